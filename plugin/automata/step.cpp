// SPDX-License-Identifier: GPL-2.0-or-later
// One step: forces, checks, time-step limit, integration.
#include "solver.hpp"
#include "volume_filter.hpp"
#include <algorithm>
#include <chrono>
#include <cmath>
#include <omp.h>
#include <sstream>

namespace mca::automata {
namespace {
	/// Adds the time from its birth to its death to a counter; does nothing when timing is off.
	class Timer {
		using Clock = std::chrono::steady_clock;
		double*           to;
		Clock::time_point start;

	public:
		Timer(bool on, double& counter)
		        : to(on ? &counter : nullptr)
		{
			if (to) start = Clock::now();
		}
		~Timer()
		{
			if (to) *to += double(std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - start).count());
		}
	};
}

template <class F> void Solver::eachAwake(F&& f)
{
	const long n = long(awake.size());
	// few blocks are not worth waking a thread for
#pragma omp parallel for schedule(static) if (n >= 16)
	for (long q = 0; q < n; q++)
		f(size_t(awake[q]));
}

void Solver::overlapError(size_t i, size_t j, double ratio) const
{
	const Store&       S = store;
	std::ostringstream s;
	s << "automata " << S.id[i] << " at (" << S.x[i] << ", " << S.y[i] << ") m and " << S.id[j] << " at (" << S.x[j] << ", " << S.y[j] << ") m are " << ratio
	  << " rest distances apart in step " << counters.steps << "; the least allowed is 0.5 (0.2 if linked). Remedy: a smaller time step, a smaller impact speed, or no overlap in the packing.";
	throw Error(s.str());
}

void Solver::checkResults(double nearestContact, size_t closest)
{
	const Store& S       = store;
	double       nearest = nearestContact;
	int64_t      clamped = 0;
	for (int32_t b : awake) {
		const BlockResult& R = results[b];
		if (R.bad >= 0) {
			std::ostringstream s;
			s << "automaton " << S.id[R.bad] << ": volume ratio " << S.J[R.bad] << " in step " << counters.steps
			  << " is not in (0, 1e6). Remedy: a smaller time step (the limit was " << dtLimit << " s, the step " << lastDt << " s).";
			throw Error(s.str());
		}
		nearest = std::min(nearest, R.nearest);
		clamped += R.clamped;
	}
	counters.clamped += clamped;
	counters.deepest = std::min(counters.deepest, std::sqrt(nearest));
	// linked automata may shear until they are close; contacts may not overlap that far
	if (nearestContact >= deepest && nearest >= 0.04) return;
	nearest = nearestContact < deepest ? nearestContact : nearest;
	if (nearestContact <= nearest) overlapError(contacts.owner[closest], contacts.other[closest], std::sqrt(nearest));
	for (int32_t b : awake)
		if (results[b].nearest <= nearest)
			for (int q = 0; q < nLinks * blockSize; q++) {
				const size_t i = size_t(b) * blockSize + q % blockSize, j = S.neighbour[size_t(b) * nLinks * blockSize + q];
				const double dx = S.x[j] - S.x[i], dy = S.y[j] - S.y[i], d = 0.5 * (S.diameter[i] + S.diameter[j]);
				if (((S.flags[i] >> (q / blockSize)) & 1) && dx * dx + dy * dy <= nearest * d * d * 1.0001) overlapError(i, j, std::sqrt(nearest));
			}
}

