// simbench sweep through the real program: what it writes, how it goes on, what it refuses.
#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "recording/version.h"
#include "tests/cli/program.h"

namespace simbench {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

class SweepTest : public ProgramTest {
 protected:
  // 3 x 2 points, 2 pipelines, 5 seeds: 60 runs.
  static std::vector<std::string> command(const std::string& folder,
                                          const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = {"sweep",
                                          "--scenario",
                                          "3cam_1host_30fps",
                                          "--sweep",
                                          "/usb/delivery_jitter_transfers=0:0.4:0.2",
                                          "--sweep",
                                          "/trigger/pulse_jitter_sigma_us=0,50",
                                          "--pipelines",
                                          "raw_arrival,genlock",
                                          "--seeds",
                                          "5",
                                          "--output",
                                          folder};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }

  // The folder's files but the plot, which is there where gnuplot is.
  std::string all_of(const std::string& folder) const {
    std::string all;
    for (const std::string& name : names_in(folder)) {
      if (name == "sweep.svg") continue;
      all.append(name).append("\n").append(content(fmt::format("{}/{}", folder, name)));
    }
    return all;
  }

  // The sweep, killed without warning after so long.
  void run_and_kill(const std::string& folder_name, std::chrono::microseconds after) const {
    std::vector<std::string> arguments = {SIMBENCH_PROGRAM};
    for (const std::string& argument : command(folder_name, {"--jobs", "2"})) {
      arguments.push_back(argument);
    }
    std::vector<char*> argv;
    argv.reserve(arguments.size() + 1);
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    const pid_t process = fork();
    if (process == 0) {
      const int nowhere = open("/dev/null", O_WRONLY);
      if (chdir(folder().c_str()) != 0 || dup2(nowhere, 1) < 0 || dup2(nowhere, 2) < 0) _exit(126);
      execv(SIMBENCH_PROGRAM, argv.data());
      _exit(127);
    }
    std::this_thread::sleep_for(after);
    kill(process, SIGKILL);
    int status = 0;
    waitpid(process, &status, 0);
  }

  std::size_t lines_of(const std::string& name) const {
    const std::string text = content(name);
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
  }
};

TEST_F(SweepTest, WritesItsResults) {
  const ProgramResult result = run(command("out"));
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("3cam_1host_30fps: 6 points, 2 pipelines, 5 seeds"));
  EXPECT_EQ(lines_of("out/sweep.csv"), 61U);
  EXPECT_EQ(lines_of("out/runs.log"), 60U);
  EXPECT_EQ(lines_of("out/hosts.csv"), 61U);
  EXPECT_EQ(content("out/sweep.txt"), result.out);
  EXPECT_THAT(content("out/sweep.csv"), HasSubstr("\n0.2,50,genlock,5,"));
}

// What a point of the sweep says is what a run with the same settings says.
TEST_F(SweepTest, APointIsARun) {
  ASSERT_EQ(run(command("out")).status, 0);
  ASSERT_EQ(run({"run", "--scenario", "3cam_1host_30fps", "--pipelines", "raw_arrival,genlock",
                 "--seeds", "5", "--set", "/usb/delivery_jitter_transfers=0.4", "--set",
                 "/trigger/pulse_jitter_sigma_us=50", "--output", "single"})
                .status,
            0);
  const std::string results = content("single/results.json");
  const std::string csv = content("out/sweep.csv");
  const std::size_t line = csv.find("\n0.4,50,genlock,3,");
  ASSERT_NE(line, std::string::npos);
  const std::string amd = csv.substr(line + 18, csv.find(',', line + 18) - line - 18);
  EXPECT_THAT(results, HasSubstr(amd));
  EXPECT_GT(amd.size(), 4U);
}

