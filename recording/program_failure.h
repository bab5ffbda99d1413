// Real programs that ended too early (ProgramFailure), in words: one home for what outcomes, notes
// and reasons say of them.
//
//   const std::vector<ProgramFailure> failures = {
//       {.host = 3, .program = "chronyd", .at = from_ms(250), .how = "exited with status 1"}};
//   failure_text(failures.front());  // "host 3, at 0.250000 s: chronyd: exited with status 1"
//   for (const std::string& line : failure_lines(failures)) print(line);
#pragma once

#include <span>
#include <string>
#include <vector>

#include "algorithms/ports/exchange.h"

namespace simbench {

// "0.250000 s": a time since the run began, to the microsecond.
std::string run_time_text(Nanoseconds at);

// "host 3, at 0.250000 s: chronyd: exited with status 1: No such file".
std::string failure_text(const ProgramFailure& failure);

// A line for each way in which programs of one run ended, with the hosts and the first time:
// "hosts 1, 2, first at 0.250000 s: chronyd: exited with status 1: No such file".
std::vector<std::string> failure_lines(std::span<const ProgramFailure> failures);

}  // namespace simbench
