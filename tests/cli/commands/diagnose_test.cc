// `simbench diagnose` through the real program.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/cli/program.h"

namespace simbench {
namespace {

using Json = nlohmann::ordered_json;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

class DiagnoseCommand : public ProgramTest {
 protected:
  // A minute of two cameras at 30 FPS on one host; the second is `ppm` slow.
  static std::string recording(double ppm) {
    std::string text = "Stream Type,Index,F#,HW Timestamp (ms),Host Timestamp(ms),camera,host\n";
    for (int i = 0; i < 1800; ++i) {
      const double ms = i * 1000.0 / 30;
      const double late_ms = 9 + i * 7919 % 97 * 0.005;
      text += fmt::format("Depth,0,{},{:.3f},{:.6f},left,pc\n", i, 700 + ms, ms + late_ms);
      text += fmt::format("Depth,0,{},{:.3f},{:.6f},right,pc\n", i, 400 + ms,
                          ms * (1 + ppm * 1e-6) + late_ms);
    }
    return text;
  }
};

TEST_F(DiagnoseCommand, SaysThatTheSyncWorks) {
  const ProgramResult result = run({"diagnose", file("rig.csv", recording(0))});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, StartsWith("Depth 0: hardware sync works: all 2 cameras"));
  EXPECT_THAT(result.err, IsEmpty());
}

TEST_F(DiagnoseCommand, SaysThatItDoesNot) {
  const ProgramResult result = run({"diagnose", file("rig.csv", recording(60))});
  EXPECT_EQ(result.status, 0) << "the exit status says whether there was an answer";
  EXPECT_THAT(result.out, StartsWith("Depth 0: hardware sync does not work, because free-running"));
  EXPECT_THAT(result.out, HasSubstr("drifts 3.6 ms per minute relative to camera left"));
}

TEST_F(DiagnoseCommand, JsonIsAllThatIsOnStandardOutput) {
  const ProgramResult result =
      run({"diagnose", file("rig.csv", recording(0)), "--rate-hz", "60", "--format", "json"});
  ASSERT_EQ(result.status, 0) << result.err;
  const Json root = Json::parse(result.out);
  EXPECT_EQ(root["verdict"]["status"], "works");
  EXPECT_EQ(root["cameras"][1]["period_multiple"], 2);
}

TEST_F(DiagnoseCommand, BadInputIsNamed) {
  const ProgramResult none = run({"diagnose", "absent.csv"});
  EXPECT_EQ(none.status, 2);
  EXPECT_THAT(none.err, HasSubstr("absent.csv: cannot be read"));
  const ProgramResult rate = run({"diagnose", file("rig.csv", recording(0)), "--rate-hz", "none"});
  EXPECT_EQ(rate.status, 2);
  EXPECT_THAT(rate.err, HasSubstr("found 'none', allowed: a number from 0.01 to 10000"));
  const ProgramResult empty = run({"diagnose", file("empty.csv", "")});
  EXPECT_EQ(empty.status, 2);
  EXPECT_THAT(empty.err, HasSubstr("the file is empty"));
}

// Arrivals from 2023-11-14 22:13:20 UTC on, on host pc, whose clock is set by -250 ms after 30 s.
std::string recording_of_a_set_clock() {
  std::string text = "Stream Type,Index,F#,HW Timestamp (ms),Host Timestamp(ms),camera,host\n";
  for (int i = 0; i < 1800; ++i) {
    const double ms = i * 1000.0 / 30;
    const double late_ms = 1.7e12 + 9 + i * 7919 % 97 * 0.005 - (ms > 30'000 ? 250 : 0);
    text += fmt::format("Depth,0,{},{:.3f},{:.6f},left,pc\n", i, 700 + ms, ms + late_ms);
    text += fmt::format("Depth,0,{},{:.3f},{:.6f},right,pc\n", i, 400 + ms, ms + late_ms);
  }
  return text;
}

// What ptp4l says of that clock, by syslog: the boot was 100 s before the recording.
std::string log_of_a_set_clock(const char* day) {
  std::string text;
  for (int s = -20; s < 80; ++s) {
    text += fmt::format(
        "{} 22:{:02}:{:02} pc ptp4l: [{}.010] master offset {} s2 freq +{} path delay 1200\n", day,
        13 + (s + 20) / 60, (s + 20) % 60, 100 + s, s < 30 ? 250'000'000 + s % 7 : s % 7,
        900 + s % 5);
  }
  return text;
}

TEST_F(DiagnoseCommand, AClockLogTellsThatTheClockWasSetAndNotTheCameras) {
  const std::string rig = file("rig.csv", recording_of_a_set_clock());
  const std::string log = file("ptp4l.log", log_of_a_set_clock("Nov 14"));
  const ProgramResult result = run({"diagnose", rig, "--clock-log", log});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("the clock of host pc was set by -250"));
  EXPECT_THAT(result.out, HasSubstr("jump by -2"));
  EXPECT_THAT(result.out, HasSubstr("The clocks of the hosts by their logs"));
  const ProgramResult json = run({"diagnose", rig, "--clock-log", "pc=" + log, "--format", "json"});
  ASSERT_EQ(json.status, 0) << json.err;
  const Json root = Json::parse(json.out);
  EXPECT_EQ(root["clocks"]["hosts"][0]["placed"], "as_is");
  EXPECT_EQ(root["findings"][0]["kind"], "host_clock_step");
}

TEST_F(DiagnoseCommand, AClockLogThatDoesNotFitIsNamed) {
  const std::string rig = file("rig.csv", recording_of_a_set_clock());
  const std::string log = file("ptp4l.log", log_of_a_set_clock("Nov 20"));
  const ProgramResult other_day = run({"diagnose", rig, "--clock-log", log});
  EXPECT_EQ(other_day.status, 0) << other_day.err;
  EXPECT_THAT(other_day.out, HasSubstr("2023-11-20"));
  const ProgramResult other_host = run({"diagnose", rig, "--clock-log", "elsewhere=" + log});
  EXPECT_EQ(other_host.status, 0) << other_host.err;
  EXPECT_THAT(other_host.out, HasSubstr("elsewhere"));
  const ProgramResult none = run({"diagnose", rig, "--clock-log", "pc=absent.log"});
  EXPECT_EQ(none.status, 2);
  EXPECT_THAT(none.err, HasSubstr("absent.log"));
}

// PTP looks good on both hosts, and the maps are blurry: the exposures are 5.2 ms apart.
TEST_F(DiagnoseCommand, ClocksThatAreLockedAreNotTheCauseOfExposuresApart) {
  std::string rig = "camera,host,seq,stamp_ms,arrival_ms\n";
  for (int i = 0; i < 1800; ++i) {
    const double ms = 1.7e12 + i * 1000.0 / 30;
    const double late_ms = 20 + i * 7919 % 97 * 0.01;
    rig += fmt::format("left,A,{},{:.3f},{:.3f}\n", i, ms, ms + late_ms);
    rig += fmt::format("right,B,{},{:.3f},{:.3f}\n", i, ms + 5.2, ms + 5.2 + late_ms);
  }
  const auto log = [this](const std::string& host) {
    std::string text;
    for (int s = 0; s < 40; ++s) {
      text += fmt::format(
          "2023-11-14T22:13:{:02}+00:00 {} ptp4l: [{}.5] master offset {} s2 freq +9 path delay "
          "90\n",
          20 + s, host, 5000 + s, (s * 7919 % 97 - 48) * 100);
    }
    return file(host + ".log", text);
  };
  const ProgramResult result =
      run({"diagnose", file("rig.csv", rig), "--columns",
           "sensor=stamp_ms:ms,arrival=arrival_ms:ms,counter=seq,camera=camera,host=host",
           "--clock-log", log("A"), "--clock-log", log("B")});
  ASSERT_EQ(result.status, 0) << result.err;
  const std::string lead = result.out.substr(0, result.out.find("\nSlips:"));
  EXPECT_THAT(lead, HasSubstr("with a constant offset"));
  EXPECT_THAT(lead, HasSubstr("the clocks are not the cause"));
}

TEST_F(DiagnoseCommand, ColumnsBesideStampsAreFound) {
  std::string text = "camera,seq,stamp_ms,arrival_ms,exposure_us\n";
  for (int i = 0; i < 1800; ++i) {
    const double ms = i * 1000.0 / 30;
    text += fmt::format("a,{},{:.3f},{:.3f},{}\n", i, ms, ms + 9, 2000 + 10 * i);
    text += fmt::format("b,{},{:.3f},{:.3f},{}\n", i, ms, ms + 9, 8000);
  }
  const ProgramResult result =
      run({"diagnose", file("rig.csv", text), "--columns",
           "sensor=stamp_ms,arrival=arrival_ms,counter=seq,camera=camera"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("camera a: its exposures vary from"));
}

TEST_F(DiagnoseCommand, TakesARecordingFolder) {
  ASSERT_EQ(run({"record", "--scenario", "3cam_1host_30fps", "--pipelines", "free_running", "--set",
                 "/timeline/frames=1500", "-o", "rig"})
                .status,
            0);
  const ProgramResult result = run({"diagnose", "rig"});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("3 cameras"));
  std::filesystem::create_directory(folder() / "empty");
  const ProgramResult empty = run({"diagnose", "empty"});
  EXPECT_EQ(empty.status, 2);
  EXPECT_THAT(empty.err, HasSubstr("empty"));
  const ProgramResult both = run({"diagnose", "rig", file("rig.csv", recording(0))});
  EXPECT_EQ(both.status, 2);
  EXPECT_THAT(both.err, HasSubstr("allowed one recording folder, or files"));
}

}  // namespace
}  // namespace simbench
