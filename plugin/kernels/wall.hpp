// SPDX-License-Identifier: GPL-2.0-or-later
// Rigid bodies that automata touch: where their surface is, and the penalty force of a contact. Formulation, equations (12b)-(12c). In three components always:
// in plane strain a wall extends along z. Rare beside links and contacts, so plain code for one contact.
#pragma once
#include "error.hpp"
#include "math.hpp"
#include <algorithm>

namespace mca {

struct Point {
	double        at[3] = { 0, 0, 0 };
	double&       operator[](int c) { return at[c]; }
	const double& operator[](int c) const { return at[c]; }
};
inline Point operator+(const Point& a, const Point& b) { return { { a[0] + b[0], a[1] + b[1], a[2] + b[2] } }; }
inline Point operator-(const Point& a, const Point& b) { return { { a[0] - b[0], a[1] - b[1], a[2] - b[2] } }; }
inline Point operator*(const Point& a, double f) { return { { a[0] * f, a[1] * f, a[2] * f } }; }
inline double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Point  cross(const Point& a, const Point& b) { return { { a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0] } }; }
inline double length(const Point& a) { return std::sqrt(dot(a, a)); }

/// YADE's Wall (an endless plane across one axis), Box, Facet (a triangle) and Sphere.
enum class WallKind { plane, box, facet, ball };

/// In the frame of the body [m].
struct WallForm {
	WallKind kind = WallKind::plane;
	int      axis = 0;  ///< plane: of its normal
	int      side = 0;  ///< plane: +1, -1: holds what is on this side of it alone; 0: either side
	Point    half;      ///< box: half of its edges
	Point    corner[3]; ///< facet
	double   radius = 0; ///< ball
};
struct WallPlace {
	Point position, velocity, spin; ///< [m], [m/s], [rad/s]
	Point axis[3] = { { { 1, 0, 0 } }, { { 0, 1, 0 } }, { { 0, 0, 1 } } }; ///< of its frame, in space
	bool  moved = true; ///< since the last step
	Point toSpace(const Point& local) const { return position + axis[0] * local[0] + axis[1] * local[1] + axis[2] * local[2]; }
	Point toBody(const Point& x) const
	{
		const Point r = x - position;
		return { { dot(r, axis[0]), dot(r, axis[1]), dot(r, axis[2]) } };
	}
};

/// From the nearest point of a surface to a point outside.
struct WallGap {
	Point  foot, normal; ///< [m], unit vector to the point
	double distance = 0; ///< not above zero: inside, or beyond a plane that holds one side [m]
};

/// Point of the triangle a, b, c that is nearest to x (by the regions of Voronoi of corners, edges and face).
inline Point nearestOfTriangle(const Point& a, const Point& b, const Point& c, const Point& x)
{
	const Point  ab = b - a, ac = c - a, ax = x - a, bx = x - b, cx = x - c;
	const double a1 = dot(ab, ax), a2 = dot(ac, ax), b1 = dot(ab, bx), b2 = dot(ac, bx), c1 = dot(ab, cx), c2 = dot(ac, cx);
	if (a1 <= 0 && a2 <= 0) return a;
	if (b1 >= 0 && b2 <= b1) return b;
	if (c2 >= 0 && c1 <= c2) return c;
	const double overAb = a1 * b2 - b1 * a2, overCa = c1 * a2 - a1 * c2, overBc = b1 * c2 - c1 * b2;
	if (overAb <= 0 && a1 >= 0 && b1 <= 0) return a + ab * (a1 / (a1 - b1));
	if (overCa <= 0 && a2 >= 0 && c2 <= 0) return a + ac * (a2 / (a2 - c2));
	const double alongB = b2 - b1, alongC = c1 - c2;
	if (overBc <= 0 && alongB >= 0 && alongC >= 0) return b + (c - b) * (alongB / (alongB + alongC));
	const double all = overAb + overBc + overCa;
	return a + ab * (overCa / all) + ac * (overAb / all);
}

