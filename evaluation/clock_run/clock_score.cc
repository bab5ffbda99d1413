#include "evaluation/clock_run/clock_score.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "algorithms/ports/assert.h"
#include "evaluation/statistics/statistics.h"

namespace simbench::evaluation {
namespace {

constexpr std::array<double, 3> kBoundsMs = {1, 0.1, 0.01};
// A spread is below a bound for good only if the last of so many parts of a run saw it there.
constexpr std::int64_t kLeastRest = 10;

// The curve over all clocks: combine() adds a clock's value to the sum so far, finish() makes the
// value of the sum over so many clocks.
template <class Combine, class Finish>
std::vector<StabilityPoint> pool(std::span<const StabilityCurves> clocks,
                                 std::vector<StabilityPoint> StabilityCurves::*curve,
                                 Combine combine, Finish finish) {
  std::vector<StabilityPoint> all;
  std::vector<double> counts;
  for (const StabilityCurves& clock : clocks) {
    const std::vector<StabilityPoint>& points = clock.*curve;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (i == all.size()) {
        all.push_back({.tau_s = points[i].tau_s});
        counts.push_back(0);
      }
      all[i].value = combine(all[i].value, points[i].value);
      all[i].terms += points[i].terms;
      ++counts[i];
    }
  }
  for (std::size_t i = 0; i < all.size(); ++i) all[i].value = finish(all[i].value, counts[i]);
  return all;
}

std::vector<StabilityPoint> rms(std::span<const StabilityCurves> clocks,
                                std::vector<StabilityPoint> StabilityCurves::*curve) {
  return pool(
      clocks, curve, [](double sum, double value) { return sum + value * value; },
      [](double sum, double count) { return std::sqrt(sum / count); });
}

std::vector<StabilityPoint> largest(std::span<const StabilityCurves> clocks,
                                    std::vector<StabilityPoint> StabilityCurves::*curve) {
  return pool(
      clocks, curve, [](double most, double value) { return std::max(most, value); },
      [](double most, double) { return most; });
}

// Every slave's clock over the readings.
StabilityCurves curves_of(const ClockReadings& readings) {
  std::vector<StabilityCurves> slaves;
  for (std::size_t host = 1; host < readings.errors_s.size(); ++host) {
    slaves.push_back(stability_curves(
        {.interval_s = readings.interval_s,
         .pieces = {{.start_s = readings.start_s, .x_s = readings.errors_s[host]}}}));
  }
  return pooled(slaves);
}

// Whole seconds are whole, which a product with 1e-9 does not give.
double exact_seconds(Nanoseconds span) { return to_ns(span) / 1e9; }

double spread_of(std::span<const double> errors_s) {
  const auto [least, greatest] = std::minmax_element(errors_s.begin(), errors_s.end());
  return (*greatest - *least) * 1e3;
}

// The errors are of one clock, in seconds.
HostTe te_of(std::vector<double> errors_s) {
  std::ranges::sort(errors_s);
  HostTe te{.median_ms = 1e3 * quantile_of_sorted(errors_s, 0.5),
            .sd_ms = 1e3 * standard_deviation(errors_s)};
  for (double& error_s : errors_s) error_s = std::abs(error_s);
  std::ranges::sort(errors_s);
  te.median_abs_ms = 1e3 * quantile_of_sorted(errors_s, 0.5);
  te.p95_abs_ms = 1e3 * quantile_of_sorted(errors_s, 0.95);
  return te;
}

double largest_ms(std::span<const double> errors_s) {
  double largest = 0;
  for (const double error : errors_s) largest = std::max(largest, std::abs(error));
  return largest * 1e3;
}

}  // namespace

StabilityCurves pooled(std::span<const StabilityCurves> curves) {
  StabilityCurves all;
  for (const ClockCurve& curve : clock_curves()) {
    const bool is_largest = curve.points == &StabilityCurves::mtie_ms;
    all.*curve.points = is_largest ? largest(curves, curve.points) : rms(curves, curve.points);
  }
  return all;
}

ClockScorer::ClockScorer(const ClockSpan& span) : span_(span), errors_(span.hosts) {
  SIMBENCH_ASSERT(span.duration >= span.from + kReadingInterval, "two readings at least");
  kept_.start_s = exact_seconds(span.from);
  kept_.interval_s = exact_seconds(kReadingInterval);
  kept_.errors_s.resize(span.hosts);
}

void ClockScorer::on_errors(TrueTime at, std::span<const double> errors_s) {
  const Nanoseconds since_start = at - TrueTime{};
  const double spread_ms = spread_of(errors_s);
  if (since_start > span_.duration) {
    watch_loss(since_start - span_.duration, errors_s, spread_ms);
    return;
  }
  for (std::size_t i = 0; i < kBoundsMs.size(); ++i) {
    if (spread_ms >= kBoundsMs[i]) last_above_[i] = at;
  }
  if (since_start >= span_.from) measure(errors_s, spread_ms);
}

