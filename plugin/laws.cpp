// SPDX-License-Identifier: GPL-2.0-or-later
// Prints the list of laws as JSON, for Python and the documentation: a step of the build, which keeps pyscripts/yade_mca/data/laws.json.
#include "kernels/laws/list.hpp"
#include <cmath>
#include <cstdio>

namespace {
const char* comma = "";

void number(double v) { std::isinf(v) ? std::printf("Infinity") : std::printf("%.17g", v); }
void range(const mca::Range& r)
{
	std::printf("\"range\": [");
	number(r.least), std::printf(", "), number(r.most);
	std::printf(
		"], \"ends\": [%s, %s, %s], \"words\": \"%s\"", r.withLeast ? "true" : "false", r.withMost ? "true" : "false", r.infinite ? "true" : "false",
		r.words);
}
void constant(const char* name, const char* unit, double start, const mca::Range& r, const char* text)
{
	std::printf("%s\n    {\"name\": \"%s\", \"unit\": \"%s\", \"default\": ", comma, name, unit);
	number(start), std::printf(", "), range(r), std::printf(", \"text\": \"%s\"}", text), comma = ",";
}
void use(const char* name, const mca::Range& r)
{
	std::printf("%s\n    {\"name\": \"%s\", ", comma, name);
	range(r), std::printf("}"), comma = ",";
}
} // namespace

#define MCA_PRINT_CONSTANT(name, unit, start, range, text) constant(#name, unit, start, range, text);
#define MCA_PRINT_USE(name, range) use(#name, range);
#define MCA_PRINT_LAW(name, law, text) \
	std::printf("%s\n  {\"name\": \"%s\", \"text\": \"%s\", \"heats\": %s, \"constants\": [", before, #name, text, law::heats ? "true" : "false"); \
	comma = "", before = ","; \
	MCA_CONSTANTS_##name(MCA_PRINT_CONSTANT) std::printf("],\n   \"uses\": ["); \
	comma = ""; \
	MCA_USES_##name(MCA_PRINT_USE) std::printf("]}");

int main()
{
	using namespace mca;
	const char* before = "";
	std::printf("{\"eos\": [");
	{
		using namespace mca::eos;
		MCA_EOS_LAWS(MCA_PRINT_LAW)
	}
	before = "";
	std::printf("],\n \"yieldModel\": [");
	{
		using namespace mca::flow;
		MCA_FLOW_LAWS(MCA_PRINT_LAW)
	}
	std::printf("]}\n");
}
