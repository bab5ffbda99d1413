#include "reports/results/leaderboard_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "algorithms/ports/stage.h"
#include "evaluation/run/leaderboard.h"
#include "evaluation/scoring/rows.h"
#include "recording/collected.h"
#include "reports/results/ground_truth_text.h"
#include "reports/results/json.h"
#include "reports/results/results_document.h"
#include "reports/text/json_node.h"
#include "reports/text/number_text.h"

namespace simbench::reports {
namespace {

using evaluation::Board;
using evaluation::PairedRatios;
using evaluation::Rank;
using evaluation::Results;
using evaluation::Row;
using evaluation::Series;

// Returns the metrics of a board whose values are medians over the seeds.
std::vector<const evaluation::Metric*> board_metrics() {
  return {&evaluation::metric("absolute_error_ms"), &evaluation::metric("amd_ms"),
          &evaluation::metric("host_error_ms")};
}

Table error_table(const Board& board) {
  const auto name = [&board](const Rank& rank) {
    const std::string& pipeline = rank.row->pipeline;
    const bool unverified = is_unverified(*rank.row);
    return (board.name.empty() ? pipeline : pipeline.substr(board.name.size() + 1)) +
           (unverified ? " (unverified)" : "");
  };
  std::vector<Rank> ranks = board.online;
  ranks.insert(ranks.end(), board.offline.begin(), board.offline.end());
  const auto stamps = [](const Rank& rank) {
    return std::string(rank.row->offline ? "offline" : "online");
  };
  const auto ratio = [](const char* header, PairedRatios Rank::*to, Series PairedRatios::*of) {
    return Field<Rank>{{header},
                       [to, of](const Rank& rank) { return number_text((rank.*to.*of).median); }};
  };
  std::vector<Field<Rank>> fields = {
      {{board.name.empty() ? "reference" : board.name, Align::kLeft}, name},
      {{"stamps", Align::kLeft}, stamps}};
  const std::vector<const Row*> rows = collected(ranks, &Rank::row);
  for (const Field<Row>& field : scored_seeds_field(rows, board_metrics())) {
    fields.push_back({field.column, [field](const Rank& rank) { return field.cell(*rank.row); }});
  }
  const auto add = [&fields](const char* id, bool with_band) {
    for (const Field<Row>& field : metric_fields(evaluation::metric(id))) {
      fields.push_back({field.column, [field](const Rank& rank) { return field.cell(*rank.row); }});
      if (!with_band) break;
    }
  };
  add("absolute_error_ms", true);
  fields.push_back(ratio("error /\noracle's", &Rank::to_oracle, &PairedRatios::error));
  fields.push_back(ratio("error /\npaper's Both", &Rank::to_paper, &PairedRatios::error));
  add("amd_ms", true);
  fields.push_back(ratio("AMD /\noracle's", &Rank::to_oracle, &PairedRatios::amd));
  fields.push_back(ratio("AMD /\npaper's Both", &Rank::to_paper, &PairedRatios::amd));
  add("host_error_ms", false);
  add("packets_per_s", false);
  add("precision", false);
  add("recall", false);
  return table_of(fields, ranks);
}

Table gathering_table(const Board& board) {
  const std::vector<const Row*> rows =
      collected(board.online.empty() ? board.offline : board.online, &Rank::row);
  return sets_table(rows);
}

// "each host_sync + hull_300 + yoon2021": the stage that the board varies, and the other ones.
std::string composition(const Board& board) {
  std::vector<const Row*> rows = collected(board.online, &Rank::row);
  for (const Rank& rank : board.offline) rows.push_back(rank.row);
  std::string text;
  for (const StageInfo& stage : kPipelineStages) {
    const std::string& name = at_stage(*rows.front(), stage.id);
    const bool is_varied =
        std::ranges::any_of(rows, [&](const Row* row) { return at_stage(*row, stage.id) != name; });
    if (!is_varied && name.empty()) continue;
    text += text.empty() ? "" : " + ";
    text += is_varied ? fmt::format("each {}", stage.name) : name;
  }
  return text;
}

std::string order_legend(const Results& results) {
  return fmt::format(
      "Each board is in order of what its rows differ in: host synchronisations of the host clock "
      "error, gatherings of recall, others of {}. absolute error: mean |global stamp - true "
      "mid-exposure on the master's clock|; what all rows share is in it. Ratios are medians over "
      "the seeds, seed by seed: to the row of the board with the oracle in "
      "its place, and to the paper's proposal. packets per s: messages that all hosts sent, from "
      "the start of host synchronisation to the end of the capture. {} Online stamps a frame when "
      "it arrives; offline needs the whole recording.",
      evaluation::ranked_metric(evaluation::ranking_of(results)).title, shared_worlds(results));
}

Json ranks_json(const std::vector<Rank>& ranks) {
  Json entries = Json::array();
  for (const Rank& rank : ranks) {
    entries.push_back({{"pipeline", rank.row->pipeline},
                       {"error_to_oracle", band_json(rank.to_oracle.error)},
                       {"amd_to_oracle", band_json(rank.to_oracle.amd)},
                       {"error_to_paper", band_json(rank.to_paper.error)},
                       {"amd_to_paper", band_json(rank.to_paper.amd)}});
  }
  return entries;
}

}  // namespace

std::vector<Block> board_blocks(const Results& results) {
  std::vector<Block> blocks;
  Block legend{.prose = {order_legend(results)}};
  std::vector<const Row*> all_rows;
  for (const Row& row : results.rows) all_rows.push_back(&row);
  if (!scored_seeds_field(all_rows, board_metrics()).empty()) {
    legend.items.emplace_back(kScoredSeedsLegend);
  }
  for (const Board& board : evaluation::leaderboard(results)) {
    const std::string heading =
        board.name.empty() ? "references" : fmt::format("{}: {}", board.name, composition(board));
    blocks.push_back({.heading = heading,
                      .table = board.of_gathering ? gathering_table(board) : error_table(board)});
    if (board.of_gathering && legend.prose.size() == 1) {
      const std::vector<std::string> sets = sets_legend(results);
      legend.prose.insert(legend.prose.end(), sets.begin(), sets.end());
    }
  }
  blocks.push_back(std::move(legend));
  return blocks;
}

Document leaderboard_document(const Results& results, const std::string& summary) {
  Document document{.title = results_title(results),
                    .head = results_head(results, summary),
                    .blocks = board_blocks(results)};
  if (std::optional<Block> alignment = alignment_block(results)) {
    alignment->prose = alignment_legend();
    document.blocks.push_back(std::move(*alignment));
  }
  add(published_figures_block(results), document.blocks);
  add(failures_block(results), document.blocks);
  add(notes_block(results), document.blocks);
  Block more;
  const bool is_single =
      std::any_of(results.rows.begin(), results.rows.end(), evaluation::has_single_camera);
  for (const std::string& text : {unverified_legend(results), asymmetry_line(results),
                                  std::string(is_single ? kSingleCameraLegend : "")}) {
    if (!text.empty()) more.prose.push_back(text);
  }
  if (!more.prose.empty()) document.blocks.push_back(std::move(more));
  return document;
}

std::string leaderboard_json(const Results& results, const ResultsAnswer& answer) {
  Json root = Json::parse(json(results, answer));
  root["leaderboard"] = Json::array();
  for (const Board& board : evaluation::leaderboard(results)) {
    root["leaderboard"].push_back({{"board", board.name},
                                   {"online", ranks_json(board.online)},
                                   {"offline", ranks_json(board.offline)}});
  }
  return file_text(root);
}

}  // namespace simbench::reports
