// SPDX-License-Identifier: GPL-2.0-or-later
// McaEngine: what it writes to bodies and files and shows to Python.
#include "McaBodies.hpp"
#include "McaEngine.hpp"
#include "McaVec.hpp"
#include <core/Omega.hpp>
#include <core/Scene.hpp>
#include <pkg/common/Sphere.hpp>
#include <sdk/arrayView.hpp>

namespace yade {
using mca::automata::Store;

void McaEngine::writeEnergies(Scene* scene)
{
	const auto  a       = solver->account();
	const char* names[]  = { "mcaKinetic",  "mcaVolumetric", "mcaDeviatoric", "mcaPlastic", "mcaViscous",  "mcaFriction",
		                 "mcaFracture", "mcaCoupling",   "mcaBoundary",   "mcaLeft",    "mcaExternal", "mcaHalfStep" };
	const Real  values[] = { a.kinetic,  a.volumetric, a.deviatoric, a.plastic, a.viscous,   a.friction,
		                 a.fracture, a.coupling,   a.boundary,   a.left,    -a.external, a.centre };
	for (int k = 0; k < 12; k++)
		scene->energy->set(values[k], names[k], energyIndex[k]);
}

void McaEngine::writeBack()
{
	locked([&] {
		const auto scene = myScene("sync");
		if (solver && home.expired()) settleIn(scene.get()); // loaded, not yet run
		if (solver && stale) writeBodies(scene.get());
	});
}

void McaEngine::reload()
{
	locked([&] {
		const auto scene = myScene("reload");
		looked           = true;
		if (solver && stale && !home.expired()) adoptChanges(scene.get());
	});
}

void McaEngine::preSave(McaEngine&)
{
	locked([&] {
		state.clear();
		bodiesSaved = true;
		const auto scene = Omega::instance().getScene();
		if (solver && standsIn(*scene)) {
			settleIn(scene.get());
			try { // what a script has changed counts in the file, too; what is refused will be refused again
				if (looked && solver) ensureBuilt(scene.get());
			} catch (const std::exception&) {
			}
			if (solver && stale) writeBodies(scene.get()); // engines are saved before bodies
		}
		if (!solver) return;
		const string bytes = solver->save();
		state.put(bytes.data(), bytes.size());
	});
}

namespace {
	/// What stands beside the solver's state must belong to it.
	void checkLoaded(const mca::automata::Solver& solver, const vector<int>& order, const vector<Vector3r>& viscous)
	{
		solver.checkOrder(order);
		for (const Vector3r& v : viscous)
			if (!(v[0] >= 0 && v[0] < 2147483648. && v[0] == std::floor(v[0]) && v[1] >= 0 && v[2] >= 0 && std::isfinite(v[1] + v[2])))
				throw mca::Error("McaEngine: the attribute 'viscous' in the file holds no body and coefficients of a viscous boundary; the "
				                 "file is damaged or was edited.");
	}
} // namespace

void McaEngine::postLoad(McaEngine&)
{
	if (state.empty()) return;
	vector<char>    bytes;
	sdk::BlobReader in(state);
	in.get(bytes);
	in.end();
	auto fresh = shared_ptr<mca::automata::Solver>(new mca::automata::Solver);
	fresh->load(string(bytes.begin(), bytes.end()));
	checkLoaded(*fresh, order, viscous);
	solver = fresh;
	home.reset(), bodies.clear(), same.clear(), known.clear();
	looked = true, stale = false;
	state.clear();
}

void McaEngine::refresh(Scene* scene)
{
	if (!solver || (looked && standsIn(*scene))) ensureBuilt(scene);
}

/// f() of the present state, under the lock; the bodies are gathered if that has not been done. An engine of a scene that is gone would show numbers that no
/// body has.
template <class F> auto McaEngine::read(const char* call, F&& f)
{
	return locked([&] {
		refresh(myScene(call).get());
		return f();
	});
}

py::object McaEngine::identifiers()
{
	const vector<int> now = read("ids", [&] { return order; });
	return sdk::arrayCopy(now.data(), { Py_ssize_t(now.size()) });
}

namespace {
	int had(const Store& S, size_t i) { return __builtin_popcount((S.flags[i] >> mca::hadShift) & mca::linkBits); }
	int have(const Store& S, size_t i) { return __builtin_popcount(S.flags[i] & mca::linkBits); }