// Points that differ in scoring alone share captures, and are still what each is alone.
TEST_F(SweepTest, PointsOfOneCaptureAreThoseOfSweepsOfTheirOwn) {
  const auto sweep = [this](const std::string& intervals, const std::string& folder) {
    return run({"sweep", "--scenario", "3cam_1host_30fps", "--sweep",
                "/evaluation/gathering_interval_periods=" + intervals, "--sweep",
                "/trigger/rate_hz=15,30", "--seeds", "3", "--output", folder})
        .status;
  };
  ASSERT_EQ(sweep("0.05,0.5", "both"), 0);
  std::string apart;
  for (const std::string interval : {"0.05", "0.5"}) {
    ASSERT_EQ(sweep(interval, interval), 0);
    const std::string csv = content(interval + "/sweep.csv");
    apart += apart.empty() ? csv : csv.substr(csv.find('\n') + 1);
  }
  EXPECT_EQ(content("both/sweep.csv"), apart);
}

// As after a kill in the middle of a point and seed.
TEST_F(SweepTest, OfAPointAndSeedOnlyWhatIsMissingIsRun) {
  ASSERT_EQ(run(command("whole")).status, 0);
  ASSERT_EQ(run(command("out")).status, 0);
  // The line is that of point 0, raw_arrival, seed 1; genlock at the same point and seed stays.
  const std::string log = content("out/runs.log");
  file("out/runs.log", log.substr(log.find('\n') + 1));
  const ProgramResult result = run(command("out"));
  EXPECT_EQ(result.status, 0);
  EXPECT_THAT(result.err, HasSubstr("59 of 60 runs finished already"));
  EXPECT_THAT(result.err, HasSubstr("1 run in"));
  EXPECT_EQ(all_of("out"), all_of("whole"));
}

TEST_F(SweepTest, TheSameBytesWithAnyNumberOfThreads) {
  const ProgramResult one = run(command("one", {"--jobs", "1"}));
  const ProgramResult four = run(command("four", {"--jobs", "4"}));
  EXPECT_EQ(one.out, four.out);
  EXPECT_EQ(all_of("one"), all_of("four"));
}

TEST_F(SweepTest, TheSameCommandAgainRepeatsNothing) {
  const ProgramResult first = run(command("out"));
  const std::string before = all_of("out");
  const ProgramResult second = run(command("out"));
  EXPECT_EQ(second.status, 0);
  EXPECT_EQ(second.out, first.out);
  EXPECT_THAT(second.err, HasSubstr("60 of 60 runs finished already"));
  EXPECT_THAT(second.err, Not(HasSubstr("left")));
  EXPECT_EQ(all_of("out"), before);
}

