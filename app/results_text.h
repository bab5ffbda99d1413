// Results in the format that was asked for, as the run of a scenario prints them.
#ifndef SIMBENCH_APP_RESULTS_TEXT_H_
#define SIMBENCH_APP_RESULTS_TEXT_H_

#include <string>

#include "evaluation/scoring/results.h"
#include "scenarios/scenario.h"

namespace simbench::app {

// `format`: table, markdown, csv or json.
std::string results_text(const evaluation::Results& results, const scenarios::Scenario& scenario,
                         const std::string& format);

}  // namespace simbench::app

#endif  // SIMBENCH_APP_RESULTS_TEXT_H_
