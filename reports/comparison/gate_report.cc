// Writes the reports of a gate: text, Markdown, JSON, JUnit.
#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <utility>

#include "recording/collected.h"
#include "recording/text_fields.h"
#include "reports/comparison/gate.h"
#include "reports/results/json.h"
#include "reports/text/block.h"
#include "reports/text/escaped_text.h"
#include "reports/text/json_node.h"
#include "reports/text/metric_text.h"
#include "reports/text/number_text.h"
#include "reports/text/plain_text.h"

namespace simbench::reports {
namespace {

std::string gate_value(const GateCheck& check, double value) {
  if (!std::isfinite(value)) return "none";
  return difference_text(*check.metric, value);
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
  if (std::isnan(check.value) || std::isnan(check.baseline)) {
    if (std::isnan(check.value) && std::isnan(check.baseline)) return "neither exists";
    return std::isnan(check.value) ? "no longer exists" : "did not exist";
  }
  const double change = check.value - check.baseline;
  std::string text = fmt::format("{}{}", change > 0 ? "+" : "", gate_value(check, change));
  const double percent = 100 * change / std::abs(check.baseline);
  if (std::isfinite(percent) && !check.metric->is_share()) {
    text += fmt::format(" ({:+.3g} %)", percent);
  }
  return text;
}

// The evidence: changed seeds, lost values, the interval.
std::string evidence_text(const GateReport& report, const GateCheck& check) {
  std::string text;
  if (check.lost_seeds > 0) {
    text += fmt::format("; {} of {} lost their value", check.lost_seeds,
                        counted(report.seeds.count, "seed"));
  }
  if (report.mode == GateMode::kExact) {
    return text + fmt::format("; {} of {} changed", check.changed_seeds,
                              counted(report.seeds.count, "seed"));
  }
  return text +
         fmt::format("; {:.4g} % interval of the change {}, p {:.2g} after Holm's correction",
                     100 * check.confidence,
                     interval_text(*check.metric, check.difference.low, check.difference.high),
                     check.adjusted_p);
}

std::string outcome_text(GateOutcome outcome) {
  if (outcome == GateOutcome::kFailed) return "FAILED";
  return outcome == GateOutcome::kPossible ? "possibly worse" : outcome_name(outcome);
}

std::string gate_verdict(const GateReport& report) {
  const char* const mode = report.mode == GateMode::kExact ? "exact" : "statistical";
  if (report.passed()) {
    return fmt::format("gate passed: {}, {} of them the same ({})",
                       counted(report.checks.size(), "check"), report.count(GateOutcome::kSame),
                       mode);
  }
  const std::size_t failed = report.count(GateOutcome::kFailed) + report.vanished_pipelines.size();
  const std::size_t all = report.checks.size() + report.vanished_pipelines.size();
  return fmt::format("gate FAILED: {} of {} ({})", failed, counted(all, "check"), mode);
}

// What was compared with what, and what is changed in its world.
std::vector<std::string> gate_head(const GateReport& report) {
  std::vector<std::string> paragraphs = {fmt::format(
      "{}, {}: {} against the baseline {} (simbench {}, commit {})",
      scenarios::named(report.scenario, report.derivation), seeds_words(report), report.result_path,
      report.baseline_path, report.baseline_version, report.baseline_commit)};
  if (!report.derivation.changes.empty()) {
    paragraphs.push_back(scenarios::changed_text(report.derivation));
  }
  return paragraphs;
}

std::vector<std::string> failures(const GateReport& report) {
  std::vector<std::string> all;
  for (const std::string& name : report.vanished_pipelines) {
    all.push_back(
        fmt::format("FAILED: the pipeline {} of the baseline is not in the result", name));
  }
  for (const GateCheck& check : report.checks) {
    if (check.outcome != GateOutcome::kFailed) continue;
    all.push_back(fmt::format("FAILED: {}", check_text(report, check)));
  }
  return all;
}

// Exact mode shows all changes; statistical mode, where everything changes, significant ones.
bool is_shown(const GateReport& report, const GateCheck& check) {
  if (check.outcome == GateOutcome::kSame) return false;
  return report.mode == GateMode::kExact || check.outcome != GateOutcome::kChanged;
}

// Nothing: all is the same.
std::optional<Table> changes(const GateReport& report) {
  Table table({{"pipeline", Align::kLeft},
               {"metric", Align::kLeft},
               {"baseline"},
               {"now"},
               {"change"},
               {"allowed"},
               {"seeds\nchanged"},
               {.header = "outcome", .align = Align::kLeft, .is_verdict = true}},
              2);
  for (const GateCheck& check : report.checks) {
    if (!is_shown(report, check)) continue;
    table.add({check.pipeline, check.metric->title, gate_value(check, check.baseline),
               gate_value(check, check.value), change_text(check), gate_value(check, check.margin),
               fmt::format("{}", check.changed_seeds), outcome_text(check.outcome)});
  }
  if (table.rows.empty()) return std::nullopt;
  return table;
}

constexpr const char* kChangesHeading = "What changed";
constexpr const char* kNotesHeading = "Notes";
constexpr const char* kReproduceHeading = "To reproduce";

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
                     statistic_name(report, check), gate_value(check, check.value),
                     gate_value(check, check.baseline), change_text(check),
                     gate_value(check, check.margin), evidence_text(report, check));
}

