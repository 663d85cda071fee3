// SPDX-License-Identifier: GPL-2.0-or-later
// The parts of the scene that Python does not set as attributes: compared with what Python reports.
#include "Probe.hpp"
#include <sdk/layout.hpp>

namespace yade {
namespace sdk __attribute__((visibility("hidden"))) {
	namespace {
		void checkBody(Probe& probe)
		{
			// parts given in Python must be found through the pointers of the declaration
			py::object       wrapper = py::import("yade.wrapper");
			py::object body = wrapper.attr("Body")(), shape = wrapper.attr("Sphere")(), material = wrapper.attr("FrictMat")();
			body.attr("shape") = shape;
			body.attr("mat")   = material;
			const Body&     b  = py::extract<const Body&>(body)();
			probe.check(b.shape.get() == static_cast<Shape*>(py::extract<Sphere*>(shape)()), "Body.shape is not where the declarations have it");
			probe.check(
				b.material.get() == static_cast<Material*>(py::extract<FrictMat*>(material)()),
				"Body.material is not where the declarations have it");
			probe.check(probe.isObject(b.state.get(), "State"), "Body.state is not where the declarations have it");
			probe.check(
				!b.bound && b.intrs.empty() && b.clumpId == Body::ID_NONE,
				"Body.bound, intrs or clumpId is not where the declarations have it");
			if (!probe.failed()) {
				const State& s = *b.state;
				probe.check(
					&s.pos == &s.se3.position && &s.ori == &s.se3.orientation,
					"State.pos and ori are not where the declarations have them");
			}
		}
		void checkTiming(Probe& probe)
		{
			py::object       engine = py::import("yade.wrapper").attr("ForceResetter")();
			Engine&          e      = py::extract<Engine&>(engine);
			engine.attr("execTime")  = 11;
			engine.attr("execCount") = 12;
			probe.check(e.timingInfo.nsec == 11 && e.timingInfo.nExec == 12, "Engine.timingInfo is not where the declarations have it");
			probe.check(!e.timingDeltas, "Engine.timingDeltas is not where the declarations have it");
			if (probe.failed()) return;
			e.timingDeltas = shared_ptr<TimingDeltas>(new TimingDeltas);
			e.timingDeltas->labels.push_back("guard");
			e.timingDeltas->data.resize(1);
			e.timingDeltas->data[0].nsec  = 21;
			e.timingDeltas->data[0].nExec = 22;
			const py::list data(engine.attr("timingDeltas").attr("data"));
			probe.check(
				py::len(data) == 1 && data[0] == py::make_tuple("guard", 21, 22),
				"TimingDeltas is laid out otherwise than the declarations have it");
			e.timingDeltas.reset();
		}
		void checkEnergy(Probe& probe)
		{
			py::object       tracker = py::import("yade.wrapper").attr("EnergyTracker")();
			EnergyTracker&   t       = py::extract<EnergyTracker&>(tracker);
			const auto&      a       = t.energies;
			const size_t     n       = omp_get_max_threads();
			tracker[string("guard")] = 2.5;
			probe.check(
			        a.nThreads == n && a.chunks.size() == n && a.perCL == a.CLS / int(sizeof(Real)) && a.sz == 1,
			        "EnergyTracker.energies is not where the declarations have it");
			probe.check(t.names.size() == 1 && t.resetStep.size() == 1, "EnergyTracker.names or resetStep is not where the declarations have it");
			const Real expected = 2.5;
			if (!probe.failed())
				probe.check(probe.equal(a.chunks[0], &expected, sizeof expected), "EnergyTracker keeps values otherwise than declared");
		}
	}

	void checkScene(Probe& probe)
	{
		checkBody(probe);
		checkTiming(probe);
		checkEnergy(probe);
		const py::object O = py::import("yade").attr("O");
		Scene&           s = *Omega::instance().getScene();
		probe.check(
			s.dt == py::extract<Real>(O.attr("dt")) && s.iter == py::extract<long>(O.attr("iter")), "Scene.dt or iter differs from O.dt, O.iter");
		const auto count = [&](const char* name) { return size_t(py::len(O.attr(name))); };
		probe.check(s.engines.size() == count("engines"), "Scene.engines is not where the declarations have it");
		probe.check(s.materials.size() == count("materials"), "Scene.materials is not where the declarations have it");
		probe.check(probe.isObject(s.bodies.get(), "BodyContainer"), "Scene.bodies is not where the declarations have it");
		probe.check(probe.isObject(s.interactions.get(), "InteractionContainer"), "Scene.interactions is not where the declarations have it");
		probe.check(probe.isObject(s.energy.get(), "EnergyTracker"), "Scene.energy is not where the declarations have it");
		probe.check(probe.isObject(s.cell.get(), "Cell"), "Scene.cell is not where the declarations have it");
		if (probe.failed()) return;
		probe.check(s.bodies->body.size() == count("bodies"), "BodyContainer.body is not where the declarations have it");
		probe.check(s.interactions->bodies == &s.bodies->body, "InteractionContainer.bodies is not where the declarations have it");
		probe.check(s.interactions->currSize == count("interactions"), "InteractionContainer.currSize is not where the declarations have it");
		// members at the far end of the containers
		py::object       bodies = O.attr("bodies");
		const bool       before = s.bodies->enableRedirection;
		bodies.attr("enableRedirection") = !before;
		probe.check(s.bodies->enableRedirection == !before, "BodyContainer.enableRedirection is not where the declarations have it");
		bodies.attr("enableRedirection") = before;
		py::object       interactions = O.attr("interactions");
		const bool       sorted       = s.interactions->serializeSorted;
		interactions.attr("serializeSorted") = !sorted;
		probe.check(s.interactions->serializeSorted == !sorted, "InteractionContainer.serializeSorted is not where the declarations have it");
		interactions.attr("serializeSorted") = sorted;
		probe.check(s.forces.getNumAllocatedThreads() == omp_get_max_threads(), "Scene.forces is not where the declarations have it");
		probe.check(
			s.forces.syncCount == py::extract<unsigned long>(O.attr("forces").attr("syncCount")),
			"ForceContainer.syncCount is not where the declarations have it");
	}
} // namespace sdk
} // namespace yade
