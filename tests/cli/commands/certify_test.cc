// `simbench certify` through the real program.
#include <gmock/gmock.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tests/cli/program.h"

namespace simbench {
namespace {

using Json = nlohmann::ordered_json;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

class CertifyCommand : public ProgramTest {
 protected:
  // A small rig on a LAN.
  static std::vector<std::string> rig(std::vector<std::string> options) {
    std::vector<std::string> arguments = {"certify",
                                          "18cam_6host_45fps_lan",
                                          "--pipelines",
                                          "two_way_hull",
                                          "--set",
                                          "/cameras/count=6",
                                          "--set",
                                          "/hosts/count=2",
                                          "--set",
                                          "/timeline/frames=20",
                                          "--set",
                                          "/timeline/warm_up_ms=200",
                                          "--estimated-stamp-ms",
                                          "0.02"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return arguments;
  }
};

TEST_F(CertifyCommand, AnswersFirst) {
  const ProgramResult result = run(rig({}));
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out,
              AllOf(HasSubstr("two_way_hull: in 95 % of its sets no two frames were exposed more "
                              "than "),
                    HasSubstr("Truth: it lies within for all 120 frames that have a bound."),
                    HasSubstr("host_rate_ppm = 53: ")));
}

TEST_F(CertifyCommand, JsonHasAssumptionsRowsAndTruth) {
  const ProgramResult result = run(rig({"--json", "--host-rate-ppm", "20", "--within", "5ms"}));
  ASSERT_EQ(result.status, 0) << result.err;
  const Json root = Json::parse(result.out);
  EXPECT_EQ(root["assumptions"]["host_rate_ppm"], 20.0);
  EXPECT_EQ(root["assumptions"]["message_ms"], 0.0);
  EXPECT_EQ(root["within_ms"], 5.0);
  ASSERT_EQ(root["rows"].size(), 1U);
  const Json& row = root["rows"][0];
  EXPECT_EQ(row["sets"], 20);
  EXPECT_EQ(row["frames"], 120);
  EXPECT_EQ(row["truth_outside"], 0);
  EXPECT_EQ(row["within"], 20);
  EXPECT_LE(row["certified_ms"]["p50"], row["certified_ms"]["p95"]);
  EXPECT_LE(row["certified_ms"]["p95"], row["certified_ms"]["max"]);
  EXPECT_TRUE(row["contradicted"].empty());
  EXPECT_GT(row["weakest"].size(), 0U);
}

TEST_F(CertifyCommand, SameBytesOnOneThreadAndTwo) {
  const ProgramResult one = run(rig({"--json", "--seeds", "3", "--jobs", "1"}));
  const ProgramResult two = run(rig({"--json", "--seeds", "3", "--jobs", "2"}));
  EXPECT_EQ(one.status, 0) << one.err;
  EXPECT_EQ(one.out, two.out);
}

TEST_F(CertifyCommand, ARequirementThatIsNotMetIsStatusThree) {
  EXPECT_EQ(run(rig({"--within", "5ms", "--require", "100"})).status, 0);
  EXPECT_EQ(run(rig({"--within", "1us", "--require", "1"})).status, 3);
}

TEST_F(CertifyCommand, AWrongAssumptionIsProved) {
  const ProgramResult result =
      run(rig({"--set", "/hosts/clock/skew_of_host_ppm=[300,-300]", "--set",
               "/timeline/warm_up_ms=3000", "--require", "0", "--host-rate-ppm", "50"}));
  EXPECT_EQ(result.status, 3) << result.err;
  EXPECT_THAT(result.out, AllOf(HasSubstr("Contradictions"), HasSubstr(" before it began"),
                                HasSubstr("with rates of +-500 ppm nothing contradicts"),
                                HasSubstr("a message sent by host"),
                                HasSubstr("what is assumed contradicts every recording"),
                                HasSubstr("1 capture has no certificates")));
}

// A recorded folder has the certificates of its run.
TEST_F(CertifyCommand, ARecordingHasThoseOfItsRun) {
  const std::vector<std::string> world = {"--set", "/cameras/count=6",   "--set", "/hosts/count=2",
                                          "--set", "/timeline/frames=20"};
  std::vector<std::string> record = {"record",      "--scenario",   "18cam_6host_45fps_lan",
                                     "--pipelines", "two_way_hull", "-o",
                                     "monday"};
  record.insert(record.end(), world.begin(), world.end());
  ASSERT_EQ(run(record).status, 0);
  std::vector<std::string> certify = {
      "certify", "18cam_6host_45fps_lan", "--pipelines", "two_way_hull",
      "--json",  "--estimated-stamp-ms",  "0.02"};
  certify.insert(certify.end(), world.begin(), world.end());
  const ProgramResult of_run = run(certify);
  const ProgramResult of_folder =
      run({"certify", "monday", "--json", "--estimated-stamp-ms", "0.02"});
  ASSERT_EQ(of_folder.status, 0) << of_folder.err;
  EXPECT_EQ(Json::parse(of_run.out)["rows"], Json::parse(of_folder.out)["rows"]);
}

// A protocol whose stamps are estimates: nothing is proved, and what to do is said.
TEST_F(CertifyCommand, WhatIsLeftOutIsNamed) {
  const ProgramResult result = run({"certify", "18cam_6host_45fps_lan", "--pipelines",
                                    "two_way_hull", "--set", "/timeline/frames=5"});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out,
              AllOf(StartsWith("18cam_6host_45fps_lan"), HasSubstr("Nothing is certified: "),
                    HasSubstr("Left out"), HasSubstr("--estimated-stamp-ms")));
}

// Beside AMD, in tables and results.
TEST_F(CertifyCommand, RunsHaveItsColumn) {
  const std::vector<std::string> run_it = {"run",
                                           "--scenario",
                                           "18cam_6host_45fps_lan",
                                           "--pipelines",
                                           "two_way_min_rtt,chrony",
                                           "--set",
                                           "/timeline/frames=10",
                                           "--seeds",
                                           "2",
                                           "--no-levers"};
  const auto with = [&](std::vector<std::string> options) {
    std::vector<std::string> arguments = run_it;
    arguments.insert(arguments.end(), options.begin(), options.end());
    return run(arguments);
  };
  EXPECT_THAT(with({}).out, Not(HasSubstr("certified")));
  const ProgramResult table = with({"--certify"});
  EXPECT_EQ(table.status, 0) << table.err;
  EXPECT_THAT(table.out, HasSubstr("certified"));
  const ProgramResult json = with({"--certify", "--format", "json"});
  ASSERT_EQ(json.status, 0) << json.err;
  const Json rows = Json::parse(json.out)["rows"];
  EXPECT_TRUE(rows[0]["certified_ms"]["median"].is_null());
  EXPECT_GT(rows[1]["certified_ms"]["median"], 1.0);
  EXPECT_EQ(with({"--certify", "--budget"}).status, 2);
}

TEST_F(CertifyCommand, EveryPairHasItsInterval) {
  const ProgramResult result = run(rig({"--pairs", "pairs.csv"}));
  ASSERT_EQ(result.status, 0) << result.err;
  std::istringstream lines(content("pairs.csv"));
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line,
            "pipeline,seed,set,first_camera,first_sensor_us,second_camera,second_sensor_us,"
            "least_ms,most_ms,truth_ms,changed");
  std::size_t pairs = 0;
  while (std::getline(lines, line)) {
    ++pairs;
    std::vector<std::string> cells;
    std::istringstream row(line.substr(0, line.find(",\"changed: ")));
    for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
    ASSERT_EQ(cells.size(), 10U) << line;
    EXPECT_LE(std::stod(cells[7]), std::stod(cells[9]));
    EXPECT_GE(std::stod(cells[8]), std::stod(cells[9]));
  }
  EXPECT_EQ(pairs, 20U * 15);
}

