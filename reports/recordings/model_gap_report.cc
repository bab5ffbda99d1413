#include "reports/recordings/model_gap_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "evaluation/model/evidence.h"
#include "evaluation/scoring/program_failures.h"
#include "recording/version.h"
#include "reports/results/json.h"
#include "reports/text/json_node.h"
#include "reports/text/number_text.h"

namespace simbench::reports {
namespace {

using evaluation::Evidence;
using evaluation::GapSide;
using evaluation::ModelGapRow;
using evaluation::StageEvidence;

constexpr std::array kGapLegend = {
    "A value is in milliseconds: a quantile over the repetitions (measured) or the seeds "
    "(simulated), which are independent of each other.",
    "KS: largest distance between the two distribution functions, 0 (equal) to 1 (no overlap). "
    "From the critical distance on they differ at the 5 % level. It is exact for these sample "
    "sizes, and coarse for few repetitions: with 5 against 5 only 1 is significant; none: no "
    "distance is significant.",
    "gap: (simulated - measured) / measured median. within 20 %: for medians above 0.05 ms; "
    "smaller ones depend on noise.",
    "The experiment validates the implementation of transport and protocols. It has no cameras: "
    "see the evidence for each stage."};

std::string quantiles_text(const GapSide& side, std::size_t low, std::size_t high) {
  if (side.count == 0) return "-";
  return fmt::format("[{}, {}]", number_text(side.quantiles[low]),
                     number_text(side.quantiles[high]));
}

std::string gap_text(double gap) {
  return std::isfinite(gap) ? fmt::format("{:+.1f} %", 100 * gap) : "-";
}

std::string gap_verdict(const ModelGapRow& row) {
  if (!row.within_20_percent) return "-";
  return *row.within_20_percent ? "yes" : "no";
}

std::string critical_text(const ModelGapRow& row) {
  if (std::isnan(row.ks)) return "-";
  return std::isnan(row.ks_critical) ? "none" : number_text(row.ks_critical);
}

Table gap_table(const std::vector<ModelGapRow>& rows) {
  Table block({{"pipeline", Align::kLeft},
               {"metric", Align::kLeft},
               {"n"},
               {"measured\nmedian"},
               {"measured\n25-75 %"},
               {"measured\n5-95 %"},
               {"simulated\nmedian"},
               {"simulated\n25-75 %"},
               {"simulated\n5-95 %"},
               {"gap"},
               {"within\n20 %"},
               {"KS"},
               {"KS\ncritical"}},
              2);
  for (const ModelGapRow& row : rows) {
    block.add({row.pipeline, row.metric,
               fmt::format("{}/{}", row.measured.count, row.simulated.count),
               number_text(row.measured.series.median), quantiles_text(row.measured, 1, 3),
               quantiles_text(row.measured, 0, 4), number_text(row.simulated.series.median),
               quantiles_text(row.simulated, 1, 3), quantiles_text(row.simulated, 0, 4),
               gap_text(row.median_gap), gap_verdict(row),
               number_text(row.ks) + (row.significant() ? " *" : ""), critical_text(row)});
  }
  return block;
}

// The long reasons stand below the table.
Block evidence_block() {
  Table table({{"stage", Align::kLeft}});
  for (const Evidence evidence : evaluation::kAllEvidence) {
    std::string name(evaluation::name_of(evidence));
    std::replace(name.begin(), name.end(), ' ', '\n');
    table.columns.push_back({name, Align::kLeft});
  }
  Block block{.heading = "Evidence for each stage of the model"};
  for (const StageEvidence& stage : evaluation::model_evidence()) {
    std::vector<std::string> cells = {std::string(stage.stage)};
    for (const Evidence evidence : evaluation::kAllEvidence) {
      cells.emplace_back(stage.has(evidence) ? "x" : "");
    }
    table.add(std::move(cells));
    block.items.push_back(fmt::format("{}: {}.", stage.stage, stage.why));
  }
  block.table = std::move(table);
  return block;
}

// Summary: how many of the judged rows are within the limit.
std::string summary_line(const std::vector<ModelGapRow>& rows) {
  const auto judged = std::count_if(rows.begin(), rows.end(), [](const ModelGapRow& row) {
    return row.within_20_percent.has_value();
  });
  const auto within = std::count_if(rows.begin(), rows.end(), [](const ModelGapRow& row) {
    return row.within_20_percent.value_or(false);
  });
  const auto differ = std::count_if(rows.begin(), rows.end(),
                                    [](const ModelGapRow& row) { return row.significant(); });
  return fmt::format(
      "{} of {} medians above 0.05 ms are within 20 %; {} of {} distributions differ at the 5 % "
      "level (*).",
      within, judged, differ, rows.size());
}

std::vector<std::string> notes_of(const ModelGapReport& report) {
  std::vector<std::string> notes;
  for (const MeasuredPipeline& row : report.measured.rows) {
    for (const std::string& note : row.notes) notes.push_back(row.pipeline + ", " + note);
  }
  notes.insert(notes.end(), report.simulated_failures.begin(), report.simulated_failures.end());
  return notes;
}

Json side_json(const GapSide& side) {
  return {{"count", side.count},         {"median", side.quantiles[2]}, {"p05", side.quantiles[0]},
          {"p25", side.quantiles[1]},    {"p75", side.quantiles[3]},    {"p95", side.quantiles[4]},
          {"values", side.series.values}};
}

Json gap_row_json(const ModelGapRow& row) {
  const auto& within = row.within_20_percent;
  return {{"pipeline", row.pipeline},
          {"metric", row.metric},
          {"measured", side_json(row.measured)},
          {"simulated", side_json(row.simulated)},
          {"ks", row.ks},
          {"ks_critical", row.ks_critical},
          {"significant", row.significant()},
          {"median_gap", row.median_gap},
          {"within_20_percent", within ? Json(*within) : Json()}};
}

Json evidence_json() {
  Json stages = Json::array();
  for (const StageEvidence& stage : evaluation::model_evidence()) {
    Json rests_on = Json::array();
    for (const Evidence evidence : evaluation::kAllEvidence) {
      if (stage.has(evidence)) rests_on.push_back(evaluation::name_of(evidence));
    }
    stages.push_back({{"stage", stage.stage}, {"rests_on", rests_on}, {"why", stage.why}});
  }
  return stages;
}

// Where a world is not the scenario's own, which of both it is.
std::vector<std::string> world_lines(const ModelGapReport& report) {
  const std::string measured = report.measured.changed;
  const std::string simulated = scenarios::changed_text(report.derivation);
  if (measured == simulated)
    return measured.empty() ? std::vector<std::string>() : std::vector{measured};
  const auto line = [](const char* which, const std::string& changed) {
    return fmt::format("{}: {}", which, changed.empty() ? "the scenario itself" : changed);
  };
  return {line("Measured", measured), line("Simulated", simulated),
          "They are not the same world: the gap is not the model's error."};
}

}  // namespace

ModelGapReport model_gap_report(const MeasuredStudy& measured,
                                const evaluation::Results& simulated) {
  ModelGapReport report{.measured = measured,
                        .derivation = simulated.derivation,
                        .simulated_seeds = simulated.seed_count};
  evaluation::Results without_failed = simulated;
  for (evaluation::Row& row : without_failed.rows) {
    const std::string failure = evaluation::program_failure_text(row);
    if (failure.empty()) continue;
    report.simulated_failures.push_back(fmt::format("{}, simulated: {}", row.pipeline, failure));
    for (const char* id : evaluation::kGapMetrics) {
      evaluation::Series& series = evaluation::metric(id).series(row);
      series = evaluation::make_series(std::vector<double>(series.values.size(), evaluation::kNan));
    }
  }
  report.rows = evaluation::model_gap(results_of(measured), without_failed);
  return report;
}

Document model_gap_document(const ModelGapReport& report) {
  const MeasuredStudy& measured = report.measured;
  Document document{
      .title = fmt::format("{}: measured beside simulated", measured.scenario),
      .head = {fmt::format("Measured {} on {} (simbench {}); simulated with {} (simbench {}).",
                           measured.date, measured.machine, measured.commit,
                           counted(report.simulated_seeds, "seed"), commit())}};
  std::ranges::move(world_lines(report), std::back_inserter(document.head));
  document.blocks.push_back({.heading = "The gap",
                             .table = gap_table(report.rows),
                             .prose = {summary_line(report.rows)}});
  if (const std::vector<std::string> notes = notes_of(report); !notes.empty()) {
    document.blocks.push_back({.heading = "What went wrong", .items = notes, .is_warning = true});
  }
  document.blocks.push_back(
      {.heading = "How to read it", .items = {kGapLegend.begin(), kGapLegend.end()}});
  document.blocks.push_back(evidence_block());
  return document;
}

std::string model_gap_json(const ModelGapReport& report) {
  const MeasuredStudy& measured = report.measured;
  Json root = {{"schema_version", 1},
               {"version", version()},
               {"commit", commit()},
               {"scenario", measured.scenario},
               {"measured_on",
                {{"date", measured.date},
                 {"machine", measured.machine},
                 {"commit", measured.commit},
                 {"changed", measured.changed.empty() ? Json(nullptr) : Json(measured.changed)}}},
               {"simulated_seeds", report.simulated_seeds},
               {"rows", Json::array()},
               {"notes", notes_of(report)},
               {"evidence", evidence_json()}};
  state_derivation(report.derivation, root);
  for (const ModelGapRow& row : report.rows) root["rows"].push_back(gap_row_json(row));
  return file_text(root);
}

}  // namespace simbench::reports
