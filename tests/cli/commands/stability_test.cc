// `simbench stability` through the real program.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/cli/program.h"

namespace simbench {
namespace {

using Json = nlohmann::ordered_json;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

class StabilityCommand : public ProgramTest {
 protected:
  // A clock that is `ppb` fast, once a second.
  static std::string csv(int points, double ppb, const std::string& heading = "") {
    std::string text = heading;
    for (int i = 0; i < points; ++i) {
      text += fmt::format("{},{:.12f}\n", i, 1e-9 * ppb * i + 1e-6 * (i * 7919 % 11));
    }
    return text;
  }

  void expect_refused(const std::string& text, const std::string& message) const {
    const ProgramResult result = run({"stability", file("log.txt", text)});
    EXPECT_EQ(result.status, 2) << text;
    EXPECT_THAT(result.out, IsEmpty());
    EXPECT_THAT(result.err, AllOf(StartsWith("error: log.txt"), HasSubstr(message)));
  }
};

TEST_F(StabilityCommand, PrintsATableOfEveryFile) {
  file("a.csv", csv(100, 5, "t_s,x_s\n"));
  file("b.csv", csv(50, 0, "t_s,x_s\n"));
  const ProgramResult result = run({"stability", "a.csv", "b.csv"});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.err, IsEmpty());
  EXPECT_THAT(result.out, AllOf(StartsWith("stability of 2 measured clocks"), HasSubstr("MTIE"),
                                HasSubstr("\nb.csv\n")));
}

TEST_F(StabilityCommand, JsonIsAllThatIsOnStandardOutput) {
  file("a.csv", csv(100, 5000, "t_s,error_s\n") + "200,0\n201");
  const ProgramResult result =
      run({"stability", "a.csv", "--remove-frequency", "--format", "json"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.err, AllOf(HasSubstr("note: a.csv:103: the last line has no line end"),
                                HasSubstr("note: a.csv: 1 gap, the longest of 101 s")));
  const Json root = Json::parse(result.out);
  EXPECT_EQ(root["files"][0]["points"], 101);
  EXPECT_TRUE(root["files"][0]["frequency_offset_ppb"].is_number());
}

TEST_F(StabilityCommand, TakesUnitSeriesAndInterval) {
  file("a.csv", "t,a,b\n0,1,2\n1,1,3\n2,1,2\n3,1,3\n4,1,2\n");
  const ProgramResult result =
      run({"stability", "a.csv", "--series", "b", "--unit", "us", "--interval-s", "2", "--json"});
  ASSERT_EQ(result.status, 0) << result.err;
  const Json found = Json::parse(result.out)["files"][0];
  EXPECT_EQ(found["interval_s"], 2);
  EXPECT_EQ(found["left_out"], 2);
  EXPECT_DOUBLE_EQ(found["max_te_ms"].get<double>(), 3e-3) << "of all points";
  EXPECT_THAT(run({"stability", "a.csv", "--series", "b", "--unit", "us", "--format", "csv"}).out,
              StartsWith("file,format,quantity,tau_s,value,terms,low,high,noise,reliable\n"));
}

TEST_F(StabilityCommand, ListsTheSeriesOfAFile) {
  file(
      "two.log",
      "ptp4l[1.0]: eth0 master offset 1 s2 freq +1\nptp4l[1.1]: eth1 master offset 2 s2 freq +1\n"
      "ptp4l[2.0]: eth0 master offset 1 s2 freq +1\nptp4l[2.1]: eth1 master offset 2 s2 freq +1\n");
  const ProgramResult list = run({"stability", "two.log", "--series", "--json"});
  ASSERT_EQ(list.status, 0) << list.err;
  const Json series = Json::parse(list.out)["files"][0]["series"];
  ASSERT_EQ(series.size(), 2U);
  EXPECT_EQ(series[1]["name"], "eth1 master");
  EXPECT_EQ(series[1]["points"], 2);
  EXPECT_EQ(run({"stability", "two.log", "--series", "eth1 master"}).status, 0);
  const ProgramResult none = run({"stability", "two.log"});
  EXPECT_EQ(none.status, 2);
  EXPECT_THAT(none.err, HasSubstr("found 2 series, 'eth0 master', 'eth1 master', allowed: one"));
}

TEST_F(StabilityCommand, LeavesOutTheStartOnRequestAndSaysBoth) {
  std::string text;
  for (int i = 0; i < 60; ++i) {
    text += fmt::format("ptp4l[{}.0]: master offset {} s{} freq +1 path delay 6\n", i,
                        i < 2 ? -37'000'000'000 : i * 7919 % 101 - 50, std::min(i, 2));
  }
  file("ptp4l.log", text);
  const ProgramResult all = run({"stability", "ptp4l.log"});
  ASSERT_EQ(all.status, 0) << all.err;
  EXPECT_THAT(all.out,
              AllOf(HasSubstr("The largest time error of ptp4l.log is 37.0 s."),
                    HasSubstr("without them (--settle) the largest time error is 50.0 ns")));
  for (const char* option : {"--locked", "--settle", "--from=2"}) {
    const ProgramResult part = run({"stability", "ptp4l.log", option, "--json"});
    ASSERT_EQ(part.status, 0) << part.err;
    const Json found = Json::parse(part.out)["files"][0];
    EXPECT_EQ(found["samples"], 58) << option;
    EXPECT_NEAR(found["max_te_ms"].get<double>(), 50e-6, 1e-12) << option;
  }
}

TEST_F(StabilityCommand, BadInputIsNamed) {
  expect_refused("", "log.txt:1: the file is empty");
  expect_refused("t_s,x_s\n0,1\n", "log.txt: found a single time error, allowed: two or more");
  expect_refused("t_s,x_s\n0,1\n1,inf\n", "log.txt:3: time error: found 'inf', allowed: a number");
  expect_refused("0,1\n1,2\n", "log.txt:1: found no unit of the time errors of column '2'");
  expect_refused("GET / HTTP/1.1\n", "log.txt:1: found 'GET / HTTP/1.1', allowed: a table of time");
  expect_refused("\1\2\3\n", "log.txt:1: found '\\x01\\x02\\x03'");
  const ProgramResult none = run({"stability", "absent.csv"});
  EXPECT_EQ(none.status, 2);
  EXPECT_THAT(none.err, HasSubstr("absent.csv: cannot be read"));
  const ProgramResult unit = run({"stability", file("a.csv", csv(9, 0)), "--unit", "parsec"});
  EXPECT_EQ(unit.status, 2);
  EXPECT_THAT(unit.err, HasSubstr("--unit: found 'parsec', allowed: s, ms, us, ns, ps"));
  const ProgramResult interval = run({"stability", "a.csv", "--interval-s", "0"});
  EXPECT_EQ(interval.status, 2);
  EXPECT_THAT(interval.err, HasSubstr("--interval-s: found '0', allowed: a number from"));
}

TEST_F(StabilityCommand, AMaskThatIsNotKeptIsStatus3) {
  file("a.csv", csv(100, 5));
  const ProgramResult fails = run({"stability", "a.csv", "--mask", "prtc_a", "--json"});
  EXPECT_EQ(fails.status, 3) << fails.err;
  const Json verdict = Json::parse(fails.out)["files"][0]["verdicts"][0];
  EXPECT_EQ(verdict["mask"], "prtc_a");
  EXPECT_EQ(verdict["judgement"], "fails");
  EXPECT_EQ(verdict["limits"][0]["quantity"], "max_te_ms");
  const ProgramResult other = run({"stability", "a.csv", "--mask", "prtc"});
  EXPECT_EQ(other.status, 2);
  EXPECT_THAT(other.err, HasSubstr("--mask: found 'prtc', allowed: "));
}

TEST_F(StabilityCommand, LimitsOfOnesOwnAreJudged) {
  file("a.csv", csv(100, 5));
  const ProgramResult kept =
      run({"stability", "a.csv", "--limit", "max_te=20us,p99=20us", "--limit", "mtie@3s=1ms"});
  EXPECT_EQ(kept.status, 0) << kept.err;
  EXPECT_THAT(kept.out, HasSubstr("--limit: passes; nearest: "));
  const ProgramResult untold = run({"stability", "a.csv", "--limit", "tdev@50s=1ms"});
  EXPECT_EQ(untold.status, 0) << "nothing is beyond";
  EXPECT_THAT(untold.out, HasSubstr("cannot be judged as a whole"));
  EXPECT_EQ(run({"stability", "a.csv", "--limit", "adev@1s=1e-12"}).status, 3);
  const ProgramResult wrong = run({"stability", "a.csv", "--limit", "max_te=20"});
  EXPECT_EQ(wrong.status, 2);
  EXPECT_THAT(wrong.err, HasSubstr("--limit max_te=20: value: found '20', allowed: a time"));
}

// Beside what it prints, with the status of the limits.
TEST_F(StabilityCommand, WritesItsPage) {
  file("a.csv", csv(200, 5, "t_s,x_s\n"));
  const std::vector<std::string> command = {"stability",  "a.csv",  "--limit",
                                            "max_te=1ns", "--html", "page.html"};
  const ProgramResult result = run(command);
  EXPECT_EQ(result.status, 3) << result.err;
  EXPECT_THAT(result.err, HasSubstr("page.html written"));
  EXPECT_THAT(result.out, HasSubstr("Time error (TE)"));
  const std::string page = content("page.html");
  for (const char* part : {"<!doctype html>", ": fails: ", "\"id\":\"time_error\"",
                           "\"id\":\"stability\"", "--limit max_te=1ns"}) {
    EXPECT_NE(page.find(part), std::string::npos) << part;
  }
  EXPECT_EQ(run(command).status, 3);
  EXPECT_EQ(content("page.html"), page);
  EXPECT_EQ(run({"stability", "a.csv", "--html", "none/page.html"}).status, 2);
}

TEST_F(StabilityCommand, DrawsItsFigure) {
  file("a.csv", csv(300, 5));
  const ProgramResult result =
      run({"stability", "a.csv", "--mask", "sec", "--figure", "clock.svg"});
  EXPECT_EQ(result.status, 3);
  EXPECT_THAT(result.err, HasSubstr("clock.svg written"));
  EXPECT_THAT(content("clock.svg"), AllOf(HasSubstr("<svg"), HasSubstr("G.813 option 1 MTIE")));
  const ProgramResult png = run({"stability", "a.csv", "--figure", "clock.png"});
  EXPECT_EQ(png.status, 2);
  EXPECT_THAT(png.err, HasSubstr("--figure: found 'clock.png', allowed: "));
}

}  // namespace
}  // namespace simbench
