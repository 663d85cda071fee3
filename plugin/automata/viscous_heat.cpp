// SPDX-License-Identifier: GPL-2.0-or-later
#include "passes.hpp"

namespace mca::automata {

void viscousHeat(Store& S, size_t b, double dt, BlockWork* work)
{
	const Block&    B = S.blocks[b];
	const Material& m = S.materialOf(B);
	const double    d = S.species[B.species].d, perMass = 1. / m.eos.rho0;
	double          sum = 0;
	for (int l = 0; l < B.count; l++) {
		const size_t i = b * blockSize + l;
		double       q = 0;
		for (int k = 0; k < nLinks; k++) {
			if (!((S.flags[i] >> k) & 1)) continue;
			const int32_t j  = S.neighbour[linkSlot(i, k)];
			const double  dx = S.x[j] - S.x[i], dy = S.y[j] - S.y[i], along = fma(dx, S.vx[j] - S.vx[i], dy * (S.vy[j] - S.vy[i]));
			const double  dij = 0.5 * (d + S.diameter[j]), w = (S.flags[i] >> (halfShift + k)) & 1 ? 0.5 : 1.;
			double        c1 = m.viscosity.linear * m.eos.rho0 * m.eos.c0, c2 = m.viscosity.quadratic * m.eos.rho0;
			if (B.mixed) S.pairViscosity(B.species, j, c1, c2);
			q += 0.5 * w * viscousCoefficient(along, 1. / fma(dx, dx, dy * dy), c1, c2, Lattice<2>::width(dij)) * along * dt; // this side's half
		}
		S.heat[i] += q * perMass / S.cell[i];
		sum += q;
	}
	if (work) work->heated += sum;
}
}
