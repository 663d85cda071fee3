// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <lib/serialization/Serializable.hpp>

namespace yade {
class Cell : public Serializable { // periodic cell; used through these exported members only
public:
	Cell() = delete;
	Matrix3r getHSize() const;
	Vector3r getSize_copy() const;
	Real     getVolume() const;
};
} // namespace yade
