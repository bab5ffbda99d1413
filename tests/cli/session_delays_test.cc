// The delays of sessions of Algorithms 1 and 2 through the real program: in a world in which every
// number is known, in results, in the archive, in a recording and its replay.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "tests/cli/program.h"

namespace simbench {
namespace {

using Json = nlohmann::ordered_json;
using testing::HasSubstr;
using testing::Not;

// A get takes 0.5 ms, a set 4, a send 3; a message is under way for 0.1 and read 0.02 ms later.
constexpr double kGet = 0.5;
constexpr double kSet = 4;
constexpr double kSend = 3;
constexpr double kWay = 0.12;
// Readings are in steps of 100 ns, oscillators differ by some ppm.
constexpr double kTolerance = 1e-3;

class DelaysOfSessions : public ProgramTest {
 protected:
  std::string exact_world() const {
    return file("exact.json", R"({
      "name": "exact", "summary": "Nothing of the sessions is random.", "base": "6cam_2host_30fps",
      "timeline": {"frames": 60},
      "hosts": {
        "count": 3,
        "clock": {"resolution_ms": 0.0001, "read_cost_ms": 0.5, "set_cost_ms": 4,
                  "set_cost_session_log_sigma": 0, "set_cost_call_log_sigma": 0},
        "send_cost_ms": 3, "send_cost_exponential_ms": 0, "send_cost_session_exponential_ms": 0,
        "load_log_sigma": 0, "receive_wake_up_ms": 0.02},
      "network": {"latency_fixed_ms": 0.1, "latency_exponential_ms": 0, "spike_probability": 0},
      "cameras": {"cameras_per_host": 2}})");
  }
  // The row of yoon2021_both.
  Json row_of(const std::string& estimate, const std::string& pipeline = "yoon2021_both") const {
    const ProgramResult result =
        run({"run", "--scenario", exact_world(), "--seeds", "2", "--pipelines", pipeline, "--set",
             "/algorithms/yoon2021/latency_estimate=" + estimate, "--format", "json"});
    EXPECT_EQ(result.status, 0) << result.err;
    return Json::parse(result.out)["rows"][0];
  }
  static double median(const Json& row, const char* metric) {
    return row[metric]["median"].get<double>();
  }
};

TEST_F(DelaysOfSessions, TheLiteralEstimateIsTheSendersOccupancy) {
  const Json row = row_of("literal");
  EXPECT_NEAR(median(row, "t_l_ms"), kGet + kSend, kTolerance) << "reading and sending a stamp";
  EXPECT_NEAR(median(row, "t_t_ms"), (kGet + kSet) / 2, kTolerance);
  EXPECT_NEAR(median(row, "t_d_ms"), kGet + kSend + (kGet + kSet) / 2, kTolerance);
  EXPECT_NEAR(median(row, "get_time_ms"), kGet, kTolerance);
  EXPECT_NEAR(median(row, "set_time_ms"), kSet, kTolerance);
  // T_m is read at the begin of its get, which is therefore part of the first message.
  EXPECT_NEAR(median(row, "message_time_ms"), kSend + kWay + kGet / 2, kTolerance);
  EXPECT_EQ(median(row, "session_passes"), 1);
}

TEST_F(DelaysOfSessions, TheIntendedEstimateIsTheDurationOfAMessage) {
  const Json row = row_of("intended");
  EXPECT_NEAR(median(row, "t_l_ms"), kSend + kWay + kGet / 2, kTolerance);
  EXPECT_NEAR(median(row, "message_time_ms"), kSend + kWay + kGet / 2, kTolerance);
}

TEST_F(DelaysOfSessions, ARowAddsWhatItSays) {
  EXPECT_NEAR(median(row_of("literal", "yoon2021_network"), "t_d_ms"), kGet + kSend, kTolerance);
  EXPECT_NEAR(median(row_of("literal", "yoon2021_time"), "t_d_ms"), (kGet + kSet) / 2, kTolerance);
  EXPECT_EQ(median(row_of("literal", "yoon2021_neither"), "t_d_ms"), 0);
  EXPECT_TRUE(row_of("literal", "oracle")["t_l_ms"]["median"].is_null());
}

// t_l 3.5 ms against t_t 2.25; two messages of 3.37 ms against calls of 4.5. With sets of 9 ms
// t_t is 4.75 and the calls take 9.5.
TEST_F(DelaysOfSessions, TheClaimComparesThem) {
  for (const auto& [set_cost, holds] : {std::pair("4", 1), std::pair("9", 0)}) {
    const ProgramResult result =
        run({"run", "--scenario", exact_world(), "--seeds", "2", "--pipelines", "yoon2021_both",
             "--set", std::string("/hosts/clock/set_cost_ms=") + set_cost, "--format", "json"});
    ASSERT_EQ(result.status, 0) << result.err;
    int found = 0;
    const Json claims = Json::parse(result.out)["claims"];
    for (const Json& claim : claims) {
      if (!claim["id"].get<std::string>().starts_with("C11")) continue;
      ++found;
      EXPECT_EQ(claim["holds_fraction"], holds) << claim;
      EXPECT_EQ(claim["decided_seeds"], 2) << claim;
    }
    EXPECT_EQ(found, 2);
  }
}

TEST_F(DelaysOfSessions, AreInTheTableAndTheArchive) {
  const ProgramResult result = run({"run", "--scenario", exact_world(), "--seeds", "2",
                                    "--pipelines", "yoon2021_both,oracle", "--verbose", "-o", "a"});
  ASSERT_EQ(result.status, 0) << result.err;
  const std::size_t begin = result.out.find("Delays of the sessions of Algorithms 1 and 2");
  ASSERT_NE(begin, std::string::npos);
  const std::string block = result.out.substr(begin, result.out.find("\n\n", begin + 60) - begin);
  EXPECT_THAT(block, testing::ContainsRegex("yoon2021_both +3.50 ms .* 2.25 ms .* 5.75 ms "));
  EXPECT_THAT(block, Not(HasSubstr("oracle")));
  EXPECT_THAT(content("a/hosts.csv"), HasSubstr("\nyoon2021_both,1,0,0,1,,,,,,,\"changed"));
  EXPECT_THAT(content("a/hosts.csv"),
              testing::ContainsRegex("yoon2021_both,1,2,[^,]+,1,3\\.[45][^,]*,2\\.2[^,]*,5\\.7"));
}

TEST_F(DelaysOfSessions, ARecordingHasThemAndItsReplayToo) {
  const std::string world = exact_world();
  ASSERT_EQ(
      run({"record", "--scenario", world, "--pipelines", "yoon2021_both", "-o", "rec"}).status, 0);
  const std::string events = content("rec/yoon2021_both/1/events.csv");
  for (const char* slave : {"1", "2"}) {
    EXPECT_THAT(events, testing::ContainsRegex(std::string("\n[0-9]+,delays,") + slave + ",1,"));
  }
  const ProgramResult replayed = run({"replay", "rec", "--json"});
  const ProgramResult ran = run({"run", "--scenario", world, "--seeds", "1", "--pipelines",
                                 "yoon2021_both", "--format", "json"});
  ASSERT_EQ(replayed.status, 0) << replayed.err;
  const Json row = Json::parse(replayed.out)["rows"][0];
  const Json expected = Json::parse(ran.out)["rows"][0];
  for (const char* metric : {"t_l_ms", "t_t_ms", "t_d_ms", "session_passes", "get_time_ms",
                             "set_time_ms", "message_time_ms"}) {
    EXPECT_FALSE(expected[metric]["median"].is_null()) << metric;
    EXPECT_EQ(row[metric], expected[metric]) << metric;
  }
}

// As of a simbench that did not record them.
TEST_F(DelaysOfSessions, ARecordingWithoutThemIsReplayed) {
  ASSERT_EQ(
      run({"record", "--scenario", exact_world(), "--pipelines", "yoon2021_both", "-o", "rec"})
          .status,
      0);
  // A line in its place keeps the order of the others.
  std::string events = content("rec/yoon2021_both/1/events.csv");
  for (std::size_t at; (at = events.find(",delays,")) != std::string::npos;) {
    events.replace(at, events.find('\n', at) - at, ",exchange,1,0,,,,");
  }
  file("rec/yoon2021_both/1/events.csv", events);
  const ProgramResult replayed = run({"replay", "rec", "--json"});
  ASSERT_EQ(replayed.status, 0) << replayed.err;
  EXPECT_TRUE(Json::parse(replayed.out)["rows"][0]["t_l_ms"]["median"].is_null());
  EXPECT_FALSE(Json::parse(replayed.out)["rows"][0]["amd_ms"]["median"].is_null());
  EXPECT_THAT(replayed.out, HasSubstr("a recording with the delays of the sessions"));
}

// Bad input: a line that names a host that the rig does not have, and one that was cut.
TEST_F(DelaysOfSessions, DamagedLinesAreRefused) {
  ASSERT_EQ(
      run({"record", "--scenario", exact_world(), "--pipelines", "yoon2021_both", "-o", "rec"})
          .status,
      0);
  const std::string path = "rec/yoon2021_both/1/events.csv";
  const std::string good = content(path);
  const std::size_t at = good.find(",delays,1,1,");
  ASSERT_NE(at, std::string::npos);
  file(path, std::string(good).replace(at, 12, ",delays,7,1,"));
  EXPECT_THAT(run({"replay", "rec"}).err, HasSubstr("slave: found 7, allowed: 0 to 2"));
  const std::size_t end = good.find('\n', at);
  file(path, std::string(good).replace(end - 3, 3, ""));
  EXPECT_EQ(run({"replay", "rec"}).status, 0) << "three digits less are another number";
  const std::size_t comma = good.rfind(',', end);
  file(path, std::string(good).erase(comma, end - comma));
  EXPECT_THAT(run({"replay", "rec"}).err, HasSubstr("(set_ns): missing"));
}

}  // namespace
}  // namespace simbench
