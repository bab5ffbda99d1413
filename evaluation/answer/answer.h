// The answer: what the rows of a run say in one paragraph, as data.
//
// A rig can run a pipeline if none of its stages needs the truth, its hosts do not read the
// master's clock, and its stamps are on a clock that hosts share. The others are limits (they need
// the truth) or references (stamps that count from a camera's own first frame). The best pipeline
// is the one with the smallest median of the ranking metric: AMD, or the absolute error where rows
// are ranked by that, or where there is no AMD (one camera). Offline pipelines count like others;
// rows that were captured without truth too. A run of the clocks alone is ranked by their spread,
// and needs nothing but a host_sync that a rig can run.
//
// Every other pipeline that a rig can run is compared with the best seed by seed, with Holm's
// correction over all of them (evaluation/statistics/paired.h): `equals` cannot be told from it by
// these seeds, `next` is the first that is worse. The best is chosen by the same seeds, so the
// distance to `next` is rather too large than too small.
//
// The limit is the row with the oracle in the best one's place of host_sync, if there is one, else
// the row that needs the truth with the smallest median.
//
// Errors: none. Cost: of compare_together() over the rows.
//
//   const Answer answer = answer_of(results, RankedBy::kAmd);
//   if (answer.best != nullptr) print(answer.best->pipeline);
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "evaluation/scoring/results.h"
#include "evaluation/statistics/paired.h"
#include "scenarios/choices.h"

namespace simbench::evaluation {

enum class RankedBy : std::uint8_t {
  kAmd,
  kAbsoluteError,
  kExposureSpread,  // the 95 % quantile over pulses; rows that follow a trigger are references
  kClockSpread,     // of clock runs: the mean spread in time
};
// How a table of captures is ranked.
RankedBy ranked_by(scenarios::TableKind table);

// What a row may be called in an answer.
enum class RowStanding : std::uint8_t {
  kRunnable,   // a rig can run it
  kReference,  // its stamps are on no clock that hosts share
  kLimit,      // it needs the truth
};
RowStanding standing_of(const Row& row);
// In tables: "", "reference" or "limit".
const char* standing_name(RowStanding standing);
// Returns the standing in an answer that ranks so.
RowStanding standing_by(const Row& row, RankedBy ranked_by);

struct Answer {
  RankedBy ranked_by = RankedBy::kAmd;
  std::size_t runnable = 0;              // pipelines with a value
  const Row* best = nullptr;             // null: there is none; all rows are of the results
  std::vector<const Row*> equals{};      // in order of their medians
  const Row* next = nullptr;             // null: none is worse
  PairedComparison to_next{};            // of `next` against the best
  const Row* limit = nullptr;            // null: there is none
  bool limit_is_host_sync = false;       // it has perfect host clocks, and all else as the best
  double times_limit = kNan;             // median over the seeds of best / limit
  std::optional<double> known_within{};  // the median's 95 % interval, as a share of it
};

// `results` must outlive the answer.
Answer answer_of(const Results& results, RankedBy ranked_by);

// The one of these that a rig can run and that has the smallest median; null: there is none.
const Row* best_of(const std::vector<const Row*>& rows, RankedBy ranked_by);

// The series of a row that the answer ranks by.
const Series& ranked_series(const Row& row, RankedBy ranked_by);

}  // namespace simbench::evaluation
