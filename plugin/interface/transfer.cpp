// SPDX-License-Identifier: GPL-2.0-or-later
#include "transfer.hpp"

namespace mca::interface {

std::vector<std::pair<int, double>> nodeMasses(const std::vector<Carried>& row)
{
	std::map<int, double> sum;
	for (const Carried& c : row) {
		if (c.Na > 0) sum[c.a] += c.Na * c.mass;
		if (c.Nb > 0) sum[c.b] += c.Nb * c.mass;
	}
	return { sum.begin(), sum.end() };
}
}
