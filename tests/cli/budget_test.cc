// `simbench run --budget`: the parts of a pipeline's error add up, on the real program.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/cli/program.h"

namespace simbench {
namespace {

using Json = nlohmann::ordered_json;
using testing::HasSubstr;
using testing::IsEmpty;

class BudgetCommand : public ProgramTest {
 protected:
  static std::vector<std::string> small(const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = {
        "run", "--budget", "--scenario",          "18cam_6host_45fps_lan", "--seeds",
        "2",   "--set",    "/timeline/frames=20", "--pipelines",           "yoon2021_both"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
};

TEST_F(BudgetCommand, PartsAndRemainderAddUpToTheTotal) {
  const ProgramResult result = run(small({"--format", "json"}));
  ASSERT_EQ(result.status, 0) << result.err;
  const Json budget = Json::parse(result.out)["budgets"][0];
  EXPECT_EQ(budget["pipeline"], "yoon2021_both");
  for (const char* error : {"amd_ms", "absolute_error_ms", "physical_ms"}) {
    const Json& parts = budget[error];
    ASSERT_EQ(parts["stages"].size(), 7U);
    double sum = parts["remainder"]["mean"].get<double>();
    for (const Json& stage : parts["stages"]) sum += stage["mean"].get<double>();
    EXPECT_NEAR(sum, parts["total"]["mean"].get<double>(), 1e-9) << error;
  }
  const Json& host_clock = budget["host_error_ms"];
  EXPECT_TRUE(host_clock["note"].is_null());
  double sum = host_clock["algorithm"]["mean"].get<double>();
  for (const Json& part : host_clock["parts"]) sum += part["mean"].get<double>();
  EXPECT_NEAR(sum, host_clock["total"]["mean"].get<double>(), 1e-12);
  EXPECT_THAT(result.err, HasSubstr("272 runs in"));
}

TEST_F(BudgetCommand, TheTableNamesEveryStage) {
  const ProgramResult result = run(small());
  ASSERT_EQ(result.status, 0) << result.err;
  for (const char* part :
       {"trigger", "exposure", "stamp quantisation", "device clock", "USB delivery", "host clock",
        "gathering", "remainder", "Shapley", "estimation", "staleness", "steering", "algorithm"}) {
    EXPECT_THAT(result.out, HasSubstr(part));
  }
}

TEST_F(BudgetCommand, SaysWhyHostClocksAreNotDivided) {
  const ProgramResult result =
      run({"run", "--budget", "--scenario", "18cam_6host_45fps_lan", "--seeds", "1", "--set",
           "/timeline/frames=20", "--pipelines", "oracle", "--format", "markdown"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("Not divided: oracle sends nothing and sets no clock."));
  EXPECT_THAT(result.err, HasSubstr("128 runs in"));
}

TEST_F(BudgetCommand, RefusesWhatABudgetHasNot) {
  const ProgramResult csv = run(small({"--format", "csv"}));
  EXPECT_EQ(csv.status, 2);
  EXPECT_THAT(csv.out, IsEmpty());
  EXPECT_THAT(csv.err, HasSubstr("--format: found 'csv', allowed with --budget"));
  const ProgramResult archive = run(small({"--output", "results"}));
  EXPECT_EQ(archive.status, 2);
  EXPECT_THAT(archive.err, HasSubstr("--output"));
  EXPECT_THAT(names_in(), IsEmpty());
}

}  // namespace
}  // namespace simbench
