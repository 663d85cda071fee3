// SPDX-License-Identifier: GPL-2.0-or-later
// The checksums of saved files: of flat arrays (Blob.hpp) and of the attributes of each class of the plugin (sdk/declare.hpp).
#pragma once
#include <array>
#include <boost/archive/archive_exception.hpp>
#include <boost/serialization/nvp.hpp>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>

namespace yade {
namespace sdk {
	/// CRC-32 as in zlib (polynomial 0xEDB88320), eight bytes at a time: some 2 GB/s. `so far`: that of what came before.
	inline uint32_t crc32(uint32_t soFar, const void* data, size_t n)
	{
		using Tables = std::array<std::array<uint32_t, 256>, 8>;
		static const Tables table = [] {
			Tables t {};
			for (uint32_t i = 0; i < 256; i++) {
				uint32_t c = i;
				for (int k = 0; k < 8; k++)
					c = c & 1 ? 0xEDB88320u ^ (c >> 1) : c >> 1;
				t[0][i] = c;
			}
			for (size_t k = 1; k < 8; k++)
				for (size_t i = 0; i < 256; i++)
					t[k][i] = t[0][t[k - 1][i] & 0xff] ^ (t[k - 1][i] >> 8);
			return t;
		}();
		const unsigned char* p = static_cast<const unsigned char*>(data);
		uint32_t             c = ~soFar;
		for (; n >= 8; n -= 8, p += 8) {
			uint64_t w;
			std::memcpy(&w, p, 8);
			w ^= c;
			c = table[7][w & 0xff] ^ table[6][w >> 8 & 0xff] ^ table[5][w >> 16 & 0xff] ^ table[4][w >> 24 & 0xff] ^ table[3][w >> 32 & 0xff]
			        ^ table[2][w >> 40 & 0xff] ^ table[1][w >> 48 & 0xff] ^ table[0][w >> 56];
		}
		for (; n; n--, p++)
			c = table[0][(c ^ *p) & 0xff] ^ (c >> 8);
		return ~c;
	}

	/// Checksum over attributes: numbers, strings, vectors and matrices, and arrays of them. What has a check of its own (Blob, other objects) adds
	/// nothing.
	class Seal {
	public:
		template <class T> void add(const T& v)
		{
			if constexpr (std::is_floating_point_v<T>)
				bytes(std::isnan(v) ? std::numeric_limits<T>::quiet_NaN() : v); // text keeps no bits of those
			else if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>)
				bytes(v);
			else if constexpr (isPair<T>(0))
				add(v.first), add(v.second);
			else if constexpr (isCoefficients<T>(0))
				add(v.coeffs());
			else if constexpr (isArray<T>(0)) {
				const uint64_t n = uint64_t(v.size());
				bytes(n);
				for (uint64_t i = 0; i < n; i++)
					add(v.data()[i]);
			}
		}
		uint32_t value() const { return crc; }

	private:
		template <class T> void bytes(const T& v) { crc = crc32(crc, &v, sizeof v); }
		template <class T> static constexpr auto isArray(int) -> decltype(std::declval<const T&>().data()[0], std::declval<const T&>().size(), true)
		{
			return true;
		}
		template <class T> static constexpr bool isArray(...) { return false; }
		template <class T> static constexpr auto isCoefficients(int) -> decltype(std::declval<const T&>().coeffs(), true) { return true; }
		template <class T> static constexpr bool isCoefficients(...) { return false; }
		template <class T> static constexpr auto isPair(int) -> decltype(std::declval<const T&>().first, std::declval<const T&>().second, true)
		{
			return true;
		}
		template <class T> static constexpr bool isPair(...) { return false; }
		uint32_t crc = 0;
	};

	/// Writes the seal of an object behind its attributes, or compares it with the one in the file.
	template <class Archive> void checkSeal(Archive& archive, const Seal& seal, const char* name)
	{
		uint32_t saved = seal.value();
		try {
			archive& boost::serialization::make_nvp("seal", saved);
		} catch (const boost::archive::archive_exception&) {
			if constexpr (!Archive::is_loading::value) throw;
			saved = ~seal.value();
		}
		if (saved != seal.value())
			throw std::runtime_error(
				std::string(name)
				+ ": its attributes in the file are not those that were saved: the file is damaged, was edited (change attributes after "
				  "loading), or comes from an older version of the plugin, which must load it.");
	}
} // namespace sdk
} // namespace yade
