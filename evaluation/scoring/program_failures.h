// Rows of real programs that ended too early (ProgramFailure): they have failed, and no number of a
// run in which a program ended is the program's.
//
// From the end of a program on its host's clock runs free, and those that follow it may go with it.
// Such a run therefore keeps its place among the seeds without a value, as one without a recording
// does: NaN in every series, nothing in the counts. A row whose programs ended in some of the seeds
// has failed (answer/standing.h); what it has is of the others.
//
//   const std::vector<ProgramFailure> ended = {
//       {.host = 3, .program = "chronyd", .how = "exited with status 1"}};
//   SeedScore score;
//   score.program_failures = ended;
//   void_score(score);
#pragma once

#include <string>
#include <vector>

#include "evaluation/scoring/results.h"

namespace simbench::evaluation {

// Takes the values of a run in which programs ended; leaves others alone.
void void_score(SeedScore& score);

// For a row of programs: "a program ended in 1 of 4 seeds: seed 2, host 3, at 10.000213 s: chronyd:
// exited with status 1: No such file"; "" if none ended.
std::string program_failure_text(const Row& row);

// Whether the row's programs ended in each of its seeds, or cannot run here. It must
// have its seeds, which archives do not keep.
bool failed_in_all_seeds(const Row& row);

}  // namespace simbench::evaluation
