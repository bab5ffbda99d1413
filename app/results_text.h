// Results in the format that was asked for, as the run of a scenario prints them.
#ifndef SIMBENCH_APP_RESULTS_TEXT_H_
#define SIMBENCH_APP_RESULTS_TEXT_H_

#include <string>
#include <vector>

#include "evaluation/scoring/results.h"
#include "reports/text/block.h"
#include "scenarios/scenario.h"

namespace simbench::app {

// `format`: table, markdown, csv or json. `more`: what else a table or Markdown is to say.
std::string results_text(const evaluation::Results& results, const scenarios::Scenario& scenario,
                         const std::string& format, const std::vector<reports::Block>& more = {});

}  // namespace simbench::app

#endif  // SIMBENCH_APP_RESULTS_TEXT_H_
