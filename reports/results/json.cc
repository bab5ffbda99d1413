#include "reports/results/json.h"

#include <algorithm>
#include <string_view>

#include "algorithms/ports/stage.h"
#include "evaluation/answer/standing.h"
#include "evaluation/scoring/metrics.h"
#include "evaluation/scoring/rows.h"
#include "reports/results/answer_fields.h"
#include "reports/results/ground_truth_text.h"
#include "reports/results/results_answer.h"

namespace simbench::reports {

Json inside_json(const evaluation::Percentile& percentile) {
  const evaluation::Placement placement = evaluation::placement_of(percentile);
  if (placement == evaluation::Placement::kTooFewSeeds) return nullptr;
  return placement == evaluation::Placement::kInside;
}

namespace {

using evaluation::FigureComparison;
using scenarios::Derivation;

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

Json search_json(const PlaceSearch& search) {
  return {{"sources", search.sources},
          {"found", search.found},
          {"again", search.again},
          {"frames", search.frames},
          {"seconds", search.seconds},
          {"since_first_frame_s", search.since_first_frame_s},
          {"error_probability", search.error_probability}};
}

Json row_json(const evaluation::Row& row, evaluation::RankedBy ranked_by) {
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
  if (row.search) all["search"] = search_json(*row.search);
  const evaluation::ReasonedStanding standing = evaluation::standing_of(row, ranked_by);
  all["standing"] = evaluation::standing_id(standing.is);
  all["failed"] = standing.reason.empty() ? Json() : Json(standing.reason);
  state_programs(row, all);
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

Json stated_value(const std::string& value) { return value.empty() ? Json() : Json::parse(value); }

std::string value_text(const JsonNode& node) {
  return node.is_null() ? "" : Json::parse(node.dump()).dump();
}

constexpr const char* kFigures = "published_figures";

Json published_figure_json(const FigureComparison& compared) {
  const scenarios::PublishedFigure& figure = compared.figure;
  Json entry = {
      {"pipeline", figure.pipeline},
      {"metric", figure.metric},
      {figure.number_name(), figure.number()},
      {"conditions", figure.conditions},
      {"source", figure.source},
      {"percentile", compared.percentile.percent},
      {"percentile_interval", Json::array({compared.percentile.low, compared.percentile.high})}};
  if (!figure.value) {
    entry["kept_percent"] = compared.kept.percent;
    entry["kept_percent_interval"] = Json::array({compared.kept.low, compared.kept.high});
  }
  const std::string_view verdict = evaluation::verdict_word(compared.verdict);
  entry["verdict"] = verdict.empty() ? Json() : Json(verdict);
  return entry;
}

const evaluation::Metric& read_figure_metric(const JsonNode& node) {
  const std::string id = node.text();
  const auto found = std::ranges::find_if(evaluation::metrics(), [&id](const auto& metric) {
    return metric.is_series() && metric.id == id;
  });
  if (found == evaluation::metrics().end()) node.refuse("a metric with a value of each seed");
  return *found;
}

scenarios::PublishedFigure read_figure(const JsonNode& node) {
  scenarios::PublishedFigure figure;
  figure.pipeline = node["pipeline"].text();
  const evaluation::Metric& metric = read_figure_metric(node["metric"]);
  figure.metric = metric.id;
  int stated = 0;
  const auto read = [&](const char* name, std::optional<double>& number) {
    if (!node.has(name)) return;
    ++stated;
    if (node[name].is_null()) node[name].refuse("a number");
    number = node[name].value_of(metric);
  };
  read("at_most", figure.at_most);
  read("value", figure.value);
  read("at_least", figure.at_least);
  if (stated != 1) node.refuse("exactly one of at_most, value and at_least");
  figure.conditions = node["conditions"].text();
  figure.source = node["source"].text();
  return figure;
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
  return json(results, results_answer(results));
}

std::string json(const evaluation::Results& results, const ResultsAnswer& answer) {
  Json root = new_document(kArchiveSchemaVersion);
  root["scenario"] = results.scenario;
  state_derivation(results.derivation, root);
  if (results.draws_load) root[kOwnLoadMember] = true;
  const evaluation::RankedBy ranked_by = evaluation::ranking_of(results);
  root.update({{"seeds", {{"first", results.first_seed}, {"count", results.seed_count}}},
               {kRankedByMember, evaluation::ranked_metric(ranked_by).id},
               {"rows", Json::array()},
               {"claims", Json::array()},
               {"asymmetry_floor", floor_json(results.asymmetry_floor)},
               {"warnings", results.warnings},
               {kLossReasonsMember, results.loss_reasons},
               {kLoadRealityMember, results.load_reality}});
  for (const evaluation::Row& row : results.rows) {
    root["rows"].push_back(row_json(row, ranked_by));
  }
  state_published_figures(results, root);
  root["answer"] =
      answer_with_fields(answer.data, answer.text, answer.levers ? &*answer.levers : nullptr);
  for (const evaluation::Claim& claim : results.claims) root["claims"].push_back(claim_json(claim));
  root["performance"] = performance_json(results.performance);
  return file_text(root);
}

void state_derivation(const Derivation& derivation, Json& root) {
  if (derivation.base.empty() && derivation.unpublished.empty()) return;
  root["based_on"] = derivation.base.empty() ? Json() : Json(derivation.base);
  Json& changed = root["changed"] = Json::array();
  for (const scenarios::Change& change : derivation.changes) {
    changed.push_back({{"pointer", change.pointer},
                       {"from", stated_value(change.from)},
                       {"to", stated_value(change.to)}});
  }
  root["published_left_out"] =
      derivation.unpublished.empty() ? Json() : Json(derivation.unpublished);
}

Derivation read_derivation(const JsonNode& root) {
  Derivation derivation;
  if (!root.has("based_on")) return derivation;
  if (const JsonNode base = root["based_on"]; !base.is_null()) derivation.base = base.text();
  for (const JsonNode& change : root["changed"].elements()) {
    derivation.changes.push_back(
        {change["pointer"].text(), value_text(change["from"]), value_text(change["to"])});
  }
  const JsonNode unpublished = root["published_left_out"];
  if (!unpublished.is_null()) derivation.unpublished = unpublished.text();
  return derivation;
}

namespace {

constexpr const char* kProgramFailures = "program_failures";

Json text_or_null(const std::string& text) { return text.empty() ? Json() : Json(text); }

std::string text_of(const JsonNode& node) { return node.is_null() ? "" : node.text(); }

}  // namespace

void state_programs(const evaluation::Row& row, Json& to) {
  if (!row.is_of_programs) return;
  Json& all = to[kProgramFailures] = Json::array();
  for (const auto& [seed, failure] : row.program_failures) {
    all.push_back({{"seed", seed},
                   {"host", failure.host},
                   {"program", failure.program},
                   {"at_s", to_ns(failure.at) / 1e9},
                   {"how", failure.how},
                   {"last_words", text_or_null(failure.last_words)},
                   {"log", text_or_null(failure.log)}});
  }
}

void read_programs(const JsonNode& from, evaluation::Row& row) {
  if (!from.has(kProgramFailures)) return;
  row.is_of_programs = true;
  for (const JsonNode& node : from[kProgramFailures].elements()) {
    row.program_failures.push_back({.seed = static_cast<std::uint64_t>(node["seed"].count()),
                                    .failure = {.host = static_cast<PeerId>(node["host"].count()),
                                                .program = node["program"].text(),
                                                .at = from_ms(1e3 * node["at_s"].number()),
                                                .how = node["how"].text(),
                                                .last_words = text_of(node["last_words"]),
                                                .log = text_of(node["log"])}});
  }
}

void state_published_figures(const evaluation::Results& results, Json& root) {
  if (results.published_figures.empty()) return;
  Json& all = root[kFigures] = Json::array();
  for (const FigureComparison& compared : results.published_figures) {
    all.push_back(published_figure_json(compared));
  }
}

std::vector<FigureComparison> read_published_figures(const JsonNode& root,
                                                     std::span<const evaluation::Row> rows) {
  std::vector<FigureComparison> all;
  if (!root.has(kFigures)) return all;
  for (const JsonNode& node : root[kFigures].elements()) {
    const scenarios::PublishedFigure figure = read_figure(node);
    const evaluation::Row* const row = find_row(rows, figure.pipeline);
    if (row == nullptr) node["pipeline"].refuse("a pipeline of /rows");
    all.push_back(compare_figure(figure, *row));
  }
  return all;
}

}  // namespace simbench::reports
