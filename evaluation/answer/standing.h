// What a row may be called in an answer: ranked among others, failed, a reference or a limit.
//
// A rig can run a pipeline if none of its stages needs the truth, its hosts do not read the
// master's clock, and its stamps are on a clock that the cameras share: the hosts', the trigger's
// code, one of LEDs. The others are limits (they need
// the truth) or references (stamps that count from a camera's own first frame; where exposures are
// ranked, cameras that follow a trigger).
//
// A pipeline that a rig can run has failed if what it is for did not happen, in any of the seeds:
// a host was not synchronised, nothing was recorded, or it found no set of one pulse though cameras
// delivered whole pulses. A small error of what remains then says nothing, so failed rows are
// neither ranked nor compared. Whether a pulse is found whole does not count where rows are ranked
// by clocks or exposures alone. A row of real programs has failed, whatever its stages, if one of
// them ended too early in any of the seeds, which then have no values
// (scoring/program_failures.h).
//
//   const ReasonedStanding standing = standing_of(row, ranking_of(results));
//   if (standing.is == RowStanding::kFailed) print(standing.reason);
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "evaluation/scoring/ranked_by.h"
#include "evaluation/scoring/results.h"

namespace simbench::evaluation {

enum class RowStanding : std::uint8_t {
  kRanked,
  kFailed,
  kReference,
  kLimit,
};
// In results.json: "ranked", "failed", "reference", "limit".
const char* standing_id(RowStanding standing);
// In tables: "" of a ranked row.
const char* standing_name(RowStanding standing);

struct ReasonedStanding {
  RowStanding is = RowStanding::kRanked;
  std::string reason{};  // of a failed row: "no gathered set is of one pulse"
};

// The standing by the stages alone, which cannot have failed. `row` needs no values.
RowStanding standing_of_stages(const Row& row, RankedBy ranked_by);
ReasonedStanding standing_of(const Row& row, RankedBy ranked_by);

// What tells whether a pipeline failed, over all seeds.
struct Outcome {
  double unsynchronised_hosts = 0;
  double sets = 0;
  double pure_sets = 0;        // NaN: it is unknown which frames belong together
  double complete_pulses = 0;  // likewise
};
// "" if it did not.
std::string failure_text(const Outcome& outcome, RankedBy ranked_by);

// The rows of a standing that have a value, in order of their medians, then of recall and
// precision.
std::vector<const Row*> ranked_rows(const std::vector<const Row*>& rows, RowStanding standing,
                                    RankedBy ranked_by);

}  // namespace simbench::evaluation
