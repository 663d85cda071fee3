// SPDX-License-Identifier: GPL-2.0-or-later
// McaEngine: what it writes to bodies and files and shows to Python.
#include "McaBodies.hpp"
#include "McaEngine.hpp"
#include "McaPairRules.hpp"
#include "McaVec.hpp"
#include <core/Omega.hpp>
#include <core/Scene.hpp>
#include <pkg/common/Sphere.hpp>
#include <sdk/arrayView.hpp>

namespace yade {
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
		saveWalls();
	});
}

namespace {
	/// What stands beside the solver's state must belong to it.
	void checkLoaded(const mca::Automata& solver, const vector<int>& order, const vector<Vector3r>& viscous, const vector<Real>& viscousZ)
	{
		solver.checkOrder(order);
		bool good = viscousZ.size() == viscous.size();
		for (Real v : viscousZ) good &= v >= 0 && std::isfinite(v);
		for (const Vector3r& v : viscous)
			if (!(good && v[0] >= 0 && v[0] < 2147483648. && v[0] == std::floor(v[0]) && v[1] >= 0 && v[2] >= 0 && std::isfinite(v[1] + v[2])))
				throw mca::Error("McaEngine: the attribute 'viscous' in the file holds no body and coefficients of a viscous boundary; the "
				                 "file is damaged or was edited.");
	}
} // namespace

