// A world that was changed says so in every output, and keeps no word or value of the unchanged
// one.
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
using testing::Not;

constexpr const char* kChanges =
    "changed: /hosts/count 6 → 4, /trigger/rate_hz 45 → 30, /cameras/count 18 → 12";
constexpr const char* kHeading = "18cam_6host_45fps (changed)";

class ChangedWorld : public ProgramTest {
 protected:
  // A command on the world with fewer cameras and hosts.
  ProgramResult on_changed(std::vector<std::string> arguments,
                           const std::vector<std::string>& more = {}) const {
    for (const char* word :
         {"--scenario", "18cam_6host_45fps", "--set", "/trigger/rate_hz=30", "--set",
          "/cameras/count=12", "--set", "/hosts/count=4", "--pipelines", "yoon2021_both"}) {
      arguments.emplace_back(word);
    }
    arguments.insert(arguments.end(), more.begin(), more.end());
    ProgramResult result = run(arguments);
    EXPECT_EQ(result.status, 0) << result.err;
    return result;
  }
  std::string output(const std::vector<std::string>& more) const {
    return on_changed({"run", "--seeds", "2"}, more).out;
  }
};

TEST_F(ChangedWorld, IsStatedInTables) {
  for (const char* format : {"table", "markdown"}) {
    const std::string text = output({"--format", format});
    EXPECT_THAT(text, AllOf(HasSubstr(kHeading), HasSubstr(kChanges))) << format;
    EXPECT_THAT(text, HasSubstr("Cameras: 12, hosts: 4")) << format;
    EXPECT_THAT(text, HasSubstr("The published values of 18cam_6host_45fps are left out"))
        << format;
    for (const char* of_another_world : {"2.44 ms", "18 cameras in genlock", "published AMD"}) {
      EXPECT_THAT(text, Not(HasSubstr(of_another_world))) << format;
    }
  }
}

TEST_F(ChangedWorld, IsStatedInCsvAndJson) {
  const std::string csv = output({"--format", "csv"});
  EXPECT_THAT(csv.substr(0, csv.find('\n')), testing::EndsWith(",changed"));
  EXPECT_THAT(csv, HasSubstr(std::string(",\"") + kChanges + "\"\n"));
  const Json root = Json::parse(output({"--format", "json"}));
  EXPECT_EQ(root["scenario"], "18cam_6host_45fps");
  EXPECT_EQ(root["based_on"], "18cam_6host_45fps");
  EXPECT_EQ(root["changed"][1],
            Json::parse(R"({"pointer": "/trigger/rate_hz", "from": 45, "to": 30})"));
  EXPECT_EQ(root["published_left_out"], "18cam_6host_45fps");
  EXPECT_TRUE(root["rows"][0]["published"].is_null());
}

TEST_F(ChangedWorld, IsStatedInArchivesAndTheirReports) {
  output({"--output", "archive"});
  EXPECT_EQ(Json::parse(content("archive/manifest.json"))["changed"].size(), 3U);
  for (const char* name : {"archive/frames.csv", "archive/hosts.csv"}) {
    EXPECT_THAT(content(name), HasSubstr(kChanges)) << name;
  }
  ASSERT_EQ(run({"report", "archive", "-o", "page.html"}).status, 0);
  EXPECT_THAT(content("page.html"), AllOf(HasSubstr(kHeading), HasSubstr(kChanges),
                                          Not(HasSubstr("18 cameras in genlock"))));
  const ProgramResult comparison = run({"compare", "archive", "archive"});
  EXPECT_THAT(comparison.out, AllOf(HasSubstr(kHeading), HasSubstr(kChanges))) << comparison.err;
  ASSERT_EQ(run({"gate", "archive", "--save-baseline", "baseline.json"}).status, 0);
  const ProgramResult gate = run({"gate", "archive", "--baseline", "baseline.json"});
  EXPECT_THAT(gate.out, AllOf(HasSubstr(kHeading), HasSubstr(kChanges))) << gate.err;
}

TEST_F(ChangedWorld, IsStatedInFigures) {
  on_changed({"figure", "host_clocks"}, {"--seed", "3", "-o", "clocks.svg"});
  EXPECT_THAT(content("clocks.svg"),
              AllOf(HasSubstr("<title>Clock errors of the hosts over time</title>"),
                    HasSubstr(std::string(kHeading) + ", yoon2021_both, 1 seed (3), simbench"),
                    HasSubstr(kChanges), Not(HasSubstr("<title>Gnuplot"))));
  on_changed({"figure", "distributions"}, {"--seeds", "2", "-o", "amd.csv"});
  EXPECT_THAT(content("amd.csv"), AllOf(testing::StartsWith("panel,series,x,y,changed\n"),
                                        HasSubstr(kChanges), Not(HasSubstr("published"))));
}

TEST_F(ChangedWorld, IsStatedInSweeps) {
  const ProgramResult sweep = on_changed({"sweep", "--sweep", "/timeline/frames=20,30"},
                                         {"--seeds", "2", "--output", "sweep"});
  EXPECT_THAT(sweep.out, AllOf(HasSubstr(kHeading), HasSubstr(kChanges)));
  const std::string csv = content("sweep/sweep.csv");
  EXPECT_THAT(csv.substr(0, csv.find('\n')), testing::EndsWith(",changed"));
  EXPECT_THAT(csv, HasSubstr(kChanges));
  EXPECT_EQ(Json::parse(content("sweep/manifest.json"))["changed"].size(), 3U);
  EXPECT_THAT(content("sweep/sweep.svg"), HasSubstr(kChanges));
}