TEST_F(CertifyCommand, BadInputIsNamed) {
  const auto refused = [&](const std::vector<std::string>& arguments, const std::string& message) {
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.status, 2);
    EXPECT_THAT(result.out, IsEmpty());
    EXPECT_THAT(result.err, AllOf(StartsWith("error: "), HasSubstr(message)));
  };
  refused(rig({"--within", "1"}), "--within: found '1', allowed: a time above 0 with its unit");
  refused(rig({"--trigger-spread-us", "1"}), "--common-trigger");
  refused({"certify", "no_such_rig"}, "no_such_rig");
  refused({"certify", "scale_18000cam_6000host_45fps"},
          "found 6000 hosts and 18000 cameras, allowed: 1000 together");
  refused({"certify", "18cam_6host_45fps_lan", "--pipelines", "nothing"}, "nothing");
  refused(rig({"--clock-log", "0=rawstats"}),
          "--clock-log: found the scenario 18cam_6host_45fps_lan, allowed: a folder");
  refused(rig({"--host-address", "0=10.0.0.1"}), "--clock-log");
}

// Pulses of PPS lines prove nothing until it is known how late hosts see them.
TEST_F(CertifyCommand, PulsesTieHosts) {
  const std::vector<std::string> rig = {"certify",     "18cam_6host_45fps_lan_hardware_clocks",
                                        "--pipelines", "gnss+two_way_poll_calibrated+yoon2021",
                                        "--set",       "/timeline/frames=20",
                                        "--json"};
  const ProgramResult without = run(rig);
  ASSERT_EQ(without.status, 0) << without.err;
  const Json unknown = Json::parse(without.out)["rows"][0];
  EXPECT_EQ(unknown["certified_ms"]["p50"], nullptr);
  EXPECT_GT(unknown["unused_pulses"], 300);
  std::vector<std::string> stated = rig;
  stated.insert(stated.end(), {"--pulse-late-us", "200"});
  const ProgramResult with = run(stated);
  ASSERT_EQ(with.status, 0) << with.err;
  const Json known = Json::parse(with.out)["rows"][0];
  EXPECT_EQ(known["pulses"], unknown["unused_pulses"]);
  EXPECT_LT(known["certified_ms"]["max"].get<double>(), 2);
  EXPECT_EQ(known["truth_outside"], 0);
}