void Solver::computeForces()
{
	Store& S = store;
	if (options.contacts) {
		Timer t(timing, counters.nsSearch);
		searchIfNeeded();
	}
	wake();
	counters.blockSteps += int64_t(awake.size());
	filterTime += lastMove;
	if (flows && options.volumeFilter > 0 && counters.steps % filterPeriod == 0) {
		Timer t(timing, counters.nsDensity);
		filterVolumes();
	}
	const bool       contact = contacts.size() > 0, account = options.account;
	const VolumeRule rule    = options.volumeRule;
	if (contact && account) // switched on since the last search
		for (auto v : { &scratch.old, &scratch.volX, &scratch.volY, &scratch.visX, &scratch.visY })
			v->resize(S.size(), 0.);
	Extra X;
	if (contact) X.contactSum = scratch.sum.data(), X.contactSq = scratch.square.data(), X.contactOld = scratch.old.data(), X.scale = scratch.scale.data(), X.contactFx = scratch.fx.data(), X.contactFy = scratch.fy.data(), X.contactT = scratch.torque.data();
	if (account) {
		for (auto v : { &accountForce.volX, &accountForce.volY, &accountForce.visX, &accountForce.visY })
			v->resize(S.size(), 0.);
		X.volX = accountForce.volX.data(), X.volY = accountForce.volY.data(), X.visX = accountForce.visX.data(), X.visY = accountForce.visY.data();
		for (auto& w : works)
			w = {};
	}
	double nearest = 1e300;
	size_t closest = 0;
	if (contact) {
		Timer t(timing, counters.nsContact);
		nearest = contactDensity(S, contacts, rule, scratch, closest);
	}
	{
		Timer t(timing, counters.nsDensity);
		eachAwake([&](size_t b) { S.packBlock(b); });
		eachAwake([&](size_t b) {
			results[b].bad = -1;
			densityPass(S, b, rule, X, false, results[b]);
		});
	}
	checkResults(nearest, closest);
	contactSpeed2 = 0;
	ContactWork cw;
	if (contact) {
		Timer t(timing, counters.nsContact);
		contactSpeed2 = contactTrial(S, contacts, lastMove, scratch, account);
	}
	{
		Timer t(timing, counters.nsStress);
		const double dt = lastMove > 0 ? lastMove : 1e-300;
		if (lastMove > 0) eachAwake([&](size_t b) { stressPass(S, b, dt, X, results[b], account ? &works[b] : nullptr); });
	}
	if (contact) {
		Timer t(timing, counters.nsContact);
		contactPressure(S, contacts, rule);
		if (lastMove > 0) contactFriction(S, contacts, scratch, account ? &cw : nullptr);
		contactForces(contacts, scratch, account);
	}
	{
		Timer t(timing, counters.nsForce);
		eachAwake([&](size_t b) { forcePass(S, b, rule, X); });
	}
	if (!S.heat.empty() && lastMove > 0)
		eachAwake([&](size_t b) {
			const Material& m = S.materialOf(S.blocks[b]);
			if (m.eos.mieGrueneisen && m.viscosity.active()) viscousHeat(S, b, lastMove, account ? &works[b] : nullptr);
		});
	if (account) {
		for (int32_t b : awake)
			sums.plastic += works[b].plastic, sums.coupling += works[b].coupling, sums.heated += works[b].heated;
		sums.friction += cw.friction, sums.coupling += cw.coupling, sums.plastic += cw.plastic;
	}
	// 2.8: all blocks, the sleeping ones with their state of rest
	double limit = 1e300, pressed = 0; // stiffest of what meets something else [Pa]: its pressure moves lighter neighbours, too, from one side
	for (size_t b = 0; b < S.blocks.size(); b++)
		if (S.blocks[b].mixed || S.blocks[b].contact) pressed = std::max(pressed, results[b].stiffest * S.materialOf(S.blocks[b]).eos.rho0);
	for (size_t b = 0; b < S.blocks.size(); b++) {
		const Block&    B  = S.blocks[b];
		const Material& m  = S.materialOf(B);
		const double    cP = std::sqrt(B.mixed || B.contact ? 0.5 * (results[b].stiffest + std::max(results[b].stiffest, pressed / m.eos.rho0)) : results[b].stiffest), d = S.species[B.species].d;
		const double    dv = lastMove > 0 ? results[b].closing * d / lastMove : 0.;
		// what turns an automaton against its neighbours grows with J: shear stresses are those of the present volume
		limit              = std::min(limit, stableStep(d, cP, m.cS() * std::sqrt(results[b].widest), m.viscosity.active() ? m.viscosity.linear + m.viscosity.quadratic * dv / cP : 0.));
	}
	if (contactSpeed2 > 0) { // pairs that meet: no more than an eighth of their distance in a step
		double d = 1e300;
		for (auto& sp : S.species)
			d = std::min(d, sp.d);
		limit = std::min(limit, 0.125 * d / std::sqrt(contactSpeed2));
	}
	dtLimit = limit;
}

