// `simbench trace` through the real program.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/cli/program.h"
#include "tests/reports/trace_format.h"

namespace simbench {
namespace {

using Json = nlohmann::ordered_json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using testing::StartsWith;

std::vector<Json> events_of(const Json& trace, const std::string& phase,
                            const std::string& category = "") {
  std::vector<Json> found;
  for (const Json& event : trace["traceEvents"]) {
    if (event["ph"] != phase) continue;
    if (category.empty() || event.value("cat", "") == category) found.push_back(event);
  }
  return found;
}

std::map<std::int64_t, std::string> track_names(const Json& trace) {
  std::map<std::int64_t, std::string> names;
  for (const Json& event : events_of(trace, "M")) {
    if (event["name"] == "thread_name") names[event["tid"]] = event["args"]["name"];
  }
  return names;
}

// Of the slices on tracks whose name ends like this.
std::vector<Json> slices_on(const Json& trace, const std::string& ending) {
  const std::map<std::int64_t, std::string> names = track_names(trace);
  std::vector<Json> found;
  for (const Json& event : events_of(trace, "X")) {
    if (names.at(event["tid"]).ends_with(ending)) found.push_back(event);
  }
  return found;
}

class TraceCommand : public ProgramTest {
 protected:
  // `simbench trace` of a second or so of a scenario.
  ProgramResult trace(const std::string& scenario, std::vector<std::string> more = {}) {
    std::vector<std::string> arguments = {"trace",
                                          "--scenario",
                                          scenario,
                                          "--set",
                                          "/timeline/frames=30",
                                          "--set",
                                          "/timeline/warm_up_ms=300"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
  Json valid_trace(const std::string& scenario, std::vector<std::string> more = {}) {
    more.insert(more.end(), {"-o", "trace.json"});
    const ProgramResult result = trace(scenario, std::move(more));
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(result.out, "");
    Json json = Json::parse(content("trace.json"));
    EXPECT_THAT(TraceFormat::violations(json), IsEmpty()) << scenario;
    return json;
  }
};

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
  for (const Json& transfer : slices_on(json, " usb")) {
    EXPECT_NEAR(transfer["dur"].get<double>(), transfer_us, 1e-3);
    EXPECT_NEAR(transfer["ts"].get<double>(), pulses.at(transfer["args"]["pulse"]) + 12'000, 2e-3);
  }
  for (const Json& stack : slices_on(json, " host stack")) EXPECT_EQ(stack["dur"], 0.001);
  for (const Json& sent : events_of(json, "X", "message")) {
    const bool on_its_way = sent["name"].get<std::string>().starts_with("sent");
    EXPECT_EQ(sent["dur"], on_its_way ? 100.0 : 10.0);
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

TEST_F(TraceCommand, DroppedFramesAreInstants) {
  const Json json = valid_trace("18cam_6host_45fps_frame_drops_10pct");
  std::size_t lost = 0;
  for (const Json& instant : events_of(json, "i", "frame")) {
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

TEST_F(TraceCommand, TheSameBytesTwiceAndOnStandardOutput) {
  const ProgramResult first = trace("6cam_2host_30fps", {"--seed", "7"});
  ASSERT_EQ(first.status, 0) << first.err;
  EXPECT_EQ(trace("6cam_2host_30fps", {"--seed", "7", "-o", "-"}).out, first.out);
  EXPECT_NE(trace("6cam_2host_30fps", {"--seed", "8"}).out, first.out);
  trace("6cam_2host_30fps", {"--seed", "7", "-o", "a.json"});
  EXPECT_TRUE(content("a.json") == first.out);
}

TEST_F(TraceCommand, ItsSizeIsBoundedAndTheCutIsNoted) {
  const std::size_t all =
      valid_trace("6cam_2host_30fps", {"--max-events", "1000000"})["otherData"]["events"];
  for (const std::size_t limit : {std::size_t{1}, std::size_t{10}, all / 5, all / 2, all - 1}) {
    const ProgramResult result =
        trace("6cam_2host_30fps", {"--max-events", std::to_string(limit), "-o", "cut.json"});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_THAT(result.err, HasSubstr(fmt::format("--max-events {}", limit)));
    const Json json = Json::parse(content("cut.json"));
    EXPECT_THAT(TraceFormat::violations(json), IsEmpty()) << limit;
    EXPECT_LE(json["otherData"]["events"], limit);
    // Clocks that do not move are counted and not shown.
    EXPECT_GE(2 * json["otherData"]["events"].get<std::size_t>() + 10, limit);
    ASSERT_THAT(json["otherData"]["left_out"], SizeIs(1));
    EXPECT_THAT(result.err, HasSubstr(json["otherData"]["left_out"][0].get<std::string>()));
  }
}

TEST_F(TraceCommand, AWindowHasWhatBeginsInIt) {
  const Json all = valid_trace("6cam_2host_30fps");
  const std::vector<Json> pulses = slices_on(all, "pulses");
  const double from_us = pulses.at(10)["ts"];
  const double to_us = pulses.at(15)["ts"];
  const Json window =
      valid_trace("6cam_2host_30fps", {"--from-ms", fmt::format("{:.6f}", from_us * 1e-3),
                                       "--to-ms", fmt::format("{:.6f}", to_us * 1e-3)});
  EXPECT_THAT(slices_on(window, "pulses"), SizeIs(5));
  EXPECT_THAT(slices_on(window, " exposure"), SizeIs(5 * 6));
  EXPECT_THAT(slices_on(window, "gathering"), SizeIs(5)) << "a set belongs to its first frame";
  EXPECT_THAT(events_of(window, "X", "message"), IsEmpty());
  EXPECT_THAT(window["otherData"]["left_out"][0].get<std::string>(), HasSubstr("outside"));
}

TEST_F(TraceCommand, CsvHasOneTimeThatGoesUp) {
  const ProgramResult result = trace("6cam_2host_30fps", {"--format", "csv"});
  ASSERT_EQ(result.status, 0) << result.err;
  std::istringstream lines(result.out);
  std::string line;
  std::getline(lines, line);
  EXPECT_THAT(line, StartsWith("time_s,trigger/pulse,host1/clock_error_us,host1/clock_step_us,"
                               "camera0/latency_ms,camera0/stamp_error_us,"));
  EXPECT_THAT(line, HasSubstr("gathering/stamps_range_us,gathering/frames"));
  const auto columns = std::count(line.begin(), line.end(), ',');
  double last = -1e9;
  std::size_t rows = 0;
  while (std::getline(lines, line)) {
    EXPECT_EQ(std::count(line.begin(), line.end(), ','), columns) << line;
    const double time = std::stod(line);
    EXPECT_GT(time, last) << line;
    last = time;
    ++rows;
  }
  EXPECT_GT(rows, 200U);
}

TEST_F(TraceCommand, BadInputIsNamedAndNothingIsWritten) {
  const auto refuses = [this](std::vector<std::string> more, const std::string& part) {
    const ProgramResult result = trace("6cam_2host_30fps", std::move(more));
    EXPECT_EQ(result.status, 2) << part;
    EXPECT_THAT(result.err, HasSubstr(part));
    EXPECT_EQ(result.out, "");
    EXPECT_THAT(names_in(), IsEmpty());
  };
  refuses({"--pipeline", "yoon2022", "-o", "t.json"}, "yoon2022");
  refuses({"--seed", "-1", "-o", "t.json"}, "found '-1'");
  refuses({"--seed", "4294967296"}, "allowed: a whole number from 0 to 4294967295");
  refuses({"--max-events", "0"}, "--max-events");
  refuses({"--from-ms", "5", "--to-ms", "5"}, "--to-ms: found 5, allowed: more than --from-ms, 5");
  refuses({"--format", "svg"}, "--format");
  refuses({"-o", "no_such/t.json"}, "there is no folder no_such");
  refuses({"-o", "."}, "is a folder");
  const ProgramResult unknown = run({"trace", "--scenario", "no_such", "-o", "t.json"});
  EXPECT_EQ(unknown.status, 2);
  EXPECT_THAT(unknown.err, HasSubstr("no_such"));
}

TEST_F(TraceCommand, AFullDiskLeavesTheFileBefore) {
  file("trace.json", "the one before");
  const ProgramResult result = run({"trace", "--scenario", "6cam_2host_30fps", "--set",
                                    "/timeline/frames=30", "-o", "trace.json"},
                                   {.largest_file = std::size_t{8192}});
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("trace.json"));
  EXPECT_THAT(names_in(), ElementsAre("trace.json"));
  EXPECT_EQ(content("trace.json"), "the one before");
}

}  // namespace
}  // namespace simbench
