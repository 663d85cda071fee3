// SPDX-License-Identifier: GPL-2.0-or-later
#include "../kernels/automaton/force.hpp"
#include "passes.hpp"

namespace mca::automata {

void viscousHeat(Store& S, size_t b, VolumeRule rule, double dt, BlockWork* work)
{
	const Block&    B = S.blocks[b];
	const Material& m = S.materialOf(B);
	const double    perMass = 1. / m.eos.rho0;
	double          sum = 0;
	for (int l = 0; l < B.count; l++) {
		const size_t i = b * blockSize + l;
		double       q = 0;
		for (int k = 0; k < nLinks; k++) {
			if (!holds(S.flags[i], k)) continue;
			const int32_t       j = S.neighbour[linkSlot(i, k)];
			const Vec<double>   r = S.between(i, j), v = S.velocity.at(j) - S.velocity.at(i);
			const double        along = dot(r, v);
			const PairViscosity c     = ofLink(B.mixed ? S.pairViscosity(B.species, j) : viscosityOf(m), rule);
			q += 0.5 * linkWeight(S.flags[i], k)
				* viscousCoefficient(along, 1. / dot(r, r), c.linear, c.quadratic, Lattice::width(S.restDistance(i, j))) * along
				* dt; // this side's half
		}
		q += viscousWork(S.viscous[i], S.dTheta[i], S.J[i]) * S.cell[i];
		S.heat[i] += q * perMass / S.cell[i];
		sum += q;
	}
	if (work) work->heated += sum;
}
}
