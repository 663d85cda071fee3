// SPDX-License-Identifier: GPL-2.0-or-later
// McaEngine: velocities and forces that scripts prescribe as tables of time.
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
	constexpr int      velocityOf = 0, forceOf = 1; ///< kinds

	/// Where the numbers of a load stand: kind * 3 + axis, number of bodies, number of points.
	struct LoadRow {
		int kind, axis;
		long bodies, points;
		explicit LoadRow(const Vector3r& v) : kind(int(v[0]) / 3), axis(int(v[0]) % 3), bodies(long(v[1])), points(long(v[2])) { }
	};
	Table tableAt(const vector<Vector2r>& points, long first, long n)
	{
		Table t;
		for (long k = first; k < first + n; k++) t.time.push_back(points[size_t(k)][0]), t.value.push_back(points[size_t(k)][1]);
		return t;
	}
} // namespace

/// f(row, its bodies' first place in loadIds, its table) for all loads.
template <class F> void McaEngine::eachLoad(F&& f) const
{
	long id = 0, point = 0;
	for (const Vector3r& v : loadRows) {
		const LoadRow row(v);
		f(row, id, tableAt(loadPoints, point, row.points));
		id += row.bodies, point += row.points;
	}
}

/// Bodies that are gone take their loads along.
void McaEngine::dropLoads(const std::function<bool(int)>& goes)
{
	vector<int>      ids;
	vector<Vector3r> rows;
	eachLoad([&](const LoadRow& row, long first, const Table&) {
		const size_t before = ids.size();
		for (long k = first; k < first + row.bodies; k++)
			if (!goes(loadIds[size_t(k)])) ids.push_back(loadIds[size_t(k)]);
		rows.push_back(Vector3r(Real(row.kind * 3 + row.axis), Real(ids.size() - before), Real(row.points)));
	});
	loadIds.swap(ids), loadRows.swap(rows);
}

void McaEngine::load(int kind, const vector<int>& ids, const py::object (&along)[3], const char* call)
{
	const string where = string("McaEngine.") + call + ": ";
	if (ids.empty()) throw mca::Error(where + "ids names no body; give the id of at least one automaton.");
	Table        tables[3];
	bool         given[3];
	for (int c = 0; c < 3; c++)
		if ((given[c] = !along[c].is_none())) tables[c] = tableOf(along[c], (where + char('x' + c)).c_str());
	if (!(given[0] || given[1] || given[2])) throw mca::Error(where + "give at least one of x, y, z: a number or a pair (times, values).");
	locked([&] {
		const auto scene = Omega::instance().getScene();
		settleIn(scene.get());
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
		looked = true; // blockedDOFs
	});
}

void McaEngine::prescribe(const vector<int>& ids, py::object x, py::object y, py::object z) { load(velocityOf, ids, { x, y, z }, "prescribe"); }
void McaEngine::push(const vector<int>& ids, py::object x, py::object y, py::object z) { load(forceOf, ids, { x, y, z }, "push"); }
void McaEngine::clearLoads()
{
	locked([&] { forgetLoads(); });
}

void McaEngine::forgetLoads() { loadRows.clear(), loadIds.clear(), loadPoints.clear(); }

/// Forces at the time of the present positions.
void McaEngine::pushLoads(const Scene& scene)
{
	eachLoad([&](const LoadRow& row, long first, const Table& table) {
		if (row.kind != forceOf) return;
		mca::Triple force {};
		force[size_t(row.axis)] = table.at(scene.time);
		for (long k = first; k < first + row.bodies; k++) solver->addForce(loadIds[size_t(k)], force, {});
	});
}

/// Velocities of this step: those in its middle, so that the way is that of the table where it is straight.
void McaEngine::driveLoads(const Scene& scene)
{
	eachLoad([&](const LoadRow& row, long first, const Table& table) {
		if (row.kind != velocityOf) return;
		const Real v = table.at(scene.time + 0.5 * scene.dt);
		for (long k = first; k < first + row.bodies; k++) solver->drive(loadIds[size_t(k)], row.axis, v);
	});
}

/// From a file; throws mca::Error when they are none.
void McaEngine::checkLoads(const mca::Automata& of) const
{
	Real ids = 0, points = 0;
	bool good = true;
	for (const Vector3r& v : loadRows) {
		for (int c = 0; c < 3; c++) good &= v[c] >= (c == 2 ? 1 : 0) && v[c] < 1e9 && v[c] == std::floor(v[c]);
		good &= good && v[0] < 6 && int(v[0]) % 3 < of.dimension();
		ids += v[1], points += v[2];
	}
	good &= ids == Real(loadIds.size()) && points == Real(loadPoints.size());
	for (int id : loadIds) good &= of.holds(id);
	if (good) eachLoad([](const LoadRow&, long, const Table& t) { t.validate("a prescribed velocity or force"); });
	if (!good) throw mca::Error("McaEngine: the prescribed velocities and forces in the file are none; the file is damaged or was edited.");
}
} // namespace yade
