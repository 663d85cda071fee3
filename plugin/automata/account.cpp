// SPDX-License-Identifier: GPL-2.0-or-later
#include "solver.hpp"
#include <algorithm>
#include <cmath>
#include <sstream>

namespace mca::automata {

Account Solver::account() const
{
	const Store& S = store;
	Account      A = sums;
	A.kinetic = A.volumetric = A.deviatoric = A.px = A.py = A.angular = 0;
	for (size_t b = 0; b < S.blocks.size(); b++) {
		double          k = 0, v = 0, q = 0, px = 0, py = 0, a = 0;
		const Material& m = S.materialOf(S.blocks[b]);
		for (int l = 0; l < S.blocks[b].count; l++) {
			const size_t i = b * blockSize + l;
			v += m.eos.heats() ? S.cell[i] * m.eos.rho0 * S.heat[i] : stateEnergy(i, S.J[i]);
			if (S.jOff[i] > 0. && S.blocks[b].contact) v += stateEnergy(i, 1. / (1. + scratch.sum[i] / nLinks)); // affine rule: contacts have a volume of their own
			q += deviatoricEnergy(i);
			if (S.flags[i] & tiedBit) { // its mass is on the grid; a free spin is its own
				if (S.ar[i] > 0) k += 0.5 * S.inertia[i] * sqr(S.omega[i]), a += S.inertia[i] * S.omega[i];
				continue;
			}
			k += 0.5 * (S.mass[i] * (sqr(S.vx[i]) + sqr(S.vy[i])) + S.inertia[i] * sqr(S.omega[i]));
			px += S.mass[i] * S.vx[i], py += S.mass[i] * S.vy[i];
			a += S.mass[i] * (S.x[i] * S.vy[i] - S.y[i] * S.vx[i]) + S.inertia[i] * S.omega[i];
		}
		A.kinetic += k, A.volumetric += v, A.deviatoric += q, A.px += px, A.py += py, A.angular += a;
	}
	A.volumetric -= A.heated;
	for (size_t c = 0; c < contacts.size(); c++) {
		const int32_t i = contacts.owner[c];
		// with the stiffness of the pair, which between unlike materials is neither's own
		if (contacts.twoG[c] > 0) A.deviatoric += Lattice<2>::cell(S.diameter[i]) / nLinks * (sqr(contacts.s[c]) + sqr(contacts.tau[c])) / (S.J[i] * contacts.twoG[c]);
	}
	return A;
}

double Solver::equivalentStress(size_t i) const
{
	const Store& S  = store;
	double       sq = 0;
	for (int s = 0; s < nLinks; s++)
		if ((S.flags[i] >> s) & 1) {
			const double w = (S.flags[i] >> (halfShift + s)) & 1 ? 0.5 : 1.;
			sq += w * (sqr(S.s[linkSlot(i, s)]) + sqr(S.tau[linkSlot(i, s)])) / sqr(S.J[i]);
		}
	return std::sqrt(equivalentStress2<2>(sq * S.invN[i], S.szz[i]));
}

double Solver::deviatoricEnergy(size_t i) const
{
	const Store& S = store;
	const double G = S.materials[S.species[S.speciesOf(i)].material].G;
	if (!(G > 0)) return 0.;
	double pairs = 0;
	for (int k = 0; k < nLinks; k++)
		if ((S.flags[i] >> k) & 1) {
			const size_t j = S.neighbour[linkSlot(i, k)];
			const double w = (S.flags[i] >> (halfShift + k)) & 1 ? 0.5 : 1., twoG = S.pairTwoG(S.speciesOf(i), j, S.diameter[i] / (S.diameter[i] + S.diameter[j]));
			if (twoG > 0) pairs += w * (sqr(S.s[linkSlot(i, k)]) + sqr(S.tau[linkSlot(i, k)])) / (S.J[i] * twoG);
		}
	// a pair side stands for a sixth of the full cell; szz for the volume of all, which on weighted rims is not the cell
	return Lattice<2>::cell(S.diameter[i]) / nLinks * (pairs + S.J[i] * sqr(S.szz[i]) / (4. * G * S.invN[i]));
}

size_t Solver::stiffestAutomaton() const
{
	const Store& S    = store;
	size_t       who  = 0;
	double       most = -1;
	for (size_t b = 0; b < S.blocks.size(); b++)
		for (int l = 0; l < S.blocks[b].count; l++) {
			const size_t    i = b * blockSize + l;
			const Material& m = S.materialOf(S.blocks[b]);
			const double    k = (tangent(m.eos, S.J[i] - 1.) + m.G * (4. / 3.)) / (m.eos.rho0 * S.J[i] * sqr(S.diameter[i]));
			if (k > most) most = k, who = i;
		}
	return who;
}

std::vector<std::pair<int32_t, int32_t>> Solver::links() const
{
	const Store&                             S = store;
	std::vector<std::pair<int32_t, int32_t>> out;
	for (size_t i = 0; i < S.size(); i++)
		for (int k = 0; k < nLinks; k++)
			if (((S.flags[i] >> k) & 1) && S.id[i] < S.id[S.neighbour[linkSlot(i, k)]]) out.push_back({ S.id[i], S.id[S.neighbour[linkSlot(i, k)]] });
	std::sort(out.begin(), out.end());
	return out;
}

void Solver::addForce(size_t i, double fx, double fy, double torque)
{
	Store& S = store;
	for (auto v : { &S.ex, &S.ey, &S.et })
		if (v->empty()) v->assign(S.size(), 0.);
	S.ex[i] += fx, S.ey[i] += fy, S.et[i] += torque;
	if (fx != 0 || fy != 0 || torque != 0) {
		if (!S.blocks[i / blockSize].moving) topologyChanged = true;
		S.blocks[i / blockSize].moving = true;
	}
}

void Solver::clearForces()
{
	for (auto v : { &store.ex, &store.ey, &store.et })
		std::fill(v->begin(), v->end(), 0.);
}

void Solver::setDamping(size_t i, double bx, double by)
{
	Store& S = store;
	if (!(bx >= 0) || !(by >= 0) || !std::isfinite(bx + by)) {
		std::ostringstream s;
		s << "automaton " << S.id[i] << ": viscous boundary coefficient (" << bx << ", " << by << ") kg/(m s) must be finite and not negative (rho c A).";
		throw Error(s.str());
	}
	for (auto v : { &S.dampX, &S.dampY })
		if (v->empty()) v->assign(S.size(), 0.);
	S.dampX[i] = bx, S.dampY[i] = by;
}

size_t Solver::tie(size_t i, bool freeSpin)
{
	Store& S = store;
	if (S.flags[i] & tiedBit) throw Error("automaton " + std::to_string(S.id[i]) + " is tied already.");
	S.flags[i] |= tiedBit;
	S.ax[i] = S.ay[i] = 0.;
	if (!freeSpin) S.ar[i] = 0.;
	tied.push_back(int32_t(i)), tiedVx.push_back(S.vx[i]), tiedVy.push_back(S.vy[i]), tiedW.push_back(S.omega[i]);
	sums.kineticStart -= 0.5 * (S.mass[i] * (sqr(S.vx[i]) + sqr(S.vy[i])) + (S.ar[i] > 0 ? 0. : S.inertia[i] * sqr(S.omega[i])));
	return tied.size() - 1;
}

void Solver::setTiedVelocity(size_t t, double vx, double vy, double omega)
{
	Store&       S = store;
	const size_t i = tied[t];
	tiedVx[t] = S.vx[i], tiedVy[t] = S.vy[i], tiedW[t] = S.omega[i];
	S.vx[i] = vx, S.vy[i] = vy;
	if (!(S.ar[i] > 0)) S.omega[i] = omega;
	if ((vx != 0 || vy != 0 || omega != 0) && !S.blocks[i / blockSize].moving) S.blocks[i / blockSize].moving = topologyChanged = true;
}
}
