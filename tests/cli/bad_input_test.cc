// Bad input gets one clear message, status 2, and nothing is written.
#include <gmock/gmock.h>

#include <string>

#include "tests/cli/program.h"

namespace simbench {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

class BadInput : public ProgramTest {
 protected:
  void refuses(const std::vector<std::string>& arguments, const std::vector<std::string>& parts) {
    SCOPED_TRACE(testing::PrintToString(arguments));
    const auto before = names_in();
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.status, 2);
    EXPECT_EQ(result.out, "");
    EXPECT_THAT(result.err, StartsWith("error: "));
    EXPECT_EQ(result.err.find("error: ", 1), std::string::npos) << result.err;
    for (const std::string& part : parts) EXPECT_THAT(result.err, HasSubstr(part));
    EXPECT_EQ(names_in(), before);
  }
  // A scenario file that differs from a good one by `member`; run would write results.
  void refuses_scenario(const std::string& member, const std::vector<std::string>& parts) {
    const std::string text =
        "{\"name\": \"bad\", \"summary\": \"bad\",\n  \"base\": \"18cam_6host_45fps\",\n  " +
        member + "\n}\n";
    refuses({"run", "--scenario", file("bad.json", text), "--output", "results"}, parts);
    refuses({"validate", "bad.json"}, parts);
  }
};

TEST_F(BadInput, AnUnknownScenarioGetsTheNearestNames) {
  refuses({"--scenario", "18cam_6host_46fps"}, {"18cam_6host_46fps", "18cam_6host_45fps"});
}

TEST_F(BadInput, FilesThatCannotBeRead) {
  refuses({"--scenario", "no_such.json"}, {"no_such.json"});
  refuses({"--scenario", "./"}, {"./"});
  refuses({"validate", "no_such.json"}, {"no_such.json"});
}

TEST_F(BadInput, BrokenJson) {
  refuses_scenario("\"name\": \"x\",,", {"bad.json:3"});
  refuses({"--scenario", file("empty.json", "")}, {"empty.json:1"});
}

TEST_F(BadInput, WrongTypesKeysAndRanges) {
  refuses_scenario("\"timeline\": {\"frames\": \"many\"}", {"bad.json:3", "/timeline/frames"});
  refuses_scenario("\"timeline\": {\"frame\": 3}", {"bad.json:3", "/timeline/frame"});
  refuses_scenario("\"timeline\": {\"frames\": -3}", {"bad.json:3", "/timeline/frames", "-3"});
}

TEST_F(BadInput, WhatASchemaCannotSay) {
  refuses_scenario("\"trigger\": {\"rate_hz\": 44444}", {"bad.json:3", "/trigger/rate_hz"});
  refuses_scenario(
      "\"pipelines\": [{\"name\": \"p\", \"host_sync\": \"magic\", \"device_time\": "
      "\"regression_30\", \"gathering\": \"yoon2021\"}]",
      {"bad.json:3", "/pipelines/0/host_sync", "magic", "yoon2021_both"});
}

TEST_F(BadInput, ACameraOnAHostThatDoesNotExist) {
  std::string hosts = "0";
  for (int i = 1; i < 18; ++i) hosts += i == 17 ? ", 9" : ", 0";
  refuses_scenario("\"cameras\": {\"host_of_camera\": [" + hosts + "]}",
                   {"bad.json:3", "/cameras/host_of_camera/17", "9"});
}

TEST_F(BadInput, AnUnknownPipelineGetsTheKnownOnes) {
  refuses({"--scenario", "18cam_6host_45fps", "--pipelines", "yoon", "--output", "results"},
          {"yoon", "yoon2021_both", "free_running"});
}

TEST_F(BadInput, APointerThatNamesNothing) {
  refuses({"--scenario", "18cam_6host_45fps", "--set", "/timeline/frmes=3"},
          {"/timeline/frmes", "--set"});
}

