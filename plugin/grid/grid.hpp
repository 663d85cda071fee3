// SPDX-License-Identifier: GPL-2.0-or-later
// The Lagrangian grid: blocks, shared nodes, boundaries, the step, energy and momentum. Plane strain, per unit thickness, SI units.
// Order of use: addBlock... -> build -> boundaries, velocities, gauges -> step (or computeForces, forces from others, integrate).
#pragma once
#include "boundary.hpp"
#include "gauge.hpp"
#include <array>
#include <functional>

namespace mca::grid {

struct GridOptions {
	bool   account = true; ///< keep internal energy, works and impulses
	bool   skip    = true; ///< leave out cells that no wave has reached: the same numbers, bit for bit
	double safety  = 0.9;  ///< criticalTimeStep() is this part of the bound of stability [-]
};

struct Energy {
	double kinetic = 0, internal = 0;                                 ///< [J/m]
	double workLoads = 0, workExternal = 0, workConstraints = 0, workViscous = 0; ///< done on the grid since the start [J/m]
	double momentumX = 0, momentumY = 0;                              ///< [N s/m]
	double impulseX = 0, impulseY = 0;                                ///< given to the grid since the start [N s/m]
	double total() const { return kinetic + internal - (workLoads + workExternal + workConstraints + workViscous); } ///< stays constant
};

/// Values for the cells of a block, row by row, or none.
struct CellFields {
	std::vector<double> pressure, sxx, syy, sxy; ///< of the equation of state; deviator [Pa]; all four or none
	std::vector<double> eqps, temperature;       ///< [-], [K]
};

class MCA_API Grid {
public:
	explicit Grid(const GridOptions& options = {});
	~Grid();
	Grid(const Grid&) = delete;
	Grid& operator=(const Grid&) = delete;

	// ---- set-up, before build
	/// Rectangle: xs, ys [m] are the rising coordinates of the grid lines. Returns the number of the block.
	int addRectangle(const Material& m, const std::vector<double>& xs, const std::vector<double>& ys, const BlockOptions& o = {});
	/// Any shape: x, y [m], (nj+1) rows of (ni+1) nodes. Cells must be counter-clockwise. Returns the number of the block.
	int addBlock(const Material& m, int ni, int nj, const std::vector<double>& x, const std::vector<double>& y, const BlockOptions& o = {});
	/// Makes a node inside a block an open node, so that it can be held or loaded.
	void openInteriorNode(int block, int i, int j);
	/// Joins blocks where their sides touch, takes masses and rest areas. Called by the first function below that needs it.
	void build();
	bool built() const { return built_; }

	// ---- boundaries and initial state, after build
	/// Number of the open node at (i,j) of a block, -1 when it is closed.
	int openNode(int block, int i, int j);
	/// Open nodes of a side in order of rising i or j; from, to (inclusive) restrict it, to = -1: to the end.
	std::vector<int> sideNodes(int block, Side side, int from = 0, int to = -1);
	/// Holds v . (nx, ny) at the table's value [m/s] on these nodes (fixed, symmetry: a table of zero).
	void prescribe(const std::vector<int>& nodes, double nx, double ny, const Table& velocity);
	void fix(const std::vector<int>& nodes, bool x, bool y);
	/// Side moves in its own line only; it must be straight.
	void symmetry(int block, Side side);
	/// Traction [Pa] per rest length on the edges between nodes from..to of a side.
	void traction(int block, Side side, const Table& tx, const Table& ty, int from = 0, int to = -1);
	/// Pressure [Pa] on the present outline.
	void pressureLoad(int block, Side side, const Table& p, int from = 0, int to = -1);
	/// Transmitting boundary (Lysmer & Kuhlemeyer 1969).
	void viscous(int block, Side side, int from = 0, int to = -1);
	/// Force [N/m] on single nodes.
	void nodalForce(const std::vector<int>& nodes, const Table& fx, const Table& fy);
	/// Velocity [m/s] of every node of a block; shared nodes get the mean weighted by mass.
	void setVelocity(int block, const std::function<std::array<double, 2>(double x, double y)>& v);
	/// Initial state of the cells of a block, which has not moved; what is empty stays. Cells of a block that is under stress are never asleep. Throws
	/// Error: another number of values, not finite, above the yield stress, a pressure that the equation of state does not have, or one that heats.
	void setCells(int block, const CellFields& fields);
	/// Mass [kg/m] added to an open node, by whoever is tied to it.
	void addNodeMass(int node, double mass);

