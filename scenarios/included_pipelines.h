// Pipelines that a scenario file takes from another scenario, in place of stating them again.
//
//   {"from": "leaderboard_lan", "names": ["host.*"], "device_time": "hull_300_calibrated"}
//
// among the pipelines of a file stands for those of leaderboard_lan, in their order, whose names
// are among `names` (a * at the end: that begin so; without `names`: all) and not among `except`.
// Other members take the place of theirs.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "scenarios/document.h"

namespace simbench::scenarios {

// The pipelines of another scenario; messages about it begin with `place`.
using PipelinesOf =
    std::function<nlohmann::json(const std::string& scenario, const std::string& place)>;

// Puts them in. Throws InputError for an item that is none of these, or of which no pipeline is.
void include_pipelines(PlacedDocument& file, const PipelinesOf& pipelines_of);

}  // namespace simbench::scenarios