// A log of a recording: of which host, of one capture, of exchanges.
TEST_F(CertifyCommand, LogsThatProveNothingAreNamed) {
  ASSERT_EQ(run({"record", "--scenario", "18cam_6host_45fps_lan", "--pipelines",
                 "two_way_hull,chrony_lan+two_way_poll+yoon2021", "--set", "/timeline/frames=5",
                 "-o", "monday"})
                .status,
            0);
  file("tracking.log",
       "2024-09-03 10:00:00 192.168.1.1 2 4.100 0.030 1.200e-06 N 1 8.1e-07 -5.9e-08 3.7e-04 "
       "4.7e-04 9.0e-03\n");
  const auto refused = [&](std::vector<std::string> options, const std::string& message) {
    options.insert(options.begin(), {"certify", "monday"});
    const ProgramResult result = run(options);
    EXPECT_EQ(result.status, 2);
    EXPECT_THAT(result.err, AllOf(StartsWith("error: "), HasSubstr(message)));
  };
  refused({"--clock-log", "0=tracking.log"}, "found 2 captures, allowed: one");
  const std::vector<std::string> one = {"--pipelines", "two_way_hull", "--clock-log"};
  const auto with = [&](const std::string& log) {
    std::vector<std::string> options = one;
    options.push_back(log);
    return options;
  };
  refused(with("tracking.log"), "--clock-log: found 'tracking.log', allowed: HOST=FILE");
  refused(with("6=tracking.log"), "HOST from 0 to 5");
  refused(with("0=tracking.log"), "tracking.log:1: found tracking.log of chrony, which has no");
  refused(with("0=no_such.log"), "no_such.log");
}

// A set of one frame is within any bound, which says nothing of a rig.
TEST_F(CertifyCommand, SetsOfOneFrameAreLeftOut) {
  const std::vector<std::string> alone = {
      "18cam_6host_45fps_lan", "--pipelines", "chrony",         "--set",
      "/cameras/count=1",      "--set",       "/hosts/count=1", "--set",
      "/timeline/frames=20"};
  std::vector<std::string> arguments = {"certify", "--format", "table"};
  arguments.insert(arguments.end(), alone.begin(), alone.end());
  const ProgramResult text = run(arguments);
  EXPECT_EQ(text.status, 0) << text.err;
  EXPECT_THAT(text.out, AllOf(HasSubstr("Nothing is certified: "),
                              HasSubstr("chrony: 20 sets of one frame")));
  arguments[2] = "json";
  const Json row = Json::parse(run(arguments).out)["rows"][0];
  EXPECT_EQ(row["sets"], 0);
  EXPECT_EQ(row["lone_frames"], 20);
  EXPECT_TRUE(row["certified_ms"]["max"].is_null());
  arguments.insert(arguments.end(), {"--require", "0"});
  EXPECT_EQ(run(arguments).status, 3);
}

// Where most pulses have no set, the bound of the rest says little.
TEST_F(CertifyCommand, PulsesWithoutASetAreCounted) {
  const std::vector<std::string> rig = {
      "certify", "18cam_6host_45fps_lan", "--pipelines", "chrony",
      "--set",   "/cameras/count=3",      "--set",       "/hosts/count=1",
      "--set",   "/timeline/frames=100",  "--set",       "/cameras/drop_probability=0.5"};
  const ProgramResult text = run(rig);
  EXPECT_EQ(text.status, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr(" of 100 pulses due; of the others nothing is certified"));
  std::vector<std::string> as_json = rig;
  as_json.emplace_back("--json");
  const Json row = Json::parse(run(as_json).out)["rows"][0];
  EXPECT_EQ(row["due_pulses"], 100);
  EXPECT_LT(row["sets"], 50);
  EXPECT_THAT(run({"certify", "18cam_6host_45fps_lan", "--pipelines", "chrony", "--set",
                   "/timeline/frames=20"})
                  .out,
              Not(HasSubstr("pulses due")));
}

// Files of other programs have no messages and no polls; neither has a folder that is no recording.
TEST_F(CertifyCommand, RecordingsWithoutExchangesAreNamed) {
  file("left.csv", "counter,sensor_us,arrival_ms\n0,1000,5\n1,34333,38\n");
  const auto refused = [&](const std::vector<std::string>& arguments, const std::string& message) {
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.status, 2);
    EXPECT_THAT(result.err, AllOf(StartsWith("error: "), HasSubstr(message)));
  };
  const std::string what_to_record =
      "found no messages between hosts and no polls of the cameras' "
      "clocks, allowed: a folder that `simbench record` wrote";
  refused({"certify", "left.csv"}, what_to_record);
  refused({"replay", "left.csv", "--certify"}, what_to_record);
  ASSERT_EQ(run({"run", "3cam_1host_30fps", "--seeds", "1", "-o", "archive"}).status, 0);
  refused({"certify", "archive"}, "archive: is the archive of a run, and no recording");
  std::filesystem::create_directory(folder() / "empty");
  refused({"certify", "empty"}, "empty: is no recording, it has no manifest.json");
}

}  // namespace
}  // namespace simbench