TEST_F(SweepTest, KilledAgainAndAgainItEndsTheSame) {
  ASSERT_EQ(run(command("whole")).status, 0);
  const unsigned seed = std::random_device()();
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  std::size_t finished = 0;
  for (int round = 0; round < 12; ++round) {
    run_and_kill("out", std::chrono::microseconds(random() % 40'000));
    // No run that was finished is lost.
    EXPECT_GE(lines_of("out/runs.log"), finished);
    finished = lines_of("out/runs.log");
  }
  const ProgramResult last = run(command("out"));
  ASSERT_EQ(last.status, 0) << last.err;
  if (finished > 0 && last.err.find("damaged") == std::string::npos) {
    EXPECT_THAT(last.err, HasSubstr(std::to_string(finished) + " of 60 runs finished already"));
  }
  EXPECT_EQ(all_of("out"), all_of("whole"));
  EXPECT_EQ(last.out, content("whole/sweep.txt"));
}

TEST_F(SweepTest, InterruptedItSaysHowToGoOn) {
  std::vector<std::string> longer = command("out", {"--set", "/timeline/frames=200000"});
  ProgramOptions options;
  options.interrupt_after = std::chrono::milliseconds(150);
  const ProgramResult result = run(longer, options);
  EXPECT_EQ(result.status, 130);
  EXPECT_EQ(result.out, "");
  EXPECT_THAT(result.err, testing::ContainsRegex("interrupted after .* runs; the finished runs "
                                                 "are kept in out, and the same command goes on"));
  EXPECT_THAT(result.err, Not(HasSubstr("no result was written")));
}

TEST_F(SweepTest, AFullDiskLosesNothing) {
  ASSERT_EQ(run(command("whole")).status, 0);
  const std::size_t manifest = content("whole/manifest.json").size();
  // Room for some of the log, then for all of it but not for sweep.csv.
  for (const std::size_t room : {manifest + 1, content("whole/runs.log").size() + 1}) {
    ProgramOptions options;
    options.largest_file = room;
    const ProgramResult full = run(command("out"), options);
    EXPECT_EQ(full.status, 2) << full.err;
    EXPECT_THAT(full.err, HasSubstr("cannot be written"));
    EXPECT_THAT(full.err, HasSubstr("all finished runs are kept"));
    EXPECT_THAT(names_in("out"), ElementsAre("lock", "manifest.json", "runs.log"));
  }
  const std::size_t finished = lines_of("out/runs.log");
  EXPECT_GT(finished, 0U);
  const ProgramResult last = run(command("out"));
  EXPECT_EQ(last.status, 0);
  EXPECT_THAT(last.err, HasSubstr(std::to_string(finished) + " of 60 runs finished already"));
  EXPECT_EQ(all_of("out"), all_of("whole"));
}

TEST_F(SweepTest, DamagedRecordsAreSaidAndDoneAgain) {
  ASSERT_EQ(run(command("whole")).status, 0);
  ASSERT_EQ(run(command("out")).status, 0);
  std::string log = content("out/runs.log");
  log[log.size() / 2] ^= 4;
  log.resize(log.size() - 5);
  file("out/runs.log", log);
  const ProgramResult result = run(command("out"));
  EXPECT_EQ(result.status, 0);
  EXPECT_THAT(result.err, HasSubstr("2 damaged records in runs.log; their runs are done again"));
  EXPECT_THAT(result.err, HasSubstr("58 of 60 runs finished already"));
  EXPECT_THAT(result.err, HasSubstr("2 runs in"));
  EXPECT_EQ(all_of("out"), all_of("whole"));
}

TEST_F(SweepTest, AnotherSweepIsNotTouched) {
  ASSERT_EQ(run(command("out")).status, 0);
  const std::string before = all_of("out");
  const ProgramResult seeds = run(command("out", {"--first-seed", "2"}));
  EXPECT_EQ(seeds.status, 2);
  EXPECT_THAT(seeds.err, HasSubstr("holds another sweep: /seeds/first is 1 there and 2 here; name "
                                   "another folder, repeat that sweep's command, or replace it "
                                   "with --restart"));
  const ProgramResult scenario = run(command("out", {"--set", "/timeline/frames=100"}));
  EXPECT_EQ(scenario.status, 2);
  EXPECT_THAT(scenario.err, HasSubstr("/scenario/timeline/frames is 480 there and 100 here"));
  EXPECT_EQ(all_of("out"), before);
  const ProgramResult restarted = run(command("out", {"--first-seed", "2", "--restart"}));
  EXPECT_EQ(restarted.status, 0) << restarted.err;
  EXPECT_THAT(restarted.err, Not(HasSubstr("already")));
}

TEST_F(SweepTest, ThatOfAnotherVersionNamesIt) {
  ASSERT_EQ(run(command("out")).status, 0);
  std::string manifest = content("out/manifest.json");
  const std::string stated = fmt::format("\"version\": \"{}\"", version());
  const std::size_t at = manifest.find(stated);
  ASSERT_NE(at, std::string::npos) << manifest;
  file("out/manifest.json", manifest.replace(at, stated.size(), "\"version\": \"1.7.3\""));
  const ProgramResult result = run(command("out"));
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err,
              HasSubstr(fmt::format(
                  "holds another sweep: /version is \"1.7.3\" there and \"{}\" here", version())));
}

TEST_F(SweepTest, ForeignFoldersAreRefused) {
  std::filesystem::create_directory(folder() / "mine");
  file("mine/notes.txt", "keep");
  const ProgramResult foreign = run(command("mine", {"--restart"}));
  EXPECT_EQ(foreign.status, 2);
  EXPECT_THAT(foreign.err, HasSubstr("holds other files (notes.txt)"));
  EXPECT_THAT(names_in("mine"), ElementsAre("notes.txt"));
  file("plain", "");
  EXPECT_THAT(run(command("plain")).err, HasSubstr("is a file; name a folder"));
}

TEST_F(SweepTest, TwoAtOnceAreRefused) {
  ASSERT_EQ(run(command("out")).status, 0);
  const int lock = open((folder() / "out/lock").c_str(), O_RDWR);
  ASSERT_GE(lock, 0);
  ASSERT_EQ(flock(lock, LOCK_EX | LOCK_NB), 0);
  const ProgramResult result = run(command("out"));
  close(lock);
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("another simbench runs this sweep"));
}

