// SPDX-License-Identifier: GPL-2.0-or-later
// McaGridEngine: conversion of what scripts give and take.
#include "McaGridEngine.hpp"
#include <kernels/deviator.hpp>
#include "McaTables.hpp"
#include <sdk/arrayView.hpp>

namespace yade {
using mca::grid::Side;
using mca::grid::Table;

namespace {
	/// What Python raises about an argument becomes one sentence that names it.
	template <class F> auto argument(const char* name, const char* range, F&& f)
	{
		try {
			return f();
		} catch (const py::error_already_set&) {
			PyErr_Clear();
			throw mca::Error(string(name) + " must be " + range + ".");
		}
	}

	/// Any sequence or array of numbers as doubles; shape of the array if asked for.
	vector<double> numbers(py::object o, const char* name, vector<long>* shape = nullptr)
	{
		return argument(name, "numbers: a sequence or an array that numpy can read as float64", [&] {
			const py::object numpy = py::import("numpy");
			const py::object given = numpy.attr("asarray")(o);
			const char       kind  = py::extract<char>(given.attr("dtype").attr("kind"));
			if (kind != 'f' && kind != 'i' && kind != 'u')
				throw mca::Error(
					string(name) + " must be real numbers, not " + string(py::extract<string>(py::str(given.attr("dtype")))) + ".");
			const py::object a = numpy.attr("ascontiguousarray")(given, "float64");
			Py_buffer        b;
			if (PyObject_GetBuffer(a.ptr(), &b, PyBUF_C_CONTIGUOUS) != 0) py::throw_error_already_set();
			const double*  p = static_cast<const double*>(b.buf);
			vector<double> v(p, p + b.len / Py_ssize_t(sizeof(double)));
			for (double x : v)
				if (!std::isfinite(x)) {
					PyBuffer_Release(&b);
					throw mca::Error(string(name) + " must be finite numbers; one is " + std::to_string(x) + ".");
				}
			if (shape) shape->assign(b.shape, b.shape + b.ndim);
			PyBuffer_Release(&b);
			return v;
		});
	}

	/// A number, or a pair (times, values).
	Table table(py::object o, const char* name)
	{
		const py::extract<double> number(o);
		Table t(0);
		if (number.check() && !PyUnicode_Check(o.ptr())) t = Table(number());
		else {
			if (!PySequence_Check(o.ptr()) || PyUnicode_Check(o.ptr()) || py::len(o) != 2)
				throw mca::Error(string(name) + " must be a number or a pair (times [s], values) of rising times and as many values.");
			const string times = string(name) + " (times)", values = string(name) + " (values)";
			t = Table(numbers(o[0], times.c_str()), numbers(o[1], values.c_str()));
		}
		t.validate(name);
		return t;
	}

	} // namespace
	Table tableOf(const py::object& o, const char* name) { return table(o, name); }
	namespace {
	vector<int> nodeList(py::object o)
	{
		return argument("nodes", "the number of an open node or a sequence of such numbers (sideNodes, openNode)", [&] {
			const py::extract<int> one(o);
			if (one.check()) return vector<int> { one() };
			vector<int> v;
			for (long k = 0; k < py::len(o); k++)
				v.push_back(py::extract<int>(o[k]));
			if (v.empty()) throw mca::Error("nodes must name at least one open node (sideNodes, openNode).");
			return v;
		});
	}

	/// What a call of the grid refuses, with the name of the call in front.
	template <class F> auto inCall(const char* call, F&& f)
	{
		try {
			return f();
		} catch (const mca::Error& e) {
			const string text = e.what();
			throw mca::Error(text.rfind("McaGridEngine", 0) == 0 ? text : "McaGridEngine." + string(call) + ": " + text);
		}
	}

	Side sideOf(const string& name)
	{
		if (name == "bottom") return Side::bottom;
		if (name == "right") return Side::right;
		if (name == "top") return Side::top;
		if (name == "left") return Side::left;
		throw mca::Error("side '" + name + "' is unknown; it must be 'bottom', 'right', 'top' or 'left'.");
	}

