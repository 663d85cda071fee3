// SPDX-License-Identifier: GPL-2.0-or-later
#include "automata.hpp"
#include "solver.hpp"
#include "start.hpp"
#include "walls.hpp"

namespace mca::automata {
namespace {
	[[maybe_unused]] Triple tripleOf(double about) { return { 0., 0., about }; }
	Triple tripleOf(const Vec<double>& v)
	{
		Triple t {};
		for (int c = 0; c < dim; c++) t[size_t(c)] = v[c];
		return t;
	}
	Ways openWays(const Vectors& inverse, size_t i)
	{
		Ways free {};
		for (int c = 0; c < dim; c++) free[size_t(c)] = inverse[c][i] > 0;
		return free;
	}
	Ways openTurns(const Turns& inverse, size_t i)
	{
		Ways free {};
		for (int c = 0; c < turns; c++) free[size_t(3 - turns + c)] = turnPlane(inverse, c)[i] > 0;
		return free;
	}
	template <class S> mca::plane::automata::Solver* ifPlane(S& solver)
	{
		if constexpr (std::is_same_v<S, mca::plane::automata::Solver>) return &solver;
		else return nullptr;
	}

	class OfThisDimension final : public Automata {
	public:
		int dimension() const override { return dim; }
		mca::plane::automata::Solver* asPlane() override { return ifPlane(solver); }
		void build(const std::vector<AutomatonStart>& given, const std::vector<Material>& materials, const AutomataOptions& options,
		           const Automata* old) override
		{
			std::vector<Automaton> list;
			for (const AutomatonStart& a : given) list.push_back(startOf(a));
			solver.build(list, materials, options, old ? &static_cast<const OfThisDimension*>(old)->solver : nullptr);
		}
		void   computeForces() override { solver.computeForces(); }
		void   integrate(double dt) override { solver.integrate(dt), walls.keep(); }
		double kick(double dt) const override { return solver.kick(dt); }
		double criticalStep() const override { return walls.limit(solver.criticalStep()); }
		int    stiffest() const override { return solver.store.id[solver.stiffestAutomaton()]; }

		void addForce(int id, const Triple& force, const Triple& torque) override { solver.addForce(at(id), vectorOf(force), turnOf(torque)); }
		void drive(int id, int axis, double velocity) override { solver.drive(at(id), axis, velocity); }
		void addGravity(const Triple& acceleration) override
		{
			for (size_t i = 0; i < S.size(); i++)
				if (S.id[i] >= 0) solver.addForce(i, vectorOf(acceleration) * S.mass[i], {});
		}
		void addPressure(int id, double pressure) override { solver.addForce(at(id), solver.perPressure(at(id)) * -pressure, {}); }
		void resist(double share) override { solver.resist(share); }
		void checkStress(int id, double pressure, const Deviator& deviator) const override { solver.checkStress(at(id), pressure, deviator); }
		void setStress(int id, double pressure, const Deviator& deviator) override { solver.setStress(at(id), pressure, deviator); }
		void setPairRules(const PairRules& rules, bool loaded) override { solver.setPairRules(rules, loaded); }
		void clearForces() override { solver.clearForces(); }
		bool hasForces() const override { return !S.outside.empty(); }
		void setDamping(int id, const Triple& b) override { solver.setDamping(at(id), vectorOf(b)); }
		void set(int id, const AutomatonChange& c) override
		{
			const size_t i = at(id);
			if (c.position) S.position.set(i, vectorOf(*c.position));
			if (c.velocity) S.velocity.set(i, vectorOf(*c.velocity));
			if (c.spin) setTurn(S.omega, i, turnOf(*c.spin));
			if (c.angle) setTurn(S.angle, i, turnOf(*c.angle));
			if (c.plasticStrain) S.eqps[i] = *c.plasticStrain;
			if (c.damage) S.damage[i] = *c.damage;
			if (c.temperature) S.temperature[i] = *c.temperature;
			if (c.strength) S.strength[i] = *c.strength;
			if (c.group) S.group[i] = *c.group;
			for (int k = 0; c.free && k < dim; k++) S.perMass[k][i] = (*c.free)[size_t(k)] ? 1. / S.mass[i] : 0.;
			for (int k = 0; c.freeSpin && k < turns; k++)
				turnPlane(S.perInertia, k)[i] = (*c.freeSpin)[size_t(3 - turns + k)] ? 1. / S.inertia[i] : 0.;
		}
		void moved() override { solver.moved(), walls.forget(); }
		void setWalls(const std::vector<WallStart>& list) override { walls.set(list); }
		const std::vector<WallPush>& pushWalls(const std::vector<WallPlace>& at, double level) override { return walls.push(solver, at, level); }
		std::vector<WallTouch> wallTouches() const override { return walls.touches(); }
		void                   setWallTouches(const std::vector<WallTouch>& list) override { walls.setTouches(list); }
		void searchAnew() override { solver.searchAnew(); }

