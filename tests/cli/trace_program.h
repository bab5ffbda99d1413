// Runs `simbench trace`, and finds events in what it wrote.
#pragma once

#include <gmock/gmock.h>

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "tests/cli/program.h"
#include "tests/reports/timeline/trace_format.h"

namespace simbench {

inline std::vector<nlohmann::ordered_json> events_of(const nlohmann::ordered_json& trace,
                                                     const std::string& phase,
                                                     const std::string& category = "") {
  std::vector<nlohmann::ordered_json> found;
  for (const nlohmann::ordered_json& event : trace["traceEvents"]) {
    if (event["ph"] != phase) continue;
    if (category.empty() || event.value("cat", "") == category) found.push_back(event);
  }
  return found;
}

inline std::map<std::int64_t, std::string> track_names(const nlohmann::ordered_json& trace) {
  std::map<std::int64_t, std::string> names;
  for (const nlohmann::ordered_json& event : events_of(trace, "M")) {
    if (event["name"] == "thread_name") names[event["tid"]] = event["args"]["name"];
  }
  return names;
}

// The slices on tracks whose name ends like this.
inline std::vector<nlohmann::ordered_json> slices_on(const nlohmann::ordered_json& trace,
                                                     const std::string& ending) {
  const std::map<std::int64_t, std::string> names = track_names(trace);
  std::vector<nlohmann::ordered_json> found;
  for (const nlohmann::ordered_json& event : events_of(trace, "X")) {
    if (names.at(event["tid"]).ends_with(ending)) found.push_back(event);
  }
  return found;
}

class TraceCommand : public ProgramTest {
 protected:
  // `simbench trace` of a second or so of a scenario.
  ProgramResult trace(const std::string& scenario, std::vector<std::string> more = {}) {
    std::vector<std::string> arguments = {"trace",
                                          "--scenario",
                                          scenario,
                                          "--set",
                                          "/timeline/frames=30",
                                          "--set",
                                          "/timeline/warm_up_ms=300"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
  nlohmann::ordered_json valid_trace(const std::string& scenario,
                                     std::vector<std::string> more = {}) {
    more.insert(more.end(), {"-o", "trace.json"});
    const ProgramResult result = trace(scenario, std::move(more));
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(result.out, "");
    nlohmann::ordered_json json = nlohmann::ordered_json::parse(content("trace.json"));
    EXPECT_THAT(TraceFormat::violations(json), testing::IsEmpty()) << scenario;
    return json;
  }
};

}  // namespace simbench
