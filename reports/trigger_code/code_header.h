// The intervals of a coded trigger as a C header, for a microcontroller's timer.
//
// Interval i is from the i-th pulse that is sent to the next one, in ticks of the timer; behind the
// last one the table begins anew. Each pulse is at the tick nearest to its time, so that rounding
// does not add up; a whole cycle is off by half a tick at most. docs/coded_trigger.md section 6.
//
//   const std::string header = code_header(app::trigger_code_of(scenario), 1e6);
#pragma once

#include <string>

#include "reports/trigger_code/code_report.h"

namespace simbench::reports {

// `timer_hz`: its ticks. Throws scenarios::InputError, "--timer-hz ...", unless an interval has at
// least one tick and fits 32 bits, half a tick is at most a twelfth of the code's step, so that
// cameras still find their place, and the intervals in ticks are ones that the scenario's cameras
// take.
std::string code_header(const TriggerCodeResult& result, double timer_hz);

}  // namespace simbench::reports
