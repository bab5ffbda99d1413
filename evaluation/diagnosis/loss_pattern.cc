#include "evaluation/diagnosis/loss_pattern.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "evaluation/frames/camera_statistics.h"

namespace simbench::evaluation {
namespace {

constexpr double kMostAtStart = 0.9;
constexpr std::int64_t kFewestPlaces = 3;
constexpr std::size_t kFewestDistances = 5;
constexpr double kEvenDistance = 0.1;
constexpr double kMostEven = 0.8;

// The distance that most neighbours have; NaN if there is none.
double even_distance_s(const std::vector<double>& at_s) {
  std::vector<double> distances;
  for (std::size_t i = 1; i < at_s.size(); ++i) distances.push_back(at_s[i] - at_s[i - 1]);
  if (distances.size() < kFewestDistances) return kNan;
  const double middle = median(distances);
  const auto even = std::ranges::count_if(distances, [middle](double distance) {
    return std::abs(distance - middle) <= kEvenDistance * middle;
  });
  const auto all = static_cast<double>(distances.size());
  return static_cast<double>(even) >= kMostEven * all ? middle : kNan;
}

}  // namespace

LossPlaces loss_places(std::span<const StampedFrame> frames, std::span<const FrameGap> gaps) {
  LossPlaces found;
  std::vector<double> at_s;
  std::int64_t all = 0;
  std::int64_t at_start = 0;
  const auto since_s = [&frames](std::size_t i) {
    return difference_ms(frames[i].arrival.count(), frames.front().arrival.count()) * 1e-3;
  };
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    const std::int64_t missing = gaps[i].lost + gaps[i].never_exposed + gaps[i].unknown;
    if (missing == 0) continue;
    at_s.push_back(since_s(i));
    all += missing;
    if (at_s.back() < to_seconds(kUnsteadyStart)) at_start += missing;
  }
  found.places = static_cast<std::int64_t>(at_s.size());
  if (all == 0) return found;
  found.pattern = LossPattern::kRandom;
  const bool is_long = since_s(frames.size() - 1) > to_seconds(kLongRecording);
  if (is_long && found.places >= kFewestPlaces &&
      static_cast<double>(at_start) >= kMostAtStart * static_cast<double>(all)) {
    found.pattern = LossPattern::kAtStart;
    return found;
  }
  found.every_s = even_distance_s(at_s);
  if (!std::isnan(found.every_s)) found.pattern = LossPattern::kPeriodic;
  return found;
}

}  // namespace simbench::evaluation
