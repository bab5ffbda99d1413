// A rig that was measured, for the page that shows what is simulated beside it: what `diagnose` and
// `replay` say of the recording, and the stamps' delays, drifts and losses as `fit` reads them.
//
//   const Measured rig = measured({"front.bag", "back.bag"}, "rig.json", {}, {});
//   use(beside_json(rig, world).dump());
//
// Errors: evaluation::FitError, and those of app/recorded_streams.h.
#pragma once

#include <string>
#include <vector>

#include "bags/recorded_files.h"
#include "evaluation/fit/fit.h"
#include "reports/text/json_node.h"
#include "scenarios/scenario.h"

namespace simbench::explore {

struct Measured {
  std::vector<std::string> inputs;
  std::vector<std::string> cameras;  // names
  evaluation::RigFit fit;
  std::string model;  // the scenario file that `simbench fit` writes of it
  reports::Json
      panel;  // {"inputs", "answer", "trust", "overview", "tables": HTML, "data": figures}
};

// `model`: the name of the scenario that is fitted.
Measured measured(const std::vector<std::string>& inputs, const std::string& model,
                  const bags::FileOptions& options, const ReadProgress& progress);

// The recording beside a simulation of this world as many frames long: {"table": HTML}; with
// {"text": why} in its place where the world is of other cameras.
reports::Json beside_json(const Measured& rig, const scenarios::Scenario& world);

}  // namespace simbench::explore
