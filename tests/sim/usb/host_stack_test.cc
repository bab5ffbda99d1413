#include "sim/usb/host_stack.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/sim/rig/ideal_scenario.h"

namespace simbench::sim {
namespace {

scenarios::Usb quiet() { return ideal_scenario().usb; }

TEST(FrameDelays, AreNoneWithoutJitter) {
  FrameDelays delays(quiet(), 1, 0);
  for (int i = 0; i < 10; ++i) {
    const auto draw = delays.draw(2e6);
    EXPECT_EQ(draw.kernel_copy_ns, 0);
    EXPECT_EQ(draw.delivery_ns, 0);
  }
}

TEST(FrameDelays, HaveTheirMeans) {
  scenarios::Usb usb = quiet();
  usb.kernel_copy_exponential_ms = 0.1;
  usb.delivery_jitter_transfers = 0.3;
  usb.spike_probability = 0.05;
  usb.spike_max_transfers = 4;
  FrameDelays delays(usb, 5, 0);
  const int n = 100000;
  double copy = 0;
  double delivery = 0;
  for (int i = 0; i < n; ++i) {
    const auto draw = delays.draw(2e6);
    copy += draw.kernel_copy_ns / n;
    delivery += draw.delivery_ns / n;
  }
  EXPECT_NEAR(copy, 1e5, 5 * 1e5 / std::sqrt(n)) << "seed 5";
  // 0.3 transfers and, in 5 % of the frames, 2 more on average; the variance of one draw is
  // 0.3^2 + 0.05 * 16 / 3 - 0.1^2 = 0.347 transfers^2.
  EXPECT_NEAR(delivery, 0.4 * 2e6, 5 * std::sqrt(0.347 / n) * 2e6) << "seed 5";
}

TEST(HostJitter, HasTheMeanAndCorrelationOfItsProcess) {
  scenarios::Usb usb = quiet();
  usb.host_jitter_transfers = 2;
  usb.host_jitter_correlation = 0.8;
  HostJitter jitter(usb, 9, 0, TrueTime{}, 1e6);
  const int n = 200000;
  double sum = 0;
  double squares = 0;
  double products = 0;
  double previous = 0;
  for (int i = 0; i < n; ++i) {
    const double value = jitter.at(TrueTime(Nanoseconds(1'000'000LL * (i + 100))));
    sum += value;
    squares += value * value;
    products += value * previous;
    previous = value;
  }
  const double mean = sum / n;
  const double variance = squares / n - mean * mean;
  EXPECT_NEAR(mean, 2, 0.05) << "seed 9";
  // Var = (1 - rho)^2 mean^2 / (1 - rho^2) = mean^2 (1 - rho) / (1 + rho) = 4 / 9.
  EXPECT_NEAR(variance, 4.0 / 9, 0.02) << "seed 9";
  EXPECT_NEAR((products / n - mean * mean) / variance, 0.8, 0.02) << "seed 9";
}

TEST(HostJitter, DoesNotDependOnWhoAsks) {
  scenarios::Usb usb = quiet();
  usb.host_jitter_transfers = 1;
  HostJitter every(usb, 2, 3, TrueTime{}, 1e6);
  HostJitter some(usb, 2, 3, TrueTime{}, 1e6);
  for (int i = 0; i < 100; ++i) {
    const double value = every.at(TrueTime(Nanoseconds(1'000'000LL * i)));
    if (i % 7 == 0) {
      EXPECT_EQ(some.at(TrueTime(Nanoseconds(1'000'000LL * i + 400))), value);
    }
  }
}

}  // namespace
}  // namespace simbench::sim
