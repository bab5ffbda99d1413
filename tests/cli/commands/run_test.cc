// `simbench run`: what it prints, what it keeps, and that it does so every time.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>
#include <string>

#include "tests/cli/program.h"

namespace simbench {
namespace {

using Json = nlohmann::ordered_json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class Run : public ProgramTest {
 protected:
  static std::vector<std::string> small(const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = {"run",
                                          "--scenario",
                                          "18cam_6host_45fps",
                                          "--seeds",
                                          "3",
                                          "--set",
                                          "/timeline/frames=60",
                                          "--pipelines",
                                          "yoon2021_both,oracle"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
  static std::string without_performance(const std::string& text) {
    Json root = Json::parse(text);
    root.erase("performance");
    return root.dump();
  }
  static std::size_t lines(const std::string& text) {
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
  }
};

TEST_F(Run, TheTableHasARowPerPipelineAndItsLegend) {
  std::vector<std::string> command = small();
  command.emplace_back("--verbose");
  const ProgramResult result = run(command);
  EXPECT_EQ(result.status, 0) << result.err;
  for (const char* part :
       {"yoon2021_both", "oracle", "AMD", "RMDV", "How to read it", "claims", "events/s"}) {
    EXPECT_THAT(result.out, HasSubstr(part));
  }
  EXPECT_THAT(result.err, HasSubstr("6 runs in"));
}

// The number of lines of a text.
std::ptrdiff_t lines_of(const std::string& text) { return std::ranges::count(text, '\n'); }

TEST_F(Run, TheAnswerIsFirstAndAllFitsOnAScreen) {
  for (const char* scenario : {"18cam_6host_45fps", "18cam_6host_45fps_lan", "3cam_1host_30fps"}) {
    const ProgramResult result = run({"run", "--scenario", scenario, "--seeds", "12"});
    EXPECT_EQ(result.status, 0) << result.err;
    const std::string first = result.out.substr(0, result.out.find("\nOthers: "));
    EXPECT_THAT(first, HasSubstr(" is the best of the ")) << scenario;
    EXPECT_LE(lines_of(first), 3) << first;
    EXPECT_LE(lines_of(result.out), 50) << scenario;
    EXPECT_THAT(result.out, HasSubstr("--verbose"));
  }
}

TEST_F(Run, QuietIsTheAnswerAlone) {
  std::vector<std::string> command = small();
  command.emplace_back("--quiet");
  const ProgramResult quiet = run(command);
  EXPECT_THAT(quiet.out, HasSubstr("yoon2021_both is the only pipeline here that a rig can run"));
  EXPECT_THAT(quiet.out, testing::Not(HasSubstr("pipeline   ")));
  command.emplace_back("--verbose");
  const ProgramResult both = run(command);
  EXPECT_EQ(both.status, 2);
  EXPECT_THAT(both.err, HasSubstr("--verbose"));
}

TEST_F(Run, OneCameraHasNoAmdAndTheTableSaysWhy) {
  const std::vector<std::string> command = {
      "run",   "--scenario",          "3cam_1host_30fps", "--set", "/cameras/count=1",
      "--set", "/timeline/frames=30", "--seeds",          "2",     "--pipelines",
      "oracle"};
  const auto formatted = [&](const std::string& format) {
    std::vector<std::string> arguments = command;
    arguments.insert(arguments.end(), {"--format", format});
    return run(arguments).out;
  };
  EXPECT_THAT(run(command).out, testing::ContainsRegex("\noracle +limit +- +- +[0-9.]+ ms +- "));
  EXPECT_THAT(run(command).out, HasSubstr("compare cameras: of a single one there are none"));
  EXPECT_THAT(formatted("markdown"), HasSubstr("| oracle | - | - | - | - |"));
  EXPECT_THAT(formatted("csv"), HasSubstr("\noracle,oracle,regression_30,yoon2021,,,,,,,"));
  const Json row = Json::parse(formatted("json"))["rows"][0];
  EXPECT_TRUE(row["amd_ms"]["median"].is_null());
  EXPECT_TRUE(row["rmdv_ms"]["median"].is_null());
  EXPECT_FALSE(row["absolute_error_ms"]["median"].is_null());
}

TEST_F(Run, WithTwoSeedsNoVerdictIsPrinted) {
  const ProgramResult result =
      run({"run", "--scenario", "18cam_6host_45fps", "--seeds", "2", "--format", "json"});
  ASSERT_EQ(result.status, 0) << result.err;
  const Json root = Json::parse(result.out);
  int published = 0;
  for (const Json& row : root["rows"]) {
    if (row["published"].is_null()) continue;
    ++published;
    EXPECT_TRUE(row["published"]["amd_inside"].is_null()) << row["pipeline"];
    EXPECT_TRUE(row["published"]["rmdv_inside"].is_null()) << row["pipeline"];
  }
  EXPECT_EQ(published, 4);
}

TEST_F(Run, TheCommandRunIsTheDefault) {
  std::vector<std::string> arguments = small({"--format", "json"});
  const ProgramResult named = run(arguments);
  arguments.erase(arguments.begin());
  const ProgramResult unnamed = run(arguments);
  EXPECT_EQ(unnamed.status, 0);
  EXPECT_EQ(without_performance(named.out), without_performance(unnamed.out));
}

TEST_F(Run, JsonIsAllThatIsOnStandardOutput) {
  const ProgramResult result = run({"run", "--scenario", "18cam_6host_45fps", "--seeds", "3",
                                    "--pipelines", "yoon2021_both,oracle", "--format", "json"});
  ASSERT_EQ(result.status, 0) << result.err;
  const Json root = Json::parse(result.out);
  EXPECT_EQ(root["scenario"], "18cam_6host_45fps");
  EXPECT_EQ(root["seeds"]["count"], 3);
  ASSERT_EQ(root["rows"].size(), 2U);
  EXPECT_EQ(root["rows"][0]["pipeline"], "yoon2021_both");
  EXPECT_EQ(root["rows"][0]["amd_ms"]["values"].size(), 3U);
  EXPECT_EQ(root["rows"][0]["published"]["amd_ms"], 2.438);
  EXPECT_GT(root["performance"]["events"], 0);
}

TEST_F(Run, EqualCommandsGiveEqualBytes) {
  const std::string one = without_performance(run(small({"--format", "json"})).out);
  EXPECT_EQ(one, without_performance(run(small({"--format", "json"})).out));
  EXPECT_EQ(one, without_performance(run(small({"--format", "json", "--jobs", "1"})).out));
  EXPECT_EQ(one, without_performance(run(small({"--format", "json", "--jobs", "2"})).out));
  EXPECT_NE(one, without_performance(run(small({"--format", "json", "--first-seed", "2"})).out));
  EXPECT_EQ(run(small({"--format", "csv"})).out, run(small({"--format", "csv"})).out);
}

TEST_F(Run, MarkdownAndCsv) {
  EXPECT_THAT(run(small({"--format", "markdown"})).out, HasSubstr("| yoon2021_both |"));
  EXPECT_EQ(lines(run(small({"--format", "csv"})).out), 3U);
}

TEST_F(Run, TidyHasALineForEachPipelineSeedAndMetric) {
  const std::string text = run(small({"--format", "tidy"})).out;
  EXPECT_THAT(text, testing::StartsWith("scenario,pipeline,seed,metric,unit,value,changed\n"));
  for (const char* start : {"yoon2021_both,1,amd_ms,ms,", "yoon2021_both,3,amd_ms,ms,",
                            "oracle,2,rmdv_ms,ms,", "oracle,2,max_te_ms,ms,"}) {
    EXPECT_THAT(text, HasSubstr(std::string("\n18cam_6host_45fps,") + start));
  }
  const ProgramResult refused = run(small({"--format", "tidy", "--budget"}));
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.err,
              HasSubstr("found 'tidy', allowed with --budget: table, markdown, latex"));
}

// Environments are closed, and no special character stands for itself.
TEST_F(Run, LatexIsBalancedAndEscaped) {
  const std::string text = run(small({"--format", "latex"})).out;
  const auto count = [&text](const std::string& part) {
    std::size_t found = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
      ++found;
    }
    return found;
  };
  EXPECT_GE(count("\\begin{tabular}"), 2U);
  for (const std::string name : {"table", "tabular", "itemize"}) {
    EXPECT_EQ(count("\\begin{" + name + "}"), count("\\end{" + name + "}")) << name;
  }
  EXPECT_EQ(count("\\toprule"), count("\\bottomrule"));
  EXPECT_THAT(text, HasSubstr("yoon2021\\_both & "));
  EXPECT_THAT(text, HasSubstr("480 $\\rightarrow$ 60"));
  for (const char special : {'_', '%', '#'}) {
    for (std::size_t at = text.find(special, text.find('\n')); at != std::string::npos;
         at = text.find(special, at + 1)) {
      EXPECT_EQ(text[at - 1], '\\') << text.substr(at, 20);
    }
  }
}

// What it says to improve the best pipeline is what a user finds who does it.
TEST_F(Run, ALeverIsTheRunThatItsOptionsMake) {
  const std::vector<std::string> base = {"run", "--scenario", "18cam_6host_45fps",   "--seeds",
                                         "8",   "--set",      "/timeline/frames=60", "--format",
                                         "json"};
  std::vector<std::string> first = base;
  first.insert(first.end(), {"--pipelines", "yoon2021_both"});
  const ProgramResult result = run(first);
  ASSERT_EQ(result.status, 0) << result.err;
  const Json levers = Json::parse(result.out)["answer"]["levers"];
  ASSERT_GT(levers.size(), 0U);
  for (const Json& lever : levers) {
    std::vector<std::string> again = base;
    again.emplace_back("--no-levers");
    std::istringstream options(lever["options"].get<std::string>());
    for (std::string word; options >> word;) again.push_back(word);
    const ProgramResult changed = run(again);
    ASSERT_EQ(changed.status, 0) << changed.err;
    EXPECT_EQ(Json::parse(changed.out)["rows"][0]["amd_ms"]["median"], lever["to"]) << lever;
  }
  const ProgramResult without = run(small({"--quiet", "--no-levers"}));
  EXPECT_THAT(without.out, Not(HasSubstr("To improve it")));
}

TEST_F(Run, TheArchiveHoldsEverything) {
  const ProgramResult result = run(small({"--output", "results", "--format", "json"}));
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(names_in(), ElementsAre("results"));
  EXPECT_THAT(names_in("results"),
              ElementsAre("frames.csv", "hosts.csv", "manifest.json", "results.json"));
  EXPECT_EQ(content("results/results.json"), result.out);
  const Json manifest = Json::parse(content("results/manifest.json"));
  EXPECT_EQ(manifest["seeds"]["count"], 3);
  EXPECT_EQ(manifest["scenario"]["timeline"]["frames"], 60);
  EXPECT_EQ(manifest["command"][1], "run");
  EXPECT_TRUE(manifest.contains("version") && manifest.contains("commit"));
  EXPECT_LE(manifest["started"], manifest["finished"]);
  const std::string frames = content("results/frames.csv");
  EXPECT_THAT(frames, testing::StartsWith("pipeline,seed,pulse,amd_ms,rmdv_ms,changed\n"));
  EXPECT_EQ(lines(frames), 1U + 2 * 3 * 60);
  EXPECT_EQ(lines(content("results/hosts.csv")), 1U + 2 * 3 * 6);
}

TEST_F(Run, AManifestsScenarioRepeatsTheRun) {
  const ProgramResult first = run(small({"--output", "results", "--format", "json"}));
  ASSERT_EQ(first.status, 0) << first.err;
  file("again.json", Json::parse(content("results/manifest.json"))["scenario"].dump());
  const ProgramResult again = run({"--scenario", "again.json", "--seeds", "3", "--pipelines",
                                   "yoon2021_both,oracle", "--format", "json"});
  EXPECT_EQ(without_performance(first.out), without_performance(again.out)) << again.err;
}

TEST_F(Run, AnEarlierArchiveIsReplaced) {
  ASSERT_EQ(run(small({"--output", "results"})).status, 0);
  ASSERT_EQ(run(small({"--output", "results", "--first-seed", "9"})).status, 0);
  EXPECT_EQ(Json::parse(content("results/results.json"))["seeds"]["first"], 9);
  EXPECT_THAT(names_in(), ElementsAre("results"));
}

TEST_F(Run, AFullDiskLeavesNothing) {
  const ProgramResult result =
      run(small({"--output", "results"}), {.largest_file = std::size_t{8192}});
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("error: --output"));
  EXPECT_THAT(result.err, HasSubstr("nothing was kept"));
  EXPECT_THAT(names_in(), IsEmpty());
}

TEST_F(Run, AResultThatCannotBePrintedIsAnError) {
  const ProgramResult result = run(small(), {.out_file = "/dev/full"});
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("standard output"));
}

