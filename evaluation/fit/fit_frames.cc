#include "evaluation/fit/fit_frames.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "evaluation/fit/fit.h"
#include "evaluation/frames/camera_statistics.h"
#include "evaluation/statistics/statistics.h"
#include "recording/counted.h"

namespace simbench::evaluation {
namespace {

constexpr std::size_t kNearFrames = 15;  // of a step: its neighbourhood
constexpr std::size_t kStartParts = 4;   // of a short file the first is left out

double delivered_at_s(std::span<const StampedFrame> frames, const StampedFrame& frame) {
  return difference_ms(frame.arrival.count(), frames.front().arrival.count()) * 1e-3;
}

// (arrival - device stamp) of each frame from the first on, in ms.
std::vector<double> stamp_distances_ms(std::span<const StampedFrame> frames) {
  std::vector<double> distances;
  distances.reserve(frames.size());
  for (const StampedFrame& frame : frames) {
    distances.push_back(difference_ms(frame.arrival.count(), frames.front().arrival.count()) -
                        difference_ms(frame.sensor.count(), frames.front().sensor.count()));
  }
  return distances;
}

// Removes the drift, as the median change over some frames has it. Returns the spread of those
// changes, between their quartiles.
double without_drift(std::vector<double>& distances_ms) {
  std::vector<double> changes;
  for (std::size_t i = kNearFrames; i < distances_ms.size(); ++i) {
    changes.push_back(distances_ms[i] - distances_ms[i - kNearFrames]);
  }
  const double per_frame = median(changes) / static_cast<double>(kNearFrames);
  for (std::size_t i = 0; i < distances_ms.size(); ++i) {
    distances_ms[i] -= per_frame * static_cast<double>(i);
  }
  return quantile(changes, 0.75) - quantile(changes, 0.25);
}

// The change of the median at frame `at`, over `window` frames on either side, none before `first`.
double step_at(const std::vector<double>& values, std::size_t first, std::size_t at,
               std::size_t window) {
  const std::size_t begin = at - std::min(window, at - first);
  const std::size_t end = std::min(values.size(), at + window);
  const auto median_in = [&values](std::size_t from, std::size_t to) {
    return median(std::vector<double>(values.begin() + static_cast<std::ptrdiff_t>(from),
                                      values.begin() + static_cast<std::ptrdiff_t>(to)));
  };
  return median_in(at, end) - median_in(begin, at);
}

struct StretchStep {
  std::size_t frame = 0;  // the first one after it
  double step_ms = 0;
};

// Where (arrival - device stamp) changes for good.
std::vector<StretchStep> stretch_steps(std::span<const StampedFrame> frames, double period_ms) {
  std::vector<StretchStep> steps;
  if (frames.size() < 2 * kNearFrames) return steps;
  std::vector<double> distances = stamp_distances_ms(frames);
  const double limit = std::max(period_ms / 2, kJumpSpreads * without_drift(distances));
  const auto window = std::max(kNearFrames, static_cast<std::size_t>(kStretchS * 1e3 / period_ms));
  const std::size_t last = frames.size() - kNearFrames;
  const auto is_step = [&distances, limit](std::size_t i) {
    return std::abs(distances[i] - distances[i - 1]) > limit;
  };
  std::size_t settled = 0;
  for (std::size_t i = kNearFrames; i <= last; ++i) {
    if (i < settled + kNearFrames || !is_step(i)) continue;
    if (std::abs(step_at(distances, settled, i, window)) <= limit) continue;
    // A late frame shortly before the step has seen it too: the step is where it is steepest.
    std::size_t steepest = i;
    double most = 0;
    for (std::size_t j = i; j <= std::min(last, i + window); ++j) {
      if (!is_step(j)) continue;
      const double near = std::abs(step_at(distances, settled, j, kNearFrames));
      if (near > most) {
        most = near;
        steepest = j;
      }
    }
    steps.push_back({steepest, step_at(distances, settled, steepest, window)});
    settled = steepest;
    i = steepest;
  }
  return steps;
}

// A line for the stretches that are not [begin, end).
std::string stretches_text(std::span<const StampedFrame> frames,
                           const std::vector<StretchStep>& steps, std::size_t begin,
                           std::size_t end) {
  constexpr std::size_t kStepsShown = 4;
  std::vector<std::string> shown;
  for (std::size_t i = 0; i < std::min(steps.size(), kStepsShown); ++i) {
    shown.push_back(fmt::format("{:+.1f} ms at {:.1f} s", steps[i].step_ms,
                                delivered_at_s(frames, frames[steps[i].frame])));
  }
  if (steps.size() > kStepsShown) shown.emplace_back("...");
  return fmt::format(
      "{} before {:.1f} s and {} after {:.1f} s: arrival less device stamp changes for good "
      "{} ({}), as where a clock is set, stamps slip or the camera starts again; the longest "
      "stretch without that is used",
      counted(begin, "frame"), delivered_at_s(frames, frames[begin]),
      counted(frames.size() - end, "frame"), delivered_at_s(frames, frames[end - 1]),
      times(steps.size()), fmt::join(shown, ", "));
}

void sort_by_device(std::span<StampedFrame> frames) {
  std::stable_sort(frames.begin(), frames.end(), [](const StampedFrame& a, const StampedFrame& b) {
    return a.sensor < b.sensor;
  });
}

void drop_repeated(UsableFrames& usable) {
  const auto end = std::unique(
      usable.frames.begin(), usable.frames.end(),
      [](const StampedFrame& a, const StampedFrame& b) { return a.sensor == b.sensor; });
  const auto repeated = static_cast<std::size_t>(usable.frames.end() - end);
  usable.frames.erase(end, usable.frames.end());
  if (repeated == 0) return;
  usable.left_out.push_back(
      fmt::format("{} with the device stamp of another", counted(repeated, "frame")));
}

void drop_warm_up(std::span<const StampedFrame> delivered, Nanoseconds warm_up,
                  UsableFrames& usable) {
  std::erase_if(usable.frames, [&](const StampedFrame& frame) {
    return delivered_at_s(delivered, frame) < to_seconds(warm_up);
  });
}

// The start of a recording whose warm-up is not stated.
void drop_start(std::span<const StampedFrame> delivered, UsableFrames& usable) {
  const std::size_t before = usable.frames.size();
  if (delivered_at_s(delivered, delivered.back()) >= to_seconds(kLongRecording)) {
    drop_warm_up(delivered, kUnsteadyStart, usable);
    const std::size_t removed = before - usable.frames.size();
    if (removed == 0) return;
    usable.left_out.push_back(fmt::format("the first {:g} s ({}), in which cameras are unsteady",
                                          to_seconds(kUnsteadyStart), counted(removed, "frame")));
    return;
  }
  const std::size_t quarter = before / kStartParts;
  if (before - quarter < kFewestFrames) return;
  usable.left_out.push_back(fmt::format(
      "the first quarter ({}), in which cameras are unsteady: the file is shorter than {:g} s",
      counted(quarter, "frame"), to_seconds(kLongRecording)));
  usable.frames.erase(usable.frames.begin(),
                      usable.frames.begin() + static_cast<std::ptrdiff_t>(quarter));
}

}  // namespace

double lost_together(std::span<const StampedFrame> frames, bool counted) {
  double lost = 0;
  double squares = 0;
  for (const FrameGap& gap : frame_gaps(frames, counted)) {
    const auto length = static_cast<double>(gap.lost);
    lost += length;
    squares += length * length;
  }
  return lost > 0 ? squares / lost : 1;
}

UsableFrames usable_frames(std::span<const StampedFrame> delivered, bool counted,
                           std::optional<Nanoseconds> warm_up) {
  UsableFrames usable;
  const std::optional<StampGrid> grid = stamp_grid(delivered);
  if (!grid) {
    usable.account = frame_account(delivered, counted);
    if (delivered.empty()) return usable;
    usable.left_out.emplace_back("all frames: their device stamps do not advance");
    return usable;
  }
  const std::vector<StretchStep> steps = stretch_steps(delivered, grid->period_ms);
  std::vector<StampedFrame> ordered(delivered.begin(), delivered.end());
  std::size_t longest_begin = 0;
  std::size_t longest = 0;
  std::size_t begin = 0;
  for (std::size_t i = 0; i <= steps.size(); ++i) {
    const std::size_t end = i < steps.size() ? steps[i].frame : ordered.size();
    sort_by_device(std::span(ordered).subspan(begin, end - begin));
    if (end - begin > longest) {
      longest = end - begin;
      longest_begin = begin;
    }
    begin = end;
  }
  usable.account = frame_account(ordered, counted);
  usable.lost_together = lost_together(ordered, counted);
  if (!steps.empty()) {
    usable.left_out.push_back(
        stretches_text(delivered, steps, longest_begin, longest_begin + longest));
  }
  const auto first = ordered.begin() + static_cast<std::ptrdiff_t>(longest_begin);
  usable.frames.assign(first, first + static_cast<std::ptrdiff_t>(longest));
  drop_repeated(usable);
  if (warm_up) {
    drop_warm_up(delivered, *warm_up, usable);
  } else {
    drop_start(delivered, usable);
  }
  return usable;
}

}  // namespace simbench::evaluation
