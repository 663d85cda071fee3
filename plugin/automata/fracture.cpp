// SPDX-License-Identifier: GPL-2.0-or-later
// Breaking of links (2.5): rare, so serial and in the order of the arrays; the test costs nothing where no criterion is near.
// A break changes no volume and creates no energy: what the links had measured goes on as the rest state of what is left.
#include "solver.hpp"
#include <algorithm>
#include <cmath>

namespace mca::automata {
namespace {
	/// The pair (i, link k) fulfils a criterion.
	bool breaks(const Store& S, const Material& m, size_t i, int k)
	{
		const size_t at = linkSlot(i, k), j = S.neighbour[at], back = linkSlot(j, (k + 3) % nLinks);
		if (0.5 * (S.criterion[i] + S.criterion[j]) >= 1.) return true;
		// sheared so far that the packing is gone: what follows is contact
		const double d = 0.5 * (S.diameter[i] + S.diameter[j]);
		if (sqr(S.x[j] - S.x[i]) + sqr(S.y[j] - S.y[i]) < sqr(collapsed * d)) return true;
		if (!std::isfinite(m.fracture.pairStress)) return false;
		const double s = 0.5 * (S.s[at] / S.J[i] + S.s[back] / S.J[j] - S.P[i] - S.P[j]); // tensile normal stress, mean of both sides
		return s >= 0.5 * m.fracture.pairStress * (S.strength[i] + S.strength[j]);
	}
}

double Solver::stateEnergy(size_t i, double J) const
{
	const Store& S = store;
	return S.cell[i] * storedEnergy(S.materials[S.species[S.speciesOf(i)].material].eos, J - 1.);
}

template <class F> void Solver::eachBreaking(F&& f) const
{
	const Store& S = store;
	for (int32_t b : awake) {
		const Material& m = S.materialOf(S.blocks[b]);
		if (!m.fracture.active()) continue;
		const bool pairStress = std::isfinite(m.fracture.pairStress);
		const bool close = results[b].nearest < sqr(collapsed);
		if (results[b].criterion < 1. && !pairStress && !close) continue;
		for (int l = 0; l < S.blocks[b].count; l++) {
			const size_t i = size_t(b) * blockSize + l;
			if (!(S.flags[i] & linkBits) || (S.criterion[i] < 1. && !pairStress && !close)) continue;
			for (int k = 0; k < nLinks; k++)
				if (((S.flags[i] >> k) & 1) && breaks(S, m, i, k) && f(i, k)) return;
		}
	}
}

bool Solver::breaking() const
{
	bool any = false;
	eachBreaking([&](size_t, int) { return any = true; });
	return any;
}

void Solver::breakLinks()
{
	Store&                                   S = store;
	std::vector<std::pair<int32_t, int32_t>> pairs; // (automaton, link)
	std::vector<int32_t>                     touched;
	eachBreaking([&](size_t i, int k) {
		pairs.push_back({ int32_t(i), k });
		touched.push_back(int32_t(i)), touched.push_back(S.neighbour[linkSlot(i, k)]);
		return false;
	});
	std::sort(touched.begin(), touched.end());
	touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
	// the volume at the present positions, as all links measure it: the work of the last move must not be lost
	std::vector<double> J;
	for (int32_t i : touched)
		J.push_back(S.jOff[i] > 0. ? S.jOff[i] * linkDeterminant(i) + S.rest[i] : S.J[i]);
	for (auto [i, k] : pairs) {
		const size_t j = S.neighbour[linkSlot(i, k)];
		if (!((S.flags[i] >> k) & 1)) continue; // seen from the other side before
		S.flags[i] &= ~(1 << k), S.flags[j] &= ~(1 << ((k + 3) % nLinks));
		S.flags[i] |= exposedBit, S.flags[j] |= exposedBit;
		S.blocks[i / blockSize].intact = S.blocks[j / blockSize].intact = false;
		counters.brokenLinks++;
	}
	for (size_t q = 0; q < touched.size(); q++)
		if (options.volumeRule == VolumeRule::affine) keepVolume(touched[q], J[q]);
		else keepSum(touched[q]);
}

double Solver::linkDeterminant(size_t i) const
{
	const Store& S = store;
	double       Fxx = 0, Fxy = 0, Fyx = 0, Fyy = 0;
	for (int k = 0; k < nLinks; k++)
		if ((S.flags[i] >> k) & 1) {
			const int32_t j  = S.neighbour[linkSlot(i, k)];
			const double  dx = S.x[j] - S.x[i], dy = S.y[j] - S.y[i];
			Fxx += linkX[k] * dx, Fyx += linkX[k] * dy, Fxy += linkY[k] * dx, Fyy += linkY[k] * dy;
		}
	return (Fxx * Fyy - Fxy * Fyx) / (9. * sqr(S.diameter[i]));
}

// The remaining links measure the same homogeneous deformation: only the factor in front of det F is set anew, so that J goes on.
void Solver::keepVolume(size_t i, double J)
{
	Store& S = store;
	if (S.jOff[i] == 0.) return;
	const double det = linkDeterminant(i);
	S.jOff[i] = det > minVolume && J > 0. ? (J - S.rest[i]) / det : 0.;
	if (S.jOff[i] == 0.) unsettled.push_back({ int32_t(i), J > 0. ? J : S.J[i] });
}

// The rules that add up distances: the sum at rest takes over what the broken links held.
void Solver::keepSum(size_t i)
{
	Store&       S   = store;
	double       sum = 0;
	const double contact = contacts.size() && S.blocks[i / blockSize].contact ? scratch.sum[i] : 0.;
	for (int k = 0; k < nLinks; k++)
		if ((S.flags[i] >> k) & 1) {
			const int32_t j = S.neighbour[linkSlot(i, k)];
			const double  d = 0.5 * (S.diameter[i] + S.diameter[j]), r2 = sqr(S.x[j] - S.x[i]) + sqr(S.y[j] - S.y[i]), w = (S.flags[i] >> (halfShift + k)) & 1 ? 0.5 : 1.;
			sum += w * (options.volumeRule == VolumeRule::inversePower ? volumeTerm<VolumeRule::inversePower, 2>(d, r2) : volumeTerm<VolumeRule::meanDistance, 2>(d, r2));
		}
	const double mean = options.volumeRule == VolumeRule::inversePower ? 1. / S.J[i] - 1. : std::sqrt(S.J[i]) - 1.;
	S.rest[i]         = sum + contact - mean / S.invN[i];
	if (S.flags[i] & linkBits) return;
	S.rest[i] = 0.;
	unsettled.push_back({ int32_t(i), S.J[i] });
}

// An automaton without links has its volume from its contacts alone. Under pressure their rest distances are set so that the pressure goes on;
// tension cannot: it is released, and booked. With the affine rule contacts have had a volume of their own: the more compressed of the two goes on.
void Solver::settleVolumes()
{
	Store&     S    = store;
	const bool mean = options.volumeRule == VolumeRule::meanDistance, affine = options.volumeRule == VolumeRule::affine;
	for (const auto& entry : unsettled) {
		const int32_t i   = entry.first;
		const double  J   = entry.second;
		const auto    row = std::lower_bound(contacts.rowOwner.begin(), contacts.rowOwner.end(), i);
		const size_t  r   = size_t(row - contacts.rowOwner.begin());
		const bool    any = row != contacts.rowOwner.end() && *row == i;
		const size_t  first = any ? contacts.rowBegin[r] : 0, last = any ? contacts.rowBegin[r + 1] : 0;
		auto distance = [&](size_t c) { return std::sqrt(sqr(S.x[contacts.other[c]] - S.x[i]) + sqr(S.y[contacts.other[c]] - S.y[i])); };
		// only neighbours about as near as in the packing can take over: a far one would push across a gap
		auto   near = [&](size_t c) { return distance(c) < 1.1 * contacts.d[c]; };
		int    n   = 0;
		double sum = 0;
		for (size_t c = first; c < last; c++) {
			const double r2 = sqr(distance(c));
			n += near(c);
			if (affine && pushes(r2, contacts.rest[c], contacts.d[c]) > 0.) sum += volumeTerm<VolumeRule::inversePower, 2>(contacts.rest[c], r2);
		}
		const double Jc = 1. / (1. + sum / nLinks);
		const bool   holds = n >= 3 && J < Jc;
		const double need = mean ? (std::sqrt(J) - 1.) / (n * S.invN[i]) : (1. / J - 1.) / (n * S.invN[i]);
		if (holds || !affine)
			for (size_t c = first; c < last; c++) {
				const double r0 = distance(c);
				if (!holds || !near(c)) contacts.rest[c] = std::min(r0, contacts.d[c]);
				else contacts.rest[c] = mean ? r0 / (1. + need) : r0 * std::sqrt(1. + need);
			}
		const bool heat = S.materials[S.species[S.speciesOf(i)].material].eos.heats(); // its volumetric energy is in the heat
		if (options.account && holds) sums.fracture += affine ? stateEnergy(i, Jc) : 0.;
		if (options.account && !holds && !heat) sums.fracture += stateEnergy(i, J);
		if (holds) continue;
		// what the contacts' own volume (5) had stored is from now on part of the internal energy
		if (heat && affine) S.heat[i] += stateEnergy(i, Jc) / (S.cell[i] * S.materials[S.species[S.speciesOf(i)].material].eos.rho0);
		for (int k = 0; k < nLinks; k++) // stresses go on
			S.s[linkSlot(i, k)] *= Jc / S.J[i], S.tau[linkSlot(i, k)] *= Jc / S.J[i];
		for (size_t c = first; c < last; c++)
			contacts.s[c] *= Jc / S.J[i], contacts.tau[c] *= Jc / S.J[i];
		S.J[i] = Jc;
		if (heat && affine) S.P[i] = pressure(S.materials[S.species[S.speciesOf(i)].material].eos, Jc - 1.); // that of its contacts
	}
	unsettled.clear();
}
}
