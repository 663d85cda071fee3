// SPDX-License-Identifier: GPL-2.0-or-later
#include "McaGridEngine.hpp"
#include <core/Omega.hpp>
#include <core/Scene.hpp>

namespace yade {
YADE_PLUGIN((McaGridEngine));

mca::grid::Grid& McaGridEngine::grid()
{
	if (!solver) {
		mca::grid::GridOptions o;
		o.account = account;
		o.skip    = sleeping;
		solver    = shared_ptr<mca::grid::Grid>(new mca::grid::Grid(o));
	}
	return *solver;
}

Real McaGridEngine::criticalTimeStep() const { return solver && solver->blocks() ? solver->criticalTimeStep() : std::numeric_limits<Real>::infinity(); }

void McaGridEngine::computeForces(Scene* s)
{
	grid().setThreads(ompThreads);
	if (solver->between()) { // something has stopped the step half-way: it is finished as it was begun
		s->dt = solver->stepBegun();
		return;
	}
	solver->computeForces(s->dt);
}

void McaGridEngine::integrate(Scene* s)
{
	grid().integrate(s->dt);
	if (!s->trackEnergy) return;
	const mca::grid::Energy e        = solver->energy();
	const char*             names[]  = { "gridKinetic", "gridInternal", "gridLoads", "gridExternal", "gridConstraints", "gridViscous" };
	const Real              values[] = { e.kinetic, e.internal, -e.workLoads, -e.workExternal, -e.workConstraints, -e.workViscous };
	for (int k = 0; k < 6; k++)
		s->energy->set(values[k], names[k], energyIndex[k]);
}

void McaGridEngine::step()
{
	findCoupler(scene);
	locked([&] {
		if (coupled) return computeForces(scene);
		if (!(dtFactor > 0 && dtFactor <= 1))
			throw mca::Error("McaGridEngine: dtFactor = " + std::to_string(dtFactor) + " must be above 0 and at most 1.");
		if (adaptive && grid().blocks()) {
			const Real limit = dtFactor * grid().criticalTimeStep();
			scene->dt        = solver->steps() > 0 && scene->dt > 0 ? std::min(limit, 1.1 * scene->dt) : limit;
		}
		timingDeltas->start();
		computeForces(scene);
		timingDeltas->checkpoint("cells and inner nodes");
		integrate(scene);
		timingDeltas->checkpoint("open nodes");
	});
}

void McaGridEngine::preSave(McaGridEngine&)
{
	locked([&] {
		state.clear();
		if (!solver) return;
		const vector<char> bytes = solver->save();
		state.put(bytes);
	});
}

void McaGridEngine::postLoad(McaGridEngine&)
{
	if (state.empty()) return;
	vector<char>    bytes;
	sdk::BlobReader in(state);
	in.get(bytes);
	in.end();
	auto fresh = shared_ptr<mca::grid::Grid>(new mca::grid::Grid());
	fresh->restore(bytes);
	solver = fresh;
	pressures.clear();
	state.clear();
}

long McaGridEngine::cellCount() const
{
	return locked([&] {
		long n = 0;
		for (int b = 0; solver && b < solver->blocks(); b++)
			n += long(solver->block(b).ni) * solver->block(b).nj;
		return n;
	});
}
} // namespace yade