TEST_F(ChangedWorld, IsStatedInBudgetsAndDescriptions) {
  const std::vector<std::string> budget = {"run", "--budget", "--seeds", "1"};
  EXPECT_THAT(on_changed(budget).out, AllOf(HasSubstr(kHeading), HasSubstr(kChanges)));
  EXPECT_EQ(Json::parse(on_changed(budget, {"--format", "json"}).out)["changed"].size(), 3U);
  const ProgramResult described =
      run({"describe", "18cam_6host_45fps", "--set", "/trigger/rate_hz=30"});
  EXPECT_THAT(described.out,
              AllOf(HasSubstr(kHeading), HasSubstr("changed: /trigger/rate_hz 45 → 30")));
}

TEST_F(ChangedWorld, IsStatedInCertificatesAndCodes) {
  const ProgramResult certified =
      run({"certify", "18cam_6host_45fps", "--pipelines", "yoon2021_both", "--set",
           "/timeline/frames=5", "--pairs", "pairs.csv"});
  EXPECT_THAT(certified.out,
              AllOf(HasSubstr(kHeading), HasSubstr("changed: /timeline/frames 480 → 5")))
      << certified.err;
  EXPECT_THAT(content("pairs.csv"), AllOf(HasSubstr(",truth_ms,changed\n"),
                                          HasSubstr(",changed: /timeline/frames 480 → 5\n")));
  const std::vector<std::string> code = {"code", "18cam_6host_90fps_coded", "--set",
                                         "/trigger/code/shift_us=40"};
  const char* const change = "changed: /trigger/code/shift_us 50 → 40";
  EXPECT_THAT(run(code).out,
              AllOf(HasSubstr("18cam_6host_90fps_coded (changed)"), HasSubstr(change)));
  std::vector<std::string> exported = code;
  exported.insert(exported.end(), {"--json", "--export", "intervals.h"});
  EXPECT_EQ(Json::parse(run(exported).out)["changed"].size(), 1U);
  EXPECT_THAT(content("intervals.h"), HasSubstr("of 18cam_6host_90fps_coded (changed), made"));
}

TEST_F(ChangedWorld, IsStatedInAdvice) {
  const ProgramResult advice =
      run({"advise", "--require", "amd<5ms", "--cameras", "2", "--hosts", "1", "--seeds", "8",
           "--set", "/cameras/oscillator/skew_sigma_ppm=90"});
  EXPECT_THAT(advice.out, HasSubstr("The world is 18cam_6host_45fps_lan with "
                                    "/cameras/oscillator/skew_sigma_ppm=90: "))
      << advice.err;
}

TEST_F(ChangedWorld, IsStatedBesideAMeasuredOne) {
  file("study.json", R"({"schema_version": 1, "date": "2026-11-23", "machine": "any", "commit": "1",
    "scenario": "6node_relay", "rows": [{"pipeline": "yoon2021_both", "notes": [],
    "seeds": [{"seed": 1, "amd_ms": 1, "rmdv_ms": 1, "absolute_error_ms": 1, "host_error_ms": 1}]}]})");
  const ProgramResult gap = run({"validate-model", "--scenario", "6node_relay", "--measured",
                                 "study.json", "--seeds", "2", "--set", "/timeline/frames=20"});
  EXPECT_THAT(gap.out, AllOf(HasSubstr("Measured: the scenario itself"),
                             HasSubstr("Simulated: changed: /timeline/frames "),
                             HasSubstr("not the same world")))
      << gap.err;
}

TEST_F(ChangedWorld, OfAnOwnScenarioNamesItsBase) {
  file("mine.json", R"({"base": "18cam_6host_45fps", "name": "mine", "summary": "My own words.",
                        "hosts": {"count": 3}, "cameras": {"count": 9}})");
  const ProgramResult result =
      run({"--scenario", "mine.json", "--seeds", "1", "--pipelines", "yoon2021_both"});
  EXPECT_THAT(result.out, AllOf(HasSubstr("mine (based on 18cam_6host_45fps): 1 seed"),
                                HasSubstr("My own words."),
                                HasSubstr("changed: /hosts/count 6 → 3, /cameras/count 18 → 9"),
                                Not(HasSubstr("2.44 ms"))))
      << result.err;
}

TEST_F(ChangedWorld, IsNoneWithoutAChange) {
  const ProgramResult result =
      run({"--scenario", "18cam_6host_45fps", "--seeds", "1", "--pipelines", "yoon2021_both"});
  EXPECT_THAT(result.out, AllOf(HasSubstr("18cam_6host_45fps: 1 seed"), HasSubstr("2.44 ms"),
                                HasSubstr("18 cameras in genlock"), Not(HasSubstr("changed:"))));
}

TEST_F(ChangedWorld, IsStatedInTimelines) {
  const ProgramResult trace = run({"trace", "--scenario", "18cam_6host_45fps", "--set",
                                   "/trigger/rate_hz=30", "-o", "trace.json"});
  ASSERT_EQ(trace.status, 0) << trace.err;
  EXPECT_EQ(Json::parse(content("trace.json"))["otherData"]["changed"].size(), 1U);
}

// Draws nothing within the time: the note stands before the work.
TEST_F(ChangedWorld, ABudgetStatesItsSeedsBeforeItBegins) {
  const ProgramResult result =
      run({"figure", "budget", "--scenario", "18cam_6host_45fps", "-o", "budget.svg"},
          {.interrupt_after = std::chrono::milliseconds(500)});
  EXPECT_EQ(result.status, 130);
  EXPECT_THAT(result.err, HasSubstr("budget runs 32 seeds (1-32), each of them 136 times"));
}

}  // namespace
}  // namespace simbench
