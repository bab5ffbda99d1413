// librealsense's global time against the figures of its own class bodies in a harness
// (docs/reference/d455.md section 5), and by hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <boost/random/exponential_distribution.hpp>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/uniform_real_distribution.hpp>
#include <cmath>
#include <cstdint>
#include <vector>

#include "algorithms/device_time/poll_estimators.h"
#include "algorithms/device_time/unwrap.h"
#include "tests/algorithms/device_time/polls.h"

namespace simbench {
namespace {

constexpr std::uint32_t kPollSeed = 15360;
constexpr double kRoundingMs = 2e-3;  // device stamps are whole microseconds

ErrorStatistics poll_statistics(const std::function<PollDelay()>& delay_ms, double fast_ppm,
                                double from_s, double to_s) {
  const auto estimator = make_librealsense_global();
  return statistics(poll_errors_ms(*estimator, delay_ms, fast_ppm, from_s, to_s));
}

// 0.2 ms + Exp(0.3 ms) each way, and tails of U(0, 30) ms with a probability.
struct Jitter {
  double request_tail = 0;
  double reply_tail = 0;
  boost::random::mt19937 random{kPollSeed};

  PollDelay operator()() {
    boost::random::exponential_distribution<double> excess_ms(1 / 0.3);
    boost::random::uniform_real_distribution<double> unit(0, 1);
    PollDelay delay = {0.2 + excess_ms(random), 0.2 + excess_ms(random)};
    if (unit(random) < request_tail) delay.request_ms += 30 * unit(random);
    if (unit(random) < reply_tail) delay.reply_ms += 30 * unit(random);
    return delay;
  }
};

TEST(LibrealsenseGlobal, SymmetricDelayHasNoError) {
  const ErrorStatistics errors = poll_statistics([] { return PollDelay{1, 1}; }, 20, 20, 120);
  EXPECT_NEAR(errors.least, 0, kRoundingMs);
  EXPECT_NEAR(errors.largest, 0, kRoundingMs);
}

TEST(LibrealsenseGlobal, ConstantAsymmetryLeavesHalf) {
  const ErrorStatistics errors = poll_statistics([] { return PollDelay{0.3, 1.7}; }, 0, 0.1, 60);
  EXPECT_NEAR(errors.least, 0.7, kRoundingMs);
  EXPECT_NEAR(errors.largest, 0.7, kRoundingMs);
}

// The reference's figures are of one run each: they must lie within what 40 runs give.
void expect_among_runs(const ErrorStatistics& figures, Jitter jitter) {
  std::vector<ErrorStatistics> runs;
  for (std::uint32_t seed = 1; seed <= 40; ++seed) {
    jitter.random.seed(seed);
    runs.push_back(poll_statistics(jitter, 20, 20, 300));
  }
  for (const auto figure : {&ErrorStatistics::mean, &ErrorStatistics::deviation,
                            &ErrorStatistics::least, &ErrorStatistics::largest}) {
    const auto [low, high] = std::minmax_element(
        runs.begin(), runs.end(), [figure](const ErrorStatistics& a, const ErrorStatistics& b) {
          return a.*figure < b.*figure;
        });
    EXPECT_GE(figures.*figure, (*low).*figure);
    EXPECT_LE(figures.*figure, (*high).*figure);
  }
}

TEST(LibrealsenseGlobal, ExponentialDelays) {
  expect_among_runs({0.304, 0.140, -0.108, 0.828}, Jitter{});
  // y is late by reply - d_min, in the mean 0.5 ms less the least half round trip.
  const ErrorStatistics errors = poll_statistics(Jitter{}, 20, 20, 1200);
  EXPECT_NEAR(errors.mean, 0.27, 0.04) << "seed " << kPollSeed;
  EXPECT_NEAR(errors.deviation, 0.14, 0.03) << "seed " << kPollSeed;
}

TEST(LibrealsenseGlobal, TailsOfRequestsDoNotMatter) {
  Jitter jitter;
  jitter.request_tail = 0.05;
  expect_among_runs({0.277, 0.149, -0.061, 1.027}, jitter);
  const ErrorStatistics errors = poll_statistics(jitter, 20, 20, 1200);
  EXPECT_NEAR(errors.mean, 0.27, 0.04) << "seed " << kPollSeed;
  EXPECT_NEAR(errors.deviation, 0.14, 0.03) << "seed " << kPollSeed;
}

TEST(LibrealsenseGlobal, TailsOfRepliesDo) {
  Jitter jitter;
  jitter.reply_tail = 0.05;
  expect_among_runs({0.575, 1.009, -2.123, 6.257}, jitter);
  // A tail enters the fit as it is: 5 % of 15 ms more in the mean.
  const ErrorStatistics errors = poll_statistics(jitter, 20, 20, 3600);
  EXPECT_NEAR(errors.mean, 0.27 + 0.75, 0.25) << "seed " << kPollSeed;
}

TEST(LibrealsenseGlobal, ALateFirstPollTiltsTheLineUntilItLeavesTheWindow) {
  // The first poll takes 20 ms longer, half of it each way. The shift of its y, when d_min falls,
  // puts it 10 ms below the others.
  const auto late_first = [first = true]() mutable {
    const double late_ms = first ? 10 : 0;
    first = false;
    return PollDelay{0.2 + late_ms, 0.2 + late_ms};
  };
  const ErrorStatistics first_20s = poll_statistics(late_first, 20, 0, 20);
  EXPECT_NEAR(first_20s.largest, 9.89, 0.15);
  EXPECT_NEAR(first_20s.mean, 1.10, 0.25);
  EXPECT_NEAR(first_20s.deviation, 2.53, 0.25);
  EXPECT_NEAR(first_20s.least, 0, kRoundingMs);
  const ErrorStatistics then = poll_statistics(late_first, 20, 20, 120);
  EXPECT_NEAR(then.least, 0, kRoundingMs);
  EXPECT_NEAR(then.largest, 0, kRoundingMs);
}

TEST(LibrealsenseGlobal, FollowsTheSkewBetweenPolls) {
  // 100 ppm with clean polls: nothing is lost between two that lie a second apart.
  const ErrorStatistics errors = poll_statistics([] { return PollDelay{0.2, 0.2}; }, 100, 5, 60);
  EXPECT_NEAR(errors.least, 0, kRoundingMs);
  EXPECT_NEAR(errors.largest, 0, kRoundingMs);
}

TEST(LibrealsenseGlobal, PollsWhatIsDue) {
  // Fast until 15 samples are there, then every second: of those given every 40 ms, each third,
  // then one in 24. A wrong poll that is not due leaves no trace.
  const auto estimator = make_librealsense_global();
  for (std::int64_t i = 0; i < 400; ++i) {
    const std::int64_t t0_ns = i * 40'000'000;
    const bool due = i <= 42 ? i % 3 == 0 : (i - 42) % 24 == 0;
    estimator->on_poll(due ? poll_at(t0_ns, 200'000, 200'000) : poll_at(t0_ns, 50'000, 9'000'000));
  }
  const std::int64_t t_ns = 16'000'000'000;
  EXPECT_NEAR(error_ns(estimator->stamp(sample_at(device_us_at(t_ns, 0), kHostZeroNs + t_ns)),
                       kHostZeroNs + t_ns),
              0, 1);
}

TEST(LibrealsenseGlobal, BlendsOverASecond) {
  // Two polls: the second is 1 ms late in its reply, so the line turns from level to the slope
  // through both; half of the turn is done half a second after the last frame before it.
  const auto estimator = make_librealsense_global();
  const auto offset_ns = [&](std::int64_t t_ns) {
    return error_ns(estimator->stamp(sample_at(device_us_at(t_ns, 0), kHostZeroNs + t_ns)),
                    kHostZeroNs + t_ns);
  };
  estimator->on_poll(poll_at(0, 200'000, 200'000));
  EXPECT_EQ(offset_ns(500'000'000), 0);
  estimator->on_poll(poll_at(1'000'000'000, 200'000, 1'200'000));
  // The line: 0 at 0.2 ms, 1 ms at 1000.2 ms.
  EXPECT_NEAR(offset_ns(500'000'000), 0, 1);
  EXPECT_NEAR(offset_ns(1'000'000'000), 0.5 * 999'800, 1);
  EXPECT_NEAR(offset_ns(1'500'000'000), 1'499'800, 1);
}

TEST(LibrealsenseGlobal, AWrapOfTheRegisterMakesNoBackwardStep) {
  // Two streams of one camera, 30 and 60 ms late, across the register's wrap.
  const auto estimator = make_librealsense_global();
  Jitter jitter;
  DeviceStampUnwrapper unwrapper;
  const std::int64_t shift_us = (std::int64_t{1} << 32) - kDeviceZeroUs - 60'000'000;
  const auto read = [&](std::int64_t t_ns) {
    return unwrapper.unwrap({static_cast<std::uint32_t>(device_us_at(t_ns, 20) + shift_us)});
  };
  std::vector<std::int64_t> newest(2);
  for (std::int64_t i = 0; i < 63 * 30; ++i) {
    const std::int64_t now_ns = i * 1'000'000'000 / 30;
    if (i % 3 == 0) {
      const PollDelay delay = jitter();
      const std::int64_t request_ns = std::llround(1e6 * delay.request_ms);
      PollSample poll = poll_at(now_ns, request_ns, std::llround(1e6 * delay.reply_ms), 20);
      poll.device = read(now_ns + request_ns);
      estimator->on_poll(poll);
    }
    for (const std::size_t stream : {std::size_t{0}, std::size_t{1}}) {
      const std::int64_t exposed_ns = now_ns - (stream == 0 ? 30'000'000 : 60'000'000);
      DeviceSample frame = sample_at(0, kHostZeroNs + now_ns);
      frame.sensor = read(exposed_ns);
      const std::int64_t stamp = nanoseconds_of(estimator->stamp(frame));
      EXPECT_GT(stamp, newest[stream]) << i << ", seed " << kPollSeed;
      newest[stream] = stamp;
      if (i > 30) {
        EXPECT_NEAR(1e-6 * static_cast<double>(stamp - kHostZeroNs - exposed_ns), 0.3, 1) << i;
      }
    }
  }
}

TEST(LibrealsenseGlobal, WithoutPollsTheArrival) {
  const auto estimator = make_librealsense_global();
  EXPECT_EQ(nanoseconds_of(estimator->stamp(sample_at(5, 1234))), 1234);
  PollSample backwards = poll_at(0, 200'000, 200'000);
  std::swap(backwards.t0, backwards.t1);
  estimator->on_poll(backwards);
  EXPECT_EQ(nanoseconds_of(estimator->stamp(sample_at(kDeviceZeroUs, 99))), 99);
}

}  // namespace
}  // namespace simbench
