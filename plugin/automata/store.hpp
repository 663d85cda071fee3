// SPDX-License-Identifier: GPL-2.0-or-later
// What the automata solver keeps: flat arrays, one entry per automaton, in blocks of 64 that hold one species (material and diameter) each,
// ordered in space. The six links of an automaton are planes of 64 inside its block; contacts are a separate list, since few automata have any.
#pragma once
#include "../kernels/automaton/contact.hpp"
#include "../kernels/automaton/force.hpp"
#include "../kernels/automaton/fracture.hpp"
#include "../kernels/automaton/links.hpp"
#include <algorithm>
#include <cstdint>
#include <vector>

namespace mca::automata {

constexpr int blockSize = 64;
constexpr int nodeSize = 8, pushSize = 4; ///< numbers of the records that neighbours read
/// place of link k of automaton i in the link arrays
inline size_t linkSlot(size_t i, int k) { return ((i / blockSize) * nLinks + k) * blockSize + i % blockSize; }

struct Species {
	int    material = 0;
	double d        = 0; ///< diameter [m]
};

struct Block {
	int32_t species = 0;
	int32_t count   = 0;     ///< automata in it; lanes above are padding
	bool    intact  = false; ///< every lane holds all six links with full weight
	bool    mixed   = false; ///< some link leads to another species
	bool    contact = false; ///< some automaton has contacts
	bool    awake   = true;
	bool    moving  = true; ///< some velocity is or was not exactly zero
	bool    ringsAwake = false; ///< the blocks around it have been woken
};

struct Store {
	// one entry per automaton; SI units per unit thickness
	std::vector<double> x, y, vx, vy, omega, angle;      ///< position [m], velocity [m/s], spin [rad/s], turned angle [rad]
	std::vector<double> mass, inertia;                   ///< [kg/m], [kg m]
	std::vector<double> ax, ay, ar;                      ///< 1/mass, 1/mass, 1/inertia; zero where the degree of freedom is blocked
	std::vector<double> diameter;                        ///< [m]
	std::vector<double> cell, invN, rest;                ///< Omega0 [m2]; 1/N of the volume rule; its sum at rest [-]
	std::vector<double> J, dTheta, P, h;                 ///< volume ratio, its last increment, pressure [Pa], pressure share of (6)
	std::vector<double> factor;                            ///< affine rule: J of the links = factor det F; 0 = too few links to have a volume
	std::vector<double> szz, eqps, temperature;          ///< [Pa], [-], [K]
	std::vector<double> strength;                        ///< factor on the fracture criteria [-]
	std::vector<double> criterion;                       ///< largest criterion / its limit [-]; a pair breaks at a mean of 1
	std::vector<double> heat;                            ///< internal energy per mass, Mie-Grueneisen only [J/kg]
	std::vector<double> fx, fy, torque;                  ///< force of the last computeForces() [N/m], [N]
	std::vector<double> ex, ey, et;                      ///< external force and torque, empty when there is none
	std::vector<double> dampX, dampY;                    ///< viscous boundary rho c A [kg/(m s)], empty when there is none
	std::vector<int32_t> flags, id, group;               ///< Flag bits; caller's number; link group
	std::vector<double> weight;                          ///< share of the full cell [-]
	// links: nLinks planes per block
	std::vector<int32_t> neighbour;                      ///< automaton at the other end, itself where there is none; there the same link is Lattice::opposite(k)
	std::vector<double>  s, tau;                         ///< J times normal and shear pair stress of this side [Pa]
	// records that neighbours read; rebuilt in every step, so not part of the saved state
	std::vector<double>  node; ///< 8 per automaton: x, y, vx, vy, omega, dTheta, 0, 0
	std::vector<double>  push; ///< 4 per automaton, affine rule: link k is pushed by T e_k; Txx, Txy, Tyx, Tyy [N/m]
	/// Copies motion into the records of a block.
	void packBlock(size_t b)
	{
		for (size_t i = b * blockSize; i < (b + 1) * blockSize; i += lanes) {
			scatter4(node.data() + i * nodeSize, nodeSize, load(&x[i]), load(&y[i]), load(&vx[i]), load(&vy[i]));
			scatter4(node.data() + i * nodeSize + 4, nodeSize, load(&omega[i]), load(&dTheta[i]), v8 {}, v8 {});
		}
	}
	/// All records anew: after building, sorting, loading.
	void packAll()
	{
		node.assign(size() * nodeSize, 0.);
		push.resize(size() * pushSize, 0.);
		for (size_t b = 0; b < blocks.size(); b++)
			packBlock(b);
	}
	std::vector<Block>   blocks;
	std::vector<Species> species;
	std::vector<Material> materials;

