// `simbench clocks` through the real program.
#include <gmock/gmock.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/cli/program.h"

namespace simbench {
namespace {

using Json = nlohmann::ordered_json;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

class ClocksCommand : public ProgramTest {
 protected:
  // Seven minutes of two pipelines and two seeds, unless `more` states another span or number.
  ProgramResult clocks(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"clocks", "--scenario",  "6host_star",         "--from-s",
                                          "100",    "--pipelines", "chrony,free_running"};
    const std::vector<std::vector<std::string>> usual = {{"--seeds", "2"}, {"--duration-s", "400"}};
    for (const std::vector<std::string>& option : usual) {
      if (std::find(more.begin(), more.end(), option[0]) != more.end()) continue;
      arguments.insert(arguments.end(), option.begin(), option.end());
    }
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
  void write_archive(const std::string& name, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"--output", name};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramResult result = clocks(arguments);
    ASSERT_EQ(result.status, 0) << result.err;
  }
  void expect_refused(const std::vector<std::string>& arguments, const std::string& message) const {
    std::vector<std::string> command = {"clocks", "--output", "refused"};
    command.insert(command.end(), arguments.begin(), arguments.end());
    const ProgramResult result = run(command);
    EXPECT_EQ(result.status, 2) << testing::PrintToString(arguments);
    EXPECT_THAT(result.out, IsEmpty());
    EXPECT_THAT(result.err, AllOf(StartsWith("error: "), HasSubstr(message)));
    EXPECT_THAT(names_in(), IsEmpty());
  }
};

TEST_F(ClocksCommand, SaysWhatCausedTheErrors) {
  const std::vector<std::string> stepped = {
      "--set", R"(/faults=[{"kind": "clock_step", "host": 0, "at_ms": 200000, "step_ms": 500}])"};
  const ProgramResult result = clocks(stepped);
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("Without the step of a clock: "));
  std::vector<std::string> as_json = stepped;
  as_json.insert(as_json.end(), {"--format", "json"});
  const auto causes = nlohmann::json::parse(clocks(as_json).out)["answer"]["causes"];
  EXPECT_EQ(causes[0]["what"], "the step of a clock");
  EXPECT_GT(causes[0]["largest_from_ms"], 499);
  EXPECT_LT(causes[0]["largest_to_ms"], 499);
}

TEST_F(ClocksCommand, PrintsATable) {
  const ProgramResult result = clocks();
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out,
              AllOf(StartsWith("6host_star: 2 seeds (1-2)\n"), HasSubstr("\nThe hosts' clocks\n"),
                    HasSubstr("\nchrony "), HasSubstr("\nfree_running "),
                    HasSubstr("Allan deviation"), HasSubstr("measured from 100 to 400 s")));
  EXPECT_THAT(names_in(), IsEmpty());
}

TEST_F(ClocksCommand, JsonIsAllThatIsOnStandardOutput) {
  const ProgramResult result = clocks({"--format", "json"});
  ASSERT_EQ(result.status, 0) << result.err;
  const Json root = Json::parse(result.out);
  EXPECT_EQ(root["kind"], "clocks");
  EXPECT_EQ(root["duration_s"], 400);
  ASSERT_EQ(root["rows"].size(), 2U);
  const Json& chrony = root["rows"][0];
  const Json& free_running = root["rows"][1];
  EXPECT_LT(chrony["clock_spread_ms"]["mean"].get<double>(), 1);
  EXPECT_GT(free_running["clock_spread_ms"]["mean"].get<double>(), 100);
  EXPECT_TRUE(chrony["below_ms"]["1"].is_number());
  EXPECT_TRUE(free_running["below_ms"]["1"].is_null());
  EXPECT_GT(chrony["packets_per_s"].get<double>(), 0);
  EXPECT_EQ(free_running["packets_per_s"], 0.0);
  EXPECT_EQ(chrony["clock_spread_ms"]["values"].size(), 2U);
  EXPECT_EQ(chrony["mtie_ms"].back()["tau_s"], 256.0);
}

