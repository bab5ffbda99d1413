#include "reports/results/json.h"

#include "algorithms/ports/stage.h"
#include "evaluation/scoring/rows.h"
#include "recording/version.h"
#include "reports/results/derivation_json.h"
#include "reports/results/ground_truth_text.h"
#include "reports/results/published_figures_json.h"
#include "reports/text/json_node.h"

namespace simbench::reports {

Json inside_json(const evaluation::Percentile& percentile) {
  const evaluation::Placement placement = evaluation::placement_of(percentile);
  if (placement == evaluation::Placement::kTooFewSeeds) return nullptr;
  return placement == evaluation::Placement::kInside;
}

namespace {

Json published_json(const std::optional<evaluation::PublishedComparison>& published) {
  if (!published) return nullptr;
  const evaluation::Percentile& amd = published->amd_percentile;
  const evaluation::Percentile& rmdv = published->rmdv_percentile;
  return {{"amd_ms", published->amd_ms},
          {"rmdv_ms", published->rmdv_ms},
          {"amd_inside", inside_json(amd)},
          {"rmdv_inside", inside_json(rmdv)},
          {"rmdv_attainable", published->rmdv_attainable},
          {"amd_percentile", amd.percent},
          {"amd_percentile_interval", Json::array({amd.low, amd.high})},
          {"rmdv_percentile", rmdv.percent},
          {"rmdv_percentile_interval", Json::array({rmdv.low, rmdv.high})}};
}

Json metric_json(const evaluation::Metric& metric, const evaluation::Row& row) {
  if (metric.is_series()) return series_json(metric.series(row));
  if (!metric.is_count()) return metric.number(row);
  return metric.is_known(row) ? Json(metric.count(row)) : Json();
}

Json row_json(const evaluation::Row& row) {
  Json all = {{"pipeline", row.pipeline}};
  for (const StageInfo& stage : kPipelineStages) {
    if (!stage.may_be_absent) all[stage.name] = at_stage(row, stage.id);
  }
  all["offline"] = row.offline;
  if (!row.model.empty()) all["model"] = row.model;
  for (const StageInfo& stage : kPipelineStages) {
    const std::string& name = at_stage(row, stage.id);
    if (stage.may_be_absent && !name.empty()) all[stage.name] = name;
  }
  for (const evaluation::Metric& metric : evaluation::metrics()) {
    Json& object = *metric.json_in == '\0' ? all : all[metric.json_in];
    object[metric.member()] = metric_json(metric, row);
  }
  all["scored_seeds"] = evaluation::scored_seeds(row);
  all["ground_truth"] = ground_truth_name(row.ground_truth);
  all["verified"] = row.verified();
  all["notes"] = row.notes;
  all["published"] = published_json(row.published);
  return all;
}

Json floor_json(const std::optional<evaluation::AsymmetryFloor>& floor) {
  if (!floor) return nullptr;
  return {{"sigma_ms", floor->sigma_ms},
          {"host_error_ms", floor->host_error_ms},
          {"amd_ms", floor->amd_ms}};
}

Json claim_json(const evaluation::Claim& claim) {
  return {{"id", claim.id},
          {"holds_fraction", claim.holds_fraction ? Json(*claim.holds_fraction) : Json()},
          {"text", claim.text},
          {"needs", claim.needs.empty() ? Json() : Json(claim.needs)},
          {"decided_seeds", claim.decided_seeds}};
}

}  // namespace

Json performance_json(const evaluation::Performance& cost) {
  return {{"events", cost.events},
          {"events_per_second", cost.events_per_second},
          {"simulated_seconds", cost.simulated_seconds},
          {"simulated_seconds_per_second", cost.simulated_seconds_per_second},
          {"cpu_seconds", cost.cpu_seconds},
          {"wall_seconds", cost.wall_seconds}};
}

std::string json(const evaluation::Results& results) {
  Json root = {{"schema_version", kArchiveSchemaVersion},
               {"version", version()},
               {"commit", commit()},
               {"scenario", results.scenario}};
  state_derivation(results.derivation, root);
  root.update({{"seeds", {{"first", results.first_seed}, {"count", results.seed_count}}},
               {"rows", Json::array()},
               {"claims", Json::array()},
               {"asymmetry_floor", floor_json(results.asymmetry_floor)},
               {"warnings", results.warnings}});
  for (const evaluation::Row& row : results.rows) root["rows"].push_back(row_json(row));
  state_published_figures(results, root);
  for (const evaluation::Claim& claim : results.claims) root["claims"].push_back(claim_json(claim));
  root["performance"] = performance_json(results.performance);
  return file_text(root);
}

}  // namespace simbench::reports
