// SPDX-License-Identifier: GPL-2.0-or-later
// Automata as YADE's bodies hold them: the same reading for the fast engine and for the law in YADE's loop.
#pragma once
#include "McaMat.hpp"
#include "automata/automata.hpp"
#include <core/Body.hpp>

namespace yade {
class Scene;

/// Material McaMat and shape Sphere.
bool isAutomaton(const shared_ptr<Body>& b);
/// The same, and no member of a clump, which is a rigid body.
bool movesAlone(const shared_ptr<Body>& b);
/// Bodies of one group link; across masks: all but those of mask 0.
inline int groupOf(int mask, bool acrossMasks) { return acrossMasks ? mask != 0 : mask; }
/// Throws unless every body has the number of its place, as YADE gives it: numbers are used as indices.
void checkNumbers(const Scene& scene);
/// Throws mca::Error: what McaEngine cannot take over of a body.
[[noreturn]] void refuseBody(const Body& b, const string& what);
/// 3 when an automaton of the scene may leave the plane (x, y), or has the mass of one in space; else 2.
int dimensionOf(const Scene& scene);
/// What the masses of the automata say: 3 when the first has that of space and not that of plane strain, 2 when it is the other way round; else
/// dimensionOf().
int dimensionByMass(const Scene& scene);
/// May move along z or turn about x or y.
bool leavesPlane(const State& s);
/// Throws mca::Error unless McaEngine can take over the motion of a body: finite, in the plane when that is the dimension.
void   checkMotion(const Body& b, int dimension);
string numberText(Real v);
/// The automaton of this number; throws std::runtime_error that names the call of McaEngine when there is none.
const Body& automatonOf(const Scene& scene, int id, const string& call);
/// Throws mca::Error when state.damage is out of range, or given where the material has no damage model.
void checkDamage(const Body& b, const McaState& s);

/// All automata of the scene, ascending ids. Strengths that are zero are drawn and stored in the states.
struct McaBodies {
	vector<mca::AutomatonStart> automata;
	vector<mca::Material>       materials;
	vector<const McaMat*>       known; ///< of materials
	vector<int>                 ids;
	/// Throws mca::Error: material out of range, no McaState, mass that is not that of the dimension.
	McaBodies(const Scene& scene, int seed, int dimension, bool acrossMasks);

private:
	void add(const Body& b, int seed, int dimension, bool acrossMasks);
};
/// Place of m in known, appended if need be.
size_t materialIndex(const McaMat* m, vector<const McaMat*>& known, vector<mca::Material>& materials);
} // namespace yade
