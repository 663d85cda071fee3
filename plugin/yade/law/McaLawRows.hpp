// SPDX-License-Identifier: GPL-2.0-or-later
// The loop of McaLaw over automata and pairs, written plainly. Compiled for the plane and for space; what differs in kind stands in McaPhysSides.
#pragma once
#include "McaLawLoop.hpp"
#include "McaPhysSides.hpp"
#include "automata/solver.hpp"
#include <map>

namespace yade {
namespace MCA_SPACE {

class Loop final : public McaLawLoop {
public:
	explicit Loop(McaLaw& l)
		: law(l)
	{
	}
	int      dimension() const override { return mca::dim; }
	void     step(Scene*) override;
	void     addForces(Scene*) override;
	Energies energies(Scene&) const override;
	Real     stepAtRest(const mca::Material&, Real diameter, Real J) const override;

	/// One side of a pair; p is null where there is none.
	struct Side {
		McaPhys* p     = nullptr;
		int      side  = 0;
		int      other = -1; ///< place in rows
	};
	struct Row {
		int                  id = 0;
		int                  mask = 1;
		State*               state    = nullptr;
		const McaMat*        mat      = nullptr;
		McaState*            m        = nullptr;
		McaLawState*         l        = nullptr;
		const mca::Material* material = nullptr;
		Real                 d        = 0; ///< diameter [m]
		Side                 link[mca::nLinks];
		int                  firstContact = 0, lastContact = 0; ///< in contacts, ascending ids
		vector<Side>         lost;                              ///< links that have broken in this step
		Real                 curvature = 0;                     ///< second difference of the volume
		Vector3r             velocity = Vector3r::Zero(), spin = Vector3r::Zero(); ///< of the last move [m/s], [rad/s]
		bool                 fresh  = false;            ///< has made no move
		// of this step
		Real   limit = 0, stiff = 0, closing = 0, turning = 1, nearestLink = 1, nearestContact = 1;
		bool   clampedNow = false, bad = false;
		Real   plastic = 0, coupling = 0, friction = 0, heated = 0;
	};

private:
	McaLaw&                    law;
	using MaskTable = std::map<int, int>; ///< Body.mask -> a body that has it
	vector<std::pair<Real, int>> newtonsGood; ///< damping and mask
	MaskTable                  automataGood, othersGood;
	vector<Row>                rows;  ///< automata, ascending ids
	vector<int>                place; ///< of body ids in rows, or -1
	vector<Side>               contacts;
	struct Bonded {
		int  row; ///< of the first body
		Side side;
		bool isNew = false; ///< has broken in this step
	};
	vector<Bonded>             bonds; ///< broken pairs that hold together
	vector<std::pair<int, Real>> unsettled;
	vector<int>                relinked; ///< ids whose links have changed because bodies were erased or added
	vector<mca::Material>      materials;
	vector<const McaMat*>      known;
	mca::PairRules             rules; ///< of materials
	int                        materialOf(const Row& r) const { return int(r.material - materials.data()); }
	const mca::PairRule&       ruleOf(const Row& a, const Row& b) const { return rules.of(materialOf(a), materialOf(b)); }
	long                       revision = 0; ///< grows when constants of pairs have changed
	void                       forget();
	void                       lastMotion(Row&) const;
	bool                       hasMoved() const;
	McaState&                  checkBody(const Scene&, const Body&) const;
	void                       checkOther(const Body&) const;
	void                       checkUntouched(const Row&) const;
	void                       checkState(const Row&) const;
	void                       checkMasks(const MaskTable& automata, const MaskTable& others);
	void                       takeIn(Scene*);
	void                       gather(Scene*);
	void                       readMaterials(Scene*);
	void                       pairConstants(const Row&, const Side&) const;
	void                       findLinks(Scene*);
	void                       keepVolumes(Scene*);
	void                       findContacts(Scene*);
	bool                       breaks(const Row&, int k) const;
	mca::LinkEnd               linkEnd(const Row&, int k) const;
	bool                       mayHoldOn(const Row&, int k) const;
	mca::Breaking              breaking(const Row&, int k) const;
	bool                       bond(const Row& first, int k, bool mayHold);
	void                       pullTogether(bool account);
	void                       checkCohesion() const;
	void                       breakLinks();
	void                       unlink(Row&, const Side&, int k, bool holdsOn);
	Real                       determinantNow(const Row&) const;
	void                       keepVolume(int i, Real J);
	void                       settleVolumes(bool account);
	Real                       distance2(const Row&, const Side&) const;
	Real                       distance(const Row& r, const Side& s) const { return std::sqrt(distance2(r, s)); }
	void                       contactVolume(Row&);
	void                       filterVolumes(bool account);
	void                       volume(Row&, bool withContacts);
	template <mca::EosKind law> void       volumeBy(Row&, bool withContacts);
	void                       stress(Row&);
	Vec                        between(const Row&, const Side&) const;
	mca::VolumeRule            rule() const { return law.rule(); }
	struct Moved {
		Vec  distance; ///< [m]
		Turn spin, own; ///< pairSpin(), and that of the automaton itself [-]
	};
	bool                       isFresh(const Row& r, const Side& s) const { return r.fresh || rows[size_t(s.other)].fresh; }
	Moved                      moved(const Row&, const Side&) const;
	Trial                      trial(const Row&, const Side&, Stress old, const Apart&) const;
	Deviator                   deviatorOf(const Row&) const;
	Real                       deviatorEnergyAt(const Row&) const;
	void                       fractureCriterion(Row&, Real dEqps, Real dt) const;
	void                       finishPressure(Row&) const;
	void                       contactFriction(Row&, const Side&, Stress before, Real scale);
	[[noreturn]] void          overlapError(const Row&, const Side&, Real ratio) const;
	void                       scaleStresses(const Row&, Real ratio);
	void                       checkResults();
	Real                       coldEnergyAt(const Row&, Real J) const;
	Real                       contactEnergyAt(const Row&, Real Jc) const;
	void                       bookEnergies(Scene*);
	int                        energyIndex[8] = { -1, -1, -1, -1, -1, -1, -1, -1 };
};

/// Throws mca::Error of these parts.
template <class... Part> [[noreturn]] void refuse(const Part&... part)
{
	std::ostringstream s;
	(s << ... << part);
	throw mca::Error(s.str());
}
/// How masses, areas and forces are given in messages.
inline const char* perThickness(const char* inPlane, const char* inSpace) { return mca::dim == 2 ? inPlane : inSpace; }
inline mca::Flags  flagsOf(const McaLawState& l) { return mca::Flags(l.flags); }
} // namespace MCA_SPACE
} // namespace yade
