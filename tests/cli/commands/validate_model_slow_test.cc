// The real-network experiment itself, small: two nodes, one or two repetitions.
#include <gmock/gmock.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/cli/program.h"

namespace simbench {
namespace {

using Json = nlohmann::ordered_json;
using testing::IsEmpty;

// Processes whose command line has this in it.
std::vector<std::string> processes_with(const std::string& text) {
  std::vector<std::string> found;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    std::ifstream in(entry.path() / "cmdline");
    std::string line;
    std::getline(in, line);
    if (line.find(text) != std::string::npos) found.push_back(line);
  }
  return found;
}

class Experiment : public ProgramTest {
 protected:
  std::vector<std::string> command(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments = {
        "validate-model",   "--scenario", "6node_relay",        "--set", "/hosts/count=2", "--set",
        "/cameras/count=6", "--set",      "/timeline/frames=60"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
  // Temporary folders go into the test's own.
  ProgramOptions here() const { return {.environment = {"TMPDIR=" + folder().string()}}; }
  void expect_nothing_left() const {
    EXPECT_THAT(processes_with(folder().string()), IsEmpty());
    for (const std::string& name : names_in()) EXPECT_FALSE(name.starts_with("simbench-")) << name;
  }
};

TEST_F(Experiment, MeasuresWhatTheSimulationSays) {
  const ProgramResult result =
      run(command({"--pipelines", "yoon2021_neither", "--repeats", "2", "--seeds", "20", "--save",
                   "study.json", "--format", "json"}),
          here());
  ASSERT_EQ(result.status, 0) << result.err;
  const Json root = Json::parse(result.out);
  ASSERT_FALSE(root["rows"].empty()) << result.err;
  for (const Json& row : root["rows"]) {
    EXPECT_EQ(row["measured"]["count"], 2) << result.out;
    // Without compensation the slave is behind by the way of one message: 2 ms and a little.
    if (row["metric"] == "host_error_ms") {
      EXPECT_GT(row["measured"]["median"].get<double>(), 2);
      EXPECT_LT(row["measured"]["median"].get<double>(), 20);
    }
  }
  EXPECT_EQ(Json::parse(content("study.json"))["scenario"], "6node_relay");
  expect_nothing_left();
}

TEST_F(Experiment, CtrlCEndsAllOfIt) {
  ProgramOptions options = here();
  options.interrupt_after = std::chrono::milliseconds(4000);
  const ProgramResult result =
      run(command({"--pipelines", "two_way_hull", "--repeats", "20"}), options);
  EXPECT_EQ(result.status, 130) << result.err;
  expect_nothing_left();
}

}  // namespace
}  // namespace simbench
