// The changes of a rig that its owner can make: other settings of cameras, other wiring of USB,
// better oscillators, the clock sources that can be bought (scenarios/part.h).
//
// A change is what --set would do, so that a user can repeat it. A change is listed only where it
// changes something: exposures that are equal already cannot be made equal. Whether it helps says
// levers.h.
//
//   for (const RigChange& change : rig_changes(scenario)) print(change.what);
#pragma once

#include <string>
#include <vector>

#include "scenarios/loader.h"

namespace simbench::evaluation {

struct RigChange {
  std::string what;  // "equal exposures (no auto-exposure)"
  std::vector<scenarios::Override> sets;
  std::vector<std::string> host_sync{};  // what it makes possible, to be used with it; empty: as is
};

// In the order in which a user would try them: settings first, purchases last.
std::vector<RigChange> rig_changes(const scenarios::Scenario& scenario);

}  // namespace simbench::evaluation
