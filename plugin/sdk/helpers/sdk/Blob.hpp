// SPDX-License-Identifier: GPL-2.0-or-later
// Flat arrays as one attribute of a saved class: raw bytes in binary archives, base64 in xml, the same bits in both.
#pragma once
#include <boost/serialization/binary_object.hpp>
#include <boost/serialization/nvp.hpp>
#include <boost/serialization/vector.hpp>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace yade {
namespace sdk {
	/// Bytes of arrays put one after another. Attribute type for engines: ((sdk::Blob, state, , Attr::hidden, "...")).
	class Blob {
	public:
		void   clear() { bytes.clear(); }
		size_t size() const { return bytes.size(); } ///< bytes
		bool   empty() const { return bytes.empty(); }
		/// append one value of plain type (number, struct of numbers)
		template <class T> void put(const T& value)
		{
			static_assert(std::is_trivially_copyable_v<T>, "only plain data can be stored");
			const char* p = reinterpret_cast<const char*>(&value);
			bytes.insert(bytes.end(), p, p + sizeof(T));
		}
		/// append n values
		template <class T> void put(const T* values, size_t n)
		{
			static_assert(std::is_trivially_copyable_v<T>, "only plain data can be stored");
			put<uint64_t>(n);
			put<uint64_t>(sizeof(T));
			const char* p = reinterpret_cast<const char*>(values);
			if (n) bytes.insert(bytes.end(), p, p + n * sizeof(T));
		}
		template <class T, class A> void put(const std::vector<T, A>& values) { put(values.data(), values.size()); }

		template <class Archive> void serialize(Archive& archive, unsigned)
		{
			uint64_t n = bytes.size();
			archive& boost::serialization::make_nvp("size", n);
			if constexpr (Archive::is_loading::value) bytes.resize(n);
			if (n == 0) return;
			boost::serialization::binary_object data(bytes.data(), n);
			archive&                            boost::serialization::make_nvp("data", data);
		}

	private:
		friend class BlobReader;
		std::vector<char> bytes;
	};

	/// Reads a blob in the order it was written. Throws std::runtime_error when it holds something else.
	class BlobReader {
	public:
		explicit BlobReader(const Blob& b)
		        : blob(b)
		{
		}
		template <class T> T get()
		{
			T value;
			take(&value, sizeof(T));
			return value;
		}
		template <class T, class A> void get(std::vector<T, A>& values)
		{
			const uint64_t n = get<uint64_t>(), width = get<uint64_t>();
			if (width != sizeof(T) || n > (blob.bytes.size() - at) / sizeof(T)) fail();
			values.resize(n);
			take(values.data(), n * sizeof(T));
		}
		bool atEnd() const { return at == blob.bytes.size(); }

	private:
		void take(void* to, size_t n)
		{
			if (n > blob.bytes.size() - at) fail();
			if (n) std::memcpy(to, blob.bytes.data() + at, n);
			at += n;
		}
		[[noreturn]] void fail() const
		{
			throw std::runtime_error(
			        "saved arrays do not fit this version of the plugin (byte " + std::to_string(at) + " of " + std::to_string(blob.bytes.size())
			        + "): load the file with the version that wrote it");
		}
		const Blob& blob;
		size_t      at = 0;
	};
} // namespace sdk
} // namespace yade

// stored in place: no class version, no tracking of addresses
BOOST_CLASS_IMPLEMENTATION(yade::sdk::Blob, boost::serialization::object_serializable)
BOOST_CLASS_TRACKING(yade::sdk::Blob, boost::serialization::track_never)