	size_t size() const { return x.size(); }
	int32_t speciesOf(size_t i) const { return blocks[i / blockSize].species; }
	/// of the pair of this species with automaton j [Pa]; q = arm of this side / distance
	double pairTwoG(int32_t mine, size_t j, double q) const { return seriesTwoG(materials[species[mine].material].G, materials[species[speciesOf(j)].material].G, q); }
	PairViscosity pairViscosity(int32_t mine, size_t j) const { return viscosityOf(materials[species[mine].material], materials[species[speciesOf(j)].material]); }
	const Material& materialOf(const Block& b) const { return materials[species[b.species].material]; }
	const Material& materialOf(size_t i) const { return materials[species[speciesOf(i)].material]; }
	double          distance2(size_t i, size_t j) const { return sqr(x[j] - x[i]) + sqr(y[j] - y[i]); } ///< [m2]
	double          restDistance(size_t i, size_t j) const { return 0.5 * (diameter[i] + diameter[j]); } ///< [m]

	/// f(name, vector) for every array with one entry per automaton; optional ones may be empty
	template <class F> void eachArray(F&& f)
	{
		f(factor), f(x), f(y), f(vx), f(vy), f(omega), f(angle), f(mass), f(inertia), f(ax), f(ay), f(ar), f(diameter), f(cell), f(invN), f(rest), f(J), f(dTheta), f(P), f(h);
		f(szz), f(eqps), f(temperature), f(strength), f(criterion), f(heat), f(fx), f(fy), f(torque), f(ex), f(ey), f(et), f(dampX), f(dampY), f(weight);
		f(flags), f(id), f(group);
	}
};

/// Half-contacts: every contact stands twice, once for each side, sorted by owner; rows of one owner are contiguous.
struct Contacts {
	std::vector<int32_t> owner, other, reverse; ///< automata; place of the other half
	std::vector<double>  s, tau;                ///< as for links [Pa]
	std::vector<double>  rest;                            ///< rest distance of this side: that of the two automata, or less when they came into contact already closer [m]
	std::vector<double>  d, twoG, friction, viscLinear, viscQuadratic, arm; ///< constants of the pair; arm of the owner over the distance
	std::vector<double>  perTwoG, perOwnG;      ///< 1/twoG, 1/G of the owner's material [1/Pa]; 0 where that is zero
	std::vector<double>  a, b, c;               ///< scratch per half-contact
	std::vector<double>  dx, dy, r2;            ///< vector from owner to other [m] and its square, of this step
	std::vector<double>  pushing, touch;        ///< 1 where this side pushes, where any side does; else 0
	std::vector<double>  along, press;          ///< (x_j-x_i).(v_j-v_i) [m2/s]; pressure force over the vector [N/m2]
	/// What a step fills anew; sized by the search.
	void sizeScratch()
	{
		for (auto v : { &a, &b, &c, &dx, &dy, &r2, &pushing, &touch, &along, &press })
			v->resize(size());
	}
	std::vector<int32_t> rowOwner, rowBegin;    ///< rows: owner and first half-contact; rowBegin has one entry more
	size_t               size() const { return owner.size(); }
	size_t               rows() const { return rowOwner.size(); }
	template <class F> void each(F&& f)
	{
		f(owner), f(other), f(reverse), f(s), f(tau), f(rest), f(d), f(twoG), f(friction), f(viscLinear), f(viscQuadratic), f(arm), f(rowOwner), f(rowBegin);
	}
};
}
