// What a gate found, for programs.
#include <nlohmann/json.hpp>

#include "recording/version.h"
#include "reports/comparison/gate.h"

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

}  // namespace simbench::reports