	/// One quantity of the automata at these places.
	vector<Real> quantity(const mca::automata::Solver& solver, const vector<size_t>& places, const string& name, const string& call)
	{
		const Store& S    = solver.store;
		const auto   each = [&](auto value) {
                        vector<Real> v;
                        v.reserve(places.size());
                        for (size_t i : places)
                                v.push_back(value(i));
                        return v;
		};
		vector<Real> found;
		bool         known = false;
		string       list;
		S.eachShown([&](const char* shown, const auto& from) {
			list += string(shown) + ", ";
			if (name == shown) known = true, found = each([&](size_t i) { return Real(from[i]); });
		});
		if (known) return found;
		if (name == "equivalentStress") return each([&](size_t i) { return solver.equivalentStress(i); });
		if (name == "links") return each([&](size_t i) { return Real(have(S, i)); });
		if (name == "brokenLinks") return each([&](size_t i) { return Real(had(S, i) - have(S, i)); });
		if (name == "material") return each([&](size_t i) { return Real(S.species[size_t(S.speciesOf(i))].material); });
		throw mca::Error(
			"McaEngine." + call + " = '" + name + "' is unknown; it must be one of " + list + "equivalentStress, links, brokenLinks, material.");
	}
} // namespace

vector<size_t> McaEngine::places() const
{
	vector<size_t> v;
	v.reserve(order.size());
	for (int id : order)
		v.push_back(size_t(solver->indexOf(id)));
	return v;
}

py::object McaEngine::fieldByName(const string& name)
{
	const auto out = read("field", [&] { return quantity(*solver, places(), name, "field: name"); });
	return sdk::arrayCopy(out.data(), { Py_ssize_t(out.size()) });
}

py::dict McaEngine::fieldsByName(py::object names)
{
	vector<string> asked;
	const bool     list = PyList_Check(names.ptr()) || PyTuple_Check(names.ptr());
	for (long k = 0; list && k < py::len(names); k++)
		if (const py::extract<string> text(names[k]); text.check()) asked.push_back(text());
	if (!list || long(asked.size()) != py::len(names)) {
		PyErr_SetString(PyExc_TypeError, "McaEngine.fields: names must be a list or tuple of texts, each a name that field() takes or 'ids'.");
		py::throw_error_already_set();
	}
	vector<int>          ids;
	vector<vector<Real>> values;
	read("fields", [&] {
		const auto at = places();
		ids           = order;
		for (const auto& name : asked)
			values.push_back(name == "ids" ? vector<Real>() : quantity(*solver, at, name, "fields: names: name"));
	});
	py::dict d;
	for (size_t k = 0; k < asked.size(); k++)
		d[asked[k]] = asked[k] == "ids" ? sdk::arrayCopy(ids.data(), { Py_ssize_t(ids.size()) })
						: sdk::arrayCopy(values[k].data(), { Py_ssize_t(values[k].size()) });
	return d;
}

py::dict McaEngine::energies()
{
	const auto a = read("energies", [&] { return solver->account(); });
	py::dict   d;
	d["kinetic"] = a.kinetic, d["volumetric"] = a.volumetric, d["deviatoric"] = a.deviatoric, d["plastic"] = a.plastic, d["viscous"] = a.viscous,
	d["friction"] = a.friction;
	d["fracture"] = a.fracture, d["coupling"] = a.coupling, d["boundary"] = a.boundary, d["left"] = a.left, d["external"] = a.external,
	d["halfStep"] = a.centre, d["total"] = a.total(), d["bookedError"] = a.bookedError();
	d["bookedVolumetric"] = a.bookedVolumetric, d["bookedDeviatoric"] = a.bookedDeviatoric, d["bookedViscous"] = a.bookedViscous,
	d["kineticStart"] = a.kineticStart;
	putVector(d, "momentum", a.momentum), d["angularMomentum"] = a.angular, putVector(d, "impulse", a.impulse);
	return d;
}

py::dict McaEngine::countersNow()
{
	struct Now {
		mca::automata::Counters c;
		long                    awake = 0, blocks = 0, contacts = 0;
		bool                    any = false;
	};
	const Now n = locked([&] {
		Now now;
		if (!solver) return now;
		now.any = true, now.c = solver->counters, now.blocks = long(solver->store.blocks.size()), now.contacts = long(solver->contacts.size() / 2);
		for (auto& b : solver->store.blocks)
			now.awake += b.awake;
		return now;
	});
	py::dict d;
	if (!n.any) return d;
	d["steps"] = n.c.steps, d["searches"] = n.c.searches, d["localSearches"] = n.c.localSearches, d["sorts"] = n.c.sorts;
	d["blockSteps"] = n.c.blockSteps, d["blocks"] = n.blocks, d["awake"] = n.awake;
	d["brokenLinks"] = n.c.brokenLinks, d["clamped"] = n.c.clamped, d["deepest"] = std::min(n.c.deepest, 1.), d["contacts"] = n.contacts;
	return d;
}

py::dict McaEngine::phases()
{
	mca::automata::Counters c;
	const bool any = locked([&] { return solver ? (c = solver->counters, true) : false; });
	py::dict   d;
	if (!any) return d;
	d["search"] = c.nsSearch, d["density"] = c.nsDensity, d["stress"] = c.nsStress, d["contact"] = c.nsContact, d["force"] = c.nsForce,
	d["fracture"] = c.nsFracture, d["integration"] = c.nsIntegrate;
	return d;
}

py::list McaEngine::linkList()
{
	const auto pairs = read("links", [&] { return solver->links(); });
	py::list   l;
	for (auto& p : pairs)
		l.append(py::make_tuple(p.first, p.second));
	return l;
}

long McaEngine::automataCount() const
{
	return locked([&] { return solver ? long(order.size()) : 0L; });
}

Vector2r McaEngine::momentum()
{
	const auto a = read("momentum", [&] { return solver->account(); });
	return vector3(a.momentum).head<2>();
}

void McaEngine::setViscous(const vector<int>& ids, const Vector2r& normal)
{
	locked([&] {
		const auto scene = Omega::instance().getScene();
		settleIn(scene.get());
		const bool alongX = std::fabs(normal[0]) > 0;
		if (!(std::fabs(normal.norm() - 1.) < 1e-9 && (normal[0] == 0 || normal[1] == 0)))
			throw std::runtime_error("McaEngine.setViscous: normal must be (1,0), (-1,0), (0,1) or (0,-1).");
		// width of the boundary that one body stands for: extent of the set over the number of bodies in a line
		Real lo = 1e300, hi = -1e300;
		for (int id : ids) {
			if (!scene->bodies->exists(id))
				throw std::runtime_error(
					"McaEngine.setViscous: ids: there is no body " + std::to_string(id) + "; each must be the id of an automaton.");
			const auto& b = scene->bodies->body[size_t(id)];
			if (!isAutomaton(b) || !b->state)
				throw std::runtime_error(
					"McaEngine.setViscous: ids: body " + std::to_string(id)
					+ " is no automaton; it must have material McaMat, shape Sphere and a state.");
			const Real t = b->state->se3.position[alongX ? 1 : 0];
			if (!std::isfinite(t))
				throw std::runtime_error("McaEngine.setViscous: ids: the position of body " + std::to_string(id) + " must be finite.");
			lo = std::min(lo, t), hi = std::max(hi, t);
		}
		vector<Vector3r> added;
		for (int id : ids) {
			const auto& b     = scene->bodies->body[size_t(id)];
			const auto  mat   = static_cast<const McaMat*>(b->material.get())->toMaterial();
			const Real  d     = 2. * static_cast<Sphere*>(b->shape.get())->radius;
			const Real  width = (hi - lo + d) / Real(ids.size());
			const Real  bn = mat.eos.rho0 * mat.cP() * width, bt = mat.eos.rho0 * mat.cS() * width;
			added.push_back(Vector3r(Real(id), alongX ? bn : bt, alongX ? bt : bn));
		}
		for (const auto& v : added) {
			viscous.push_back(v);
			if (solver && isMine(int(v[0]))) solver->setDamping(size_t(solver->indexOf(int(v[0]))), vec(v, 1));
		}
	});
}
} // namespace yade
