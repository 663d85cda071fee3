// SPDX-License-Identifier: GPL-2.0-or-later
// The pair of automata in YADE's InteractionLoop: physics, its functors, and the law that turns pair stresses into forces.
#pragma once
#include "McaMat.hpp"
#include <core/Dispatching.hpp>
#include <pkg/common/NormShearPhys.hpp>

namespace yade {
class McaPhys;

/// What differs between pairs in plane strain and in space: compiled for each, in law/.
class McaPairLaw {
public:
	virtual ~McaPairLaw() = default;
	static const McaPairLaw& in(int dimension);
	/// Force of a pair of automata, its torques and what the account needs of it, into p.
	virtual void force(McaPhys& p, const State& a, const McaLawState& la, const State& b, const McaLawState& lb) const = 0;
	/// Whether two automata are tested for contact: both have a free side, or one has and is no part of the other's body (debris, or another mask).
	virtual bool mayTouch(const Body& a, const McaLawState& la, const Body& b, const McaLawState& lb) const = 0;
	/// Area of a contact of an automaton of this diameter [m, in space m2].
	virtual Real width(Real diameter) const = 0;
	virtual int  links() const = 0; ///< places of links
	/// Whether what a file says of the links of an automaton is possible.
	virtual bool fits(const McaLawState&) const = 0;
};

class McaPhys : public NormShearPhys {
public:
	/// This side pushes: it is closer than its rest distance, which is not that of automata that slid into each other.
	bool pushes(int side, Real r2) const;
	bool touching(Real r2) const { return pushes(0, r2) || pushes(1, r2); }
	/// A broken pair that still holds together.
	bool       bonded() const { return bondLast > 0; }
	/// Where two that are found closer than their diameters start without push [m].
	void startContact(Real r);
	/// Penalty contact of an automaton of diameter d [m] with a rigid body.
	void setWall(const McaMat& m, Real otherAngle, Real d, int dimension);
	/// Functors run in a parallel region, where nothing may be thrown: they leave the first error here, and McaForces throws it before anything moves.
	static void   leaveError(const string& what);
	static string takeError(); ///< empty when there is none
	static bool   linking; ///< McaLaw makes links: pairs that are made now need no search
	void          postLoad(McaPhys&); ///< what is used as an index
	// of McaLaw: the materials that the constants of the pair are made of, and which state of them
	const Material* madeOf[2] = { nullptr, nullptr };
	long            revision  = -1;
	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS_CTOR(McaPhys, NormShearPhys,
		"Pair of two automata, or of an automaton and a body that is none (facet, wall, box, grain). Pairs of numbers belong to the first and second "
		"body. "
		"normalForce and shearForce are the parts of the force on the second body along and across the line of centres [N/m]. All attributes are "
		"outputs of :yref:`McaLaw` and the functors; the "
		"constants of the pair follow its materials from step to step.",
		((bool, linked, false, Attr::readonly, "the link holds; only McaLaw makes links, so a broken pair stays broken"))
		((bool, active, false, Attr::readonly, "not linked, and both automata may touch something"))
		((bool, wall, false, Attr::readonly, "one body is no automaton: penalty contact kn, ks with Coulomb friction"))
		((bool, half, false, Attr::readonly, "link that counts half: along a weighted rim, or with one triangle of its body beside it"))
		((int, slot, 0, Attr::readonly, "place of the link around the first body, 60 slot degrees in the frame of the packing; (slot + 3) % 6 around "
		    "the second. In space 0-11, (slot + 6) % 12 around the second"))
		((Vector2r, s, Vector2r::Zero(), Attr::readonly, "J times normal deviatoric stress of each side [Pa]; in plane strain"))
		((Vector2r, tau, Vector2r::Zero(), Attr::readonly, "J times shear stress of each side [Pa]; in plane strain"))
		((Vector3r, traction, Vector3r::Zero(), Attr::readonly, "J times traction of the first side, of links beside deviators (S4) [Pa]; in space"))
		((Vector3r, tractionOther, Vector3r::Zero(), Attr::readonly, "the same of the second side [Pa]"))
		((Vector2r, rest, Vector2r::Zero(), Attr::readonly, "contact: rest distance of each side [m]"))
		((Real, d, 0, Attr::readonly, "mean diameter [m]"))
		((Real, arm, 0.5, Attr::readonly, "arm of the first body over the distance [-]"))
		((Real, twoG, 0, Attr::readonly, "pair shear stiffness 2G, in series [Pa]"))
		((Real, friction, 0, Attr::readonly, "Coulomb coefficient [-], the smaller of both"))
		((Real, viscLinear, 0, Attr::readonly, "rho c1 c, the smaller of both [Pa s/m]"))
		((Real, viscQuadratic, 0, Attr::readonly, "rho c2, the smaller of both [Pa s2/m2]"))
		((Vector3r, force, Vector3r::Zero(), Attr::readonly, "force of this step on the first body, the second has its negative [N/m, in space N]"))
		((Vector3r, torque, Vector3r::Zero(), Attr::readonly, "torque on the first body [N, in space N m]; in plane strain about z alone"))
		((Vector3r, torqueOther, Vector3r::Zero(), Attr::readonly, "torque on the second body [N, in space N m]"))
		((Vector3r, opening, Vector3r::Zero(), Attr::readonly, "of a broken pair that holds together (11f): in plane strain along the pair, across it, "
		    "0; in space from the first to the second body [m]"))
		((Real, bondRest, 0, Attr::readonly, "distance at which it is closed [m]"))
		((Real, bondStiffness, 0, Attr::readonly, "pull over the opening before it softens [N/m2, in space N/m]"))
		((Real, bondFirst, 0, Attr::readonly, "opening from which on it softens [m]"))
		((Real, bondLast, 0, Attr::readonly, "opening at which it parts [m]; 0: it holds nothing"))
		((Real, bondMost, 0, Attr::readonly, "widest opening so far [m]"))
		((Vector3r, pull, Vector3r::Zero(), Attr::readonly, "share of force that is cohesion [N/m, in space N]"))
		((Vector3r, pullTorque, Vector3r::Zero(), Attr::readonly, "the same of torque [N, in space N m]"))
		((Vector3r, pullTorqueOther, Vector3r::Zero(), Attr::readonly, "the same of torqueOther [N, in space N m]"))
		((Real, heatRate, 0, Attr::readonly, "power of the pair viscosity [W/m, in space W]"))
		((Vector3r, viscousForce, Vector3r::Zero(), Attr::readonly, "share of the viscosity in force [N/m, in space N]"))
		,
		createIndex();
	)
	// clang-format on
	REGISTER_CLASS_INDEX(McaPhys, NormShearPhys);
};
REGISTER_SERIALIZABLE(McaPhys);

class Ip2_McaMat_McaMat_McaPhys : public IPhysFunctor {
public:
	void go(const shared_ptr<Material>& m1, const shared_ptr<Material>& m2, const shared_ptr<Interaction>& I) override;
	FUNCTOR2D(McaMat, McaMat);
	// clang-format off
	YADE_CLASS_BASE_DOC(Ip2_McaMat_McaMat_McaPhys, IPhysFunctor, "Makes :yref:`McaPhys` of two automata. A body with McaMat that is no Sphere is a wall. "
	    "No attributes of its own.")
	// clang-format on
};
REGISTER_SERIALIZABLE(Ip2_McaMat_McaMat_McaPhys);

class Ip2_FrictMat_McaMat_McaPhys : public IPhysFunctor {
public:
	void go(const shared_ptr<Material>& m1, const shared_ptr<Material>& m2, const shared_ptr<Interaction>& I) override;
	void goReverse(const shared_ptr<Material>& m1, const shared_ptr<Material>& m2, const shared_ptr<Interaction>& I) override { go(m2, m1, I); }
	FUNCTOR2D(FrictMat, McaMat);
	DEFINE_FUNCTOR_ORDER_2D(FrictMat, McaMat);
	// clang-format off
	YADE_CLASS_BASE_DOC(Ip2_FrictMat_McaMat_McaPhys, IPhysFunctor,
		"Makes :yref:`McaPhys` of an automaton and a facet, wall, box or grain of FrictMat: a penalty contact of the automaton's moduli, kn = (K + "
		"4G/3) S0/(d/2) and "
		"ks = G S0/(d/2) [N/m per m, in space N/m], with the smaller friction of both. The other body is taken as rigid. "
		"Either order of the two bodies will do. The materials are read when the pair is made, "
		"and anew when a McaMat has changed.")
	// clang-format on
};
REGISTER_SERIALIZABLE(Ip2_FrictMat_McaMat_McaPhys);

class Law2_ScGeom_McaPhys_Mca : public LawFunctor {
public:
	bool go(shared_ptr<IGeom>& geom, shared_ptr<IPhys>& phys, Interaction* I) override;
	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS(Law2_ScGeom_McaPhys_Mca, LawFunctor,
		"Force of a pair from the pressures and pair stresses that :yref:`McaLaw` has found, and its viscosity; of an automaton and a wall from the "
		"overlap. It leaves the force in "
		"the pair, :yref:`McaForces` adds it to the bodies in a fixed order. Pairs that are farther apart than range are forgotten.",
		((Real, range, 1.45, , "distance at which a contact is given up, over the diameter [-], 1.1 to 10; above the interactionDetectionFactor of "
		    "Ig2_Sphere_Sphere_ScGeom. Read in every step"))
	)
	// clang-format on
	FUNCTOR2D(ScGeom, McaPhys);
};
REGISTER_SERIALIZABLE(Law2_ScGeom_McaPhys_Mca);
} // namespace yade
