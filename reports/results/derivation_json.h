// What a scenario rests on, in documents for programs (scenarios/derivation.h).
//
// Members beside "scenario", only of a scenario that rests on another or is changed:
//
//   "based_on": the name of the built-in scenario, or of the own file,
//   "changed": [{"pointer": "/trigger/rate_hz", "from": 45, "to": 30}], null: not there,
//   "published_left_out": the scenario whose published values do not hold here, or null
#ifndef SIMBENCH_REPORTS_RESULTS_DERIVATION_JSON_H_
#define SIMBENCH_REPORTS_RESULTS_DERIVATION_JSON_H_

#include "reports/text/json_node.h"
#include "scenarios/derivation.h"

namespace simbench::reports {

void state_derivation(const scenarios::Derivation& derivation, Json& root);

// Throws scenarios::InputError. A document without the members has none.
scenarios::Derivation read_derivation(const JsonNode& root);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_RESULTS_DERIVATION_JSON_H_
