// The parameters of a world as the page shows them: each with its value, unit, range, meaning and
// source, from scenarios/schema.json and `simbench describe`.
//
// JSON: [{"pointer", "value": as JSON, "unit", "meaning", "source", "group": "/usb", "type":
// "number", "integer", "boolean", "word", "text" or "list", and where they are known "low", "high",
// "words": [...], "or_null": true}]. What the page cannot set (pipelines, published values, tables)
// is left out.
//
//   use(parameters_json(world).dump());
#pragma once

#include "reports/text/json_node.h"
#include "scenarios/scenario.h"

namespace simbench::explore {

reports::Json parameters_json(const scenarios::Scenario& scenario);

// The pipelines of the scenario and the algorithms of each stage, of which others can be made:
// {"pipelines": [{"name", "host_sync", "device_time", "gathering", "programs": true}], "stages":
// [{"stage": "host_sync", "algorithms": [{"name", "summary"}]}]}.
reports::Json pipelines_json(const scenarios::Scenario& scenario);

}  // namespace simbench::explore
