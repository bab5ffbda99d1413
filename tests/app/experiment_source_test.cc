#include "app/experiment_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "algorithms/ports/capture_alignment.h"
#include "scenarios/loader.h"

namespace simbench::app {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

// The world of these tests. Host 0: steady clock as the monotonic one, system clock 1 s ahead of
// it. Host 1: oscillator 20 ppm fast from the monotonic clock's zero, system clock 1.005 s ahead of
// its steady clock until that reads 10 s, then set back by 4 ms.
constexpr double kSkewPpm = 20;

MonotonicTime mono(double s) { return MonotonicTime(from_ms(s * 1e3)); }
SteadyTime steady(double s) { return SteadyTime(from_ms(s * 1e3)); }
HostTime host_time(double s) { return HostTime(from_ms(s * 1e3)); }

std::vector<hardware::NodeOscillator> oscillators() {
  return {{}, {.monotonic_zero = {}, .steady_zero = {}, .skew_ppm = kSkewPpm}};
}

double host_1_ms(double s) {
  const double steady_ms = s * 1e3 * (1 + kSkewPpm * 1e-6);
  return steady_ms + 1005 - (steady_ms >= 10'000 ? 4 : 0);
}

// A capture of two cameras, one on each host, whose exposures begin at 3 s and 4 s of the simulated
// world and last 8 ms.
class ExperimentTruthTest : public testing::Test {
 protected:
  ExperimentTruthTest() {
    played_.on_start({.hosts = 2, .cameras = {{0}, {1}}, .frame_rate_hz = 1, .pulses = 2});
    for (std::int64_t pulse = 0; pulse < 2; ++pulse) {
      const TrueTime at = TrueTime(std::chrono::seconds(3 + pulse));
      played_.on_event(PulseTruth{pulse, at, std::vector<Nanoseconds>(2)});
      for (std::uint32_t camera = 0; camera < 2; ++camera) {
        const FrameTruth truth = {
            .pulse = pulse, .exposure_start = at, .exposure_end = at + from_ms(8)};
        played_.on_frame(frame(camera, pulse, SteadyTime{}), &truth);
      }
    }
    captured_.on_start({.hosts = 2, .cameras = {{0}, {1}}, .frame_rate_hz = 99});
    log(0, 0, 0, 1);
    log(1, 0, 0, 1.005);
    log(1, 10, 11.005, 11.001);
  }

  static FrameRecord frame(std::uint32_t camera, std::int64_t pulse, SteadyTime arrived) {
    FrameRecord record;
    record.camera = camera;
    record.counter = static_cast<std::uint32_t>(700 + pulse);
    record.arrival_steady = arrived;
    return record;
  }
  void log(std::uint32_t host, double at_s, double before_s, double after_s) {
    captured_.on_event(ClockAdjustment{.host = host,
                                       .at = steady(at_s),
                                       .before = host_time(before_s == 0 ? after_s : before_s),
                                       .after = host_time(after_s)});
  }
  // A frame of `pulse` that reached its host at this reading of the host's steady clock.
  void capture(std::uint32_t camera, std::int64_t pulse, SteadyTime arrived) {
    captured_.on_frame(frame(camera, pulse, arrived), nullptr);
  }
  KeptRecording recorded(double zero_s) const {
    KeptRecording result;
    add_truth({.played = played_, .zero = mono(zero_s), .oscillators = oscillators()}, captured_,
              result);
    return result;
  }
  template <class Event>
  static std::vector<Event> all(const KeptRecording& recording) {
    std::vector<Event> found;
    for (const KeptEvent& event : recording.events()) {
      if (const auto* one = event_as<Event>(event)) found.push_back(*one);
    }
    return found;
  }

  KeptRecording played_;
  KeptRecording captured_;
};

TEST_F(ExperimentTruthTest, AnExposureIsWhereTheTriggerPutIt) {
  capture(0, 1, steady(6.05));
  const std::vector<FrameEvent> frames = all<FrameEvent>(recorded(5));
  ASSERT_THAT(frames, SizeIs(1));
  const FrameTruth& truth = frames[0].truth.value();
  EXPECT_EQ(truth.pulse, 1);
  EXPECT_EQ(truth.exposure_start, TrueTime(from_ms(6000)));
  EXPECT_EQ(truth.exposure_end, TrueTime(from_ms(6008)));
  EXPECT_EQ(truth.reference, host_time(7.004));
  EXPECT_EQ(truth.own_host, host_time(7.004));
  EXPECT_EQ(truth.own_steady, steady(6.004));
  EXPECT_EQ(truth.delivered, host_time(7.05)) << "the master's clock at 6.05 s";
}

TEST_F(ExperimentTruthTest, AnotherHostsClocksAreItsOwn) {
  // At 5.05 s its oscillator has counted 101 us more.
  capture(1, 0, SteadyTime(from_ms(5050.101)));
  const std::vector<FrameEvent> frames = all<FrameEvent>(recorded(5));
  ASSERT_THAT(frames, SizeIs(1));
  const FrameTruth& truth = frames[0].truth.value();
  EXPECT_EQ(truth.reference, host_time(6.004));
  EXPECT_NEAR(to_ms(truth.own_host.time_since_epoch()), host_1_ms(5.004), 2e-6);
  EXPECT_NEAR(to_ms(truth.own_steady.time_since_epoch()), 5004.10008, 2e-6);
  EXPECT_NEAR(to_ms(truth.delivered.time_since_epoch()), 6050, 2e-6);
}

TEST_F(ExperimentTruthTest, HostErrorsFollowSkewAndSteps) {
  for (const double zero_s : {5.0, 9.5}) {
    const std::vector<PulseTruth> pulses = all<PulseTruth>(recorded(zero_s));
    ASSERT_THAT(pulses, SizeIs(2));
    for (std::size_t i = 0; i < 2; ++i) {
      const double at_s = zero_s + static_cast<double>(i);
      EXPECT_EQ(pulses[i].at, TrueTime(from_ms(at_s * 1e3)));
      ASSERT_THAT(pulses[i].host_errors, SizeIs(2));
      EXPECT_EQ(pulses[i].host_errors[0], Nanoseconds(0));
      EXPECT_NEAR(to_ms(pulses[i].host_errors[1]), host_1_ms(at_s) - (at_s * 1e3 + 1000), 2e-6);
    }
  }
  // In numbers: 5 ms and 100 us after 5 s; 1 ms and 210 us after 10.5 s.
  EXPECT_NEAR(to_ms(all<PulseTruth>(recorded(5))[0].host_errors[1]), 5.1, 2e-6);
  EXPECT_NEAR(to_ms(all<PulseTruth>(recorded(9.5))[1].host_errors[1]), 1.21, 2e-6);
}

TEST_F(ExperimentTruthTest, TheLayoutIsThePlayedOneAndAllElseIsHandedOn) {
  captured_.on_event(SyncOutcome());
  captured_.on_event(ExchangeEvent{.host = 1, .exchange = {}});
  const KeptRecording result = recorded(5);
  EXPECT_EQ(result.layout().frame_rate_hz, 1);
  EXPECT_EQ(result.layout().pulses, 2);
  EXPECT_THAT(all<SyncOutcome>(result), SizeIs(1));
  EXPECT_THAT(all<ExchangeEvent>(result), SizeIs(1));
  EXPECT_THAT(all<ClockAdjustment>(result), SizeIs(3));
}

TEST_F(ExperimentTruthTest, PulsesAreToldBeforeTheFramesThatFollowThem) {
  capture(0, 0, steady(5.05));
  capture(0, 1, steady(6.05));
  std::string order;
  const KeptRecording result = recorded(5);
  for (const KeptEvent& event : result.events()) {
    if (event_as<PulseTruth>(event) != nullptr) order += 'p';
    if (event_as<FrameEvent>(event) != nullptr) order += 'f';
  }
  EXPECT_EQ(order, "pfpf");
}

std::string failure(const KeptRecording& played, const KeptRecording& captured,
                    std::size_t hosts = 2) {
  std::vector<hardware::NodeOscillator> all = oscillators();
  all.resize(hosts);
  KeptRecording ignored;
  try {
    add_truth({.played = played, .zero = mono(5), .oscillators = all}, captured, ignored);
  } catch (const RecordingFailed& error) {
    return error.what();
  }
  return "";
}

TEST_F(ExperimentTruthTest, WhatIsMissingIsSaid) {
  KeptRecording without_log;
  without_log.on_start({.hosts = 2, .cameras = {{0}, {1}}});
  EXPECT_THAT(failure(played_, without_log), HasSubstr("host 0 left no log of its clock"));
  EXPECT_THAT(failure(KeptRecording(), captured_), HasSubstr("no frame that a pulse exposed"));
  EXPECT_THAT(failure(played_, captured_, 1), HasSubstr("1 hosts answered, 2 were played to"));
  capture(0, 7, steady(6));
  EXPECT_THAT(failure(played_, captured_), HasSubstr("camera 0: frame 707 was never played"));
}

class Steers final : public CaptureAlignment {
 public:
  Task<void> run_master(Host&, std::vector<PeerId>) override { co_return; }
  Task<void> run_slave(Host&, PeerId) override { co_return; }
};

TEST(ExperimentSource, ACaptureAlignmentWouldMoveThePlayedTruth) {
  const scenarios::Scenario scenario = scenarios::load_scenario("6node_relay");
  ExperimentSource source(scenario, {});
  KeptRecording captured;
  Steers steers;
  const RecordingRequest request{.seed = 1, .pipeline = "ntp", .capture_alignment = &steers};
  EXPECT_THAT([&] { source.record(request, captured); },
              testing::ThrowsMessage<RecordingFailed>(HasSubstr("capture_alignment moves frames")));
}

}  // namespace
}  // namespace simbench::app
