// SPDX-License-Identifier: GPL-2.0-or-later
// Open nodes (sides of blocks, and any node the user names) and what acts on them. They are integrated apart from the closed nodes, so that
// blocks can share them and other parties can add mass and force between the two halves of a step.
#pragma once
#include "block.hpp"
#include <limits>
#include <map>

namespace mca::grid {

enum class Side { bottom, right, top, left };

/// Piecewise linear in time, constant before the first and after the last point; one point: a constant.
struct MCA_API Table {
	std::vector<double> time, value;
	Table() = default;
	Table(double constant)
	        : time { 0. }
	        , value { constant }
	{
	}
	Table(std::vector<double> t, std::vector<double> v)
	        : time(std::move(t))
	        , value(std::move(v))
	{
	}
	double at(double t) const;
	/// Throws Error unless times rise, sizes agree and all is finite. what: for the message.
	void validate(const std::string& what) const;
};

/// Copies of open nodes in blocks and their masters. All masters as flat arrays of the same length.
struct MCA_API OpenNodes {
	std::vector<double> x, y;       ///< positions x^n [m]
	std::vector<double> vx, vy;     ///< velocities v^(n-1/2) [m/s]
	std::vector<double> mass;       ///< own and added [kg/m]
	std::vector<double> addedMass;  ///< the part added by others [kg/m]
	std::vector<double> fx, fy;     ///< forces of the cells [N/m], valid between computeForces and integrate
	std::vector<double> lx, ly;     ///< forces of tractions, pressures and nodal loads [N/m]
	std::vector<double> ex, ey;     ///< forces added by others [N/m]; zero again after integrate
	std::vector<double> wx, wy;     ///< mean of old and new velocity of the last step [m/s]
	// copies
	std::vector<int>    copyMaster;
	std::vector<int>    copyBlock;
	std::vector<size_t> copyNode;
	std::vector<double> copyMass;       ///< share of the block [kg/m]
	std::vector<double> copyVx, copyVy; ///< initial velocities as set per block, before averaging over the blocks [m/s]
	std::vector<double> corner[8];      ///< slots: x of corners 0..3, y of corners 0..3 (sweep.hpp)
	std::vector<int>    repeats;        ///< copies that are not the first of their master
	std::vector<int>    firstCopy;      ///< of each master
	int                 size() const { return int(x.size()); }
};

/// A velocity component held at a value: v . n = value(t).
struct Constraint {
	int    node;
	double nx, ny;
	int    table;
};

enum class LoadKind { traction, pressure, viscous };

/// Something that acts on an edge of the outline, traversed with the material on the left.
struct EdgeLoad {
	LoadKind kind;
	int      a, b;         ///< nodes
	int      tableX, tableY; ///< traction: both; pressure: tableX
	double   restLength;   ///< [m]
	double   zP, zS;       ///< impedances rho cP, rho cS [Pa s/m], viscous only
	int      block, i, j;  ///< the cell behind it, for messages
};

struct NodeLoad {
	int node, tableX, tableY;
};

/// Boundary conditions of a grid: filled by Grid's setters, applied once per step.
class Boundary {
public:
	int  addTable(const Table& t);
	void constrain(int node, double nx, double ny, int table, const std::string& where);
	void load(const EdgeLoad& l, const std::string& where);
	void load(const NodeLoad& l) { nodeLoads_.push_back(l); }

	/// Forces of tractions, pressures and nodal loads at time t into o.lx, o.ly.
	void forces(OpenNodes& o, double t) const;
	/// Viscous matrix per node for the present outline.
	void viscous(const OpenNodes& o);
	/// Positions of all open nodes from t to t+dt, velocities by kick [s]; works and impulses go to the account.
	struct Account {
		double loads = 0, external = 0, constraints = 0, viscous = 0;     ///< work done on the grid [J/m]
		double impulseX = 0, impulseY = 0;                                ///< of all of them [N s/m]
	};
	void accelerate(OpenNodes& o, double t, double dt, double kick, double restSpeed, Account& account);

	template <class Archive> void fields(Archive& a);

	/// After reading a saved state of a grid with so many open nodes: throws Error unless all fits together.
	void checkState(int openNodes) const;
	/// Look-ups, after that.
	void indexAll();

private:
	std::vector<Table>      tables_;
	std::vector<Constraint> constraints_; ///< in order of nodes
	std::vector<EdgeLoad>   edgeLoads_;
	std::vector<NodeLoad>   nodeLoads_;
	// look-ups
	std::vector<int>                           special_; ///< nodes with constraint or viscous edge, ascending
	std::multimap<std::pair<int, int>, size_t> loadOf_;    ///< loads of an edge
	std::multimap<int, int>                    viscousAt_; ///< the other ends of the viscous edges of a node
	std::vector<double>                        cxx_, cxy_, cyy_;
	struct Special {
		double ux, uy; ///< new velocity [m/s]
		double rx, ry; ///< reaction of the constraints [N/m]
		double qx, qy; ///< force of the viscous edges [N/m]
	};
	Special                                    accelerateSpecial(const OpenNodes& o, int node, double mid, double kick, double restSpeed) const;
	std::pair<size_t, size_t>                  constraintsOf(int node) const;
	bool                                       heldAlike(int a, int b) const;
	void                                       index(size_t edgeLoad);
	void                                       mark(int node);
};
}
