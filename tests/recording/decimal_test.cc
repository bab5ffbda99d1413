#include <gtest/gtest.h>

#include <cstdint>
#include <optional>
#include <random>

#include "recording/text_fields.h"

namespace simbench {
namespace {

constexpr std::int64_t kLargest = 4'000'000'000'000;

std::optional<std::int64_t> ns(std::string_view text) {
  const auto parsed = parse_ms(text, kLargest);
  return parsed ? std::optional(parsed->count()) : std::nullopt;
}

TEST(ParseMs, IsExactToTheNanosecond) {
  EXPECT_EQ(ns("0"), 0);
  EXPECT_EQ(ns("12.345679"), 12'345'679);
  EXPECT_EQ(ns("1597855377790.361600"), 1'597'855'377'790'361'600);
  EXPECT_EQ(ns("-0.5"), -500'000);
  EXPECT_EQ(ns(".25"), 250'000);
  EXPECT_EQ(ns("7."), 7'000'000);
}

TEST(ParseMs, RoundsWhatIsFiner) {
  EXPECT_EQ(ns("0.0000004"), 0);
  EXPECT_EQ(ns("0.0000005"), 1);
  EXPECT_EQ(ns("0.99999999"), 1'000'000);
  EXPECT_EQ(ns("0.12345649999999999999999999"), 123'456);
}

TEST(ParseMs, TakesAnExponent) {
  EXPECT_EQ(ns("1.5e3"), 1'500'000'000);
  EXPECT_EQ(ns("1E-3"), 1'000);
}

TEST(ParseMs, RefusesWhatIsNoNumber) {
  for (const char* text : {"", "-", ".", "-.", "+1", "1,5", "1.2.3", "0x10", "nan", "inf", "1 ",
                           "1e", "--1", "1e400", "12a"}) {
    EXPECT_EQ(ns(text), std::nullopt) << text;
  }
}

TEST(ParseMs, RefusesWhatIsTooLarge) {
  EXPECT_EQ(ns("4000000000000"), kLargest * 1'000'000);
  EXPECT_EQ(ns("4000000000000.000001"), std::nullopt);
  EXPECT_EQ(ns("4000000000001"), std::nullopt);
  EXPECT_EQ(ns("99999999999999999999999999"), std::nullopt);
  EXPECT_EQ(ns("-4000000000001"), std::nullopt);
  EXPECT_EQ(ns("4.1e12"), std::nullopt);
}

TEST(MsText, HasSixDecimals) {
  EXPECT_EQ(ms_text(Nanoseconds(0)), "0.000000");
  EXPECT_EQ(ms_text(Nanoseconds(12'345'678)), "12.345678");
  EXPECT_EQ(ms_text(Nanoseconds(-5)), "-0.000005");
  EXPECT_EQ(ms_text(Nanoseconds(-1'000'001)), "-1.000001");
}

TEST(MsText, ReadsBackAsTheSame) {
  constexpr unsigned kSeed = 7;
  std::mt19937_64 random(kSeed);
  for (int i = 0; i < 10'000; ++i) {
    const auto value = static_cast<std::int64_t>(random() >> 3) - (std::int64_t{1} << 60);
    EXPECT_EQ(ns(ms_text(Nanoseconds(value))), value) << "seed " << kSeed << ", draw " << i;
  }
}

}  // namespace
}  // namespace simbench
