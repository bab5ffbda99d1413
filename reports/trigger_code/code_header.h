// The intervals of a coded trigger as a C header, for a microcontroller's timer.
//
// Interval i is from the i-th pulse that is sent to the next one, in ticks of the timer; behind the
// last one the table begins anew. Each pulse is at the tick nearest to its time, so that rounding
// does not add up; a whole cycle is off by half a tick at most. docs/coded_trigger.md section 6.
//
//   const std::string header = code_header(code, "my_rig", 1e6);
#pragma once

#include <string>

#include "scenarios/trigger_code.h"

namespace simbench::reports {

// `timer_hz`: its ticks, such that an interval has at least one and fits 32 bits. Throws
// scenarios::InputError if it does not.
std::string code_header(const TriggerCode& code, const std::string& scenario, double timer_hz);

}  // namespace simbench::reports
