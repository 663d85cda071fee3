// SPDX-License-Identifier: GPL-2.0-or-later
// Motion: leapfrog, and the work that the forces do in it.
#include "parallel.hpp"
#include <cmath>
#include <sstream>

namespace mca::automata {
namespace {
	constexpr double largestForce = 1e300; // below it: finite, and no NaN
	/// Velocities of a block after the kick.
	struct Kicked {
		alignas(64) double vx[blockSize], vy[blockSize], omega[blockSize];
	};
	/// Forces from outside on automaton i.
	struct Outside {
		double x, y, torque;
	};
	Outside outside(const Store& S, size_t i)
	{
		return S.outsideX.empty() ? Outside { 0., 0., 0. } : Outside { S.outsideX[i], S.outsideY[i], S.outsideTorque[i] };
	}
	bool    finite(double x, double y, double torque) { return std::fabs(x) + std::fabs(y) + std::fabs(torque) < largestForce; }

	/// One direction of the kick. force, outside (may be null), damping (may be null: none): of the lanes; inverse: 1/mass or 0.
	MCA_INLINE void
	kickLanes(const double* v, const double* force, const double* outside, const double* damping, const double* inverse, double kick, double* to)
	{
#pragma omp simd
		for (int l = 0; l < blockSize; l++) {
			const double F = outside ? force[l] + outside[l] : force[l], free = fma(inverse[l] * F, kick, v[l]);
			// implicit in the mean velocity: stable for any coefficient
			const double b = damping ? 0.5 * damping[l] * inverse[l] * kick : 0.;
			to[l]          = damping ? (free - b * v[l]) / (1. + b) : free;
		}
	}
	void kickBlock(const Store& S, size_t base, double kick, Kicked& to)
	{
		const auto given = [&](const std::vector<double>& v) { return v.empty() ? nullptr : v.data() + base; };
		kickLanes(&S.vx[base], &S.fx[base], given(S.outsideX), given(S.dampX), &S.perMassX[base], kick, to.vx);
		kickLanes(&S.vy[base], &S.fy[base], given(S.outsideY), given(S.dampY), &S.perMassY[base], kick, to.vy);
		kickLanes(&S.omega[base], &S.torque[base], given(S.outsideTorque), nullptr, &S.perInertia[base], kick, to.omega);
	}
	/// New velocities, and positions by them; returns whether anything moves.
	bool driftBlock(Store& S, size_t base, double dt, const Kicked& to)
	{
		double *vx = &S.vx[base], *vy = &S.vy[base], *omega = &S.omega[base], *x = &S.x[base], *y = &S.y[base], *angle = &S.angle[base];
		double  moving = 0;
#pragma omp simd reduction(max : moving)
		for (int l = 0; l < blockSize; l++) {
			vx[l] = to.vx[l], vy[l] = to.vy[l], omega[l] = to.omega[l];
			x[l]     = fma(to.vx[l], dt, x[l]);
			y[l]     = fma(to.vy[l], dt, y[l]);
			angle[l] = fma(to.omega[l], dt, angle[l]);
			moving   = max(moving, std::fabs(to.vx[l]) + std::fabs(to.vy[l]) + std::fabs(to.omega[l]));
		}
		return moving > 0;
	}
}

/// Before anything moves: a force that is not finite must not get into the state.
void Solver::checkForces()
{
	const Store& S = store;
	const bool ext = !S.outsideX.empty();
	for (int32_t b : awake)
		results[b].bad = -1;
	eachAwake([&](size_t b) {
		int          bad  = 0;
		const size_t base = b * blockSize;
		for (int l = 0; l < blockSize; l++)
			bad += finite(S.fx[base + l], S.fy[base + l], S.torque[base + l]) ? 0 : 1;
		for (int l = 0; ext && l < blockSize; l++)
			bad += finite(S.outsideX[base + l], S.outsideY[base + l], S.outsideTorque[base + l]) ? 0 : 1;
		if (bad) results[b].bad = int64_t(base);
	});
	for (int32_t b : awake)
		for (int l = 0; l < blockSize && results[b].bad >= 0; l++) {
			const size_t  i = size_t(b) * blockSize + l;
			const Outside e = outside(S, i);
			if (finite(S.fx[i], S.fy[i], S.torque[i]) && finite(e.x, e.y, e.torque)) continue;
			std::ostringstream s;
			s << "automaton " << S.id[i] << ": force (" << S.fx[i] << ", " << S.fy[i] << ") N/m, from outside (" << e.x << ", " << e.y
			  << ") N/m, in step " << counters.steps
			  << " is not finite. Positions are those before the step; save and look, or use a smaller time step.";
			throw Error(s.str());
		}
}

/// Shares of the pressures and of the viscosity in the force on automaton i.
Solver::ForceShares Solver::sharesOf(size_t i) const
{
	const auto& a = accountForce;
	ForceShares f { a.volX[i], a.volY[i], a.visX[i], a.visY[i] };
	if (contacts.size() && store.blocks[i / blockSize].contact)
		f.volX += scratch.volX[i], f.volY += scratch.volY[i], f.visX += scratch.visX[i], f.visY += scratch.visY[i];
	return f;
}

/// Work of a block's forces in the kick to these velocities; after: share of the kick that comes after the time of the forces.
void Solver::bookBlock(size_t b, double kick, double after, const double* newVx, const double* newVy, const double* newOmega)
{
	const Store& S    = store;
	const bool   damp = !S.dampX.empty();
	StepWork     p;
	for (int l = 0; l < blockSize; l++) {
		const size_t      i = b * blockSize + l;
		const double      vx = newVx[l], vy = newVy[l], w = newOmega[l];
		const Outside     o = outside(S, i);
		const ForceShares f = sharesOf(i);
		const double      mx = 0.5 * (S.vx[i] + vx) * kick, my = 0.5 * (S.vy[i] + vy) * kick, mw = 0.5 * (S.omega[i] + w) * kick;
		p.volumetric += f.volX * mx + f.volY * my;
		p.viscous += f.visX * mx + f.visY * my;
		p.deviatoric += (S.fx[i] - f.volX - f.visX) * mx + (S.fy[i] - f.volY - f.visY) * my + S.torque[i] * mw;
		const double dX = damp ? S.dampX[i] : 0., dY = damp ? S.dampY[i] : 0.;
		// what the outside adds: given forces, and the reaction that keeps blocked degrees of freedom at their velocity
		const double Fx = S.fx[i] + o.x, Fy = S.fy[i] + o.y, T = S.torque[i] + o.torque;
		const double ex = S.perMassX[i] > 0 ? Fx - S.fx[i] : -S.fx[i], ey = S.perMassY[i] > 0 ? Fy - S.fy[i] : -S.fy[i],
			     et = S.perInertia[i] > 0 ? T - S.torque[i] : -S.torque[i];
		p.external += ex * mx + ey * my + et * mw;
		const double dampedX = S.perMassX[i] > 0 ? dX * mx : 0., dampedY = S.perMassY[i] > 0 ? dY * my : 0.;
		p.boundary += (dampedX * mx + dampedY * my) / kick;
		p.impulseX += ex * kick - dampedX, p.impulseY += ey * kick - dampedY;
		const double cx = vx - after * (vx - S.vx[i]), cy = vy - after * (vy - S.vy[i]), cw = w - after * (w - S.omega[i]);
		if (!(S.flags[i] & tiedBit)) p.centre += 0.5 * S.mass[i] * (cx * cx + cy * cy - vx * vx - vy * vy);
		if (!(S.flags[i] & tiedBit) || S.perInertia[i] > 0) p.centre += 0.5 * S.inertia[i] * (cw * cw - w * w);
	}
	stepWorks[b] = p;
}

/// The sums of all blocks, and the work on those that the grid carries.
void Solver::bookStep(double kick, double after)
{
	const Store& S        = store;
	const double external = sums.external, boundary = sums.boundary, viscous = sums.bookedViscous;
	sums.centre           = 0;
	for (auto& p : stepWorks)
		sums.centre += p.centre, sums.bookedVolumetric += p.volumetric, sums.bookedViscous += p.viscous, sums.bookedDeviatoric += p.deviatoric,
			sums.external += p.external, sums.boundary += p.boundary, sums.impulseX += p.impulseX, sums.impulseY += p.impulseY;
	for (size_t t = 0; t < tied.size(); t++) { // their velocity had been set before: the mean is that of old and new
		const size_t      i = tied[t];
		const ForceShares f = sharesOf(i);
		const double      mx = 0.5 * (tiedVx[t] - S.vx[i]) * kick, my = 0.5 * (tiedVy[t] - S.vy[i]) * kick,
			     mw         = S.perInertia[i] > 0 ? 0. : 0.5 * (tiedW[t] - S.omega[i]) * kick; // a free spin is booked above
		const double volumetric = f.volX * mx + f.volY * my, viscosity = f.visX * mx + f.visY * my,
			     all = S.fx[i] * mx + S.fy[i] * my + S.torque[i] * mw;
		sums.bookedVolumetric += volumetric, sums.bookedViscous += viscosity, sums.bookedDeviatoric += all - volumetric - viscosity,
			sums.external -= all;
	}
	sums.viscous -= sums.bookedViscous - viscous;
	sums.centre += after * (sums.external - external - sums.boundary + boundary + sums.bookedViscous - viscous);
}

void Solver::integrate(double dt)
{
	if (!(dt > 0) || !std::isfinite(dt)) {
		std::ostringstream s;
		s << "time step " << dt << " s must be finite and above zero; the largest stable one is now " << dtLimit << " s.";
		throw Error(s.str());
	}
	Timer timer(timing, counters.nsIntegrate);
	if (topologyChanged) wake(); // a force from outside on a block at rest
	checkForces();
	const double span = kick(dt), after = 0.5 * dt / span; // share of the kick that comes after the time of the forces
	if (options.account) stepWorks.assign(store.blocks.size(), {});
	eachAwake([&](size_t b) {
		Kicked to;
		kickBlock(store, b * blockSize, span, to);
		if (options.account) bookBlock(b, span, after, to.vx, to.vy, to.omega);
		if (driftBlock(store, b * blockSize, dt, to)) store.blocks[b].moving = true;
	});
	if (options.account) bookStep(span, after);
	lastDt = lastMove = dt;
	time += dt;
	counters.steps++;
}
}
