// Help, lists and mistakes in the use of the command.
#include <gmock/gmock.h>

#include <algorithm>
#include <utility>

#include "recording/version.h"
#include "tests/cli/program.h"

namespace simbench {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

class Usage : public ProgramTest {
 protected:
  // Refused with status 2 and a message that has all of `parts`; nothing on standard output.
  void refuses(const std::vector<std::string>& arguments, const std::vector<std::string>& parts) {
    SCOPED_TRACE(testing::PrintToString(arguments));
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.status, 2);
    EXPECT_EQ(result.out, "");
    EXPECT_THAT(result.err, StartsWith("error: "));
    for (const std::string& part : parts) EXPECT_THAT(result.err, HasSubstr(part));
  }
};

TEST_F(Usage, EveryCommandHasHelpWithAnExample) {
  const ProgramResult all = run({"--help"});
  EXPECT_EQ(all.status, 0);
  EXPECT_EQ(all.err, "");
  for (const char* command :
       {"run", "list", "describe", "validate", "replay", "diagnose", "stability", "convert-ibl",
        "record", "fit", "node", "keygen", "relay", "validate-model", "reconstruct"}) {
    EXPECT_THAT(all.out, HasSubstr(command));
    const ProgramResult result = run({command, "--help"});
    EXPECT_EQ(result.status, 0) << command;
    EXPECT_EQ(result.err, "") << command;
    EXPECT_THAT(result.out, HasSubstr("Example")) << command;
    EXPECT_THAT(result.out, HasSubstr(std::string("simbench ") + command)) << command;
  }
  EXPECT_THAT(all.out,
              AllOf(HasSubstr("simbench 18cam_6host_45fps"), HasSubstr("Exit status: 0 ok")));
}

TEST_F(Usage, HelpNamesEveryOptionOfRun) {
  const ProgramResult result = run({"run", "--help"});
  for (const char* option : {"--scenario", "--seeds", "--first-seed", "--jobs", "--pipelines",
                             "--set", "--format", "--output"}) {
    EXPECT_THAT(result.out, HasSubstr(option));
  }
}

TEST_F(Usage, VersionNamesTheCommit) {
  const ProgramResult result = run({"--version"});
  EXPECT_EQ(result.status, 0);
  EXPECT_EQ(result.out,
            "simbench " + std::string(version()) + " (" + std::string(commit()) + ")\n");
}

TEST_F(Usage, ListsWhatThereIs) {
  const ProgramResult names = run({"list"});
  EXPECT_EQ(names.status, 0);
  for (const char* name : {"18cam_6host_45fps", "host_sync", "yoon2021_both", "capture_alignment",
                           "rpi_sync", "device_time", "regression_30", "gathering", "genlock"}) {
    EXPECT_THAT(names.out, HasSubstr(name));
  }
  EXPECT_THAT(run({"list", "algorithms"}).out,
              AllOf(HasSubstr("source: "), HasSubstr("_exposure_corrected")));
  EXPECT_THAT(run({"list", "pipelines"}).out, HasSubstr("ntp_last_set"));
  EXPECT_THAT(run({"list", "scenarios"}).out, HasSubstr("18cam_6host_15fps"));
  EXPECT_THAT(run({"list", "cameras"}).out, HasSubstr("d455: RealSense D455"));
  EXPECT_THAT(run({"list", "cameras", "--format", "json"}).out, HasSubstr("\"model\": \"d435\""));
  EXPECT_THAT(run({"list", "oscillators"}).out,
              AllOf(HasSubstr("tcxo: Temperature-compensated"), HasSubstr("Vig, Introduction")));
  EXPECT_THAT(run({"list", "parts"}).out,
              AllOf(HasSubstr("ptp_cards (clock): Network cards"), HasSubstr("EUR a host")));
  refuses({"list", "--format", "json"}, {"found 'json'", "with cameras only"});
  for (const auto& [what, name] :
       {std::pair{"scenarios", "18cam_6host_45fps"}, std::pair{"pipelines", "genlock"},
        std::pair{"algorithms", "pid_frame_rate"}, std::pair{"cameras", "d455"},
        std::pair{"oscillators", "ocxo"}, std::pair{"parts", "ptp_cards"},
        std::pair{"studies", "scalability"}, std::pair{"figures", "frame_errors"}}) {
    EXPECT_THAT(
        run({"list", what, "--format", "names"}).out,
        AllOf(HasSubstr(std::string(name) + "\n"), Not(StartsWith("\n")), Not(HasSubstr(" "))))
        << what;
  }
  refuses({"list", "fish"}, {"found 'fish'", "scenarios, pipelines, algorithms, cameras"});
}

