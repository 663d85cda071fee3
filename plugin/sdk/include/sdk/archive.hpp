// SPDX-License-Identifier: GPL-2.0-or-later
// Saving and loading. The library exports no serialize() of its classes but the serializers of boost::archive around it; they are taken from
// there, so stock members are saved by YADE's own code and class versions and export names agree with files written without the plugin.
#pragma once
#include <boost/archive/binary_iarchive.hpp>
#include <boost/archive/binary_oarchive.hpp>
#include <boost/archive/xml_iarchive.hpp>
#include <boost/archive/xml_oarchive.hpp>
#include <boost/serialization/base_object.hpp>
#include <boost/serialization/export.hpp>
#include <boost/serialization/map.hpp>
#include <boost/serialization/nvp.hpp>
#include <boost/serialization/shared_ptr.hpp>
#include <boost/serialization/string.hpp>
#include <boost/serialization/vector.hpp>
#include <lib/base/Math.hpp>

// at global scope: type T is (de)serialized by code of the library
#define YADE_SDK_STOCK_SERIALIZER(T)                                                                                                                           \
	namespace boost {                                                                                                                                      \
		namespace archive {                                                                                                                            \
			namespace detail {                                                                                                                     \
				extern template class oserializer<xml_oarchive, T>;                                                                            \
				extern template class iserializer<xml_iarchive, T>;                                                                            \
				extern template class oserializer<binary_oarchive, T>;                                                                         \
				extern template class iserializer<binary_iarchive, T>;                                                                         \
			}                                                                                                                                      \
		}                                                                                                                                              \
	}
// the same for a stock class that is a base class or may be pointed to
#define YADE_SDK_STOCK_ARCHIVE(cls)                                                                                                                            \
	YADE_SDK_STOCK_SERIALIZER(yade::cls)                                                                                                                   \
	BOOST_CLASS_EXPORT_KEY2(yade::cls, "yade::" #cls)

YADE_SDK_STOCK_SERIALIZER(yade::Vector2r)
YADE_SDK_STOCK_SERIALIZER(yade::Vector2i)
YADE_SDK_STOCK_SERIALIZER(yade::Vector3r)
YADE_SDK_STOCK_SERIALIZER(yade::Vector3i)
YADE_SDK_STOCK_SERIALIZER(yade::Vector6r)
YADE_SDK_STOCK_SERIALIZER(yade::Matrix3r)
YADE_SDK_STOCK_SERIALIZER(yade::Quaternionr)
YADE_SDK_STOCK_SERIALIZER(std::vector<yade::Real>)
YADE_SDK_STOCK_SERIALIZER(std::vector<int>)
YADE_SDK_STOCK_SERIALIZER(std::vector<std::string>)
YADE_SDK_STOCK_SERIALIZER(std::vector<yade::Vector2r>)
YADE_SDK_STOCK_SERIALIZER(std::vector<yade::Vector3r>)