void Solver::integrate(double dt)
{
	if (!(dt > 0) || !std::isfinite(dt)) {
		std::ostringstream s;
		s << "time step " << dt << " s must be finite and above zero; the largest stable one is now " << dtLimit << " s.";
		throw Error(s.str());
	}
	Timer        timer(timing, counters.nsIntegrate);
	if (topologyChanged) wake(); // a force from outside on a block at rest
	Store&       S    = store;
	const double kick = lastDt > 0 ? 0.5 * (lastDt + dt) : dt;
	const bool   ext = !S.ex.empty(), damp = !S.dampX.empty(), account = options.account, contact = contacts.size() > 0;
	for (int32_t b : awake) // before anything moves: a force that is not finite must not get into the state
		results[b].bad = -1;
	eachAwake([&](size_t b) {
		int bad = 0;
		const size_t base = b * blockSize;
		for (int l = 0; l < blockSize; l++)
			bad += std::fabs(S.fx[base + l]) + std::fabs(S.fy[base + l]) + std::fabs(S.torque[base + l]) < 1e300 ? 0 : 1;
		for (int l = 0; ext && l < blockSize; l++)
			bad += std::fabs(S.ex[base + l]) + std::fabs(S.ey[base + l]) + std::fabs(S.et[base + l]) < 1e300 ? 0 : 1;
		if (bad) results[b].bad = int64_t(base);
	});
	for (int32_t b : awake)
		for (int l = 0; l < blockSize && results[b].bad >= 0; l++) {
			const size_t i = size_t(b) * blockSize + l;
			const double ex = ext ? S.ex[i] : 0., ey = ext ? S.ey[i] : 0., et = ext ? S.et[i] : 0.;
			if (std::fabs(S.fx[i]) + std::fabs(S.fy[i]) + std::fabs(S.torque[i]) < 1e300 && std::fabs(ex) + std::fabs(ey) + std::fabs(et) < 1e300) continue;
			std::ostringstream s;
			s << "automaton " << S.id[i] << ": force (" << S.fx[i] << ", " << S.fy[i] << ") N/m, from outside (" << ex << ", " << ey << ") N/m, in step " << counters.steps << " is not finite. Positions are those before the step; save and look, or use a smaller time step.";
			throw Error(s.str());
		}
	if (account) partials.assign(S.blocks.size(), {});
	if (account)
		for (auto& p : partials)
			p.assign(8, 0.);
	const double after = 0.5 * dt / kick; // share of the kick that comes after the time of the forces
	eachAwake([&](size_t b) {
		const size_t base = b * blockSize;
		const bool   withContact = account && contact && S.blocks[b].contact;
		double       moving = 0;
		for (int l = 0; l < blockSize; l++) {
			const size_t i  = base + l;
			double       Fx = S.fx[i], Fy = S.fy[i], T = S.torque[i];
			if (ext) Fx += S.ex[i], Fy += S.ey[i], T += S.et[i];
			double vx = fma(S.ax[i] * Fx, kick, S.vx[i]), vy = fma(S.ay[i] * Fy, kick, S.vy[i]);
			if (damp) { // implicit in the mean velocity: stable for any b
				const double bx = 0.5 * S.dampX[i] * S.ax[i] * kick, by = 0.5 * S.dampY[i] * S.ay[i] * kick;
				vx = (vx - bx * S.vx[i]) / (1. + bx), vy = (vy - by * S.vy[i]) / (1. + by);
			}
			const double w = fma(S.ar[i] * T, kick, S.omega[i]);
			if (account) {
				auto&        p  = partials[b];
				const double mx = 0.5 * (S.vx[i] + vx) * kick, my = 0.5 * (S.vy[i] + vy) * kick, mw = 0.5 * (S.omega[i] + w) * kick;
				double       Vx = accountForce.volX[i], Vy = accountForce.volY[i], Qx = accountForce.visX[i], Qy = accountForce.visY[i];
				if (withContact) Vx += scratch.volX[i], Vy += scratch.volY[i], Qx += scratch.visX[i], Qy += scratch.visY[i];
				p[0] += Vx * mx + Vy * my;
				p[1] += Qx * mx + Qy * my;
				p[2] += (S.fx[i] - Vx - Qx) * mx + (S.fy[i] - Vy - Qy) * my + S.torque[i] * mw;
				const double dX = damp ? S.dampX[i] : 0., dY = damp ? S.dampY[i] : 0.;
				// what the outside adds: given forces, and the reaction that keeps blocked degrees of freedom at their velocity
				const double ex = S.ax[i] > 0 ? Fx - S.fx[i] : -S.fx[i], ey = S.ay[i] > 0 ? Fy - S.fy[i] : -S.fy[i], et = S.ar[i] > 0 ? T - S.torque[i] : -S.torque[i];
				p[3] += ex * mx + ey * my + et * mw;
				const double dampedX = S.ax[i] > 0 ? dX * mx : 0., dampedY = S.ay[i] > 0 ? dY * my : 0.;
				p[4] += (dampedX * mx + dampedY * my) / kick;
				p[5] += ex * kick - dampedX, p[6] += ey * kick - dampedY;
				const double cx = vx - after * (vx - S.vx[i]), cy = vy - after * (vy - S.vy[i]), cw = w - after * (w - S.omega[i]);
				if (!(S.flags[i] & tiedBit)) p[7] += 0.5 * S.mass[i] * (cx * cx + cy * cy - vx * vx - vy * vy);
				if (!(S.flags[i] & tiedBit) || S.ar[i] > 0) p[7] += 0.5 * S.inertia[i] * (cw * cw - w * w);
			}
			S.vx[i] = vx, S.vy[i] = vy, S.omega[i] = w;
			S.x[i]     = fma(vx, dt, S.x[i]);
			S.y[i]     = fma(vy, dt, S.y[i]);
			S.angle[i] = fma(w, dt, S.angle[i]);
			moving     = max(moving, std::fabs(vx) + std::fabs(vy) + std::fabs(w));
		}
		if (moving > 0) S.blocks[b].moving = true;
	});
	if (account) {
		const double external = sums.external, boundary = sums.boundary, viscous = sums.bookedViscous;
		sums.centre = 0;
		for (auto& p : partials)
			sums.centre += p[7], sums.bookedVolumetric += p[0], sums.bookedViscous += p[1], sums.bookedDeviatoric += p[2], sums.external += p[3], sums.boundary += p[4], sums.impulseX += p[5], sums.impulseY += p[6];
		for (size_t t = 0; t < tied.size(); t++) { // their velocity had been set before: the mean is that of old and new
			const size_t i = tied[t];
			double       Vx = accountForce.volX[i], Vy = accountForce.volY[i], Qx = accountForce.visX[i], Qy = accountForce.visY[i];
			if (contact && S.blocks[i / blockSize].contact) Vx += scratch.volX[i], Vy += scratch.volY[i], Qx += scratch.visX[i], Qy += scratch.visY[i];
			const double mx = 0.5 * (tiedVx[t] - S.vx[i]) * kick, my = 0.5 * (tiedVy[t] - S.vy[i]) * kick, mw = S.ar[i] > 0 ? 0. : 0.5 * (tiedW[t] - S.omega[i]) * kick; // a free spin is booked above
			const double a = Vx * mx + Vy * my, q = Qx * mx + Qy * my, all = S.fx[i] * mx + S.fy[i] * my + S.torque[i] * mw;
			sums.bookedVolumetric += a, sums.bookedViscous += q, sums.bookedDeviatoric += all - a - q, sums.external -= all;
		}
		sums.viscous -= sums.bookedViscous - viscous;
		sums.centre += after * (sums.external - external - sums.boundary + boundary + sums.bookedViscous - viscous);
	}
	lastDt = lastMove = dt;
	time += dt;
	counters.steps++;
}

