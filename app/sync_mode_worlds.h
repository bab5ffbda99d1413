// A rig of depth and colour in each sync mode that its cameras have, as the paper compares them:
// GenLock, Slave and Full Slave.
//
// The scenario's own mode is as the scenario states it. Another mode has the trigger that it needs
// (GenLock half of the depth mode's rate, and a common start; the slaves all of it); all else
// stays. The worlds have the paper's pipelines for these modes, also where the scenario has not:
// GenLock is read by its own order, the others by the method, Full Slave also by the clocks without
// it.
//
//   std::vector<std::string> problems;  // why a mode is not there
//   for (const ModeWorld& world : sync_mode_worlds(scenario, problems)) {
//     evaluation::choose_pipelines(world.scenario, world.pipelines);
//   }
#pragma once

#include <string>
#include <vector>

#include "scenarios/scenario.h"

namespace simbench::app {

struct ModeWorld {
  scenarios::Scenario scenario;
  std::vector<std::string> pipelines;
};

// Empty for a rig without both streams. A mode that the rig cannot be in is left out; `problems`
// gets the reason.
std::vector<ModeWorld> sync_mode_worlds(const scenarios::Scenario& scenario,
                                        std::vector<std::string>& problems);

}  // namespace simbench::app