TEST_F(BadInput, AHundredThousandBrackets) {
  refuses({"--scenario", file("deep.json", std::string(100'000, '['))}, {"deep.json:1"});
}

TEST_F(BadInput, EveryFileIsValidated) {
  file("good.json", "{\"name\": \"good\", \"summary\": \"good\", \"base\": \"18cam_6host_45fps\"}");
  file("bad.json", "{");
  const ProgramResult result = run({"validate", "bad.json", "good.json"});
  EXPECT_EQ(result.status, 2);
  EXPECT_EQ(result.out, "good.json: ok\n");
  EXPECT_THAT(result.err, HasSubstr("bad.json"));
}

TEST_F(BadInput, MoreBytesThanUsbCarriesIsAWarning) {
  const ProgramResult result = run({"--scenario", "18cam_6host_45fps", "--seeds", "1", "--set",
                                    "/usb/bandwidth_mb_per_s=20", "--set", "/timeline/frames=20"});
  EXPECT_EQ(result.status, 0);
  EXPECT_THAT(result.err, HasSubstr("warning: "));
  EXPECT_THAT(result.err, HasSubstr("%"));
}

TEST_F(BadInput, DamagedRecordings) {
  const std::string header = "Stream Type,Index,F#,HW Timestamp (ms),Host Timestamp(ms)\n";
  const auto replay = [](const std::string& name) {
    return std::vector<std::string>{"replay", name, "--output", "results"};
  };
  refuses(replay("no_such.csv"), {"no_such.csv: cannot be read"});
  refuses(replay(file("empty.csv", "")), {"empty.csv:1: the file is empty"});
  refuses(replay(file("header.csv", header)), {"header.csv:1", "without a frame"});
  refuses(replay(file("other.csv", "a,b\n1,2\n")), {"other.csv:1", "allowed: --columns sensor="});
  refuses(replay(file("cut.csv", header + "Depth,0,1,10,1\nDepth,0,2,4\n")), {"cut.csv:3"});
  refuses(replay(file("text.csv", header + "Depth,0,1,ten,1\n")), {"text.csv:2", "'ten'"});
  refuses({"replay", "cut.csv", "cut.csv"}, {"cut.csv"});
  refuses({"convert-ibl", "cut.csv"}, {"cut.csv", "*.timestamps.ssv"});
}

TEST_F(BadInput, ANameThatIsTooLong) {
  const std::string name(5000, 'a');
  refuses({"replay", name}, {"File name too long"});
  refuses({"report", name, "--output", "x.html"}, {"File name too long"});
  refuses({"figure", "distributions", name, "--output", "x.svg"}, {"File name too long"});
}

TEST_F(BadInput, AKeyThatCannotBeRead) {
  file("rig.json", R"({"schema_version": 1, "name": "test", "hosts": [
    {"name": "host0", "address": "127.0.0.1", "cameras": [{"serial": "left"}]}]})");
  const std::vector<std::string> on_rig = {
      "--scenario", "3cam_1host_30fps", "--backend",  "hardware",
      "--rig",      "rig.json",         "--key-file", "no_such.key"};
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"run"}, {"record", "-o", "rec"}}) {
    std::vector<std::string> arguments = command;
    arguments.insert(arguments.end(), on_rig.begin(), on_rig.end());
    refuses(arguments, {"no_such.key"});
  }
}

TEST_F(BadInput, OutputFoldersAreCheckedBeforeTheWork) {
  const auto to = [](const std::string& folder) {
    return std::vector<std::string>{"--scenario", "18cam_6host_45fps", "--output", folder};
  };
  file("file", "mine");
  refuses(to("file"), {"--output", "is a file"});
  refuses(to("no/such"), {"--output", "make it first"});
  refuses(to("/proc/results"), {"--output", "cannot be written"});
  std::filesystem::create_directory(folder() / "mine");
  file("mine/notes.txt", "mine");
  refuses(to("mine"), {"--output", "notes.txt"});
  EXPECT_EQ(content("mine/notes.txt"), "mine");
}

TEST_F(BadInput, AlgorithmParametersThatContradictEachOther) {
  const std::string name =
      file("polls.json",
           "{\"name\": \"polls\", \"summary\": \"polls\", \"base\": \"18cam_6host_45fps_lan\",\n"
           " \"algorithms\": {\"ntp\": {\n"
           "  \"max_poll\": 5}}}\n");
  const std::vector<std::string> parts = {"polls.json:3", "/algorithms/ntp/max_poll",
                                          "is 5; allowed: at least \"min_poll\", which is 6"};
  refuses({"validate", name}, parts);
  refuses({"run", "--scenario", name, "--pipelines", "oracle"}, parts);
}

TEST_F(BadInput, AnEmptyValueOfAnyOption) {
  const auto refuses_empty = [&](std::vector<std::string> command, const std::string& option) {
    if (option.starts_with("-")) command.push_back(option);
    command.emplace_back("");
    refuses(command, {option + ": found '', allowed: "});
  };
  for (const char* option :
       {"--output", "--pipelines", "--set", "--rig", "--key-file", "--seeds", "--format"}) {
    refuses_empty({"run", "--scenario", "3cam_1host_30fps"}, option);
  }
  refuses_empty({"run"}, "--scenario");
  refuses_empty({"record", "--scenario", "3cam_1host_30fps", "-o", "x"}, "--collect");
  refuses_empty({"node", "--rig", "rig.json", "--name", "host0"}, "--key-file");
  refuses_empty({"node", "--rig", "rig.json", "--name", "host0"}, "--journal");
  refuses_empty({"validate-model"}, "--save");
  refuses_empty({"gate", "a", "b"}, "--junit");
  refuses_empty({"sweep"}, "--study");
  refuses_empty({"validate"}, "files");
  refuses_empty({"replay"}, "recordings");
  EXPECT_THAT(names_in(), testing::IsEmpty());
}

TEST_F(BadInput, ALinkToNothingAsOutputIsRefusedBeforeTheRun) {
  std::filesystem::create_symlink("nowhere", folder() / "link");
  refuses({"run", "--scenario", "3cam_1host_30fps", "--seeds", "100000", "--output", "link"},
          {"--output link: is a link to nowhere, which does not exist"});
}

}  // namespace
}  // namespace simbench
