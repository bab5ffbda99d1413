#include "reports/recordings/measured_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "evaluation/statistics/statistics.h"
#include "recording/version.h"
#include "reports/text/json_node.h"
#include "reports/text/output_file.h"

namespace simbench::reports {
namespace {

using evaluation::Results;
using evaluation::Row;

constexpr int kSchemaVersion = 1;
constexpr const char* kStudyAdvice =
    "`simbench validate-model` explains how to measure and keep one";

// A row of programs that ended has failed, whatever the other repetitions have.
MeasuredPipeline measured_pipeline(const Row& row) {
  MeasuredPipeline pipeline{.pipeline = row.pipeline, .seeds = {}, .notes = row.notes};
  for (const evaluation::SeedScore& score : row.seeds) {
    if (!score.recorded || !row.program_failures.empty()) continue;
    MeasuredSeed& seed = pipeline.seeds.emplace_back();
    seed.seed = score.seed;
    for (const char* id : evaluation::kGapMetrics) {
      evaluation::metric(id).of_seed(seed) = evaluation::metric(id).of_seed(score);
    }
  }
  return pipeline;
}

MeasuredSeed read_seed(const JsonNode& node, std::set<std::uint64_t>& known) {
  MeasuredSeed seed;
  seed.seed = static_cast<std::uint64_t>(node["seed"].count());
  if (!known.insert(seed.seed).second)
    node["seed"].fail(fmt::format("{} is there twice", seed.seed));
  for (const char* id : evaluation::kGapMetrics) {
    const JsonNode value = node[id];
    evaluation::metric(id).of_seed(seed) = value.number();
    if (value.number() < 0) value.refuse("a number from 0, or null");
  }
  return seed;
}

MeasuredPipeline read_measured_pipeline(const JsonNode& node, std::set<std::string>& known) {
  MeasuredPipeline pipeline;
  pipeline.pipeline = node["pipeline"].text();
  if (!known.insert(pipeline.pipeline).second) {
    node["pipeline"].fail(fmt::format("'{}' is there twice", pipeline.pipeline));
  }
  std::set<std::uint64_t> seeds;
  for (const JsonNode& seed : node["seeds"].elements()) {
    pipeline.seeds.push_back(read_seed(seed, seeds));
  }
  if (!node.has("notes")) return pipeline;
  for (const JsonNode& note : node["notes"].elements()) pipeline.notes.push_back(note.text());
  return pipeline;
}

}  // namespace

MeasuredStudy measured_study(const Results& results, const std::string& date,
                             const std::string& machine) {
  MeasuredStudy study{.date = date,
                      .machine = machine,
                      .scenario = results.scenario,
                      .commit = std::string(commit()),
                      .changed = scenarios::changed_text(results.derivation),
                      .rows = {}};
  for (const Row& row : results.rows) study.rows.push_back(measured_pipeline(row));
  return study;
}

Results results_of(const MeasuredStudy& study) {
  Results results;
  results.scenario = study.scenario;
  for (const MeasuredPipeline& pipeline : study.rows) {
    Row row;
    row.pipeline = pipeline.pipeline;
    row.notes = pipeline.notes;
    for (const char* id : evaluation::kGapMetrics) {
      const evaluation::Metric& metric = evaluation::metric(id);
      std::vector<double> values;
      for (const MeasuredSeed& seed : pipeline.seeds) values.push_back(metric.of_seed(seed));
      metric.series(row) = evaluation::make_series(std::move(values));
    }
    results.seed_count = std::max<std::uint64_t>(results.seed_count, pipeline.seeds.size());
    results.rows.push_back(std::move(row));
  }
  return results;
}

std::string measured_study_json(const MeasuredStudy& study) {
  Json root = {{"schema_version", kSchemaVersion}, {"date", study.date},
               {"machine", study.machine},         {"scenario", study.scenario},
               {"commit", study.commit},           {"rows", Json::array()}};
  if (!study.changed.empty()) root["changed"] = study.changed;
  for (const MeasuredPipeline& pipeline : study.rows) {
    Json row = {
        {"pipeline", pipeline.pipeline}, {"notes", pipeline.notes}, {"seeds", Json::array()}};
    for (const MeasuredSeed& seed : pipeline.seeds) {
      Json entry = {{"seed", seed.seed}};
      for (const char* id : evaluation::kGapMetrics) {
        entry[id] = evaluation::metric(id).of_seed(seed);
      }
      row["seeds"].push_back(std::move(entry));
    }
    root["rows"].push_back(std::move(row));
  }
  return root.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

void write_measured_study(const std::string& path, const MeasuredStudy& study) {
  write_file(path, measured_study_json(study));
}

MeasuredStudy read_measured_study(const std::string& path, const std::string& scenario) {
  const JsonFile file = read_json_file(path, kStudyAdvice);
  const JsonNode root(file, file.value);
  root.check_schema_version(kSchemaVersion);
  MeasuredStudy study{.date = root["date"].text(),
                      .machine = root["machine"].text(),
                      .scenario = root["scenario"].text(),
                      .commit = root["commit"].text(),
                      .changed = root.has("changed") ? root["changed"].text() : std::string(),
                      .rows = {}};
  if (!scenario.empty() && study.scenario != scenario) {
    root["scenario"].refuse(fmt::format("'{}', the scenario it is to be compared with", scenario));
  }
  std::set<std::string> pipelines;
  for (const JsonNode& row : root["rows"].elements()) {
    study.rows.push_back(read_measured_pipeline(row, pipelines));
  }
  return study;
}

}  // namespace simbench::reports