		bool           holds(int id) const override { return solver.indexOf(id) >= 0; }
		AutomatonFixed fixed(int id) const override
		{
			const size_t   i = at(id);
			AutomatonFixed a;
			a.mass = S.mass[i], a.inertia = S.inertia[i], a.diameter = S.diameter[i], a.strength = S.strength[i];
			a.material = S.species[size_t(S.speciesOf(i))].material, a.group = S.group[i];
			a.free = openWays(S.perMass, i), a.freeSpin = openTurns(S.perInertia, i), a.tied = S.flags[i] & tiedBit;
			return a;
		}
		AutomatonNow now(int id) const override
		{
			const size_t i = at(id);
			AutomatonNow a;
			a.position = tripleOf(S.position.at(i)), a.velocity = tripleOf(S.velocity.at(i));
			a.spin = tripleOf(turnAt(S.omega, i)), a.angle = tripleOf(turnAt(S.angle, i));
			a.pressure = S.mean[i], a.volumeRatio = S.J[i], a.plasticStrain = S.eqps[i], a.temperature = S.temperature[i];
			a.equivalentStress = solver.equivalentStress(i), a.stressZZ = S.szz[i], a.tension = S.P[i] < 0 ? S.P[i] : 0.;
			if (!S.heat.empty()) a.dissipated = S.heat[i];
			if (!S.damage.empty()) a.damage = S.damage[i];
			a.links = linkCount(S.flags[i]), a.brokenLinks = brokenCount(S.flags[i]);
			return a;
		}
		size_t                       tiedCount() const override { return solver.tiedCount(); }
		const std::vector<Material>& materials() const override { return S.materials; }
		AccountOf<Triple, Triple>    account() const override
		{
			const Account             a = solver.account();
			AccountOf<Triple, Triple> b;
			b.kinetic = a.kinetic, b.volumetric = a.volumetric, b.deviatoric = a.deviatoric, b.plastic = a.plastic, b.viscous = a.viscous;
			b.friction = a.friction, b.fracture = a.fracture, b.coupling = a.coupling, b.boundary = a.boundary;
			b.left = a.left, b.external = a.external;
			b.leftMass = a.leftMass, b.leftKinetic = a.leftKinetic, b.leftVolumetric = a.leftVolumetric, b.leftDeviatoric = a.leftDeviatoric;
			b.leftMomentum = tripleOf(a.leftMomentum);
			b.bookedVolumetric = a.bookedVolumetric, b.bookedDeviatoric = a.bookedDeviatoric, b.bookedViscous = a.bookedViscous;
			b.centre = a.centre, b.kineticStart = a.kineticStart, b.heated = a.heated;
			b.momentum = tripleOf(a.momentum), b.angular = tripleOf(a.angular), b.impulse = tripleOf(a.impulse);
			return b;
		}
		std::vector<std::pair<int32_t, int32_t>> links() const override { return solver.links(); }
		BrokenLinks brokenLinks() const override
		{
			const auto& b = solver.broken;
			BrokenLinks l;
			l.time = b.time, l.first.assign(b.first.begin(), b.first.end()), l.second.assign(b.second.begin(), b.second.end());
			l.cause.assign(b.cause.begin(), b.cause.end());
			for (size_t q = 0; q < b.time.size(); q++)
				l.middle.push_back(tripleOf(b.middle.at(q))), l.normal.push_back(tripleOf(b.normal.at(q)));
			return l;
		}
		CohesivePairs cohesivePairs() const override
		{
			const Bonds&  b = solver.bonds;
			CohesivePairs p;
			p.first.assign(b.first.begin(), b.first.end()), p.second.assign(b.second.begin(), b.second.end());
			for (size_t q = 0; q < b.size(); q++)
				p.opening.push_back(wide(sideOf(b, q), S.between(size_t(solver.indexOf(p.first[q])), size_t(solver.indexOf(p.second[q]))))),
					p.spent.push_back(shareSpent(b.at(q)));
			return p;
		}
		size_t cut(const std::vector<std::pair<int32_t, int32_t>>& pairs) override { return solver.cut(pairs); }
		std::vector<double> quantity(const std::vector<int>& ids, const std::string& name, const std::string& call) const override;
		Work work() const override
		{
			Work w { long(S.blocks.size()), 0, long(solver.contacts.size() / 2) };
			for (const Block& b : S.blocks) w.awake += b.awake;
			return w;
		}

		AutomataOptions&        options() override { return solver.options; }
		const AutomataCounters& counters() const override { return solver.counters; }
		void                    setTiming(bool on) override { solver.timing = on; }
		std::string save() const override { return solver.save(); }
		void        load(const std::string& bytes) override { solver.load(bytes); }
		void        checkOrder(const std::vector<int>& ids) const override { solver.checkOrder(ids); }

	private:
		Solver solver;
		Walls  walls;
		Store& S = solver.store;
		size_t at(int id) const { return size_t(solver.indexOf(id)); }
	};

	std::vector<double> OfThisDimension::quantity(const std::vector<int>& ids, const std::string& name, const std::string& call) const
	{
		std::vector<double> found;
		const auto each = [&](auto value) {
			found.reserve(ids.size());
			for (int id : ids) found.push_back(double(value(at(id))));
			return found;
		};
		bool        known = false;
		std::string list;
		S.eachShown([&](const char* shown, const auto& from) {
			list += std::string(shown) + ", ";
			if (name == shown) known = true, each([&](size_t i) { return from.empty() ? 0. : from[i]; }); // empty: no material uses it
		});
		if (known) return found;
		if (name == "equivalentStress") return each([&](size_t i) { return solver.equivalentStress(i); });
		if (name == "links") return each([&](size_t i) { return linkCount(S.flags[i]); });
		if (name == "brokenLinks") return each([&](size_t i) { return brokenCount(S.flags[i]); });
		if (name == "material") return each([&](size_t i) { return S.species[size_t(S.speciesOf(i))].material; });
		throw Error(
			"McaEngine." + call + " = '" + name + "' is unknown; it must be one of " + list + "equivalentStress, links, brokenLinks, material.");
	}
}
}

namespace mca::MCA_SPACE {
std::unique_ptr<Automata> makeAutomata() { return std::make_unique<automata::OfThisDimension>(); }
double                    cellOf(double diameter) { return Lattice::cell(diameter); }
}
