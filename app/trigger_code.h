// What there is to say of a scenario's coded trigger: the code, how soon a camera finds its place
// in it, and what each sync mode of the cameras makes of it.
//
//   const reports::TriggerCodeResult result = trigger_code_of(scenario);
//   print(plain(reports::trigger_code_document(result)));
#pragma once

#include "reports/trigger_code/code_report.h"
#include "scenarios/scenario.h"

namespace simbench::app {

// Throws scenarios::InputError without /trigger/code.
reports::TriggerCodeResult trigger_code_of(const scenarios::Scenario& scenario);

}  // namespace simbench::app
