#include "reports/clocks/clock_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "evaluation/answer/standing.h"
#include "evaluation/clock_run/clock_score.h"
#include "recording/text_fields.h"
#include "recording/version.h"
#include "reports/results/answer_fields.h"
#include "reports/results/csv.h"
#include "reports/results/ground_truth_text.h"
#include "reports/results/json.h"
#include "reports/results/metric_columns.h"
#include "reports/results/results_document.h"
#include "reports/stability/stability_report.h"
#include "reports/text/json_node.h"
#include "reports/text/metric_text.h"
#include "reports/text/number_text.h"

namespace simbench::reports {
namespace {

using evaluation::ClockResults;
using evaluation::kNan;
using evaluation::Metric;
using evaluation::ResultKind;
using evaluation::Row;

std::vector<double> existing(const std::vector<double>& values) {
  std::vector<double> found;
  for (const double value : values) {
    if (std::isfinite(value)) found.push_back(value);
  }
  return found;
}

double largest(const std::vector<double>& values) {
  const std::vector<double> found = existing(values);
  return found.empty() ? kNan : *std::max_element(found.begin(), found.end());
}

double rms(const std::vector<double>& values) {
  double squares = 0;
  const std::vector<double> found = existing(values);
  for (const double value : found) squares += value * value;
  return found.empty() ? kNan : std::sqrt(squares / static_cast<double>(found.size()));
}

Field<Row> clock_field(const Metric& metric) {
  const MetricColumn column = column_of(metric, ResultKind::kClockRuns);
  Field<Row> field = {{column.heading, Align::kRight, column.legend},
                      [metric](const Row& row) { return metric_text(metric, metric.value(row)); }};
  if (column.band_heading != nullptr) {
    field.sparkline = [metric](const Row& row) { return seeds_sparkline(metric.series(row)); };
  }
  return field;
}

evaluation::ReasonedStanding standing_among_clocks(const Row& row) {
  return evaluation::standing_of(row, evaluation::RankedBy::kClockSpread);
}

bool has_failed(const Row* row) {
  return standing_among_clocks(*row).is == evaluation::RowStanding::kFailed;
}

Table metrics_table(const ClockResults& results) {
  const std::vector<const Row*> rows = pointers_to(results.results.rows);
  std::vector<Field<Row>> fields = {pipeline_field<Row>()};
  if (std::ranges::any_of(rows, has_failed)) {
    fields.push_back(standing_field(rows, evaluation::RankedBy::kClockSpread));
  }
  for (const Metric* metric : table_metrics(&TablePlaces::clocks, ResultKind::kClockRuns)) {
    fields.push_back(clock_field(*metric));
  }
  return table_of(fields, rows);
}

// A line for each tau, a column for each pipeline.
Table over_tau_table(const ClockResults& results, const evaluation::ClockCurve& curve) {
  std::vector<Column> columns = {{"tau s"}};
  const std::vector<evaluation::StabilityPoint>* longest = nullptr;
  for (std::size_t row = 0; row < results.results.rows.size(); ++row) {
    columns.push_back({results.results.rows[row].pipeline});
    const auto& points = results.curves[row].*curve.points;
    if (longest == nullptr || points.size() > longest->size()) longest = &points;
  }
  Table table(std::move(columns));
  for (std::size_t i = 0; longest != nullptr && i < longest->size(); ++i) {
    std::vector<std::string> cells = {number_text((*longest)[i].tau_s)};
    for (const evaluation::StabilityCurves& curves : results.curves) {
      const auto& points = curves.*curve.points;
      cells.push_back(i < points.size() ? number_text(points[i].value) : "-");
    }
    table.add(std::move(cells));
  }
  return table;
}

// Where hosts stand in a chain, each slave has a line: errors add up along it.
Table chain_table(const ClockResults& results) {
  Table table({{"pipeline"},
               {"host"},
               {"follows"},
               {"median TE ms"},
               {"median |TE| ms"},
               {"95 % |TE| ms"}});
  for (std::size_t row = 0; row < results.results.rows.size(); ++row) {
    const std::vector<evaluation::HostTe> hosts =
        evaluation::host_medians(results.hosts[row]).to_truth;
    for (std::size_t host = 1; host < hosts.size(); ++host) {
      table.add({results.results.rows[row].pipeline, std::to_string(host),
                 std::to_string(results.follows[host]), number_text(hosts[host].median_ms),
                 number_text(hosts[host].median_abs_ms), number_text(hosts[host].p95_abs_ms)});
    }
  }
  return table;
}

std::vector<std::string> legend(const ClockResults& results) {
  std::vector<std::string> lines = {
      fmt::format("Hosts alone, without cameras, read once a second; measured from {} to {} s. A "
                  "value is the median over the seeds.",
                  results.results.clock_period.from_s, results.results.clock_period.duration_s)};
  for (const Metric* metric : table_metrics(&TablePlaces::clocks, ResultKind::kClockRuns)) {
    const MetricColumn column = column_of(*metric, ResultKind::kClockRuns);
    if (*column.legend == '\0') continue;
    if (column.legend_continues) {
      lines.back().append(" ").append(column.legend);
    } else {
      lines.emplace_back(column.legend);
    }
  }
  lines.emplace_back(
      "ADEV and TDEV: RMS over slaves and seeds. MTIE: the largest of any slave and seed.");
  if (results.results.draws_load) lines.push_back(fmt::format("rows of one seed: {}.", kOwnLoad));
  return lines;
}

}  // namespace

ClockResults clock_results_of(const Archive& archive) {
  return {.results = archive.results, .curves = archive.curves};
}

Document clock_document(const ClockResults& results, const std::string& summary) {
  Document document{.title = results_title(results.results),
                    .head = paragraphs(clock_answer(results))};
  const std::vector<std::string> head = results_head(results.results, summary);
  document.head.insert(document.head.end(), head.begin(), head.end());
  if (!results.period_note.empty()) document.head.push_back(results.period_note);
  std::vector<Block>& blocks = document.blocks;
  blocks.push_back({.heading = "The hosts' clocks", .table = metrics_table(results)});
  if (!results.follows.empty() && !results.hosts.empty()) {
    blocks.push_back({.heading = "Each host, against true time", .table = chain_table(results)});
  }
  add(program_gap_block(results.results), blocks);
  add(notes_block(results.results), blocks);
  for (const evaluation::ClockCurve& curve : evaluation::clock_curves()) {
    if (!curve.in_text) continue;
    blocks.push_back({.heading = curve.title, .table = over_tau_table(results, curve)});
  }
  blocks.push_back({.heading = "How to read it", .items = legend(results)});
  Block syncs{.heading = "Pipelines and their host_sync"};
  for (const Row& row : results.results.rows) {
    syncs.items.push_back(row.pipeline + " = " + row.host_sync);
  }
  blocks.push_back(std::move(syncs));
  return document;
}

namespace {

// The hosts from `first` on.
Json host_errors_json(const std::vector<evaluation::HostTe>& hosts, std::size_t first) {
  Json all = Json::array();
  for (std::size_t host = first; host < hosts.size(); ++host) {
    all.push_back({{"host", host},
                   {"median_te_ms", hosts[host].median_ms},
                   {"median_abs_te_ms", hosts[host].median_abs_ms},
                   {"p95_abs_te_ms", hosts[host].p95_abs_ms},
                   {"sd_te_ms", hosts[host].sd_ms}});
  }
  return all;
}

Json clock_row_json(const Row& row, const evaluation::StabilityCurves& curves) {
  Json all = {{"pipeline", row.pipeline},
              {"host_sync", row.host_sync},
              {"device_time", row.device_time},
              {"gathering", row.gathering},
              {"clock_spread_ms",
               {{"mean", evaluation::mean_of_existing(row.clock_spread_ms.values)},
                {"median", evaluation::mean_of_existing(row.clock_spread_median_ms.values)},
                {"p95", evaluation::mean_of_existing(row.clock_spread_p95_ms.values)},
                {"max", largest(row.clock_spread_max_ms.values)},
                {"values", row.clock_spread_ms.values}}}};
  if (!row.model.empty()) all["model"] = row.model;
  all["notes"] = row.notes;
  all["unsynchronised_hosts"] = row.unsynchronised_hosts;
  if (row.is_of_programs || has_failed(&row)) {
    const evaluation::ReasonedStanding standing = standing_among_clocks(row);
    all["standing"] = evaluation::standing_id(standing.is);
    all["failed"] = standing.reason.empty() ? Json() : Json(standing.reason);
  }
  state_programs(row, all);
  for (const evaluation::ClockCurve& curve : evaluation::clock_curves())
    all[curve.id] = points_json(curves.*curve.points);
  all["max_te_ms"] = largest(row.max_te_ms.values);
  all["rms_te_ms"] = rms(row.rms_te_ms.values);
  all["constant_te_ms"] = largest(row.constant_te_ms.values);
  all["dynamic_te_ms"] = largest(row.dynamic_te_ms.values);
  all["below_ms"] = {{"1", evaluation::median_time(row.below_1_ms_s.values)},
                     {"0.1", evaluation::median_time(row.below_0_1_ms_s.values)},
                     {"0.01", evaluation::median_time(row.below_0_01_ms_s.values)}};
  all["holdover_ms"] = {{"60", row.holdover_60_ms.median}, {"600", row.holdover_600_ms.median}};
  all["recovery_s"] = evaluation::median_time(row.recovery_s.values);
  all["packets_per_s"] = row.packets_per_s.median;
  for (const Metric& metric : evaluation::metrics(ResultKind::kClockRuns)) {
    all["metrics"][metric.id] = series_json(metric.series(row));
  }
  return all;
}

Json causes_json(const evaluation::ClockCauses& causes) {
  if (causes.tried.empty()) return nullptr;
  Json all = Json::array();
  for (const evaluation::ClockCause& cause : causes.found) {
    Json sets = Json::object();
    for (const scenarios::Override& set : cause.sets) sets[set.pointer] = set.value;
    all.push_back({{"what", cause.what},
                   {"sets", std::move(sets)},
                   {"spread_from_ms", cause.spread_from_ms},
                   {"spread_to_ms", cause.spread_to_ms},
                   {"largest_from_ms", cause.largest_from_ms},
                   {"largest_to_ms", cause.largest_to_ms}});
  }
  return all;
}

}  // namespace

std::string clock_json(const ClockResults& results) {
  const evaluation::Results& of = results.results;
  Json root = {{"schema_version", kArchiveSchemaVersion},
               {"kind", kClockRunsName},
               {"version", version()},
               {"commit", commit()},
               {"scenario", of.scenario}};
  state_derivation(of.derivation, root);
  if (of.draws_load) root[kOwnLoadMember] = true;
  root.update({{"seeds", {{"first", of.first_seed}, {"count", of.seed_count}}},
               {"duration_s", of.clock_period.duration_s},
               {"from_s", of.clock_period.from_s},
               {"interval_s", to_seconds(evaluation::kReadingInterval)},
               {"period_note", results.period_note},
               {"rows", Json::array()},
               {"warnings", of.warnings},
               {kLoadRealityMember, of.load_reality}});
  if (results.period_note.empty()) root.erase("period_note");
  for (std::size_t row = 0; row < of.rows.size(); ++row) {
    root["rows"].push_back(clock_row_json(of.rows[row], results.curves[row]));
    if (results.hosts.empty()) continue;  // of an archive, which does not keep them
    const evaluation::HostTimeErrors hosts = evaluation::host_medians(results.hosts[row]);
    root["rows"].back()["hosts"] = host_errors_json(hosts.to_truth, 0);
    root["rows"].back()["pairs"] = host_errors_json(hosts.pairs, 1);
  }
  const evaluation::Answer answer = evaluation::answer_of(of);
  root["answer"] = answer_with_fields(answer, clock_answer(of, answer, results.causes), nullptr);
  root["answer"]["causes"] = causes_json(results.causes);
  root["performance"] = performance_json(of.performance);
  return file_text(root);
}

std::string clock_csv(const ClockResults& results) {
  const LineEnds ends(results.results.derivation);
  std::string text = "pipeline,measure,tau_s,value" + ends.header;
  for (std::size_t i = 0; i < results.results.rows.size(); ++i) {
    const Row& row = results.results.rows[i];
    const std::string name = csv_cell(row.pipeline);
    for (const Metric& metric : evaluation::metrics(ResultKind::kClockRuns)) {
      text += fmt::format("{},{},,{}{}", name, metric.id, csv_cell(metric.value(row)), ends.line);
    }
    for (const evaluation::ClockCurve& curve : evaluation::clock_curves()) {
      for (const evaluation::StabilityPoint& point : results.curves[i].*curve.points) {
        text += fmt::format("{},{},{},{}{}", name, curve.id, csv_cell(point.tau_s),
                            csv_cell(point.value), ends.line);
      }
    }
    if (!has_failed(&row)) continue;
    const evaluation::ReasonedStanding standing = standing_among_clocks(row);
    text += fmt::format("{},standing,,{}{}", name, evaluation::standing_id(standing.is), ends.line);
    text += fmt::format("{},failed,,{}{}", name, csv_cell(standing.reason), ends.line);
  }
  return text;
}

void write_series_csv(const ClockResults& results, std::ostream& out) {
  out << "pipeline,seed,time_s,host,te_s\n";
  for (std::size_t row = 0; row < results.results.rows.size(); ++row) {
    const evaluation::ClockReadings& readings = results.readings[row];
    const std::string start = fmt::format("{},{}", csv_cell(results.results.rows[row].pipeline),
                                          results.results.first_seed);
    for (std::size_t i = 0; i < readings.errors_s.front().size(); ++i) {
      const double at_s = readings.start_s + static_cast<double>(i) * readings.interval_s;
      for (std::size_t host = 1; host < readings.errors_s.size(); ++host) {
        out << fmt::format("{},{},{},{:.12f}\n", start, at_s, host, readings.errors_s[host][i]);
      }
    }
  }
}

std::vector<std::string> clock_archive_files() { return {"curves.csv", "series.csv"}; }

void write_clock_archive(OutputFolder& output, const ClockResults& results,
                         const scenarios::Scenario& scenario, const Provenance& provenance) {
  output.file("manifest.json") << manifest_json(provenance, results.results, scenario);
  output.file("results.json") << clock_json(results);
  output.file("curves.csv") << clock_csv(results);
  write_series_csv(results, output.file("series.csv"));
  output.publish();
}

}  // namespace simbench::reports
