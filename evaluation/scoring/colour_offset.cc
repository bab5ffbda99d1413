#include "evaluation/scoring/colour_offset.h"

#include <algorithm>
#include <cstdlib>
#include <optional>

#include "algorithms/ports/assert.h"
#include "evaluation/scoring/pulse_scores.h"
#include "evaluation/statistics/statistics.h"

namespace simbench::evaluation {
namespace {

std::int64_t mid_exposure_ns(const FrameTruth& truth) {
  return PulseTable::clamped_ns(GlobalTime(truth.mid_exposure().time_since_epoch()));
}

// The nearest of the frames, which are in order of time, less `at_ns`; nothing if it is unknown.
template <class Frames>
std::optional<std::int64_t> nearest_offset_ns(const Frames& frames, std::int64_t at_ns) {
  const auto next =
      std::ranges::lower_bound(frames, at_ns, {}, [](const auto& frame) { return frame.mid_ns; });
  if (next == frames.end()) return std::nullopt;
  if (next->mid_ns == at_ns) return 0;
  if (next == frames.begin()) return std::nullopt;
  const auto last = next - 1;
  if (next->counter != last->counter + 1) return std::nullopt;
  const std::int64_t since_last_ns = at_ns - last->mid_ns;
  const std::int64_t to_next_ns = next->mid_ns - at_ns;
  return since_last_ns < to_next_ns ? -since_last_ns : to_next_ns;
}

}  // namespace

ColourOffset::ColourOffset(const RigLayout& layout)
    : first_pulse_(layout.first_pulse), pulses_(layout.pulses), cameras_(layout.cameras.size()) {}

void ColourOffset::add(const FrameRecord& frame, const FrameTruth& truth) {
  SIMBENCH_ASSERT(frame.camera < cameras_.size(), "a frame of a camera of the rig");
  Camera& camera = cameras_[frame.camera];
  if (frame.stream == StreamKind::kColour) {
    camera.colour.push_back({.mid_ns = mid_exposure_ns(truth), .counter = frame.counter});
  } else if (truth.pulse >= first_pulse_ && truth.pulse - first_pulse_ < pulses_) {
    camera.depth.push_back({.mid_ns = mid_exposure_ns(truth), .pulse = truth.pulse});
  }
}

void ColourOffset::add_to(MetricValues<double>& score) {
  PulseRanges ranges(first_pulse_, pulses_);
  std::vector<double> absolute_ms;
  for (std::uint32_t camera = 0; camera < cameras_.size(); ++camera) {
    Camera& frames = cameras_[camera];
    std::ranges::stable_sort(frames.colour, {}, &Colour::mid_ns);
    for (const Depth& depth : frames.depth) {
      const auto offset_ns = nearest_offset_ns(frames.colour, depth.mid_ns);
      if (!offset_ns) continue;
      ranges.add(camera, depth.pulse, GlobalTime(Nanoseconds(*offset_ns)));
      absolute_ms.push_back(to_ms(Nanoseconds(std::abs(*offset_ns))));
    }
  }
  score.colour_offset_ms = mean_of_existing(absolute_ms);
  score.colour_offset_spread_ms = ranges.amd_ms(cameras_.size());
}

}  // namespace simbench::evaluation
