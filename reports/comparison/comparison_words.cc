#include "reports/comparison/comparison_words.h"

#include <fmt/format.h>

#include <cmath>

#include "reports/text/number_text.h"

namespace simbench::reports {
namespace {

using evaluation::Estimate;
using evaluation::Metric;
using evaluation::PairedComparison;
using evaluation::Verdict;

bool is_sure(const PairedComparison& comparison) {
  return comparison.verdict == Verdict::kBetter || comparison.verdict == Verdict::kWorse;
}

// From a factor of two on, "times" reads better than percent.
std::string factor_words(const Estimate& ratio) {
  constexpr double kTimes = 2;
  if (ratio.value >= kTimes) {
    return fmt::format("{} times larger [{}, {}]", factor_text(ratio.value), factor_text(ratio.low),
                       factor_text(ratio.high));
  }
  if (ratio.value * kTimes <= 1 && ratio.low > 0) {
    return fmt::format("{} times smaller [{}, {}]", factor_text(1 / ratio.value),
                       factor_text(1 / ratio.high), factor_text(1 / ratio.low));
  }
  const bool is_larger = ratio.value >= 1;
  const double near = is_larger ? ratio.low : ratio.high;
  const double far = is_larger ? ratio.high : ratio.low;
  const auto percent = [](double share) { return factor_text(100 * std::abs(share - 1)); };
  return fmt::format("{} % {} [{} %, {} %]", percent(ratio.value), is_larger ? "larger" : "smaller",
                     percent(near), percent(far));
}

}  // namespace

std::string factor_text(double factor) {
  constexpr double kWhole = 999.5;  // rounds to four digits
  if (std::isnan(factor)) return "-";
  return std::abs(factor) < kWhole ? fmt::format("{:.3g}", factor) : fmt::format("{:.0f}", factor);
}

const char* verdict_name(Verdict verdict) {
  switch (verdict) {
    case Verdict::kBetter:
      return "better";
    case Verdict::kWorse:
      return "worse";
    case Verdict::kNoDifferenceSeen:
      return "no_difference_seen";
    case Verdict::kTooFewSeeds:
      return "too_few_seeds";
  }
  return "";
}

std::string verdict_text(const PairedComparison& comparison, double smallest_effect) {
  constexpr std::uint64_t kMany = 1'000'000;
  if (comparison.pairs == 0) return "no values";
  std::string text;
  if (comparison.verdict == Verdict::kNoDifferenceSeen) {
    const bool all_equal = comparison.difference.low == 0 && comparison.difference.high == 0;
    text = all_equal ? "no difference seen: all equal" : "no difference seen";
  } else if (is_sure(comparison)) {
    text = verdict_name(comparison.verdict);
    if (comparison.within_effect) {
      text += fmt::format(", by less than {:.3g} %", 100 * smallest_effect);
    }
  } else if (comparison.seeds_needed == 0) {
    text = "too few seeds: more needed";
  } else if (comparison.seeds_needed > kMany) {
    text = "too few seeds: over a million needed";
  } else {
    text = fmt::format("too few seeds: {} needed", comparison.seeds_needed);
  }
  if (comparison.left_out > 0) {
    text += fmt::format(" ({} {} left out: no value)", comparison.left_out,
                        comparison.left_out == 1 ? "seed" : "seeds");
  }
  return text;
}

double shown_value(const Metric& metric, double value) {
  constexpr double kPercent = 100;
  return metric.is_share() ? kPercent * value : value;
}

std::string shown_title(const Metric& metric) {
  return fmt::format("{} {}", metric.title, metric.is_share() ? "%" : metric.unit);
}

std::string effect_words(const Metric& metric, const PairedComparison& comparison,
                         double smallest_effect) {
  if (!is_sure(comparison)) {
    return fmt::format("{}: {}", metric.title, verdict_text(comparison, smallest_effect));
  }
  if (metric.is_share()) {
    return fmt::format("{} {} in place of {}", metric.title, share_text(comparison.mean_b),
                       share_text(comparison.mean_a));
  }
  if (std::isnan(comparison.ratio.low)) {
    return fmt::format("{} {} {} in place of {} {}", metric.title, number_text(comparison.mean_b),
                       metric.unit, number_text(comparison.mean_a), metric.unit);
  }
  return fmt::format("{} {}", metric.title, factor_words(comparison.ratio));
}

}  // namespace simbench::reports
