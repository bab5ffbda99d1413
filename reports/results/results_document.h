// Results for people: the output of `simbench run` and the tables of the HTML report.
//
// A block each, with a row per pipeline: the paper's metrics beside the published values, and the
// metrics that need true time; others about the hosts' time errors, the alignment of exposures that
// are steered, colour against depth, the delays of sessions of Algorithms 1 and 2, and the gathered
// sets if the pipelines gather in different ways. The columns are those of
// reports/results/metric_columns.h that name the table. Rows of real rigs state their ground truth;
// those without any are "unverified" (evaluation/scoring/unverified_scores.h). Then follow
// failures, a legend for newcomers, the paper's claims with the fraction of seeds in which each
// holds, and the cost of the run. About 145 columns wide. Source of the definitions: docs/design.md
// section 8.
//
//   std::cout << plain(results_document(results, scenario.summary));
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "algorithms/ports/stage.h"
#include "evaluation/scoring/metrics.h"
#include "evaluation/scoring/results.h"
#include "reports/text/block.h"

namespace simbench::reports {

// `summary`: the scenario's own description, which states whether it is a fit.
Document results_document(const evaluation::Results& results, const std::string& summary);

// The title and the head of documents about results: what the scenario rests on, how it is changed.
std::string results_title(const evaluation::Results& results);
std::vector<std::string> results_head(const evaluation::Results& results,
                                      const std::string& summary);

// The columns of a metric in a table of rows: its value and, if it has a heading, its band.
std::vector<Field<evaluation::Row>> metric_fields(const evaluation::Metric& metric);
// What stands beside AMD where captures were certified; none where none was.
std::vector<Field<evaluation::Row>> certified_fields(const evaluation::Results& results);
// The metrics of a table that has these beside AMD: for the count of its seeds.
std::vector<const evaluation::Metric*> with_certificates(
    std::vector<const evaluation::Metric*> metrics);

// What each row is among these: the best, failed, a limit, a reference.
Field<evaluation::Row> standing_field(const std::vector<const evaluation::Row*>& rows,
                                      evaluation::RankedBy ranked_by);

// The column of the seeds behind a row's medians of these metrics, "14 of 16", if a row has fewer
// than all; "12-14 of 16" where the metrics differ. A metric without any value does not count.
std::vector<Field<evaluation::Row>> scored_seeds_field(
    const std::vector<const evaluation::Row*>& rows,
    const std::vector<const evaluation::Metric*>& metrics);

// How well exposures that are steered coincide; nothing if no row has such a metric.
std::optional<Block> alignment_block(const evaluation::Results& results);
// The meaning of its columns.
std::vector<std::string> alignment_legend();

// The gathered sets: a line per pipeline, to compare policies.
Table sets_table(const std::vector<const evaluation::Row*>& rows);
// The meaning of its columns.
std::vector<std::string> sets_legend(const evaluation::Results& results);

// Where the published AMD values lie among the seeds: "Published AMD, by its percentile [95 %
// interval]: 3 of 4 inside (yoon2021_both at 25 % [11-43], ...); 32 seeds cannot place
// yoon2021_network at 94 % [79-99]."; "" without published values. Nothing but the percentiles of
// these seeds decides what it says.
std::string published_amd_text(const evaluation::Results& results);
struct PublishedAmdCount {
  std::size_t all = 0;
  std::size_t inside = 0;
  std::size_t outside = 0;  // the seeds are too few to place the others
};
PublishedAmdCount published_amd_count(const evaluation::Results& results);

// Published figures of any metric beside the seeds (evaluation/scoring/published_figures.h), in the
// scenario's order, one entry for each whose pipeline has a row; nothing without figures. The block
// has a table, the meaning of its verdicts, and what was measured on what; of lines there is one
// for each figure, for one screen.
std::optional<Block> published_figures_block(const evaluation::Results& results);
std::optional<Block> published_figures_lines(const evaluation::Results& results);

// Real programs beside the algorithms that model them (scenarios/scenario.h, HostPrograms::model);
// nothing where no row is a program whose model has a row. The gap is the median over the seeds of
// the program's value divided by its model's, seed by seed: both met the same world. Captures have
// it of AMD and the host clock error, clock runs of the spread of the hosts' clocks over time and
// the RMS time error.
std::optional<Block> program_gap_block(const evaluation::Results& results);

// A line for each pipeline whose host synchronisation failed, with the first reason; nothing if
// none did. Rows of programs that ended have their lines among the notes.
std::optional<Block> failures_block(const evaluation::Results& results);
// The notes of all rows, the first `most` of them; nothing if there are none. If a program ended,
// they end with where its output is, or what keeps it.
std::optional<Block> notes_block(const evaluation::Results& results,
                                 std::size_t most = std::numeric_limits<std::size_t>::max());

// How the cameras found their places in the trigger's code; nothing where no gathering looks for
// them.
std::optional<Block> search_block(const evaluation::Results& results);

// The floor of two-way methods with unequal links; empty if links are equal.
std::string asymmetry_line(const evaluation::Results& results);

// The stages of each pipeline, for rows of any kind that name them.
template <class Rows>
Block stages_block(const Rows& rows) {
  Block block{.heading = "Pipelines = " + stages_formula(present_stages(rows), " ")};
  for (const auto& row : rows) {
    block.items.push_back(row.pipeline + " = " + joined_stages(row, " + "));
  }
  return block;
}

}  // namespace simbench::reports
