// The differences of two resolved scenarios, and a value of a scenario on one line.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "scenarios/derivation.h"

namespace simbench::scenarios {

// The changes of a world (derivation.h), in the order of scenarios/schema.json.
std::vector<Change> world_changes(const nlohmann::json& from, const nlohmann::json& to);

// Whether there are none.
bool same_world(const nlohmann::json& from, const nlohmann::json& to);

// The changes of the stages of pipelines that have the same name in both.
std::vector<Change> pipeline_changes(const nlohmann::json& from, const nlohmann::json& to);

// The pipeline of that name; null if there is none.
const nlohmann::json* find_pipeline(const nlohmann::json& scenario, const std::string& name);

// A measured table is one value; its numbers are in the file.
bool is_table(const nlohmann::ordered_json& value);
// "45", "genlock", "[0, 1]", "[0.1, ..., 2.5] (1001 numbers)".
std::string value_text(const nlohmann::ordered_json& value);

}  // namespace simbench::scenarios
