// SPDX-License-Identifier: GPL-2.0-or-later
// Breaking of links: rare, so serial and in the order of the arrays; the test costs nothing where no criterion is near.
// A break changes no volume and creates no energy: what the links had measured goes on as the rest state of what is left.
#include "../kernels/automaton/energy.hpp"
#include "solver.hpp"
#include <algorithm>
#include <cmath>

namespace mca::automata {

double Solver::coldEnergyAt(size_t i, double J) const { return coldEnergy(store.materialOf(i), store.cell[i], J); }
/// Of the volume that contacts give it, if it has links: in the affine rule a volume of its own.
double Solver::contactEnergyAt(size_t i, double Jc) const
{
	const double part = mirrorShare(store, i); // of what it is beyond planes of symmetry, too
	return coldEnergy(store.materialOf(i), contactCell(store.diameter[i], store.cell[i] / part, 1.) * part, Jc);
}

LinkEnd Solver::linkEnd(size_t i, int k) const
{
	const Store& S = store;
	const double normal = normalStressAt(S, i, k, S.between(i, size_t(S.neighbour[linkSlot(i, k)])));
	return { S.criterion[i], normal, S.J[i], S.mean[i], S.strength[i] };
}

/// f(automaton, link) for the pairs that fulfil a criterion, until it returns true.
template <class F> void Solver::eachBreaking(F&& f) const
{
	const Store& S   = store;
	for (int32_t b : awake) {
		const Material& m = S.materialOf(S.blocks[b]);
		const auto      weak = S.pairRules.weakest(S.species[size_t(S.blocks[b].species)].material);
		if (!m.fracture.active() && !weak.tension) continue;
		const bool pairStress = std::isfinite(m.fracture.pairStress) || weak.tension;
		const bool close = results[b].nearest < sqr(collapsed);
		if (results[b].criterion < weak.strength && !pairStress && !close) continue;
		for (int l = 0; l < S.blocks[b].count; l++) {
			const size_t i = size_t(b) * blockSize + l;
			if (!(S.flags[i] & linkBits) || (S.criterion[i] < weak.strength && !pairStress && !close)) continue;
			for (int k = 0; k < nLinks; k++) {
				if (!holds(S.flags[i], k)) continue;
				const size_t j = S.neighbour[linkSlot(i, k)];
				if (!m.fracture.active() && !std::isfinite(S.ruleOf(S.speciesOf(i), S.speciesOf(j)).tension)) continue;
				const LinkEnd a = linkEnd(i, k), b = linkEnd(j, Lattice::opposite(k));
				if (mca::breaks(m.fracture, a, b, S.distance2(i, j), S.restDistance(i, j), S.ruleOf(S.speciesOf(i), S.speciesOf(j)))
				    && f(i, k))
					return;
			}
		}
	}
}

bool Solver::breaking() const
{
	bool any = false;
	eachBreaking([&](size_t, int) { return any = true; });
	return any;
}

/// Returns the ends of those that broke, ascending.
std::vector<int32_t> Solver::breakLinks()
{
	Store&                                   S = store;
	std::vector<std::pair<int32_t, int32_t>> pairs; // (automaton, link)
	std::vector<BreakCause>                  causes;
	std::vector<int32_t>                     touched;
	const auto                               add = [&](size_t i, int k, BreakCause cause) {
                pairs.push_back({ int32_t(i), k }), causes.push_back(cause);
                touched.push_back(int32_t(i)), touched.push_back(S.neighbour[linkSlot(i, k)]);
	};
	for (size_t q = 0; q < asked.size(); q += 2) {
		const size_t i = size_t(place[size_t(asked[q])]);
		if (const int k = linkOf(i, size_t(place[size_t(asked[q + 1])])); k >= 0) add(i, k, BreakCause::cut);
	}
	asked.clear();
	if (counters.steps % breakPeriod == 0)
		eachBreaking([&](size_t i, int k) {
			add(i, k, causeAt(i, k));
			return false;
		});
	std::sort(touched.begin(), touched.end());
	touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
	// the volume at the present positions, as all links measure it: the work of the last move must not be lost
	std::vector<double> J;
	for (int32_t i : touched)
		J.push_back(S.factor[i] > 0. ? S.factor[i] * determinantNow(i) + S.rest[i] : S.J[i]);
	for (size_t q = 0; q < pairs.size(); q++) {
		const auto [i, k] = pairs[q];
		const size_t j = S.neighbour[linkSlot(i, k)];
		if (!holds(S.flags[i], k)) continue; // seen from the other side before
		noteBreak(i, k, causes[q]);
		const bool holdsOn = bondAt(i, k, causes[q]);
		unlink(i, k, !holdsOn), unlink(j, Lattice::opposite(k), !holdsOn);
		if (holdsOn) leavePush(i, k), leavePush(j, Lattice::opposite(k));
		counters.brokenLinks++;
	}
	for (size_t q = 0; q < touched.size(); q++)
		keepVolume(touched[q], J[q]);
	return touched;
}

size_t Solver::cut(const std::vector<std::pair<int32_t, int32_t>>& pairs)
{
	if (!options.contacts) throw Error("cut: contacts=False, and links break only where contacts can take their place.");
	size_t hold = 0;
	for (const auto& [a, b] : pairs) {
		for (int32_t id : { a, b })
			if (indexOf(id) < 0) throw Error("cut: body " + std::to_string(id) + " is no automaton of this engine.");
		if (linkOf(size_t(indexOf(a)), size_t(indexOf(b))) < 0) continue;
		asked.push_back(a), asked.push_back(b);
		hold++;
	}
	return hold;
}

/// The link of automaton i that leads to j, -1: none that holds.
int Solver::linkOf(size_t i, size_t j) const
{
	for (int k = 0; k < nLinks; k++)
		if (holds(store.flags[i], k) && size_t(store.neighbour[linkSlot(i, k)]) == j) return k;
	return -1;
}

BreakCause Solver::causeAt(size_t i, int k) const
{
	const Store& S = store;
	const size_t j = size_t(S.neighbour[linkSlot(i, k)]);
	const auto   apart = [&](size_t q) {
		return CriteriaApart(
			Criteria(S.materialOf(i).fracture), S.eqps[q], S.mean[q], equivalentStress(q), S.damage.empty() ? 0. : S.damage[q], S.strength[q]);
	};
	const PairRule& rule = S.ruleOf(S.speciesOf(i), S.speciesOf(j));
	return mca::causeOf(linkEnd(i, k), linkEnd(j, Lattice::opposite(k)), apart(i), apart(j), S.distance2(i, j), S.restDistance(i, j), rule);
}

void Solver::noteBreak(size_t i, int k, BreakCause cause)
{
	const Store&      S = store;
	const size_t      j = size_t(S.neighbour[linkSlot(i, k)]), n = broken.time.size();
	const bool        turn = S.id[j] < S.id[i]; // the smaller number first
	const Vec<double> r = S.between(i, j), along = r * ((turn ? -1. : 1.) / std::sqrt(plainSquare(r)));
	broken.time.push_back(time), broken.first.push_back(turn ? S.id[j] : S.id[i]), broken.second.push_back(turn ? S.id[i] : S.id[j]);
	broken.cause.push_back(int32_t(cause));
	broken.middle.resize(n + 1), broken.normal.resize(n + 1);
	broken.middle.set(n, S.position.at(i) + r * 0.5), broken.normal.set(n, along);
}

/// One end of a link that breaks. It stays known as one that has held; its stresses go on in the contact. books: what is lost is not booked elsewhere.
void Solver::unlink(size_t i, int k, bool books)
{
	Store&       S      = store;
	const size_t at     = linkSlot(i, k), j = size_t(S.neighbour[at]);
	const double weight = linkWeight(S.flags[i], k), twoG = S.pairTwoG(S.speciesOf(i), j, arm(S.diameter[i], S.diameter[j]));
	if (options.account && books) sums.fracture += lostAtBreak(S.diameter[i], weight, pairEnergy(S.stressAt(at), S.J[i], twoG));
	S.setStress(at, scaled(S.stressAt(at), weight));
	S.flags[i] = withoutTriangles(S.flags[i] & ~(Flags(1) << k | Flags(1) << (halfShift + k))) | exposedBit;
	S.blocks[i / blockSize].intact = false;
}

/// det F of the links that hold, at the present positions.
double Solver::determinantNow(size_t i) const
{
	return linkDeterminant(measured(store, i), Lattice::perVolume(store.diameter[i]));
}

// Affine rule: the remaining links measure the same homogeneous deformation; only the factor in front of det F is set anew, so that J goes on.
// The rules that add up distances: the sum at rest takes over what the broken links held.
void Solver::keepVolume(size_t i, double J)
{
	Store& S = store;
	if (options.volumeRule == VolumeRule::affine) {
		if (S.factor[i] == 0.) return;
		S.factor[i] = affineFactor(J, S.rest[i], determinantNow(i));
		if (S.factor[i] > 0.) return;
		unsettled.push_back({ int32_t(i), J > 0. ? J : S.J[i] });
		const double held = deviatorEnergyOf(i);
		deviatorToSides(S, i);
		if (options.account) sums.fracture += held - deviatorEnergyOf(i);
		return;
	}
	dispatch(options.volumeRule, [&](auto rule) {
		double       sum     = 0;
		const double contact = contacts.size() && S.blocks[i / blockSize].contact ? scratch.sum[i] : 0.;
		for (int k = 0; k < nLinks; k++)
			if (holds(S.flags[i], k)) {
				const int32_t j = S.neighbour[linkSlot(i, k)];
				sum += linkWeight(S.flags[i], k) * volumeTerm<rule.value>(S.restDistance(i, j), S.distance2(i, j));
			}
		S.rest[i] = restKeeping<rule.value>(S.J[i], sum + contact, S.invN[i]);
	});
	if (S.flags[i] & linkBits) return;
	S.rest[i] = 0.;
	unsettled.push_back({ int32_t(i), S.J[i] });
}

// See Settling: what has lost its volume has it from its contacts from now on; what cannot go on is released, and booked.
void Solver::settleVolumes()
{
	Store&           S    = store;
	Contacts&        C    = contacts;
	const VolumeRule rule = options.volumeRule;
	const bool       affine = rule == VolumeRule::affine;
	for (const auto& entry : unsettled) {
		const int32_t i     = entry.first;
		const double  J     = entry.second;
		const auto    row   = std::lower_bound(C.rowOwner.begin(), C.rowOwner.end(), i);
		const size_t  r     = size_t(row - C.rowOwner.begin());
		const bool    any   = row != C.rowOwner.end() && *row == i;
		const size_t  first = any ? C.rowBegin[r] : 0, last = any ? C.rowBegin[r + 1] : 0;
		const auto    distance = [&](size_t c) { return std::sqrt(S.distance2(i, C.other[c])); };
		int           near     = 0;
		double        sum      = 0;
		for (size_t c = first; c < last; c++) {
			const double r2 = S.distance2(i, C.other[c]);
			near += Settling::isNear(distance(c), C.d[c]);
			if (affine && pushes(r2, C.rest[c], C.d[c]) > 0.) sum += volumeTerm<ofContacts(VolumeRule::affine)>(C.rest[c], r2);
		}
		const Material& m  = S.materialOf(size_t(i));
		const double    Jc = contactRatio(sum);
		const Settling  s(rule, J, Jc, near, S.invN[i]);
		if (s.holds || !affine)
			for (size_t c = first; c < last; c++)
				C.rest[c] = s.restDistance(rule, distance(c), C.d[c]);
		const bool heat = m.eos.heats(); // its volumetric energy is in the heat
		if (options.account && s.holds) sums.fracture += affine ? contactEnergyAt(i, Jc) : 0.;
		if (options.account && !s.holds && !heat) sums.fracture += coldEnergyAt(i, J) + (affine ? contactEnergyAt(i, Jc) - coldEnergyAt(i, Jc) : 0.);
		if (s.holds) continue;
		// what the contacts' own volume (5) had stored is from now on part of the internal energy
		if (heat && affine) S.heat[i] += contactEnergyAt(i, Jc) / (S.cell[i] * m.eos.rho0);
		scaleStresses(i, Jc / S.J[i]); // stresses go on
		for (size_t c = first; c < last; c++)
			setSide(C, c, scaled(sideOf(C, c), Jc / S.J[i]));
		S.J[i] = Jc;
		if (heat && affine) S.P[i] = S.mean[i] = pressure(m.eos, Jc - 1.); // that of its contacts
	}
	unsettled.clear();
}

/// Those of all links of an automaton, kept as J times the stress.
void Solver::scaleStresses(size_t i, double ratio)
{
	for (int k = 0; k < nLinks; k++)
		store.setStress(linkSlot(i, k), scaled(store.stressAt(linkSlot(i, k)), ratio));
}
}
