// How well the exposures of cameras that are steered by their controls coincide: spread, time to
// alignment, disturbed frames, drift, wrong locks.
//
// For captures without trigger cable whose frames have truth. A frame's pulse is the index of the
// exposure of the reference camera, camera 0, that is nearest to it. A pulse counts if all cameras
// have a frame of it; of several frames of a camera, its first.
//
//   spread         the range of the true mid-exposures of a pulse; median and 95 % quantile over
//                  the evaluated pulses
//   aligned        the whole second since the capture's start (the first exposure's begin, warm-up
//                  included) from which on the median spread of every second stays below 1, 0.1 and
//                  0.01 ms, to the last evaluated pulse; NaN: it does not
//   disturbed      frames of the whole capture, but for the cameras' unsteady start, whose length
//                  (from mid-exposure to that of the next frame by the camera's counter) or whose
//                  exposure differs from the camera's median by more than 1 %; the mean over the
//                  cameras
//   drift          of a camera against the reference camera: the change of the distance of their
//                  mid-exposures over a second, along the least-squares line through it; the median
//                  over the whole seconds of evaluated pulses of its absolute value, of the camera
//                  where it is largest. Corrections in less than half of the seconds do not move it
//   wrong locks    cameras whose newest report says that they are aligned, while the median
//                  distance of their mid-exposures to the reference camera's, over the evaluated
//                  pulses, is more than a tenth of the frame period; NaN: nobody reported
//
// What compares cameras is NaN of a single one, and everything without frames. Memory: 24 bytes a
// frame. Complexity: O(n log n) of n frames. Definitions: docs/design.md section 8.
//
//   AlignmentScores scores(layout, /*unsteady_start=*/from_ms(5000));
//   scores.add(frame, truth);              // each frame of the scored stream
//   scores.add(AlignmentReport{.camera = 3, .aligned = true});
//   scores.add_to(seed_score);
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/scoring/metrics.h"
#include "recording/recording.h"

namespace simbench::evaluation {

class AlignmentScores {
 public:
  // `unsteady_start`: so long after a camera's first exposure its frames jitter by themselves.
  AlignmentScores(const RigLayout& layout, Nanoseconds unsteady_start);

  // A frame of a camera of the layout, in order of delivery.
  void add(const FrameRecord& frame, const FrameTruth& truth);
  void add(const AlignmentReport& report);

  // Why a camera is not aligned, by its newest report: of the first such camera. Empty: all that
  // were reported are.
  std::string problem() const;

  // Sets the score's exposure_spread_median_ms, exposure_spread_p95_ms, aligned_1_ms_s,
  // aligned_0_1_ms_s, aligned_0_01_ms_s, disturbed_frames, exposure_drift_ppm and wrong_locks.
  void add_to(MetricValues<double>& score) const;

 private:
  struct Frame {
    std::int64_t mid_ns = 0;  // true mid-exposure
    std::int32_t pulse = -1;  // -1: none that counts
    std::uint32_t counter = 0;
    std::uint32_t exposure_ns = 0;
  };

  // A frame of the reference camera and what all cameras have near it.
  struct Pulse {
    std::int32_t pulse = 0;
    std::uint32_t cameras = 0;
    std::uint32_t newest_camera = 0;
    std::int64_t reference_ns = 0;
    std::int64_t least_ns = 0;
    std::int64_t greatest_ns = 0;

    double spread_ms() const { return static_cast<double>(greatest_ns - least_ns) * 1e-6; }
  };

  // A camera's mid-exposure less the reference camera's, at the latter.
  struct Distance {
    double at_s = 0;  // since the first evaluated pulse
    double us = 0;
  };

  std::int32_t pulse_that_counts(std::int64_t pulse) const;
  bool is_evaluated(std::int32_t pulse) const { return pulse >= first_pulse_; }
  std::vector<Pulse> pulses_of_reference() const;
  // In order of pulses.
  std::vector<Pulse> complete_pulses() const;
  std::vector<Distance> distances(std::size_t camera, const std::vector<Pulse>& reference) const;
  double drift_ppm(const std::vector<Distance>& distances, double seconds) const;
  // Nothing of a camera without steady frames.
  std::optional<std::int64_t> disturbed_frames(const std::vector<Frame>& frames) const;
  void add_spreads(const std::vector<Pulse>& complete, MetricValues<double>& score) const;
  void add_aligned(const std::vector<Pulse>& complete, MetricValues<double>& score) const;
  void add_distances(MetricValues<double>& score) const;

  double period_ns_;
  double unsteady_ns_;  // a frame more than stated: the first may itself be early
  std::int64_t first_pulse_;
  std::int64_t end_pulse_;
  std::int64_t start_ns_;  // of the first exposure
  std::vector<std::vector<Frame>> cameras_;
  std::map<std::uint32_t, AlignmentReport> reports_;  // by camera, the newest
};

}  // namespace simbench::evaluation
