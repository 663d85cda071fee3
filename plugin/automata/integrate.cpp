// SPDX-License-Identifier: GPL-2.0-or-later
// Motion: leapfrog, and the work that the forces do in it.
#include "parallel.hpp"
#include <cmath>
#include <sstream>

namespace mca::automata {
namespace {
	constexpr double largestForce = 1e300; // below it: finite, and no NaN
	/// Forces from outside on automaton i.
	struct Outside {
		Vec<double>  force;
		Turn<double> torque;
	};
	Outside outside(const Store& S, size_t i) { return S.outside.empty() ? Outside {} : Outside { S.outside.at(i), turnAt(S.outsideTorque, i) }; }
	bool    finite(Vec<double> force, Turn<double> torque) { return sumOfMagnitudes(force) + sumOfMagnitudes(torque) < largestForce; }

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
	/// pushed: forces from outside act on somebody in it.
	template <class Kicked> void kickBlock(const Store& S, size_t base, double kick, bool pushed, Kicked& to)
	{
		const auto given = [&](const std::vector<double>& v) { return v.empty() ? nullptr : v.data() + base; };
		const auto outer = [&](const std::vector<double>& v) { return pushed ? v.data() + base : nullptr; };
		for (int c = 0; c < dim; c++)
			kickLanes(&S.velocity[c][base], &S.force[c][base], outer(S.outside[c]), given(S.damp[c]), &S.perMass[c][base], kick, to.velocity[c]);
		for (int c = 0; c < turns; c++)
			kickLanes(&turnPlane(S.omega, c)[base], &turnPlane(S.torque, c)[base], outer(turnPlane(S.outsideTorque, c)), nullptr,
			          &turnPlane(S.perInertia, c)[base], kick, to.omega[c]);
	}
	/// One direction of the drift: new velocities v, and positions x by them; returns the largest.
	MCA_INLINE double driftLanes(const double* to, double dt, double* v, double* x)
	{
		double most = 0;
#pragma omp simd reduction(max : most)
		for (int l = 0; l < blockSize; l++) {
			v[l] = to[l];
			x[l] = fma(to[l], dt, x[l]);
			most = max(most, std::fabs(to[l]));
		}
		return most;
	}
	/// Largest component of a velocity [m/s], and of a spin [rad/s].
	struct Fastest {
		double velocity = 0, spin = 0;
	};
	template <class Kicked> Fastest driftBlock(Store& S, size_t base, double dt, const Kicked& to)
	{
		Fastest most;
		for (int c = 0; c < turns; c++)
			most.spin = max(most.spin, driftLanes(to.omega[c], dt, &turnPlane(S.omega, c)[base], &turnPlane(S.angle, c)[base]));
		for (int c = 0; c < dim; c++)
			most.velocity = max(most.velocity, driftLanes(to.velocity[c], dt, &S.velocity[c][base], &S.position[c][base]));
		return most;
	}
}

/// Velocities of a block after the kick.
struct Solver::Kicked {
	alignas(64) double velocity[dim][blockSize], omega[turns][blockSize];
	Vec<double> velocityAt(int l) const
	{
		Vec<double> v;
		for (int c = 0; c < dim; c++) v[c] = velocity[c][l];
		return v;
	}
	Turn<double> omegaAt(int l) const
	{
		Turn<double> w;
		for (int c = 0; c < turns; c++) turnComponent(w, c) = omega[c][l];
		return w;
	}
};

/// Before anything moves: a force that is not finite must not get into the state.
void Solver::checkForces()
{
	const Store& S = store;
	const auto   force = S.force.planes(), given = S.outside.planes();
	for (int32_t b : awake)
		results[b].bad = -1;
	eachAwake([&](size_t b) {
		int          bad  = 0;
		const size_t base = b * blockSize;
		for (int l = 0; l < blockSize; l++)
			bad += finite(force.at(base + l), turnAt(S.torque, base + l)) ? 0 : 1;
		for (int l = 0; isPushed(b) && l < blockSize; l++)
			bad += finite(given.at(base + l), turnAt(S.outsideTorque, base + l)) ? 0 : 1;
		if (bad) results[b].bad = int64_t(base);
	});
	for (int32_t b : awake)
		for (int l = 0; l < blockSize && results[b].bad >= 0; l++) {
			const size_t  i = size_t(b) * blockSize + l;
			const Outside e = outside(S, i);
			if (finite(S.force.at(i), turnAt(S.torque, i)) && finite(e.force, e.torque)) continue;
			std::ostringstream s;
			s << "automaton " << S.id[i] << ": force " << S.force.at(i) << " N/m, from outside " << e.force << " N/m, in step " << counters.steps
			  << " is not finite. Positions are those before the step; save and look, or use a smaller time step.";
			throw Error(s.str());
		}
}

/// Shares of the pressures and of the viscosity in the force on automaton i.
Solver::ForceShares Solver::sharesOf(size_t i) const
{
	const auto& a = accountForce;
	ForceShares f { a.volumetric.at(i), a.viscous.at(i) };
	if (contacts.size() && store.blocks[i / blockSize].contact) f.volumetric += scratch.volumetric.at(i), f.viscous += scratch.viscous.at(i);
	return f;
}

/// Work of a block's forces in the kick to these velocities; after: share of the kick that comes after the time of the forces.
void Solver::bookBlock(size_t b, double kick, double after, const Kicked& to)
{
	const Store& S    = store;
	const bool   damp = !S.damp.empty();
	StepWork     p;
	for (int l = 0; l < blockSize; l++) {
		const size_t      i = b * blockSize + l;
		const Vec<double> v = to.velocityAt(l), before = S.velocity.at(i), F = S.force.at(i), damping = damp ? S.damp.at(i) : Vec<double> {};
		const Turn<double> w = to.omegaAt(l), spin = turnAt(S.omega, i), T = turnAt(S.torque, i);
		const Outside     o = outside(S, i);
		const ForceShares f = sharesOf(i);
		const Vec<double> move = (before + v) * 0.5 * kick;
		const Turn<double> turn = (spin + w) * 0.5 * kick;
		p.volumetric += plainDot(f.volumetric, move);
		p.viscous += plainDot(f.viscous, move);
		p.deviatoric += plainDot(F - f.volumetric - f.viscous, move) + plainDot(T, turn);
		// what the outside adds: given forces, and the reaction that keeps blocked degrees of freedom at their velocity
		const Vec<double> all = F + o.force;
		Vec<double>       e, damped;
		for (int c = 0; c < dim; c++) {
			const bool free = S.perMass[c][i] > 0;
			e[c] = free ? all[c] - F[c] : -F[c], damped[c] = free ? damping[c] * move[c] : 0.;
			p.impulse[c] += e[c] * kick - damped[c];
		}
		const Turn<double> torques = T + o.torque;
		Turn<double>       et;
		for (int c = 0; c < turns; c++) {
			const double own = turnComponent(T, c);
			turnComponent(et, c) = turnPlane(S.perInertia, c)[i] > 0 ? turnComponent(torques, c) - own : -own;
		}
		p.external += plainDot(e, move) + plainDot(et, turn);
		p.boundary += plainDot(damped, move) / kick;
		const Vec<double> centre = v - (v - before) * after;
		const Turn<double> cw     = w - (w - spin) * after;
		double            gained = plainSquare(centre);
		for (int c = 0; c < dim; c++)
			gained -= v[c] * v[c];
		if (!(S.flags[i] & tiedBit)) p.centre += 0.5 * S.mass[i] * gained;
		if (!(S.flags[i] & tiedBit) || turnsFreely(i)) p.centre += 0.5 * S.inertia[i] * (plainSquare(cw) - plainSquare(w));
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
			sums.external += p.external, sums.boundary += p.boundary, sums.impulse += p.impulse;
	for (size_t t = 0; t < tied.size(); t++) { // their velocity had been set before: the mean is that of old and new
		const size_t      i = tied[t];
		const ForceShares f = sharesOf(i);
		const Vec<double> move       = (tiedVelocity.at(t) - S.velocity.at(i)) * 0.5 * kick;
		// a free spin is booked above
		const Turn<double> turn = turnsFreely(i) ? Turn<double> {} : (turnAt(tiedSpin, t) - turnAt(S.omega, i)) * 0.5 * kick;
		const double      volumetric = plainDot(f.volumetric, move), viscosity = plainDot(f.viscous, move),
			     all = plainDot(S.force.at(i), move) + plainDot(turnAt(S.torque, i), turn);
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
		kickBlock(store, b * blockSize, span, isPushed(b), to);
		if (options.account) bookBlock(b, span, after, to);
		const Fastest most = driftBlock(store, b * blockSize, dt, to);
		if (most.velocity > 0 || most.spin > 0) store.blocks[b].moving = true;
		if (!travelled.empty()) travelled[b] += most.velocity * dt;
	});
	if (options.account) bookStep(span, after);
	lastDt = lastMove = dt;
	time += dt;
	counters.steps++;
}
}
