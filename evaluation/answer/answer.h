// The answer: what the rows of a run say in one paragraph, as data.
//
// The best pipeline is the ranked one (standing.h) with the smallest median of what the results are
// ranked by (scoring/ranked_by.h); rows of one median are in order of recall and precision. Offline
// pipelines count like others; rows that were captured without truth too. Failed rows are named
// with their reason, and neither ranked nor compared.
//
// Every other ranked pipeline is compared with the best seed by seed, with Holm's correction over
// all of them (evaluation/statistics/paired.h): those in `not_told_apart` show no difference in
// these seeds, `next` is the first that is worse. The best is chosen by the same seeds, so the
// distance to `next` is rather too large than too small. Where no order of so few seeds could reach
// the level after the correction, nothing is told apart, however large the differences are:
// `seeds_needed` says so, and a comparison's `higher` in how many of the seeds the best was lower.
//
// The absolute error alone may crown what is worse in all that matters: a constant that all rows
// share (`shared_bias_ms`) swamps their differences. A row whose AMD and host clock error are both
// larger than those of another with about the same error is not the best.
//
// The limit is the best one's twin with perfect host clocks: the row with the oracle in its place
// of host_sync and all else alike. Another row that needs the truth limits nothing of it.
//
// Errors: none. Cost: of compare_together() over the rows.
//
//   const Answer answer = answer_of(results);
//   if (answer.best != nullptr) print(answer.best->pipeline);
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/answer/standing.h"
#include "evaluation/scoring/ranked_by.h"
#include "evaluation/scoring/results.h"
#include "evaluation/statistics/paired.h"

namespace simbench::evaluation {

struct FailedRow {
  const Row* row = nullptr;
  std::string reason;
};

struct ComparedRow {
  const Row* row = nullptr;
  PairedComparison to_best{};  // of the row against the best
};

// All rows are of the results.
struct Answer {
  RankedBy ranked_by = RankedBy::kAmd;
  std::size_t ranked = 0;                     // pipelines
  const Row* best = nullptr;                  // null: there is none
  std::vector<ComparedRow> not_told_apart{};  // in order of their medians
  std::optional<ComparedRow> next{};          // nothing: none is worse
  std::size_t seeds_needed = 0;               // for any verdict; 0: there are enough
  std::vector<FailedRow> failed{};            // in the order of the results
  std::optional<ComparedRow> limit{};         // nothing: there is none
  double times_limit = kNan;                  // median over the seeds of best / limit
  std::optional<double> known_within{};       // the median's 95 % interval, as a share of it
  std::optional<double> shared_bias_ms{};     // of the absolute error
};

// `results` must outlive the answer.
Answer answer_of(const Results& results);

// The best of these; null: none is ranked. Compares nothing: much cheaper than answer_of().
const Row* best_of(const std::vector<const Row*>& rows, RankedBy ranked_by);
const Row* best_of(const Results& results);

}  // namespace simbench::evaluation
