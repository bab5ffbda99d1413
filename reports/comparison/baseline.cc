#include "reports/comparison/baseline.h"

#include <fmt/format.h>

#include <set>

#include "reports/comparison/comparison_scenarios.h"
#include "reports/text/json_node.h"
#include "reports/text/output_file.h"
#include "scenarios/loader.h"

namespace simbench::reports {
namespace {

using evaluation::judged_metrics;

constexpr const char* kKind = "simbench baseline";
constexpr const char* kEdited =
    "only margins may be edited by hand; write a baseline with `simbench gate RESULT "
    "--save-baseline FILE`";

// Rounds to 12 digits, so that JSON writes no more.
double rounded(double value) { return std::stod(fmt::format("{:.12g}", value)); }

Json values_json(const std::vector<double>& values) {
  Json all = Json::array();
  for (const double value : values) all.push_back(rounded(value));
  return all;
}

Json pipelines_json(const Baseline& baseline) {
  Json all = Json::array();
  for (const BaselinePipeline& pipeline : baseline.pipelines) {
    Json entry = {{"pipeline", pipeline.name}};
    for (std::size_t i = 0; i < pipeline.values.size(); ++i) {
      entry[baseline.judged[i]->id] = values_json(pipeline.values[i]);
    }
    all.push_back(std::move(entry));
  }
  return all;
}

Json margins_json(const Baseline& baseline) {
  Json all;
  for (std::size_t i = 0; i < baseline.margins.size(); ++i) {
    const evaluation::GateMargin& margin = baseline.margins[i];
    all[baseline.judged[i]->id] = {{"relative", margin.relative}, {"absolute", margin.absolute}};
  }
  return all;
}

// The members of the object, a line each, after `indent` blanks; without its braces.
std::string object_lines(const Json& object, std::size_t indent) {
  std::vector<std::string> members;
  for (const auto& [key, value] : object.items()) {
    members.push_back(fmt::format("{:{}}{}: {}", "", indent, Json(key).dump(), value.dump()));
  }
  return fmt::format("{}", fmt::join(members, ",\n"));
}

evaluation::GateMargin read_margin(const JsonNode& node) {
  const evaluation::GateMargin margin{.relative = node["relative"].number(),
                                      .absolute = node["absolute"].number()};
  if (!(margin.relative >= 0)) node["relative"].refuse("a number from 0, a share of the value");
  if (!(margin.absolute >= 0)) node["absolute"].refuse("a number from 0, in the metric's unit");
  return margin;
}

BaselinePipeline read_pipeline(const JsonNode& node, const Baseline& baseline) {
  const std::size_t seeds = baseline.seeds.count;
  BaselinePipeline pipeline{.name = node["pipeline"].text(), .values = {}};
  for (const evaluation::Metric* metric : baseline.judged) {
    pipeline.values.push_back(node[metric->id].values_of(*metric, seeds));
  }
  return pipeline;
}

void check_digest(const JsonNode& root, const char* digest, const char* member) {
  if (root[digest].text() == digest_of_json(root[member].dump())) return;
  root[digest].fail(fmt::format("is not that of /{}; {}", member, kEdited));
}

}  // namespace

Baseline make_baseline(const Archive& archive) {
  if (archive.scenario_json.empty()) {
    throw scenarios::InputError(fmt::format(
        "{}: a results.json alone does not hold its scenario, which a baseline needs; name the "
        "folder that `simbench run --output DIR` wrote",
        archive.path));
  }
  Baseline baseline{.kind = archive.results.kind,
                    .clock_period = archive.results.clock_period,
                    .path = {},
                    .version = archive.version,
                    .commit = archive.commit,
                    .scenario = archive.results.scenario,
                    .scenario_json = archive.scenario_json,
                    .seeds = seeds_of(archive.results),
                    .margins = {},
                    .pipelines = {}};
  std::vector<const evaluation::Row*> rows;
  rows.reserve(archive.results.rows.size());
  for (const evaluation::Row& row : archive.results.rows) rows.push_back(&row);
  baseline.judged = judged_metrics(baseline.kind, rows);
  for (const evaluation::Metric* metric : baseline.judged) {
    baseline.margins.push_back(metric->judged->margin);
  }
  for (const evaluation::Row& row : archive.results.rows) {
    BaselinePipeline pipeline{.name = row.pipeline, .values = {}};
    for (const evaluation::Metric* metric : baseline.judged) {
      pipeline.values.push_back(metric->series(row).values);
    }
    baseline.pipelines.push_back(std::move(pipeline));
  }
  return baseline;
}

std::string baseline_json(const Baseline& baseline) {
  const Json scenario = Json::parse(baseline.scenario_json);
  const Json pipelines = pipelines_json(baseline);
  Json head = {{"schema_version", kBaselineSchemaVersion},
               {"kind", kKind},
               {"version", baseline.version},
               {"commit", baseline.commit},
               {"scenario", baseline.scenario},
               {"seeds", {{"first", baseline.seeds.first}, {"count", baseline.seeds.count}}},
               {"scenario_digest", digest_of_json(scenario.dump())},
               {"pipelines_digest", digest_of_json(pipelines.dump())}};
  if (baseline.kind == evaluation::ResultKind::kClockRuns) {
    head.update({{"results", kClockRunsName},
                 {"from_s", baseline.clock_period.from_s},
                 {"duration_s", baseline.clock_period.duration_s}});
  }
  std::vector<std::string> rows;
  for (const Json& pipeline : pipelines) {
    rows.push_back(fmt::format("    {{\n{}\n    }}", object_lines(pipeline, 6)));
  }
  return fmt::format(
      "{{\n{},\n  \"margins\": {{\n{}\n  }},\n  \"resolved_scenario\": {{\n{}\n  }},\n"
      "  \"pipelines\": [\n{}\n  ]\n}}\n",
      object_lines(head, 2), object_lines(margins_json(baseline), 4), object_lines(scenario, 4),
      fmt::join(rows, ",\n"));
}

void write_baseline(const Baseline& baseline, const std::string& path) {
  write_file(path, baseline_json(baseline));
}

Baseline read_baseline(const std::string& path) {
  const JsonFile file = read_json_file(path, kEdited);
  const JsonNode root(file, file.value);
  if (root["kind"].text() != kKind) root["kind"].refuse(fmt::format("'{}'; {}", kKind, kEdited));
  root.check_schema_version(kBaselineSchemaVersion);
  Baseline baseline;
  baseline.path = path;
  baseline.kind = read_result_kind(root, "results");
  baseline.clock_period = read_clock_period(root, baseline.kind);
  baseline.version = root["version"].text();
  baseline.commit = root["commit"].text();
  baseline.scenario = root["scenario"].text();
  baseline.scenario_json = root["resolved_scenario"].dump();
  baseline.seeds = {static_cast<std::uint64_t>(root["seeds"]["first"].count()),
                    static_cast<std::uint64_t>(root["seeds"]["count"].count())};
  if (baseline.seeds.count == 0) root["seeds"]["count"].refuse("a whole number from 1");
  for (const evaluation::Metric* metric : judged_metrics(baseline.kind)) {
    if (metric->is_new && !root["margins"].has(metric->id)) continue;
    baseline.judged.push_back(metric);
    baseline.margins.push_back(read_margin(root["margins"][metric->id]));
  }
  std::set<std::string> names;
  for (const JsonNode& node : root["pipelines"].elements()) {
    baseline.pipelines.push_back(read_pipeline(node, baseline));
    if (!names.insert(baseline.pipelines.back().name).second) {
      node["pipeline"].refuse("each pipeline once");
    }
  }
  if (baseline.pipelines.empty()) root["pipelines"].refuse("at least one pipeline");
  check_digest(root, "scenario_digest", "resolved_scenario");
  check_digest(root, "pipelines_digest", "pipelines");
  return baseline;
}

}  // namespace simbench::reports
