// A score does not depend on how the frames come in blocks, whatever the algorithms.
#include <gtest/gtest.h>

#include <algorithm>
#include <boost/random/mersenne_twister.hpp>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "algorithms/device_time/variants.h"
#include "algorithms/registry.h"
#include "evaluation/scoring/pipeline_scorer.h"
#include "recording/event.h"
#include "tests/algorithms/coded_trigger/coded_frames.h"

namespace simbench::evaluation {
namespace {

enum class Knowledge : std::uint8_t { kTruth, kTruthAndGenlock, kGenlock, kNothing };

constexpr std::uint32_t kBlockCameras = 5;
constexpr std::int64_t kBlockPeriodNs = 20'000'000;

RigLayout block_layout() {
  RigLayout layout = {
      .hosts = 2, .cameras = {}, .frame_rate_hz = 50, .first_pulse = 4, .pulses = 40};
  for (std::uint32_t camera = 0; camera < kBlockCameras; ++camera) {
    layout.cameras.push_back({.host = camera / 3});
  }
  return layout;
}

struct Delivered {
  FrameRecord frame;
  FrameTruth truth;
};

// Frames with noisy delays of up to two periods, of which some are lost, some come twice, some have
// no pulse and some are of the other stream; in order of delivery.
std::vector<Delivered> delivered_frames(boost::random::mt19937& random) {
  std::vector<Delivered> all;
  for (std::int64_t pulse = 0; pulse < 44; ++pulse) {
    for (std::uint32_t camera = 0; camera < kBlockCameras; ++camera) {
      if (random() % 40 == 0) continue;
      const std::int64_t mid_ns = 1'000'000'000 + pulse * kBlockPeriodNs + random() % 100'000;
      const std::int64_t late_ns =
          8'000'000 + random() % (random() % 8 == 0 ? 40'000'000 : 6'000'000);
      Delivered one;
      one.frame.camera = camera;
      one.frame.counter = static_cast<std::uint32_t>(pulse);
      one.frame.exposure_us = 8'000;
      // The registers wrap on the way.
      one.frame.sensor.us = static_cast<std::uint32_t>(mid_ns / 1000 + 0xFFF2'0000 + 1000 * camera);
      one.frame.arrival = HostTime(Nanoseconds(mid_ns + late_ns + 1000 * camera));
      one.frame.arrival_steady = SteadyTime(Nanoseconds(mid_ns + late_ns));
      if (random() % 30 == 0) one.frame.stream = StreamKind::kColour;
      one.truth.pulse = random() % 50 == 0 ? -1 : pulse;
      one.truth.exposure_start = TrueTime(Nanoseconds(mid_ns - 4'000'000));
      one.truth.exposure_end = TrueTime(Nanoseconds(mid_ns + 4'000'000));
      one.truth.reference = HostTime(Nanoseconds(mid_ns));
      one.truth.own_host = HostTime(Nanoseconds(mid_ns + 1000 * camera));
      one.truth.delivered = HostTime(Nanoseconds(mid_ns + late_ns));
      all.push_back(one);
      if (random() % 60 == 0) all.push_back(one);
    }
  }
  std::ranges::stable_sort(
      all, {}, [](const Delivered& one) { return one.frame.arrival_steady.time_since_epoch(); });
  return all;
}

// A capture with polls and adjustments between its frames.
KeptRecording noisy_capture(std::uint32_t seed, bool with_truth) {
  boost::random::mt19937 random(seed);
  KeptRecording kept;
  kept.on_start(block_layout());
  std::int64_t pulse = 0;
  for (const Delivered& one : delivered_frames(random)) {
    const std::int64_t now_ns = nanoseconds_of(one.frame.arrival_steady);
    if (now_ns > 1'000'000'000 + pulse * kBlockPeriodNs) {
      if (with_truth) kept.on_event(PulseTruth{pulse, {}, {Nanoseconds(0), Nanoseconds(1000)}});
      const HostTime host{Nanoseconds(now_ns)};
      kept.on_event(DevicePoll{.camera = static_cast<std::uint32_t>(pulse) % kBlockCameras,
                               .device = one.frame.sensor,
                               .t0 = host - Nanoseconds(300'000),
                               .t1 = host,
                               .t0_steady = one.frame.arrival_steady - Nanoseconds(300'000),
                               .t1_steady = one.frame.arrival_steady});
      if (pulse++ % 7 == 0) {
        kept.on_event(ClockAdjustment{.host = static_cast<std::uint32_t>(pulse) % 2,
                                      .at = one.frame.arrival_steady,
                                      .before = host,
                                      .after = host + Nanoseconds(2000),
                                      .rate_ppb = 500});
      }
    }
    kept.on_frame(one.frame, with_truth ? &one.truth : nullptr);
  }
  return kept;
}

// Hands frames on in blocks of random sizes.
class InBlocks final : public RecordingSink {
 public:
  InBlocks(RecordingSink& sink, std::uint32_t seed) : sink_(sink), random_(seed) {}

  void on_start(const RigLayout& layout) override { sink_.on_start(layout); }
  void on_frames(std::span<const FrameRecord> frames, std::span<const FrameTruth> truths) override {
    for_each_frame(frames, truths, [this](const FrameRecord& frame, const FrameTruth* truth) {
      frames_.push_back(frame);
      if (truth != nullptr) truths_.push_back(*truth);
      if (random_() % 8 == 0) hand_on();
    });
  }
  void on_event(const RecordingEvent& event) override {
    hand_on();
    sink_.on_event(event);
  }
  void hand_on() {
    sink_.on_frames(frames_, truths_);
    frames_.clear();
    truths_.clear();
  }

 private:
  RecordingSink& sink_;
  boost::random::mt19937 random_;
  std::vector<FrameRecord> frames_;
  std::vector<FrameTruth> truths_;
};

// All numbers of a score as bytes, so that NaN equals NaN.
template <class Thing>
std::string_view bytes_of(const Thing& thing) {
  return {reinterpret_cast<const char*>(&thing), sizeof(thing)};
}

void expect_same(const SeedScore& a, const SeedScore& b, const std::string& context) {
  EXPECT_EQ(bytes_of(static_cast<const MetricValues<double>&>(a)),
            bytes_of(static_cast<const MetricValues<double>&>(b)))
      << context;
  EXPECT_EQ(bytes_of(a.frames), bytes_of(b.frames)) << context;
  EXPECT_EQ(bytes_of(a.sets), bytes_of(b.sets)) << context;
  EXPECT_EQ(bytes_of(a.emission_latency_max_ms), bytes_of(b.emission_latency_max_ms)) << context;
  EXPECT_EQ(a.genlock_index_errors, b.genlock_index_errors) << context;
  EXPECT_EQ(a.ground_truth, b.ground_truth) << context;
  ASSERT_EQ(a.host_errors_ms.size(), b.host_errors_ms.size()) << context;
  for (std::size_t host = 0; host < a.host_errors_ms.size(); ++host) {
    EXPECT_EQ(bytes_of(a.host_errors_ms[host]), bytes_of(b.host_errors_ms[host])) << context;
  }
  ASSERT_EQ(a.pulses.size(), b.pulses.size()) << context;
  for (std::size_t i = 0; i < a.pulses.size(); ++i) {
    ASSERT_EQ(bytes_of(a.pulses[i]), bytes_of(b.pulses[i])) << context << ", pulse " << i;
  }
}

ScorerSetup block_setup(const std::string& device_time, const std::string& gathering,
                        Knowledge knowledge) {
  ScorerSetup setup;
  setup.genlock = knowledge == Knowledge::kTruthAndGenlock || knowledge == Knowledge::kGenlock;
  const DeviceTimeName name = parse_device_time_name(device_time);
  const DeviceTimeEntry& estimator = *find_algorithm<DeviceTimeEntry>(name.base);
  if (estimator.make) {
    setup.make_estimator = [name, &estimator](std::size_t) {
      const Parameters parameters = check_parameters(estimator.info.parameters, {});
      auto made = make_variant(name, estimator.make(parameters), {});
      made->on_coded_pulses(pulses_of(short_code()));
      return made;
    };
  }
  setup.make_second_estimator = [](std::size_t) {
    return find_algorithm<DeviceTimeEntry>("regression_offline")->make({});
  };
  const GatheringEntry& gatherer = *find_algorithm<GatheringEntry>(gathering);
  setup.make_gatherer = [&gatherer](GatheringSetup gathering_setup) {
    gathering_setup.pulses = pulses_of(short_code());
    return gatherer.make(check_parameters(gatherer.info.parameters, {}), gathering_setup);
  };
  return setup;
}

void expect_blocks_change_nothing(const std::string& device_time, const std::string& gathering) {
  for (const Knowledge knowledge :
       {Knowledge::kTruth, Knowledge::kTruthAndGenlock, Knowledge::kGenlock, Knowledge::kNothing}) {
    const bool with_truth =
        knowledge == Knowledge::kTruth || knowledge == Knowledge::kTruthAndGenlock;
    if (!with_truth && device_time == "oracle") continue;  // it needs the truth
    const ScorerSetup setup = block_setup(device_time, gathering, knowledge);
    for (std::uint32_t seed = 1; seed <= 3; ++seed) {
      const KeptRecording capture = noisy_capture(seed, with_truth);
      PipelineScorer one_by_one(setup);
      capture.play(one_by_one);
      PipelineScorer in_blocks(setup);
      InBlocks blocks(in_blocks, seed);
      capture.play(blocks);
      blocks.hand_on();
      const SeedScore expected = one_by_one.finish();
      EXPECT_GT(expected.frames.delivered, 0);
      expect_same(in_blocks.finish(), expected,
                  device_time + ", " + gathering + ", knowledge " +
                      std::to_string(static_cast<int>(knowledge)) + ", seed " +
                      std::to_string(seed));
    }
  }
}

TEST(ScoreBlocks, EveryDeviceTime) {
  for (const DeviceTimeEntry& entry : algorithms<DeviceTimeEntry>()) {
    if (entry.info.source == "test") continue;
    expect_blocks_change_nothing(entry.info.name, "yoon2021");
    if (entry.make)
      expect_blocks_change_nothing(entry.info.name + "_steady_calibrated", "yoon2021");
  }
}

TEST(ScoreBlocks, EveryGathering) {
  for (const GatheringEntry& entry : algorithms<GatheringEntry>()) {
    if (entry.info.source == "test") continue;
    expect_blocks_change_nothing("regression_30", entry.info.name);
    expect_blocks_change_nothing("sensor_normalised", entry.info.name);
  }
}

}  // namespace
}  // namespace simbench::evaluation
