
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>
#include <vector>

#include "algorithms/ports/stage.h"
#include "evaluation/statistics/statistics.h"
#include "recording/text_fields.h"
#include "recording/version.h"
#include "reports/reconstruction/reconstruction_document.h"
#include "reports/results/json.h"
#include "reports/results/results_document.h"
#include "reports/text/json_node.h"

namespace simbench::reports {
namespace {

using evaluation::Series;
using reconstruction::CurvePoint;
using reconstruction::ReconstructionResults;
using reconstruction::ReprojectionRow;
using reconstruction::SeedReprojection;

Json published_error_json(const ReprojectionRow& row) {
  if (!row.published) return nullptr;
  return {{"mean_cm", row.published->mean_cm},
          {"std_cm", row.published->std_cm},
          {"mean_inside",
           inside_json(evaluation::percentile_of(row.published->mean_cm, row.mean_cm().values))},
          {"std_inside",
           inside_json(evaluation::percentile_of(row.published->std_cm, row.std_cm().values))}};
}

Json reprojection_row_json(const ReprojectionRow& row) {
  Json all = {{"pipeline", row.pipeline}};
  for (const StageInfo& stage : kPipelineStages) {
    const std::string& name = at_stage(row, stage.id);
    if (!name.empty()) all[stage.name] = name;
  }
  all.update({{"mean_cm", series_json(row.mean_cm())},
              {"std_cm", series_json(row.std_cm())},
              {"median_cm", series_json(row.median_cm())},
              {"p95_cm", series_json(row.p95_cm())},
              {"desync_ms", series_json(row.desync_ms())},
              {"sets", total_over_seeds(row, &SeedReprojection::sets)},
              {"failed_sets", total_over_seeds(row, &SeedReprojection::failed_sets)},
              {"missing_frames", total_over_seeds(row, &SeedReprojection::missing_frames)},
              {"no_gathered_set_share", no_gathered_set_share(row)},
              {"published", published_error_json(row)},
              {"notes", row.notes}});
  return all;
}

Json all_published_json(const ReconstructionResults& results) {
  Json json = Json::object();
  if (!results.scenario.studio) return json;
  for (const auto& [pipeline, value] : results.scenario.studio->published) {
    json[pipeline] = {{"mean_cm", value.mean_cm}, {"std_cm", value.std_cm}};
  }
  return json;
}

Json ratio_json(const ReconstructionResults& results) {
  const auto ratio = published_ratio(results.rows);
  if (!ratio) return nullptr;
  return {{"worst", ratio->worst},
          {"best", ratio->best},
          {"ratio", series_json(ratio->ratio)},
          {"published", ratio->published}};
}

Json curve_json(const std::vector<CurvePoint>& curve) {
  Json json = Json::array();
  for (const CurvePoint& point : curve) {
    json.push_back({{"speed_m_per_s", point.speed_m_per_s},
                    {"speed_factor", point.speed_factor},
                    {"desync_ms", point.desync_ms},
                    {"mean_cm", series_json(evaluation::make_series(point.mean_cm))},
                    {"std_cm", series_json(evaluation::make_series(point.std_cm))}});
  }
  return json;
}

Json optional_json(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json limits_json(const std::vector<CurvePoint>& curve) {
  Json json = Json::array();
  for (const SyncLimit& limit : sync_limits(curve)) {
    json.push_back({{"speed_m_per_s", limit.speed_m_per_s},
                    {"speed_factor", limit.speed_factor},
                    {"floor_cm", limit.floor_cm},
                    {"limit_ms", optional_json(limit.limit_ms)},
                    {"last_ms", limit.last_ms},
                    {"cost_cm_per_ms", limit.cost_cm_per_ms}});
  }
  return json;
}

Json speed_needed_json(const std::optional<reconstruction::SpeedNeeded>& needed) {
  if (!needed) return nullptr;
  return {{"pipeline", needed->pipeline},
          {"desync_ms", needed->desync_ms},
          {"published_mean_cm", needed->published_mean_cm},
          {"speed_m_per_s", optional_json(needed->speed_m_per_s)},
          {"points", curve_json(needed->points)}};
}

struct NamedSeries {
  const char* name;
  Series (ReprojectionRow::*series)() const;
};

constexpr NamedSeries kSeries[] = {{"mean_cm", &ReprojectionRow::mean_cm},
                                   {"std_cm", &ReprojectionRow::std_cm},
                                   {"median_cm", &ReprojectionRow::median_cm},
                                   {"p95_cm", &ReprojectionRow::p95_cm},
                                   {"desync_ms", &ReprojectionRow::desync_ms}};

std::string csv_header(const std::vector<StageInfo>& stages) {
  std::string line = "pipeline";
  for (const StageInfo& stage : stages) line += fmt::format(",{}", stage.name);
  for (const NamedSeries& each : kSeries) line += fmt::format(",{0},{0}_p05,{0}_p95", each.name);
  return line +
         ",sets,failed_sets,missing_frames,no_gathered_set_share,published_mean_cm,"
         "published_std_cm\n";
}

std::string reconstruction_csv_line(const ReprojectionRow& row,
                                    const std::vector<StageInfo>& stages) {
  std::vector<std::string> cells = {csv_cell(row.pipeline)};
  for (const StageInfo& stage : stages) cells.push_back(csv_cell(at_stage(row, stage.id)));
  for (const NamedSeries& each : kSeries) {
    const Series series = (row.*each.series)();
    cells.insert(cells.end(),
                 {csv_cell(series.median), csv_cell(series.p05), csv_cell(series.p95)});
  }
  for (const auto member : {&SeedReprojection::sets, &SeedReprojection::failed_sets,
                            &SeedReprojection::missing_frames}) {
    cells.push_back(std::to_string(total_over_seeds(row, member)));
  }
  cells.push_back(csv_cell(no_gathered_set_share(row)));
  cells.push_back(row.published ? csv_cell(row.published->mean_cm) : "");
  cells.push_back(row.published ? csv_cell(row.published->std_cm) : "");
  return fmt::format("{}\n", fmt::join(cells, ","));
}

}  // namespace

std::string reconstruction_json(const ReconstructionResults& results) {
  Json rows = Json::array();
  for (const ReprojectionRow& row : results.rows) rows.push_back(reprojection_row_json(row));
  Json root = {{"schema_version", 1}, {"scenario", results.scenario.name}};
  state_derivation(results.scenario.derivation, root);
  root.update({{"version", version()},
               {"commit", commit()},
               {"first_seed", results.first_seed},
               {"seeds", results.seeds},
               {"frames", results.frames},
               {"rows", rows},
               {"published", all_published_json(results)},
               {"published_ratio", ratio_json(results)},
               {"curve", curve_json(results.curve)},
               {"limits", limits_json(results.curve)},
               {"speed_needed", speed_needed_json(results.speed_needed)},
               {"notes", honest_notes(results)},
               {"performance",
                {{"wall_s", results.wall_s}, {"seconds_per_set", results.seconds_per_set}}}});
  return file_text(root);
}

std::string reconstruction_csv(const ReconstructionResults& results) {
  const std::vector<StageInfo> stages = present_stages(results.rows);
  std::string text = csv_header(stages);
  for (const ReprojectionRow& row : results.rows) {
    text += reconstruction_csv_line(row, stages);
  }
  return text;
}

}  // namespace simbench::reports
