// What a gate found, for people.
#include <fmt/format.h>

#include <cmath>

#include "reports/comparison/comparison_words.h"
#include "reports/comparison/gate.h"
#include "reports/text/block.h"
#include "reports/text/number_text.h"
#include "reports/text/plain_text.h"

namespace simbench::reports {
namespace {

const char* unit_of(const GateCheck& check) {
  return check.metric->is_share() ? "%" : check.metric->unit;
}

std::string value_text(const GateCheck& check, double value) {
  return fmt::format("{} {}", number_text(shown_value(*check.metric, value)), unit_of(check));
}

const char* statistic_name(const GateReport& report, const GateCheck& check) {
  const bool is_mean = report.mode == GateMode::kStatistical || check.metric->is_share();
  return is_mean ? "mean" : "median";
}

std::string seeds_words(const GateReport& report) {
  if (!report.by_index) return fmt::format("seeds {}", seeds_text(report.seeds));
  return fmt::format("seeds {} against {}", seeds_text(report.seeds),
                     seeds_text(report.baseline_seeds));
}

std::string change_text(const GateCheck& check) {
  const double change = check.value - check.baseline;
  std::string text = fmt::format("{}{}", change > 0 ? "+" : "", value_text(check, change));
  if (check.baseline != 0 && !check.metric->is_share()) {
    text += fmt::format(" ({:+.3g} %)", 100 * change / std::abs(check.baseline));
  }
  return text;
}

// What there is beside the values: seeds that changed, values that vanished, the interval.
std::string evidence_text(const GateReport& report, const GateCheck& check) {
  std::string text;
  if (check.lost_seeds > 0) {
    text += fmt::format("; {} of {} seeds have no value any more", check.lost_seeds,
                        report.seeds.count);
  }
  if (report.mode == GateMode::kExact) {
    return text + fmt::format("; {} of {} seeds changed", check.changed_seeds, report.seeds.count);
  }
  return text +
         fmt::format(
             "; {:.4g} % interval of the change [{}, {}], p {:.2g} after Holm's correction",
             100 * check.confidence, number_text(shown_value(*check.metric, check.difference.low)),
             number_text(shown_value(*check.metric, check.difference.high)), check.adjusted_p);
}

std::string outcome_text(GateOutcome outcome) {
  if (outcome == GateOutcome::kFailed) return "FAILED";
  return outcome == GateOutcome::kPossible ? "possibly worse" : outcome_name(outcome);
}

std::string gate_head(const GateReport& report) {
  const std::size_t failed = report.count(GateOutcome::kFailed) + report.vanished_pipelines.size();
  const std::string verdict =
      report.passed() ? fmt::format("gate passed: {} checks, {} of them the same",
                                    report.checks.size(), report.count(GateOutcome::kSame))
                      : fmt::format("gate FAILED: {} of {} checks", failed,
                                    report.checks.size() + report.vanished_pipelines.size());
  return wrapped(fmt::format("{} ({}). {}, {}: {} against the baseline {} (simbench {}, commit {})",
                             verdict, report.mode == GateMode::kExact ? "exact" : "statistical",
                             report.scenario, seeds_words(report), report.result_path,
                             report.baseline_path, report.baseline_version,
                             report.baseline_commit));
}

std::string failures(const GateReport& report) {
  std::string text;
  for (const std::string& name : report.vanished_pipelines) {
    text += wrapped(
        fmt::format("FAILED: the pipeline {} of the baseline is not in the result", name), 2);
  }
  for (const GateCheck& check : report.checks) {
    if (check.outcome != GateOutcome::kFailed) continue;
    text += wrapped(fmt::format("FAILED: {}", check_text(report, check)), 2);
  }
  return text.empty() ? text : "\n" + text;
}

// In exact mode what changed; in statistical mode, where nothing is ever the same, what counts.
bool is_shown(const GateReport& report, const GateCheck& check) {
  if (check.outcome == GateOutcome::kSame) return false;
  return report.mode == GateMode::kExact || check.outcome != GateOutcome::kChanged;
}

std::string changes(const GateReport& report) {
  Table table({{"pipeline", Align::kLeft},
               {"metric", Align::kLeft},
               {"baseline"},
               {"now"},
               {"change"},
               {"allowed"},
               {"seeds\nchanged"},
               {"outcome", Align::kLeft}});
  bool is_empty = true;
  for (const GateCheck& check : report.checks) {
    if (!is_shown(report, check)) continue;
    is_empty = false;
    table.add({check.pipeline, check.metric->title, value_text(check, check.baseline),
               value_text(check, check.value), change_text(check), value_text(check, check.margin),
               fmt::format("{}", check.changed_seeds), outcome_text(check.outcome)});
  }
  return is_empty ? "" : "\nWhat changed\n\n" + plain(table);
}

std::string lines(const char* title, const std::vector<std::string>& texts) {
  if (texts.empty()) return "";
  std::string all = fmt::format("\n{}\n", title);
  for (const std::string& text : texts) all += fmt::format("  {}\n", text);
  return all;
}

}  // namespace

const char* outcome_name(GateOutcome outcome) {
  switch (outcome) {
    case GateOutcome::kSame:
      return "same";
    case GateOutcome::kChanged:
      return "changed";
    case GateOutcome::kBetter:
      return "better";
    case GateOutcome::kPossible:
      return "possibly_worse";
    case GateOutcome::kFailed:
      return "failed";
  }
  return "";
}

std::string check_text(const GateReport& report, const GateCheck& check) {
  return fmt::format("{} of {} in {}, {}: {} {}, was {}: {}, allowed {}{}", check.metric->title,
                     check.pipeline, report.scenario, seeds_words(report),
                     statistic_name(report, check), value_text(check, check.value),
                     value_text(check, check.baseline), change_text(check),
                     value_text(check, check.margin), evidence_text(report, check));
}

std::string gate_text(const GateReport& report) {
  std::string notes;
  for (const std::string& note : report.notes) notes += wrapped(note, 2);
  return gate_head(report) + failures(report) + changes(report) +
         (notes.empty() ? notes : "\nNotes\n" + notes) +
         (report.passed() ? "" : lines("To reproduce", report.reproduce));
}

}  // namespace simbench::reports