TEST_F(SweepTest, WrongInputLeavesNothing) {
  const ProgramResult point = run({"sweep", "--scenario", "18cam_6host_45fps", "--sweep",
                                   "/hosts/count=6,0", "--seeds", "1", "-o", "out"});
  EXPECT_EQ(point.status, 2);
  EXPECT_THAT(point.err, HasSubstr("point 2 of 2 of the sweep (/hosts/count=0) is refused"));
  const ProgramResult nothing = run({"sweep", "--scenario", "3cam_1host_30fps", "-o", "out"});
  EXPECT_EQ(nothing.status, 2);
  EXPECT_THAT(nothing.err, HasSubstr("neither --study nor both --scenario and --sweep"));
  const ProgramResult study = run({"sweep", "--study", "scale", "-o", "out"});
  EXPECT_EQ(study.status, 2);
  EXPECT_THAT(study.err, AllOf(HasSubstr("found 'scale', allowed: list, asymmetry, "),
                               HasSubstr(", scalability, ")));
  EXPECT_TRUE(names_in().empty());
}

TEST_F(SweepTest, AStudyMayBeOfClocks) {
  const ProgramResult result = run({"sweep", "--study", "oscillator_class", "--duration-s", "400",
                                    "--from-s", "100", "--seeds", "2", "-o", "out"});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("the hosts' clocks alone"));
  EXPECT_THAT(result.out, HasSubstr("The order by spread of the clocks"));
  EXPECT_THAT(content("out/manifest.json"), HasSubstr("\"duration_s\": 400"));
}

