#include "algorithms/coded_trigger/code_correlator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

namespace simbench {
namespace {

const TriggerCode& code() {
  static const TriggerCode made = TriggerCode::position(from_ms(10), 8, from_us(50));
  return made;
}

double shift_us(std::int64_t pulse) { return to_ns(code().shift(pulse)) * 1e-3; }

// Points of `count` pulses from `first` on, on a clock with a level and a rate.
void add_pulses(CodeCorrelator& correlator, std::int64_t first, std::int64_t count,
                double level_us = 0, double rate_us = 0) {
  for (std::int64_t slot = 0; slot < count; ++slot) {
    correlator.add(slot, level_us + rate_us * static_cast<double>(slot) + shift_us(first + slot));
  }
}

TEST(CodeCorrelator, FindsThePlaceTheLevelAndTheRate) {
  for (const std::int64_t first : {0, 17, 250}) {
    CodeCorrelator correlator(code(), {.noise_us = 5});
    add_pulses(correlator, first, 40, 300, 0.25);
    const CodeVerdict verdict = correlator.judge();
    EXPECT_EQ(verdict.place, static_cast<std::size_t>(first));
    EXPECT_LT(verdict.error_probability, 1e-20);
    EXPECT_EQ(verdict.noise_us, 5) << "not less than stated";
    // The prior, N(0, 1 us), moves the rate by 25 / (sum of (t - mean)^2 = 5330) of it.
    EXPECT_NEAR(verdict.rate_us, 0.25, 0.002);
    EXPECT_NEAR(verdict.level_us + 19.5 * verdict.rate_us, 300 + 19.5 * 0.25, 1e-6);
  }
}

TEST(CodeCorrelator, TheProbabilityIsThatOfBayes) {
  // Three points of no use: alike for every place whose shifts are alike there.
  CodeCorrelator correlator(code(), {.noise_us = 1000});
  add_pulses(correlator, 3, 3);
  // Noise far above the shifts: all 256 places stay nearly equally probable.
  EXPECT_NEAR(correlator.judge().error_probability, 255.0 / 256, 0.001);
}

TEST(CodeCorrelator, MoreNoiseThanStatedIsMeasured) {
  CodeCorrelator correlator(code(), {.noise_us = 2});
  for (std::int64_t slot = 0; slot < 60; ++slot) {
    const double noise_us = slot % 2 == 0 ? 10 : -10;
    correlator.add(slot, noise_us + shift_us(slot));
  }
  const CodeVerdict verdict = correlator.judge();
  EXPECT_EQ(verdict.place, 0U);
  EXPECT_NEAR(verdict.noise_us, 10, 0.3);
}

TEST(CodeCorrelator, ClearForgetsAll) {
  CodeCorrelator correlator(code(), {.noise_us = 5});
  add_pulses(correlator, 100, 30);
  correlator.clear();
  EXPECT_EQ(correlator.points(), 0U);
  add_pulses(correlator, 5, 30);
  EXPECT_EQ(correlator.judge().place, 5U);
}

TEST(CodeCorrelator, LeftOutPulsesNameAPlaceToo) {
  const TriggerCode missing = TriggerCode::missing(from_ms(10), 6, 4);
  CodeCorrelator correlator(missing, {.noise_us = 5, .lost_share = 0.02});
  const std::int64_t first = 100;  // the first of a symbol
  for (std::int64_t slot = 0; slot < 80; ++slot) {
    if (missing.is_sent(first + slot)) {
      correlator.add(slot, 0);
    } else {
      correlator.add_absent(slot);
    }
  }
  const CodeVerdict verdict = correlator.judge();
  EXPECT_EQ(verdict.place, static_cast<std::size_t>(first));
  EXPECT_LT(verdict.error_probability, 1e-9);
  // One more frame where the code has no pulse costs kImpossible there, and a loss where it has one
  // -ln(0.02).
  CodeCorrelator with_loss(missing, {.noise_us = 5, .lost_share = 0.02});
  for (std::int64_t slot = 0; slot < 3; ++slot) with_loss.add(slot, 0);
  const CodeVerdict of_three = with_loss.judge();
  with_loss.add_absent(3);
  const auto nats = [&](std::size_t place) {
    return with_loss.nats_behind({.place = of_three.place}, place, 5);
  };
  std::size_t sent = 0;
  std::size_t left_out = 0;
  for (std::size_t place = 0; place < with_loss.places(); place += 4) {
    (missing.is_sent(static_cast<std::int64_t>(place) + 3) ? sent : left_out) = place;
  }
  EXPECT_NEAR(nats(sent) - nats(left_out), -std::log(0.02), 1e-9);
}

}  // namespace
}  // namespace simbench
