// `simbench compare`: forms, formats, refusals.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/cli/program.h"

namespace simbench {
namespace {

using Json = nlohmann::ordered_json;
using testing::AllOf;
using testing::HasSubstr;

class Compare : public ProgramTest {
 protected:
  void run_to(const std::string& output, const std::vector<std::string>& more = {},
              const std::string& seeds = "16") const {
    std::vector<std::string> arguments = {"run",
                                          "--scenario",
                                          "18cam_6host_45fps",
                                          "--seeds",
                                          seeds,
                                          "--set",
                                          "/timeline/frames=60",
                                          "--pipelines",
                                          "ntp_last_set,yoon2021_both,oracle",
                                          "--output",
                                          output};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramResult result = run(arguments);
    ASSERT_EQ(result.status, 0) << result.err;
  }
};

TEST_F(Compare, TwoArchivesOfTheSameCodeDoNotDiffer) {
  run_to("a");
  run_to("b");
  const ProgramResult result = run({"compare", "a", "b", "--format", "json"});
  ASSERT_EQ(result.status, 0) << result.err;
  const Json root = Json::parse(result.out);
  ASSERT_EQ(root["pipelines"].size(), 3U);
  for (const Json& pipeline : root["pipelines"]) {
    EXPECT_EQ(pipeline["amd_ms"]["verdict"], "no_difference_seen");
    EXPECT_EQ(pipeline["amd_ms"]["difference"]["high"], 0);
  }
  EXPECT_EQ(run({"compare", "a", "b/results.json"}).status, 0);
}

TEST_F(Compare, HowMuchBetterThanNtp) {
  run_to("a");
  const std::vector<std::string> command = {"compare", "a", "--with-baseline", "ntp_last_set"};
  const ProgramResult result = run(command);
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("yoon2021_both against ntp_last_set: AMD"));
  EXPECT_THAT(result.out, HasSubstr("times smaller ["));
  EXPECT_THAT(result.out, HasSubstr("How to read it"));
  EXPECT_EQ(run(command).out, result.out);
}

TEST_F(Compare, TwoPipelinesInEveryFormat) {
  run_to("a");
  const auto formatted = [&](const std::string& format) {
    return run({"compare", "a", "--pipelines", "yoon2021_both,oracle", "--format", format}).out;
  };
  EXPECT_THAT(formatted("markdown"), HasSubstr("| oracle / yoon2021_both | AMD |"));
  EXPECT_THAT(formatted("csv"), HasSubstr("\nyoon2021_both,oracle,amd_ms,16,0,"));
  EXPECT_LT(Json::parse(formatted("json"))["pipelines"][0]["amd_ms"]["ratio"]["value"], 1);
}

// Beside what it prints; the same command gives the same bytes.
TEST_F(Compare, APageOfTwoArchivesOfPipelinesAndOfABaseline) {
  run_to("a");
  run_to("b");
  const std::vector<std::vector<std::string>> kinds = {
      {"a", "b"}, {"a", "--pipelines", "ntp_last_set,oracle"}, {"a", "--with-baseline", "oracle"}};
  for (const std::vector<std::string>& kind : kinds) {
    std::vector<std::string> command = {"compare", "--html", "page.html"};
    command.insert(command.end(), kind.begin(), kind.end());
    const ProgramResult result = run(command);
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_THAT(result.out, HasSubstr("How to read it"));
    EXPECT_THAT(result.err, HasSubstr("page.html written"));
    const std::string page = content("page.html");
    EXPECT_EQ(page.substr(0, 15), "<!doctype html>");
    for (const char* part : {"<h3>Verdicts</h3>", "\"id\":\"compared_distributions\"",
                             "\"id\":\"paired_differences\""}) {
      EXPECT_NE(page.find(part), std::string::npos) << part;
    }
    EXPECT_EQ(run(command).status, 0);
    EXPECT_EQ(content("page.html"), page);
  }
  const ProgramResult refused = run({"compare", "a", "b", "--html", "none/page.html"});
  EXPECT_EQ(refused.status, 2);
  EXPECT_EQ(refused.out, "");
}

TEST_F(Compare, SaysWhatDiffersAndWhatCanStillBeCompared) {
  run_to("a");
  run_to("slow", {"--set", "/network/latency_fixed_ms=5"});
  const ProgramResult refused = run({"compare", "a", "slow"});
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.err, AllOf(HasSubstr("/network/latency_fixed_ms: 0.1 against 5"),
                                 HasSubstr("--different-scenarios")));
  EXPECT_EQ(run({"compare", "a", "slow", "--different-scenarios"}).status, 0);
  run_to("later", {"--first-seed", "17"});
  const ProgramResult apart = run({"compare", "a", "later"});
  EXPECT_EQ(apart.status, 2);
  EXPECT_THAT(apart.err, HasSubstr("--by-index"));
  const ProgramResult by_index = run({"compare", "a", "later", "--by-index"});
  EXPECT_EQ(by_index.status, 0);
  EXPECT_THAT(by_index.out, HasSubstr("seeds 1-16 with 17-32"));
}

TEST_F(Compare, BadInputIsRefused) {
  run_to("a", {}, "2");
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"a"},
                                             {"a", "a", "a"},
                                             {"a", "nowhere"},
                                             {"a", "a", "--with-baseline", "oracle"},
                                             {"a", "--with-baseline", "no_such"},
                                             {"a", "--pipelines", "oracle"},
                                             {"a", "--pipelines", "oracle,no_such"},
                                             {"a", "a", "--smallest-effect", "-1"}}) {
    std::vector<std::string> command = {"compare"};
    command.insert(command.end(), arguments.begin(), arguments.end());
    const ProgramResult result = run(command);
    EXPECT_EQ(result.status, 2) << testing::PrintToString(arguments);
    EXPECT_THAT(result.err, HasSubstr("error: "));
  }
  const std::string whole = content("a/results.json");
  file("a/results.json", whole.substr(0, whole.size() - 100));
  const ProgramResult cut = run({"compare", "a", "--with-baseline", "oracle"});
  EXPECT_EQ(cut.status, 2);
  EXPECT_THAT(cut.err, HasSubstr("a/results.json:"));
}

}  // namespace
}  // namespace simbench
