#include "recording/number_in.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace simbench {
namespace {

TEST(NumberIn, ReadsTheWholeText) {
  EXPECT_EQ(number_in<int>("-12"), -12);
  EXPECT_EQ(number_in<std::uint64_t>("18446744073709551615"), UINT64_MAX);
  EXPECT_EQ(number_in<double>("2.5e-3"), 0.0025);
}

TEST(NumberIn, RefusesWhateverElseStandsThere) {
  for (const char* const text : {"", " 1", "1 ", "+1", "1x", "one", "-"}) {
    EXPECT_EQ(number_in<int>(text), std::nullopt) << text;
    EXPECT_EQ(number_in<double>(text), std::nullopt) << text;
  }
  EXPECT_EQ(number_in<int>("1.0"), std::nullopt);
  EXPECT_EQ(number_in<unsigned>("-1"), std::nullopt);
}

TEST(NumberIn, RefusesWhatIsBeyondTheRange) {
  EXPECT_EQ(number_in<std::uint8_t>("256"), std::nullopt);
  EXPECT_EQ(number_in<double>("1e999"), std::nullopt);
}

}  // namespace
}  // namespace simbench
