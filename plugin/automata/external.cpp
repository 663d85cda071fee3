// SPDX-License-Identifier: GPL-2.0-or-later
// What others do to the automata: forces, transmitting boundaries, ties to a grid, changes of place.
#include "../kernels/automaton/energy.hpp"
#include "parallel.hpp"
#include <algorithm>
#include <cmath>
#include <sstream>

namespace mca::automata {

void Solver::addForce(size_t i, Vec<double> force, Turn<double> torque)
{
	Store& S = store;
	if (S.outside.empty()) S.outside.resize(S.size()), S.outsideTorque.resize(S.size());
	pushed.resize(S.blocks.size()), pushed[i / blockSize] = 1;
	S.outside.add(i, force), addTurn(S.outsideTorque, i, torque);
	if (!isZero(force) || !isZero(torque)) {
		if (!S.blocks[i / blockSize].moving) topologyChanged = true;
		S.blocks[i / blockSize].moving = true;
	}
}

void Solver::clearForces()
{
	for (size_t b = 0; b < pushed.size(); b++) {
		if (!pushed[b]) continue;
		const auto first = std::ptrdiff_t(b * blockSize);
		eachPlane([&](auto& v) { std::fill(v.begin() + first, v.begin() + first + blockSize, 0.); }, store.outside, store.outsideTorque);
		pushed[b] = 0;
	}
}

void Solver::drive(size_t i, int axis, double velocity)
{
	Store&       S = store;
	const double before = S.velocity[axis][i];
	const auto   who = "automaton " + std::to_string(S.id[i]);
	if (S.flags[i] & tiedBit) throw Error(who + " is tied to a grid, which moves it; its velocity cannot be prescribed.");
	if (S.perMass[axis][i] != 0.) throw Error(who + " has a prescribed velocity and is free to move in that direction; block it (blockedDOFs).");
	if (velocity == before) return;
	if (options.account)
		sums.external += 0.5 * S.mass[i] * (velocity * velocity - before * before), sums.impulse[axis] += S.mass[i] * (velocity - before);
	S.velocity[axis][i] = velocity;
	if (!S.blocks[i / blockSize].moving) S.blocks[i / blockSize].moving = topologyChanged = true;
}

void Solver::resist(double share)
{
	Store& S = store;
	if (S.outside.empty()) S.outside.resize(S.size()), S.outsideTorque.resize(S.size());
	pushed.resize(S.blocks.size());
	const auto against = [share](double all, double v) { return v > 0. ? -share * std::fabs(all) : v < 0. ? share * std::fabs(all) : 0.; };
	eachAwake([&](size_t b) {
		pushed[b] = 1;
		for (size_t i = b * blockSize; i < b * blockSize + size_t(S.blocks[b].count); i++) {
			for (int c = 0; c < dim; c++)
				if (S.perMass[c][i] > 0) S.outside[c][i] += against(S.force[c][i] + S.outside[c][i], S.velocity[c][i]);
			for (int c = 0; c < turns; c++)
				if (turnPlane(S.perInertia, c)[i] > 0)
					turnPlane(S.outsideTorque, c)[i]
						+= against(turnPlane(S.torque, c)[i] + turnPlane(S.outsideTorque, c)[i], turnPlane(S.omega, c)[i]);
		}
	});
}

Vec<double> Solver::perPressure(size_t i) const
{
	const Store&         S = store;
	const Tensor<double> own = unitPush(S, i);
	Vec<double>          force {};
	for (int k = 0; k < nLinks; k++)
		if (holds(S.flags[i], k)) force += unitPushOfLink(S, i, k, own, unitPush(S, size_t(S.neighbour[linkSlot(i, k)]))) * -1.;
	return force;
}

namespace {
	/// The volume ratio at which the pressure is p, from the present state on, and the state there.
	struct Compressed {
		double        J;
		PressureState now;
	};
	Compressed compressTo(const Store& S, size_t i, double p)
	{
		const Material&     m = S.materialOf(i);
		const PressureState old { S.P[i], S.heat.empty() ? 0. : S.heat[i] };
		return dispatch(m.eos.kind, [&](auto law) {
			const VolumeConstants<law.value> c(m, S.diameter[i]);
			const auto                       at = [&](double J) { return pressureStep(c, J, S.J[i], old, true); };
			double                           low = 0.5, high = 1.5; // of J: the pressure falls with it
			if (!(at(low).P > p && at(high).P < p)) {
				std::ostringstream s;
				s << "automaton " << S.id[i] << ": the equation of state has no pressure of " << p
				  << " Pa at volume ratios from 0.5 to 1.5; those it has go from " << at(high).P << " to " << at(low).P << " Pa.";
				throw Error(s.str());
			}
			for (int n = 0; n < 100; n++) {
				const double J = 0.5 * (low + high);
				(at(J).P > p ? low : high) = J;
			}
			return Compressed { low, at(low) };
		});
	}
}

void Solver::checkStress(size_t i, double pressure, const Deviator& deviator) const
{
	const Store&    S = store;
	const Material& m = S.materialOf(i);
	const auto      refuse = [&](const std::string& what) { throw Error("automaton " + std::to_string(S.id[i]) + ": " + what); };
	const auto      text = [](double v) {
                std::ostringstream s;
                s << v;
                return s.str();
	};
	if (options.volumeRule != VolumeRule::affine) refuse("a stress can be put in with volumeRule 'affine' only.");
	const double sigma = deviator.mises();
	const double yield = dispatch(m.yield.kind, [&](auto law) {
		return LawOf<law.value>::yields ? staticYield<law.value>(m.yield, S.eqps[i], S.temperature[i]).stress : std::numeric_limits<double>::infinity();
	});
	if (sigma > yield * (1. + 1e-12) || (m.G == 0. && sigma > 0.))
		refuse("the stress has a Mises stress of " + text(sigma) + " Pa, and the material flows at " + text(m.G == 0. ? 0. : yield)
		       + " Pa (plastic strain " + text(S.eqps[i]) + ", " + text(S.temperature[i]) + " K); give less.");
	if (S.factor[i] > 0.) compressTo(S, i, pressure);
}

void Solver::setStress(size_t i, double pressure, const Deviator& deviator)
{
	checkStress(i, pressure, deviator);
	Store&          S = store;
	const Material& m = S.materialOf(i);
	const auto energy = [&] { return volumeEnergy(m, S.cell[i], S.J[i], S.heat.empty() ? 0. : S.heat[i]); };
	const double     volumetric = energy(), deviatoric = deviatorEnergyOf(i);
	if (S.factor[i] > 0.) {
		const Compressed to = compressTo(S, i, pressure);
		S.J[i] = to.J, S.P[i] = S.mean[i] = to.now.P, S.dTheta[i] = 0.;
		if (!S.heat.empty()) S.heat[i] = to.now.e;
		S.factor[i] = affineFactor(to.J, S.rest[i], determinantNow(i));
	}
	setDeviator(S, i, deviator);
	if (!(S.factor[i] > 0.)) deviatorToSides(S, i);
	sums.leftVolumetric -= energy() - volumetric, sums.leftDeviatoric -= deviatorEnergyOf(i) - deviatoric;
	sums.left -= energy() - volumetric + deviatorEnergyOf(i) - deviatoric;
	S.blocks[i / blockSize].moving = topologyChanged = true;
}

void Solver::setDamping(size_t i, Vec<double> b)
{
	Store& S = store;
	if (!std::all_of(b.component, b.component + dim, [](double v) { return v >= 0 && std::isfinite(v); })) {
		std::ostringstream s;
		s << "automaton " << S.id[i] << ": viscous boundary coefficient " << b << " kg/(m s) must be finite and not negative (rho c A).";
		throw Error(s.str());
	}
	if (S.damp.empty()) S.damp.resize(S.size());
	S.damp.set(i, b);
}

size_t Solver::tie(size_t i, bool freeSpin)
{
	Store& S = store;
	if (S.flags[i] & tiedBit) throw Error("automaton " + std::to_string(S.id[i]) + " is tied already.");
	S.flags[i] |= tiedBit;
	S.perMass.set(i, {});
	if (!freeSpin) setTurn(S.perInertia, i, {});
	tied.push_back(int32_t(i)), tiedVelocity.push_back(S.velocity.at(i)), tiedSpin.push_back(turnAt(S.omega, i));
	sums.kineticStart -= 0.5 * (S.mass[i] * plainSquare(S.velocity.at(i)) + (turnsFreely(i) ? 0. : S.inertia[i] * plainSquare(turnAt(S.omega, i))));
	return tied.size() - 1;
}

void Solver::setTiedVelocity(size_t t, Vec<double> velocity, Turn<double> omega)
{
	Store&       S = store;
	const size_t i = tied[t];
	tiedVelocity.set(t, S.velocity.at(i)), setTurn(tiedSpin, t, turnAt(S.omega, i));
	S.velocity.set(i, velocity);
	if (!turnsFreely(i)) setTurn(S.omega, i, omega);
	if ((!isZero(velocity) || !isZero(omega)) && !S.blocks[i / blockSize].moving) S.blocks[i / blockSize].moving = topologyChanged = true;
}

void Solver::moved()
{
	lastMove        = 0.;
	topologyChanged = searchDue = true;
	for (auto& B : store.blocks)
		B.moving = B.awake = true;
}
}
