// What the tests of scenarios share.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "scenarios/loader.h"

namespace simbench::scenarios {

// A scenario "my" over the built-in 18cam_6host_45fps; `members` begin on line 3.
inline std::string derived(const std::string& members) {
  return "{\"base\": \"18cam_6host_45fps\",\n \"name\": \"my\", \"summary\": \"s\",\n " + members +
         "}\n";
}

inline Scenario load_derived(const std::string& members,
                             const std::vector<Override>& overrides = {}) {
  return load_scenario_text(derived(members), "my.json", overrides);
}

// The resolved studio of a built-in scenario, as JSON.
inline std::string studio_of(const std::string& scenario) {
  return nlohmann::json::parse(load_scenario(scenario).resolved_json()).at("studio").dump();
}

// "FILE:LINE: /pointer" of a value of the built-in 18cam_6host_45fps.
inline std::string place_in_base(const std::string& pointer) {
  return load_scenario("18cam_6host_45fps").origin->describe(pointer);
}

// The message with which loading fails, "" if it does not.
inline std::string error_of_text(const std::string& text,
                                 const std::vector<Override>& overrides = {}) {
  try {
    load_scenario_text(text, "my.json", overrides);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

inline std::string error_of(const std::string& members) { return error_of_text(derived(members)); }

// The message for --set pointer=value on a built-in scenario.
inline std::string error_of_set(const std::string& pointer, const std::string& value) {
  try {
    load_scenario("18cam_6host_45fps", {{pointer, value}});
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace simbench::scenarios