	mca::Material constants(const shared_ptr<Material>& m)
	{
		const auto* known = dynamic_cast<const McaMat*>(m.get());
		if (!known) throw mca::Error("unknown material" + (m ? " of class " + m->getClassName() : string(" None")) + "; material must be a McaMat.");
		return known->toMaterial();
	}
} // namespace

mca::grid::BlockOptions McaGridEngine::blockOptions(const string& name, Real hourglass, bool edgeViscosity) const
{
	mca::grid::BlockOptions o;
	o.name          = name;
	o.hourglass     = hourglass;
	o.edgeViscosity = edgeViscosity;
	return o;
}

int McaGridEngine::addRectangle(shared_ptr<Material> material, py::object xs, py::object ys, const string& name, Real hourglass, bool edgeViscosity)
{
	return inCall("addRectangle", [&] {
		const auto m = constants(material);
		vector<long> sx, sy;
		const auto   x = numbers(xs, "xs", &sx), y = numbers(ys, "ys", &sy);
		if (sx.size() != 1 || sy.size() != 1) throw mca::Error("xs and ys must be rows of numbers (one dimension), the grid lines [m].");
		for (const auto* v : { &x, &y })
			for (size_t k = 1; k < v->size(); k++)
				if (!((*v)[k] > (*v)[k - 1]) && v->size() > 2 && (*v)[k] == (*v)[k - 1])
					throw mca::Error(
						string(v == &x ? "xs" : "ys") + " must rise; entries " + std::to_string(k - 1) + " and " + std::to_string(k)
						+ " are equal.");
		return locked([&] { return grid().addRectangle(m, x, y, blockOptions(name, hourglass, edgeViscosity)); });
	});
}

int McaGridEngine::addBlock(shared_ptr<Material> material, py::object x, py::object y, const string& name, Real hourglass, bool edgeViscosity)
{
	return inCall("addBlock", [&] {
		vector<long>         sx, sy;
		const vector<double> nx = numbers(x, "x", &sx), ny = numbers(y, "y", &sy);
		if (sx.size() != 2 || sx != sy) throw mca::Error("block '" + name + "': x and y must be arrays of the same shape (rows+1, cells per row+1).");
		const auto m = constants(material);
		return locked([&] { return grid().addBlock(m, int(sx[1]) - 1, int(sx[0]) - 1, nx, ny, blockOptions(name, hourglass, edgeViscosity)); });
	});
}

py::list McaGridEngine::sideNodes(int block, const string& side, int start, int end)
{
	return inCall("sideNodes", [&] {
		py::list l;
		for (int n : locked([&] { return grid().sideNodes(block, sideOf(side), start, end); }))
			l.append(n);
		return l;
	});
}

void McaGridEngine::fix(int block, const string& side, bool x, bool y, int start, int end)
{
	inCall("fix", [&] {
		locked([&] { grid().fix(grid().sideNodes(block, sideOf(side), start, end), x, y); });
	});
}

void McaGridEngine::fixNodes(py::object nodes, bool x, bool y)
{
	inCall("fixNodes", [&] {
		const auto n = nodeList(nodes);
		locked([&] { grid().fix(n, x, y); });
	});
}

void McaGridEngine::symmetry(int block, const string& side)
{
	inCall("symmetry", [&] {
		locked([&] { grid().symmetry(block, sideOf(side)); });
	});
}

void McaGridEngine::prescribe(int block, const string& side, py::object vx, py::object vy, int start, int end)
{
	inCall("prescribe", [&] {
		const bool  x = !vx.is_none(), y = !vy.is_none();
		const Table tx = x ? table(vx, "x") : Table(0), ty = y ? table(vy, "y") : Table(0);
		locked([&] {
			const auto nodes = grid().sideNodes(block, sideOf(side), start, end);
			if (x) grid().prescribe(nodes, 1, 0, tx);
			if (y) grid().prescribe(nodes, 0, 1, ty);
		});
	});
}

void McaGridEngine::prescribeNodes(py::object nodes, const Vector2r& d, py::object velocity)
{
	inCall("prescribeNodes", [&] {
		const auto  n = nodeList(nodes);
		const Table t = table(velocity, "velocity");
		locked([&] { grid().prescribe(n, d[0], d[1], t); });
	});
}

void McaGridEngine::traction(int block, const string& side, py::object x, py::object y, int start, int end)
{
	inCall("traction", [&] {
		const Table tx = table(x, "x"), ty = table(y, "y");
		locked([&] { grid().traction(block, sideOf(side), tx, ty, start, end); });
	});
}

void McaGridEngine::pressureLoad(int block, const string& side, py::object p, int start, int end)
{
	inCall("pressure", [&] {
		const Table t = table(p, "value");
		locked([&] { grid().pressureLoad(block, sideOf(side), t, start, end); });
	});
}

void McaGridEngine::viscous(int block, const string& side, int start, int end)
{
	inCall("viscous", [&] {
		locked([&] { grid().viscous(block, sideOf(side), start, end); });
	});
}

void McaGridEngine::force(py::object nodes, py::object fx, py::object fy)
{
	inCall("force", [&] {
		const auto  n = nodeList(nodes);
		const Table tx = table(fx, "x"), ty = table(fy, "y");
		locked([&] { grid().nodalForce(n, tx, ty); });
	});
}

void McaGridEngine::setVelocity(int block, py::object velocity)
{
	inCall("setVelocity", [&] {
		vector<long>         shape;
		const vector<double> v = numbers(velocity, "velocity", &shape);
		locked([&] { setVelocities(block, v, shape); });
	});
}

void McaGridEngine::setVelocities(int block, const vector<double>& v, const vector<long>& shape)
{
	if (v.size() == 2) {
		grid().setVelocity(block, [&](double, double) { return std::array<double, 2> { v[0], v[1] }; });
		return;
	}
	if (block < 0 || block >= grid().blocks()) throw mca::Error("there is no block " + std::to_string(block) + ".");
	const auto& b = grid().block(block);
	if (shape.size() != 3 || shape[0] != b.nj + 1 || shape[1] != b.ni + 1 || shape[2] != 2)
		throw mca::Error(
			"block '" + b.options.name + "': velocity must be a pair or an array of shape (" + std::to_string(b.nj + 1) + ", "
			+ std::to_string(b.ni + 1) + ", 2).");
	size_t k = 0; // setVelocity asks row by row
	grid().setVelocity(block, [&](double, double) {
		k += 2;
		return std::array<double, 2> { v[k - 2], v[k - 1] };
	});
}

namespace {
	/// Deviator and pressure of stresses xx, yy, xy (and zz) [Pa], one row for each cell or one for all.
	void putStress(const vector<double>& v, const vector<long>& shape, const mca::grid::Block& b, mca::grid::CellFields& to)
	{
		const size_t cells = size_t(b.ni) * size_t(b.nj), n = shape.empty() ? 0 : size_t(shape.back());
		const bool   one = shape.size() == 1, all = shape.size() == 3 && shape[0] == b.nj && shape[1] == b.ni;
		if (!((one || all) && (n == 3 || n == 4)))
			throw mca::Error(
				"block '" + b.options.name + "': stress [Pa] must be xx, yy, xy (and zz) for all cells, or an array of shape ("
				+ std::to_string(b.nj) + ", " + std::to_string(b.ni) + ", 3 or 4).");
		const double K = b.material.eos.bulkModulus(), G = b.material.G, nu = (3 * K - 2 * G) / (2 * (3 * K + G));
		for (size_t k = 0; k < cells; k++) {
			const double* s = &v[one ? 0 : n * k];
			const mca::SplitStress split({ s[0], s[1], n == 4 ? s[3] : nu * (s[0] + s[1]), 0., 0., s[2] });
			to.pressure.push_back(split.pressure), to.sxy.push_back(split.deviator.xy);
			to.sxx.push_back(split.deviator.xx), to.syy.push_back(split.deviator.yy);
		}
	}
	/// A number for all cells, or one for each.
	vector<double> ofCells(const py::object& o, const char* name, const mca::grid::Block& b)
	{
		if (o.is_none()) return {};
		vector<long>         shape;
		const vector<double> v = numbers(o, name, &shape);
		if (v.size() == 1) return vector<double>(size_t(b.ni) * size_t(b.nj), v[0]);
		if (shape.size() != 2 || shape[0] != b.nj || shape[1] != b.ni)
			throw mca::Error(
				"block '" + b.options.name + "': " + name + " must be a number or an array of shape (" + std::to_string(b.nj) + ", "
				+ std::to_string(b.ni) + ").");
		return v;
	}
} // namespace

void McaGridEngine::setCells(int block, py::object stress, py::object plasticStrain, py::object temperature)
{
	inCall("setCells", [&] {
		if (block < 0 || block >= grid().blocks()) throw mca::Error("there is no block " + std::to_string(block) + ".");
		const auto&           b = grid().block(block);
		mca::grid::CellFields f;
		f.eqps = ofCells(plasticStrain, "plasticStrain", b), f.temperature = ofCells(temperature, "temperature", b);
		vector<long> shape;
		if (!stress.is_none()) {
			const vector<double> v = numbers(stress, "stress", &shape);
			putStress(v, shape, b, f);
		}
		if (f.eqps.empty() && f.temperature.empty() && f.pressure.empty())
			throw mca::Error("give at least one of stress, plasticStrain, temperature.");
		locked([&] { grid().setCells(block, f); });
	});
}

int McaGridEngine::addGauge(const Vector2r& at, int period)
{
	return inCall("addGauge", [&] {
		return locked([&] { return grid().addGauge(at[0], at[1], period); });
	});
}

py::object McaGridEngine::view(int block, const string& what)
{
	return inCall("view", [&] {
		if (block < 0 || block >= grid().blocks()) throw mca::Error("there is no block " + std::to_string(block) + ".");
		const auto&   b     = grid().block(block);
		const double* p     = nullptr;
		bool          known = true, cells = true;
		shared_ptr<void> owner = solver;
		if (what == "x" || what == "y" || what == "vx" || what == "vy") {
			cells = false;
			p     = what == "x" ? b.x : what == "y" ? b.y : what == "vx" ? b.vx : b.vy;
		} else if (what == "sxx") p = b.sxx;
		else if (what == "syy") p = b.syy;
		else if (what == "sxy") p = b.sxy;
		else if (what == "plasticStrain") p = b.eqps;
		else if (what == "restArea") p = b.restArea;
		else if (what == "energy") p = b.energy;
		else if (what == "temperature") p = b.temperature;
		else if (what == "pressure") {
			pressures.resize(size_t(grid().blocks()));
			auto& v = pressures[size_t(block)];
			if (!v) v = shared_ptr<vector<double>>(new vector<double>(b.pitch * size_t(b.nj)));
			locked([&] { grid().pressure(block, v->data()); });
			p     = v->data();
			owner = v;
		} else
			known = false;
		if (!known)
			throw mca::Error(
				"what = '" + what
				+ "' is unknown; it must be one of x, y, vx, vy, sxx, syy, sxy, plasticStrain, restArea, energy, temperature, pressure.");
		if (!p)
			throw mca::Error(
				"block '" + b.options.name + "' does not keep '" + what + "'"
				+ (what == "energy" ? "; set account=True before the first block." : "; its material is not Johnson-Cook."));
		const Py_ssize_t rows = cells ? b.nj : b.nj + 1, columns = cells ? b.ni : b.ni + 1;
		return sdk::makeArrayView({ const_cast<double*>(p),
		                            "d",
		                            Py_ssize_t(sizeof(double)),
		                            { rows, columns },
		                            { Py_ssize_t(b.pitch * sizeof(double)), Py_ssize_t(sizeof(double)) },
		                            owner,
		                            false });
	});
}

py::object McaGridEngine::gaugeHistory(int k)
{
	const auto h = locked([&] {
		if (k < 0 || k >= grid().gauges())
			throw mca::Error(
				"McaGridEngine.gauge: number = " + std::to_string(k) + " must be from 0 to " + std::to_string(grid().gauges() - 1)
				+ "; there are " + std::to_string(grid().gauges()) + " gauges.");
		return grid().gauge(k).history;
	});
	static_assert(sizeof(mca::grid::Sample) == 10 * sizeof(double), "a sample is a row of ten numbers");
	static const double none = 0;
	return sdk::arrayCopy(h.empty() ? &none : &h[0].time, { Py_ssize_t(h.size()), 10 });
}

py::dict McaGridEngine::probeLine(const Vector2r& from, const Vector2r& to, int n)
{
	return inCall("probeLine", [&] {
		const auto s = locked([&] { return grid().probeLine(from[0], from[1], to[0], to[1], n); });
		py::dict   d;
		const auto put = [&](const char* name, double mca::grid::Sample::*member) {
			vector<double> v;
			for (const auto& e : s)
				v.push_back(e.*member);
			v.reserve(1);
			d[name] = sdk::arrayCopy(v.data(), { Py_ssize_t(v.size()) });
		};
		using S = mca::grid::Sample;
		put("x", &S::x), put("y", &S::y), put("vx", &S::vx), put("vy", &S::vy), put("pressure", &S::pressure);
		put("sxx", &S::sxx), put("syy", &S::syy), put("sxy", &S::sxy), put("plasticStrain", &S::eqps);
		return d;
	});
}

py::dict McaGridEngine::energies()
{
	const mca::grid::Energy e = locked([&] { return grid().energy(); });
	py::dict                d;
	d["kinetic"] = e.kinetic, d["internal"] = e.internal, d["total"] = e.total();
	d["workLoads"] = e.workLoads, d["workExternal"] = e.workExternal, d["workConstraints"] = e.workConstraints, d["workViscous"] = e.workViscous;
	d["momentumX"] = e.momentumX, d["momentumY"] = e.momentumY, d["impulseX"] = e.impulseX, d["impulseY"] = e.impulseY;
	return d;
}

py::list McaGridEngine::blockList()
{
	py::list l;
	for (int k = 0; k < grid().blocks(); k++) {
		py::dict d;
		d["name"]  = grid().block(k).options.name;
		d["cells"] = py::make_tuple(grid().block(k).ni, grid().block(k).nj);
		l.append(d);
	}
	return l;
}
} // namespace yade