/// The surface beside x.
inline WallGap gapTo(const WallForm& w, const WallPlace& at, const Point& x)
{
	WallGap g;
	if (w.kind == WallKind::plane) {
		const double beside = x[w.axis] - at.position[w.axis];
		const int    side   = w.side ? w.side : beside < 0 ? -1 : 1;
		g.foot = x, g.foot[w.axis] = at.position[w.axis];
		g.normal[w.axis] = side, g.distance = side * beside;
		return g;
	}
	if (w.kind == WallKind::ball) {
		const Point  r = x - at.position;
		const double away = length(r);
		g.normal = away > 0 ? r * (1. / away) : Point { { 1, 0, 0 } }, g.distance = away - w.radius, g.foot = at.position + g.normal * w.radius;
		return g;
	}
	if (w.kind == WallKind::box) {
		const Point local = at.toBody(x);
		Point       near;
		for (int c = 0; c < 3; c++) near[c] = min(max(local[c], -w.half[c]), w.half[c]);
		g.foot = at.toSpace(near);
	} else {
		const Point local = at.toBody(x);
		g.foot = at.toSpace(nearestOfTriangle(w.corner[0], w.corner[1], w.corner[2], local));
	}
	const Point r = x - g.foot;
	g.distance    = length(r);
	if (g.distance > 0) g.normal = r * (1. / g.distance);
	return g;
}

/// Box of space that a wall takes up [m].
struct WallBounds {
	Point low, high;
};
inline WallBounds boundsOf(const WallForm& w, const WallPlace& at)
{
	constexpr double endless = 1e300;
	WallBounds       b { at.position, at.position };
	for (int c = 0; c < 3; c++) {
		if (w.kind == WallKind::plane) {
			if (c != w.axis || w.side < 0) b.high[c] = endless;
			if (c != w.axis || w.side > 0) b.low[c] = -endless;
			if (c == w.axis && w.side < 0) b.low[c] = at.position[c], b.high[c] = endless; // all of space behind it
		} else if (w.kind == WallKind::ball) b.low[c] -= w.radius, b.high[c] += w.radius;
		else if (w.kind == WallKind::box) {
			const double reach = std::fabs(at.axis[0][c]) * w.half[0] + std::fabs(at.axis[1][c]) * w.half[1] + std::fabs(at.axis[2][c]) * w.half[2];
			b.low[c] -= reach, b.high[c] += reach;
		} else {
			const double p = at.toSpace(w.corner[0])[c], q = at.toSpace(w.corner[1])[c], r = at.toSpace(w.corner[2])[c];
			b.low[c] = min(p, min(q, r)), b.high[c] = max(p, max(q, r));
		}
	}
	return b;
}

/// Surfaces whose normals differ by less (the cosine of 15 degrees) are one, as neighbouring facets of a curved body are.
constexpr double sameFace = 0.966;
/// Whether a surface is hidden by a nearer one: it is the same face, or its foot lies in the plane of that one or behind it, as at the edge between two facets.
inline bool isHidden(const WallGap& gap, const WallGap& nearer, double d)
{
	return dot(gap.normal, nearer.normal) > sameFace || dot(gap.foot - nearer.foot, nearer.normal) <= 1e-9 * d;
}

/// Whether x is within `reach` of the box, in each direction [m].
inline bool isNear(const WallBounds& b, const Point& x, double reach)
{
	for (int c = 0; c < 3; c++)
		if (x[c] - b.high[c] >= reach || b.low[c] - x[c] >= reach) return false;
	return true;
}

/// Velocity of the body at a point [m/s].
inline Point velocityAt(const WallPlace& at, const Point& x) { return at.velocity + cross(at.spin, x - at.position); }

/// Stiffness of the penalty contact of an automaton with a rigid body (12b): its half cell of area S0 between centre and face. [N/m, in plane strain N/m per m]
struct WallStiffness {
	double normal, shear;
	WallStiffness(double K, double G, double area, double d) : normal((K + G * (4. / 3.)) * area * 2. / d), shear(G * area * 2. / d) { }
};
/// Share of a shear force of this size that Coulomb's friction leaves [-]; most: friction times normal force.
inline double frictionShare(double size, double most) { return size > most ? most / size : 1.; }

/// Force on the automaton (12c). slip: its velocity against the surface [m/s], over dt [s]; shear: force across the normal that the contact holds, old in, new
/// out [N].
inline Point wallForce(const WallStiffness& k, double friction, double overlap, const Point& normal, const Point& slip, double dt, Point& shear)
{
	const double push = k.normal * overlap;
	shear             = shear - normal * dot(normal, shear);
	shear             = shear - (slip - normal * dot(normal, slip)) * (k.shear * dt);
	shear             = shear * frictionShare(length(shear), friction * push);
	return normal * push + shear;
}

/// Largest stable step where it is `free` without contacts of this stiffness over mass [1/s2]: the largest eigenvalue of a sum is at most the sum of
/// theirs, and the step is 2 over its root.
inline double stepBeside(double free, double stiffness) { return 1. / std::sqrt(1. / (free * free) + 0.25 * stiffness); }

/// Overlaps beyond this share of the radius are an error: the penalty means nothing there, and the other side is near [-].
constexpr double deepestWall = 0.5;
}
