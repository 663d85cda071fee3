// SPDX-License-Identifier: GPL-2.0-or-later
// Plastic shock before a piston, in four directions of the packing. The column is periodic across: a skin of three links around it is driven with the motion of
// the automata whose images they are, so that whoever is inside has all neighbours. Compiled with MCA_DIM = 3.
#include "../unit/space_scene.hpp"
#include <map>
using namespace spacetest;

namespace {
constexpr double G = 0.48, slope = 1.49;
const double     strength = std::getenv("MCA_STRENGTH") ? std::atof(std::getenv("MCA_STRENGTH")) : 0.01;

struct Direction {
	const char* name;
	Vec<double> along, across;   ///< axes of the packing along the column and across it
	double      second, third;   ///< periods across [d]
};
const Direction directions[] = {
	{ "100", { 1, 0, 0 }, { 0, 1, 1 }, 1., 1. },
	{ "110", { 1, 1, 0 }, { 0, 0, 1 }, std::sqrt(2.), 1. },
	{ "111", { 1, 1, 1 }, { 1, -1, 0 }, 1., std::sqrt(3.) },
	{ "123", { 1, 2, 3 }, { 2, -1, 0 }, std::sqrt(10.), std::sqrt(35.) },
};

/// Elastic precursor and plastic wave of a solid of perfect plasticity by the jump conditions: speed over the material and pressure behind.
struct Theory {
	double speed, pressure;
	explicit Theory(double U)
	{
		const Material m      = plain(G, strength, slope);
		const auto     stress = [&](double e, double s) { return pressure_(m, e) + s; }; // e: volume strain, s: deviator along, compression positive
		// elastic limit: deviator 2/3 Y, strain Y/(2G) of a uniaxial strain
		const double e1 = -strength / (2. * G), s1 = stress(e1, 2. * strength / 3.), D1 = std::sqrt(s1 / -e1), u1 = D1 * -e1;
		double low = e1, high = -0.5;
		for (int k = 0; k < 200; k++) { // behind the plastic wave: (s - s1)(e1 - e) = (U - u1)^2
			const double e = 0.5 * (low + high), s = stress(e, 2. * strength / 3.);
			((s - s1) * (e1 - e) < (U - u1) * (U - u1) ? low : high) = e;
		}
		const double s = stress(low, 2. * strength / 3.);
		speed = std::sqrt((s - s1) / (e1 - low)), pressure = pressure_(m, low);
	}
	static double pressure_(const Material& m, double e) { return mca::pressure(m.eos, e); }
};

struct Column {
	Solver              s;
	std::vector<int>    ghost, image; ///< numbers
	std::vector<double> at;           ///< along the column at the start, by number
	std::vector<char>   inside;
	double              period[2];
	Column(const Direction& q, double length, double U, double thickness)
	{
		const Material m = [] { Material a = plain(G, strength, slope); a.viscosity = { 0.5, 2. }; return a; }();
		period[0] = q.second * std::max(1., std::round(thickness / q.second)), period[1] = q.third * std::max(1., std::round(thickness / q.third));
		const double skin = 3.6, off = 1e-6;
		const auto within = [&](Vec<double> p) {
			const double x = std::fabs(p[0]), y = std::fabs(p[1] - off), z = std::fabs(p[2] - off);
			return x < 0.5 * length && y < 0.5 * period[0] + skin && z < 0.5 * period[1] + skin;
		};
		const double half = std::max(0.5 * length + 1., 0.5 * std::max(period[0], period[1]) + skin);
		auto         list = packing(1., half, axesTo(q.along, q.across), m, within);
		inside.assign(list.size(), 0), at.resize(list.size());
		std::map<std::array<long, 3>, int> place;
		const auto key = [](Vec<double> p) { return std::array<long, 3> { std::lround(p[0] * 50), std::lround(p[1] * 50), std::lround(p[2] * 50) }; };
		const auto home = [&](Vec<double> p) {
			for (int c = 1; c < dim; c++) p[c] -= period[c - 1] * std::floor((p[c] - off) / period[c - 1] + 0.5);
			return p;
		};
		std::mt19937                           r(1);
		std::uniform_real_distribution<double> u(-1e-3, 1e-3);
		for (auto& a : list) {
			at[size_t(a.id)] = a.position[0];
			const Vec<double> h = home(a.position);
			if (plainSquare(h - a.position) < 1e-9) inside[size_t(a.id)] = 1, place[key(a.position)] = a.id;
		}
		std::vector<Vec<double>> shift(list.size());
		for (auto& v : shift) v = { u(r), u(r), u(r) };
		for (auto& a : list) {
			const bool driven = a.position[0] < -0.5 * length + 3.2;
			int        twin   = a.id;
			if (!inside[size_t(a.id)]) {
				const auto k = key(home(a.position));
				twin = -1;
				for (long x = -1; x <= 1; x++)
					for (long y = -1; y <= 1; y++)
						for (long z = -1; z <= 1; z++)
							if (auto it = place.find({ k[0] + x, k[1] + y, k[2] + z }); it != place.end()) twin = it->second;
				if (twin < 0) throw std::runtime_error("no image");
				ghost.push_back(a.id), image.push_back(twin);
			}
			if (driven) a.velocity[0] = U;
			if (driven || twin != a.id) a.free = { false, false, false }, a.freeR = { false, false, false };
			if (!driven) a.position += shift[size_t(twin)];
		}
		Options o;
		o.contacts = false;
		s.build(list, { m }, o);
	}
	void step(double factor)
	{
		s.computeForces();
		const double dt = factor * s.criticalStep(), kick = s.kick(dt);
		Store&       S  = s.store;
		for (size_t g = 0; g < ghost.size(); g++) { // the velocity that its image is about to get
			const size_t i = size_t(s.indexOf(ghost[g])), j = size_t(s.indexOf(image[g]));
			for (int c = 0; c < dim; c++)
				S.velocity[c][i] = mca::fma(S.perMass[c][j] * S.force[c][j], kick, S.velocity[c][j]),
				S.omega[c][i]    = mca::fma(S.perInertia[c][j] * S.torque[c][j], kick, S.omega[c][j]);
			if (!isZero(S.velocity.at(i))) S.blocks[i / blockSize].moving = true;
		}
		s.integrate(dt);
	}
	/// Of those inside between two places of the start: mean of f.
	template <class F> double mean(double low, double high, F&& f) const
	{
		double sum = 0;
		int    n   = 0;
		for (size_t id = 0; id < at.size(); id++)
			if (inside[id] && at[id] >= low && at[id] < high) sum += f(size_t(s.indexOf(int(id)))), n++;
		return n ? sum / n : 0.;
	}
};
}

