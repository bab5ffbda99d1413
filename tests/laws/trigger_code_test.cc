#include "laws/trigger_code.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <set>
#include <string>
#include <vector>

namespace simbench {
namespace {

constexpr Nanoseconds kPeriod = from_ms(10);

TEST(TriggerCode, ADeBruijnSequenceHasEveryRunOnce) {
  for (int order = TriggerCode::kLowestOrder; order <= TriggerCode::kHighestOrder; ++order) {
    const std::vector<std::uint8_t> symbols = de_bruijn_sequence(order);
    const std::size_t length = std::size_t{1} << order;
    ASSERT_EQ(symbols.size(), length) << order;
    std::vector<char> seen(length, 0);
    std::size_t ones = 0;
    for (std::size_t begin = 0; begin < length; ++begin) {
      std::size_t run = 0;
      for (int i = 0; i < order; ++i) {
        run = 2 * run + symbols[(begin + static_cast<std::size_t>(i)) % length];
      }
      ASSERT_EQ(seen[run], 0) << "order " << order << ", run " << run;
      seen[run] = 1;
      ones += symbols[begin];
    }
    EXPECT_EQ(ones, length / 2) << order;
  }
}

Nanoseconds sum_of_shifts(const TriggerCode& code) {
  Nanoseconds sum{};
  for (std::int64_t pulse = 0; pulse < code.length(); ++pulse) sum += code.shift(pulse);
  return sum;
}

TEST(TriggerCode, PositionMovesEachPulseEitherWay) {
  const TriggerCode code = TriggerCode::position(kPeriod, 5, from_us(50));
  EXPECT_EQ(code.length(), 32);
  EXPECT_EQ(code.span(), from_ms(320));
  const std::vector<std::uint8_t> symbols = de_bruijn_sequence(5);
  for (std::int64_t pulse = 0; pulse < 32; ++pulse) {
    const bool is_late = symbols[static_cast<std::size_t>(pulse)] != 0;
    EXPECT_EQ(code.shift(pulse), from_us(is_late ? 50 : -50));
    EXPECT_TRUE(code.is_sent(pulse));
  }
  EXPECT_EQ(sum_of_shifts(code), Nanoseconds(0)) << "the mean rate is the even grid's";
  EXPECT_EQ(code.shortest_interval(), kPeriod - from_us(100));
  EXPECT_EQ(code.longest_interval(), kPeriod + from_us(100));
  EXPECT_EQ(code.range(), from_us(100));
  EXPECT_FALSE(code.leaves_out());
  EXPECT_EQ(code.sent_share(), 1);
}

TEST(TriggerCode, BeginsAnewAfterItsLengthAndBeforePulseZero) {
  const TriggerCode code = TriggerCode::position(kPeriod, 4, from_us(50));
  for (std::int64_t pulse = -40; pulse < 40; ++pulse) {
    EXPECT_EQ(code.shift(pulse), code.shift(pulse + 16)) << pulse;
    EXPECT_EQ(code.place(pulse), code.place(pulse + 160)) << pulse;
  }
}

TEST(TriggerCode, FrequencyHasTwoIntervalsAndReturnsToTheGrid) {
  const TriggerCode code = TriggerCode::frequency(kPeriod, 4, 4, from_us(100));
  EXPECT_EQ(code.length(), 64);
  const std::vector<std::uint8_t> symbols = de_bruijn_sequence(4);
  for (std::int64_t pulse = 0; pulse < 64; ++pulse) {
    const Nanoseconds interval = kPeriod + code.shift(pulse) - code.shift(pulse - 1);
    const bool is_one = symbols[static_cast<std::size_t>(pulse / 4)] != 0;
    const bool is_long = is_one == (pulse % 4 < 2);
    EXPECT_EQ(interval, kPeriod + from_us(is_long ? 100 : -100)) << pulse;
    if (pulse % 4 == 3) {
      EXPECT_EQ(code.shift(pulse), Nanoseconds(0)) << pulse;
    }
  }
  EXPECT_EQ(sum_of_shifts(code), Nanoseconds(0));
  EXPECT_EQ(code.range(), from_us(400));
}

TEST(TriggerCode, MissingLeavesOutTheLastPulseOfASymbol) {
  const TriggerCode code = TriggerCode::missing(kPeriod, 4, 3);
  EXPECT_EQ(code.length(), 48);
  const std::vector<std::uint8_t> symbols = de_bruijn_sequence(4);
  for (std::int64_t pulse = 0; pulse < 48; ++pulse) {
    const bool is_left_out = pulse % 3 == 2 && symbols[static_cast<std::size_t>(pulse / 3)] != 0;
    EXPECT_EQ(code.is_sent(pulse), !is_left_out) << pulse;
  }
  EXPECT_TRUE(code.leaves_out());
  EXPECT_EQ(code.sent_share(), 1 - 8.0 / 48);
  EXPECT_EQ(code.shortest_interval(), kPeriod);
  EXPECT_EQ(code.longest_interval(), 2 * kPeriod);
}

TEST(TriggerCode, WhatIsNoCodeIsAProgrammingError) {
  EXPECT_DEATH(TriggerCode::position(kPeriod, 3, from_us(50)), "orders of a code");
  EXPECT_DEATH(TriggerCode::position(kPeriod, 4, from_ms(3)), "leaves its pulses apart");
  EXPECT_DEATH(TriggerCode::missing(kPeriod, 4, 1), "half of all would be left out");
  EXPECT_DEATH(TriggerCode::frequency(kPeriod, 4, 3, from_us(50)), "two halves");
}

}  // namespace
}  // namespace simbench
