// SPDX-License-Identifier: GPL-2.0-or-later
// One step of a grid, its time step, its energy.
#include "../threads.hpp"
#include "grid.hpp"
#include "sweep.hpp"
#include <algorithm>
#include <cmath>

namespace mca::grid {

namespace {
	constexpr long cellsPerThread = 1024;
}

/// Contiguous shares of the bands with about the same number of cells awake.
void Grid::partition(int threads, std::vector<int>& first) const
{
	std::vector<double> upTo(bands_.size() + 1, 0.);
	for (size_t u = 0; u < bands_.size(); u++) {
		const Block& b = *blocks_[size_t(bands_[u].first)];
		double       w = 1;
		for (int j = b.bandStart[size_t(bands_[u].second)]; j < b.bandStart[size_t(bands_[u].second) + 1]; j++)
			w += b.awake[size_t(j)].hi - b.awake[size_t(j)].lo;
		upTo[u + 1] = upTo[u] + w;
	}
	first.assign(size_t(threads) + 1, int(bands_.size()));
	first[0] = 0;
	for (int t = 1; t < threads; t++) {
		const double share = upTo.back() * t / threads;
		size_t       u     = size_t(std::lower_bound(upTo.begin(), upTo.end(), share) - upTo.begin());
		if (u > 0 && share - upTo[u - 1] < upTo[u] - share) u--;
		first[size_t(t)] = std::max(first[size_t(t) - 1], int(u));
	}
}

/// Throws Error, before anything has moved, unless a step of dt [s] can be done.
void Grid::checkStep(double dt)
{
	mustBeBuilt();
	if (!failure_.empty()) throw Error("the grid has stopped and cannot go on: " + failure_ + " Save it for inspection, or restore an earlier state.");
	if (between_) throw Error("grid: computeForces was called twice; integrate must follow it.");
	if (!(dt > 0) || !std::isfinite(dt)) {
		std::ostringstream s;
		s << "grid: time step " << dt << " s is not allowed; it must be finite and above zero, at most " << criticalTimeStep() << " s ("
		  << criticalCell() << ").";
		throw Error(s.str());
	}
	if (dt > criticalTimeStep() * (1. + 1e-12)) {
		std::ostringstream s;
		s.precision(9);
		s << "grid: time step " << dt << " s is too large; the largest allowed value is " << criticalTimeStep() << " s, set by " << criticalCell()
		  << ". Nothing has moved: lower the time step and go on.";
		throw Error(s.str());
	}
}

/// Forces of the nodes that are summed one by one, from the corners of their cells.
void Grid::sumCorners()
{
	OpenNodes& o = open_;
	const auto sum = [&](const std::vector<double>* c, size_t k) { return (c[3][k] + c[2][k]) + (c[1][k] + c[0][k]); };
	for (size_t k = 0; k < size_t(o.size()); k++) {
		const size_t c = size_t(o.firstCopy[k]);
		o.fx[k]        = sum(o.corner, c);
		o.fy[k]        = sum(o.corner + 4, c);
	}
	for (const int r : o.repeats) {
		o.fx[size_t(o.copyMaster[size_t(r)])] += sum(o.corner, size_t(r));
		o.fy[size_t(o.copyMaster[size_t(r)])] += sum(o.corner + 4, size_t(r));
	}
}

void Grid::computeForces(double dt)
{
	checkStep(dt);
	if (bands_.empty())
		for (size_t b = 0; b < blocks_.size(); b++)
			for (size_t k = 0; k + 1 < blocks_[b]->bandStart.size(); k++) bands_.push_back({ int(b), int(k) });

	Step s;
	s.dtPrevious = dtPrevious_;
	s.dt         = dt;
	s.kick       = kick(dt);
	s.restSpeed  = restSpeed_;
	s.skip       = options_.skip;
	for (int c = 0; c < 4; c++) {
		s.cornerX[c] = open_.corner[c].data();
		s.cornerY[c] = open_.corner[c + 4].data();
	}
	long awake = 0; // a thread that gets fewer cells than this costs more to wake than it saves
	for (const auto& b : blocks_)
		for (const Range& r : b->awake) awake += r.hi - r.lo;
	const int threads = std::max(1, std::min({ threads_ > 0 ? threads_ : mca::threads(), int(bands_.size()), int(awake / cellsPerThread) }));
	for (auto& b : blocks_)
		if (b->limiterX) {
			eachPart(threads, [&](int t) {
				for (int j = (b->nj + 1) * t / threads; j < (b->nj + 1) * (t + 1) / threads; j++) edgeLimiterRow(*b, j);
			});
		}
	std::vector<int> first;
	partition(threads, first);
	for (auto& b : blocks_) std::fill(b->seamReady.begin(), b->seamReady.end(), 0);
	eachPart(threads, [&](int share) {
		static thread_local Workspace ws;
		for (int u = first[size_t(share)]; u < first[size_t(share) + 1]; u++) {
			Block&    b    = *blocks_[size_t(bands_[size_t(u)].first)];
			const int band = bands_[size_t(u)].second;
			sweepBand(b, band, s, ws);
			// a seam belongs to whoever completes the second of its two bands: no barrier, and its rows are still in the cache
			for (const int seam : { band - 1, band })
				if (seam >= 0 && size_t(seam) < b.seamReady.size() && __atomic_add_fetch(&b.seamReady[size_t(seam)], 1, __ATOMIC_ACQ_REL) == 2)
					finishSeam(b, seam, s, ws);
		}
	});
	uint64_t worst = 0;
	for (auto& b : blocks_)
		for (const uint64_t w : b->bandWorst) worst = std::max(worst, w);

	sumCorners();
	boundary_.forces(open_, time_);
	between_ = true;
	dtNow_   = dt;
	failIfBad(worst);
	ratesKnown_ = true;
}

void Grid::integrate(double dt)
{
	if (!between_ || dt != dtNow_) throw Error("grid: integrate must follow computeForces with the same time step.");
	OpenNodes& o = open_;
	for (size_t k = 0; k < size_t(o.size()); k++)
		if (!std::isfinite(o.ex[k] + o.ey[k])) {
			std::ostringstream s;
			s << "grid: the force added to " << nodeName(int(k)) << " is (" << o.ex[k] << ", " << o.ey[k] << ") N/m; it must be finite.";
			throw Error(s.str());
		}
	boundary_.accelerate(o, time_, dt, kick(dt), restSpeed_, account_);
	const double* cx[4];
	const double* cy[4];
	for (int c = 0; c < 4; c++) {
		cx[c] = o.corner[c].data();
		cy[c] = o.corner[c + 4].data();
	}
	for (auto& p : blocks_) {
		Block& b = *p;
		for (int c = b.firstCopy; c < b.firstCopy + b.nCopies; c++) {
			const size_t k = size_t(o.copyMaster[size_t(c)]), n = o.copyNode[size_t(c)];
			b.x[n] = o.x[k], b.y[n] = o.y[k], b.vx[n] = o.vx[k], b.vy[n] = o.vy[k];
			if (b.account && (o.wx[k] != 0. || o.wy[k] != 0.)) {
				int i, j;
				b.nodeOfCopy(c, i, j);
				openNodeWork(b, i, j, cx, cy, c, o.wx[k], o.wy[k], kick(dt));
			}
		}
		wake(b);
	}
	between_    = false;
	dtPrevious_ = dt;
	time_ += dt;
	steps_++;
	for (Gauge& g : gauges_)
		if (steps_ % g.period == 0) g.history.push_back(sample(*blocks_[size_t(g.at.block)], g.at, time_));
}

namespace {
	/// Reciprocal of the largest stable step of one cell [1/s], present state.
	double rateOf(const Block& b, int i, int j)
	{
		CellConstants c = cellConstants(b, 0.);
		CellState     s = { 0, 0, 0, 0, 0, 0, 0 };
		return dispatch(c.eos.kind, [&](auto eos) {
			constexpr auto Q = GridViscosity::scalar, none = GridViscosity::none;
			const auto     update = b.material.viscosity.active() ? updateCell<YieldKind::elastic, Q, true, eos.value>
									      : updateCell<YieldKind::elastic, none, true, eos.value>;
			return update(c, b.positionPattern(i, j), b.velocityPattern(i, j), b.restArea[b.cell(i, j)], 0., s).rate;
		});
	}
}

void Grid::scanRates()
{
	maxRate_ = 0;
	for (const auto& b : blocks_)
		for (int j = 0; j < b->nj; j++)
			for (int i = 0; i < b->ni; i++) maxRate_ = std::max(maxRate_, rateOf(*b, i, j));
	if (steps_ == 0) restRate_ = maxRate_; // cells asleep bound the step as well
	ratesKnown_ = true;
}

double Grid::criticalTimeStep()
{
	mustBeBuilt();
	if (!ratesKnown_) scanRates();
	return options_.safety / maxRate_;
}

std::string Grid::criticalCell() const
{
	double      best = -1;
	std::string name = "no cell";
	for (const auto& b : blocks_)
		for (int j = 0; j < b->nj; j++)
			for (int i = 0; i < b->ni; i++) {
				const double r = rateOf(*b, i, j);
				if (!(r <= best)) {
					best = r;
					name = b->cellName(i, j);
					if (!(r < std::numeric_limits<double>::infinity())) return name;
				}
			}
	return name;
}

void Grid::failIfBad(uint64_t worst)
{
	const uint64_t infinite = uint64_t(bitsOf(std::numeric_limits<double>::infinity()));
	// sleeping cells keep their rest rate, so the largest rate never falls below that of the grid at rest while some sleep
	if (worst < infinite) {
		bool allAwake = true;
		for (const auto& b : blocks_) allAwake = allAwake && b->allAwake;
		const double r = fromBits(int64_t(worst));
		maxRate_       = allAwake ? r : std::max(r, restRate_);
		return;
	}
	std::ostringstream s;
	for (const auto& b : blocks_)
		for (int j = 0; j < b->nj; j++)
			for (int i = 0; i < b->ni; i++) {
				const size_t c = b->cell(i, j);
				// the cell as it was when its forces were computed: take back the step of its closed nodes
				const CellPattern p = b->positionPattern(i, j);
				const double      a = cellArea(p), sum = b->sxx[c] + b->syy[c] + b->sxy[c] + b->rx[c] + b->ry[c] + b->eqps[c];
				if (a > 0 && std::isfinite(sum) && std::isfinite(a)) continue;
				s << b->cellName(i, j) << ": " << (a <= 0 ? "the cell is turned inside out" : "a number is not finite") << " (area " << a
				  << " m2, rest area " << b->restArea[c] << " m2, stress " << b->sxx[c] << ", " << b->syy[c] << ", " << b->sxy[c]
				  << " Pa) at time " << time_
				  << " s. Lower the time step, raise viscosity or hourglass stiffness, or use automata where the deformation is this large.";
				failure_ = s.str();
				throw Error(failure_);
			}
	s << "a cell became unusable at time " << time_ << " s (turned inside out or a number that is not finite).";
	failure_ = s.str();
	throw Error(failure_);
}

Energy Grid::energy() const
{
	Energy e;
	if (!built_) return e; // nothing has a velocity yet
	const OpenNodes& o = open_;
	for (const auto& p : blocks_) {
		const Block& b = *p;
		for (int j = 0; j < b.nj; j++) { // row sums in order of rows: the same bits always
			double k = 0, u = 0, mx = 0, my = 0;
			for (int i = 1; i < b.ni && j > 0; i++) {
				const size_t n = b.node(i, j);
				const double m = 1. / b.invMass[n];
				k += 0.5 * m * (b.vx[n] * b.vx[n] + b.vy[n] * b.vy[n]);
				mx += m * b.vx[n];
				my += m * b.vy[n];
			}
			if (b.energy)
				for (int i = 0; i < b.ni; i++) u += b.energy[b.cell(i, j)];
			e.kinetic += k, e.internal += u, e.momentumX += mx, e.momentumY += my;
		}
		for (const int n : b.interiorOpen) { // counted with the open nodes
			const size_t c = b.node(n % (b.ni + 1), n / (b.ni + 1));
			const double m = 1. / b.invMass[c];
			e.kinetic -= 0.5 * m * (b.vx[c] * b.vx[c] + b.vy[c] * b.vy[c]);
			e.momentumX -= m * b.vx[c];
			e.momentumY -= m * b.vy[c];
		}
	}
	for (size_t k = 0; k < size_t(o.size()); k++) {
		e.kinetic += 0.5 * o.mass[k] * (o.vx[k] * o.vx[k] + o.vy[k] * o.vy[k]);
		e.momentumX += o.mass[k] * o.vx[k];
		e.momentumY += o.mass[k] * o.vy[k];
	}
	e.workLoads       = account_.loads;
	e.workExternal    = account_.external;
	e.workConstraints = account_.constraints;
	e.workViscous     = account_.viscous;
	e.impulseX        = account_.impulseX;
	e.impulseY        = account_.impulseY;
	return e;
}

double Grid::awakeFraction() const
{
	double on = 0, all = 0;
	for (const auto& b : blocks_) {
		all += double(b->ni) * b->nj;
		for (const Range& r : b->awake) on += r.hi - r.lo;
	}
	return all > 0 ? on / all : 0.;
}

void Grid::pressure(int block, double* out) const
{
	const Block& b = checkedBlock(block, "pressure");
	for (int j = 0; j < b.nj; j++)
		for (int i = 0; i < b.ni; i++) out[b.cell(i, j)] = b.pressureOf(i, j);
}
}
