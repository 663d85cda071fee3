// SPDX-License-Identifier: GPL-2.0-or-later
// The map of the interface: shares, masses, and what it refuses.
#include "interface/transfer.hpp"
#include <cmath>
#include <gtest/gtest.h>

using namespace mca;
using namespace mca::interface;

namespace {
Material steel()
{
	Material m;
	m.eos = { 7830., 4578., 1.33, 1.67 };
	m.G   = 80e9;
	return m;
}
const Material material = steel();

/// n automata of diameter 1 along the line from the origin at `angle`, the first `begin` from the first node; `nodes` edges of length h; the block lies to the
/// right.
struct Scene {
	std::vector<RowPoint> row;
	SideNodes             side;
	MapOptions            options;
	double                c, s;
	Scene(int n, int edges, double h, double angle = 0.7, double begin = 0.)
	        : c(std::cos(angle))
	        , s(std::sin(angle))
	{
		for (int k = 0; k < n; k++)
			row.push_back({ 100 + k, (begin + k) * c, (begin + k) * s, 1., 0.4, 0.5, &material });
		side.block    = "right";
		side.material = &material;
		for (int k = 0; k <= edges; k++)
			side.node.push_back(10 * k), side.x.push_back(k * h * c), side.y.push_back(k * h * s);
		side.inX = 0.5 * c + s, side.inY = 0.5 * s - c;
	}
	std::string refusal() const
	{
		try {
			makeMap(row, side, options);
		} catch (const Error& e) {
			return e.what();
		}
		return "";
	}
	void off(size_t k, double by) { row[k].x -= by * s, row[k].y += by * c; }
};
bool has(const std::string& text, std::initializer_list<const char*> words)
{
	for (const char* w : words)
		if (text.find(w) == std::string::npos) {
			ADD_FAILURE() << "'" << w << "' is missing in: " << text;
			return false;
		}
	return true;
}
}

TEST(InterfaceMap, interpolatesInAnyOrderAndDirection)
{
	for (double h : { 0.5, 1., 2., 4. }) {
		Scene q(9, int(8 / h), h);
		std::swap(q.row[0], q.row[5]);
		const auto map = makeMap(q.row, q.side, q.options);
		ASSERT_EQ(map.size(), 9u);
		double mass = 0;
		for (size_t k = 0; k < map.size(); k++) {
			EXPECT_EQ(map[k].id, 100 + int(k));
			EXPECT_DOUBLE_EQ(map[k].Na + map[k].Nb, 1.);
			const double along = (map[k].Na * map[k].a + map[k].Nb * map[k].b) / 10. * h;
			EXPECT_NEAR(along, double(k), 1e-12);
			EXPECT_LT(std::hypot(map[k].rx, map[k].ry), 1e-14);
		}
		for (auto& m : nodeMasses(map))
			mass += m.second;
		EXPECT_NEAR(mass, 9 * 0.4, 1e-13);
	}
}

TEST(InterfaceMap, picksTheRowFromAllAutomata)
{
	Scene q(9, 8, 1.);
	for (int k = 0; k < 8; k++) // the next row, away from the grid
		q.row.push_back({ k, (k + 0.5) * q.c - 0.866 * q.s, (k + 0.5) * q.s + 0.866 * q.c, 1., 0.8, 1., &material });
	EXPECT_EQ(makeMap(q.row, q.side, q.options).size(), 9u);
}

TEST(InterfaceMap, refusesWithBodiesAndDistances)
{
	{
		Scene q(9, 8, 1.);
		q.off(3, 0.02);
		EXPECT_TRUE(has(q.refusal(), { "'right'", "body 103", "0.02 m", "0.0001 m", "off the line" }));
	}
	{
		Scene q(9, 8, 1.);
		q.off(3, -0.9);
		EXPECT_TRUE(has(q.refusal(), { "body 103", "overlaps the grid", "0.9 m inside" }));
	}
	{
		Scene q(9, 8, 1.);
		q.row.erase(q.row.begin() + 4);
		EXPECT_TRUE(has(q.refusal(), { "gap", "body 103", "body 105", "2 m apart" }));
	}
	{
		Scene q(9, 8, 1.);
		q.row.push_back({ 7, 3.5 * q.c, 3.5 * q.s, 1., 0.4, 0.5, &material });
		EXPECT_TRUE(has(q.refusal(), { "overlap", "body 103", "body 7", "0.5 m apart" }));
	}
	{
		Scene q(7, 8, 1.);
		EXPECT_TRUE(has(q.refusal(), { "gap", "ends with body 106", "2 m before" }));
	}
	{
		Scene q(9, 7, 1.);
		EXPECT_TRUE(q.refusal().empty()); // one beyond the end at a full diameter is another row's business
		q.options.onlyGiven = true;
		EXPECT_TRUE(has(q.refusal(), { "body 108", "beyond the end", "1 m" }));
	}
	{
		Scene q(9, 8, 1.);
		q.row[4].weight = 1.;
		EXPECT_TRUE(has(q.refusal(), { "body 104", "stands for 1", "1/2" }));
	}
	{
		Material other = steel();
		other.G *= 1.01;
		Scene q(9, 8, 1.);
		q.row[2].material = &other;
		EXPECT_TRUE(has(q.refusal(), { "body 102", "shearModulus", "otherMaterials" }));
		q.options.otherMaterials = true;
		EXPECT_TRUE(q.refusal().empty());
	}
	{
		Scene q(11, 2, 5.);
		EXPECT_TRUE(has(q.refusal(), { "5 m long", "5 times the spacing", "0.5 to 4.5" }));
	}
	{
		Scene q(9, 8, 1.);
		q.side.x[4] += 1e-3;
		EXPECT_TRUE(has(q.refusal(), { "node 4", "off the line between its ends", "straight" }));
	}
	{
		Scene q(9, 8, 1.);
		for (size_t k = 0; k < 9; k++)
			q.off(k, 3.);
		EXPECT_TRUE(has(q.refusal(), { "gap: 0 automata", "is 3 m away" }));
	}
}
