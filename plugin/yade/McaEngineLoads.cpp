// SPDX-License-Identifier: GPL-2.0-or-later
// McaEngine: velocities, forces, temperatures and pressures that scripts prescribe as tables of time.
#include "McaBodies.hpp"
#include "McaEngine.hpp"
#include "McaTables.hpp"
#include "McaVec.hpp"
#include <core/Omega.hpp>
#include <core/Scene.hpp>

namespace yade {
using mca::grid::Table;

namespace {
	constexpr unsigned dofs[] = { State::DOF_X, State::DOF_Y, State::DOF_Z };
	constexpr int      velocityOf = 0, forceOf = 1, temperatureOf = 2, pressureOf = 3, kinds = 4;
	constexpr Real     coldest = 0, hottest = 1e9; ///< [K]
} // namespace

/// Of what is saved.
vector<McaEngine::Load> McaEngine::loadList() const
{
	vector<Load> list;
	size_t       id = 0, point = 0;
	for (const Vector3r& v : loadRows) {
		Load l { int(v[0]) / 3, int(v[0]) % 3, {}, {} };
		for (long k = 0; k < long(v[1]); k++) l.ids.push_back(loadIds[id++]);
		for (long k = 0; k < long(v[2]); k++, point++)
			l.table.time.push_back(loadPoints[point][0]), l.table.value.push_back(loadPoints[point][1]);
		list.push_back(l);
	}
	return list;
}

/// Bodies that are gone take their loads along.
void McaEngine::dropLoads(const std::function<bool(int)>& goes)
{
	loadIds.clear();
	for (size_t q = 0; q < loads.size(); q++) {
		auto& ids = loads[q].ids;
		ids.erase(std::remove_if(ids.begin(), ids.end(), goes), ids.end());
		loadRows[q][1] = Real(ids.size());
		loadIds.insert(loadIds.end(), ids.begin(), ids.end());
	}
}

void McaEngine::load(int kind, const vector<int>& ids, const py::object (&along)[3], const char* call)
{
	const string where = string("McaEngine.") + call + ": ";
	if (kind == pressureOf && volumeRule != "affine") throw mca::Error(where + "it needs volumeRule 'affine', not '" + volumeRule + "'.");
	if (ids.empty()) throw mca::Error(where + "ids names no body; give the id of at least one automaton.");
	Table        tables[3];
	bool         given[3];
	const bool   along3 = kind == velocityOf || kind == forceOf; // else a scalar, which stands first
	const char*  scalar = kind == temperatureOf ? "temperature [K]" : "pressure [Pa]";
	for (int c = 0; c < 3; c++)
		if ((given[c] = !along[c].is_none()))
			tables[c] = tableOf(along[c], (where + (along3 ? string(1, char('x' + c)) : scalar)).c_str());
	if (!(given[0] || given[1] || given[2]))
		throw mca::Error(
			where + (along3 ? string("give at least one of x, y, z") : string(scalar) + " is None; it must be given")
			+ ": a number or a pair (times, values).");
	for (Real T : kind == temperatureOf ? tables[0].value : std::vector<double>())
		if (!(T > coldest && T <= hottest)) throw mca::Error(where + "temperature = " + numberText(T) + " K must be above 0 and at most 1e9.");
	locked([&] {
		const auto scene = Omega::instance().getScene();
		settleIn(scene.get());
		if (solver && looked) ensureBuilt(scene.get()); // bodies that have joined since are known, and keep what they get
		const int n = solver ? dimension : dimensionOf(*scene);
		if (n == 2 && given[2]) throw mca::Error(where + "z must be None, left out: it is for bodies in space, and these are in plane strain.");
		for (int id : ids) automatonOf(*scene, id, call); // refuses what is none
		vector<int> sorted(ids);
		std::sort(sorted.begin(), sorted.end());
		if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end())
			throw mca::Error(where + "ids names a body twice; name each once.");
		for (int c = 0; c < n; c++) {
			if (!given[c]) continue;
			for (int id : ids)
				if (kind == velocityOf) automatonOf(*scene, id, call).state->blockedDOFs |= dofs[c];
			loadRows.push_back(Vector3r(Real(kind * 3 + c), Real(ids.size()), Real(tables[c].time.size())));
			loadIds.insert(loadIds.end(), ids.begin(), ids.end());
			for (size_t k = 0; k < tables[c].time.size(); k++) loadPoints.push_back(Vector2r(tables[c].time[k], tables[c].value[k]));
		}
		loads  = loadList();
		looked = true; // blockedDOFs
	});
}

