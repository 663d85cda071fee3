// SPDX-License-Identifier: GPL-2.0-or-later
// The two passes of one step over a block: bands of rows, fused (cells, then at once the nodes between them), and the seams between bands.
#pragma once
#include "block.hpp"

namespace mca::grid {

/// What a step hands to every band.
struct Step {
	double  dtPrevious; ///< from x^(n-1) to x^n [s]
	double  dt;         ///< from x^n to x^(n+1) [s]
	double  kick;       ///< from v^(n-1/2) to v^(n+1/2) [s]
	double  restSpeed;  ///< slower nodes are at rest [m/s]
	bool    skip;       ///< rows and cells no wave has reached are left out
	double* cornerX[4]; ///< forces on the copies of open nodes by the cell above right, above left, below left, below right of them [N/m]
	double* cornerY[4];
};

/// Row buffers of one thread.
class Workspace {
public:
	void              fit(size_t pitch, bool edges);
	RowForces&        ring(int row) { return ring_[size_t(row) % 2]; }
	double*           meanVx(int row) { return mean_[size_t(row) % 2 * 2]; }
	double*           meanVy(int row) { return mean_[size_t(row) % 2 * 2 + 1]; }
	const double*     zeros() const { return zeros_; }

private:
	size_t    pitch_ = 0;
	bool      edges_ = false;
	Arena     arena_;
	RowForces ring_[2];
	double*   mean_[4] = {};
	double*   zeros_   = nullptr;
};

/// Cells [lo,hi) of row j: state forward to x^n, forces into f; returns the largest rate as bits (a bad cell beats every good one).
using RowKernel = uint64_t (*)(const Block& block, int j, int lo, int hi, const CellConstants& constants, const RowForces& f);
/// Of one flow stress; each has a source of its own (row.cpp.in).
template <YieldKind kind> RowKernel rowKernelOf(const Block& block);

CellConstants cellConstants(const Block& block, double dtPrevious);

/// Adds the edge viscosity of row j to f (edge.cpp); returns the largest rate with it.
uint64_t edgeRow(const Block& block, int j, int lo, int hi, const CellConstants& constants, const RowForces& f);
/// Limiters of the edges that node row j owns, from x^n, v^(n-1/2). Must be complete before any band starts.
void edgeLimiterRow(Block& block, int j);

/// Bands: cells, and nodes inside the band; forces on open nodes go to the corner slots.
void sweepBand(Block& block, int band, const Step& step, Workspace& ws);
/// Node row between band and band+1, after both are swept.
void finishSeam(Block& block, int band, const Step& step, Workspace& ws);
/// Energy of the four cells around an open node, once its mean velocity is known.
void openNodeWork(Block& block, int i, int j, const double* cx[4], const double* cy[4], int copy, double wx, double wy, double dt);
/// New ranges of awake cells from the nodes that move; open nodes included.
void wake(Block& block);
}
