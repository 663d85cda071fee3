// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <core/State.hpp>
#include <pkg/common/ElastMat.hpp>
#include "kernels/material.hpp"
#include <map>

namespace yade {

class McaLawState : public Serializable {
public:
	void postLoad(McaLawState&); ///< what is used as an index
	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS(McaLawState, Serializable, "What :yref:`McaLaw` keeps of an automaton from step to step.",
		((int, dimension, 2, Attr::readonly, "2 in plane strain, 3 in space, where units per thickness are without it"))
		((long, flags, 0, Attr::readonly, "bits 0-5: link k holds; 8-13: it counts half; 16-21: it once held; 24: the automaton may touch something; "
		    "26-31: the triangle between links k and k + 1 belongs to the body, of an automaton at an outline (5g). In space fields of 16 bits: 0-11, "
		    "16-27, 32-43, 48; 50-61: the link counts a quarter"))
		((vector<int>, partner, , Attr::readonly, "body at the other end of link k; -1: never linked [6, in space 12]"))
		((Real, cell, 0, Attr::readonly, "volume at rest, Omega0 times weight [m2]"))
		((Real, invN, 0, Attr::readonly, "1 / number of slots [-]"))
		((Real, rest, 0, Attr::readonly, "sum of the volume rule at rest [-]"))
		((Real, factor, 0, Attr::readonly, "affine rule: J = factor det F; 0: too few links to have a volume [-]"))
		((Real, P, 0, Attr::readonly, "pressure of the equation of state [Pa]"))
		((Real, dTheta, 0, Attr::readonly, "last increment of the volume strain [-]"))
		((Real, viscous, 0, Attr::readonly, "viscous pressure of the last move [Pa]"))
		((Real, viscousShare, 0, Attr::readonly, "share of the viscous pressure in push [-]"))
		((Matrix3r, push, Matrix3r::Zero(), Attr::readonly, "affine rule: link k is pushed by push e_k, at outlines by push c_k (5g), in the frame of "
		    "the packing [N/m]; in space by (pushPressure + pushStress) push e_k, push in m2"))
		((Real, pushPressure, 0, Attr::readonly, "in space: pressure of the equation of state and of the viscosity, J times [Pa]"))
		((Matrix3r, pushStress, Matrix3r::Zero(), Attr::readonly, "in space: minus the deviator, and what the sides of pairs do with the deformation "
		    "(S6), J times [Pa]"))
		((Matrix3r, deviator, Matrix3r::Zero(), Attr::readonly, "in space: deviator of the stress (S4) [Pa]"))
		((Real, pressureShare, 0, Attr::readonly, "pressure share of rule (6), of contacts in the affine rule [N/m]"))
		((int, rule, 0, Attr::readonly, "volume rule: 0 affine, 1 inversePower, 2 meanDistance"))
		((Real, contactSum, 0, Attr::readonly, "volume terms of the contacts [-]"))
		((Real, diameter, 0, Attr::readonly, "with which the automaton was taken in [m]"))
		((int, triangles, 0, Attr::readonly, "state.triangles with which it was taken in"))
		((bool, acrossMasks, false, Attr::readonly, "McaLaw.linkAcrossMasks with which it was taken in"))
		((Real, moved, 0, Attr::readonly, "time step that led to the present position [s]"))
		((Vector3r, from, Vector3r::Zero(), Attr::readonly, "position before the last move [m]"))
		((Quaternionr, fromOri, Quaternionr::Identity(), Attr::readonly, "orientation before the last move"))
		((Vector3r, expected, Vector3r::Zero(), Attr::readonly, "velocity that the last move should have [m/s]: another one was set by a script"))
		((Vector3r, expectedSpin, Vector3r::Zero(), Attr::readonly, "the same of the spin [rad/s]"))
		((Vector3r, results, Vector3r(0, 1, 0), Attr::readonly, "pressure [Pa], volume ratio [-] and stressZZ [Pa] as the law has left them"))
		((Real, criterion, 0, Attr::readonly, "largest fracture criterion over its limit [-]; a pair breaks at a mean of 1"))
	)
	// clang-format on
};
REGISTER_SERIALIZABLE(McaLawState);

class McaState : public State {
public:
	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS_CTOR(McaState, State, "State of an automaton. :yref:`McaEngine` fills it when it writes back to the bodies.",
		((Real, pressure, 0, , "mean pressure, positive in compression [Pa]: that of the equation of state, in the affine rule "
		    "with what the deviators of the sides do with the volume (5f) but at outlines (5g), without viscosity; output"))
		((Real, volumeRatio, 1, , "J = volume / volume at rest [-]; output"))
		((Real, equivalentStress, 0, , "Mises stress [Pa]; output"))
		((Real, plasticStrain, 0, , "equivalent plastic strain [-]; read at every look (at the start as initial hardening), by :yref:`McaLaw` in "
		    "every step"))
		((Real, damage, 0, , "of plastic flow by the material's damageModel (11e) [-]; a pair breaks at a mean of 1 (times the strength); read at "
		    "every look (at the start as damage from before), by :yref:`McaLaw` in every step; other than 0 without a damageModel is refused"))
		((Real, temperature, 298, , "temperature, for flow stresses that depend on it [K]; material.newAssocState() sets the reference temperature; "
		    "read at every look, by :yref:`McaLaw` in every step"))
		((Real, stressZZ, 0, , "deviatoric stress along z, in plane strain out of the plane [Pa]; output"))
		((Real, dissipated, 0, , "internal energy per mass, kept where the equation of state depends on it [J/kg]; output, read in every step by "
		    ":yref:`McaLaw`"))
		((Real, strength, 0, , "factor on the strengths of the material [-]; 0 when the automaton is taken in: drawn by the engine from the "
		    "material's distribution and the engine's seed; read at every look, by :yref:`McaLaw` in every step"))
		((int, triangles, 0, , "of the six triangles of the packing around it, those that it stands for, 1 to 6, where its body shall end through "
		    "the centres of its outermost automata (5g); packings.addBodies() sets it for rim='triangles'. 0: what its mass says. Read when "
		    "automata are taken in, which is refused when neighbours or mass make another number; a change later is refused"))
		((int, mirrors, 0, , "planes of symmetry on which it lies: 1, 2, 4 for one with its normal along x, y, z, summed; beyond it the body goes on "
		    "as its image. In space only; packings.addBodies() sets it for fcc(mirror=...), with the mass of the part of the cell on this side and "
		    "blockedDOFs. Read when automata are taken in; a change later is refused"))
		((int, links, 0, , "links that hold [-]; output"))
		((int, brokenLinks, 0, , "links that broke [-]; output"))
		((shared_ptr<McaLawState>, law, , Attr::hidden, "what :yref:`McaLaw` keeps of the automaton; empty with McaEngine"))
		,
		createIndex();
	)
	// clang-format on
	REGISTER_CLASS_INDEX(McaState, State);
};
REGISTER_SERIALIZABLE(McaState);

// attributes of the laws' constants, and the names a law can have, from plugin/kernels/laws/list.hpp
#define MCA_ATTRIBUTE(name, unit, start, range, text) ((Real, name, start, , text " [" unit "]; read at every look, by a grid when the block is added"))
#define MCA_ATTRIBUTES(name, law, text) MCA_CONSTANTS_##name(MCA_ATTRIBUTE)
#define MCA_CHOICE(name, law, text) " '" #name "' (" text ")"

class McaMat : public FrictMat {
public:
	/// A McaState of the reference temperature.
	shared_ptr<State> newAssocState() const override;
	bool              stateTypeOk(State* s) const override { return dynamic_cast<McaState*>(s) != nullptr; }
	/// Constants for the solvers; throws mca::Error naming the constant that is out of range.
	mca::Material toMaterial() const;
	Real          longitudinalSpeed() const { return toMaterial().cP(); }
	Real          shearSpeed() const { return toMaterial().cS(); }
	Real          yieldAt(Real eqps, Real rate, Real temperature) const;
	Real          pressureAt(Real volumeRatio) const;
	void          postLoad(McaMat&);
	void          pyHandleCustomCtorArgs(py::tuple& args, py::dict& keywords) override;
	/// Sets young and poisson, which stock engines read, from the constants; false while those are not given yet.
	bool derive();
	Real youngNow() { return derive(), young; }
	Real poissonNow() { return derive(), poisson; }
	void setYoung(Real v) { derive(), refuseElastic("young [Pa]", v, young); }
	void setPoisson(Real v) { derive(), refuseElastic("poisson [-]", v, poisson); }
	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS_CTOR_PY(McaMat, FrictMat,
		"Material of automata and of the Lagrangian grid: equation of state, plasticity, fracture, contact, viscosity. "
		"Density [kg/m3] and frictionAngle [rad] are those of :yref:`FrictMat`; young and poisson follow from the constants below and refuse other "
		"values. "
		"All constants are checked before they are used: finite (infinite only where that means 'never') and in range; NaN is refused. "
		":yref:`McaEngine` reads all of them at every look, that is in the first step or call after a script could change something; "
		":yref:`McaGridEngine` when a block is added, never again. "
		":yref:`McaLaw` reads all of them in every step, so that a change between steps counts from the next one on, for links and contacts that "
		"exist as well; strengthSpread and "
		"strengthDistribution are read when strengths are drawn, density moreover when an automaton is taken in.",
		((Real, bulkSoundSpeed, 0, Attr::triggerPostLoad, "c0 of the shock adiabat D = c0 + b U [m/s]; bulk modulus K = density c0^2; read at every "
		    "look, by a grid when the block is added"))
		MCA_EOS_LAWS(MCA_ATTRIBUTES)
		((string, eos, "shockAdiabat", , "equation of state:" MCA_EOS_LAWS(MCA_CHOICE) "; read at every look, by a grid when the block is added"))
		((Real, shearModulus, 0, Attr::triggerPostLoad, "G [Pa]; read at every look, by a grid when the block is added"))
		((string, yieldModel, "elastic", , "flow stress:" MCA_FLOW_LAWS(MCA_CHOICE) "; read at every look, by a grid when the block is added"))
		MCA_FLOW_LAWS(MCA_ATTRIBUTES)
		((Real, referenceTemperature, 298, , "initial and reference temperature [K]; read at every look, by a grid when the block is added"))
		((Real, heatCapacity, 0, , "specific heat [J/kg/K]; 0: no heating; read at every look, by a grid when the block is added"))
		((Real, taylorQuinney, 0.9, , "share of plastic work that becomes heat [-] (Taylor and Quinney 1934); read at every look, by a grid when the "
		    "block is added"))
		((Real, fractureStrain, std::numeric_limits<Real>::infinity(), , "plastic strain of a pair at which it unlinks [-]; read at every look, by a "
		    "grid when the block is added"))
		((Real, spallStrength, std::numeric_limits<Real>::infinity(), , "tensile pressure at which a pair unlinks [Pa]; read at every look, by a "
		    "grid when the block is added"))
		((Real, pairStrength, std::numeric_limits<Real>::infinity(), , "tensile normal stress of a pair at which it unlinks [Pa]; read at every "
		    "look, by a grid when the block is added"))
		((Real, fractureStress, std::numeric_limits<Real>::infinity(), , "Mises stress at which a pair unlinks; with strengthRatio a > 1 the "
		    "two-parameter criterion 0.5 (a+1) sigma_eq + 1.5 (a-1) sigma_mean [Pa]; read at every look, by a grid when the block is added"))
		((Real, strengthRatio, 1, , "a = compressive / tensile strength of the two-parameter criterion [-]; 1: Mises; read at every look, by a grid "
		    "when the block is added"))
		((Real, fractureEnergy, 0, , "G_f, the work per area of crack that a broken pair takes until it has parted [J/m2], (11f): K_Ic^2 (1 - nu^2)/E. "
		    "From the break on its pull falls with its opening. Strength and spacing must fit together, see Material.longestSpacing(); others are "
		    "refused. 0: a broken pair parts at once. Read at every look, of pairs as they break; a grid does not use it"))
		((string, damageModel, "none", , "damage by plastic flow: 'none' or 'johnsonCook' (Johnson and Cook 1985): a pair unlinks where the plastic "
		    "strain over the fracture strain at the triaxiality, rate and temperature it came at sums up to 1, (11e); read at every look; a grid "
		    "does not use it"))
		((Real, damageD1, 0, , "D1 of (11e) [-]; read at every look"))
		((Real, damageD2, 0, , "D2 of (11e), of the exponential of the triaxiality [-]; read at every look"))
		((Real, damageD3, 0, , "D3 of (11e), negative where tension shortens the strain [-]; read at every look"))
		((Real, damageD4, 0, , "D4 of (11e), of the logarithm of the strain rate over referenceRate [-]; read at every look"))
		((Real, damageD5, 0, , "D5 of (11e), of the temperature over its way to melting [-]; read at every look"))
		((Real, strengthSpread, 0, , "relative standard deviation of the strengths from automaton to automaton [-]; read when strengths are drawn, "
		    "that is when a body is taken over for the first time"))
		((string, strengthDistribution, "uniform", , "'uniform', 'normal' (cut at 3 deviations) or 'weibull'; read when strengths are drawn, that is "
		    "when a body is taken over for the first time"))
		((Real, viscosityLinear, 0.25, , "linear artificial viscosity c1 [-]; read at every look, by a grid when the block is added"))
		((Real, viscosityQuadratic, 1.2, , "quadratic artificial viscosity c2 [-]; read at every look, by a grid when the block is added"))
		,
		createIndex();
		,
		.add_property("young", &McaMat::youngNow, &McaMat::setYoung, "Young's modulus [Pa]; output: follows from density, bulkSoundSpeed and "
		    "shearModulus, and another value is refused.")
		.add_property("poisson", &McaMat::poissonNow, &McaMat::setPoisson, "Poisson's ratio [-]; output: follows from density, bulkSoundSpeed and "
		    "shearModulus, and another value is refused.")
		.add_property("cP", &McaMat::longitudinalSpeed, "Longitudinal wave speed at rest [m/s].")
		.add_property("cS", &McaMat::shearSpeed, "Shear wave speed at rest [m/s].")
		.def("flowStress", &McaMat::yieldAt, (py::arg("plasticStrain"), py::arg("rate") = 1., py::arg("temperature") = 298.), "Yield stress [Pa] at "
		    "plastic strain [-], strain rate [1/s] and temperature [K], by yieldModel.")
		.def("pressure", &McaMat::pressureAt, (py::arg("volumeRatio")), "Pressure [Pa] at J = volume / volume at rest [-], by eos without internal "
		    "energy; 'mieGruneisen': on the shock adiabat.")
	)
	// clang-format on
	REGISTER_CLASS_INDEX(McaMat, FrictMat);

private:
	std::map<string, Real> asked; ///< young and poisson given to the constructor
	void                   refuseElastic(const char* what, Real asked, Real derived) const;
};
REGISTER_SERIALIZABLE(McaMat);
} // namespace yade
