// Hand-made captures for the tests of evaluation/: every frame is where the test puts it.
//
// Pulse p is at 1 s + p * 20 ms. Unless a test says otherwise, an exposure is centred on its pulse,
// host clocks are right, a frame arrives 10 ms after mid-exposure and its sensor stamp is the true
// time. Frames are delivered pulse by pulse, in order of camera.
//
//   TestCapture capture(/*hosts=*/2, /*cameras_per_host=*/3);
//   capture.late_by = [](std::uint32_t camera, std::int64_t) { return from_ms(camera); };
//   capture.lost = [](std::uint32_t camera, std::int64_t pulse) { return pulse == 5; };
//   capture.record(scorer);
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "evaluation/scoring/pipeline_scorer.h"
#include "recording/recording.h"

namespace simbench::evaluation {

struct TestCapture {
  TestCapture(std::uint32_t hosts, std::uint32_t cameras_per_host);

  static constexpr Nanoseconds kPeriod{20'000'000};
  static TrueTime at(std::int64_t pulse) {
    return TrueTime(std::chrono::seconds(1) + pulse * kPeriod);
  }

  void record(RecordingSink& sink) const;
  // One frame, as record() would deliver it.
  void deliver(std::uint32_t camera, std::int64_t pulse, RecordingSink& sink) const;

  using PerFrame = std::function<Nanoseconds(std::uint32_t camera, std::int64_t pulse)>;

  RigLayout layout;  // 3 pulses of warm-up, 10 evaluated
  bool with_truth = true;
  PerFrame late_by;          // added to the arrival
  PerFrame exposed_late_by;  // added to the true mid-exposure
  PerFrame sensor_late_by;   // added to the sensor stamp
  std::function<bool(std::uint32_t camera, std::int64_t pulse)> lost;
  std::vector<Nanoseconds> host_errors;  // of the system clocks, constant
  std::vector<SyncOutcome> outcomes;
};

// A setup that scores the bare arrivals, with Algorithm 3.
ScorerSetup arrival_setup();

// The score of the capture.
SeedScore score(const TestCapture& capture, const ScorerSetup& setup);

// What scores may be off by: rounding alone.
inline constexpr double kTolerance = 1e-9;

// Cameras 0 .. n-1 arrive 0, 1, ... n-1 ms late.
inline Nanoseconds staircase(std::uint32_t camera, std::int64_t) { return from_ms(camera); }

}  // namespace simbench::evaluation
