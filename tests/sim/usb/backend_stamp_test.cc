#include "sim/usb/backend_stamp.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <optional>
#include <set>

#include "tests/sim/at_ms.h"

namespace simbench::sim {
namespace {

constexpr std::int64_t kHourNs = 3'600'000'000'000;

double stamp_ms(const BackendStamps& stamps, const SystemClock& clock, double copied_ms,
                double delivered_ms) {
  const HostTime stamp = stamps.stamp(clock, clock.steady(at_ms(1000)), at_ms(copied_ms),
                                      clock.read_both(at_ms(delivered_ms)));
  return to_ms(stamp.time_since_epoch());
}

TEST(BackendStamp, WithoutSettingsIsTheSystemClockInTheArrivalsSteps) {
  const SystemClock clock(0, OscillatorModel(0.0), from_ms(0.25));
  EXPECT_NEAR(stamp_ms({std::nullopt, Granularity(from_ms(0.1))}, clock, 2000.17, 2003), 2000.4,
              1e-9);
  EXPECT_NEAR(stamp_ms({std::nullopt, Granularity()}, clock, 2000.17, 2003), 2000.42, 1e-9);
}

TEST(BackendStamp, ExactClocksGiveTheExactStamp) {
  const SystemClock clock(0, OscillatorModel(0.0), from_ms(777.25));
  const BackendStamps stamps(scenarios::BackendStamp{.host_uptime_h = 0, .resolution_ms = 0}, {});
  EXPECT_NEAR(stamp_ms(stamps, clock, 2000.17, 2003.9), 2003.9 + 777.25, 1e-9);
}

// Whole milliseconds of two clocks that begin at different times: what both cut off comes back as
// one or none.
TEST(BackendStamp, InWholeMillisecondsIsUpToOneEarly) {
  const SystemClock clock(0, OscillatorModel(0.0), from_ms(100.3));
  const BackendStamps stamps(scenarios::BackendStamp{.host_uptime_h = 0, .resolution_ms = 1}, {});
  EXPECT_EQ(stamp_ms(stamps, clock, 2000, 2005.2), 2105);  // 2105.5
  EXPECT_EQ(stamp_ms(stamps, clock, 2000, 2005.8), 2106);  // 2106.1
  for (double delivered_ms = 2001; delivered_ms < 2003; delivered_ms += 0.01) {
    const double early_ms = delivered_ms + 100.3 - stamp_ms(stamps, clock, 2000, delivered_ms);
    EXPECT_GT(early_ms, -1e-9);
    EXPECT_LT(early_ms, 1);
  }
}

// 24 bits: of 3.6e10 ticks of 100 ns steps of 4096 ticks, then of 3.6e6 ms steps of 0.25 ms.
TEST(BackendStamp, FloatHasTheStepsOfItsSize) {
  const auto steps_ms = [](std::int64_t hours) {
    std::set<double> stamps_ms;
    for (int us = 0; us < 400'000; us += 50) {
      const Nanoseconds since_boot(hours * kHourNs + std::int64_t{us} * 1000);
      const double stamp_ms = to_ms(through_float_ms(since_boot));
      EXPECT_EQ(static_cast<double>(static_cast<float>(stamp_ms)), stamp_ms);
      stamps_ms.insert(stamp_ms);
    }
    return stamps_ms;
  };
  // 400 ms in steps of 0.4096 and of 6.5536 ms, which the second rounding merges in part.
  EXPECT_NEAR(static_cast<double>(steps_ms(1).size()), 400 / 0.4096, 2);
  EXPECT_LE(static_cast<double>(steps_ms(24).size()), 400 / 8.0 + 1);
  EXPECT_GE(static_cast<double>(steps_ms(24).size()), 400 / 8.0 - 1);
  for (const double stamp : steps_ms(24)) EXPECT_EQ(std::int64_t(stamp) % 8, 0);
  // Nearly exact soon after the start.
  EXPECT_NEAR(to_ms(through_float_ms(Nanoseconds(1'000'000'000))), 1000, 1e-4);
}

TEST(BackendStamp, OfAHostThatHasBeenOnForADayMovesInStepsOfEightMilliseconds) {
  const SystemClock clock(0, OscillatorModel(0.0), from_ms(0));
  const BackendStamps stamps(scenarios::BackendStamp{.host_uptime_h = 24, .resolution_ms = 1}, {});
  double sum_ms = 0;
  double worst_ms = 0;
  int frames = 0;
  for (double delivered_ms = 1000; delivered_ms < 11000; delivered_ms += 1000.0 / 45, ++frames) {
    const double error_ms = stamp_ms(stamps, clock, 0, delivered_ms) - delivered_ms;
    sum_ms += error_ms;
    worst_ms = std::max(worst_ms, std::abs(error_ms));
  }
  // Half of each step, and a millisecond that is cut off.
  EXPECT_LE(worst_ms, 8.0 / 2 + 6.5536 / 2 + 1);
  EXPECT_GT(worst_ms, 4);
  EXPECT_NEAR(sum_ms / frames, 0, 1);
}

// Uptime counts from the capture, not from the zero of the steady clock.
TEST(BackendStamp, DoesNotDependOnTheZeroOfTheSteadyClock) {
  const BackendStamps stamps(scenarios::BackendStamp{.host_uptime_h = 24, .resolution_ms = 1}, {});
  const SystemClock one(0, OscillatorModel(0.0), from_ms(5));
  const SystemClock other(0, OscillatorModel(0.0), from_ms(5), SteadyTime(from_seconds(12345)));
  for (double delivered_ms = 1000; delivered_ms < 2000; delivered_ms += 7) {
    EXPECT_EQ(stamp_ms(stamps, one, 0, delivered_ms), stamp_ms(stamps, other, 0, delivered_ms));
  }
}

}  // namespace
}  // namespace simbench::sim
