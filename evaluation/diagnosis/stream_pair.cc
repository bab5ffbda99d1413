#include "evaluation/diagnosis/stream_pair.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "evaluation/frames/camera_statistics.h"

namespace simbench::evaluation {
namespace {

constexpr double kMovesShare = 0.25;    // of a period; more is no jitter
constexpr double kMovesDeviations = 4;  // of the offsets

// The first stream's register may have wrapped before the second stream began.
std::int64_t register_difference(const StampedFrame& a, const StampedFrame& b) {
  const std::int64_t difference = (a.sensor - b.sensor).count();
  const double wraps =
      std::round(static_cast<double>(difference) / static_cast<double>(kDeviceRegisterNs));
  return difference - static_cast<std::int64_t>(wraps) * kDeviceRegisterNs;
}

}  // namespace

PairDiagnosis compare_streams(std::span<const StampedFrame> recorded,
                              std::span<const StampedFrame> recorded_against) {
  PairDiagnosis pair;
  if (recorded.size() < 2 || recorded_against.size() < 2) return pair;
  const std::vector<StampedFrame> frames = unwrapped(recorded);
  const std::vector<StampedFrame> against = unwrapped(recorded_against);
  const double period_ms = to_ms(median_period(against));
  if (!(period_ms > 0)) return pair;

  std::vector<double> minutes;
  std::vector<double> offsets;
  std::size_t nearest = 0;
  for (const StampedFrame& frame : frames) {
    const auto distance = [&](std::size_t i) {
      return std::abs(register_difference(frame, against[i]));
    };
    while (nearest + 1 < against.size() && distance(nearest + 1) <= distance(nearest)) ++nearest;
    double offset = static_cast<double>(register_difference(frame, against[nearest])) * 1e-6;
    if (std::abs(offset) > period_ms) continue;  // lost frames
    if (!offsets.empty()) {
      offset = offsets.back() + std::remainder(offset - offsets.back(), period_ms);
    }
    offsets.push_back(offset);
    minutes.push_back(difference_ms(frame.sensor.count(), frames.front().sensor.count()) / 60'000);
  }
  if (offsets.size() < 2) return pair;
  const FittedLine line = fit_line(minutes, offsets);
  std::vector<double> deviations;
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    deviations.push_back(offsets[i] - line.at(minutes[i]));
  }
  const double moved_ms = std::abs(line.slope) * (minutes.back() - minutes.front());
  pair.offset_ms = std::remainder(mean_of(offsets), period_ms);
  pair.spread_ms = standard_deviation(deviations);
  pair.moves_ms_per_minute = line.slope;
  pair.runs_free =
      moved_ms > kMovesShare * period_ms && moved_ms > kMovesDeviations * pair.spread_ms;
  return pair;
}

}  // namespace simbench::evaluation
