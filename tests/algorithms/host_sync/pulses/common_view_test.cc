#include "algorithms/host_sync/pulses/common_view.h"

#include <gtest/gtest.h>

#include <boost/random/mersenne_twister.hpp>
#include <cmath>
#include <memory>
#include <utility>

#include "algorithms/host_sync/pulses/gnss.h"
#include "tests/algorithms/host_sync/closed_loop.h"

namespace simbench {
namespace {

constexpr Nanoseconds kViewPeriod{22'222'222};
constexpr Nanoseconds kAsymmetry{80'000};

// Frames of one camera, all there from the beginning but shown when their time has come.
class ScriptFrames : public FrameFeed {
 public:
  explicit ScriptFrames(ScriptHost& host, std::uint32_t first_stamp_us = 0)
      : host_(host), first_stamp_us_(first_stamp_us) {}

  Nanoseconds delay{from_ms(12)};
  Nanoseconds pulse_offset{0};

  Task<std::optional<FrameArrival>> next(SteadyTime) override {
    const SteadyTime exposed = SteadyTime(from_ms(500) + pulse_offset + number_ * kViewPeriod);
    const std::uint32_t exposure_us = number_ % 2 == 0 ? 4000 : 1000;
    const SteadyTime arrival = exposed + Microseconds(exposure_us) + delay;
    if (arrival > host_.steady_clock().now()) co_return std::nullopt;
    const auto stamp_us = static_cast<std::uint32_t>(number_ * kViewPeriod.count() / 1000);
    ++number_;
    co_return FrameArrival{.camera = 3,
                           .counter = static_cast<std::uint32_t>(number_),
                           .exposure_us = exposure_us,
                           .sensor = {first_stamp_us_ + stamp_us},
                           .arrival = {},
                           .arrival_steady = arrival};
  }

 private:
  ScriptHost& host_;
  std::uint32_t first_stamp_us_;
  std::int64_t number_ = 0;
};

class ScriptPulses : public PulseInput {
 public:
  ScriptPulses(ScriptHost& host, bool tells_time) : host_(host), tells_time_(tells_time) {}

  Task<std::optional<PulseStamp>> next(SteadyTime deadline) override {
    const SteadyTime at(from_ms(500 + 1000.0 * static_cast<double>(number_)));
    if (at > deadline) {
      co_await host_.sleep_for(deadline - host_.steady_clock().now());
      co_return std::nullopt;
    }
    if (at > host_.steady_clock().now()) {
      co_await host_.sleep_for(at - host_.steady_clock().now());
    }
    PulseStamp stamp{.system = host_.reading() - (host_.steady_clock().now() - at), .steady = at};
    if (tells_time_) stamp.gnss = from_ms(7'000'000) + number_ * from_ms(1000);
    ++number_;
    co_return stamp;
  }

 private:
  ScriptHost& host_;
  bool tells_time_;
  std::int64_t number_ = 0;
};

// A ScriptHost with the ports that the test gives it, by forwarding everything else.
class PortHost : public Host {
 public:
  explicit PortHost(ScriptHost& host) : host_(host) {}

  std::unique_ptr<FrameFeed> feed;
  std::unique_ptr<PulseInput> pulses;

  PeerId id() const override { return host_.id(); }
  HostClock& clock() override { return host_.clock(); }
  const SteadyClock& steady_clock() const override { return host_.steady_clock(); }
  PulseInput* pulse_input(PulseLine line) override {
    return line == PulseLine::kPps ? pulses.get() : nullptr;
  }
  FrameFeed* frame_feed() override { return feed.get(); }
  MessageChannel& open_channel(PeerId peer, Transport transport) override {
    return host_.open_channel(peer, transport);
  }
  Task<void> sleep_for(Nanoseconds interval) override { return host_.sleep_for(interval); }
  Task<void> sleep_until(HostTime at) override { return host_.sleep_until(at); }
  double random_uniform() override { return host_.random_uniform(); }
  void report_exchange(const Exchange& exchange) override { host_.report_exchange(exchange); }
  void report_outcome(const SyncOutcome& outcome) override { host_.report_outcome(outcome); }

 private:
  ScriptHost& host_;
};

constexpr LoopLimits kPulseLimits{.error_us = 0.05};

// Two hosts over a link whose asymmetry the network cannot see.
class CommonViewTest : public testing::Test {
 protected:
  CommonViewTest() {
    world_.set_latency(1, 0, from_ms(0.2) + kAsymmetry);
    world_.set_latency(0, 1, from_ms(0.2));
    world_.host(0).offset = from_ms(-20);
    world_.host(1).offset = from_ms(300);
    world_.host(1).uniform = 0.5;
    // The scripted clock slews at once, which no real one does: always step.
    settings_.two_way.steering.step_threshold = Nanoseconds(0);
  }

  void run(HostSync& sync, Nanoseconds end = from_ms(30e3)) {
    world_.start(sync.run_slave(slave_, 0));
    world_.start(sync.run_master(master_, {1}));
    world_.run(end);
  }
  // The slave's cameras deliver later than the master's.
  void see_slower_cameras(Nanoseconds later) {
    auto feed = std::make_unique<ScriptFrames>(world_.host(1));
    feed->delay += later;
    slave_.feed = std::move(feed);
    master_.feed = std::make_unique<ScriptFrames>(world_.host(0));
    CommonView sync(settings_);
    run(sync);
  }
  double lead() { return lead_us(world_, 1); }

  ScriptWorld world_{2};
  PortHost master_{world_.host(0)};
  PortHost slave_{world_.host(1)};
  CommonViewSettings settings_;
};

TEST_F(CommonViewTest, FramesTakeTheAsymmetryOutAcrossTheWrapOfTheStamps) {
  master_.feed = std::make_unique<ScriptFrames>(world_.host(0), 4'294'000'000u);
  slave_.feed = std::make_unique<ScriptFrames>(world_.host(1), 4'290'000'000u);
  CommonView sync(settings_);
  EXPECT_EQ(sync.warm_up(), from_ms(60e3));
  run(sync);
  expect_locked(world_, kPulseLimits);
}

TEST_F(CommonViewTest, UnequalDelaysOfTheCamerasGoIntoTheOffset) {
  see_slower_cameras(from_ms(0.1));
  // What the slave sees later seems to be due to a clock that is ahead, and is taken back.
  EXPECT_NEAR(lead(), -100, 0.05);
}

TEST_F(CommonViewTest, ButNoFurtherThanTheNetworkAllows) {
  see_slower_cameras(from_ms(0.4));
  // A round trip of 480 us lets the hull, which is 40 us off, be no more than 240 us off.
  EXPECT_NEAR(lead(), 40 - 240, 0.05);
}

TEST_F(CommonViewTest, WithoutTheMastersFramesTheNetworkAloneCounts) {
  slave_.feed = std::make_unique<ScriptFrames>(world_.host(1));
  CommonView sync(settings_);
  run(sync);
  EXPECT_NEAR(lead(), to_ms(kAsymmetry) * 1e3 / 2, 0.05);
}

TEST_F(CommonViewTest, FramesOfTheFirstSecondsAreLeftOut) {
  master_.feed = std::make_unique<ScriptFrames>(world_.host(0));
  slave_.feed = std::make_unique<ScriptFrames>(world_.host(1));
  settings_.pulses.settle = from_ms(1e6);
  CommonView sync(settings_);
  run(sync);
  EXPECT_NEAR(lead(), to_ms(kAsymmetry) * 1e3 / 2, 0.05);
}

TEST_F(CommonViewTest, PpsDoesTheSameWithoutCameras) {
  master_.pulses = std::make_unique<ScriptPulses>(world_.host(0), false);
  slave_.pulses = std::make_unique<ScriptPulses>(world_.host(1), false);
  settings_.pulses.source = PulseSource::kPps;
  CommonView sync(settings_);
  run(sync);
  expect_aligned(world_, kPulseLimits);
}

TEST_F(CommonViewTest, AMissingPortIsAnOutcomeThatNamesIt) {
  for (const auto& [source, name] : {std::pair{PulseSource::kFrames, "frame_feed"},
                                     {PulseSource::kTrigger, "trigger line"},
                                     {PulseSource::kPps, "PPS line"}}) {
    settings_.pulses.source = source;
    CommonView sync(settings_);
    world_.host(1).outcomes.clear();
    world_.start(sync.run_slave(slave_, 0));
    world_.run(world_.now() + from_ms(100));
    expect_refused(world_, 1, name);
  }
}

TEST_F(CommonViewTest, GnssNeedsNoNetwork) {
  cut(world_, 0, 1);
  master_.pulses = std::make_unique<ScriptPulses>(world_.host(0), true);
  slave_.pulses = std::make_unique<ScriptPulses>(world_.host(1), true);
  GnssSettings settings;
  settings.steering.step_threshold = Nanoseconds(0);
  Gnss sync(settings);
  run(sync);
  expect_locked(world_, kPulseLimits);
  EXPECT_EQ(world_.host(1).reading() - world_.host(1).steady_clock().now().time_since_epoch(),
            HostTime(from_ms(7'000'000 - 500)));
  EXPECT_TRUE(world_.host(0).outcomes.empty());
}

TEST_F(CommonViewTest, GnssWithoutLineOrTimeIsAnOutcome) {
  Gnss sync({});
  run(sync);
  expect_refused(world_, 1, "no PPS line");
  world_.host(1).outcomes.clear();
  slave_.pulses = std::make_unique<ScriptPulses>(world_.host(1), false);
  world_.start(sync.run_slave(slave_, 0));
  world_.run(world_.now() + from_ms(5e3));
  expect_refused(world_, 1, "sends no time");
}

TEST(CommonViewCorrectionTest, IsTheMeanOfWhatCausalityAllows) {
  const auto correction = [](double offset_ns, double sigma_ns, double bound_ns) {
    return common_view_correction_ns({.offset_ns = offset_ns, .sigma_ns = sigma_ns}, bound_ns);
  };
  EXPECT_EQ(correction(3000, 0, 10'000), 3000);
  EXPECT_EQ(correction(30'000, 0, 10'000), 10'000);
  EXPECT_EQ(correction(3000, 100, 0), 0);
  EXPECT_EQ(correction(0, 100, 10'000), 0);
  // Certain against the bound: as measured.
  EXPECT_NEAR(correction(3000, 100, 10'000), 3000, 1e-6);
  // Uncertain against the bound: c b^2 / (3 s^2), that of a normal prior of the same variance.
  EXPECT_NEAR(correction(3000, 1e6, 10'000), 3000 * 1e8 / 3e12, 1e-3);
  // At the bound itself, half a normal remains: b - s sqrt(2 / pi).
  EXPECT_NEAR(correction(10'000, 100, 10'000), 10'000 - 100 * std::sqrt(2 / 3.14159265358979), 0.1);
  // Far beyond it, the tail is exponential: b - s^2 / (c - b); the two formulas meet.
  EXPECT_NEAR(correction(12'000, 100, 10'000), 10'000 - 5, 0.05);
  EXPECT_NEAR(correction(12'499, 100, 10'000), correction(12'501, 100, 10'000), 0.02);
  EXPECT_EQ(correction(-12'000, 100, 10'000), -correction(12'000, 100, 10'000));
}

TEST(CommonViewCorrectionTest, NeverLeavesTheRangeFromNothingToWhatWasMeasured) {
  boost::random::mt19937_64 engine(4);
  for (int run = 0; run < 100'000; ++run) {
    const auto magnitude = [&engine] {
      return std::pow(10, static_cast<double>(engine() % 1600) / 100 - 4);
    };
    const double offset_ns = magnitude();
    const double bound_ns = magnitude();
    const double correction =
        common_view_correction_ns({.offset_ns = offset_ns, .sigma_ns = magnitude()}, bound_ns);
    EXPECT_GE(correction, -bound_ns) << "seed 4, run " << run;
    EXPECT_LE(correction, std::min(offset_ns, bound_ns)) << "seed 4, run " << run;
  }
}

TEST(GnssEstimatorTest, FindsOffsetAndRateOfLatePulses) {
  boost::random::mt19937_64 engine(8);
  GnssEstimator estimator(from_ms(60e3));
  // The steady clock loses 20 ppm: GNSS time gains as much on it.
  for (int i = 0; i < 60; ++i) {
    const double late_us = 5 + (i % 3 == 0 ? 0 : static_cast<double>(engine() % 50));
    estimator.add(from_ms(1e7 + 1000.0 * i),
                  SteadyTime(from_ms(1000.0 * i * (1 - 20e-6) + late_us * 1e-3)));
  }
  const ClockLine line = *estimator.line();
  EXPECT_NEAR(line.rate_ppb, 20'000, 1);
  EXPECT_NEAR(to_ms(line.read(SteadyTime(from_ms(59e3))) - HostTime(from_ms(1e7 + 59e3))),
              59 * 20e-3 - 5e-3, 1e-4);
}

TEST(GnssEstimatorTest, AJumpOfTheReceiverStartsAfresh) {
  GnssEstimator estimator(from_ms(60e3));
  EXPECT_FALSE(estimator.line());
  for (int i = 0; i < 20; ++i) {
    const double jump = i < 10 ? 0 : 5000;
    estimator.add(from_ms(1000.0 * i + jump), SteadyTime(from_ms(1000.0 * i)));
  }
  EXPECT_EQ(estimator.line()->read(SteadyTime{}), HostTime(from_ms(5000)));
}

TEST(GnssEstimatorTest, PulsesThatNoClockSeesSoGiveNoLine) {
  GnssEstimator still(from_ms(60e3));
  for (int i = 0; i < 20; ++i) {
    still.add(from_ms(0.1 * i), SteadyTime{});
    EXPECT_FALSE(still.line());
  }
}

TEST(GnssEstimatorTest, RepeatedPulsesGiveNoLine) {
  GnssEstimator estimator(from_ms(60e3));
  for (int i = 0; i < 20; ++i) estimator.add(from_ms(1000), SteadyTime(from_ms(1000)));
  EXPECT_FALSE(estimator.line());
}

TEST(CommonViewMessageTest, WhatIsEncodedIsDecodedAndNothingElse) {
  const CommonViewMessage request{.is_answer = false, .index = 5};
  EXPECT_EQ(decode_common_view_message(encode(request)), request);
  CommonViewMessage answer{.is_answer = true, .index = 6};
  EXPECT_EQ(decode_common_view_message(encode(answer)), answer);
  answer.pulse = CommonViewMessage::Pulse{.at = HostTime(from_ms(-3)), .sigma_ns = 12};
  EXPECT_EQ(decode_common_view_message(encode(answer)), answer);
  boost::random::mt19937_64 engine(13);
  for (int run = 0; run < 20'000; ++run) {
    Bytes bytes = encode(answer);
    for (int change = 0; change < 1 + run % 5; ++change) {
      bytes[engine() % bytes.size()] = static_cast<std::byte>(engine());
    }
    const auto message = decode_common_view_message(bytes);
    if (!message) continue;
    EXPECT_EQ(encode(*message), bytes) << "seed 13, run " << run;
  }
}

}  // namespace
}  // namespace simbench
