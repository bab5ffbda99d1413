#include "evaluation/scoring/pulse_spread.h"

#include <algorithm>
#include <cmath>

#include "evaluation/statistics/statistics.h"

namespace simbench::evaluation {
namespace {

constexpr double kMsPerNs = 1e-6;

// The median as a difference from `base`.
double median_above(std::int64_t base, MedianKind kind, std::vector<std::int64_t>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  const auto upper = static_cast<double>(*middle - base);
  if (kind == MedianKind::kUpperMiddle || values.size() % 2 == 1) return upper;
  const auto lower = static_cast<double>(*std::max_element(values.begin(), middle) - base);
  return (lower + upper) / 2;
}

}  // namespace

double spread_ms(std::span<const std::int64_t> stamps_ns) {
  const auto [least, greatest] = std::minmax_element(stamps_ns.begin(), stamps_ns.end());
  return static_cast<double>(*greatest - *least) * kMsPerNs;
}

Differences differences_from_median(std::span<const std::int64_t> stamps_ns, MedianKind kind,
                                    std::vector<std::int64_t>& workspace) {
  workspace.assign(stamps_ns.begin(), stamps_ns.end());
  const std::int64_t base = stamps_ns.front();
  const double median = median_above(base, kind, workspace);
  // Summed in the given order, so that the selection algorithm cannot change the result.
  double squares = 0;
  double sum = 0;
  for (const std::int64_t stamp : stamps_ns) {
    const double difference = static_cast<double>(stamp - base) - median;
    squares += difference * difference;
    sum += difference;
  }
  const auto count = static_cast<double>(stamps_ns.size());
  return {.deviation_ms = std::sqrt(squares / count) * kMsPerNs, .mean_ms = sum / count * kMsPerNs};
}

void PrintedRmdv::add(const Differences& pulse) {
  ++pulses_;
  if (pulse.mean_ms < 0) return;
  ++real_;
  sum_ += std::sqrt(pulse.mean_ms);
}

double PrintedRmdv::mean_sqrt_ms() const {
  return real_ > 0 ? sum_ / static_cast<double>(real_) : kNan;
}

double PrintedRmdv::real_share() const {
  return pulses_ > 0 ? static_cast<double>(real_) / static_cast<double>(pulses_) : kNan;
}

// The sum of squares is convex in the sorted stamps, so its maximum over all stamps of a given
// range is at a step: k of them at one end, n - k at the other, the median at either end or, for
// the mean of the middle two with k = n/2, halfway between.
double rmdv_bound(std::size_t n, MedianKind kind) {
  if (n < 2) return 0;
  const std::size_t lower_half = n / 2;
  const auto count = static_cast<double>(n);
  const auto half = static_cast<double>(lower_half);
  if (kind == MedianKind::kUpperMiddle || n % 2 == 1) return std::sqrt(half / count);
  return std::sqrt(std::max(half - 1, count / 4) / count);
}

}  // namespace simbench::evaluation
