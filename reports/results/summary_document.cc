#include "reports/results/summary_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <vector>

#include "evaluation/answer/answer.h"
#include "evaluation/run/leaderboard.h"
#include "evaluation/scoring/metrics.h"
#include "evaluation/scoring/rows.h"
#include "reports/results/ground_truth_text.h"
#include "reports/results/metric_columns.h"
#include "reports/results/results_document.h"
#include "reports/text/number_text.h"
#include "reports/text/time_text.h"

namespace simbench::reports {
namespace {

using evaluation::Board;
using evaluation::Metric;
using evaluation::Rank;
using evaluation::RankedBy;
using evaluation::Results;
using evaluation::Row;
using RowFields = std::vector<Field<Row>>;

// With these all of it stays on a screen of 50 lines.
constexpr std::size_t kMostSummaryRows = 20;
constexpr std::size_t kMostRowsOfBoard = 7;
constexpr std::size_t kMostNotes = 3;

std::vector<const Metric*> summary_metrics() { return table_metrics(&TablePlaces::summary); }

// The median; of AMD its band too.
void add_metric(const Metric& metric, RowFields& fields) {
  RowFields both = metric_fields(metric);
  const bool with_band = metric.id == std::string_view("amd_ms");
  if (with_band) {
    both[1].sparkline = [metric](const Row& row) { return seeds_sparkline(metric.series(row)); };
  } else {
    both.resize(1);
  }
  fields.insert(fields.end(), both.begin(), both.end());
}

void add_published_amd(const Results& results, RowFields& fields) {
  if (std::ranges::none_of(results.rows, [](const Row& row) { return row.published.has_value(); }))
    return;
  fields.push_back({{"published\nAMD"}, [](const Row& row) {
                      return row.published ? time_text(row.published->amd_ms) : "-";
                    }});
  fields.push_back(
      {{.header = "published\nis", .align = Align::kLeft, .is_verdict = true}, [](const Row& row) {
         return row.published ? placement_text(row.published->amd_percentile) : "-";
       }});
}

RowFields summary_fields(const Results& results, const std::vector<const Row*>& rows,
                         RankedBy ranked_by) {
  RowFields fields = {pipeline_field<Row>(), standing_field(rows, ranked_by)};
  if (has_real_rows(results)) {
    fields.push_back({{"ground\ntruth", Align::kLeft}, ground_truth_label});
  }
  const RowFields seeds = scored_seeds_field(rows, with_certificates(summary_metrics()));
  fields.insert(fields.end(), seeds.begin(), seeds.end());
  for (const Metric* metric : summary_metrics()) {
    add_metric(*metric, fields);
    if (metric->id != std::string_view("amd_ms")) continue;
    add_published_amd(results, fields);
    const RowFields certified = certified_fields(results);
    fields.insert(fields.end(), certified.begin(), certified.end());
  }
  return fields;
}

std::string rest_text(std::size_t rows, std::size_t most) {
  if (rows <= most) return "";
  return fmt::format("... and {} more: --verbose shows them.", rows - most);
}

void shorten(std::vector<const Row*>& rows, std::size_t most, Block& block) {
  if (const std::string rest = rest_text(rows.size(), most); !rest.empty()) {
    block.prose.push_back(rest);
    rows.resize(most);
  }
}

Block rows_block(const Results& results) {
  std::vector<const Row*> rows = pointers_to(results.rows);
  Block block;
  shorten(rows, kMostSummaryRows, block);
  block.table = table_of(summary_fields(results, rows, evaluation::ranking_of(results)), rows);
  return block;
}

// Ranks rows by the spread of their exposures, the least first; rows without one come last.
Block spread_block(const Results& results) {
  constexpr RankedBy ranked_by = RankedBy::kExposureSpread;
  std::vector<const Row*> rows = pointers_to(results.rows);
  std::ranges::stable_sort(rows, {}, [](const Row* row) {
    const double spread_ms = evaluation::ranked_series(*row, ranked_by).median;
    return std::isnan(spread_ms) ? std::numeric_limits<double>::infinity() : spread_ms;
  });
  Block block;
  shorten(rows, kMostSummaryRows, block);
  RowFields fields = {pipeline_field<Row>(), standing_field(rows, ranked_by)};
  for (const Metric* metric : table_metrics(&TablePlaces::alignment)) {
    add_metric(*metric, fields);
  }
  block.table = table_of(fields, rows);
  return block;
}

Block board_block(const Results& results, const Board& board) {
  std::vector<const Row*> rows;
  for (const std::vector<Rank>* ranks : {&board.online, &board.offline}) {
    for (const Rank& rank : *ranks) rows.push_back(rank.row);
  }
  Block block;
  shorten(rows, kMostRowsOfBoard, block);
  block.table = table_of(summary_fields(results, rows, board.ranked_by), rows);
  return block;
}

std::vector<std::string> summary_legend(const Results& results) {
  std::vector<std::string> lines = {
      "Medians over the seeds, with the band from 5 to 95 %. " + shared_worlds(results) +
      " AMD: range of the stamps of a pulse over all cameras. Absolute error: against the true "
      "mid-exposure. Host clock error: slaves against the master. precision: sets of one pulse "
      "only; recall: pulses found whole."};
  if (std::ranges::any_of(results.rows, evaluation::has_single_camera)) {
    lines.emplace_back(kSingleCameraLegend);
  }
  if (!certified_fields(results).empty()) {
    lines.emplace_back(column_of(evaluation::metric("certified_ms")).legend);
  }
  for (const std::string& line :
       {published_amd_text(results), unverified_legend(results), asymmetry_line(results)}) {
    if (!line.empty()) lines.push_back(line);
  }
  return lines;
}

void add_failures(const Results& results, Document& document) {
  add(failures_block(results), document.blocks);
  add(search_block(results), document.blocks);
  add(notes_block(results, kMostNotes), document.blocks);
}

}  // namespace

std::vector<Block> summary_blocks(const Results& results, scenarios::TableKind table) {
  if (table == scenarios::TableKind::kPipelines) return {rows_block(results)};
  if (table == scenarios::TableKind::kAlignment) return {spread_block(results)};
  std::vector<Block> blocks;
  for (const Board& board : evaluation::leaderboard(results)) {
    blocks.push_back(board_block(results, board));
  }
  return blocks;
}

Document summary_document(const Results& results, const SummaryOptions& options,
                          const AnswerText& answer) {
  Document document{.title = results_title(results), .head = paragraphs(answer)};
  const std::vector<std::string> head = results_head(results, options.summary);
  document.head.insert(document.head.end(), head.begin(), head.end());
  document.blocks = summary_blocks(results, options.table);
  add(published_figures_lines(results), document.blocks);
  add_failures(results, document);
  const bool is_of_alignment = options.table == scenarios::TableKind::kAlignment;
  document.blocks.push_back(
      {.prose = is_of_alignment ? alignment_legend() : summary_legend(results)});
  document.blocks.push_back(
      {.prose = {"More: --verbose has all metrics, their meaning and the paper's claims, --budget "
                 "what each stage costs; --output DIR, then simbench report DIR, the figures."}});
  return document;
}

Document quiet_document(const Results& results, const AnswerText& answer) {
  Document document{.title = results_title(results), .head = paragraphs(answer)};
  add_failures(results, document);
  return document;
}

}  // namespace simbench::reports
