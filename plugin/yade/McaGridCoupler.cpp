// SPDX-License-Identifier: GPL-2.0-or-later
// McaGridCoupler: its two engines, the step of both, what it saves and shows. The row: McaGridCouplerRow.cpp.
#include "McaGridCoupler.hpp"
#include "McaVec.hpp"
#include <core/Omega.hpp>
#include <core/Scene.hpp>
#include <set>

namespace yade {
YADE_PLUGIN((McaGridCoupler));

using mca::interface::Carried;

namespace {
	template <class T> shared_ptr<T> onlyOne(Scene* scene, const char* attribute)
	{
		shared_ptr<T> found;
		for (const auto& e : scene->engines) {
			auto t = boost::dynamic_pointer_cast<T>(e);
			if (!t) continue;
			if (found)
				throw mca::Error(
					string("McaGridCoupler: there are several ") + t->getClassName() + " in O.engines; say which by the attribute '"
					+ attribute + "'.");
			found = t;
		}
		return found;
	}
} // namespace

/// f() under the locks of both sides.
template <class F> void McaGridCoupler::inBoth(F&& f)
{
	if (!foundAutomata) return foundGrid->locked(f);
	foundAutomata->locked([&] { foundGrid->locked(f); });
}

vector<McaGridCoupler*> McaGridCoupler::all(Scene* scene) const
{
	vector<McaGridCoupler*> v;
	for (const auto& e : scene->engines)
		if (auto* c = dynamic_cast<McaGridCoupler*>(e.get()))
			if (!c->dead) v.push_back(c);
	return v;
}

void McaGridCoupler::find(Scene* scene)
{
	if (foundGrid) return;
	foundAutomata = automata ? automata : onlyOne<McaEngine>(scene, "automata");
	foundGrid     = grid ? grid : onlyOne<McaGridEngine>(scene, "grid");
	if (!foundGrid) throw mca::Error("McaGridCoupler: there is no McaGridEngine in O.engines.");
	const auto stands = [&](const Engine* e) {
		return std::any_of(scene->engines.begin(), scene->engines.end(), [&](const shared_ptr<Engine>& s) { return s.get() == e; });
	};
	const bool a = !foundAutomata || stands(foundAutomata.get()), g = stands(foundGrid.get());
	if (!a || !g) {
		foundAutomata.reset(), foundGrid.reset();
		throw mca::Error(
			string("McaGridCoupler: the attribute '") + (a ? "grid" : "automata")
			+ "' is an engine that does not stand in O.engines; put it there, or leave the attribute empty to take the only one.");
	}
}

bool McaGridCoupler::drives(const McaSolverEngine* engine, Scene* scene)
{
	find(scene);
	return engine == foundAutomata.get() || engine == foundGrid.get();
}

/// What tying the row reads, apart from the engines.
string McaGridCoupler::asText() const
{
	std::ostringstream s;
	s.precision(17);
	s << "block " << block << ", side '" << side << "', start " << start << ", end " << end << ", tolerance " << tolerance << ", ratio (" << ratio[0]
	  << ", " << ratio[1] << "), otherMaterials " << otherMaterials << ", ids";
	for (int id : ids)
		s << ' ' << id;
	return s.str();
}

/// The tied bodies are those of one scene; a coupler taken to another one would move whoever has their numbers there.
void McaGridCoupler::checkHome(Scene* scene)
{
	if (const string text = asText(); text != tiedAs || (automata && automata != foundAutomata) || (grid && grid != foundGrid))
		throw mca::Error(
			"McaGridCoupler: its attributes were changed after the row was tied, when they are read (now " + text + "; tied as " + tiedAs
			+ "; or automata or grid); set them back, or make a new scene.");
	const auto now = home.lock();
	if (now.get() == scene) return;
	if (!loaded)
		throw mca::Error("McaGridCoupler: it has tied bodies of another scene (O.reset, O.load, ...); take the coupler of the present scene from "
		                 "O.engines, or make new couplers and a new grid.");
	inBoth([&] { checkTied(scene); });
	loaded = false;
	home   = Omega::instance().getScene();
}

void McaGridCoupler::prepare(Scene* scene)
{
	find(scene);
	if (tied) {
		if (foundAutomata && !foundAutomata->built())
			throw mca::Error("McaGridCoupler: its row is tied, but its McaEngine has no automata; a new engine cannot take the place of the one "
			                 "that was tied.");
		return checkHome(scene);
	}
	const auto couplers = all(scene);
	try { // all rows first: nothing is tied unless every row fits
		for (auto* c : couplers)
			if (!c->tied) {
				c->find(scene);
				c->inBoth([&] { c->makeRow(scene); });
			}
	} catch (...) {
		for (auto* c : couplers) {
			if (c->tied) continue;
			c->row.clear();
			if (c->foundAutomata) c->foundAutomata->forget(); // bodies that the script corrects are gathered anew
		}
		throw;
	}
	for (auto* c : couplers)
		if (!c->tied) c->inBoth([&] { c->tieRow(scene); });
}

// The row of a loaded scene against what it refers to.
void McaGridCoupler::checkTied(Scene* scene)
{
	const auto refuse = [](int id, const char* what) {
		throw mca::Error("McaGridCoupler: the saved row does not belong to this scene: body " + std::to_string(id) + " " + what + ".");
	};
	mca::interface::checkRow(row, foundGrid->grid().open().size());
	if (foundAutomata) foundAutomata->ensureBuilt(scene);
	if (foundAutomata && places.size() != row.size()) refuse(row.front().id, "has no place among the tied automata");
	for (size_t k = 0; k < row.size(); k++) {
		const int id = row[k].id;
		if (size_t(id) >= scene->bodies->body.size() || !scene->bodies->body[size_t(id)] || !scene->bodies->body[size_t(id)]->state)
			refuse(id, "is not there");
		if (foundAutomata && (places[k] < 0 || !foundAutomata->automata().isTied(size_t(places[k]), id))) refuse(id, "is not tied");
	}
	loaded = false;
}

void McaGridCoupler::forcesToNodes(Scene* scene)
{
	auto&      g = foundGrid->grid();
	auto&      n = g.open();
	const Real dt = scene->dt;
	if (foundAutomata) {
		auto&       A = foundAutomata->automata();
		const auto& S = A.store;
		const bool  outside = !S.outside.empty();
		const Real  f = A.kick(dt) / g.kick(dt); // 1 but for the first step of one side beside an older one
		for (const Carried& c : row) {
			const size_t i = size_t(A.indexOf(c.id));
			mca::interface::addForce(c, (outside ? S.force.at(i) + S.outside.at(i) : S.force.at(i)) * f, n);
		}
	} else {
		scene->forces.sync();
		const Real f = dt / g.kick(dt); // NewtonIntegrator's forces act over dt
		for (const Carried& c : row) {
			const Vector3r& force = scene->forces.getForce(c.id);
			mca::interface::addForce(c, vec(force) * f, n);
			auto& at = scene->bodies->body[size_t(c.id)]->state->se3.position; // takes back the round-off of the last move
			at       = vector3(mca::interface::motion(c, n).position, at);
		}
	}
}

void McaGridCoupler::motionToRow(Scene* scene, bool positions)
{
	const auto& n = foundGrid->grid().open();
	for (size_t k = 0; k < row.size(); k++) {
		const auto m = mca::interface::motion(row[k], n);
		if (!foundAutomata) {
			if (!positions) scene->bodies->body[size_t(row[k].id)]->state->vel = vector3(m.velocity);
			continue;
		}
		auto&        A = foundAutomata->automata();
		const size_t i = size_t(A.indexOf(row[k].id));
		if (positions) A.store.position.set(i, m.position); // no drift by round-off
		else A.setTiedVelocity(size_t(places[k]), m.velocity, A.store.omega[i]);
	}
}

void McaGridCoupler::action()
{
	guarded([&] {
		try {
			step();
		} catch (...) {
			McaSolverEngine::settle(scene);
			throw;
		}
	});
}

void McaGridCoupler::step()
{
	timingDeltas->start();
	prepare(scene);
	if ((foundAutomata && !foundAutomata->forcesReady) || !foundGrid->grid().between())
		throw mca::Error("McaGridCoupler: it must follow McaEngine (or InteractionLoop) and McaGridEngine in O.engines, and both must run.");
	inBoth([&] { forcesToNodes(scene); });
	const auto couplers = all(scene);
	timingDeltas->checkpoint("forces to the nodes");
	if (couplers.back() != this) return;
	// the last one moves all
	std::set<McaSolverEngine*> done;
	for (auto* c : couplers)
		if (done.insert(c->foundGrid.get()).second) c->foundGrid->locked([&] { c->foundGrid->integrate(scene); });
	timingDeltas->checkpoint("integration of the grid");
	for (auto* c : couplers)
		c->inBoth([&] { c->motionToRow(scene, false); });
	timingDeltas->checkpoint("motion to the row");
	for (auto* c : couplers)
		if (c->foundAutomata && done.insert(c->foundAutomata.get()).second) c->foundAutomata->locked([&] { c->foundAutomata->integrate(scene); });
	timingDeltas->checkpoint("integration of the automata");
	for (auto* c : couplers)
		if (c->foundAutomata) c->inBoth([&] { c->motionToRow(scene, true); });
	for (auto* c : couplers)
		if (c->foundAutomata && done.erase(c->foundAutomata.get())) c->foundAutomata->locked([&] { c->foundAutomata->finish(scene); });
	timingDeltas->checkpoint("motion to the row");
}

void McaGridCoupler::preSave(McaGridCoupler&)
{
	state.clear();
	state.put(row);
	state.put(places);
}

void McaGridCoupler::postLoad(McaGridCoupler&)
{
	foundAutomata.reset(), foundGrid.reset();
	if (state.empty()) return;
	sdk::BlobReader in(state);
	in.get(row);
	in.get(places);
	in.end();
	mca::interface::checkRow(row, std::numeric_limits<int>::max()); // against the grid: when it is used
	tied = loaded = !row.empty();
	home.reset();
	state.clear();
}

vector<int> McaGridCoupler::rowIds() const
{
	vector<int> v;
	for (const Carried& c : row)
		v.push_back(c.id);
	return v;
}
vector<Vector2i> McaGridCoupler::rowNodes() const
{
	vector<Vector2i> v;
	for (const Carried& c : row)
		v.push_back(Vector2i(c.a, c.b));
	return v;
}
vector<Vector2r> McaGridCoupler::rowShares() const
{
	vector<Vector2r> v;
	for (const Carried& c : row)
		v.push_back(Vector2r(c.Na, c.Nb));
	return v;
}

py::dict McaGridCoupler::energies()
{
	Scene* now = Omega::instance().getScene().get();
	Real   kinetic = 0, total = 0, booked = 0, turn = 0;
	mca::Vec<Real> momentum {}, impulse {};
	std::set<McaSolverEngine*> done;
	for (auto* c : all(now)) {
		c->prepare(now);
		c->inBoth([&] {
		if (c->foundAutomata && done.insert(c->foundAutomata.get()).second) {
			c->foundAutomata->refresh(now); // what a script has changed counts already
			const auto a = c->foundAutomata->automata().account();
			kinetic += a.kinetic, total += a.total(), booked += a.bookedError(), momentum += a.momentum, impulse += a.impulse,
				turn += a.angular;
		}
		if (!done.insert(c->foundGrid.get()).second) return;
		const auto& g = c->foundGrid->grid();
		const auto  e = g.energy();
		kinetic += e.kinetic, total += e.total(), booked += e.total(), momentum += mca::Vec<Real> { e.momentumX, e.momentumY },
			impulse += mca::Vec<Real> { e.impulseX, e.impulseY };
		for (int b = 0; b < g.blocks(); b++) {
			const auto& B = g.block(b);
			for (int j = 1; j < B.nj; j++)
				for (int i = 1; i < B.ni; i++) {
					const size_t k = B.node(i, j);
					if (B.copyOf(i, j) < 0) turn += (B.x[k] * B.vy[k] - B.y[k] * B.vx[k]) / B.invMass[k];
				}
		}
		const auto& n = g.open();
		for (size_t k = 0; k < size_t(n.size()); k++)
			turn += n.mass[k] * (n.x[k] * n.vy[k] - n.y[k] * n.vx[k]);
		});
	}
	py::dict d;
	d["kinetic"] = kinetic, d["total"] = total, d["booked"] = booked;
	putVector(d, "momentum", momentum), putVector(d, "impulse", impulse);
	d["angularMomentum"] = turn;
	return d;
}
} // namespace yade
