#include "algorithms/coded_trigger/code_forecast.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/algorithms/coded_trigger/coded_frames.h"

namespace simbench {
namespace {

TEST(CodeForecast, EveryPlaceOfAUsualCodeIsFoundSoon) {
  const CodeForecast forecast = forecast_of(usual_pulses(), {});
  EXPECT_EQ(forecast.places, 256);
  EXPECT_EQ(forecast.found, 256);
  EXPECT_EQ(forecast.wrong, 0);
  EXPECT_GE(forecast.frames_median, 12) << "twelve symbols name a place";
  EXPECT_LE(forecast.frames_worst, 30);
  EXPECT_LE(forecast.error_probability, 1e-9);
  EXPECT_LE(forecast.union_bound, 1e-9);
}

TEST(CodeForecast, ShiftsWithinTheNoiseNameNothing) {
  const CodeForecast forecast = forecast_of(
      pulses_of(TriggerCode::position(from_ms(11), 10, from_us(2))), {.noise = {.noise_us = 5}});
  EXPECT_EQ(forecast.found, 0);
}

TEST(CodeForecast, LeftOutPulsesTakeLongerAndHaveNoUnionBound) {
  const CodeForecast forecast = forecast_of(pulses_of(TriggerCode::missing(from_ms(22), 8, 4)), {});
  EXPECT_EQ(forecast.found, forecast.places);
  EXPECT_EQ(forecast.wrong, 0);
  EXPECT_GT(forecast.pulses_worst, forecast.frames_worst);
  EXPECT_TRUE(std::isnan(forecast.union_bound));
}

}  // namespace
}  // namespace simbench
