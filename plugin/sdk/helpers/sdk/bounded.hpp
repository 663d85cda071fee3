// SPDX-License-Identifier: GPL-2.0-or-later
// Strings and vectors of the plugin's classes in a file. Boost makes room for the length a file states before it reads: four bytes of damage cost
// gigabytes. Here room grows with what has been read.
#pragma once
#include <algorithm>
#include <boost/archive/binary_iarchive.hpp>
#include <boost/serialization/level.hpp>
#include <boost/serialization/nvp.hpp>
#include <boost/serialization/tracking.hpp>
#include <string>
#include <type_traits>
#include <vector>

namespace yade {
namespace sdk {
	template <class Archive, class T> void transfer(Archive& archive, const char* name, T& value) { archive& boost::serialization::make_nvp(name, value); }

	/// The same bytes as Boost's.
	template <class Archive> void transfer(Archive& archive, const char* name, std::string& value)
	{
		if constexpr (std::is_same_v<Archive, boost::archive::binary_iarchive>) {
			size_t length = 0;
			archive.load_binary(&length, sizeof length);
			value.clear();
			while (value.size() < length) {
				const size_t at = value.size(), more = std::min<size_t>(4096, length - at);
				value.resize(at + more);
				archive.load_binary(&value[at], more);
			}
		} else
			archive& boost::serialization::make_nvp(name, value);
	}

	template <class T> struct Items {
		std::vector<T>&                v;
		template <class Archive> void serialize(Archive& archive, unsigned)
		{
			uint64_t count = v.size();
			archive& boost::serialization::make_nvp("count", count);
			if constexpr (Archive::is_loading::value) v.clear();
			for (uint64_t k = 0; k < count; k++) {
				if constexpr (Archive::is_loading::value) v.emplace_back();
				transfer(archive, "item", v[size_t(k)]);
			}
		}
	};
	template <class Archive, class T> void transfer(Archive& archive, const char* name, std::vector<T>& value)
	{
		Items<T> items { value };
		archive& boost::serialization::make_nvp(name, items);
	}
} // namespace sdk
} // namespace yade

// stored in place: no class version, no tracking of addresses
namespace boost {
namespace serialization {
	template <class T> struct implementation_level<yade::sdk::Items<T>> {
		using tag  = mpl::integral_c_tag;
		using type = mpl::int_<object_serializable>;
		BOOST_STATIC_CONSTANT(int, value = type::value);
	};
	template <class T> struct tracking_level<yade::sdk::Items<T>> {
		using tag  = mpl::integral_c_tag;
		using type = mpl::int_<track_never>;
		BOOST_STATIC_CONSTANT(int, value = type::value);
	};
} // namespace serialization
} // namespace boost
