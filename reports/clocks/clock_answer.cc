
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "evaluation/answer/answer.h"
#include "evaluation/clock_run/clock_causes.h"
#include "recording/counted.h"
#include "reports/clocks/clock_report.h"
#include "reports/results/results_answer.h"
#include "reports/text/number_text.h"
#include "reports/text/time_text.h"

namespace simbench::reports {
namespace {

using evaluation::Answer;
using evaluation::ClockCause;
using evaluation::ClockCauses;
using evaluation::Row;

constexpr double kMostlyConstant = 0.5;  // of the largest time error
constexpr std::size_t kNamedCauses = 3;

std::string closest_sentence(const Answer& answer) {
  const Row& best = *answer.best;
  const std::string place =
      answer.ranked == 1
          ? " is the only host_sync here that a rig can run, and keeps the clocks"
          : fmt::format("{} keeps the clocks closest together of the {} that a rig can run{}",
                        certainty_clause(answer), answer.ranked,
                        answer.seeds_needed > 0 ? ", in too few seeds for a verdict" : "");
  return fmt::format("{}{}: {} apart, mean in time (5-95 %: {}).", best.pipeline, place,
                     time_text(best.clock_spread_ms.median),
                     time_band_text(best.clock_spread_ms.p05, best.clock_spread_ms.p95));
}

// "within 1 ms for good 8.00 s after the cold start".
std::string in_sync_sentence(const Row& row) {
  const struct {
    const evaluation::Series& seconds;
    const char* bound;
  } bounds[] = {
      {row.below_0_01_ms_s, "10 us"}, {row.below_0_1_ms_s, "0.1 ms"}, {row.below_1_ms_s, "1 ms"}};
  for (const auto& [seconds, bound] : bounds) {
    const double median_s = evaluation::median_time(seconds.values);
    if (std::isnan(median_s)) continue;
    return fmt::format(
        "Within {} for good {} after the cold start; the largest error of a host is {}.", bound,
        time_text(1000 * median_s), time_text(row.max_te_ms.median));
  }
  return fmt::format(
      "No: half of the seeds or more never stay within 1 ms; the largest "
      "error of a host is {}.",
      time_text(row.max_te_ms.median));
}

// Says what the error looks like, which is no cause, where nobody asked for causes.
std::string kind_of_error_sentence(const Row& row) {
  const double share = row.constant_te_ms.median / row.max_te_ms.median;
  if (!std::isfinite(share)) return "";
  return share > kMostlyConstant
             ? fmt::format("Mostly constant, {} in a host: unequal paths there and back look so.",
                           time_text(row.constant_te_ms.median))
             : fmt::format("Mostly moving, by up to {} in a host; the constant part is {}.",
                           time_text(row.dynamic_te_ms.median),
                           time_text(row.constant_te_ms.median));
}

std::string cause_sentence(const ClockCause& cause) {
  const bool is_spread = cause.spread_effect() >= cause.largest_effect();
  return fmt::format(
      "Without {}: {}.", cause.what,
      is_spread ? "mean spread " + time_change_text(cause.spread_from_ms, cause.spread_to_ms)
                : "largest error of a host " +
                      time_change_text(cause.largest_from_ms, cause.largest_to_ms));
}

// What alone makes nearly all of the error; nothing: no cause does.
std::optional<std::string> dominant_cause_text(const ClockCauses& causes) {
  constexpr double kNearlyAll = 0.9;
  if (causes.found.empty() || causes.found.front().effect() < kNearlyAll) return std::nullopt;
  return cause_sentence(causes.found.front());
}

std::string found_causes_text(const ClockCauses& causes) {
  if (causes.found.empty()) {
    return fmt::format("Nothing alone, by {:g} % or more: {}.", 100 * evaluation::kLeastEffect,
                       fmt::join(causes.tried, ", "));
  }
  std::string text;
  const std::size_t first = dominant_cause_text(causes) ? 1 : 0;  // that is in the lead
  for (std::size_t i = first; i < std::min(kNamedCauses, causes.found.size()); ++i) {
    text += cause_sentence(causes.found[i]) + " ";
  }
  if (text.empty()) {
    text = fmt::format("No other one alone by {:g} % or more. ", 100 * evaluation::kLeastEffect);
  }
  return fmt::format("{}(Means over {}.)", text, counted(causes.seeds, "seed"));
}

// Says what limits it, by runs without each cause.
std::string causes_text(const ClockCauses& causes) {
  if (causes.tried.empty()) return "";
  std::string text = found_causes_text(causes);
  if (!causes.refused.empty()) {
    text += fmt::format(" Not tried: {}.", fmt::join(causes.refused, "; "));
  }
  return text;
}

std::string without_master_sentence(const Row& row) {
  if (std::isnan(row.holdover_600_ms.median)) return "";
  const double recovery_s = evaluation::median_time(row.recovery_s.values);
  return fmt::format(
      "Without its master a host is {} off after 60 s, {} after 600 s; {}.",
      time_text(row.holdover_60_ms.median), time_text(row.holdover_600_ms.median),
      std::isnan(recovery_s) ? "then half of the seeds or more do not recover within an hour"
      : recovery_s == 0      ? "then it is right at once"
                        : fmt::format("then it recovers within {}", time_text(1000 * recovery_s)));
}

}  // namespace

AnswerText clock_answer(const evaluation::ClockResults& results) {
  return clock_answer(results.results, evaluation::answer_of(results.results), results.causes);
}

AnswerText clock_answer(const evaluation::Results& results) {
  return clock_answer(results, evaluation::answer_of(results), {});
}

AnswerText clock_answer(const evaluation::Results& results, const Answer& answer,
                        const ClockCauses& causes) {
  if (answer.best == nullptr) {
    AnswerText none{.lead = "No host_sync that a rig can run has a result here."};
    none.add("Failed", failed_text(answer));
    return none;
  }
  AnswerText text{.lead = closest_sentence(answer)};
  if (const auto dominant = dominant_cause_text(causes)) text.lead += " " + *dominant;
  text.add("Others", distance_text(results, answer));
  text.add("Failed", failed_text(answer));
  text.add("In sync?", in_sync_sentence(*answer.best));
  text.add("Causes", causes_text(causes));
  if (causes.tried.empty()) text.add("Error", kind_of_error_sentence(*answer.best));
  text.add("Load", load_text(results));
  text.add("Holdover", without_master_sentence(*answer.best));
  text.add("Cost", fmt::format("It sends {} packets per second.",
                               number_text(answer.best->packets_per_s.median)));
  text.add("Uncertain", uncertainty_text(answer));
  return text;
}

}  // namespace simbench::reports
