// SPDX-License-Identifier: GPL-2.0-or-later
// One structured block of quadrilateral cells: ni cells along a row, nj rows. Flat arrays in one arena; the same pitch for nodes and cells.
#pragma once
#include "../kernels/cell.hpp"
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace mca::grid {

/// Aligned memory whose arrays start at different offsets within a page, so that the many streams of a row do not share cache sets.
class MCA_API Arena {
public:
	Arena() = default;
	Arena(size_t arrays, size_t length);
	double*       array(size_t k) const { return base_ + k * stride_; }
	size_t        arrays() const { return arrays_; }
	size_t        length() const { return length_; }

private:
	struct MCA_API Free {
		void operator()(void* p) const;
	};
	std::unique_ptr<void, Free> memory_;
	double*                     base_   = nullptr;
	size_t                      stride_ = 0, arrays_ = 0, length_ = 0;
};

/// The six numbers per cell that make corner forces (kernels/cell.hpp), for one row of cells.
struct RowForces {
	double *t0x = nullptr, *t0y = nullptr, *t1x = nullptr, *t1y = nullptr;
	double *rx = nullptr, *ry = nullptr; ///< hourglass part: the state itself, or a buffer (edge viscosity)
};

/// Half-open interval; empty when lo >= hi.
struct Range {
	int  lo = 0, hi = 0;
	bool empty() const { return lo >= hi; }
};
inline Range hull(Range a, Range b)
{
	if (a.empty()) return b;
	if (b.empty()) return a;
	return { a.lo < b.lo ? a.lo : b.lo, a.hi > b.hi ? a.hi : b.hi };
}

/// What a block is made of, as the user states it.
struct BlockOptions {
	std::string name;              ///< how errors call the block; default "block<N>"
	double      hourglass = 1;     ///< multiplier of the hourglass stiffness [-]; 0 switches it off
	bool        edgeViscosity = false; ///< edge viscosity with limiter in place of the scalar one
};

/// Bands of rows are the unit of work of a thread. Their number does not depend on the number of threads, so no sum does either.
constexpr int bandRows = 16;
/// Waking goes by whole groups of cells, so that vector loops stay aligned.
constexpr int wakeCells = 16;

struct MCA_API Block {
	int          ni = 0, nj = 0; ///< cells along a row, rows
	size_t       pitch = 0;      ///< doubles from one row to the next, nodes and cells alike
	Material     material;
	BlockOptions options;
	Arena        arena;
	// nodes, (nj+1) x (ni+1)
	double *x = nullptr, *y = nullptr, *vx = nullptr, *vy = nullptr, *invMass = nullptr;
	// cells, nj x ni
	double *sxx = nullptr, *syy = nullptr, *sxy = nullptr, *eqps = nullptr, *restArea = nullptr, *rx = nullptr, *ry = nullptr;
	double *energy      = nullptr; ///< internal energy per unit thickness [J/m]; only with the energy account
	double *temperature = nullptr; ///< [K]; only where the flow stress heats
	double *limiterX = nullptr, *limiterY = nullptr; ///< 1 - psi of the edges (edge viscosity only): edge (i,j)-(i+1,j), edge (i,j)-(i,j+1)

	bool account = false; ///< internal energy is kept

	std::vector<int> bandStart; ///< first row of each band, and nj

	// sleeping: cells [lo,hi) of each row are computed; moving nodes of each node row
	std::vector<Range> awake;
	std::vector<Range> moving;
	bool               allAwake = false;

	// copies of open nodes: -1 for closed nodes. Perimeter copies come first: bottom row, top row, left column, right column.
	int              firstCopy = 0, nCopies = 0;
	std::vector<int> interiorOpen;         ///< node numbers j (ni+1) + i of open nodes off the perimeter, ascending
	std::vector<int> interiorOpenRowStart; ///< first of each node row in interiorOpen

	// first and last row of cells of each band keep their forces until the seam between bands is done
	Arena                  seamArena;
	std::vector<RowForces> seamRow; ///< two per band: first row, last row
	std::vector<double>    zeroRow;
	std::vector<int>       seamReady; ///< bands completed beside each seam in this step: 0 to 2
	std::vector<uint64_t>  bandWorst; ///< largest rate of each band, as bits

	size_t node(int i, int j) const { return size_t(j) * pitch + size_t(i); }
	size_t cell(int i, int j) const { return size_t(j) * pitch + size_t(i); }
	bool   isPerimeter(int i, int j) const { return i == 0 || j == 0 || i == ni || j == nj; }
	/// copy number of a perimeter node
	int perimeterCopy(int i, int j) const;
	/// copy number of any open node, -1 when the node is closed
	int copyOf(int i, int j) const;
	/// inverse of copyOf
	void nodeOfCopy(int copy, int& i, int& j) const;

	CellPattern positionPattern(int i, int j) const;
	CellPattern velocityPattern(int i, int j) const;
	double      area(int i, int j) const { return cellArea(positionPattern(i, j)); }
	/// EOS pressure [Pa] of one cell at its present area, as the forces of the next step will see it to first order in time
	double pressureOf(int i, int j) const;

	/// Arrays and bands for ni x nj cells; positions are set by the caller afterwards.
	void allocate(int cellsPerRow, int rows);
	/// Rest areas from positions; throws Error naming the first cell with an area that is not positive.
	void takeRestGeometry();
	std::string cellName(int i, int j) const;
};
}
