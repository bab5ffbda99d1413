// The code of a scenario's trigger, and whether the cameras can follow it.
//
// What a sync mode tolerates, the one table of it (docs/coded_trigger.md section 3):
//
//   slave, full slave   each interval within 1 % of the mode's (pulse_window.h), longer than the
//                       mode's less the guard, and than an exposure; no pulse left out.
//                       Assumptions: the maker documents none of this, and the shutter model knows
//                       no window
//   genlock             one pulse is answered and those of two mode periods less the guard ignored,
//                       from one answered to the next it is longer than that, and than exposure
//                       and readout. Pulses may be left out: the camera waits
//   industrial          the same with one mode period (a slave whose profile begins at the pulse)
//   others              no camera follows, a code is nonsense
//
// A camera's clock may be fast or slow by kClockErrorPpm, which shortens or lengthens its periods.
//
//   const std::optional<TriggerCode> code = trigger_code(scenario.trigger);
//   if (code) print(code_problem(scenario, *scenario.scored_stream(), *code));
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "laws/trigger_code.h"
#include "scenarios/scenario.h"

namespace simbench::scenarios {

// Nothing without /trigger/code. The scenario must have passed check_trigger_code().
std::optional<TriggerCode> trigger_code(const Trigger& trigger);

inline constexpr double kClockErrorPpm = 100;

struct CodeLimits {
  std::int64_t pulses_per_frame = 1;  // from an answered pulse to the next one
  Nanoseconds shortest{};             // how far these are apart at least
  Nanoseconds longest = Nanoseconds::max();
  bool may_leave_out = false;
};

// The stream follows the trigger; a camera gets one of so many pulses.
CodeLimits code_limits(const Scenario& scenario, const Stream& stream,
                       std::int64_t pulses_per_camera = 1);

// The shortest and longest time between a pulse and the one so many pulses later.
struct CodeDistances {
  Nanoseconds shortest{};
  Nanoseconds longest{};
};
CodeDistances code_distances(const TriggerCode& code, std::int64_t pulses);

// Why a stream cannot follow the code, with what would work; empty if it can.
struct CodeProblem {
  std::string pointer;  // the member that is to blame
  std::string text;     // found ..., allowed ...
};
std::optional<CodeProblem> code_problem(const Scenario& scenario, const Stream& stream,
                                        const TriggerCode& code,
                                        std::int64_t pulses_per_camera = 1);

// Throws InputError for a code that is none, or that a camera of the rig cannot follow.
void check_trigger_code(const Scenario& scenario);

}  // namespace simbench::scenarios