std::string gate_text(const GateReport& report) {
  std::vector<std::string> head = gate_head(report);
  head.front() = fmt::format("{}. {}", gate_verdict(report), head.front());
  std::string text;
  for (const std::string& paragraph : head) text += wrapped(paragraph);
  const std::vector<std::string> failed = failures(report);
  if (!failed.empty()) text += "\n";
  for (const std::string& failure : failed) text += wrapped(failure, 2);
  if (const std::optional<Table> changed = changes(report)) {
    text += fmt::format("\n{}\n\n{}", kChangesHeading, plain(*changed));
  }
  if (!report.notes.empty()) text += fmt::format("\n{}\n", kNotesHeading);
  for (const std::string& note : report.notes) text += wrapped(note, 2);
  if (report.passed()) return text;
  text += fmt::format("\n{}\n", kReproduceHeading);
  for (const std::string& command : report.reproduce) text += fmt::format("  {}\n", command);
  return text;
}

std::string gate_markdown(const GateReport& report) {
  // Whatever names have in them, a text stays in its line.
  const auto lines = [](const std::vector<std::string>& texts) {
    return collected(texts, printable_name);
  };
  Document document{.title = fmt::format("{}: {}", report.scenario, gate_verdict(report)),
                    .head = lines(gate_head(report))};
  if (const std::vector<std::string> failed = failures(report); !failed.empty()) {
    document.blocks.push_back({.items = lines(failed)});
  }
  if (std::optional<Table> changed = changes(report)) {
    document.blocks.push_back({.heading = kChangesHeading, .table = std::move(changed)});
  }
  if (!report.notes.empty()) {
    document.blocks.push_back({.heading = kNotesHeading, .items = lines(report.notes)});
  }
  std::string text = markdown(document);
  if (report.passed()) return text;
  // Four blanks make lines of code, whatever is in them.
  text += fmt::format("\n### {}\n\n", kReproduceHeading);
  for (const std::string& command : report.reproduce) {
    text += fmt::format("    {}\n", printable_name(command));
  }
  return text;
}

namespace {

Json seeds_json(const SeedRange& seeds) { return {{"first", seeds.first}, {"count", seeds.count}}; }

Json check_json(const GateReport& report, const GateCheck& check) {
  Json result = {{"pipeline", check.pipeline},
                 {"metric", check.metric->id},
                 {"outcome", outcome_name(check.outcome)},
                 {"baseline", check.baseline},
                 {"value", check.value},
                 {"margin", check.margin},
                 {"changed_seeds", check.changed_seeds},
                 {"lost_seeds", check.lost_seeds},
                 {"message", check_text(report, check)}};
  if (report.mode == GateMode::kStatistical) {
    result["difference"] = {{"value", check.difference.value},
                            {"low", check.difference.low},
                            {"high", check.difference.high},
                            {"confidence", check.confidence}};
    result["adjusted_p"] = check.adjusted_p;
  }
  return result;
}

}  // namespace

std::string gate_json(const GateReport& report) {
  Json root = new_document();
  root["passed"] = report.passed();
  root["mode"] = report.mode == GateMode::kExact ? "exact" : "statistical";
  root["scenario"] = report.scenario;
  state_derivation(report.derivation, root);
  root.update({{"result", report.result_path},
               {"baseline",
                {{"path", report.baseline_path},
                 {"version", report.baseline_version},
                 {"commit", report.baseline_commit},
                 {"seeds", seeds_json(report.baseline_seeds)}}},
               {"seeds", seeds_json(report.seeds)},
               {"paired_by", report.by_index ? "index" : "seed"},
               {"checks", Json::array()},
               {"vanished_pipelines", report.vanished_pipelines},
               {"notes", report.notes},
               {"reproduce", report.reproduce}});
  for (const GateCheck& check : report.checks) root["checks"].push_back(check_json(report, check));
  return file_text(root);
}

namespace {

// `failure`: empty for a case that passed.
std::string test_case(const GateReport& report, const std::string& pipeline,
                      const std::string& name, const std::string& failure) {
  const std::string start = fmt::format(
      "    <testcase classname=\"{}\" name=\"{}\" time=\"0\"",
      html_escaped(fmt::format("{}.{}", report.scenario, pipeline)), html_escaped(name));
  if (failure.empty()) return fmt::format("{}/>\n", start);
  return fmt::format(
      "{}>\n      <failure message=\"{}\">{}\n\nTo reproduce:\n{}\n</failure>\n    </testcase>\n",
      start, html_escaped(failure), html_escaped(failure),
      html_escaped(fmt::format("{}", fmt::join(report.reproduce, "\n"))));
}

}  // namespace

std::string gate_junit(const GateReport& report) {
  std::string cases;
  for (const std::string& name : report.vanished_pipelines) {
    cases += test_case(report, name, "exists",
                       fmt::format("the pipeline {} of the baseline {} is not in the result {}",
                                   name, report.baseline_path, report.result_path));
  }
  for (const GateCheck& check : report.checks) {
    const bool failed = check.outcome == GateOutcome::kFailed;
    cases += test_case(report, check.pipeline, check.metric->title,
                       failed ? check_text(report, check) : "");
  }
  const std::size_t vanished = report.vanished_pipelines.size();
  const std::string counts =
      fmt::format("tests=\"{}\" failures=\"{}\" errors=\"0\" skipped=\"0\" time=\"0\"",
                  report.checks.size() + vanished, report.count(GateOutcome::kFailed) + vanished);
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites {}>\n  <testsuite "
      "name=\"{}\" {}>\n{}  </testsuite>\n</testsuites>\n",
      counts, html_escaped(fmt::format("simbench gate {}", report.scenario)), counts, cases);
}

}  // namespace simbench::reports
