#include "reports/recordings/prediction_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <string_view>

#include "evaluation/scoring/metrics.h"
#include "evaluation/statistics/statistics.h"
#include "reports/results/json.h"
#include "reports/text/json_node.h"
#include "reports/text/metric_text.h"
#include "reports/text/number_text.h"

namespace simbench::reports {
namespace {

using evaluation::Results;
using evaluation::Row;
using evaluation::Series;

constexpr const char* kOfPulses[] = {"amd_ms", "rmdv_ms", "host_error_ms", "absolute_error_ms"};
constexpr const char* kOfSets[] = {"set_amd_ms"};

std::string prediction_legend(bool one_repetition) {
  const std::string legend = fmt::format(
      "Prediction: the simulator's, for the same scenario, among whose seeds the measured median "
      "has "
      "a percentile. {} What is inside does not distinguish the rig from such a world; a scenario "
      "does not describe what is outside (simbench fit makes one that does).",
      placement_legend());
  return one_repetition ? legend + " One repetition has a value and no band." : legend;
}

std::span<const char* const> metrics_of(const Row& measured) {
  if (measured.verified() || evaluation::count_of_existing(measured.amd_ms.values) == 0)
    return kOfPulses;
  return kOfSets;
}

// AMD is always shown, other metrics only if measured: real rigs cannot measure errors.
bool is_predicted(std::string_view metric, std::size_t measured) {
  return measured > 0 || metric == "amd_ms" || metric == "set_amd_ms";
}

std::string band_in_its_unit(const Prediction& prediction, const evaluation::Series& series) {
  return interval_text(evaluation::metric(prediction.metric), series.p05, series.p95);
}

std::string measured_band(const Prediction& prediction) {
  return prediction.measured_count > 1 ? band_in_its_unit(prediction, prediction.measured) : "-";
}

std::string place_text(const Prediction& prediction) {
  return prediction.percentile ? placement_text(*prediction.percentile) : "-";
}

std::string predicted_metric(const Prediction& prediction) {
  const bool unverified = !prediction.verified && prediction.measured_count > 0;
  return fmt::format("{}{}", evaluation::metric(prediction.metric).title,
                     unverified ? " (unverified)" : "");
}

Table prediction_table(const std::vector<Prediction>& rows) {
  Table table({{"pipeline", Align::kLeft},
               {"metric", Align::kLeft},
               {"measured\nmedian"},
               {"measured\n5-95 %"},
               {"simulated\nmedian"},
               {"simulated\n5-95 %"},
               {.header = "measured\nmedian is", .align = Align::kLeft, .is_verdict = true}},
              2);
  for (const Prediction& row : rows) {
    const evaluation::Metric& metric = evaluation::metric(row.metric);
    table.add({row.pipeline, predicted_metric(row), metric_text(metric, row.measured.median),
               measured_band(row), metric_text(metric, row.simulated.median),
               band_in_its_unit(row, row.simulated), place_text(row)});
  }
  return table;
}

Json prediction_json(const Prediction& row) {
  Json measured = {{"count", row.measured_count}};
  measured.update(band_json(row.measured));
  if (row.measured_count < 2) measured["p05"] = measured["p95"] = Json();
  return {{"pipeline", row.pipeline},
          {"metric", row.metric},
          {"verified", row.verified},
          {"measured", measured},
          {"simulated", band_json(row.simulated)},
          {"inside", row.percentile ? inside_json(*row.percentile) : Json()}};
}

}  // namespace

std::vector<Prediction> predictions(const Results& measured, const Results& simulated) {
  std::vector<Prediction> all;
  for (const Row& found : measured.rows) {
    const Row* const predicted = evaluation::find_row(simulated.rows, found.pipeline);
    if (predicted == nullptr) continue;
    for (const char* const id : metrics_of(found)) {
      const evaluation::Metric& metric = evaluation::metric(id);
      Prediction row{.pipeline = found.pipeline,
                     .metric = id,
                     .verified = found.verified(),
                     .measured = metric.series(found),
                     .simulated = metric.series(*predicted),
                     .measured_count = evaluation::count_of_existing(metric.series(found).values),
                     .percentile = std::nullopt};
      if (!is_predicted(id, row.measured_count)) continue;
      if (row.measured_count > 0 && evaluation::count_of_existing(row.simulated.values) > 0) {
        row.percentile = evaluation::percentile_of(row.measured.median, row.simulated.values);
      }
      all.push_back(std::move(row));
    }
  }
  return all;
}

Block prediction_block(const Results& measured, const Results& simulated) {
  const std::vector<Prediction> rows = predictions(measured, simulated);
  const bool one = std::any_of(rows.begin(), rows.end(),
                               [](const Prediction& row) { return row.measured_count == 1; });
  return {.heading = fmt::format("Measured beside predicted ({})",
                                 counted(simulated.seed_count, "simulated seed")),
          .table = prediction_table(rows),
          .prose = {prediction_legend(one)}};
}

std::string json_with_prediction(const Results& measured, const Results& simulated) {
  Json root = Json::parse(json(measured));
  Json rows = Json::array();
  for (const Prediction& row : predictions(measured, simulated)) {
    rows.push_back(prediction_json(row));
  }
  root["prediction"] = {
      {"seeds", {{"first", simulated.first_seed}, {"count", simulated.seed_count}}},
      {"rows", std::move(rows)}};
  return file_text(root);
}

}  // namespace simbench::reports
