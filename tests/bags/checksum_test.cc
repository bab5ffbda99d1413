#include "bags/checksum.h"

#include <gtest/gtest.h>

#include <boost/crc.hpp>
#include <random>
#include <string>

namespace simbench::bags {
namespace {

std::uint32_t sum_of(const std::string& text) {
  Checksum sum;
  sum.add(text);
  return sum.value();
}

TEST(ChecksumTest, IsThatOfTheCatalogue) {
  EXPECT_EQ(sum_of("123456789"), 0xcbf43926U);
  EXPECT_EQ(sum_of(""), 0U);
}

TEST(ChecksumTest, InAnyPartsItIsThatOfBoost) {
  std::mt19937 random(3);
  std::string bytes;
  for (int i = 0; i < 1000; ++i) bytes += static_cast<char>(random());
  boost::crc_32_type expected;
  expected.process_bytes(bytes.data(), bytes.size());
  for (const std::size_t part : {1U, 7U, 8U, 13U, 1000U}) {
    Checksum sum;
    for (std::size_t at = 0; at < bytes.size(); at += part) {
      sum.add(std::string_view(bytes).substr(at, part));
    }
    EXPECT_EQ(sum.value(), expected.checksum()) << part;
  }
}

}  // namespace
}  // namespace simbench::bags
