#include "algorithms/host_sync/pulses/pulse_observer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <deque>

#include "tests/algorithms/host_sync/script_host.h"

namespace simbench {
namespace {

constexpr Nanoseconds kPeriod{22'222'222};
constexpr Nanoseconds kDelay{12'000'000};

// A ScriptHost with a feed that the test fills.
class FeedHost : public ScriptHost, private FrameFeed {
 public:
  explicit FeedHost(ScriptWorld& world) : ScriptHost(world, 0) {}
  std::deque<FrameArrival> frames;
  FrameFeed* frame_feed() override { return this; }

 private:
  Task<std::optional<FrameArrival>> next(SteadyTime) override {
    if (frames.empty()) co_return std::nullopt;
    const FrameArrival frame = frames.front();
    frames.pop_front();
    co_return frame;
  }
};

SteadyTime pulse_at(int number) { return SteadyTime(from_ms(1000) + number * kPeriod); }

FrameArrival arrival_of(std::uint32_t camera, int pulse, Nanoseconds early = {}) {
  return {.camera = camera,
          .counter = 0,
          .exposure_us = 2000,
          .sensor = {static_cast<std::uint32_t>(pulse * kPeriod.count() / 1000)},
          .arrival = {},
          .arrival_steady = pulse_at(pulse) + Microseconds(2000) + kDelay - early};
}

class PulseObserverTest : public testing::Test {
 protected:
  // How far the middle pulse is from where the least delay of a full bus puts it.
  double error_us(PulseObserver::Settings settings = {}) {
    PulseObserver observer(host_, settings);
    world_.start(observer.collect());
    world_.run();
    const std::optional<Sighting> middle = observer.middle();
    if (!middle) return NAN;
    const double periods = to_ms(middle->at - kDelay - pulse_at(0)) / to_ms(kPeriod);
    return (periods - std::round(periods)) * to_ms(kPeriod) * 1e3;
  }

  ScriptWorld world_{1};
  FeedHost host_{world_};
};

TEST_F(PulseObserverTest, AHostWithoutThePortCannotObserve) {
  EXPECT_FALSE(PulseObserver(world_.host(0), {}).is_possible());
  EXPECT_FALSE(PulseObserver(world_.host(0), {.source = PulseSource::kPps}).is_possible());
  EXPECT_TRUE(PulseObserver(host_, {}).is_possible());
}

TEST_F(PulseObserverTest, CamerasAreAveraged) {
  for (int pulse = 0; pulse < 500; ++pulse) {
    host_.frames.push_back(arrival_of(1, pulse));
    host_.frames.push_back(arrival_of(2, pulse, -from_ms(0.2)));
  }
  EXPECT_NEAR(error_us(), 100, 0.1);
}

TEST_F(PulseObserverTest, UnequalDelaysOfTheCamerasAreInTheUncertainty) {
  for (int pulse = 0; pulse < 500; ++pulse) {
    host_.frames.push_back(arrival_of(1, pulse));
    host_.frames.push_back(arrival_of(2, pulse, -from_ms(0.2)));
  }
  PulseObserver observer(host_, {});
  world_.start(observer.collect());
  world_.run();
  // Two values 200 us apart: their mean has a standard error of 100 us.
  EXPECT_NEAR(observer.middle()->sigma_ns, 100e3, 50);
}

TEST_F(PulseObserverTest, FramesThatDidNotShareTheBusAreLeftOut) {
  for (int pulse = 0; pulse < 500; ++pulse) {
    // Without the other camera's frame a frame is a millisecond faster.
    const bool has_one = pulse % 7 != 3;
    const bool has_two = pulse % 5 != 1;
    if (has_one)
      host_.frames.push_back(arrival_of(1, pulse, has_two ? Nanoseconds(0) : from_ms(1)));
    if (has_two)
      host_.frames.push_back(arrival_of(2, pulse, has_one ? Nanoseconds(0) : from_ms(1)));
  }
  EXPECT_NEAR(error_us(), 0, 0.1);
}

TEST_F(PulseObserverTest, FramesOfTheFirstSecondsAreLeftOut) {
  for (int pulse = 0; pulse < 500; ++pulse) {
    const Nanoseconds early =
        pulse_at(pulse) - pulse_at(0) < from_ms(4e3) ? from_ms(1) : from_ms(0);
    host_.frames.push_back(arrival_of(1, pulse, early));
  }
  EXPECT_NEAR(error_us(), 0, 0.1);
  EXPECT_TRUE(host_.frames.empty());
}

TEST_F(PulseObserverTest, FewFramesGiveNoPulse) {
  for (int pulse = 0; pulse < 10; ++pulse) host_.frames.push_back(arrival_of(1, pulse));
  EXPECT_TRUE(std::isnan(error_us({.settle = Nanoseconds(0)})));
}

TEST_F(PulseObserverTest, IdenticalStampsGiveNoPulse) {
  for (int i = 0; i < 500; ++i) host_.frames.push_back(arrival_of(1, 0));
  EXPECT_TRUE(std::isnan(error_us({.settle = Nanoseconds(0)})));
}

}  // namespace
}  // namespace simbench