void ClockScorer::measure(std::span<const double> errors_s, double spread_ms) {
  spread_sum_ms_ += spread_ms;
  spread_max_ms_ = std::max(spread_max_ms_, spread_ms);
  for (std::size_t host = 1; host < errors_s.size(); ++host) {
    errors_.add(host, errors_s[host] * 1e3);
  }
  if (measured_++ % stride_ != 0) return;
  if (spreads_ms_.size() == kMostReadings) halve();
  if ((measured_ - 1) % stride_ != 0) return;
  spreads_ms_.push_back(spread_ms);
  for (std::size_t host = 0; host < errors_s.size(); ++host) {
    kept_.errors_s[host].push_back(errors_s[host]);
  }
  master_s_.push_back(master_error_s_);
}

// Keeps every second reading from now on, and of those kept.
void ClockScorer::halve() {
  const auto every_second = [](std::vector<double>& values) {
    for (std::size_t i = 0; 2 * i < values.size(); ++i) values[i] = values[2 * i];
    values.resize((values.size() + 1) / 2);
  };
  every_second(spreads_ms_);
  for (std::vector<double>& errors_s : kept_.errors_s) every_second(errors_s);
  every_second(master_s_);
  stride_ *= 2;
  kept_.interval_s *= 2;
}

void ClockScorer::watch_loss(Nanoseconds since_loss, std::span<const double> errors_s,
                             double spread_ms) {
  if (since_loss == std::chrono::seconds(60)) holdover_60_ms_ = largest_ms(errors_s);
  if (since_loss == kMasterLostFor) holdover_600_ms_ = largest_ms(errors_s);
  if (since_loss < kMasterLostFor) return;
  if (!last_apart_) last_apart_ = Nanoseconds(0);
  if (spread_ms > spread_max_ms_) last_apart_ = since_loss - kMasterLostFor + kReadingInterval;
}

// A place for each host all the same.
ClockScore ClockScorer::without_values() {
  ClockScore score;
  score.host_errors_ms.assign(span_.hosts, kNan);
  score.to_truth.resize(span_.hosts);
  score.pairs.resize(span_.hosts);
  score.failures = failures_.take();
  score.program_failures = std::move(program_failures_);
  score.readings.errors_s.resize(span_.hosts);
  return score;
}

ClockScore ClockScorer::finish(std::uint64_t messages) {
  if (!program_failures_.empty()) return without_values();
  ClockScore score;
  MetricValues<double>& values = score.values;
  values.clock_spread_ms = spread_sum_ms_ / static_cast<double>(measured_);
  std::sort(spreads_ms_.begin(), spreads_ms_.end());
  values.clock_spread_median_ms = quantile_of_sorted(spreads_ms_, 0.5);
  values.clock_spread_p95_ms = quantile_of_sorted(spreads_ms_, 0.95);
  values.clock_spread_max_ms = spread_max_ms_;
  errors_.add_to(values);
  score.host_errors_ms = errors_.means_ms();
  const auto below_s = [&](std::size_t bound) {
    if (!last_above_[bound]) return 0.0;
    const Nanoseconds since_start = *last_above_[bound] + kReadingInterval - TrueTime{};
    return span_.duration - since_start < span_.duration / kLeastRest ? kNan
                                                                      : exact_seconds(since_start);
  };
  values.below_1_ms_s = below_s(0);
  values.below_0_1_ms_s = below_s(1);
  values.below_0_01_ms_s = below_s(2);
  values.holdover_60_ms = holdover_60_ms_;
  values.holdover_600_ms = holdover_600_ms_;
  if (last_apart_ && *last_apart_ <= kRecovery) values.recovery_s = exact_seconds(*last_apart_);
  values.packets_per_s = static_cast<double>(messages) / exact_seconds(span_.duration);
  const std::vector<double>& reference_s = kept_.errors_s.at(span_.pairs_with);
  for (std::vector<double> errors_s : kept_.errors_s) {
    std::vector<double> pair_s = errors_s;
    for (std::size_t i = 0; i < pair_s.size(); ++i) pair_s[i] -= reference_s[i];
    score.pairs.push_back(te_of(std::move(pair_s)));
    for (std::size_t i = 0; i < errors_s.size(); ++i) errors_s[i] += master_s_[i];
    score.to_truth.push_back(te_of(std::move(errors_s)));
  }
  score.failures = failures_.take();
  score.curves = curves_of(kept_);
  score.readings = std::move(kept_);
  return score;
}

}  // namespace simbench::evaluation
