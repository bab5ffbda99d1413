// Traces made by hand, so that every event is known.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "reports/text/json_node.h"
#include "reports/timeline/trace.h"
#include "reports/timeline/trace_events.h"
#include "tests/reports/timeline/trace_format.h"

namespace simbench::reports {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TrueTime at_us(double us) { return TrueTime(from_ms(us * 1e-3)); }

// One pulse at 1 ms, a frame of each of two cameras on two hosts, gathered.
Trace two_frames() {
  Trace trace;
  trace.scenario = "by \"hand\"";
  trace.hosts = 2;
  trace.cameras = {{0}, {1}};
  trace.pulses = {{.pulse = 7, .at = at_us(1000)}};
  for (std::uint32_t camera = 0; camera < 2; ++camera) {
    TraceFrame frame;
    frame.way = {.camera = camera,
                 .host = camera,
                 .counter = 3 + camera,
                 .pulse = 7,
                 .exposure_start = at_us(1000.5),
                 .exposure_end = at_us(5000.5),
                 .offered = at_us(9000),
                 .transferred = at_us(11000),
                 .copied = at_us(11200),
                 .delivered = at_us(11900 + 100 * camera)};
    frame.set = 0;
    frame.leads_set = camera == 0;
    trace.frames.push_back(frame);
  }
  trace.sets = {{.frames = {0, 1},
                 .members = 2,
                 .complete = true,
                 .range = Nanoseconds(1234),
                 .begin = at_us(11900),
                 .end = at_us(12000.001)}};
  return trace;
}

Json chrome(const Trace& trace) {
  std::ostringstream out;
  write_chrome_trace(trace, out);
  Json json = Json::parse(out.str());
  EXPECT_THAT(TraceFormat::violations(json), IsEmpty());
  return json;
}

// "track: name ts dur", of slices.
std::vector<std::string> slices(const Json& trace) {
  std::map<std::int64_t, std::string> names;
  std::vector<std::string> found;
  for (const Json& event : trace["traceEvents"]) {
    if (event["name"] == "thread_name") names[event["tid"]] = event["args"]["name"];
    if (event["ph"] != "X") continue;
    found.push_back(fmt::format("{}: {} {} {}", names[event["tid"]],
                                event["name"].get<std::string>(), event["ts"].dump(),
                                event["dur"].dump()));
  }
  return found;
}

std::vector<Json> of_phase(const Json& trace, const std::string& phases) {
  std::vector<Json> found;
  for (const Json& event : trace["traceEvents"]) {
    if (phases.find(event["ph"].get<std::string>()) != std::string::npos) found.push_back(event);
  }
  return found;
}

// "phase ts" of an arrow's points.
std::vector<std::string> arrow(const Json& trace, const std::string& kind, int id) {
  std::vector<std::string> found;
  for (const Json& event : of_phase(trace, "stf")) {
    if (event["cat"] != kind || event["id"] != id) continue;
    found.push_back(event["ph"].get<std::string>() + " " + event["ts"].dump());
  }
  return found;
}

TEST(ChromeTrace, AFramesWayIsSlicesOnTracksOfItsHost) {
  const Json trace = chrome(two_frames());
  EXPECT_THAT(slices(trace),
              ElementsAre("pulses: pulse 7 1000.0 100.0",               //
                          "camera0 exposure: frame 3 1000.5 4000.0",    //
                          "camera1 exposure: frame 4 1000.5 4000.0",    //
                          "camera0 usb: frame 3 9000.0 2000.0",         //
                          "camera1 usb: frame 4 9000.0 2000.0",         //
                          "camera0 host stack: frame 3 11200.0 700.0",  //
                          "camera1 host stack: frame 4 11200.0 800.0",  //
                          "gathering: set 11900.0 100.001"));
  std::vector<std::string> processes;
  for (const Json& event : trace["traceEvents"]) {
    if (event["name"] == "process_name") processes.push_back(event["args"]["name"]);
  }
  EXPECT_THAT(processes, ElementsAre("trigger", "host0 (master)", "host1"));
  EXPECT_EQ(trace["otherData"]["scenario"], "by \"hand\"");
  EXPECT_TRUE(trace["otherData"]["left_out"].empty());
}

TEST(ChromeTrace, AnArrowFollowsAFrameAsFarAsItGot) {
  Trace trace = two_frames();
  EXPECT_THAT(arrow(chrome(trace), "frame", 2),
              ElementsAre("s 1000.0", "t 1000.5", "t 11200.0", "f 12000.0"));
  trace.frames[1].set.reset();
  EXPECT_THAT(arrow(chrome(trace), "frame", 2), ElementsAre("s 1000.0", "t 1000.5", "f 11200.0"));
  trace.frames[1].way.pulse = -1;
  EXPECT_THAT(arrow(chrome(trace), "frame", 2), ElementsAre("s 1000.5", "f 11200.0"));
  trace.frames[1].way.fate = FrameFate::kLostInCamera;
  EXPECT_THAT(arrow(chrome(trace), "frame", 2), IsEmpty());
  trace.frames[1].way.pulse = 7;
  EXPECT_THAT(arrow(chrome(trace), "frame", 2), ElementsAre("s 1000.0", "f 1000.5"));
  EXPECT_EQ(of_phase(chrome(trace), "i").front()["name"], "lost in camera");
  trace.frames[1].way.fate = FrameFate::kLostOnUsb;
  const Json lost = of_phase(chrome(trace), "i").front();
  EXPECT_EQ(lost["name"], "lost on usb");
  EXPECT_EQ(lost["ts"], 9000.0);
}

// A frame that was exposed before its pulse left, and one that took no time in the stack.
TEST(ChromeTrace, OddTimesBreakNoRule) {
  Trace trace = two_frames();
  trace.frames[0].way.exposure_start = at_us(500);
  trace.frames[1].way.exposure_start = at_us(400);
  trace.frames[1].way.exposure_end = at_us(900);
  trace.frames[1].way.copied = trace.frames[1].way.delivered;
  const Json json = chrome(trace);
  EXPECT_THAT(arrow(json, "frame", 1),
              ElementsAre("s 1000.0", "t 1000.0", "t 11200.0", "f 11900.0"));
  EXPECT_THAT(arrow(json, "frame", 2), ElementsAre("s 400.0", "t 12000.0", "f 12000.0"));
}

TEST(ChromeTrace, WhatWouldOverlapGoesToAnotherTrack) {
  Trace trace = two_frames();
  trace.frames[1].way.camera = trace.frames[1].way.host = 0;
  trace.frames[1].way.exposure_start = at_us(2000);
  const std::vector<std::string> all = slices(chrome(trace));
  EXPECT_THAT(all, testing::Contains("camera0 exposure: frame 3 1000.5 4000.0"));
  EXPECT_THAT(all, testing::Contains("camera0 exposure (2): frame 4 2000.0 3000.5"));
}

TEST(ChromeTrace, AConversationIsOneArrow) {
  Trace trace;
  trace.hosts = 2;
  const auto message = [](std::uint32_t from, double left_ms, double arrived_ms, bool lost) {
    return ObservedMessage{.from = from,
                           .to = 1 - from,
                           .stream = false,
                           .id = 5,
                           .bytes = 48,
                           .left = at_us(left_ms * 1e3),
                           .arrived = at_us(arrived_ms * 1e3),
                           .lost = lost};
  };
  trace.messages = {message(0, 1, 2, false),   message(1, 3, 4, false),
                    message(0, 60, 61, false),  // too late to be an answer
                    message(1, 62, 0, true),   message(1, 70, 0, true),
                    message(1, 71, 72, false)};
  const Json json = chrome(trace);
  EXPECT_THAT(arrow(json, "message", 1),
              ElementsAre("s 1000.0", "t 2000.0", "t 3000.0", "f 4000.0"));
  EXPECT_THAT(arrow(json, "message", 2), ElementsAre("s 60000.0", "t 61000.0", "f 62000.0"));
  EXPECT_THAT(arrow(json, "message", 3), IsEmpty());
  EXPECT_THAT(arrow(json, "message", 4), ElementsAre("s 71000.0", "f 72000.0"));
  EXPECT_EQ(of_phase(json, "i").size(), 2U);
  EXPECT_THAT(slices(json), testing::Contains("channel host1: sent 5 1000.0 10.0"));
  EXPECT_THAT(slices(json), testing::Contains("channel host0: received 5 2000.0 10.0"));
}

TEST(ChromeTrace, MessagesInQuickSuccessionShareATrack) {
  Trace trace;
  trace.hosts = 2;
  for (int i = 0; i < 3; ++i) {
    trace.messages.push_back({.from = 0,
                              .to = 1,
                              .id = static_cast<std::uint64_t>(i),
                              .left = at_us(100 + 2.5 * i),
                              .arrived = at_us(500 + 2.5 * i)});
  }
  EXPECT_THAT(
      slices(chrome(trace)),
      ElementsAre("channel host1: sent 0 100.0 2.5", "channel host1: sent 1 102.5 2.5",
                  "channel host1: sent 2 105.0 10.0", "channel host0: received 0 500.0 2.5",
                  "channel host0: received 1 502.5 2.5", "channel host0: received 2 505.0 10.0"));
}

TEST(ChromeTrace, ClocksAreCountersWhereTheyChangeAndInstantsWhereTheyAreSet) {
  Trace trace;
  trace.hosts = 2;
  trace.clocks = {{at_us(-2000), 1, Nanoseconds(500)},
                  {at_us(-1000), 1, Nanoseconds(500)},
                  {at_us(0), 1, Nanoseconds(-1500)}};
  TraceAdjustment step;
  step.at = at_us(-500);
  step.host = 1;
  step.step = Nanoseconds(-2000);
  trace.adjustments = {step};
  const Json json = chrome(trace);
  EXPECT_EQ(json["otherData"]["ts_0_is_true_time_us"], -2000.0) << "shifted: none is negative";
  const std::vector<Json> counters = of_phase(json, "C");
  ASSERT_EQ(counters.size(), 2U);
  EXPECT_EQ(counters[0]["name"], "clock error, TE");
  EXPECT_EQ(counters[0]["ts"], 0.0);
  EXPECT_EQ(counters[0]["args"]["us"], 0.5);
  EXPECT_EQ(counters[1]["ts"], 2000.0);
  EXPECT_EQ(counters[1]["args"]["us"], -1.5);
  const std::vector<Json> instants = of_phase(json, "i");
  ASSERT_EQ(instants.size(), 1U);
  EXPECT_EQ(instants[0]["name"], "step");
  EXPECT_EQ(instants[0]["ts"], 1500.0);
  EXPECT_EQ(instants[0]["args"]["step_us"], -2.0);
}

TEST(ChromeTrace, ASessionIsASliceOfItsSlaveWithItsDelays) {
  Trace trace;
  trace.hosts = 2;
  trace.sessions = {{.at = at_us(1000),
                     .end = at_us(951000.5),
                     .begin_steady = {},
                     .last = {.slave = 1,
                              .pass = 3,
                              .t_l = Nanoseconds(3'012'345),
                              .t_t = Nanoseconds(2'250'500),
                              .t_d = Nanoseconds(5'262'845),
                              .get = Nanoseconds(1'000),
                              .set = Nanoseconds(4'500'000)}}};
  const Json json = chrome(trace);
  EXPECT_THAT(slices(json), ElementsAre("session: session 1000.0 950000.5"));
  const Json session = of_phase(json, "X").front();
  EXPECT_EQ(session["pid"], 3) << "the slave's process";
  EXPECT_EQ(session["args"], Json::parse(R"({"passes": 3, "t_l_ms": 3.012345, "t_t_ms": 2.2505,
    "t_d_ms": 5.262845, "get_ms": 0.001, "set_ms": 4.5})"));
}

TEST(ChromeTrace, AnEmptyTraceIsATrace) {
  EXPECT_TRUE(of_phase(chrome(Trace()), "XCistf").empty());
}

TEST(ChromeTrace, TheRulesAreChecked) {
  std::ostringstream out;
  write_chrome_trace(two_frames(), out);
  const Json good = Json::parse(out.str());
  const auto broken = [&](const std::string& phase, const std::string& member, const Json& value) {
    Json bad = good;
    for (Json& event : bad["traceEvents"]) {
      if (event["ph"] != phase) continue;
      event[member] = value;
      break;
    }
    return TraceFormat::violations(bad);
  };
  EXPECT_THAT(broken("s", "id", 99), testing::Not(IsEmpty()));
  EXPECT_THAT(broken("f", "ts", 1), testing::Not(IsEmpty()));
  EXPECT_THAT(broken("X", "tid", 99), testing::Not(IsEmpty()));
  EXPECT_THAT(broken("X", "ts", "soon"), testing::Not(IsEmpty()));
  EXPECT_THAT(broken("X", "ts", -1), testing::Not(IsEmpty()));
  EXPECT_THAT(broken("M", "name", "process_label"), testing::Not(IsEmpty()));
}

}  // namespace
}  // namespace simbench::reports