	// ---- one step: x^n, v^(n-1/2) -> x^(n+1), v^(n+1/2)
	/// First half: stresses at x^n, forces on open nodes complete in open().fx; closed nodes move already.
	void computeForces(double dt);
	/// Adds a force [N/m] to an open node, between the two halves.
	void addNodeForce(int node, double fx, double fy)
	{
		open_.ex[size_t(node)] += fx;
		open_.ey[size_t(node)] += fy;
	}
	/// Time [s] over which the forces of a step of dt act on the velocities: half of the step before and half of this one.
	double kick(double dt) const { return dtPrevious_ > 0 ? 0.5 * (dtPrevious_ + dt) : dt; }
	/// Second half: open nodes move, energies are complete, gauges are read.
	void integrate(double dt);
	/// Forces are computed, integrate() has yet to follow.
	bool between() const { return between_; }
	double stepBegun() const { return dtNow_; } ///< of the step whose forces are computed [s]
	void step(double dt)
	{
		computeForces(dt);
		integrate(dt);
	}
	/// OpenMP threads of the steps; 0: as many as OpenMP gives. No result depends on it.
	void setThreads(int threads) { threads_ = threads; }
	/// Largest time step [s] the cells allow in their present state, safety included.
	double criticalTimeStep();
	/// The cell that sets criticalTimeStep, as text.
	std::string criticalCell() const;

	// ---- reading
	double              time() const { return time_; }   ///< of the positions [s]
	long                steps() const { return steps_; }
	int                 blocks() const { return int(blocks_.size()); }
	const Block&        block(int b) const { return *blocks_[size_t(b)]; }
	OpenNodes&          open() { return open_; }
	const OpenNodes&    open() const { return open_; }
	const GridOptions&  options() const { return options_; }
	/// Sums over the whole grid, in a fixed order; kinetic energy with v^(n+1/2), internal energy at the same half step.
	Energy energy() const;
	/// Part of the cells that are computed [-].
	double awakeFraction() const;
	/// EOS pressure [Pa] of every cell of a block, nj rows of pitch values; computed on call.
	void   pressure(int block, double* out) const;

	/// Point whose history is recorded every period-th step.
	int                addGauge(double x, double y, int period = 1);
	const Gauge&       gauge(int g) const { return gauges_[size_t(g)]; }
	int                gauges() const { return int(gauges_.size()); }
	/// State now at n points of the straight line from (x0,y0) to (x1,y1) [m], present positions; points outside all blocks are left out.
	std::vector<Sample> probeLine(double x0, double y0, double x1, double y1, int n) const;

	/// Whole state; restoring it into any Grid continues bit-identically. restore throws Error and changes nothing when the bytes are no state:
	/// every length, index, flag and number is checked. Damage that leaves a possible state is not seen: whoever keeps the bytes keeps a checksum.
	std::vector<char> save() const;
	void              restore(const std::vector<char>& state);

private:
	Grid& operator=(Grid&&) = default; ///< of restore()
	template <class Archive> void fields(Archive& a);
	void                          checkStep(double dt);
	void                          sumCorners();
	static uint64_t               layout(); ///< of the saved state: follows from the names and kinds of what fields() lists
	void                          checkState() const; ///< after reading: throws Error unless all fits together
	void                          checkBlock(const Block& b, int copies) const;
	void                          checkOpen() const;
	void                          allocateOpen();
	void                          join();
	void                          refuseHangingNodes() const;
	void                          masses();
	void                          averageVelocities();
	void                          restRanges();
	void                          checkCells(const Block& b, const CellFields& f) const;
	void                          mustBeBuilt() { if (!built_) build(); }
	void                          checkNodes(const std::vector<int>& nodes, const char* what) const;
	const Block&                  checkedBlock(int block, const char* what) const;
	std::vector<EdgeLoad>         sideEdges(int block, Side side, int from, int to);
	std::string                   nodeName(int node) const;
	void                          scanRates();
	void                          failIfBad(uint64_t worst);
	void                          partition(int threads, std::vector<int>& firstUnit) const;

	GridOptions                         options_;
	std::vector<std::unique_ptr<Block>> blocks_;
	OpenNodes                           open_;
	Boundary                            boundary_;
	Boundary::Account                   account_;
	std::vector<Gauge>                  gauges_;
	bool                                built_ = false, between_ = false, ratesKnown_ = false;
	double                              time_ = 0, dtPrevious_ = 0, dtNow_ = 0, restSpeed_ = 0, maxRate_ = 0, restRate_ = 0;
	long                                steps_ = 0;
	std::string                         failure_; ///< message of the error that ended the run
	int                                 threads_ = 0;
	std::vector<std::pair<int, int>>    bands_;   ///< (block, band), in order
};

/// Coordinates from a to b with first cell size h0 and last h1 near the given ones; neighbours differ by the same factor [m].
MCA_API std::vector<double> gradedLine(double a, double b, double h0, double h1);
}
