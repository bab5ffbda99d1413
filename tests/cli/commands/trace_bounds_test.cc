// `simbench trace` through the real program: its bounds, formats and refusals.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "tests/cli/trace_program.h"

namespace simbench {
namespace {

using Json = nlohmann::ordered_json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using testing::StartsWith;

using TraceBounds = TraceCommand;

TEST_F(TraceBounds, TheSameBytesTwiceAndOnStandardOutput) {
  const ProgramResult first = trace("6cam_2host_30fps", {"--seed", "7"});
  ASSERT_EQ(first.status, 0) << first.err;
  EXPECT_EQ(trace("6cam_2host_30fps", {"--seed", "7", "-o", "-"}).out, first.out);
  EXPECT_NE(trace("6cam_2host_30fps", {"--seed", "8"}).out, first.out);
  trace("6cam_2host_30fps", {"--seed", "7", "-o", "a.json"});
  EXPECT_TRUE(content("a.json") == first.out);
}

TEST_F(TraceBounds, ItsSizeIsBoundedAndTheCutIsNoted) {
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

TEST_F(TraceBounds, AWindowHasWhatBeginsInIt) {
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

TEST_F(TraceBounds, CsvHasOneTimeThatGoesUp) {
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

// Each set of a rig whose clocks are read has a bound, in both formats.
TEST_F(TraceBounds, SetsHaveCertificates) {
  const std::vector<std::string> asked = {"--certify", "--pipeline", "chrony", "--set",
                                          "/timeline/frames=20"};
  std::vector<std::string> as_csv = asked;
  as_csv.insert(as_csv.end(), {"--format", "csv"});
  const ProgramResult csv = trace("18cam_6host_45fps_lan", as_csv);
  ASSERT_EQ(csv.status, 0) << csv.err;
  EXPECT_THAT(csv.out.substr(0, csv.out.find('\n')), HasSubstr(",gathering/certified_ms"));
  const ProgramResult chrome = trace("18cam_6host_45fps_lan", asked);
  ASSERT_EQ(chrome.status, 0) << chrome.err;
  EXPECT_THAT(chrome.out, HasSubstr(R"(,"certified_ms":)"));
}

TEST_F(TraceBounds, BadInputIsNamedAndNothingIsWritten) {
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

TEST_F(TraceBounds, AFullDiskLeavesTheFileBefore) {
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