TEST_F(Usage, DescribesEveryParameter) {
  const ProgramResult result =
      run({"describe", "18cam_6host_45fps", "--set", "/timeline/frames=77"});
  EXPECT_EQ(result.status, 0);
  EXPECT_THAT(result.out, HasSubstr("/timeline/frames"));
  EXPECT_THAT(result.out, HasSubstr("77"));
  EXPECT_THAT(result.out, HasSubstr("source"));
}

TEST_F(Usage, WhatDescribePrintsAsJsonIsAScenario) {
  const ProgramResult result = run({"describe", "18cam_6host_45fps", "--format", "json"});
  ASSERT_EQ(result.status, 0);
  const std::string name = file("mine.json", result.out);
  const ProgramResult checked = run({"validate", name});
  EXPECT_EQ(checked.status, 0) << checked.err;
  EXPECT_EQ(checked.out, "mine.json: ok\n");
}

TEST_F(Usage, WrongCommandsAreRefused) {
  refuses({"fly"}, {"found 'fly'", "allowed: run, ", "list, describe, validate"});
  refuses({"run"}, {"--scenario is required", "See: simbench run --help"});
  refuses({"--seeds", "3"}, {"--scenario is required"});
  refuses({"describe"}, {"scenario is required"});
  refuses({"validate"}, {"files is required"});
  refuses({"replay"}, {"recordings is required"});
  refuses({"run", "--scenario", "18cam_6host_45fps", "--colour"}, {"--colour"});
}

TEST_F(Usage, WithoutArgumentsItSaysWhereToStart) {
  const ProgramResult result = run({});
  EXPECT_EQ(result.status, 0);
  EXPECT_EQ(result.err, "");
  for (const char* part : {"simbench 18cam_6host_45fps", "simbench list", "simbench help run"}) {
    EXPECT_THAT(result.out, HasSubstr(part));
  }
  EXPECT_LT(std::count(result.out.begin(), result.out.end(), '\n'), 10);
}

TEST_F(Usage, HelpIsACommandToo) {
  EXPECT_EQ(run({"help"}).out, run({"--help"}).out);
  EXPECT_EQ(run({"help", "run"}).out, run({"run", "--help"}).out);
  EXPECT_EQ(run({"help", "help"}).status, 0);
  refuses({"help", "fly"}, {"found 'fly'", "allowed: run, "});
}

TEST_F(Usage, AScenarioAloneIsRun) {
  const std::vector<std::string> more = {"--seeds", "1",        "--pipelines",
                                         "oracle",  "--format", "csv"};
  std::vector<std::string> named = {"3cam_1host_30fps"};
  named.insert(named.end(), more.begin(), more.end());
  std::vector<std::string> stated = {"run", "--scenario", "3cam_1host_30fps"};
  stated.insert(stated.end(), more.begin(), more.end());
  const ProgramResult result = run(named);
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.out, run(stated).out);
  std::vector<std::string> after_command = {"run", "3cam_1host_30fps"};
  after_command.insert(after_command.end(), more.begin(), more.end());
  EXPECT_EQ(run(after_command).out, result.out);
  file("mine.json", run({"describe", "3cam_1host_30fps", "--format", "json"}).out);
  named.front() = "mine.json";
  EXPECT_EQ(run(named).status, 0);
  refuses({"missing.json"}, {"missing.json"});
  refuses({"3cam_1host_30fp"}, {"did you mean 3cam_1host_30fps?", "or a scenario"});
}

TEST_F(Usage, OtherWordsLeadToTheCommandsThatAreMeant) {
  refuses({"plot"}, {"found 'plot'", "`simbench figure`", "`simbench report`"});
  refuses({"help", "plot"}, {"`simbench figure`"});
}

TEST_F(Usage, DescribesAnAlgorithm) {
  const ProgramResult result = run({"describe", "two_way_hull"});
  EXPECT_EQ(result.status, 0) << result.err;
  for (const char* part : {"A host_sync, of the family two_way", "window_s", "1 to 100000",
                           "span of the hulls", "MOOSSkewFilter"}) {
    EXPECT_THAT(result.out, HasSubstr(part));
  }
  EXPECT_THAT(
      run({"describe", "oracle"}).out,
      AllOf(HasSubstr("A host_sync"), HasSubstr("A device_time"), HasSubstr("A gathering")));
  EXPECT_THAT(run({"describe", "hull_300_steady"}).out, HasSubstr("A device_time"));
  EXPECT_THAT(run({"describe", "yoon2021", "--format", "json"}).out,
              HasSubstr("\"stage\": \"gathering\""));
  refuses({"describe", "two_way_hul"}, {"found \"two_way_hul\", did you mean two_way_hull?"});
  refuses({"describe", "two_way_hull", "/trigger"}, {"/trigger", "is an algorithm"});
}

