// --json: the result as JSON on standard output, all else as JSON lines on standard error.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/cli/program.h"

namespace simbench {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class JsonMessages : public ProgramTest {
 protected:
  // Fails where a line of standard error is no JSON object with an event.
  static std::vector<json> events(const ProgramResult& result) {
    std::istringstream in(result.err);
    std::vector<json> found;
    for (std::string line; std::getline(in, line);) {
      json event = json::parse(line, nullptr, false);
      EXPECT_TRUE(event.is_object() && event.contains("event")) << line;
      found.push_back(std::move(event));
    }
    return found;
  }
  std::vector<std::string> small_run(std::vector<std::string> more) {
    std::vector<std::string> all = {"run", "--scenario", "3cam_1host_30fps",    "--seeds",
                                    "2",   "--set",      "/timeline/frames=20", "--json"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
};

TEST_F(JsonMessages, ARunStartsProgressesAndEnds) {
  const ProgramResult result =
      run(small_run({"--pipelines", "free_running,oracle", "--no-levers"}));
  EXPECT_EQ(result.status, 0);
  EXPECT_TRUE(json::parse(result.out).contains("schema_version"));
  const std::vector<json> seen = events(result);
  ASSERT_GE(seen.size(), 3);
  EXPECT_EQ(seen.front(), json({{"event", "start"}, {"unit", "runs"}}));
  EXPECT_EQ(seen[1].at("event"), "progress");
  EXPECT_TRUE(seen[1].contains("eta_s"));
  EXPECT_EQ(seen.back().at("event"), "end");
  EXPECT_EQ(seen.back().at("done"), 4);
  EXPECT_EQ(seen.back().at("total"), 4);
  EXPECT_GE(seen.back().at("elapsed_s"), 0);
}

TEST_F(JsonMessages, WarningsAndNotesStayReadable) {
  const ProgramResult result =
      run(small_run({"--set", "/usb/bandwidth_mb_per_s=0.5", "--output", "results"}));
  EXPECT_EQ(result.status, 0) << result.err;
  std::string kinds;
  for (const json& event : events(result)) kinds += event.at("event").get<std::string>() + " ";
  EXPECT_THAT(kinds, HasSubstr("warning "));
  EXPECT_THAT(kinds, HasSubstr("note "));
}

TEST_F(JsonMessages, AnErrorIsAnEventEvenBeforeTheOptionsAreRead) {
  for (const std::vector<std::string>& wrong :
       {small_run({"--seeds", "many"}), small_run({"--colour"}),
        std::vector<std::string>{"run", "--scenario", "no_such.json", "--json"}}) {
    const ProgramResult result = run(wrong);
    EXPECT_EQ(result.status, 2);
    EXPECT_EQ(result.out, "");
    const std::vector<json> seen = events(result);
    ASSERT_EQ(seen.size(), 1);
    EXPECT_EQ(seen[0].at("event"), "error");
  }
}

TEST_F(JsonMessages, AnotherFormatIsRefused) {
  const ProgramResult result = run(small_run({"--format", "csv"}));
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("--format csv"));
  EXPECT_EQ(run(small_run({"--format", "json"})).status, 0);
}

TEST_F(JsonMessages, AnInterruptedRunSaysHowFarItGot) {
  const ProgramResult result =
      run({"run", "--scenario", "18cam_6host_45fps", "--seeds", "100000", "--json"},
          {.interrupt_after = std::chrono::milliseconds(500)});
  EXPECT_EQ(result.status, 130);
  EXPECT_EQ(result.out, "");
  const std::vector<json> seen = events(result);
  ASSERT_FALSE(seen.empty());
  EXPECT_EQ(seen.back().at("event"), "interrupt");
  EXPECT_EQ(seen.back().at("unit"), "runs");
}

}  // namespace
}  // namespace simbench
