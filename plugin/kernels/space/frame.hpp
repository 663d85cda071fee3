// SPDX-License-Identifier: GPL-2.0-or-later
// How a packing stands in space: where its links point. Needed when links are made, never after.
#pragma once
#include "pair.hpp"

namespace mca {
inline namespace MCA_SPACE {

/// A rotation: the axes of the packing in the laboratory.
using Frame = Tensor<double>;

inline Vec<double> unit(Vec<double> a) { return Lattice::bearing(a); }
/// Axes along a, across it towards b, and across both.
inline Frame triad(Vec<double> a, Vec<double> b)
{
	const Vec<double> third = unit(plainCross(a, b));
	return { a, plainCross(third, a), third };
}
/// The frame in which links k and l point along a and b, as well as that can be.
inline Frame frameOf(int k, int l, Vec<double> a, Vec<double> b)
{
	const Frame to = triad(a, b), from = triad(Lattice::direction(k), Lattice::direction(l));
	Frame       f {};
	for (int c = 0; c < dim; c++)
		for (int q = 0; q < dim; q++) f.column[c] += to.column[q] * from.column[q][c];
	return f;
}
/// Some frame in which link 0 points along a.
inline Frame frameAlong(Vec<double> a)
{
	const Vec<double> aside = std::fabs(a[0]) < 0.6 ? Vec<double> { 1., 0., 0. } : Vec<double> { 0., 1., 0. };
	return frameOf(0, 1, a, aside);
}
inline Frame turnedFrame(const Frame& f, Vec<double> w) { return { rotated(f.column[0], w), rotated(f.column[1], w), rotated(f.column[2], w) }; }

/// The link of a frame that points most nearly along n.
struct Match {
	int    link = 0;
	double cosine = -2;
};
inline Match match(const Frame& f, Vec<double> n)
{
	Match best;
	for (int k = 0; k < nLinks; k++) {
		const double c = plainDot(times(f, k), n);
		if (c > best.cosine) best = { k, c };
	}
	return best;
}
/// Cosine of the largest angle between a link and the direction that its frame gives it: 25 degrees of the 60 to the next one.
constexpr double farthestMatch = 0.905;
/// Bearings that two links tell a frame from: not in a line.
inline bool spanFrame(Vec<double> a, Vec<double> b) { return std::fabs(plainDot(a, b)) < 0.8; }

/// The frame that suits these bearings best.
inline Frame bestFrame(const Vec<double>* bearing, int count)
{
	int second = 0;
	for (int f = 1; f < count && second == 0; f++)
		if (spanFrame(bearing[0], bearing[f])) second = f;
	if (second == 0) return frameAlong(bearing[0]);
	Frame  best {};
	double most = -1e300;
	for (int k = 0; k < nLinks; k++)
		for (int l = 0; l < nLinks; l++) {
			if (!spanFrame(Lattice::direction(k), Lattice::direction(l))) continue;
			const Frame frame = frameOf(k, l, bearing[0], bearing[second]);
			double      sum   = 0;
			for (int f = 0; f < count; f++) sum += match(frame, bearing[f]).cosine;
			if (sum > most + 1e-9) best = frame, most = sum;
		}
	return best;
}
}
}