// 2 points, 2 pipelines, 2 seeds of six hosts' clocks.
std::vector<std::string> clock_sweep(const std::string& folder,
                                     const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments = {
      "sweep",      "--clocks",    "--scenario",
      "6host_star", "--pipelines", "chrony,free_running",
      "--seeds",    "2",           "--from-s",
      "100",        "--sweep",     "/network/latency_exponential_ms=0.02,0.2",
      "--output",   folder};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

TEST_F(SweepTest, APointOfAClockSweepIsAClockRun) {
  const ProgramResult swept = run(clock_sweep("out", {"--duration-s", "400"}));
  ASSERT_EQ(swept.status, 0) << swept.err;
  EXPECT_THAT(swept.out, HasSubstr("6host_star: 2 points, 2 pipelines, 2 seeds"));
  EXPECT_EQ(lines_of("out/hosts.csv"), 1U + 8 * 6);
  const ProgramResult clocks =
      run({"clocks", "--scenario", "6host_star", "--pipelines", "chrony", "--seeds", "2",
           "--from-s", "100", "--duration-s", "400", "--set", "/network/latency_exponential_ms=0.2",
           "--format", "json"});
  ASSERT_EQ(clocks.status, 0) << clocks.err;
  const std::string csv = content("out/sweep.csv");
  for (const std::string start : {"\n0.2,chrony,1,", "\n0.2,chrony,2,"}) {
    const std::size_t line = csv.find(start);
    ASSERT_NE(line, std::string::npos);
    const std::size_t cell = line + start.size();
    const std::string spread = csv.substr(cell, csv.find(',', cell) - cell);
    EXPECT_GT(spread.size(), 4U);
    EXPECT_THAT(clocks.out, HasSubstr(spread));
  }
}

TEST_F(SweepTest, AnInterruptedClockSweepGoesOnWithItsOwnPeriodOnly) {
  ASSERT_EQ(run(clock_sweep("whole", {"--duration-s", "400"})).status, 0);
  ASSERT_EQ(run(clock_sweep("out", {"--duration-s", "400", "--jobs", "1"})).status, 0);
  EXPECT_EQ(all_of("out"), all_of("whole"));
  std::string log = content("out/runs.log");
  log.resize(log.size() / 2);
  file("out/runs.log", log);
  const ProgramResult other = run(clock_sweep("out", {"--duration-s", "401"}));
  EXPECT_EQ(other.status, 2);
  EXPECT_THAT(other.err, HasSubstr("/duration_s is 400 there and 401 here"));
  const ProgramResult again = run(clock_sweep("out", {"--duration-s", "400"}));
  EXPECT_EQ(again.status, 0) << again.err;
  EXPECT_THAT(again.err, HasSubstr("of 8 runs finished already"));
  EXPECT_EQ(all_of("out"), all_of("whole"));
}

TEST_F(SweepTest, ClockSweepsEndAtOnceWhenInterrupted) {
  ProgramOptions options;
  options.interrupt_after = std::chrono::milliseconds(200);
  const ProgramResult result = run(clock_sweep("out", {"--duration-s", "30000000"}), options);
  EXPECT_EQ(result.status, 130) << result.err;
  EXPECT_THAT(result.err, HasSubstr("the same command goes on"));
}

TEST_F(SweepTest, ClockSweepsRefuseWhatMeansNothing) {
  const auto problem = [this](const std::vector<std::string>& arguments) {
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.status, 2);
    return result.err;
  };
  EXPECT_THAT(problem(command("out", {"--duration-s", "100"})),
              HasSubstr("--duration-s: found without --clocks"));
  EXPECT_THAT(problem(command("out", {"--from-s", "100"})),
              HasSubstr("--from-s: found without --clocks"));
  EXPECT_THAT(problem({"sweep", "--clocks", "--study", "seeds_needed", "-o", "out"}),
              HasSubstr("--clocks: the study seeds_needed shows what only captures have"));
  EXPECT_THAT(problem(clock_sweep("out", {"--duration-s", "100"})),
              HasSubstr("--from-s: found 100, allowed: less than --duration-s, 100"));
  EXPECT_THAT(
      problem({"sweep", "--clocks", "--scenario", "leaderboard_lan", "--pipelines",
               "host.trigger_wired", "--sweep", "/hosts/count=6", "-o", "out"}),
      HasSubstr("needs the trigger's pulses, which a run of the clocks alone does not have"));
  EXPECT_TRUE(names_in().empty());
}

TEST_F(SweepTest, Studies) {
  const ProgramResult list = run({"sweep", "--study", "list"});
  EXPECT_EQ(list.status, 0);
  EXPECT_EQ(list.out, run({"list", "studies"}).out);
  const ProgramResult result = run({"sweep", "--study", "seeds_needed", "--seeds", "8", "--set",
                                    "/timeline/frames=20", "-o", "out"});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("+-5 %"));
  EXPECT_THAT(content("out/manifest.json"), HasSubstr("\"study\": \"seeds_needed\""));
}

TEST_F(SweepTest, SaysThatItChecksManyPoints) {
  file("results", "in the way");
  const ProgramResult many = run({"sweep", "--scenario", "3cam_1host_30fps", "--sweep",
                                  "/trigger/pulse_jitter_sigma_us=0:999:1", "-o", "results"});
  EXPECT_EQ(many.status, 2);
  EXPECT_THAT(many.err, testing::StartsWith("note: checking 1000 points\n"));
}

}  // namespace
}  // namespace simbench