TEST(SpaceShock, SpeedAndPressureAreThoseOfTheJumpConditions)
{
	const double length = std::getenv("MCA_LENGTH") ? std::atof(std::getenv("MCA_LENGTH")) : 150.;
	for (const Direction& q : directions)
		for (double U : { 0.05, 0.1, 0.2 }) {
			Column       c(q, length, U, 3.);
			const Theory theory(U);
			const double piston = -0.5 * length + 3.2, end = 0.8 * length / std::sqrt(1. + 4. / 3. * G) / 1.05;
			constexpr int reads = 6; // the speed is the slope of a straight line through them
			double        t[reads], x[reads], meanT = 0, meanX = 0, product = 0, square = 0;
			// the plastic front: where the material has got the mean of the velocities before and behind it, in the frame of the material
			const double before = strength / (2. * G) * std::sqrt(1. + 4. * G / 3.);
			const auto front = [&] {
				const double level = 0.5 * (U + before), wide = 1.5;
				double       last = 0.;
				for (double z = 0.5 * length - 4.; z > piston; z -= 0.25) {
					const double v = c.mean(z - wide, z + wide, [&](size_t i) { return c.s.store.velocity[0][i]; });
					if (v > level) return z + 0.25 * (v - level) / (v - last);
					last = v;
				}
				return piston;
			};
			for (int k = 0; k < reads; k++) {
				while (c.s.time < end * (0.5 + 0.5 * k / (reads - 1))) c.step(0.4);
				t[k] = c.s.time, x[k] = front(), meanT += t[k] / reads, meanX += x[k] / reads;
			}
			for (int k = 0; k < reads; k++) product += (t[k] - meanT) * (x[k] - meanX), square += sqr(t[k] - meanT);
			const double low = piston + 0.35 * (x[reads - 1] - piston), high = piston + 0.8 * (x[reads - 1] - piston);
			const double P   = c.mean(low, high, [&](size_t i) { return c.s.store.P[i]; });
			const double rms = std::sqrt(c.mean(low, high, [&](size_t i) { return sqr(c.s.store.P[i] / P - 1.); }));
			const double C   = product / square;
			std::cout << q.name << " U " << U << ": speed " << C << " (" << 100. * (C / theory.speed - 1.) << " %), pressure " << P << " ("
			          << 100. * (P / theory.pressure - 1.) << " %), scatter " << 100. * rms << " %, " << c.at.size() << " automata, theory "
			          << theory.speed << " " << theory.pressure << std::endl;
			EXPECT_NEAR(P / theory.pressure, 1., 0.005) << q.name << ' ' << U;
			EXPECT_NEAR(C / theory.speed, 1., 0.01) << q.name << ' ' << U;
		}
}