TEST_F(ClocksCommand, PrintsCsvAndMarkdown) {
  EXPECT_THAT(clocks({"--format", "csv"}).out, AllOf(StartsWith("pipeline,measure,tau_s,value\n"),
                                                     HasSubstr("\nchrony,mtie_ms,256,")));
  EXPECT_THAT(clocks({"--format", "markdown"}).out, HasSubstr("| chrony "));
}

TEST_F(ClocksCommand, TheNumberOfThreadsChangesNothing) {
  const auto with_jobs = [&](const std::string& jobs) {
    const ProgramResult result = clocks({"--format", "json", "--seeds", "5", "--jobs", jobs});
    EXPECT_EQ(result.status, 0) << result.err;
    Json root = Json::parse(result.out);
    EXPECT_EQ(root.erase("performance"), 1U);
    return root.dump();
  };
  EXPECT_EQ(with_jobs("1"), with_jobs("2"));
}

TEST_F(ClocksCommand, AnArchiveReplacesTheOneBefore) {
  write_archive("results", {"--seeds", "1"});
  write_archive("results");
  EXPECT_THAT(names_in("results"),
              ElementsAre("curves.csv", "manifest.json", "results.json", "series.csv"));
  EXPECT_EQ(Json::parse(content("results/results.json"))["seeds"]["count"], 2);
  const Json manifest = Json::parse(content("results/manifest.json"));
  EXPECT_EQ(manifest["kind"], "clocks");
  EXPECT_EQ(manifest["scenario"]["name"], "6host_star");
  EXPECT_THAT(content("results/series.csv"),
              StartsWith("pipeline,seed,time_s,host,te_s\nchrony,1,100,1,"));
}

TEST_F(ClocksCommand, ArchivesAreComparedAndHeldToABaseline) {
  write_archive("a");
  write_archive("b", {"--set", "/network/latency_exponential_ms=0.05"});
  const ProgramResult compared = run({"compare", "a", "b"});
  EXPECT_EQ(compared.status, 0) << compared.err;
  EXPECT_THAT(compared.out, AllOf(HasSubstr("chrony"), HasSubstr("no difference seen")));
  EXPECT_EQ(run({"compare", "a", "--with-baseline", "free_running"}).status, 0);
  ASSERT_EQ(run({"gate", "a", "--save-baseline", "b.json"}).status, 0);
  const ProgramResult same = run({"gate", "b", "--baseline", "b.json"});
  EXPECT_EQ(same.status, 0) << same.out << same.err;
  EXPECT_THAT(same.out, HasSubstr("gate passed: 8 checks, 8 of them the same (exact)"));
  write_archive("longer", {"--duration-s", "401"});
  const ProgramResult refused = run({"gate", "longer", "--baseline", "b.json"});
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.err, HasSubstr("with the same --from-s and --duration-s"));
  EXPECT_EQ(run({"compare", "a", "longer"}).status, 2);
}

TEST_F(ClocksCommand, AWorseClockFailsTheGate) {
  write_archive("a");
  ASSERT_EQ(run({"gate", "a", "--save-baseline", "b.json"}).status, 0);
  std::string text = content("a/results.json");
  Json root = Json::parse(text);
  for (Json& value : root["rows"][0]["metrics"]["max_te_ms"]["values"]) {
    value = 2 * value.get<double>();
  }
  file("a/results.json", root.dump(2));
  const ProgramResult result = run({"gate", "a", "--baseline", "b.json"});
  EXPECT_EQ(result.status, 3) << result.out << result.err;
  EXPECT_THAT(result.out, AllOf(HasSubstr("largest time error"), HasSubstr("chrony")));
}

