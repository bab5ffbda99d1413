#include "reports/results/results_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "evaluation/answer/answer.h"
#include "evaluation/scoring/rows.h"
#include "recording/counted.h"
#include "reports/results/ground_truth_text.h"
#include "reports/results/metric_columns.h"
#include "reports/text/metric_text.h"
#include "reports/text/number_text.h"
#include "reports/text/time_text.h"

namespace simbench::reports {
namespace {

using evaluation::Claim;
using evaluation::Metric;
using evaluation::PublishedComparison;
using evaluation::Results;
using evaluation::Row;
using evaluation::SeedScore;
using RowFields = std::vector<Field<Row>>;

bool any_published(const Results& results) {
  return std::any_of(results.rows.begin(), results.rows.end(),
                     [](const Row& row) { return row.published.has_value(); });
}

std::string cell_text(const Metric& metric, const Row& row) {
  if (metric.is_count()) return metric.is_known(row) ? count_text(metric.count(row)) : "-";
  return metric_text(metric, metric.value(row));
}

Field<Row> published_field(Column column, std::string (*cell)(const PublishedComparison&)) {
  return {std::move(column),
          [cell](const Row& row) { return row.published ? cell(*row.published) : "-"; }};
}

ScoredSeeds scored_seeds_of(const Row& row, const std::vector<const Metric*>& metrics) {
  ScoredSeeds found{.all = row.amd_ms.values.size()};
  for (const Metric* metric : metrics) {
    if (metric->is_series() && !metric->is_time_until())
      found.add(evaluation::scored_seeds(row, *metric));
  }
  if (found.most == 0) found.add(evaluation::scored_seeds(row));
  return found;
}

void append(RowFields& fields, const RowFields& more) {
  fields.insert(fields.end(), more.begin(), more.end());
}

RowFields published_amd_fields() {
  return {
      published_field({"published\nAMD"},
                      [](const auto& known) { return time_text(known.amd_ms); }),
      published_field({.header = "published\nAMD is", .align = Align::kLeft, .is_verdict = true},
                      [](const auto& known) { return placement_text(known.amd_percentile); }),
      published_field({"at percentile\n[95 % interval]"},
                      [](const auto& known) { return percentile_text(known.amd_percentile); })};
}

RowFields published_rmdv_fields() {
  return {
      published_field({"published\nRMDV"},
                      [](const auto& known) { return time_text(known.rmdv_ms); }),
      published_field({.header = "published\nRMDV is", .align = Align::kLeft, .is_verdict = true},
                      [](const auto& known) {
                        return known.rmdv_attainable ? placement_text(known.rmdv_percentile)
                                                     : "not attainable";
                      })};
}

// The paper's two metrics beside the published values.
Table paper_table(const Results& results) {
  const bool published = any_published(results);
  RowFields fields = {pipeline_field<Row>()};
  if (has_real_rows(results)) {
    fields.push_back({{"ground\ntruth", Align::kLeft}, ground_truth_label});
  }
  append(fields, scored_seeds_field(pointers_to(results.rows),
                                    with_certificates(table_metrics(&TablePlaces::paper))));
  for (const Metric* metric : table_metrics(&TablePlaces::paper)) {
    append(fields, metric_fields(*metric));
    if (published && metric->id == std::string_view("amd_ms")) {
      append(fields, published_amd_fields());
    }
    if (metric->id == std::string_view("amd_ms")) append(fields, certified_fields(results));
    if (published && metric->id == std::string_view("rmdv_ms")) {
      append(fields, published_rmdv_fields());
    }
  }
  return table_of(fields, results.rows);
}

// A line per pipeline with the metrics that name the table.
Table table_of_metrics(const std::vector<const Row*>& rows, int TablePlaces::*table) {
  const auto metrics = table_metrics(table);
  RowFields fields = {pipeline_field<Row>()};
  append(fields, scored_seeds_field(rows, metrics));
  for (const Metric* metric : metrics) append(fields, metric_fields(*metric));
  return table_of(fields, rows);
}

Table table_of_metrics(const Results& results, int TablePlaces::*table) {
  return table_of_metrics(pointers_to(results.rows), table);
}

// Whether there are slaves and true time.
bool has_time_errors(const Results& results) {
  return std::any_of(results.rows.begin(), results.rows.end(), [](const Row& row) {
    return evaluation::scored_seeds(row, evaluation::metric("max_te_ms")) > 0;
  });
}

// The rows that have a value of a table's metrics.
std::vector<const Row*> rows_with(const Results& results, int TablePlaces::*table) {
  std::vector<const Row*> rows = pointers_to(results.rows);
  std::erase_if(rows, [metrics = table_metrics(table)](const Row* row) {
    return std::ranges::none_of(metrics, [row](const Metric* metric) {
      return evaluation::scored_seeds(*row, *metric) > 0;
    });
  });
  return rows;
}

// Whether a row is of exposures that may be steered.
bool has_alignment(const Results& results) {
  return !rows_with(results, &TablePlaces::alignment).empty();
}

// Adds a table of the rows that have one of its values, if there are any.
void add_where_known(const Results& results, const char* heading, int TablePlaces::*table,
                     std::vector<Block>& blocks) {
  const std::vector<const Row*> rows = rows_with(results, table);
  if (rows.empty()) return;
  blocks.push_back({.heading = heading, .table = table_of_metrics(rows, table)});
}

// Adds the legends of a table's metrics.
void append_legends(int TablePlaces::*table, std::vector<std::string>& lines) {
  for (const Metric* metric : table_metrics(table)) {
    const MetricColumn column = column_of(*metric);
    const bool is_explained = table == &TablePlaces::sets && column.tables.truth > 0;
    if (is_explained || column.legend[0] == '\0') continue;
    if (column.legend_continues && !lines.empty()) {
      lines.back().append(" ").append(column.legend);
    } else {
      lines.emplace_back(column.legend);
    }
  }
}

bool gatherings_differ(const Results& results) {
  return std::any_of(results.rows.begin(), results.rows.end(), [&](const Row& row) {
    return row.gathering != results.rows.front().gathering;
  });
}

// The meaning of the columns, line by line.
std::vector<std::string> results_legend(const Results& results) {
  std::vector<std::string> lines = {
      fmt::format("{} A value is the median over the {}, [a, b] their band from 5 to 95 %.",
                  shared_worlds(results), has_real_rows(results) ? "repetitions" : "seeds")};
  const auto lacks_seeds = [&results](int TablePlaces::*table) {
    return !scored_seeds_field(pointers_to(results.rows), table_metrics(table)).empty();
  };
  if (lacks_seeds(&TablePlaces::paper) || lacks_seeds(&TablePlaces::certificates) ||
      lacks_seeds(&TablePlaces::truth) ||
      (gatherings_differ(results) && lacks_seeds(&TablePlaces::sets))) {
    lines.emplace_back(kScoredSeedsLegend);
  }
  append_legends(&TablePlaces::paper, lines);
  append_legends(&TablePlaces::truth, lines);
  if (has_time_errors(results)) append_legends(&TablePlaces::time_errors, lines);
  for (const auto table : {&TablePlaces::certificates, &TablePlaces::alignment,
                           &TablePlaces::colour, &TablePlaces::sessions}) {
    if (!rows_with(results, table).empty()) append_legends(table, lines);
  }
  if (std::any_of(results.rows.begin(), results.rows.end(), evaluation::has_single_camera)) {
    lines.emplace_back(kSingleCameraLegend);
  }
  if (const std::string unverified = unverified_legend(results); !unverified.empty()) {
    lines.push_back(unverified);
  }
  if (any_published(results)) {
    lines.push_back(fmt::format(
        "published: the paper's one recording. {} not attainable: under eq. (4) no data have that "
        "RMDV with that AMD.",
        placement_legend()));
  }
  if (gatherings_differ(results)) {
    const std::vector<std::string> sets = sets_legend(results);
    lines.insert(lines.end(), sets.begin(), sets.end());
  }
  const std::string asymmetry = asymmetry_line(results);
  if (!asymmetry.empty()) lines.push_back(asymmetry);
  return lines;
}

Table claims_table(const Results& results) {
  const std::vector<Field<Claim>> fields = {
      {{"claim", Align::kLeft}, &Claim::id},
      {{"holds in"},
       [&results](const Claim& claim) {
         if (!claim.holds_fraction) return std::string("-");
         std::string share = share_text(*claim.holds_fraction);
         if (claim.decided_seeds >= results.seed_count) return share;
         return fmt::format("{} of {}", share, counted(claim.decided_seeds, "seed"));
       }},
      {{"of the paper", Align::kLeft}, [](const Claim& claim) {
         return claim.text + (claim.needs.empty() ? "" : fmt::format(" (needs {})", claim.needs));
       }}};
  return table_of(fields, results.claims);
}

std::string cost_line(const Results& results) {
  const evaluation::Performance& cost = results.performance;
  if (cost.simulated_seconds == 0) {
    return fmt::format("Cost: {:.2f} s ({:.2f} s of CPU).", cost.wall_seconds, cost.cpu_seconds);
  }
  return fmt::format(
      "Cost: {} events in {:.2f} s ({:.2f} s of CPU): {} events/s, {} simulated seconds per "
      "second.",
      short_text(static_cast<double>(cost.events)), cost.wall_seconds, cost.cpu_seconds,
      short_text(cost.events_per_second), short_text(cost.simulated_seconds_per_second));
}

// The line has the first reason, which is mostly the reason of all.
std::string unsynchronised_line(const Row& row) {
  const std::string times =
      row.unsynchronised_hosts == 1 ? "once" : count_text(row.unsynchronised_hosts) + " times";
  std::string line =
      fmt::format("{}: host synchronisation failed {} over all seeds.", row.pipeline, times);
  for (const SeedScore& seed : row.seeds) {
    if (seed.failures.empty()) continue;
    return line + fmt::format(" Seed {}: {}.", seed.seed, seed.failures.front().message);
  }
  return line;
}

// Where to read more of the first program that ended; "" if none did.
std::string program_log_text(const Results& results) {
  for (const Row& row : results.rows) {
    if (row.program_failures.empty()) continue;
    const std::string& log = row.program_failures.front().failure.log;
    return log.empty() ? "--program-log DIR keeps what programs print, and their files."
                       : fmt::format("What the program of {} printed: {}", row.pipeline, log);
  }
  return "";
}

}  // namespace

std::optional<Block> failures_block(const Results& results) {
  Block block;
  for (const Row& row : results.rows) {
    // What ended programs say is among the notes.
    const auto said = static_cast<std::int64_t>(row.program_failures.size());
    if (row.unsynchronised_hosts > said) block.prose.push_back(unsynchronised_line(row));
  }
  return block.prose.empty() ? std::nullopt : std::optional(std::move(block));
}

Field<Row> standing_field(const std::vector<const Row*>& rows, evaluation::RankedBy ranked_by) {
  const Row* const best = evaluation::best_of(rows, ranked_by);
  return {{.header = "is", .align = Align::kLeft, .is_verdict = true},
          [best, ranked_by](const Row& row) {
            return &row == best
                       ? "best"
                       : evaluation::standing_name(evaluation::standing_of(row, ranked_by).is);
          }};
}

std::optional<Block> notes_block(const Results& results, std::size_t most) {
  std::vector<std::string> notes = note_lines(results);
  if (notes.empty()) return std::nullopt;
  if (notes.size() > most) {
    const std::string rest = fmt::format("... and {} more: --verbose", notes.size() - most);
    notes.resize(most);
    notes.push_back(rest);
  }
  if (std::string log = program_log_text(results); !log.empty()) notes.push_back(std::move(log));
  return Block{.heading = "What went wrong", .items = std::move(notes), .is_warning = true};
}

std::vector<Field<Row>> metric_fields(const Metric& metric) {
  const MetricColumn column = column_of(metric);
  // Copied, since the address of a metric may not last.
  RowFields fields = {{{column.heading, Align::kRight, column.legend},
                       [metric](const Row& row) { return cell_text(metric, row); }}};
  if (column.band_heading != nullptr) {
    fields.push_back(
        {{column.band_heading, Align::kRight, column.legend}, [metric](const Row& row) {
           const evaluation::Series& series = metric.series(row);
           return interval_text(metric, series.p05, series.p95);
         }});
  }
  return fields;
}

std::string results_title(const Results& results) {
  return fmt::format("{}: {}", scenarios::named(results.scenario, results.derivation),
                     counted_seeds(results.first_seed, results.seed_count));
}

std::vector<std::string> results_head(const Results& results, const std::string& summary) {
  std::vector<std::string> head = scenarios::derivation_lines(results.derivation);
  if (!summary.empty()) head.insert(head.begin(), summary);
  return head;
}

RowFields scored_seeds_field(const std::vector<const Row*>& rows,
                             const std::vector<const Metric*>& metrics) {
  const auto lacks_seeds = [&metrics](const Row* row) {
    return scored_seeds_of(*row, metrics).lack();
  };
  if (std::none_of(rows.begin(), rows.end(), lacks_seeds)) return {};
  return {{{"seeds", Align::kRight, kScoredSeedsLegend},
           [metrics](const Row& row) { return scored_seeds_text(scored_seeds_of(row, metrics)); }}};
}

std::optional<Block> alignment_block(const Results& results) {
  if (!has_alignment(results)) return std::nullopt;
  return Block{.heading = "Alignment of the exposures",
               .table = table_of_metrics(results, &TablePlaces::alignment)};
}

std::optional<Block> search_block(const Results& results) {
  const RowFields fields = {
      pipeline_field<Row>(),
      {{"found"},
       [](const Row& row) {
         return fmt::format("{} of {}", row.search->found, row.search->sources);
       }},
      {{"again"}, [](const Row& row) { return count_text(row.search->again); }},
      {{"frames\nat most"}, [](const Row& row) { return count_text(row.search->frames); }},
      {{"time\nat most s"}, [](const Row& row) { return number_text(row.search->seconds); }},
      {{"since first frame\nat most s"},
       [](const Row& row) { return number_text(row.search->since_first_frame_s); }},
      {{"wrong place\nat most"},
       [](const Row& row) { return number_text(row.search->error_probability); }}};
  std::vector<const Row*> rows;
  for (const Row& row : results.rows) {
    if (row.search) rows.push_back(&row);
  }
  if (rows.empty()) return std::nullopt;
  return Block{.heading = "Places in the trigger's code, over all seeds",
               .table = table_of(fields, rows),
               .prose = {"found: cameras that found their place; again: searches beyond the first; "
                         "frames and time of a search, the largest of any camera and seed; wrong "
                         "place: the probability that the search itself states "
                         "(docs/coded_trigger.md section 4)."}};
}

std::vector<const Metric*> with_certificates(std::vector<const Metric*> metrics) {
  const std::vector<const Metric*> more = table_metrics(&TablePlaces::certificates);
  metrics.insert(metrics.end(), more.begin(), more.end());
  return metrics;
}

RowFields certified_fields(const Results& results) {
  RowFields fields;
  if (rows_with(results, &TablePlaces::certificates).empty()) return fields;
  for (const Metric* metric : table_metrics(&TablePlaces::certificates)) {
    append(fields, metric_fields(*metric));
  }
  return fields;
}

std::vector<std::string> alignment_legend() {
  std::vector<std::string> lines;
  append_legends(&TablePlaces::alignment, lines);
  return lines;
}

Table sets_table(const std::vector<const Row*>& rows) {
  RowFields fields = {pipeline_field<Row>(), {{"gathering", Align::kLeft}, &Row::gathering}};
  append(fields, scored_seeds_field(rows, table_metrics(&TablePlaces::sets)));
  for (const Metric* metric : table_metrics(&TablePlaces::sets)) {
    append(fields, metric_fields(*metric));
  }
  return table_of(fields, rows);
}

std::vector<std::string> sets_legend(const Results& results) {
  std::vector<std::string> lines;
  append_legends(&TablePlaces::sets, lines);
  if (has_real_rows(results)) {
    lines.emplace_back(
        "Arrivals on a real rig are read from the hosts' own clocks: their difference is an error "
        "of \"emitted after\", which may be negative.");
  }
  return lines;
}

std::string asymmetry_line(const Results& results) {
  if (!results.asymmetry_floor) return "";
  const evaluation::AsymmetryFloor& floor = *results.asymmetry_floor;
  return fmt::format(
      "Floor: unequal links (sigma {}) alone put any host synchronisation that measures over "
      "them at an AMD of {} and a host clock error of {} on average; only methods that do "
      "not measure over the links can be below.",
      time_text(floor.sigma_ms), time_text(floor.amd_ms), time_text(floor.host_error_ms));
}

Document results_document(const Results& results, const std::string& summary) {
  Document document{.title = results_title(results), .head = results_head(results, summary)};
  std::vector<Block>& blocks = document.blocks;
  blocks.push_back({.heading = "The paper's metrics", .table = paper_table(results)});
  if (const std::string published = published_amd_text(results); !published.empty()) {
    blocks.back().prose.push_back(published);
  }
  blocks.push_back({.heading = "Metrics that need true time",
                    .table = table_of_metrics(results, &TablePlaces::truth)});
  if (has_time_errors(results)) {
    blocks.push_back({.heading = "Time error of the hosts",
                      .table = table_of_metrics(results, &TablePlaces::time_errors)});
  }
  add(alignment_block(results), blocks);
  add_where_known(results, "Colour against depth", &TablePlaces::colour, blocks);
  add_where_known(results, "Delays of the sessions of Algorithms 1 and 2", &TablePlaces::sessions,
                  blocks);
  add(published_figures_block(results), blocks);
  add(program_gap_block(results), blocks);
  if (gatherings_differ(results)) {
    blocks.push_back({.heading = "Gathered sets, over all seeds",
                      .table = sets_table(pointers_to(results.rows))});
  }
  add(search_block(results), blocks);
  add(failures_block(results), blocks);
  add(notes_block(results), blocks);
  blocks.push_back({.heading = "How to read it", .items = results_legend(results)});
  blocks.push_back(stages_block(results.rows));
  if (!results.claims.empty()) {
    blocks.push_back(
        {.heading = fmt::format(
             "The paper's claims{}, and the fraction of seeds in which each holds",
             results.derivation.unpublished.empty() ? "" : " about its own rig, not this one"),
         .table = claims_table(results)});
  }
  blocks.push_back({.prose = {cost_line(results)}});
  return document;
}

}  // namespace simbench::reports
