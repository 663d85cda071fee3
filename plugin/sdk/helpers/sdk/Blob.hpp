// SPDX-License-Identifier: GPL-2.0-or-later
// Flat arrays as one attribute of a saved class: raw bytes in binary archives, base64 in xml, the same bits in both, with a checksum.
#pragma once
#include <algorithm>
#include <boost/serialization/binary_object.hpp>
#include <boost/serialization/nvp.hpp>
#include <boost/serialization/vector.hpp>
#include <cstdint>
#include <cstring>
#include <sdk/checksum.hpp>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#ifndef MCA_VERSION
#define MCA_VERSION "unknown"
#endif

namespace yade {
namespace sdk {
	/// Bytes of arrays put one after another. Attribute type for engines: ((sdk::Blob, state, , Attr::hidden, "...")).
	/// In a file: number of bytes, a head (kind, format, checksum, length, version that wrote it), the bytes in pieces. So a damaged length never takes
	/// more memory than the file holds. Saving empties the blob: preSave fills it for each file, and it must not come back when postLoad runs for another
	/// reason.
	class Blob {
	public:
		void   clear() { bytes.clear(), bytes.shrink_to_fit(); }
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
			uint64_t n = bytes.empty() ? 0 : sizeof(Head) + bytes.size();
			archive& boost::serialization::make_nvp("size", n);
			if constexpr (Archive::is_loading::value) {
				bytes.clear();
				if (n) load(archive, n);
			} else if (n)
				save(archive);
		}

	private:
		friend class BlobReader;
		static constexpr size_t   piece  = 1 << 20;
		static constexpr uint32_t format = 2; ///< 1: without head and checksum
		struct Head {
			char     kind[8]    = { 'm', 'c', 'a', '-', 'b', 'l', 'o', 'b' };
			uint32_t format     = Blob::format;
			uint32_t checksum   = 0; ///< CRC-32 of this head with zero here, then of the bytes
			uint64_t length     = 0; ///< of the bytes
			char     writer[24] = {}; ///< version of the plugin
		};
		static_assert(sizeof(Head) == 48, "no padding: the head is compared as bytes");

		uint32_t checksum(Head h) const
		{
			h.checksum = 0;
			return crc32(crc32(0, &h, sizeof h), bytes.data(), bytes.size());
		}
		template <class Archive> static void transfer(Archive& archive, void* p, size_t n)
		{
			boost::serialization::binary_object data(p, n);
			archive& boost::serialization::make_nvp("data", data);
		}
		template <class Archive> void save(Archive& archive)
		{
			Head h;
			h.length = bytes.size();
			std::strncpy(h.writer, MCA_VERSION, sizeof h.writer - 1);
			h.checksum = checksum(h);
			transfer(archive, &h, sizeof h);
			for (size_t at = 0; at < bytes.size(); at += piece)
				transfer(archive, bytes.data() + at, std::min(piece, bytes.size() - at));
			clear();
		}
		template <class Archive> void load(Archive& archive, uint64_t n)
		{
			Head       h;
			const Head mine;
			try {
				if (n < sizeof h) fail("is damaged (its length)");
				transfer(archive, &h, sizeof h);
				if (std::memcmp(h.kind, mine.kind, sizeof h.kind) != 0)
					fail("has no head: the file is damaged, or an older version, which kept no checksum, has written it and must load it");
				if (h.format != format)
					fail("has format " + std::to_string(h.format) + ", this version (" MCA_VERSION ") reads format "
					     + std::to_string(format) + ": version '" + std::string(h.writer, strnlen(h.writer, sizeof h.writer))
					     + "' has written it and must load it");
				if (h.length != n - sizeof h) fail("is damaged (its length)");
				while (bytes.size() < h.length) {
					const size_t at = bytes.size(), more = size_t(std::min<uint64_t>(piece, h.length - at));
					bytes.resize(at + more);
					transfer(archive, bytes.data() + at, more);
				}
			} catch (const boost::archive::archive_exception&) {
				clear();
				fail("is cut or damaged");
			}
			if (checksum(h) == h.checksum) return;
			clear();
			fail("is damaged: its checksum does not fit");
		}
		[[noreturn]] static void fail(const std::string& what) { throw std::runtime_error("the saved state of an engine of yade-mca " + what + "."); }

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
			static_assert(!std::is_same_v<T, bool>, "a byte of a file may be neither true nor false");
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
		/// Refuses bytes that are left over.
		void end() const
		{
			if (!atEnd()) fail();
		}

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