void Solver::wakeAround(size_t block)
{
	Store& S = store;
	S.blocks[block].awake = true;
	for (int32_t q = adjacentBegin[block]; q < adjacentBegin[block + 1]; q++) {
		const int32_t a    = adjacent[q];
		S.blocks[a].awake = true;
		for (int32_t p = adjacentBegin[a]; p < adjacentBegin[a + 1]; p++)
			S.blocks[adjacent[p]].awake = true;
	}
}

// Forces reach two links in one step (through the volume of the neighbour's neighbour), so two rings of blocks around a moving one are computed.
void Solver::wake()
{
	Store& S = store;
	if (awake.size() == S.blocks.size() && !topologyChanged) return;
	for (size_t b = 0; b < S.blocks.size(); b++)
		if (S.blocks[b].moving && !S.blocks[b].ringsAwake) {
			wakeAround(b);
			S.blocks[b].ringsAwake = true;
		}
	for (auto& [a, b] : contactAdjacent)
		if (S.blocks[a].moving != S.blocks[b].moving || S.blocks[a].awake != S.blocks[b].awake) wakeAround(a), wakeAround(b);
	awake.clear();
	for (size_t b = 0; b < S.blocks.size(); b++)
		if (S.blocks[b].awake) awake.push_back(int32_t(b));
	if (topologyChanged) S.packAll(); // neighbours of blocks that sleep read their records, which then stay as they are
	topologyChanged = false;
}