void McaEngine::prescribe(const vector<int>& ids, py::object x, py::object y, py::object z) { load(velocityOf, ids, { x, y, z }, "prescribe"); }
void McaEngine::push(const vector<int>& ids, py::object x, py::object y, py::object z) { load(forceOf, ids, { x, y, z }, "push"); }
void McaEngine::prescribeTemperature(const vector<int>& ids, py::object T) { load(temperatureOf, ids, { T, {}, {} }, "prescribeTemperature"); }
void McaEngine::press(const vector<int>& ids, py::object pressure) { load(pressureOf, ids, { pressure, {}, {} }, "press"); }
void McaEngine::clearLoads()
{
	locked([&] { forgetLoads(); });
}

void McaEngine::forgetLoads() { loadRows.clear(), loadIds.clear(), loadPoints.clear(), loads.clear(); }

/// Forces at the time of the present positions.
void McaEngine::pushLoads(const Scene& scene)
{
	for (const Load& l : loads) {
		if (l.kind != forceOf && l.kind != pressureOf) continue;
		const Real  now = l.table.at(scene.time);
		mca::Triple force {};
		force[size_t(l.axis)] = now;
		if (l.kind == forceOf)
			for (int id : l.ids) solver->addForce(id, force, {});
		else if (now != 0)
			for (int id : l.ids) solver->addPressure(id, now);
	}
}

/// Temperatures with which the stresses of this step are found.
void McaEngine::heatLoads(const Scene& scene)
{
	mca::AutomatonChange to;
	for (const Load& l : loads) {
		if (l.kind != temperatureOf) continue;
		to.temperature = l.table.at(scene.time);
		for (int id : l.ids) solver->set(id, to);
	}
}

/// Velocities of this step: those in its middle, so that the way is that of the table where it is straight.
void McaEngine::driveLoads(const Scene& scene)
{
	for (const Load& l : loads) {
		if (l.kind != velocityOf) continue;
		const Real v = l.table.at(scene.time + 0.5 * scene.dt);
		for (int id : l.ids) solver->drive(id, l.axis, v);
	}
}

/// Throws where a script has set a velocity that a table would overwrite.
void McaEngine::checkDriven(const Body& b, const Vector3r& was) const
{
	for (const Load& l : loads) {
		if (l.kind != velocityOf || b.state->vel[l.axis] == was[l.axis] || std::find(l.ids.begin(), l.ids.end(), b.id) == l.ids.end()) continue;
		refuseBody(
			b,
			string("state.vel along ") + "xyz"[l.axis] + " was set to " + numberText(b.state->vel[l.axis])
				+ " m/s, and prescribe() drives it there: prescribe() another velocity, or clearLoads() first.");
	}
}

/// From a file; throws mca::Error when they are none. of: null where nothing has been gathered yet.
void McaEngine::checkLoads(const mca::Automata* of) const
{
	Real ids = 0, points = 0;
	bool good = true;
	for (const Vector3r& v : loadRows) {
		for (int c = 0; c < 3; c++) good &= v[c] >= (c == 2 ? 1 : 0) && v[c] < 1e9 && v[c] == std::floor(v[c]);
		good &= good && v[0] < 3 * kinds && int(v[0]) % 3 < (v[0] >= 3 * temperatureOf ? 1 : of ? of->dimension() : 3);
		ids += v[1], points += v[2];
	}
	good &= ids == Real(loadIds.size()) && points == Real(loadPoints.size());
	for (int id : loadIds) good &= of ? of->holds(id) : id >= 0;
	for (const Load& l : good ? loadList() : vector<Load>()) {
		l.table.validate("a prescribed velocity, force, temperature or pressure");
		for (Real T : l.table.value) good &= l.kind != temperatureOf || (T > coldest && T <= hottest);
	}
	if (!good) throw mca::Error("McaEngine: the prescribed velocities and forces in the file are none; the file is damaged or was edited.");
}
} // namespace yade
