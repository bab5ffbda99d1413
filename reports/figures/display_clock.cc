#include "reports/figures/display_clock.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

namespace simbench::reports {
namespace {

constexpr double kStepMs = 1000 / kDisplayRateHz;
constexpr std::int64_t kMostReadings = 24;
constexpr double kLeastShare = 0.01;

// Minutes, seconds and milliseconds of the display's frame `step`: whole ones, as clocks count.
std::string reading(std::int64_t step) {
  // A step is 25/3 ms: whole numbers, so that equal steps have equal texts.
  const std::int64_t ms = step >= 0 ? step * 25 / 3 : -((-step * 25 + 2) / 3);
  const std::int64_t in_hour = ((ms % 3'600'000) + 3'600'000) % 3'600'000;
  return fmt::format("{:02}:{:02}.{:03}", in_hour / 60'000, in_hour / 1000 % 60, in_hour % 1000);
}

}  // namespace

std::vector<PhotographedReading> display_readings(double start_ms, double end_ms) {
  const auto first = static_cast<std::int64_t>(std::floor(start_ms / kStepMs));
  if (!(end_ms > start_ms)) return {{reading(first), 1}};
  const auto last = std::clamp(static_cast<std::int64_t>(std::ceil(end_ms / kStepMs)) - 1, first,
                               first + kMostReadings - 1);
  const double end = std::min(end_ms, static_cast<double>(last + 1) * kStepMs);
  std::vector<PhotographedReading> readings;
  for (std::int64_t step = first; step <= last; ++step) {
    const double from = std::max(start_ms, static_cast<double>(step) * kStepMs);
    const double to = std::min(end, static_cast<double>(step + 1) * kStepMs);
    readings.push_back({reading(step), (to - from) / (end - start_ms)});
  }
  std::erase_if(readings, [](const PhotographedReading& r) { return r.share < kLeastShare; });
  double sum = 0;
  for (const PhotographedReading& seen : readings) sum += seen.share;
  for (PhotographedReading& seen : readings) seen.share /= sum;
  return readings;
}

}  // namespace simbench::reports
