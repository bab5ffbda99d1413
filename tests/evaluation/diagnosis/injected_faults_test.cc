// Faults that a simulated rig is given, one at a time, and what the diagnosis says first: ten
// kinds, three sizes, three rigs. And rigs without a fault, of which it must say nothing.
//
// Captures are of the simulator, with arrivals in true time (hosts whose clocks are right), cameras
// of a clock of their own, or of one that PTP keeps within some microseconds.
#include <gmock/gmock.h>

#include <algorithm>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <boost/random/uniform_01.hpp>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "evaluation/diagnosis/diagnose.h"
#include "scenarios/loader.h"
#include "sim/rig/simulation.h"
#include "tests/recording/test_sink.h"

namespace simbench::evaluation {
namespace {

constexpr double kCaptureS = 60;
constexpr double kUnixMs = 1'700'000'000'000;
constexpr std::size_t kFaulty = 1;  // the camera that gets the fault

enum class Clocks : std::uint8_t { kOwn, kPtp };

// The depth frames of a capture, a stream a camera.
class TrueTimeSink final : public TestSink {
 public:
  explicit TrueTimeSink(Clocks clocks) : clocks_(clocks) {}
  void on_start(const RigLayout& layout) override {
    layout_ = layout;
    for (std::size_t i = 0; i < layout.cameras.size(); ++i) {
      streams.push_back({.camera = std::to_string(i),
                         .host = "host" + std::to_string(layout.cameras[i].host),
                         .stream = "Depth 0",
                         .frames = {}});
    }
  }

  std::vector<RecordedStream> streams;

 private:
  void frame_came(const FrameRecord& frame, const FrameTruth* truth) override {
    if (frame.stream != StreamKind::kDepth) return;
    const Nanoseconds exposed = truth->mid_exposure().time_since_epoch();
    const Nanoseconds delay = frame.arrival_steady - truth->own_steady;
    StampedFrame stamped = {.counter = frame.counter,
                            .sensor = Microseconds(frame.sensor.us),
                            .arrival = exposed + delay + from_ms(kUnixMs)};
    if (clocks_ == Clocks::kPtp) {
      constexpr double kPtpMs = 0.005;
      stamped.sensor = exposed + from_ms(kUnixMs) + from_ms(kPtpMs * normal_(random_));
    }
    streams[frame.camera].frames.push_back(stamped);
  }

