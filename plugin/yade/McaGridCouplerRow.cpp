// SPDX-License-Identifier: GPL-2.0-or-later
// McaGridCoupler: which automata make up the row, and how they are tied to the side of the block.
#include "McaBodies.hpp"
#include "McaGridCoupler.hpp"
#include "McaVec.hpp"
#include <core/Scene.hpp>
#include <pkg/common/Sphere.hpp>

namespace yade {
using mca::interface::Carried;
using mca::interface::RowPoint;

namespace {
	mca::grid::Side tiedSide(const string& name)
	{
		if (name == "bottom") return mca::grid::Side::bottom;
		if (name == "right") return mca::grid::Side::right;
		if (name == "top") return mca::grid::Side::top;
		if (name == "left") return mca::grid::Side::left;
		throw mca::Error("McaGridCoupler: side '" + name + "' is unknown; it must be 'bottom', 'right', 'top' or 'left'.");
	}
} // namespace

vector<RowPoint> McaGridCoupler::candidates(Scene* scene, std::deque<mca::Material>& keep) const
{
	vector<RowPoint>          out;
	std::map<const McaMat*, const mca::Material*> known;
	const auto                add = [&](const Body& b, const vector<Vector3r>* at) {
                const auto* m      = dynamic_cast<const McaMat*>(b.material.get());
                const auto* sphere = dynamic_cast<const Sphere*>(b.shape.get());
                if (!sphere || (!m && ids.empty())) return;
                const Vector3r& x = at ? (*at)[0] : b.state->se3.position;
                RowPoint        p;
                p.id = b.id, p.x = x[0], p.y = x[1], p.diameter = 2. * sphere->radius, p.mass = b.state->mass;
                p.weight = p.mass / (b.material->density * mca::Lattice::cell(p.diameter));
                if (m) {
                        const mca::Material*& mine = known[m];
                        if (!mine) keep.push_back(m->toMaterial()), mine = &keep.back(); // a deque does not move what it has
                        p.material = mine;
                }
                out.push_back(p);
	};
	const auto point = [&](int id) {
		const auto& b = scene->bodies->body[size_t(id)];
		if (!foundAutomata) return add(*b, nullptr);
		const auto  i = foundAutomata->automata().indexOf(id);
		const auto& S = foundAutomata->automata().store;
		if (i < 0)
			throw mca::Error(
				"McaGridCoupler: body " + std::to_string(id) + " is not an automaton of the McaEngine (material McaMat and shape Sphere).");
		const vector<Vector3r> x { vector3(S.position.at(size_t(i))) };
		add(*b, &x);
	};
	if (!ids.empty()) {
		for (int id : ids) {
			if (id < 0 || size_t(id) >= scene->bodies->body.size() || !scene->bodies->body[size_t(id)])
				throw mca::Error("McaGridCoupler: there is no body " + std::to_string(id) + ".");
			point(id);
		}
	} else
		for (const auto& b : scene->bodies->body)
			if (b && dynamic_cast<const McaMat*>(b->material.get()) && dynamic_cast<const Sphere*>(b->shape.get())) point(b->id);
	return out;
}

void McaGridCoupler::makeRow(Scene* scene)
{
	if (foundAutomata) foundAutomata->ensureBuilt(scene);
	else if (dimensionByMass(*scene) == 3)
		throw mca::Error("McaGridCoupler: the automata of the scene are in space, and a grid is in plane strain: rows in space cannot be tied.");
	mca::grid::Grid&                  g = foundGrid->grid();
	const mca::grid::OpenNodes&       n = g.open();
	mca::interface::SideNodes         s;
	s.node              = g.sideNodes(block, tiedSide(side), start, end);
	const auto& b       = g.block(block);
	s.block             = b.options.name;
	s.material          = &b.material;
	for (int k : s.node)
		s.x.push_back(n.x[size_t(k)]), s.y.push_back(n.y[size_t(k)]);
	// middle of the block's cells next to the side
	const bool   alongI = side == "bottom" || side == "top";
	const int    k      = start, i = alongI ? k : side == "left" ? 1 : b.ni - 1, j = alongI ? (side == "bottom" ? 1 : b.nj - 1) : k;
	s.inX = b.x[b.node(i, j)], s.inY = b.y[b.node(i, j)];
	mca::interface::MapOptions o;
	o.tolerance = tolerance, o.smallestRatio = ratio[0], o.largestRatio = ratio[1], o.otherMaterials = otherMaterials, o.onlyGiven = !ids.empty();
	if (!(ratio[0] > 0 && ratio[0] <= ratio[1] && ratio[1] <= 1e6))
		throw mca::Error(
			"McaGridCoupler: ratio = (" + std::to_string(ratio[0]) + ", " + std::to_string(ratio[1])
			+ ") must be two rising numbers above 0 and at most 1e6.");
	if (!(tolerance > 0 && tolerance <= 0.05))
		throw mca::Error("McaGridCoupler: tolerance = " + std::to_string(tolerance) + " must be above 0 and at most 0.05 diameters.");
	std::deque<mca::Material> keep;
	row = mca::interface::makeMap(candidates(scene, keep), s, o);
}

void McaGridCoupler::tieRow(Scene* scene)
{
	mca::grid::Grid& g = foundGrid->grid();
	for (const auto& m : mca::interface::nodeMasses(row))
		g.addNodeMass(m.first, m.second);
	places.clear();
	for (const Carried& c : row) {
		const auto v = mca::interface::motion(c, g.open());
		if (foundAutomata) {
			auto&        A = foundAutomata->automata();
			const size_t q = size_t(A.indexOf(c.id));
			places.push_back(long(A.tie(q, true)));
			A.setTiedVelocity(size_t(places.back()), v.velocity, A.store.omega[q]);
		} else {
			State& st = *scene->bodies->body[size_t(c.id)]->state;
			st.blockedDOFs |= State::DOF_X | State::DOF_Y | State::DOF_Z | State::DOF_RX | State::DOF_RY;
			st.vel = vector3(v.velocity);
		}
	}
	foundGrid->carry();
	tiedAs = asText();
	home = Omega::instance().getScene();
	tied = true;
}
} // namespace yade
