// SPDX-License-Identifier: GPL-2.0-or-later
#include "block.hpp"
#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <new>

namespace mca::grid {

void Arena::Free::operator()(void* p) const { std::free(p); }

Arena::Arena(size_t arrays, size_t length)
        : arrays_(arrays)
        , length_(length)
{
	if (!arrays || !length) return;
	// whole cache lines, and never a multiple of the page: 5 lines off
	stride_ = (length + 7) / 8 * 8;
	while ((stride_ * sizeof(double)) % 4096 != 320)
		stride_ += 8;
	const size_t bytes = (arrays * stride_ * sizeof(double) + 63) / 64 * 64;
	memory_.reset(std::aligned_alloc(64, bytes));
	if (!memory_) throw std::bad_alloc();
	std::memset(memory_.get(), 0, bytes);
	base_ = static_cast<double*>(memory_.get());
}

int Block::perimeterCopy(int i, int j) const
{
	if (j == 0) return i;
	if (j == nj) return (ni + 1) + i;
	const int columns = 2 * (ni + 1);
	return i == 0 ? columns + (j - 1) : columns + (nj - 1) + (j - 1);
}

int Block::copyOf(int i, int j) const
{
	if (isPerimeter(i, j)) return firstCopy + perimeterCopy(i, j);
	const int  n  = j * (ni + 1) + i;
	const auto it = std::lower_bound(interiorOpen.begin(), interiorOpen.end(), n);
	if (it == interiorOpen.end() || *it != n) return -1;
	return firstCopy + 2 * (ni + 1) + 2 * (nj - 1) + int(it - interiorOpen.begin());
}

void Block::nodeOfCopy(int copy, int& i, int& j) const
{
	int c = copy - firstCopy;
	if (c < ni + 1) { i = c, j = 0; return; }
	c -= ni + 1;
	if (c < ni + 1) { i = c, j = nj; return; }
	c -= ni + 1;
	if (c < nj - 1) { i = 0, j = c + 1; return; }
	c -= nj - 1;
	if (c < nj - 1) { i = ni, j = c + 1; return; }
	c -= nj - 1;
	i = interiorOpen[size_t(c)] % (ni + 1);
	j = interiorOpen[size_t(c)] / (ni + 1);
}

CellPattern Block::positionPattern(int i, int j) const
{
	const size_t a = node(i, j), b = node(i, j + 1);
	return cellPattern(x[a], y[a], x[a + 1], y[a + 1], x[b + 1], y[b + 1], x[b], y[b]);
}

CellPattern Block::velocityPattern(int i, int j) const
{
	const size_t a = node(i, j), b = node(i, j + 1);
	return cellPattern(vx[a], vy[a], vx[a + 1], vy[a + 1], vx[b + 1], vy[b + 1], vx[b], vy[b]);
}

double Block::pressureOf(int i, int j) const
{
	const size_t c   = cell(i, j);
	const double eps = area(i, j) / restArea[c] - 1.;
	const double p   = energy ? hotPressure(material.eos, eps, energy[c] / (material.eos.rho0 * restArea[c])) : pressure(material.eos, eps);
	return std::max(p, -material.fracture.spall);
}

void Block::allocate(int cellsPerRow, int rows)
{
	ni    = cellsPerRow;
	nj    = rows;
	pitch = (size_t(ni) + 1 + 7) / 8 * 8;
	const bool edges = options.edgeViscosity && material.viscosity.active();
	arena = Arena(12 + (account ? 1 : 0) + (material.yield.heats() ? 1 : 0) + (edges ? 2 : 0), pitch * (size_t(nj) + 1));
	size_t k = 0;
	for (double** p : { &x, &y, &vx, &vy, &invMass, &sxx, &syy, &sxy, &eqps, &restArea, &rx, &ry })
		*p = arena.array(k++);
	if (account) energy = arena.array(k++);
	if (material.yield.heats()) temperature = arena.array(k++);
	if (edges) {
		limiterX = arena.array(k++);
		limiterY = arena.array(k++);
	}
	if (temperature) std::fill(temperature, temperature + pitch * (size_t(nj) + 1), material.yield.referenceTemperature);

	bandStart.clear();
	const int bands = std::max(1, nj / bandRows); // every band has two rows or more, or there is one band only
	for (int b = 0; b <= bands; b++)
		bandStart.push_back(int(int64_t(nj) * b / bands));
	seamReady.assign(size_t(bands) - 1, 0);
	bandWorst.assign(size_t(bands), 0);
	zeroRow.assign(pitch, 0.);
	seamArena = Arena(size_t(bands) * 2 * 6, pitch);
	seamRow.resize(size_t(bands) * 2);
	for (size_t r = 0; r < seamRow.size(); r++) {
		RowForces& f = seamRow[r];
		size_t     a = r * 6;
		for (double** p : { &f.t0x, &f.t0y, &f.t1x, &f.t1y, &f.rx, &f.ry })
			*p = seamArena.array(a++);
	}
	awake.assign(size_t(nj), Range { 0, ni });
	moving.assign(size_t(nj) + 1, Range {});
	allAwake = true;
	interiorOpenRowStart.assign(size_t(nj) + 2, 0);
}

std::string Block::cellName(int i, int j) const
{
	return "block '" + options.name + "', cell (" + std::to_string(i) + ", " + std::to_string(j) + ")";
}

void Block::takeRestGeometry()
{
	for (int j = 0; j < nj; j++)
		for (int i = 0; i < ni; i++) {
			const double a = area(i, j);
			if (!(a > 0) || !std::isfinite(a)) {
				std::ostringstream s;
				s << cellName(i, j) << ": area " << a
				  << " m2 is not allowed; it must be finite and above zero. Give node coordinates so that rows (second index) lie to the left "
				     "of "
				     "the direction of the first index (counter-clockwise cells) and no cell is degenerate.";
				throw Error(s.str());
			}
			restArea[cell(i, j)] = a;
		}
}
}
