// What a scenario may say about published results (/published, /published_figures and
// /studio/published).
#pragma once

#include "scenarios/scenario.h"

namespace simbench::scenarios {

// Throws InputError unless each published result is of a pipeline of the scenario, and each figure
// states exactly one of at_most, value and at_least. Whether its metric exists is not known here:
// evaluation/run/pipeline_choice.h. Results times pipelines.
void check_published(const Scenario& scenario);

}  // namespace simbench::scenarios
