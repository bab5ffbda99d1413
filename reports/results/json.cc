#include "reports/results/json.h"

#include <nlohmann/json.hpp>

#include "recording/version.h"
#include "reports/results/ground_truth_text.h"

namespace simbench::reports {
namespace {

using Json = nlohmann::ordered_json;  // keeps members in order; writes NaN as null

Json series_json(const evaluation::Series& series) {
  return {{"median", series.median},
          {"p05", series.p05},
          {"p95", series.p95},
          {"values", series.values}};
}

Json published_json(const std::optional<evaluation::PublishedComparison>& published) {
  if (!published) return nullptr;
  const evaluation::Percentile& amd = published->amd_percentile;
  const evaluation::Percentile& rmdv = published->rmdv_percentile;
  return {{"amd_ms", published->amd_ms},
          {"rmdv_ms", published->rmdv_ms},
          {"amd_inside", published->amd_inside},
          {"rmdv_inside", published->rmdv_inside},
          {"rmdv_attainable", published->rmdv_attainable},
          {"amd_percentile", amd.percent},
          {"amd_percentile_interval", Json::array({amd.low, amd.high})},
          {"rmdv_percentile", rmdv.percent},
          {"rmdv_percentile_interval", Json::array({rmdv.low, rmdv.high})}};
}

// Of what only a verified row can count.
Json count_json(const evaluation::Row& row, std::int64_t count) {
  return row.verified() ? Json(count) : Json();
}

Json row_json(const evaluation::Row& row) {
  return {{"pipeline", row.pipeline},
          {"host_sync", row.host_sync},
          {"device_time", row.device_time},
          {"gathering", row.gathering},
          {"offline", row.offline},
          {"amd_ms", series_json(row.amd_ms)},
          {"rmdv_ms", series_json(row.rmdv_ms)},
          {"absolute_error_ms", series_json(row.absolute_error_ms)},
          {"bias_ms", series_json(row.bias_ms)},
          {"host_error_ms", series_json(row.host_error_ms)},
          {"exposure_spread_ms", series_json(row.exposure_spread_ms)},
          {"gathering_score",
           {{"precision", row.precision},
            {"recall", row.recall},
            {"margin_ms", row.margin_ms},
            {"seed_precision", series_json(row.seed_precision)},
            {"seed_recall", series_json(row.seed_recall)},
            {"sets", row.sets.emitted},
            {"pure_sets", count_json(row, row.sets.pure)},
            {"complete_pulses", count_json(row, row.sets.complete_pulses)},
            {"partial_sets", row.sets.partial},
            {"index_errors", count_json(row, row.sets.index_errors)},
            {"discarded_frames", row.sets.discarded_frames},
            {"set_amd_ms", series_json(row.set_amd_ms)},
            {"set_absolute_error_ms", series_json(row.set_absolute_error_ms)},
            {"emission_latency_ms", series_json(row.emission_latency_ms)},
            {"emission_latency_max_ms", row.emission_latency_max_ms}}},
          {"frames",
           {{"expected", row.frames.expected},
            {"delivered", row.frames.delivered},
            {"dropped", row.frames.dropped}}},
          {"evaluated_pulses", row.evaluated_pulses},
          {"unsynchronised_hosts", row.unsynchronised_hosts},
          {"ground_truth", ground_truth_name(row.ground_truth)},
          {"verified", row.verified()},
          {"notes", row.notes},
          {"published", published_json(row.published)}};
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
          {"needs", claim.needs.empty() ? Json() : Json(claim.needs)}};
}

}  // namespace

std::string json(const evaluation::Results& results) {
  Json root = {{"schema_version", 1},
               {"version", version()},
               {"commit", commit()},
               {"scenario", results.scenario},
               {"seeds", {{"first", results.first_seed}, {"count", results.seed_count}}},
               {"rows", Json::array()},
               {"claims", Json::array()},
               {"asymmetry_floor", floor_json(results.asymmetry_floor)},
               {"warnings", results.warnings}};
  for (const evaluation::Row& row : results.rows) root["rows"].push_back(row_json(row));
  for (const evaluation::Claim& claim : results.claims) root["claims"].push_back(claim_json(claim));
  const evaluation::Performance& cost = results.performance;
  root["performance"] = {{"events", cost.events},
                         {"events_per_second", cost.events_per_second},
                         {"simulated_seconds", cost.simulated_seconds},
                         {"simulated_seconds_per_second", cost.simulated_seconds_per_second},
                         {"cpu_seconds", cost.cpu_seconds},
                         {"wall_seconds", cost.wall_seconds}};
  // A note may quote what another machine said.
  return root.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace simbench::reports