void Solver::searchIfNeeded()
{
	Store& S = store;
	bool   due = searchDue;
	double reach = 1e300; // a pair that is not listed may come nearer by this much before it can touch
	for (auto& sp : S.species)
		reach = std::min(reach, options.skin * sp.d);
	const long    n = long(exposed.size());
	const int32_t* who = exposed.data();
	const double * x = S.x.data(), *y = S.y.data(), *x0 = searchX.data(), *y0 = searchY.data();
	// no two have moved against each other by more than the diagonal of the box that holds all displacements, nor by more than twice the largest
	double most = 0, left = 1e300, right = -1e300, low = 1e300, high = -1e300;
#pragma omp parallel for simd schedule(static) reduction(max : most, right, high) reduction(min : left, low) if (n > 4096)
	for (long q = 0; q < n; q++) {
		const double dx = x[who[q]] - x0[q], dy = y[who[q]] - y0[q];
		most = max(most, dx * dx + dy * dy);
		left = min(left, dx), right = max(right, dx), low = min(low, dy), high = max(high, dy);
	}
	due |= n > 0 && 4. * most > sqr(reach) && sqr(right - left) + sqr(high - low) > sqr(reach);
	// links break in batches, every fourth step: each batch needs a search, and a few steps do not matter to a process that takes hundreds
	if (!due && counters.steps % breakPeriod == 0) due = breaking();
	if (due) search();
}

void Solver::search()
{
	Store& S = store;
	if (counters.steps % breakPeriod == 0) {
		Timer t(timing, counters.nsFracture);
		breakLinks();
	}
	if (counters.steps >= lastSort + 2000) sortInSpace();
	for (int32_t i : contacts.rowOwner) // entries of owners that may have none any more
		for (auto v : { &scratch.sum, &scratch.square, &scratch.old, &scratch.scale, &scratch.fx, &scratch.fy, &scratch.torque, &scratch.volX, &scratch.volY, &scratch.visX, &scratch.visY })
			if (!v->empty()) (*v)[i] = 0.;
	searchContacts(S, contacts, options.skin, std::max(1, omp_get_max_threads()));
	if (contacts.size()) {
		for (auto v : { &scratch.sum, &scratch.square, &scratch.scale, &scratch.fx, &scratch.fy, &scratch.torque })
			v->resize(S.size(), 0.);
		if (options.account)
			for (auto v : { &scratch.old, &scratch.volX, &scratch.volY, &scratch.visX, &scratch.visY })
				v->resize(S.size(), 0.);
	}
	settleVolumes();
	exposed.clear();
	for (size_t i = 0; i < S.size(); i++)
		if (S.id[i] >= 0 && (S.flags[i] & exposedBit)) exposed.push_back(int32_t(i));
	searchX.resize(exposed.size()), searchY.resize(exposed.size());
	for (size_t q = 0; q < exposed.size(); q++)
		searchX[q] = S.x[exposed[q]], searchY[q] = S.y[exposed[q]];
	contactAdjacent.clear();
	if (options.sleeping && awake.size() < S.blocks.size()) {
		for (size_t c = 0; c < contacts.size(); c++) {
			const int32_t a = contacts.owner[c] / blockSize, b = contacts.other[c] / blockSize;
			if (a < b) contactAdjacent.push_back({ a, b });
		}
		std::sort(contactAdjacent.begin(), contactAdjacent.end());
		contactAdjacent.erase(std::unique(contactAdjacent.begin(), contactAdjacent.end()), contactAdjacent.end());
	}
	topologyChanged = true;
	searchDue       = false;
	counters.searches++;
}

void Solver::moved()
{
	lastMove        = 0.;
	topologyChanged = searchDue = true;
	for (auto& B : store.blocks)
		B.moving = B.awake = true;
}
}
