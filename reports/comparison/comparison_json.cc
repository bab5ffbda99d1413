// Comparisons for programs.
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "recording/version.h"
#include "reports/comparison/comparison.h"
#include "reports/comparison/comparison_words.h"

namespace simbench::reports {
namespace {

using Json = nlohmann::ordered_json;  // keeps members in order; writes NaN as null

Json estimate_json(const evaluation::Estimate& estimate) {
  return {{"value", estimate.value}, {"low", estimate.low}, {"high", estimate.high}};
}

Json metric_json(const evaluation::PairedComparison& c) {
  return {{"pairs", c.pairs},
          {"left_out", c.left_out},
          {"a", {{"mean", c.mean_a}, {"median", c.median_a}}},
          {"b", {{"mean", c.mean_b}, {"median", c.median_b}}},
          {"difference", estimate_json(c.difference)},
          {"ratio", estimate_json(c.ratio)},
          {"smallest_effect", c.smallest_effect},
          {"within_smallest_effect", c.within_effect},
          {"verdict", verdict_name(c.verdict)},
          {"seeds_needed", c.seeds_needed > 0 ? Json(c.seeds_needed) : Json()}};
}

// Empty for what does not exist, as in the CSV of a run.
std::string csv_number(double value) { return std::isnan(value) ? "" : fmt::format("{}", value); }

}  // namespace

std::string comparison_json(const Comparison& comparison) {
  Json root = {{"schema_version", 1},
               {"version", version()},
               {"commit", commit()},
               {"scenario", comparison.scenario},
               {"a", comparison.a},
               {"b", comparison.b},
               {"seeds",
                {{"first_a", comparison.first_seed_a},
                 {"first_b", comparison.first_seed_b},
                 {"count", comparison.seed_count},
                 {"paired_by", comparison.by_index ? "index" : "seed"}}},
               {"smallest_effect", comparison.smallest_effect},
               {"pipelines", Json::array()},
               {"notes", comparison.notes}};
  const auto judged = evaluation::judged_metrics();
  for (const ComparedPipeline& pipeline : comparison.pipelines) {
    Json row = {{"a", pipeline.pipeline_a}, {"b", pipeline.pipeline_b}};
    for (std::size_t i = 0; i < pipeline.metrics.size(); ++i) {
      row[judged[i]->id] = metric_json(pipeline.metrics[i]);
    }
    root["pipelines"].push_back(std::move(row));
  }
  return root.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string comparison_csv(const Comparison& comparison) {
  std::string text =
      "pipeline_a,pipeline_b,metric,pairs,left_out,mean_a,mean_b,median_a,median_b,difference,"
      "difference_low,difference_high,ratio,ratio_low,ratio_high,verdict,seeds_needed\n";
  const auto judged = evaluation::judged_metrics();
  for (const ComparedPipeline& pipeline : comparison.pipelines) {
    for (std::size_t i = 0; i < pipeline.metrics.size(); ++i) {
      const evaluation::PairedComparison& c = pipeline.metrics[i];
      text += fmt::format("{},{},{},{},{}", pipeline.pipeline_a, pipeline.pipeline_b, judged[i]->id,
                          c.pairs, c.left_out);
      for (const double value :
           {c.mean_a, c.mean_b, c.median_a, c.median_b, c.difference.value, c.difference.low,
            c.difference.high, c.ratio.value, c.ratio.low, c.ratio.high}) {
        text += fmt::format(",{}", csv_number(value));
      }
      text += fmt::format(",{},{}\n", verdict_name(c.verdict),
                          c.seeds_needed > 0 ? fmt::format("{}", c.seeds_needed) : "");
    }
  }
  return text;
}

}  // namespace simbench::reports
