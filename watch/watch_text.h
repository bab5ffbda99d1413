// A snapshot of a monitor for a terminal: the verdict, the open alarms, a line for each camera and
// clock, the last events.
//
//   print(watch_text(monitor.snapshot()));
#pragma once

#include <string>

#include "reports/text/json_node.h"

namespace simbench::watch {

std::string watch_text(const reports::Json& snapshot);

}  // namespace simbench::watch
