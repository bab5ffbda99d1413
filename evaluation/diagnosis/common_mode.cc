#include "evaluation/diagnosis/common_mode.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace simbench::evaluation {
namespace {

constexpr std::size_t kWindows = 16;
constexpr std::size_t kFewestWindows = 8;
constexpr std::size_t kFewestInWindow = 5;
constexpr double kLeastShared = 0.5;  // of the longest recording

struct SharedTime {
  double begin_ms = 0;
  double end_ms = 0;
};

std::optional<SharedTime> shared_time(std::span<const StreamFacts* const> cameras) {
  SharedTime shared{.begin_ms = -HUGE_VAL, .end_ms = HUGE_VAL};
  double longest_ms = 0;
  for (const StreamFacts* camera : cameras) {
    if (camera->arrivals_ms.size() < 2 || !camera->steps.empty()) return std::nullopt;
    shared.begin_ms = std::max(shared.begin_ms, camera->arrivals_ms.front());
    shared.end_ms = std::min(shared.end_ms, camera->arrivals_ms.back());
    longest_ms = std::max(longest_ms, camera->arrivals_ms.back() - camera->arrivals_ms.front());
  }
  const bool enough = shared.end_ms - shared.begin_ms > kLeastShared * longest_ms;
  return enough ? std::optional(shared) : std::nullopt;
}

// The median phase in each window; NaN where there are too few frames.
std::vector<double> window_phases(const StreamFacts& camera, double period_ms,
                                  const SharedTime& shared) {
  std::vector<std::vector<double>> phases(kWindows);
  const double width_ms = (shared.end_ms - shared.begin_ms) / static_cast<double>(kWindows);
  for (std::size_t i = 0; i < camera.arrivals_ms.size(); ++i) {
    const double since_ms = camera.arrivals_ms[i] - shared.begin_ms;
    if (since_ms < 0 || camera.arrivals_ms[i] > shared.end_ms) continue;
    const auto window = std::min(kWindows - 1, static_cast<std::size_t>(since_ms / width_ms));
    phases[window].push_back(since_ms - static_cast<double>(camera.periods[i]) * period_ms);
  }
  std::vector<double> medians;
  medians.reserve(kWindows);
  for (std::vector<double>& of_window : phases) {
    medians.push_back(of_window.size() < kFewestInWindow ? kNan : median(std::move(of_window)));
  }
  return medians;
}

// The line through the differences of phases over the middles of the windows, in periods.
PeriodEstimate compared_period(const std::vector<double>& phases,
                               const std::vector<double>& reference, double period_ms,
                               const SharedTime& shared) {
  const double periods =
      (shared.end_ms - shared.begin_ms) / static_cast<double>(kWindows) / period_ms;
  std::vector<double> x;
  std::vector<double> y;
  for (std::size_t i = 0; i < kWindows; ++i) {
    const double difference = phases[i] - reference[i];
    if (std::isnan(difference)) continue;
    x.push_back((static_cast<double>(i) + 0.5) * periods);
    y.push_back(difference);
  }
  if (x.size() < kFewestWindows) return {};
  const FittedLine line = fit_line(x, y);
  double scatter = 0;
  double width = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double residual = y[i] - line.at(x[i]);
    scatter += residual * residual;
    width += (x[i] - line.mean_x) * (x[i] - line.mean_x);
  }
  const auto freedom = static_cast<double>(x.size() - 2);
  return {.period_ms = period_ms + line.slope,
          .sd_ppm = std::sqrt(scatter / freedom / width) / period_ms * 1e6,
          .freedom = freedom};
}

}  // namespace

std::optional<std::vector<PeriodEstimate>> relative_periods(
    std::span<const StreamFacts* const> cameras, std::span<const int> multiples) {
  if (cameras.size() < 2) return std::nullopt;
  const std::optional<SharedTime> shared = shared_time(cameras);
  const double period_ms = cameras[0]->host_period.period_ms / multiples[0];
  if (!shared || !(period_ms > 0)) return std::nullopt;
  const std::vector<double> reference =
      window_phases(*cameras[0], period_ms * multiples[0], *shared);
  std::vector<PeriodEstimate> periods = {
      {.period_ms = period_ms, .sd_ppm = 0, .freedom = cameras[0]->host_period.freedom}};
  for (std::size_t i = 1; i < cameras.size(); ++i) {
    const std::vector<double> phases =
        window_phases(*cameras[i], period_ms * multiples[i], *shared);
    periods.push_back(compared_period(phases, reference, period_ms, *shared));
    if (!(periods.back().period_ms > 0)) return std::nullopt;
  }
  return periods;
}

}  // namespace simbench::evaluation