TEST_F(Run, TheFirstTableOfAFreshCloneIsThatOfTheCommand) {
  const std::filesystem::path first =
      std::filesystem::path(SIMBENCH_PROGRAM).parent_path() / "simbench-first-table";
  const std::string scenario = "18cam_6host_45fps";
  const std::string command = fmt::format("cd {} && {} {} > first.txt 2> said.txt",
                                          folder().string(), first.string(), scenario);
  ASSERT_EQ(std::system(command.c_str()), 0) << content("said.txt");
  EXPECT_EQ(content("first.txt"), run({"run", "--scenario", scenario}).out);
}

TEST_F(Run, CtrlCEndsItWithoutAHalfWrittenResult) {
  const ProgramResult result =
      run({"--scenario", "18cam_6host_45fps", "--seeds", "100000", "--output", "results"},
          {.interrupt_after = std::chrono::milliseconds(500)});
  EXPECT_EQ(result.status, 130);
  EXPECT_EQ(result.out, "");
  EXPECT_THAT(result.err, HasSubstr("interrupted after"));
  EXPECT_THAT(names_in(), IsEmpty());
}

TEST_F(Run, InterruptedAtAnyMomentItLeavesNothing) {
  std::mt19937 random(11);
  for (int tried = 0; tried < 25; ++tried) {
    const std::chrono::microseconds moment(random() % 150'000);
    const ProgramResult result =
        run(small({"--output", "results"}), {.interrupt_at = moment, .interrupts = 1 + tried % 2});
    SCOPED_TRACE(fmt::format("after {} us: {}", moment.count(), result.err));
    if (names_in().empty()) {
      EXPECT_EQ(result.status, 130);
      continue;
    }
    EXPECT_THAT(names_in(), ElementsAre("results"));
    EXPECT_THAT(names_in("results"),
                ElementsAre("frames.csv", "hosts.csv", "manifest.json", "results.json"));
    std::filesystem::remove_all(folder() / "results");
  }
}

// Worlds that do not come to their next frame for long.
TEST_F(Run, CtrlCEndsEveryWorld) {
  const std::vector<std::vector<std::string>> worlds = {
      {"--set", "/hosts/clock/oscillator/random_walk_ppb_per_sqrt_s=1000000", "--seeds", "100000"},
      {"--set", "/pipelines/0/host_sync=\"two_way_hull\"", "--set",
       "/algorithms/two_way/warm_up_s=1000000", "--set", "/algorithms/two_way/interval_ms=0.1"},
      {"--set", "/hosts/load_burst/rate_hz=100000", "--set",
       "/hosts/load_burst/duration_exponential_ms=1000000", "--seeds", "100000"},
      {"--set", "/hosts/clock/oscillator/wander_step_ms=1", "--set",
       "/timeline/wait_before_capture_ms=1000000000"},
      {"--set", "/hosts/count=100000", "--set", "/cameras/count=100000", "--set",
       "/timeline/frames=200"}};
  for (std::vector<std::string> world : worlds) {
    SCOPED_TRACE(testing::PrintToString(world));
    world.insert(world.begin(), {"--scenario", "18cam_6host_45fps_lan"});
    const ProgramResult result = run(world, {.interrupt_after = std::chrono::milliseconds(700)});
    EXPECT_EQ(result.status, 130);
    EXPECT_EQ(result.out, "");
    EXPECT_THAT(result.err, HasSubstr("interrupted after"));
  }
}

}  // namespace
}  // namespace simbench
