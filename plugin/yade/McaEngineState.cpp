// SPDX-License-Identifier: GPL-2.0-or-later
// McaEngine: what it writes to bodies and files and shows to Python.
#include "McaEngine.hpp"
#include <core/Omega.hpp>
#include <core/Scene.hpp>
#include <pkg/common/Sphere.hpp>
#include <sdk/arrayView.hpp>

namespace yade {
using mca::automata::Store;

void McaEngine::writeBodies(Scene* scene)
{
	const Store& S = solver->store;
	writtenPos.resize(order.size()), writtenVel.resize(order.size()), writtenSpin.resize(order.size());
	const long n = long(order.size());
	for (long q = 0; q < n; q++) {
		const auto& b = scene->bodies->body[order[q]];
		if (!b) continue;
		const size_t i = solver->indexOf(order[q]);
		State&       s = *b->state;
		s.se3.position[0] = S.x[i], s.se3.position[1] = S.y[i];
		s.vel             = Vector3r(S.vx[i], S.vy[i], s.vel[2]);
		s.angVel[2]       = S.omega[i];
		s.se3.orientation = Quaternionr(AngleAxisr(S.angle[i], Vector3r::UnitZ()));
		writtenPos[q] = s.se3.position, writtenVel[q] = s.vel, writtenSpin[q] = s.angVel[2];
		if (auto* m = dynamic_cast<McaState*>(&s)) {
			m->pressure = S.P[i], m->volumeRatio = S.J[i], m->plasticStrain = S.eqps[i], m->temperature = S.temperature[i], m->stressZZ = S.szz[i];
			m->equivalentStress = solver->equivalentStress(i);
			m->links            = __builtin_popcount(S.flags[i] & mca::automata::linkBits);
			m->brokenLinks      = __builtin_popcount((S.flags[i] >> mca::automata::hadShift) & mca::automata::linkBits) - m->links;
			if (!S.heat.empty()) m->dissipated = S.heat[i];
		}
	}
	stale       = false;
	lastWritten = scene->iter;
	if (scene->trackEnergy) writeEnergies(scene);
}

void McaEngine::writeEnergies(Scene* scene)
{
	const auto  a       = solver->account();
	const char* names[] = { "mcaKinetic", "mcaVolumetric", "mcaDeviatoric", "mcaPlastic", "mcaViscous", "mcaFriction", "mcaFracture", "mcaCoupling", "mcaBoundary", "mcaExternal", "mcaHalfStep" };
	const Real  values[] = { a.kinetic, a.volumetric, a.deviatoric, a.plastic, a.viscous, a.friction, a.fracture, a.coupling, a.boundary, -a.external, a.centre };
	for (int k = 0; k < 11; k++)
		scene->energy->set(values[k], names[k], energyIndex[k]);
}

void McaEngine::writeBack()
{
	if (!solver) return;
	writeBodies(Omega::instance().getScene().get());
	checkBodies = true;
}

void McaEngine::reload()
{
	checkBodies = true;
}

void McaEngine::preSave(McaEngine&)
{
	state.clear();
	if (!solver) return;
	const string bytes = solver->save();
	state.put(bytes.data(), bytes.size());
}

namespace {
	/// What stands beside the solver's state must belong to it.
	void checkLoaded(const mca::automata::Solver& solver, const vector<int>& order, const vector<Vector3r>& viscous)
	{
		solver.checkOrder(order);
		for (const Vector3r& v : viscous)
			if (!(v[0] >= 0 && v[0] < 2147483648. && v[0] == std::floor(v[0]) && v[1] >= 0 && v[2] >= 0 && std::isfinite(v[1] + v[2])))
				throw mca::Error("McaEngine: the attribute 'viscous' in the file holds no body and coefficients of a viscous boundary; the file is damaged or was edited.");
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
	loaded = true;
	state.clear();
}

py::object McaEngine::identifiers()
{
	if (!solver) ensureBuilt(Omega::instance().getScene().get());
	return sdk::arrayCopy(order.data(), { Py_ssize_t(order.size()) });
}

py::object McaEngine::fieldByName(const string& name)
{
	if (!solver) ensureBuilt(Omega::instance().getScene().get());
	const Store& S = solver->store;
	const std::map<string, const vector<Real>*> plain = {
		{ "x", &S.x }, { "y", &S.y }, { "vx", &S.vx }, { "vy", &S.vy }, { "omega", &S.omega }, { "angle", &S.angle }, { "mass", &S.mass }, { "pressure", &S.P }, { "volumeRatio", &S.J },
		{ "plasticStrain", &S.eqps }, { "temperature", &S.temperature }, { "stressZZ", &S.szz }, { "fx", &S.fx }, { "fy", &S.fy }, { "strength", &S.strength }, { "diameter", &S.diameter }, { "weight", &S.weight }
	};
	vector<Real> out(order.size());
	auto         fill = [&](auto value) {
                for (size_t q = 0; q < order.size(); q++)
                        out[q] = value(size_t(solver->indexOf(order[q])));
	};
	auto it = plain.find(name);
	if (it != plain.end()) fill([&](size_t i) { return (*it->second)[i]; });
	else if (name == "equivalentStress") fill([&](size_t i) { return solver->equivalentStress(i); });
	else if (name == "links") fill([&](size_t i) { return Real(__builtin_popcount(S.flags[i] & mca::automata::linkBits)); });
	else if (name == "brokenLinks") fill([&](size_t i) { return Real(__builtin_popcount((S.flags[i] >> mca::automata::hadShift) & mca::automata::linkBits) - __builtin_popcount(S.flags[i] & mca::automata::linkBits)); });
	else if (name == "material") fill([&](size_t i) { return Real(S.species[S.speciesOf(i)].material); });
	else {
		string list;
		for (auto& p : plain)
			list += p.first + ", ";
		throw std::runtime_error("McaEngine.field: '" + name + "' is unknown; known are " + list + "equivalentStress, links, brokenLinks, material.");
	}
	return sdk::arrayCopy(out.data(), { Py_ssize_t(out.size()) });
}

py::dict McaEngine::energies()
{
	py::dict d;
	if (!solver) ensureBuilt(Omega::instance().getScene().get());
	const auto a = solver->account();
	d["kinetic"] = a.kinetic, d["volumetric"] = a.volumetric, d["deviatoric"] = a.deviatoric, d["plastic"] = a.plastic, d["viscous"] = a.viscous, d["friction"] = a.friction;
	d["fracture"] = a.fracture, d["coupling"] = a.coupling, d["boundary"] = a.boundary, d["external"] = a.external, d["halfStep"] = a.centre, d["total"] = a.total(), d["bookedError"] = a.bookedError();
	d["bookedVolumetric"] = a.bookedVolumetric, d["bookedDeviatoric"] = a.bookedDeviatoric, d["bookedViscous"] = a.bookedViscous, d["kineticStart"] = a.kineticStart;
	d["momentumX"] = a.px, d["momentumY"] = a.py, d["angularMomentum"] = a.angular, d["impulseX"] = a.impulseX, d["impulseY"] = a.impulseY;
	return d;
}

py::dict McaEngine::counters()
{
	py::dict d;
	if (!solver) return d;
	const auto& c = solver->counters;
	long awake = 0;
	for (auto& b : solver->store.blocks)
		awake += b.awake;
	d["steps"] = c.steps, d["searches"] = c.searches, d["sorts"] = c.sorts, d["blockSteps"] = c.blockSteps, d["blocks"] = long(solver->store.blocks.size()), d["awake"] = awake;
	d["brokenLinks"] = c.brokenLinks, d["clamped"] = c.clamped, d["deepest"] = std::min(c.deepest, 1.), d["contacts"] = long(solver->contacts.size() / 2);
	return d;
}

py::dict McaEngine::phases()
{
	py::dict d;
	if (!solver) return d;
	const auto& c = solver->counters;
	d["search"] = c.nsSearch, d["density"] = c.nsDensity, d["stress"] = c.nsStress, d["contact"] = c.nsContact, d["force"] = c.nsForce, d["fracture"] = c.nsFracture, d["integration"] = c.nsIntegrate;
	return d;
}

py::list McaEngine::linkList()
{
	py::list l;
	if (!solver) ensureBuilt(Omega::instance().getScene().get());
	for (auto& p : solver->links())
		l.append(py::make_tuple(p.first, p.second));
	return l;
}

Vector2r McaEngine::momentum()
{
	if (!solver) ensureBuilt(Omega::instance().getScene().get());
	const auto a = solver->account();
	return Vector2r(a.px, a.py);
}

void McaEngine::setViscous(const vector<int>& ids, const Vector2r& normal)
{
	const Scene* scene = Omega::instance().getScene().get();
	const bool   alongX = std::fabs(normal[0]) > 0;
	if (!(std::fabs(normal.norm() - 1.) < 1e-9 && (normal[0] == 0 || normal[1] == 0)))
		throw std::runtime_error("McaEngine.setViscous: normal must be (1,0), (-1,0), (0,1) or (0,-1).");
	// width of the boundary that one body stands for: extent of the set over the number of bodies in a line
	for (int id : ids) {
		if (id < 0 || size_t(id) >= scene->bodies->body.size() || !scene->bodies->body[id]) throw std::runtime_error("McaEngine.setViscous: there is no body " + std::to_string(id) + ".");
		const auto* m = dynamic_cast<const McaMat*>(scene->bodies->body[id]->material.get());
		if (!m) throw std::runtime_error("McaEngine.setViscous: body " + std::to_string(id) + " has no McaMat.");
	}
	if (ids.empty()) return;
	Real lo = 1e300, hi = -1e300;
	for (int id : ids) {
		const Real t = scene->bodies->body[id]->state->se3.position[alongX ? 1 : 0];
		lo = std::min(lo, t), hi = std::max(hi, t);
	}
	for (int id : ids) {
		const auto& b     = scene->bodies->body[id];
		const auto  mat   = static_cast<const McaMat*>(b->material.get())->toMaterial();
		const Real  d     = 2. * static_cast<Sphere*>(b->shape.get())->radius;
		const Real  width = (hi - lo + d) / ids.size();
		const Real  bn = mat.eos.rho0 * mat.cP() * width, bt = mat.eos.rho0 * mat.cS() * width;
		viscous.push_back(Vector3r(Real(id), alongX ? bn : bt, alongX ? bt : bn));
		if (solver && solver->indexOf(id) >= 0) solver->setDamping(solver->indexOf(id), viscous.back()[1], viscous.back()[2]);
	}
}
} // namespace yade
