// What commands say of runs of real programs: at the start what is simulated, at the end by the
// exit status whether programs failed.
//
//   print_note(programs_note(scenario, {"chrony", "mine"}, /*seeds=*/4));
//   const evaluation::Results found = evaluation::evaluate(scenario, make_source, {}, nullptr);
//   const int status = status_of(found);
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/clock_run/clock_evaluation.h"
#include "evaluation/scoring/results.h"
#include "scenarios/scenario.h"

namespace simbench::cli {

// "simulates 4 seeds of 6 hosts: 17 pipelines, of which cristian (python3, 71 s each) runs real
// programs"; "" if none of these does. `names`: empty, all of the scenario. `duration_s`: of a
// clock run; nothing: what each needs until its capture, and that.
std::string programs_note(const scenarios::Scenario& scenario,
                          const std::vector<std::string>& names, std::uint64_t seeds,
                          std::optional<std::uint64_t> duration_s = {});

// Chooses how long clocks run with real programs (evaluation/clock_run/program_duration.h), if
// nobody did; without programs it is what it was. Returns what the results say of it; "": nothing.
std::string choose_duration(const scenarios::Scenario& scenario,
                            std::optional<std::uint64_t> stated_s,
                            evaluation::ClockOptions& options);

// kProgramFailed if the programs of one of the pipelines ended too early in every seed, or cannot
// run here; else kOk.
int status_of(const evaluation::Results& results);

}  // namespace simbench::cli
