// How long the hosts' clocks run where real programs do and nobody says how long: ten hours of an
// algorithm take seconds, ten hours of a program minutes or an hour.
//
//   at least    ten minutes; five minutes beyond what the programs are said to need until a capture
//               (run_before_capture_s), beyond the scenario's last fault, beyond --from-s
//   at most     what keeps a seed to kMostProcessSeconds of programs times simulated seconds, but
//               six minutes, and a minute beyond --from-s, in any case
//
// The loss of the master takes kMasterLostFor and kRecovery more; runs of programs that are shorter
// than that leave it out.
//
//   ClockOptions options;
//   options.duration_s = program_duration_s(scenario, options.pipelines, options.from_s);
//   options.loses_master = loss_is_worth_it(options.duration_s);
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scenarios/scenario.h"

namespace simbench::evaluation {

inline constexpr double kMostProcessSeconds = 21'600;  // six hosts with a program each for an hour

// The pipelines of programs among these names; of all of the scenario if there are none.
std::vector<const scenarios::Pipeline*> program_pipelines(const scenarios::Scenario& scenario,
                                                          const std::vector<std::string>& names);

// In whole minutes. Such pipelines run in the scenario.
std::uint64_t program_duration_s(const scenarios::Scenario& scenario,
                                 const std::vector<std::string>& names, std::uint64_t from_s);

// Whether a run of programs is at least as long as what follows the loss of the master.
bool loss_is_worth_it(std::uint64_t duration_s);

}  // namespace simbench::evaluation
