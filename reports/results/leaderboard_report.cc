#include "reports/results/leaderboard_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <vector>

#include "evaluation/run/leaderboard.h"
#include "reports/results/ground_truth_text.h"
#include "reports/results/json.h"
#include "reports/results/sets_block.h"
#include "reports/text/number_text.h"
#include "reports/text/text_table.h"

namespace simbench::reports {
namespace {

using evaluation::Board;
using evaluation::Rank;
using evaluation::Results;
using evaluation::Row;
using evaluation::Series;
using Json = nlohmann::ordered_json;  // keeps members in order; writes NaN as null

std::string own_name(const Board& board, const Row& row) {
  return board.name.empty() ? row.pipeline : row.pipeline.substr(board.name.size() + 1);
}

void add_ranks(const Board& board, const std::vector<Rank>& ranks, TextTable& table) {
  for (const Rank& rank : ranks) {
    const Row& row = *rank.row;
    const bool unverified = ground_truth_label(row) == "unverified";
    table.add({own_name(board, row) + (unverified ? " (unverified)" : ""),
               row.offline ? "offline" : "online", number_text(row.absolute_error_ms.median),
               band_text(row.absolute_error_ms), number_text(rank.to_oracle.error.median),
               number_text(rank.to_paper.error.median), number_text(row.amd_ms.median),
               band_text(row.amd_ms), number_text(rank.to_oracle.amd.median),
               number_text(rank.to_paper.amd.median), number_text(row.host_error_ms.median),
               share_text(row.precision), share_text(row.recall)});
  }
}

TextTable block(const Board& board) {
  TextTable table({{board.name.empty() ? "reference" : board.name, Align::kLeft},
                   {"stamps", Align::kLeft},
                   {"absolute error\nmedian ms"},
                   {"absolute error\n5-95 %"},
                   {"error /\noracle's"},
                   {"error /\npaper's Both"},
                   {"AMD\nmedian ms"},
                   {"AMD\n5-95 %"},
                   {"AMD /\noracle's"},
                   {"AMD /\npaper's Both"},
                   {"host clock error\nmedian ms"},
                   {"sets:\nprecision"},
                   {"sets:\nrecall"}});
  add_ranks(board, board.online, table);
  add_ranks(board, board.offline, table);
  return table;
}

TextTable gathering_block(const Board& board) {
  std::vector<const Row*> rows;
  for (const Rank& rank : board.online.empty() ? board.offline : board.online) {
    rows.push_back(rank.row);
  }
  return sets_block(rows);
}

// "host = host_sync x hull_300 + yoon2021": which stage the board varies, and what the others are.
std::string composition(const Board& board) {
  std::vector<const Row*> rows;
  for (const Rank& rank : board.online) rows.push_back(rank.row);
  for (const Rank& rank : board.offline) rows.push_back(rank.row);
  const auto stage = [&rows](const char* name, std::string Row::*algorithm) {
    for (const Row* row : rows) {
      if (row->*algorithm != rows.front()->*algorithm) return fmt::format("each {}", name);
    }
    return rows.front()->*algorithm;
  };
  return fmt::format("{} + {} + {}", stage("host_sync", &Row::host_sync),
                     stage("device_time", &Row::device_time), stage("gathering", &Row::gathering));
}

bool any_of_gathering(const Results& results) {
  const std::vector<Board> boards = evaluation::leaderboard(results);
  return std::any_of(boards.begin(), boards.end(),
                     [](const Board& board) { return board.of_gathering; });
}

std::string leaderboard(const Results& results, std::string_view summary, bool as_markdown) {
  std::string text = fmt::format("{}{}: {} seeds from {}\n", as_markdown ? "## " : "",
                                 results.scenario, results.seed_count, results.first_seed);
  if (!summary.empty()) text += fmt::format("{}\n", wrapped(summary));
  for (const Board& board : evaluation::leaderboard(results)) {
    const TextTable table = board.of_gathering ? gathering_block(board) : block(board);
    const std::string heading =
        board.name.empty() ? "references" : fmt::format("{}: {}", board.name, composition(board));
    text += fmt::format("\n{}{}\n\n{}", as_markdown ? "### " : "", heading,
                        as_markdown ? table.markdown() : table.plain());
  }
  text += fmt::format(
      "\n{}",
      wrapped(
          "Sorted by absolute error: mean |global stamp - true mid-exposure on the master's "
          "clock|. "
          "Ratios are medians over the seeds, each seed against the same seed: to the row of the "
          "board "
          "with the oracle in its place, and to the paper's proposal. Every pipeline meets the "
          "same "
          "worlds. Online stamps a frame when it arrives; offline has seen the whole recording."));
  for (const std::string& line : note_lines(results)) text += fmt::format("\n{}", wrapped(line));
  const std::string unverified = unverified_legend(results);
  if (!unverified.empty()) text += fmt::format("\n{}", wrapped(unverified));
  if (any_of_gathering(results)) text += fmt::format("\n{}", wrapped(kSetsLegend));
  const std::string asymmetry = asymmetry_line(results);
  return asymmetry.empty() ? text : fmt::format("{}\n{}", text, wrapped(asymmetry));
}

Json ratio_json(const Series& ratio) {
  return {{"median", ratio.median}, {"p05", ratio.p05}, {"p95", ratio.p95}};
}

Json ranks_json(const std::vector<Rank>& ranks) {
  Json entries = Json::array();
  for (const Rank& rank : ranks) {
    entries.push_back({{"pipeline", rank.row->pipeline},
                       {"error_to_oracle", ratio_json(rank.to_oracle.error)},
                       {"amd_to_oracle", ratio_json(rank.to_oracle.amd)},
                       {"error_to_paper", ratio_json(rank.to_paper.error)},
                       {"amd_to_paper", ratio_json(rank.to_paper.amd)}});
  }
  return entries;
}

}  // namespace

std::string leaderboard_table(const Results& results, std::string_view summary) {
  return fitted(leaderboard(results, summary, false));
}

std::string leaderboard_markdown(const Results& results, std::string_view summary) {
  return leaderboard(results, summary, true);
}

std::string leaderboard_json(const Results& results) {
  Json root = Json::parse(json(results));
  root["leaderboard"] = Json::array();
  for (const Board& board : evaluation::leaderboard(results)) {
    root["leaderboard"].push_back({{"board", board.name},
                                   {"online", ranks_json(board.online)},
                                   {"offline", ranks_json(board.offline)}});
  }
  return root.dump(2) + "\n";
}

std::string asymmetry_line(const Results& results) {
  if (!results.asymmetry_floor) return "";
  const evaluation::AsymmetryFloor& floor = *results.asymmetry_floor;
  return fmt::format(
      "Floor: unequal links (sigma {} ms) alone put any host synchronisation that measures over "
      "them at an AMD of {} ms and a host clock error of {} ms on average; only methods that do "
      "not measure over the links can be below.",
      number_text(floor.sigma_ms), number_text(floor.amd_ms), number_text(floor.host_error_ms));
}

}  // namespace simbench::reports
