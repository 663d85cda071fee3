// SPDX-License-Identifier: GPL-2.0-or-later
// Arrays in a saved file: the bits come back, in each kind of archive; what does not fit is refused.
#include <boost/archive/binary_iarchive.hpp>
#include <boost/archive/binary_oarchive.hpp>
#include <boost/archive/xml_iarchive.hpp>
#include <boost/archive/xml_oarchive.hpp>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>
#include <sdk/Blob.hpp>
#include <sstream>

using yade::sdk::Blob;
using yade::sdk::BlobReader;

template <class Out, class In> Blob roundTrip(const Blob& blob)
{
	std::stringstream stream;
	{
		Out archive(stream);
		archive << boost::serialization::make_nvp("blob", blob);
	}
	Blob back;
	back.put(1.); // what was there before must go
	In archive(stream);
	archive >> boost::serialization::make_nvp("blob", back);
	return back;
}
template <class Out, class In> void checkBits(size_t n)
{
	std::mt19937_64        random(n);
	std::vector<double>    values(n);
	std::vector<long>      ids(n / 3);
	for (double& x : values) { // any bits at all: not-a-numbers, denormals, infinities among them
		const uint64_t bits = random();
		std::memcpy(&x, &bits, sizeof x);
	}
	if (n > 3) values[3] = std::numeric_limits<double>::infinity();
	for (long& i : ids)
		i = long(random());
	Blob blob;
	blob.put(values);
	blob.put(7);
	blob.put(ids);
	const Blob          back = roundTrip<Out, In>(blob);
	BlobReader          reader(back);
	std::vector<double> values2;
	std::vector<long>   ids2;
	reader.get(values2);
	EXPECT_EQ(reader.get<int>(), 7);
	reader.get(ids2);
	EXPECT_TRUE(reader.atEnd());
	ASSERT_EQ(values2.size(), n);
	EXPECT_TRUE(n == 0 || std::memcmp(values.data(), values2.data(), n * sizeof(double)) == 0);
	EXPECT_EQ(ids, ids2);
}
TEST(Blob, ComesBackFromBinary)
{
	for (const size_t n : { 0, 1, 2, 3, 17, 1000, 100003 })
		checkBits<boost::archive::binary_oarchive, boost::archive::binary_iarchive>(n);
}
TEST(Blob, ComesBackFromXml)
{
	for (const size_t n : { 0, 1, 2, 3, 17, 1000, 10003 })
		checkBits<boost::archive::xml_oarchive, boost::archive::xml_iarchive>(n);
}
TEST(Blob, EmptyComesBackEmpty)
{
	EXPECT_TRUE((roundTrip<boost::archive::xml_oarchive, boost::archive::xml_iarchive>(Blob()).empty()));
	EXPECT_TRUE((roundTrip<boost::archive::binary_oarchive, boost::archive::binary_iarchive>(Blob()).empty()));
}
TEST(Blob, RefusesWhatDoesNotFit)
{
	Blob blob;
	blob.put(std::vector<double> { 1, 2, 3 });
	std::vector<float> other;
	EXPECT_THROW(BlobReader(blob).get(other), std::runtime_error);
	Blob cut;
	cut.put<uint64_t>(1000); // says 1000 values, holds none
	cut.put<uint64_t>(8);
	std::vector<double> values;
	EXPECT_THROW(BlobReader(cut).get(values), std::runtime_error);
	EXPECT_THROW(BlobReader(Blob()).get<int>(), std::runtime_error);
}
