// SPDX-License-Identifier: GPL-2.0-or-later
// Number, vector and pointer types of the stock double-precision build of YADE 2023.02a (Debian 12, amd64).
#pragma once
#if !defined(EIGEN_DONT_ALIGN) || !defined(EIGEN_DONT_VECTORIZE)
#error "compile with -DEIGEN_DONT_ALIGN -DEIGEN_DONT_VECTORIZE: the stock build has Quaternionr and Se3r aligned to 8 bytes"
#endif
#ifndef EIGEN_DONT_PARALLELIZE
#define EIGEN_DONT_PARALLELIZE
#endif
// boost before anything of Python's, as its own headers demand
#include <boost/python.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <boost/enable_shared_from_this.hpp>
#include <boost/make_shared.hpp>
#include <boost/shared_ptr.hpp>
#include <limits>
#include <map>
#include <string>
#include <vector>

namespace yade {
namespace py = boost::python;
using boost::dynamic_pointer_cast;
using boost::make_shared;
using boost::shared_ptr;
using boost::static_pointer_cast;
using std::string;
using std::vector;

using Real        = double;
using Vector2i    = Eigen::Matrix<int, 2, 1>;
using Vector3i    = Eigen::Matrix<int, 3, 1>;
using Vector2r    = Eigen::Matrix<Real, 2, 1>;
using Vector3r    = Eigen::Matrix<Real, 3, 1>;
using Vector6r    = Eigen::Matrix<Real, 6, 1>;
using Matrix3r    = Eigen::Matrix<Real, 3, 3>;
using Quaternionr = Eigen::Quaternion<Real>;
using AngleAxisr  = Eigen::AngleAxis<Real>;

static constexpr Real NaN = std::numeric_limits<Real>::signaling_NaN();

// position and orientation of a body; the template argument is part of mangled names
template <class R> struct Se3 {
	Eigen::Matrix<R, 3, 1> position;
	Eigen::Quaternion<R>   orientation;
};
using Se3r = Se3<Real>;
} // namespace yade
