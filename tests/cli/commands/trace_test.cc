// `simbench trace` through the real program: what is in a trace.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "tests/cli/trace_program.h"
#include "tests/nonempty.h"

namespace simbench {
namespace {

using Json = nlohmann::ordered_json;
using testing::ElementsAre;

TEST_F(TraceCommand, IsValidWhateverHappens) {
  for (const char* scenario :
       {"18cam_6host_45fps", "18cam_6host_45fps_frame_drops_10pct", "18cam_1host_pcie",
        "18cam_6host_45fps_loss_and_reordering", "18cam_6host_45fps_clock_step_during_capture",
        "18cam_6host_90fps_full_slave", "9cam_3host_30fps_azure_kinect",
        "18cam_6host_45fps_unequal_delays", "18cam_6host_45fps_staggered_start"}) {
    const Json json = valid_trace(scenario);
    EXPECT_FALSE(slices_on(json, " exposure").empty()) << scenario;
    EXPECT_EQ(json["otherData"]["scenario"], scenario);
  }
}

// No jitter and equal exposures: every length and instant is known.
TEST_F(TraceCommand, SlicesAreWhereTheScenarioPutsThem) {
  const Json json =
      valid_trace(file("exact.json", R"({"name": "exact", "summary": "Nothing is random.",
                             "base": "6cam_2host_30fps",
                             "cameras": {"exposure_ms": 4, "exposure_host_periods": 0},
                             "usb": {"delivery_jitter_transfers": 0,
                                     "kernel_copy_exponential_ms": 0.0},
                             "network": {"latency_exponential_ms": 0, "spike_probability": 0}})"));
  std::map<std::int64_t, double> pulses;
  for (const Json& pulse : slices_on(json, "pulses")) {
    pulses[pulse["args"]["pulse"]] = pulse["ts"];
  }
  ASSERT_GT(pulses.size(), 30U);
  const std::vector<Json> exposures = slices_on(json, " exposure");
  EXPECT_EQ(exposures.size(), 6 * pulses.size());
  for (const Json& exposure : exposures) {
    EXPECT_EQ(exposure["dur"], 4000.0);
    EXPECT_EQ(exposure["ts"], pulses.at(exposure["args"]["pulse"]));
  }
  // 848 x 480 pixels of two bytes at 350 MB/s, after 8 ms in the camera.
  const double transfer_us = 848 * 480 * 2 / 350.0;
  for (const Json& transfer : nonempty(slices_on(json, " usb"))) {
    EXPECT_NEAR(transfer["dur"].get<double>(), transfer_us, 1e-3);
    EXPECT_NEAR(transfer["ts"].get<double>(), pulses.at(transfer["args"]["pulse"]) + 12'000, 2e-3);
  }
  for (const Json& stack : nonempty(slices_on(json, " host stack"))) {
    EXPECT_EQ(stack["dur"], 0.001);
  }
  for (const Json& message : nonempty(events_of(json, "X", "message"))) {
    EXPECT_EQ(message["args"]["latency_us"], 100.0);
  }
}

TEST_F(TraceCommand, EveryArrowOfAnEvaluatedFrameEndsInASet) {
  const Json json = valid_trace("18cam_6host_45fps_lan");
  const std::map<std::int64_t, std::string> names = track_names(json);
  std::map<std::string, int> ends;
  for (const Json& end : events_of(json, "f", "frame")) {
    const std::string& name = names.at(end["tid"]);
    ++ends[name.starts_with("gathering") ? "gathering" : name.substr(name.find(' '))];
  }
  // Thirty pulses are evaluated; what comes before them is warm-up, which is not gathered.
  EXPECT_EQ(ends["gathering"], 30 * 18);
  EXPECT_EQ(ends.size(), 2U);
  EXPECT_GT(ends[" host stack"], 0);
  EXPECT_EQ(events_of(json, "X", "set").size(), 30U);
  for (const Json& set : events_of(json, "X", "set")) EXPECT_EQ(set["args"]["frames"], 18);
}

TEST_F(TraceCommand, HostsAreProcessesAndTheirClocksCounters) {
  const Json json = valid_trace("6cam_2host_30fps");
  std::vector<std::string> processes;
  for (const Json& event : events_of(json, "M")) {
    if (event["name"] == "process_name") processes.push_back(event["args"]["name"]);
  }
  EXPECT_THAT(processes, ElementsAre("trigger", "host0 (master)", "host1"));
  std::set<std::int64_t> counted;
  double largest = 0;
  for (const Json& counter : events_of(json, "C")) {
    counted.insert(counter["pid"].get<std::int64_t>());
    largest = std::max(largest, std::abs(counter["args"]["us"].get<double>()));
  }
  EXPECT_THAT(counted, ElementsAre(2, 3));
  EXPECT_GT(largest, 1000) << "before synchronisation";
  const auto steps = events_of(json, "i", "clock");
  EXPECT_FALSE(steps.empty()) << "the algorithm sets the slave's clock";
  EXPECT_FALSE(events_of(json, "s", "message").empty());
}

TEST_F(TraceCommand, SessionsAreSlicesOfTheirSlavesInTurn) {
  const Json json = valid_trace("18cam_6host_45fps", {"--pipeline", "yoon2021_both"});
  const std::vector<Json> sessions = slices_on(json, "session");
  ASSERT_EQ(sessions.size(), 5U);
  double free_at_us = 0;
  for (std::size_t i = 0; i < sessions.size(); ++i) {
    const Json& session = sessions[i];
    EXPECT_EQ(session["pid"], 3 + i) << "a slave's process";
    EXPECT_GE(session["ts"].get<double>(), free_at_us) << "one after the other";
    free_at_us = session["ts"].get<double>() + session["dur"].get<double>();
    const Json& delays = session["args"];
    EXPECT_EQ(delays["passes"], 1);
    const auto ms = [&delays](const char* name) { return delays[name].get<double>(); };
    EXPECT_NEAR(ms("t_d_ms"), ms("t_l_ms") + ms("t_t_ms"), 2e-6);
    EXPECT_NEAR(ms("t_t_ms"), (ms("get_ms") + ms("set_ms")) / 2, 2e-6);
    // 100 calls of each kind, 100 stamps and one set more make up nearly all of it.
    const double most_us = 1e3 * (100 * (ms("get_ms") + ms("set_ms")) + 100 * ms("t_l_ms"));
    EXPECT_GT(session["dur"].get<double>(), most_us);
    EXPECT_LT(session["dur"].get<double>(), 1.2 * most_us);
  }
  EXPECT_TRUE(
      slices_on(valid_trace("18cam_6host_45fps", {"--pipeline", "oracle"}), "session").empty());
}

TEST_F(TraceCommand, DroppedFramesAreInstants) {
  const Json json = valid_trace("18cam_6host_45fps_frame_drops_10pct");
  std::size_t lost = 0;
  for (const Json& instant : nonempty(events_of(json, "i", "frame"))) {
    EXPECT_EQ(instant["name"], "lost in camera");
    ++lost;
  }
  const std::size_t exposed = slices_on(json, " exposure").size();
  EXPECT_EQ(slices_on(json, " usb").size(), exposed - lost);
  EXPECT_NEAR(static_cast<double>(lost), 0.1 * static_cast<double>(exposed), 40);
}

TEST_F(TraceCommand, OfflineStampsAndRelativeOnesAreTracedToo) {
  for (const char* pipeline : {"genlock", "free_running", "ntp_w32time"}) {
    const Json json = valid_trace("18cam_6host_45fps", {"--pipeline", pipeline});
    EXPECT_EQ(json["otherData"]["pipeline"], pipeline);
    std::size_t stamped = 0;
    for (const Json& stack : slices_on(json, " host stack")) {
      if (stack["args"].contains("stamp_error_us")) ++stamped;
    }
    EXPECT_EQ(stamped, 30U * 18U) << pipeline;
  }
}

TEST_F(TraceCommand, AWorldThatBeginsHoursBeforeZeroIsShifted) {
  const Json json = valid_trace("18cam_6host_45fps", {"--pipeline", "ntp_w32time"});
  EXPECT_EQ(json["otherData"]["ts_0_is_true_time_us"], -20 * 3600e6);
}

}  // namespace
}  // namespace simbench
