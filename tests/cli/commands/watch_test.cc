// `simbench watch` through the real program, of files that have all their lines already.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tests/cli/program.h"
#include "tests/scratch_folder.h"
#include "tests/watch/watched_rig.h"

namespace simbench {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::string csv_of(const watch::WatchedRig& rig, int pulses) {
  std::string text = "Stream Type,Index,F#,HW Timestamp (ms),Host Timestamp(ms),camera,host\n";
  for (const RecordedStream& stream : rig.frames(0, pulses)) {
    for (const StampedFrame& frame : stream.frames) {
      const double ms = static_cast<double>(frame.arrival.count()) / 1e6;
      text += "Depth,0," + std::to_string(frame.counter) + "," + std::to_string(ms) + "," +
              std::to_string(ms) + "," + stream.camera + ",pc\n";
    }
  }
  return text;
}

class WatchCommand : public ProgramTest {
 protected:
  std::string path_of(const std::string& name) const { return (folder() / name).string(); }

  static std::vector<json> events(const ProgramResult& result) {
    std::vector<json> events;
    std::istringstream lines(result.out);
    for (std::string line; std::getline(lines, line);) events.push_back(json::parse(line));
    return events;
  }

  std::string slipping() {
    const watch::WatchedRig rig{.later_ms = [](std::size_t camera, int pulse) {
      return camera == 1 && pulse >= 300 ? 9.0 : 0.0;
    }};
    return file("rig.csv", csv_of(rig, 600));
  }
};

TEST_F(WatchCommand, ARigInOrderHasNoEventAndStatusZero) {
  const std::string rig = file("rig.csv", csv_of({}, 600));
  const ProgramResult result = run({"watch", rig, "--format", "json", "--for-s", "0.2"});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, IsEmpty());
  EXPECT_THAT(result.err, IsEmpty());
}

TEST_F(WatchCommand, ASlipIsALineOfJsonAndStatusThree) {
  const ProgramResult result =
      run({"watch", slipping(), "--format", "json", "--until-alarm", "--on-event",
           "echo \"$SIMBENCH_EVENT_KIND of $SIMBENCH_EVENT_SUBJECT\" > " + path_of("heard")});
  EXPECT_EQ(result.status, 3) << result.err;
  const std::vector<json> found = events(result);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0]["event"], "slipped");
  EXPECT_EQ(found[0]["subject"], "camera c1");
  EXPECT_EQ(found[0]["alarm"], true);
  EXPECT_GT(found[0]["at_s"], 20.0);
  EXPECT_LT(found[0]["at_s"], 22.0);
  EXPECT_EQ(content(path_of("heard")), "slipped of camera c1\n");
}

TEST_F(WatchCommand, AClockThatStepsIsNamedByItsHost) {
  std::string log = "time_s,offset_us\n";
  for (int i = 0; i < 60; ++i) {
    log +=
        std::to_string(i) + "," + std::to_string((i >= 40 ? 500 : 0) + watch::chance(0, i)) + "\n";
  }
  const ProgramResult result = run({"watch", "--clock-log", "hostA=" + file("clock.csv", log),
                                    "--limit-ms", "0.1", "--format", "json", "--for-s", "0.2"});
  EXPECT_EQ(result.status, 3) << result.err;
  std::vector<std::string> kinds;
  for (const json& event : events(result)) {
    kinds.push_back(event["event"]);
    EXPECT_EQ(event["subject"], "clock of hostA");
  }
  EXPECT_THAT(kinds, ElementsAre("clock_off", "clock_step"));
}

TEST_F(WatchCommand, WhatACommandPrintsIsWatched) {
  const std::string asks =
      "echo time_s,offset_ms; for i in 0 1 2 3 4 5 6 7 8 9 10; do echo $i,7; done; sleep 10";
  const ProgramResult result = run({"watch", "--clock-command", "hostB=" + asks, "--limit-ms", "5",
                                    "--format", "json", "--until-alarm", "--for-s", "60"});
  EXPECT_EQ(result.status, 3) << result.err;
  ASSERT_EQ(events(result).size(), 1u);
  EXPECT_EQ(events(result)[0]["event"], "clock_off");
  EXPECT_EQ(events(result)[0]["subject"], "clock of hostB");
}

TEST_F(WatchCommand, AFileThatIsNotThereIsAnAlarm) {
  const ProgramResult result =
      run({"watch", path_of("none.csv"), "--format", "json", "--until-alarm"});
  EXPECT_EQ(result.status, 3) << result.err;
  EXPECT_THAT(result.out, HasSubstr("\"gone\""));
}

TEST_F(WatchCommand, NothingToWatchIsRefused) {
  const ProgramResult result = run({"watch"});
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("found nothing to watch"));
}

}  // namespace
}  // namespace simbench
