#include "watch/monitor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/scratch_folder.h"
#include "tests/watch/watched_rig.h"
#include "watch/hook.h"
#include "watch/open_metrics.h"
#include "watch/watch_text.h"

namespace simbench::watch {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

class MonitorTest : public testing::Test {
 protected:
  MonitorTest() {
    append("Stream Type,Index,F#,HW Timestamp (ms),Host Timestamp(ms),camera,host\n");
  }

  void append(const std::string& text) { std::ofstream(path_, std::ios::app) << text; }
  void write(const WatchedRig& rig, int from, int to) {
    std::string text;
    for (const RecordedStream& stream : rig.frames(from, to)) {
      for (const StampedFrame& frame : stream.frames) {
        const std::string ms = std::to_string(static_cast<double>(frame.arrival.count()) / 1e6);
        text += "Depth,0," + std::to_string(frame.counter) + "," + ms + "," + ms + "," +
                stream.camera + ",pc\n";
      }
    }
    append(text);
  }
  static std::vector<std::string> kinds(const std::vector<WatchEvent>& events) {
    std::vector<std::string> names;
    for (const WatchEvent& event : events)
      names.push_back(event.kind + (event.is_alarm ? "" : " over"));
    return names;
  }

  ScratchFolder folder_;
  std::string path_ = folder_ / "rig.csv";
};

TEST_F(MonitorTest, TheSnapshotHasTheStatusWithSinceWhen) {
  Monitor monitor({.recordings = {path_}});
  monitor.poll(100);
  EXPECT_EQ(monitor.snapshot()["status"], "nothing yet");
  const WatchedRig rig{.later_ms = [](std::size_t camera, int pulse) {
    return camera == 2 && pulse >= 300 ? 9.0 : 0.0;
  }};
  write(rig, 0, 200);
  EXPECT_TRUE(monitor.poll(101).empty());
  EXPECT_EQ(monitor.snapshot()["status"], "in order");
  EXPECT_FALSE(monitor.had_alarm());
  write(rig, 200, 400);
  EXPECT_THAT(kinds(monitor.poll(102)), ElementsAre("slipped"));
  const reports::Json alarm = monitor.snapshot();
  EXPECT_EQ(alarm["status"], "alarm");
  EXPECT_EQ(alarm["since_s"], 2.0);
  EXPECT_EQ(alarm["alarms"][0]["subject"], "camera c2");
  EXPECT_EQ(alarm["cameras"].size(), 3u);
  // Nothing closes a slip: it ends as an alarm after its time, and is known ever after.
  write(rig, 400, 500);
  monitor.poll(102 + kRecentS + 1);
  EXPECT_EQ(monitor.snapshot()["status"], "in order");
  EXPECT_TRUE(monitor.had_alarm());
  EXPECT_EQ(monitor.snapshot()["cameras"][2]["slips"], 1);
}

TEST_F(MonitorTest, AFileThatStandsStillIsAnAlarmUntilItGrows) {
  Monitor monitor({.recordings = {path_}});
  write({}, 0, 100);
  monitor.poll(0);
  EXPECT_TRUE(monitor.poll(kStallS - 1).empty());
  EXPECT_THAT(kinds(monitor.poll(kStallS + 1)), ElementsAre("stands_still"));
  EXPECT_TRUE(monitor.poll(kStallS + 2).empty());
  write({}, 100, 130);
  EXPECT_THAT(kinds(monitor.poll(kStallS + 3)), ElementsAre("stands_still over"));
  EXPECT_FALSE(monitor.has_alarm());
}

TEST_F(MonitorTest, AFileThatIsGoneOrNonsenseIsAnAlarmUntilItIsNot) {
  Monitor monitor({.recordings = {path_}});
  write({}, 0, 100);
  monitor.poll(0);
  append("nonsense,1\n");
  EXPECT_THAT(kinds(monitor.poll(1)), ElementsAre("unreadable"));
  write({}, 100, 110);
  EXPECT_THAT(kinds(monitor.poll(2)), ElementsAre("unreadable over"));
  std::filesystem::rename(path_, path_ + ".away");
  EXPECT_THAT(kinds(monitor.poll(3)), ElementsAre("gone"));
  std::filesystem::rename(path_ + ".away", path_);
  EXPECT_THAT(kinds(monitor.poll(4)), ElementsAre("gone over"));
}

// The masks are those of `simbench stability`; of the last errors, and again once they are kept.
TEST_F(MonitorTest, AClockIsJudgedByMasks) {
  const std::string log = folder_ / "clock.csv";
  const auto add = [&log](int from, int to, double error_us) {
    std::ofstream file(log, std::ios::app);
    for (int i = from; i < to; ++i) file << i << "," << error_us + chance(1, i) << "\n";
  };
  std::ofstream(log) << "time_s,offset_us\n";
  add(0, 100, 0);
  Monitor monitor({.clock_logs = {{.host = "a", .path = log}},
                   .clock_masks = {evaluation::limits_mask({"max_te=50us"})}});
  EXPECT_TRUE(monitor.poll(0).empty());
  add(100, 103, 80);
  EXPECT_THAT(kinds(monitor.poll(kJudgeS / 2)), ElementsAre("clock_step"));
  EXPECT_THAT(kinds(monitor.poll(kJudgeS)), ElementsAre("beyond_limit"));
  EXPECT_THAT(monitor.snapshot()["text"].get<std::string>(), HasSubstr("clock of a: "));
  add(103, 103 + static_cast<int>(kKeptErrors) + 10, 0);
  EXPECT_THAT(kinds(monitor.poll(2 * kJudgeS)), Contains("beyond_limit over"));
}

// What is shown in three ways is the same.
TEST_F(MonitorTest, TerminalAndMetricsShowTheSnapshot) {
  Monitor monitor({.recordings = {path_}});
  const WatchedRig rig{
      .arrives = [](std::size_t camera, int pulse) { return camera != 1 || pulse % 10 != 0; }};
  write(rig, 0, 300);
  monitor.poll(0);
  const reports::Json snapshot = monitor.snapshot();
  const std::string text = watch_text(snapshot);
  EXPECT_THAT(text, HasSubstr("camera c1 loses frames"));
  EXPECT_THAT(text, HasSubstr("alarm, for 0 s"));
  const std::string metrics = open_metrics(snapshot);
  EXPECT_THAT(metrics, HasSubstr("simbench_alarms{kind=\"losing\"} 1\n"));
  EXPECT_THAT(metrics, HasSubstr("simbench_in_order 0\n"));
  EXPECT_THAT(metrics, HasSubstr("simbench_camera_frames_total{camera=\"c0\",host=\"pc\",stream="
                                 "\"Depth 0\"} 300\n"));
  EXPECT_THAT(metrics, Not(HasSubstr("nan")));
  EXPECT_TRUE(metrics.ends_with("# EOF\n"));
}

TEST_F(MonitorTest, LabelsOfMetricsAreEscaped) {
  const reports::Json snapshot = {{"status", "in order"},
                                  {"alarms", reports::Json::array()},
                                  {"cameras", reports::Json::array()},
                                  {"clocks",
                                   {{{"subject", "a\"b\\c\nd"},
                                     {"file", "f"},
                                     {"error_ms", 1.5},
                                     {"max_te_ms", nullptr},
                                     {"rms_te_ms", nullptr},
                                     {"steps", 0},
                                     {"samples", 3}}}}};
  EXPECT_THAT(
      open_metrics(snapshot),
      HasSubstr("simbench_clock_error_seconds{subject=\"a\\\"b\\\\c\\nd\",file=\"f\"} 0.0015\n"));
}

TEST_F(MonitorTest, AHookHearsOneEventAfterAnother) {
  const std::string heard = folder_ / "heard";
  Hook hook("echo \"$SIMBENCH_EVENT_KIND\" >> " + heard);
  for (const char* const kind : {"one", "two", "three"}) hook.tell({.kind = kind});
  hook.finish();
  std::ifstream file(heard);
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  EXPECT_THAT(lines, ElementsAre("one", "two", "three"));
  EXPECT_EQ(hook.failed(), 0u);
}

TEST_F(MonitorTest, AHookThatFailsOrIsSlowIsCounted) {
  Hook hook("exit 3");
  for (std::size_t i = 0; i < kMostWaiting + 10; ++i) hook.tell({.kind = "x"});
  hook.finish();
  EXPECT_GT(hook.failed(), kMostWaiting - 1);
  EXPECT_LE(hook.dropped(), 10u);
}

}  // namespace
}  // namespace simbench::watch
