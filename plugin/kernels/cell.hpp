// SPDX-License-Identifier: GPL-2.0-or-later
// One quadrilateral cell of the Lagrangian grid, one stress point: from the positions x^n and velocities v^(n-1/2) of its corners to its stress,
// its corner forces and its limit on the time step. Wilkins (1964) strength, Caramana, Burton, Shashkov & Whalen (1998) staggering,
// Hughes & Winget (1980) rotation, Flanagan & Belytschko (1981) hourglass stiffness. Values in, values out; straight-line code that vectorises.
//
// Corners run counter-clockwise 0..3. Every quantity of the one-point quadrilateral depends on the two diagonals (2-0 and 3-1) and on the
// hourglass pattern h = (1,-1,1,-1) alone, so that is what the caller hands over. Any four corner forces with zero sum are written
//     f0 = T0 - R,  f2 = -T0 - R,  f1 = T1 + R,  f3 = -T1 + R
// so momentum is conserved by form and six numbers per cell, not eight, travel from cells to nodes.
#pragma once
#include "material.hpp"

namespace mca {

/// Diagonals and hourglass pattern of one field (position [m] or velocity [m/s]) over the four corners.
struct CellPattern {
	double x20, y20, x31, y31; ///< corner 2 minus corner 0, corner 3 minus corner 1
	double hx, hy;             ///< corner 0 - 1 + 2 - 3
};

inline CellPattern cellPattern(
        double x0, double y0, double x1, double y1, double x2, double y2, double x3, double y3)
{
	return { x2 - x0, y2 - y0, x3 - x1, y3 - y1, (x0 - x1) + (x2 - x3), (y0 - y1) + (y2 - y3) };
}

/// Area [m2], positive for counter-clockwise corners.
inline double cellArea(const CellPattern& p) { return 0.5 * (p.x20 * p.y31 - p.x31 * p.y20); }

/// Half the trace h of G_ij = sum_c B_ci B_cj [m2], B_c = dA/dx_c. Its larger eigenvalue is h + sqrt(h^2 - A^2), because det G = A^2.
inline double cellHalfTrace(const CellPattern& p) { return 0.25 * ((p.x20 * p.x20 + p.y20 * p.y20) + (p.x31 * p.x31 + p.y31 * p.y31)); }

/// What is the same for all cells of a block in one step.
struct CellConstants {
	Eos       eos;
	Yield     yield;
	Viscosity viscosity;
	double    G         = 0;
	double    hourglass = 0; ///< multiplier of the exact stiffness of the bilinear square, (4/3)(lambda + 3 mu) [-]
	double    spall     = std::numeric_limits<double>::infinity(); ///< tensile pressure is cut off here [Pa]
	double    dt        = 0; ///< time from x^(n-1) to x^n [s]; 0 in the first step
};

/// What a cell remembers. Deviator components only: s_zz = -(s_xx + s_yy).
struct CellState {
	double sxx, syy, sxy; ///< deviatoric stress [Pa]
	double eqps;          ///< equivalent plastic strain [-]
	double rx, ry;        ///< hourglass force over four [N/m], turning with the cell
	double temperature;   ///< [K], where the flow stress heats
};

/// What a cell gives to its nodes.
struct CellForces {
	double t0x, t0y, t1x, t1y; ///< [N/m], see the head of this file
	double rate;               ///< reciprocal of the largest stable time step [1/s]; not finite or negative when the cell is unusable
	double pressure;           ///< EOS pressure, without viscosity [Pa]
	double trial;              ///< equivalent stress before the radial return [Pa]; 0 for a material that does not yield
};

/// Edge viscosity wants rho, c and the stress without q; the scalar one adds q to the pressure here.
enum class GridViscosity { none, scalar };

/// The whole update. restArea [m2]; energy: internal energy at n-1/2 per rest volume [J/m3], read only where the equation of state heats.
/// flows = false leaves out the radial return: the same bits wherever `trial` stays at or below the static yield stress.
/// Long because it is one chain of values: what a part would take and give back is nearly all of them.
template <YieldKind kind, GridViscosity visc, bool hourglass, EosKind eos, bool flows = true>
inline CellForces updateCell(const CellConstants& c, const CellPattern& p, const CellPattern& v, double restArea, double energy, CellState& s)
{
	using Law = LawOf<kind>;
	const double dt = c.dt, halfDt = 0.5 * dt;
	// velocity gradient on the geometry of the half step: a rigid rotation then has D = 0 exactly, whatever its angle
	const double mx20 = p.x20 - halfDt * v.x20, my20 = p.y20 - halfDt * v.y20;
	const double mx31 = p.x31 - halfDt * v.x31, my31 = p.y31 - halfDt * v.y31;
	const double half = 1. / (mx20 * my31 - mx31 * my20); // 1/(2 A_mid)
	const double lxx  = (v.x20 * my31 - v.x31 * my20) * half;
	const double lxy  = (v.x31 * mx20 - v.x20 * mx31) * half;
	const double lyx  = (v.y20 * my31 - v.y31 * my20) * half;
	const double lyy  = (v.y31 * mx20 - v.y20 * mx31) * half;
	const double div  = lxx + lyy;

	// volume strain: exactly zero at rest, no rounding noise; one division serves 1/A and 1/A0
	const double area    = cellArea(p);
	const double recip   = 1. / (area * restArea);
	const double eps     = (area - restArea) * area * recip;
	const double invArea = restArea * recip;
	const double kt      = tangent<eos>(c.eos, eps);
	const double modulus = kt + (4. / 3.) * c.G;
	const double rho     = c.eos.rho0 * restArea * invArea;
	const double trace   = cellHalfTrace(p);

	// deviator: half the rotation, the strain increment in the frame of the half step, the other half
	const double t    = halfDt * 0.5 * (lyx - lxy); // tan(theta/2), Hughes & Winget
	const double inv1 = 1. / (1. + t * t);
	const double co = (1. - t * t) * inv1, si = 2. * t * inv1; // cos, sin of theta: turning a tensor by theta/2
	const double g2dt = 2. * c.G * dt;
	const double mOld = 0.5 * (s.sxx + s.syy), dOld = 0.5 * (s.sxx - s.syy);
	const double m1   = fma(g2dt, div * (1. / 6.), mOld); // (Dxx + Dyy)/2 - tr D/3
	const double d1   = fma(g2dt, 0.5 * (lxx - lyy), co * dOld - si * s.sxy);
	const double k1   = fma(g2dt, 0.5 * (lxy + lyx), si * dOld + co * s.sxy);
	double       m = m1, d = co * d1 - si * k1, k = si * d1 + co * k1;

	// hourglass velocity orthogonal to every linear field, so the patch test holds on any mesh
	double rx = 0, ry = 0;
	if constexpr (hourglass) {
		const double mhx = p.hx - halfDt * v.hx, mhy = p.hy - halfDt * v.hy;
		const double qx = v.hx - (mhx * lxx + mhy * lxy), qy = v.hy - (mhx * lyx + mhy * lyy);
		const double stiff = c.hourglass * (1. / 12.) * (kt + (7. / 3.) * c.G) * trace * invArea * dt;
		rx                 = fma(stiff, qx, co * s.rx - si * s.ry);
		ry                 = fma(stiff, qy, si * s.rx + co * s.ry);
	}

	// radial return; the hourglass force yields with the deviator
	double stressFactor = 1., trial = 0.;
	if constexpr (Law::yields) trial = std::sqrt(3. * (3. * m * m + d * d + k * k));
	if constexpr (Law::yields && flows) {
		const Return r     = radialReturn<kind>(c.yield, trial, s.eqps, s.temperature, 3. * c.G, dt);
		stressFactor       = r.scale;
		m *= r.scale;
		d *= r.scale;
		k *= r.scale;
		rx *= r.scale;
		ry *= r.scale;
		s.eqps += r.dEqps;
		if constexpr (Law::heats) s.temperature += c.yield.heatPerWork * (trial * r.scale) * r.dEqps;
	}
	s.sxx = m + d;
	s.syy = m - d;
	s.sxy = k;
	if constexpr (hourglass) {
		s.rx = rx;
		s.ry = ry;
	}

	double viscous = 0, q = 0; // viscous: q per strain rate [Pa s]
	if constexpr (visc == GridViscosity::scalar) {
		const double closing = max(-div, 0.);
		viscous = c.viscosity.linear * std::sqrt(rho * modulus * area) + c.viscosity.quadratic * rho * area * closing;
		q       = viscous * closing;
		viscous = closing > 0. ? viscous : 0.;
	}

	double pr;
	if constexpr (LawOf<eos>::heats) {
		// the energy is known at n-1/2, the pressure is wanted at n: half a step of work, implicit in the pressure
		const double  share = halfDt / (2. * half * restArea);
		const double  work  = m * div + d * (lxx - lyy) + k * (lxy + lyx); // s : D
		const Thermal hot   = LawOf<eos>::thermal(c.eos, eps, energy);
		pr                  = (hot.A + hot.B * (energy + share * (work - q * div))) / (1. + hot.B * share * div);
	} else
		pr = pressure<eos>(c.eos, eps);
	pr = max(pr, -c.spall);

	const double sx = s.sxx - (pr + q), sy = s.syy - (pr + q);
	CellForces   f;
	// F_c = -sigma . dA/dx_c
	f.t0x = 0.5 * (sx * p.y31 - k * p.x31);
	f.t0y = 0.5 * (k * p.y31 - sy * p.x31);
	f.t1x = 0.5 * (k * p.x20 - sx * p.y20);
	f.t1y = 0.5 * (sy * p.x20 - k * p.y20);
	if constexpr (hourglass) {
		// gamma_c = h_c - (hx dA/dx_c + hy dA/dy_c)/A, on the geometry of the forces
		const double b0 = 0.5 * (p.hy * p.x31 - p.hx * p.y31) * invArea;
		const double b1 = 0.5 * (p.hx * p.y20 - p.hy * p.x20) * invArea;
		f.t0x += b0 * rx;
		f.t0y += b0 * ry;
		f.t1x += b1 * rx;
		f.t1y += b1 * ry;
	}
	// leapfrog with lagged viscosity: 1/dt = u mu + sqrt(M u + (u mu)^2), u = lambda_max(G)/(rho A^2)
	const double lambda = trace + std::sqrt(max(trace * trace - area * area, 0.));
	const double u      = lambda * invArea * invArea / rho;
	const double uv     = u * viscous;
	// the pattern that changes sign from node to node: 4 k/(rho A) with the hourglass stiffness k above; decides beyond a multiplier of about 2
	const double stiffest = hourglass ? max(modulus, c.hourglass * (1. / 3.) * (kt + (7. / 3.) * c.G)) : modulus;
	// a cell turned inside out, or any non-finite number in its stress, shows in the rate
	const double poison = 0. * (sx + sy + k + (rx + ry) + stressFactor);
	f.rate              = area > 0. ? uv + std::sqrt(stiffest * u + uv * uv) + poison : std::numeric_limits<double>::infinity();
	f.pressure          = pr;
	f.trial             = trial;
	return f;
}
}
