#include <gtest/gtest.h>

#include <boost/random/exponential_distribution.hpp>
#include <boost/random/mersenne_twister.hpp>
#include <cstdint>

#include "algorithms/device_time/poll_estimators.h"
#include "algorithms/device_time/variants.h"
#include "tests/algorithms/device_time/polls.h"

namespace simbench {
namespace {

constexpr std::uint32_t kDelaySeed = 77;

// `base_ms` and Exp(mean_ms) each way.
std::function<PollDelay()> jitter(double request_ms, double reply_ms, double mean_ms) {
  return [=, random = boost::random::mt19937(kDelaySeed)]() mutable {
    boost::random::exponential_distribution<double> excess_ms(1 / mean_ms);
    const double request = request_ms + excess_ms(random);
    return PollDelay{request, reply_ms + excess_ms(random)};
  };
}

TEST(TwoWayPoll, SymmetricDelayHasNoError) {
  for (const double fast_ppm : {0.0, 20.0, -300.0}) {
    const auto estimator = make_two_way_poll({});
    const auto errors = poll_errors_ms(
        *estimator,
        [] {
          return PollDelay{1, 1};
        },
        fast_ppm, 5, 60);
    EXPECT_NEAR(statistics(errors).least, 0, 2e-3) << fast_ppm;
    EXPECT_NEAR(statistics(errors).largest, 0, 2e-3) << fast_ppm;
  }
}

TEST(TwoWayPoll, ConstantAsymmetryLeavesHalf) {
  const auto estimator = make_two_way_poll({});
  const auto errors = poll_errors_ms(
      *estimator,
      [] {
        return PollDelay{0.3, 1.7};
      },
      0, 0.1, 60);
  EXPECT_NEAR(statistics(errors).least, 0.7, 2e-3);
  EXPECT_NEAR(statistics(errors).largest, 0.7, 2e-3);
}

TEST(TwoWayPoll, FindsTheLineBetweenTheHulls) {
  // 300 polls of the window, 0.3 ms each way: b / n is 1 us.
  const auto estimator = make_two_way_poll({});
  const ErrorStatistics errors =
      statistics(poll_errors_ms(*estimator, jitter(0.2, 0.2, 0.3), 50, 30, 600));
  EXPECT_NEAR(errors.mean, 0, 3e-3) << "seed " << kDelaySeed;
  EXPECT_LT(errors.deviation, 6e-3) << "seed " << kDelaySeed;
}

TEST(TwoWayPoll, ALatePollChangesNothing) {
  const auto late_sometimes = [i = 0]() mutable {
    ++i;
    return PollDelay{i % 5 == 1 ? 20.2 : 0.2, i % 7 == 1 ? 30.2 : 0.2};
  };
  const auto estimator = make_two_way_poll({});
  const auto errors = poll_errors_ms(*estimator, late_sometimes, 20, 5, 60);
  EXPECT_NEAR(statistics(errors).least, 0, 2e-3);
  EXPECT_NEAR(statistics(errors).largest, 0, 2e-3);
}

TEST(TwoWayPoll, ArrivalsDoNotMatter) {
  const auto estimator = make_two_way_poll({});
  estimator->on_poll(poll_at(0, 300'000, 300'000));
  const auto stamp = [&](std::int64_t latency_ns) {
    return nanoseconds_of(
        estimator->stamp(sample_at(kDeviceZeroUs + 20'000, kHostZeroNs + 20'000'000 + latency_ns)));
  };
  EXPECT_EQ(stamp(0), kHostZeroNs + 20'000'000);
  EXPECT_EQ(stamp(500'000'000), kHostZeroNs + 20'000'000);
}

TEST(TwoWayPoll, TheWindowForgets) {
  // The host steps by 5 ms after a minute: forgotten 10 s later.
  const auto estimator = make_two_way_poll({.window_s = 10});
  for (std::int64_t i = 0; i < 1200; ++i) {
    const std::int64_t t_ns = i * 100'000'000;
    PollSample poll = poll_at(t_ns, 300'000, 300'000);
    const std::int64_t step_ns = i >= 600 ? 5'000'000 : 0;
    poll.t0 += Nanoseconds(step_ns);
    poll.t1 += Nanoseconds(step_ns);
    estimator->on_poll(poll);
    const GlobalTime stamp =
        estimator->stamp(sample_at(device_us_at(t_ns, 0), kHostZeroNs + t_ns + step_ns));
    if (i < 600 || i >= 701) {
      ASSERT_NEAR(error_ns(stamp, kHostZeroNs + t_ns + step_ns), 0, 1) << i;
    }
  }
}

TEST(TwoWayPoll, WithoutPollsOfItsClocksTheArrival) {
  const auto estimator = make_two_way_poll({});
  EXPECT_EQ(nanoseconds_of(estimator->stamp(sample_at(5, 1234))), 1234);
  PollSample slow = poll_at(0, 300'000, 300'000);
  slow.t1 += from_ms(1000);
  estimator->on_poll(slow);
  PollSample backwards = poll_at(0, 300'000, 300'000);
  std::swap(backwards.t0, backwards.t1);
  estimator->on_poll(backwards);
  EXPECT_EQ(nanoseconds_of(estimator->stamp(sample_at(kDeviceZeroUs, 99))), 99) << "left out";
  estimator->on_poll(poll_at(0, 300'000, 300'000));
  EXPECT_EQ(nanoseconds_of(estimator->stamp(sample_at(kDeviceZeroUs + 10, kHostZeroNs))),
            kHostZeroNs + 10'000);
  EXPECT_EQ(nanoseconds_of(estimator->stamp(sample_at(7, kHostZeroNs + 55))), kHostZeroNs + 55)
      << "the camera was restarted";
}

TEST(TwoWayPoll, ARestartedCameraIsFollowedFromItsNextPoll) {
  const auto estimator = make_two_way_poll({});
  for (std::int64_t i = 0; i < 100; ++i) estimator->on_poll(poll_at(i * 100'000'000, 1000, 1000));
  PollSample poll = poll_at(10'000'000'000, 1000, 1000);
  poll.device = DeviceTime(Microseconds(500));
  estimator->on_poll(poll);
  const GlobalTime stamp = estimator->stamp(sample_at(1500, kHostZeroNs + 10'005'000'000));
  EXPECT_EQ(nanoseconds_of(stamp), kHostZeroNs + 10'001'001'000);
}

TEST(TwoWayPoll, OnTheSteadyClockAStepDoesNotEnter) {
  const auto estimator = on_steady_clock(make_two_way_poll({}));
  for (std::int64_t i = 0; i < 300; ++i) {
    const std::int64_t t_ns = i * 100'000'000;
    const std::int64_t step_ns = i >= 150 ? 5'000'000 : 0;
    if (i == 0 || i == 150) {
      estimator->on_adjustment({.host = 0,
                                .at = SteadyTime(Nanoseconds(t_ns)),
                                .before = HostTime(Nanoseconds(kHostZeroNs + t_ns)),
                                .after = HostTime(Nanoseconds(kHostZeroNs + t_ns + step_ns)),
                                .rate_ppb = 0});
    }
    estimator->on_poll(poll_at(t_ns, 300'000, 300'000));
    DeviceSample frame = sample_at(device_us_at(t_ns + 50'000'000, 0), kHostZeroNs);
    frame.arrival_steady = SteadyTime(Nanoseconds(t_ns + 60'000'000));
    EXPECT_NEAR(error_ns(estimator->stamp(frame), kHostZeroNs + t_ns + 50'000'000 + step_ns), 0, 1)
        << i;
  }
}

}  // namespace
}  // namespace simbench