  Clocks clocks_;
  RigLayout layout_;
  boost::random::mt19937 random_{5};
  boost::random::normal_distribution<double> normal_;
};

std::vector<RecordedStream> capture(const std::string& name, std::uint64_t seed, Clocks clocks,
                                    std::vector<scenarios::Override> overrides = {}) {
  const double rate_hz = name.ends_with("45fps") ? 45 : 30;
  overrides.push_back({"/timeline/frames", std::to_string(static_cast<int>(kCaptureS * rate_hz))});
  const scenarios::Scenario scenario = scenarios::load_scenario(name, overrides);
  TrueTimeSink sink(clocks);
  sim::make_simulation(scenario)->record(
      {.seed = seed, .pipeline = scenario.pipelines.front().name}, sink);
  return sink.streams;
}

using Frames = std::vector<StampedFrame>;

double period_of(const Frames& frames) {
  return to_ms(frames.back().sensor - frames.front().sensor) /
         static_cast<double>(frames.back().counter - frames.front().counter);
}

void move(StampedFrame& frame, double ms) {
  frame.sensor += from_ms(ms);
  frame.arrival += from_ms(ms);
}

// Frames in order of delivery, a counter for each.
void keep(Frames& frames, const std::function<bool(std::size_t)>& is_kept, bool renumber) {
  Frames kept;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (!is_kept(i)) continue;
    kept.push_back(frames[i]);
    if (renumber) kept.back().counter = kept.size();
  }
  frames = std::move(kept);
}

struct Fault {
  const char* kind;  // what the diagnosis must name, as the first finding of that camera
  Clocks clocks;
  std::vector<double> sizes;
  std::function<void(RecordedStream&, double)> inject;
};

void run_free(RecordedStream& stream, double ppm) {
  const Nanoseconds begin = stream.frames.front().arrival;
  for (StampedFrame& frame : stream.frames) move(frame, to_ms(frame.arrival - begin) * ppm * 1e-6);
}

void lose(RecordedStream& stream, double share) {
  boost::random::mt19937 random(11);
  boost::random::uniform_01<double> uniform;
  keep(
      stream.frames, [&](std::size_t) { return uniform(random) >= share; }, false);
}

void drop_uncounted(RecordedStream& stream, double share) {
  lose(stream, share);
  stream.counted = false;
  for (std::size_t i = 0; i < stream.frames.size(); ++i) stream.frames[i].counter = i;
}

void skip(RecordedStream& stream, double every) {
  const auto n = static_cast<std::size_t>(every);
  keep(
      stream.frames, [n](std::size_t i) { return i % n == 0; }, true);
}

void slip(RecordedStream& stream, double periods) {
  const double period_ms = period_of(stream.frames);
  for (std::size_t i = stream.frames.size() / 2; i < stream.frames.size(); ++i) {
    stream.frames[i].sensor += from_ms(periods * period_ms);
  }
}

void set_clock(RecordedStream& stream, double ms) {
  for (std::size_t i = stream.frames.size() / 2; i < stream.frames.size(); ++i) {
    stream.frames[i].arrival += from_ms(ms);
  }
}

void step_phase(RecordedStream& stream, double share) {
  const double period_ms = period_of(stream.frames);
  for (std::size_t i = stream.frames.size() / 2; i < stream.frames.size(); ++i) {
    move(stream.frames[i], share * period_ms);
  }
}

void shift_scale(RecordedStream& stream, double ahead_s) {
  for (StampedFrame& frame : stream.frames) frame.sensor += from_ms(ahead_s * 1e3);
}

// A program that is late by `sd_ms` stamps.
void stamp_on_arrival(RecordedStream& stream, double sd_ms) {
  boost::random::mt19937 random(3);
  boost::random::normal_distribution<double> normal;
  for (StampedFrame& frame : stream.frames) {
    frame.arrival += from_ms(4 * sd_ms + sd_ms * normal(random));
    frame.sensor = frame.arrival - from_ms(0.4 + 0.05 * normal(random));
  }
}

void offset(RecordedStream& stream, double share) {
  const double period_ms = period_of(stream.frames);
  for (StampedFrame& frame : stream.frames) move(frame, share * period_ms);
}

std::vector<Fault> faults() {
  return {{"free_running", Clocks::kOwn, {15, 100, 5000}, run_free},
          {"lost_frames", Clocks::kOwn, {0.01, 0.1, 0.55}, lose},
          {"missing_frames", Clocks::kOwn, {0.01, 0.1, 0.55}, drop_uncounted},
          {"divided_rate", Clocks::kOwn, {2, 3, 4}, skip},
          {"period_slip", Clocks::kOwn, {1, 2, 5}, slip},
          {"clock_step", Clocks::kOwn, {19, 110, 1210}, set_clock},
          {"phase_step", Clocks::kOwn, {0.1, 0.25, 0.5}, step_phase},
          {"time_scale", Clocks::kPtp, {18, 37, 7200}, shift_scale},
          {"stamped_on_arrival", Clocks::kPtp, {1, 3, 6}, stamp_on_arrival},
          {"constant_offset", Clocks::kPtp, {0.05, 0.25, 0.5}, offset}};
}

// By automatic exposure the cameras of a host look at another brightness, and their middles differ
// by a millisecond: a true offset, which PTP stamps show.
std::vector<scenarios::Override> equal_exposures() {
  return {{"/cameras/exposure_camera_periods", "0"},
          {"/cameras/exposure_host_periods", "0"},
          {"/cameras/auto_exposure/step_interval_exponential_ms", "0"}};
}

const std::vector<std::string>& rigs() {
  static const std::vector<std::string> names = {"3cam_1host_30fps", "6cam_2host_30fps",
                                                 "18cam_6host_45fps"};
  return names;
}

// The first finding is of that kind, and of that camera or, if two cameras disagree, of the rig.
bool is_named(const Diagnosis& found, const Fault& fault) {
  if (found.findings.empty()) return false;
  const Finding& first = found.findings.front();
  const bool of_camera = first.camera == std::to_string(kFaulty);
  return first.kind == fault.kind && of_camera;
}

TEST(InjectedFaults, TenKindsAreNamedFirst) {
  int all = 0;
  int named = 0;
  for (const std::string& rig : rigs()) {
    for (const Clocks clocks : {Clocks::kOwn, Clocks::kPtp}) {
      const std::vector<RecordedStream> clean = capture(rig, 21, clocks, equal_exposures());
      for (const Fault& fault : faults()) {
        if (fault.clocks != clocks) continue;
        for (const double size : fault.sizes) {
          std::vector<RecordedStream> streams = clean;
          fault.inject(streams[kFaulty], size);
          const Diagnosis found = diagnose(streams, {});
          ++all;
          if (is_named(found, fault)) {
            ++named;
          } else {
            std::string said = found.findings.empty() ? "nothing" : found.findings.front().text;
            std::printf("%s, %s %g: %s\n", rig.c_str(), fault.kind, size, said.c_str());
          }
        }
      }
    }
  }
  std::printf("%d of %d faults are named first\n", named, all);
  EXPECT_EQ(all, 90);
  EXPECT_GE(named, 86) << "95 %";
}

TEST(InjectedFaults, FiftyCleanRigsHaveNone) {
  int with_findings = 0;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    const Clocks clocks = seed % 2 == 0 ? Clocks::kOwn : Clocks::kPtp;
    const Diagnosis found =
        diagnose(capture(rigs()[seed % 3], seed, clocks, equal_exposures()), {});
    EXPECT_EQ(found.verdict.status, SyncStatus::kWorks) << seed << found.verdict.reason;
    for (const Finding& finding : found.findings) {
      if (finding.harm == Harm::kNote) continue;
      ++with_findings;
      ADD_FAILURE() << seed << ": " << finding.text;
      break;
    }
  }
  EXPECT_EQ(with_findings, 0);
}

}  // namespace
}  // namespace simbench::evaluation
