#include "evaluation/run/leaderboard.h"

#include <algorithm>
#include <cmath>

#include "algorithms/ports/assert.h"
#include "algorithms/ports/stage.h"
#include "evaluation/statistics/statistics.h"

namespace simbench::evaluation {
namespace {

std::string board_of(const Row& row) {
  const std::size_t dot = row.pipeline.find('.');
  return dot == std::string::npos ? "" : row.pipeline.substr(0, dot);
}

PairedRatios ratios(const Row& row, const Row* other) {
  if (other == nullptr) {
    const Series none = make_series({});
    return {.error = none, .amd = none};
  }
  return {.error = paired_ratio(row.absolute_error_ms, other->absolute_error_ms),
          .amd = paired_ratio(row.amd_ms, other->amd_ms)};
}

// Rows without a value come last; equal ones keep their order.
void sort_ranks(RankedBy ranked_by, std::vector<Rank>& ranks) {
  std::stable_sort(ranks.begin(), ranks.end(), [ranked_by](const Rank& a, const Rank& b) {
    const double left = ranked_series(*a.row, ranked_by).median;
    const double right = ranked_series(*b.row, ranked_by).median;
    if (std::isnan(left) || std::isnan(right)) return !std::isnan(left) && std::isnan(right);
    return left < right;
  });
}

void sort_by_recall(std::vector<Rank>& ranks) {
  std::stable_sort(ranks.begin(), ranks.end(), [](const Rank& a, const Rank& b) {
    const auto rank = [](double share) { return std::isnan(share) ? -1 : share; };
    if (rank(a.row->recall) != rank(b.row->recall)) {
      return rank(a.row->recall) > rank(b.row->recall);
    }
    return rank(a.row->precision) > rank(b.row->precision);
  });
}

bool differ_alone_in(PipelineStage stage, const std::vector<Rank>& ranks) {
  const Row& first = *ranks.front().row;
  const auto is_alike_elsewhere = [&](const Rank& rank) {
    return std::ranges::all_of(kPipelineStages, [&](const StageInfo& other) {
      return other.id == stage || at_stage(*rank.row, other.id) == at_stage(first, other.id);
    });
  };
  const auto is_other = [&](const Rank& rank) {
    return at_stage(*rank.row, stage) != at_stage(first, stage);
  };
  return std::ranges::all_of(ranks, is_alike_elsewhere) && std::ranges::any_of(ranks, is_other);
}

// How a board is ranked: as its results, or by the clocks where its rows differ in these alone.
RankedBy ranking_of_board(const Results& results, const std::vector<Rank>& ranks) {
  const RankedBy ranked_by = ranking_of(results);
  const bool is_of_hosts =
      ranked_by == RankedBy::kAmd && differ_alone_in(PipelineStage::kHostSync, ranks) &&
      std::ranges::any_of(
          ranks, [](const Rank& rank) { return !std::isnan(rank.row->host_error_ms.median); });
  return is_of_hosts ? RankedBy::kHostError : ranked_by;
}

}  // namespace

std::string usual_pipeline(const std::vector<std::string>& names) {
  SIMBENCH_ASSERT(!names.empty(), "there is a pipeline");
  const auto paper = std::ranges::find(names, kPaperPipeline);
  return paper != names.end() ? *paper : names.front();
}

Series paired_ratio(const Series& numerator, const Series& denominator) {
  SIMBENCH_ASSERT(numerator.values.size() == denominator.values.size(),
                  "paired series have the same seeds");
  std::vector<double> values;
  values.reserve(numerator.values.size());
  for (std::size_t seed = 0; seed < numerator.values.size(); ++seed) {
    const double below = denominator.values[seed];
    values.push_back(below > 0 ? numerator.values[seed] / below : kNan);
  }
  return make_series(std::move(values));
}

std::vector<Board> leaderboard(const Results& results) {
  const Row* paper = find_row(results.rows, std::string(kPaperPipeline));
  std::vector<Board> boards;
  for (const Row& row : results.rows) {
    const std::string name = board_of(row);
    auto board = std::find_if(boards.begin(), boards.end(),
                              [&](const Board& known) { return known.name == name; });
    if (board == boards.end()) {
      boards.push_back({.name = name, .online = {}, .offline = {}});
      board = boards.end() - 1;
    }
    const Row* oracle = find_row(results.rows, name.empty() ? "oracle" : name + ".oracle");
    (row.offline ? board->offline : board->online)
        .push_back({.row = &row, .to_oracle = ratios(row, oracle), .to_paper = ratios(row, paper)});
  }
  for (Board& board : boards) {
    std::vector<Rank> all = board.online;
    all.insert(all.end(), board.offline.begin(), board.offline.end());
    board.ranked_by = ranking_of_board(results, all);
    board.of_gathering = (board.online.empty() || board.offline.empty()) &&
                         differ_alone_in(PipelineStage::kGathering, all);
    for (std::vector<Rank>* ranks : {&board.online, &board.offline}) {
      if (board.of_gathering) {
        sort_by_recall(*ranks);
      } else {
        sort_ranks(board.ranked_by, *ranks);
      }
    }
  }
  return boards;
}

}  // namespace simbench::evaluation
