// The rows of a leaderboard: board by board, with ratios to the limit and to the paper.
//
// A leaderboard scenario names its pipelines "<board>.<algorithm>": the rows of a board differ in
// one stage. Its row "<board>.oracle" has the oracle in that stage. Rows without a dot are the
// board "" (references). Ratios are paired by seed: the median of the row's value divided by the
// other's, over seeds in which both exist. Rows are in order of what the results are ranked by
// (scoring/ranked_by.h), rows without a value last; a board whose rows differ in host_sync alone is
// in order of the hosts' clock errors. Estimators that need the whole recording (offline) are
// ranked apart. Rows that differ in gathering alone share one error; they are in order of recall,
// then precision.
//
//   for (const Board& board : leaderboard(results)) board.online.front().row->pipeline;
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "evaluation/scoring/results.h"

namespace simbench::evaluation {

inline constexpr std::string_view kPaperPipeline = "yoon2021_both";

// What is shown of one pipeline where nobody names it: the paper's if it is among the names, else
// the first. `names` must not be empty.
std::string usual_pipeline(const std::vector<std::string>& names);

// Ratios of one row to another; NaN without the other row.
struct PairedRatios {
  Series error;
  Series amd;
};

struct Rank {
  const Row* row = nullptr;  // of the Results
  PairedRatios to_oracle;
  PairedRatios to_paper;
};

struct Board {
  std::string name;
  std::vector<Rank> online;
  std::vector<Rank> offline;
  RankedBy ranked_by = RankedBy::kAmd;
  bool of_gathering = false;  // its rows differ in gathering alone: recall ranks them
};

// Returns the boards in order of their first rows. `results` must outlive them.
std::vector<Board> leaderboard(const Results& results);

// Divides seed by seed; both have the same seeds.
Series paired_ratio(const Series& numerator, const Series& denominator);

}  // namespace simbench::evaluation