void McaEngine::postLoad(McaEngine&)
{
	checkLoads(nullptr), checkPairRules(pairMaterials, pairNumbers, "McaEngine");
	loads = loadList();
	if (state.empty()) return;
	vector<char>    bytes;
	sdk::BlobReader in(state);
	in.get(bytes);
	in.end();
	if (dimension != 2 && dimension != 3) throw mca::Error("McaEngine: dimension in the file is neither 2 nor 3; the file is damaged or was edited.");
	shared_ptr<mca::Automata> fresh(mca::automataIn(dimension));
	fresh->load(string(bytes.begin(), bytes.end()));
	checkLoaded(*fresh, order, viscous, viscousZ), loadWalls(*fresh), checkLoads(fresh.get());
	solver = fresh;
	home.reset(), letGo(bodies, same, known, walls), wallStarts.clear();
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

py::object McaEngine::fieldByName(const string& name)
{
	const auto out = read("field", [&] { return solver->quantity(order, name, "field: name"); });
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
		ids = order;
		for (const auto& name : asked)
			values.push_back(name == "ids" ? vector<Real>() : solver->quantity(order, name, "fields: names: name"));
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
	putVector(d, "momentum", a.momentum, dimension), putVector(d, "impulse", a.impulse, dimension);
	d["leftMass"] = a.leftMass, d["leftKinetic"] = a.leftKinetic, d["leftVolumetric"] = a.leftVolumetric, d["leftDeviatoric"] = a.leftDeviatoric;
	putVector(d, "leftMomentum", a.leftMomentum, dimension);
	if (dimension == 2) d["angularMomentum"] = a.angular[2];
	else putVector(d, "angularMomentum", a.angular, dimension);
	return d;
}

py::dict McaEngine::countersNow()
{
	struct Now {
		mca::AutomataCounters c;
		mca::Automata::Work   work;
		bool                  any = false;
	};
	const Now n = locked([&] {
		Now now;
		if (!solver) return now;
		now.any = true, now.c = solver->counters(), now.work = solver->work();
		return now;
	});
	py::dict d;
	if (!n.any) return d;
	d["steps"] = n.c.steps, d["searches"] = n.c.searches, d["localSearches"] = n.c.localSearches, d["sorts"] = n.c.sorts;
	d["blockSteps"] = n.c.blockSteps, d["blocks"] = n.work.blocks, d["awake"] = n.work.awake;
	d["brokenLinks"] = n.c.brokenLinks, d["clamped"] = n.c.clamped, d["deepest"] = std::min(n.c.deepest, 1.), d["contacts"] = n.work.contacts;
	return d;
}

py::dict McaEngine::phases()
{
	mca::AutomataCounters c;
	const bool any = locked([&] { return solver ? (c = solver->counters(), true) : false; });
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

long McaEngine::cut(py::object pairs)
{
	const auto list = idPairs(pairs, "McaEngine.cut");
	return long(read("cut", [&] { return solver->cut(list); }));
}

void McaEngine::setPair(py::object first, py::object second, Real strength, Real pairStrength, py::object frictionAngle, Real viscosity)
{
	locked([&] { settleIn(Omega::instance().getScene().get()); }); // rules of a scene that is gone go with it
	auto materials = pairMaterials; // nothing changes where something is refused
	auto numbers   = pairNumbers;
	addPairRule(materials, numbers, "McaEngine.setPair", first, second, strength, pairStrength, frictionAngle, viscosity);
	locked([&] {
		pairMaterials.swap(materials), pairNumbers.swap(numbers);
		try {
			if (solver && !bodies.empty()) givePairRules();
		} catch (...) {
			pairMaterials.swap(materials), pairNumbers.swap(numbers);
			throw;
		}
	});
}

namespace {
	/// Rows of 3, 4 or 6 numbers, or one of them; under Python's lock.
	vector<vector<Real>> stressRows(const py::object& given, size_t bodies)
	{
		vector<vector<Real>> rows;
		try {
			const py::object a    = py::import("numpy").attr("atleast_2d")(py::import("numpy").attr("asarray")(given, "float64"));
			const py::object list = a.attr("tolist")();
			for (long n = 0; n < py::len(list); n++) {
				rows.emplace_back();
				for (long c = 0; c < py::len(list[n]); c++) rows.back().push_back(py::extract<Real>(list[n][c]));
			}
		} catch (const py::error_already_set&) {
			PyErr_Clear();
			rows.clear();
		}
		if (rows.size() == 1) rows.resize(bodies, rows[0]);
		const bool many = rows.size() == bodies && !rows.empty();
		for (const auto& row : rows)
			for (Real v : row)
				if (!std::isfinite(v))
					throw mca::Error("McaEngine.setStress: stress [Pa] must be finite numbers; one is " + numberText(v) + ".");
		if (!many || rows[0].size() < 3)
			throw mca::Error("McaEngine.setStress: stress must be one row of numbers [Pa] for all bodies, or one for each of the "
			                 + std::to_string(bodies) + ": xx, yy, xy (and zz) in plane strain, xx, yy, zz, yz, zx, xy in space.");
		return rows;
	}
	/// Stress of a row; nu: Poisson's ratio, for zz of plane strain.
	mca::SplitStress stressOf(const vector<Real>& row, int dimension, Real nu)
	{
		if (dimension == 3) return mca::SplitStress({ row[0], row[1], row[2], row[3], row[4], row[5] });
		return mca::SplitStress({ row[0], row[1], row.size() == 4 ? row[3] : nu * (row[0] + row[1]), 0., 0., row[2] });
	}
} // namespace

void McaEngine::setStress(const vector<int>& ids, py::object stress)
{
	if (ids.empty()) throw mca::Error("McaEngine.setStress: ids names no body; give the id of at least one automaton.");
	const auto rows = stressRows(stress, ids.size());
	read("setStress", [&] {
		const auto scene = home.lock();
		if (!scene) throw std::runtime_error("McaEngine.setStress: the engine must stand in O.engines of the present scene.");
		for (int id : ids) {
			automatonOf(*scene, id, "setStress");
			if (isMine(id)) continue;
			throw std::runtime_error(
				"McaEngine.setStress: ids: body " + std::to_string(id)
				+ " is none of the automata of this engine yet; put the engine into O.engines, and pause a run in the background.");
		}
		const size_t n = rows[0].size();
		if (dimension == 3 ? n != 6 : n > 4)
			throw mca::Error("McaEngine.setStress: stress has rows of " + std::to_string(n) + " numbers; they must be "
			                 + (dimension == 3 ? "6: xx, yy, zz, yz, zx, xy." : "3 or 4: xx, yy, xy (and zz)."));
		if (!forcesReady) stale = true, solver->computeForces(); // the strain of the last step belongs to the state before
		heatLoads(*scene);
		const auto each = [&](auto&& f) {
			for (size_t q = 0; q < ids.size(); q++) {
				const mca::Material& m = solver->materials()[size_t(solver->fixed(ids[q]).material)];
				const Real           K = m.eos.bulkModulus(), nu = (3 * K - 2 * m.G) / (2 * (3 * K + m.G));
				f(ids[q], stressOf(rows[q], dimension, nu));
			}
		};
		each([&](int id, const mca::SplitStress& s) { solver->checkStress(id, s.pressure, s.deviator); }); // all, before any is changed
		each([&](int id, const mca::SplitStress& s) { solver->setStress(id, s.pressure, s.deviator); });
		solver->moved();
		forcesReady = false, stale = stressGiven = true;
		writeBodies(scene.get());
	});
}

py::dict McaEngine::brokenLinks()
{
	const mca::BrokenLinks b = read("brokenLinks", [&] { return solver->brokenLinks(); });
	py::dict               d;
	const Py_ssize_t       n = Py_ssize_t(b.time.size());
	d["time"] = sdk::arrayCopy(b.time.data(), { n });
	d["id1"] = sdk::arrayCopy(b.first.data(), { n }), d["id2"] = sdk::arrayCopy(b.second.data(), { n }), d["cause"] = sdk::arrayCopy(b.cause.data(), { n });
	for (size_t c = 0; c < 3; c++) {
		vector<Real> x, normal;
		for (const auto& p : b.middle) x.push_back(p[c]);
		for (const auto& p : b.normal) normal.push_back(p[c]);
		const string name(1, char('x' + c));
		d[name] = sdk::arrayCopy(x.data(), { n }), d["n" + name] = sdk::arrayCopy(normal.data(), { n });
	}
	return d;
}

py::dict McaEngine::cohesivePairs()
{
	const mca::CohesivePairs p = read("cohesivePairs", [&] { return solver->cohesivePairs(); });
	const Py_ssize_t         n = Py_ssize_t(p.first.size());
	py::dict                 d;
	d["id1"] = sdk::arrayCopy(p.first.data(), { n }), d["id2"] = sdk::arrayCopy(p.second.data(), { n });
	d["opening"] = sdk::arrayCopy(p.opening.data(), { n }), d["spent"] = sdk::arrayCopy(p.spent.data(), { n });
	return d;
}

long McaEngine::automataCount() const
{
	return locked([&] { return solver ? long(order.size()) : 0L; });
}

py::object McaEngine::momentum()
{
	const Vector3r m = vector3(read("momentum", [&] { return solver->account(); }).momentum);
	return dimension == 2 ? py::object(Vector2r(m.head<2>())) : py::object(m);
}

namespace {
	/// The axis of a normal of two components, or three; -1: it has no such number of them or does not lie along an axis.
	int axisOf(const py::object& normal)
	{
		Vector3r n = Vector3r::Zero();
		if (const py::extract<Vector2r> flat(normal); flat.check()) n.head<2>() = flat();
		else if (const py::extract<Vector3r> full(normal); full.check()) n = full();
		int axis = -1;
		for (int c = 0; c < 3; c++) {
			if (n[c] == 0) continue;
			if (axis >= 0 || !(std::fabs(std::fabs(n[c]) - 1.) < 1e-9)) return -1;
			axis = c;
		}
		return axis;
	}
	Real diameterOf(const Body& b) { return 2. * static_cast<const Sphere*>(b.shape.get())->radius; }
} // namespace

void McaEngine::setViscous(const vector<int>& ids, const py::object& normal)
{
	const int axis = axisOf(normal);
	locked([&] {
		const auto scene = Omega::instance().getScene();
		settleIn(scene.get());
		if (solver && looked) ensureBuilt(scene.get());
		const int n = solver ? dimension : dimensionOf(*scene);
		if (axis < 0 || axis >= n)
			throw std::runtime_error(
				string("McaEngine.setViscous: normal must be (1,0), (-1,0), (0,1) or (0,-1)")
				+ (n == 2 ? "." : ", or, for these bodies in space, along one of the axes with three components, as (0,0,1)."));
		// what one body stands for: extent of the set over the number of bodies in a line, in space area over their number
		Vector3r lo = Vector3r::Constant(1e300), hi = -lo;
		for (int id : ids) {
			const Vector3r& x = automatonOf(*scene, id, "setViscous").state->se3.position;
			lo = lo.cwiseMin(x), hi = hi.cwiseMax(x);
		}
		for (int id : ids) {
			const Body& b     = automatonOf(*scene, id, "setViscous");
			const auto  mat   = static_cast<const McaMat*>(b.material.get())->toMaterial();
			const Real  d     = diameterOf(b);
			Real        share = 1. / Real(ids.size());
			for (int c = 0; c < n; c++)
				if (c != axis) share *= hi[c] - lo[c] + d;
			Vector3r along = Vector3r::Constant(mat.eos.rho0 * mat.cS() * share);
			along[axis]    = mat.eos.rho0 * mat.cP() * share;
			viscous.push_back(Vector3r(Real(id), along[0], along[1])), viscousZ.push_back(n == 3 ? along[2] : 0.);
			if (solver && isMine(id)) solver->setDamping(id, triple(along));
		}
	});
}
} // namespace yade
