// SPDX-License-Identifier: GPL-2.0-or-later
// The exchange of volume in flowing material: stripes fade at the stated rate, smooth fields stay, the sum of J is kept.
#include "automata_scene.hpp"
#include "kernels/automaton/filter.hpp"
#include <numeric>
using namespace automatatest;

namespace {
constexpr double d = 1e-3;
constexpr int    n = 40;

/// A fixed block with J = 1 + 0.01 cos(2 pi row/wave); only the exchange can change it. Returns the amplitude in the middle row before and after.
struct Fade {
	double before, after, expected, sumBefore, sumAfter;
	Fade(double wave, double eqps, double rate = 0.1)
	{
		Material m    = steel(YieldKind::perfect);
		auto     list = packing(d, n, n, m);
		for (auto& a : list) a.free[0] = a.free[1] = a.freeR = false, a.eqps = eqps;
		Options o;
		o.sleeping = o.contacts = false, o.volumeFilter = rate;
		Solver s;
		s.build(list, { m }, o);
		s.computeForces();
		for (int i = 0; i < n * n; i++)
			s.store.factor[s.indexOf(i)] *= 1. + 0.01 * std::cos(2 * M_PI * (i / n) / wave);
		s.moved();
		s.computeForces();
		const size_t middle = s.indexOf(n / 2 * n + n / 2);
		const auto   total  = [&] {
                        double sum = 0;
                        for (int i = 0; i < n * n; i++)
                                sum += s.store.J[s.indexOf(i)];
                        return sum;
		};
		before = s.store.J[middle] - 1., sumBefore = total(), expected = before;
		const double dt = 0.3 * s.criticalStep();
		for (int k = 1; k <= 5 * filterPeriod; k++) {
			s.integrate(dt);
			s.computeForces();
			if (k % filterPeriod == 0) { // fourth difference of a wave along the rows, over 64: ((4 - 4 cos q)/8)^2
				const double q = 2 * M_PI / wave;
				expected *= 1. - 64. * volumeExchange(rate, m.eos.c0, filterPeriod * dt, d) * sqr(0.5 - 0.5 * std::cos(q));
			}
		}
		after = s.store.J[middle] - 1., sumAfter = total();
	}
};
}

TEST(AutomataFilter, StripesFadeAsStatedAndTheSumIsKept)
{
	const Fade stripe(2., 0.01);
	EXPECT_NEAR(stripe.before, 0.01, 1e-12);
	EXPECT_LT(stripe.after, 0.9 * stripe.before);
	EXPECT_NEAR(stripe.after, stripe.expected, 1e-4 * stripe.before);
	EXPECT_NEAR(stripe.sumAfter, stripe.sumBefore, 1e-10);
	const Fade smooth(20., 0.01);
	EXPECT_GT(smooth.after, 0.999 * smooth.before);
	EXPECT_NEAR(smooth.after, smooth.expected, 1e-4 * smooth.before);
	EXPECT_NEAR(smooth.sumAfter, smooth.sumBefore, 1e-10);
}

TEST(AutomataFilter, LeavesElasticMaterialAloneAndCanBeSwitchedOff)
{
	for (const Fade& f : { Fade(2., 0.), Fade(2., 0.01, 0.) })
		EXPECT_EQ(f.before, f.after);
}