TEST_F(Usage, DescribesAPartOfAScenario) {
  const ProgramResult result =
      run({"describe", "18cam_6host_45fps", "/trigger", "--format", "names"});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, testing::StartsWith("/trigger/rate_hz\n"));
  EXPECT_THAT(result.out, Not(HasSubstr("/timeline")));
  EXPECT_THAT(run({"describe", "18cam_6host_45fps", "/hosts/clock"}).out,
              AllOf(HasSubstr("/hosts/clock/set_cost_ms"), Not(HasSubstr("/hosts/count"))));
  EXPECT_THAT(run({"describe", "18cam_6host_45fps", "/trigger", "--format", "json"}).out,
              StartsWith("{\n  \"rate_hz\": 45"));
  refuses({"describe", "18cam_6host_45fps", "/hosts/clok"}, {"did you mean /hosts/clock;"});
  refuses({"describe", "18cam_6host_45fps", "/trig", "--format", "json"}, {"the whole pointer"});
}

TEST_F(Usage, MistypedNamesGetASuggestion) {
  refuses({"vlidate", "x.json"}, {"found 'vlidate', did you mean validate?"});
  refuses({"run", "--scenario", "18cam_6host_45fps", "--seed", "3"},
          {"found '--seed', which `simbench run` does not know; did you mean --seeds?",
           "See: simbench run --help"});
  refuses({"--scenario", "18cam_6host_45fps", "--pipeline=x"}, {"did you mean --pipelines?"});
  refuses({"list", "cameras", "d455"}, {"found 'd455'", "no more than WHAT"});
  refuses({"run", "18cam_6host_45fps", "--scenario", "3cam_1host_30fps"}, {"options only"});
  refuses({"run"}, {"simbench list"});
}

TEST_F(Usage, NumbersAreChecked) {
  for (const char* value : {"0", "-1", "many", "1.5", "1e3", "", "99999999999999999999"}) {
    refuses({"--scenario", "18cam_6host_45fps", "--seeds", value},
            {"--seeds", std::string("found '") + value + "'", "a whole number from 1 to 1000000"});
  }
  refuses({"--scenario", "18cam_6host_45fps", "--first-seed", "-3"}, {"--first-seed"});
  refuses({"--scenario", "18cam_6host_45fps", "--jobs", "0"}, {"--jobs", "from 1 to"});
  refuses({"--scenario", "18cam_6host_45fps", "--format", "xml"},
          {"found 'xml'", "table, markdown, latex, csv, tidy, json"});
  refuses({"--scenario", "18cam_6host_45fps", "--set", "seeds=3"},
          {"--set", "found 'seeds=3'", "/json/pointer=value"});
  refuses({"--scenario", "18cam_6host_45fps", "--set", "/timeline/frames"}, {"--set"});
}

TEST_F(Usage, AResultThatCannotBeWrittenIsOneClearLine) {
  for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
           {"list"},
           {"--help"},
           {"--version"},
           {"run", "--help"},
           {"describe", "3cam_1host_30fps"},
           {"completion", "bash"},
           {"manual"},
           {"manual", "run"},
           {"trace", "--scenario", "3cam_1host_30fps", "-o", "-", "--format", "csv"},
           {"sweep", "--study", "list"},
           {"run", "--scenario", "3cam_1host_30fps", "--seeds", "1", "--jobs", "1"}}) {
    SCOPED_TRACE(testing::PrintToString(arguments));
    const ProgramResult full = run(arguments, {.out_file = "/dev/full"});
    EXPECT_EQ(full.status, 2);
    EXPECT_THAT(full.err, HasSubstr("error: "));
    EXPECT_THAT(full.err, HasSubstr("No space left on device\n"));
    EXPECT_THAT(full.err, Not(HasSubstr("internal error")));
    const ProgramResult closed = run(arguments, {.closed_out = true});
    EXPECT_EQ(closed.status, 2);
    EXPECT_THAT(closed.err, HasSubstr("Bad file descriptor\n"));
    EXPECT_THAT(closed.err, Not(HasSubstr("internal error")));
  }
}

// Without an open standard output no other file may get its number.
TEST_F(Usage, NothingIsWrittenIntoAResultThatHasTheNumberOfAClosedOutput) {
  const ProgramResult result =
      run({"run", "--scenario", "3cam_1host_30fps", "--seeds", "1", "--output", "results"},
          {.closed_out = true});
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(content("results/results.json"), StartsWith("{"));
  EXPECT_THAT(content("results/hosts.csv"), Not(HasSubstr("AMD")));
}

}  // namespace
}  // namespace simbench