TEST_F(ClocksCommand, AnArchiveHasAReport) {
  write_archive("a");
  const ProgramResult result = run({"report", "a", "--output", "report.html"});
  ASSERT_EQ(result.status, 0) << result.err;
  const std::string page = content("report.html");
  EXPECT_THAT(page, AllOf(HasSubstr("The hosts"), HasSubstr("Allan deviation"),
                          HasSubstr("G.8262 option 1"), HasSubstr("free_running")));
  EXPECT_THAT(page, testing::Not(HasSubstr(">nan<")));
}

TEST_F(ClocksCommand, DrawsAFigure) {
  const ProgramResult result = clocks({"--figure", "clocks.svg"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("note: clocks.svg written"));
  EXPECT_THAT(content("clocks.svg"),
              AllOf(HasSubstr("<svg"), HasSubstr("chrony"), HasSubstr("G.8262")));
}

TEST_F(ClocksCommand, RefusesOptionsBeforeAnyWork) {
  expect_refused({"--scenario", "6host_star", "--figure", "nowhere/clocks.svg"}, "nowhere");
  expect_refused({"--scenario", "6host_star", "--duration-s", "100"},
                 "--from-s: found 300, allowed: less than --duration-s, 100");
  expect_refused({"--scenario", "6host_star", "--duration-s", "303"},
                 "--duration-s: found 303, allowed: at least 304, 4 readings of a second");
  expect_refused({"--scenario", "6host_star", "--duration-s", "400", "--from-s", "500"},
                 "--from-s: found 500, allowed: less than --duration-s, 400");
  expect_refused({"--scenario", "6host_star", "--duration-s", "31000001"},
                 "--duration-s: found '31000001', allowed: a whole number from 1 to 31000000");
  expect_refused({"--scenario", "6host_star", "--pipelines", "cuckoo"},
                 "found \"cuckoo\", known: chrony, ntp");
  expect_refused({"--scenario", "leaderboard_lan", "--pipelines", "host.common_view"},
                 "--pipelines: pipeline host.common_view: host_sync \"common_view\" needs the "
                 "frames of cameras");
  expect_refused({"--scenario", "6host_star", "--figure", "clocks.png"},
                 "--figure: found 'clocks.png', allowed: a name that ends in .svg or .pdf");
  expect_refused({"--scenario", "6host_star", "--seeds", "0"}, "--seeds: found '0'");
  expect_refused({"--scenario", "3cam_1host_30fps"}, "/hosts/count: found 1, allowed");
}

TEST_F(ClocksCommand, LeavesOutWhatNeedsCamerasAndSaysSo) {
  const std::string boards = file("boards.json", R"({"base": "leaderboard_lan", "name": "boards",
    "summary": "Two.", "pipelines": [
      {"name": "seen", "host_sync": "common_view", "device_time": "oracle", "gathering": "oracle"},
      {"name": "sent", "host_sync": "yoon2021_both", "device_time": "oracle",
       "gathering": "oracle"}]})");
  const ProgramResult result = run({"clocks", "--scenario", boards, "--seeds", "1", "--duration-s",
                                    "10", "--from-s", "2", "--format", "json"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("\"common_view\" needs the frames of cameras, which a run of "
                                    "the clocks alone does not have; left out"));
  EXPECT_THAT(result.out, testing::Not(HasSubstr("\"host_sync\": \"common_view\"")));
}

TEST_F(ClocksCommand, CtrlCEndsItWithoutAHalfWrittenResult) {
  for (const std::string pipeline : {"two_way_hull", "free_running", "chrony"}) {
    const ProgramResult result =
        run({"clocks", "--scenario", "6host_lan_day", "--duration-s", "31000000", "--seeds", "100",
             "--pipelines", pipeline, "--output", "results"},
            {.interrupt_after = std::chrono::milliseconds(500)});
    EXPECT_EQ(result.status, 130) << pipeline;
    EXPECT_EQ(result.out, "");
    EXPECT_THAT(result.err, HasSubstr("interrupted after"));
    EXPECT_THAT(names_in(), IsEmpty());
  }
}

}  // namespace
}  // namespace simbench
