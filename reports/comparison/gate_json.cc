#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "recording/version.h"
#include "reports/comparison/gate.h"
#include "scenarios/document.h"

namespace simbench::reports {
namespace {

using Json = nlohmann::ordered_json;  // keeps members in order; writes NaN as null

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
  Json root = {{"schema_version", 1},
               {"version", version()},
               {"commit", commit()},
               {"passed", report.passed()},
               {"mode", report.mode == GateMode::kExact ? "exact" : "statistical"},
               {"scenario", report.scenario},
               {"result", report.result_path},
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
               {"reproduce", report.reproduce}};
  for (const GateCheck& check : report.checks) root["checks"].push_back(check_json(report, check));
  return root.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

namespace {

// `failure` is empty for a case that passed.
std::string test_case(const GateReport& report, const std::string& pipeline,
                      const std::string& name, const std::string& failure) {
  const std::string start =
      fmt::format("    <testcase classname=\"{}\" name=\"{}\" time=\"0\"",
                  xml_text(fmt::format("{}.{}", report.scenario, pipeline)), xml_text(name));
  if (failure.empty()) return fmt::format("{}/>\n", start);
  return fmt::format(
      "{}>\n      <failure message=\"{}\">{}\n\nTo reproduce:\n{}\n</failure>\n    </testcase>\n",
      start, xml_text(failure), xml_text(failure),
      xml_text(fmt::format("{}", fmt::join(report.reproduce, "\n"))));
}

}  // namespace

std::string xml_text(std::string_view text) {
  const std::string whole(text);
  std::string escaped;
  for (const char letter : scenarios::is_utf8(whole) ? whole : std::string(text.size(), '?')) {
    const bool is_control = static_cast<unsigned char>(letter) < ' ' && letter != '\n';
    if (letter == '&') {
      escaped += "&amp;";
    } else if (letter == '<') {
      escaped += "&lt;";
    } else if (letter == '>') {
      escaped += "&gt;";
    } else if (letter == '"') {
      escaped += "&quot;";
    } else {
      escaped += is_control ? '?' : letter;
    }
  }
  return escaped;
}

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
      counts, xml_text(fmt::format("simbench gate {}", report.scenario)), counts, cases);
}

}  // namespace simbench::reports
