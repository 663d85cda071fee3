// SPDX-License-Identifier: GPL-2.0-or-later
// Energies that the present state holds.
#include "../kernels/automaton/energy.hpp"
#include "solver.hpp"
#include <cmath>

namespace mca::automata {

Account Solver::account() const
{
	const Store& S = store;
	Account      A = sums;
	A.kinetic = A.volumetric = A.deviatoric = 0, A.momentum = {}, A.angular = {};
	for (size_t b = 0; b < S.blocks.size(); b++) {
		double          k = 0, v = 0, q = 0;
		Vec<double>     p {};
		Turn<double>    a {};
		const Material& m = S.materialOf(S.blocks[b]);
		for (int l = 0; l < S.blocks[b].count; l++) {
			const size_t       i    = b * blockSize + l;
			const Turn<double> spin = turnAt(S.omega, i);
			v += volumeEnergy(m, S.cell[i], S.J[i], S.heat.empty() ? 0. : S.heat[i]);
			if (S.factor[i] > 0. && S.blocks[b].contact)
				v += contactEnergyAt(i, contactRatio(scratch.sum[i])); // affine rule: contacts have a volume of their own
			q += deviatorEnergyOf(i);
			if (S.flags[i] & tiedBit) { // its mass is on the grid; a free spin is its own
				if (turnsFreely(i)) k += 0.5 * S.inertia[i] * plainSquare(spin), a += spin * S.inertia[i];
				continue;
			}
			k += 0.5 * (S.mass[i] * plainSquare(S.velocity.at(i)) + S.inertia[i] * plainSquare(spin));
			p += S.velocity.at(i) * S.mass[i];
			a += plainCross(S.position.at(i), S.velocity.at(i)) * S.mass[i] + spin * S.inertia[i];
		}
		A.kinetic += k, A.volumetric += v, A.deviatoric += q, A.momentum += p, A.angular += a;
	}
	A.volumetric -= A.heated;
	for (size_t c = 0; c < contacts.size(); c++) {
		const int32_t i = contacts.owner[c];
		A.deviatoric += Lattice::cell(S.diameter[i]) / nLinks * pairEnergy(sideOf(contacts, c), S.J[i], contacts.twoG[c]);
	}
	A.deviatoric += energyOfBonds();
	return A;
}

double Solver::ownMass() const
{
	double sum = 0;
	for (size_t i = 0; i < store.size(); i++)
		if (store.id[i] >= 0 && !(store.flags[i] & tiedBit)) sum += store.mass[i];
	return sum;
}

double Solver::equivalentStress(size_t i) const
{
	const Store& S  = store;
	double       sq = 0;
	for (int k = 0; k < nLinks; k++)
		if (holds(S.flags[i], k)) sq += linkWeight(S.flags[i], k) * plainSquare(S.stressAt(linkSlot(i, k))) / sqr(S.J[i]);
	return equivalentStressAt(S, i, sq);
}

double Solver::deviatorEnergyOf(size_t i) const
{
	const Store& S = store;
	double pairs = 0;
	for (int k = 0; k < nLinks; k++)
		if (holds(S.flags[i], k)) {
			const size_t j = S.neighbour[linkSlot(i, k)];
			const double twoG = S.pairTwoG(S.speciesOf(i), j, arm(S.diameter[i], S.diameter[j]));
			pairs += linkWeight(S.flags[i], k) * pairEnergy(S.stressAt(linkSlot(i, k)), S.J[i], twoG);
		}
	return deviatorEnergyAt(S, i, pairs);
}
}
