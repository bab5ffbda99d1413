#include "evaluation/diagnosis/clock_account.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <numbers>
#include <string>
#include <vector>

#include "tests/evaluation/diagnosis/clocked_rig.h"

namespace simbench::evaluation {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::IsSupersetOf;
using ::testing::Not;
using ::testing::SizeIs;

std::vector<std::string> kinds_of_clocks(const ClockAccount& account) {
  std::vector<std::string> kinds;
  for (const ClockFinding& finding : account.findings) kinds.push_back(finding.kind);
  return kinds;
}

std::string clock_text_of(const ClockAccount& account, const std::string& kind) {
  const auto found = std::ranges::find(account.findings, kind, &ClockFinding::kind);
  return found == account.findings.end() ? "no " + kind : found->text;
}

std::string iso_time_of(double time_s) {
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}", fmt::gmtime(static_cast<std::time_t>(time_s)));
}

// Two cameras of host A and one of host B.
std::vector<RecordedStream> clocked_hosts(const ClockErrorS& of_a, const ClockErrorS& of_b,
                                          double start_s = 0) {
  return {rig_recording({.name = "x", .start_s = start_s, .error_s = of_a}),
          rig_recording({.name = "y", .start_s = start_s, .error_s = of_a, .clock_ppm = -20}),
          rig_recording({.name = "z", .host = "B", .start_s = start_s, .error_s = of_b})};
}

std::vector<RecordedStream> clocked_host(const ClockErrorS& error_s, double start_s = 0) {
  std::vector<RecordedStream> streams = clocked_hosts(error_s, keeps_time, start_s);
  streams.pop_back();
  return streams;
}

TEST(ClockAccount, HostsInTimeHaveNoFindings) {
  const std::vector<HostLog> logs = {{"A", rig_log({})}, {"B", rig_log({})}};
  const ClockAccount account = clock_account(clocked_hosts(keeps_time, keeps_time), logs);
  EXPECT_THAT(account.findings, IsEmpty()) << testing::PrintToString(kinds_of_clocks(account));
  EXPECT_EQ(account.logs[0].placing, LogPlacing::kAsIs);
  EXPECT_THAT(account.budgets, SizeIs(2));
}

TEST(ClockAccount, NoFramesAndNoLogsAreNoError) {
  EXPECT_THAT(clock_account({}, {}).findings, IsEmpty());
  const std::vector<HostLog> logs = {{"A", rig_log({})}};
  EXPECT_THAT(kinds_of_clocks(clock_account({}, logs)), ElementsAre("log_of_no_host"));
  const std::vector<RecordedStream> empty = {{"x", "A", "Depth 0", {}}};
  EXPECT_THAT(clock_account(empty, logs).budgets, IsEmpty());
}

TEST(ClockAccount, AStepOfTheClockIsFoundInBoth) {
  const ClockErrorS step = step_at(41.2, -0.25);
  const std::vector<HostLog> logs = {{"A", rig_log({.error_s = step})}, {"B", rig_log({})}};
  const ClockAccount account = clock_account(clocked_hosts(step, keeps_time), logs);
  ASSERT_THAT(account.matches, SizeIs(1));
  EXPECT_NEAR(account.jumps[account.matches[0].jump].jump.step_ms, -250, 0.1);
  EXPECT_THAT(clock_text_of(account, "host_clock_step"),
              AllOf(HasSubstr("the clock of host A was set by -250.0 ms at 41.0 s"),
                    HasSubstr("the arrivals of cameras x, y jump by -250.")));
  EXPECT_THAT(kinds_of_clocks(account), Not(Contains("unexplained_jump")));
  EXPECT_GT(account.explanations[0].share, 0.999);
  // The step is in the clocks' part alone.
  const SpreadBudget& pair = account.budgets[1];
  EXPECT_NEAR(pair.delivery.rms_ms, 0.141, 0.02);
  EXPECT_NEAR(pair.stamp.rms_ms, 0.0141, 0.002);
  EXPECT_LT(pair.unexplained.rms_ms, 0.1);
  EXPECT_GT(pair.host_clock.share, 0.99);
}

TEST(ClockAccount, AJumpThatTheLogLacksIsNamed) {
  const std::vector<HostLog> logs = {{"A", rig_log({})}, {"B", rig_log({})}};
  const ClockAccount account = clock_account(clocked_hosts(step_at(30, 0.08), keeps_time), logs);
  EXPECT_THAT(clock_text_of(account, "unexplained_jump"),
              AllOf(HasSubstr("cameras x, y on host A jump by +80"), HasSubstr("no such step"),
                    HasSubstr("all cameras of the host at once")));
  EXPECT_THAT(kinds_of_clocks(account), Contains("clocks_do_not_explain"));
}

TEST(ClockAccount, AStepThatNoCameraShowsIsNamed) {
  const std::vector<HostLog> logs = {{"", rig_log({.error_s = step_at(30, 0.08)})}};
  const ClockAccount account = clock_account(clocked_host(keeps_time), logs);
  EXPECT_THAT(clock_text_of(account, "unseen_step"), HasSubstr("a step of +80"));
}

TEST(ClockAccount, ALogOfAnotherDayIsNamedWithBothRanges) {
  const std::vector<HostLog> logs = {{"", rig_log({.start_s = kRigDayS - 3 * 86400})}};
  const ClockAccount account = clock_account(clocked_host(keeps_time, kRigDayS), logs);
  EXPECT_THAT(clock_text_of(account, "log_of_another_day"),
              AllOf(HasSubstr("it has 2024-08-31 10:29:55 UTC to 2024-08-31 10:31:10 UTC"),
                    HasSubstr("the arrivals 2024-09-03 10:30:00 UTC to 2024-09-03 10:30:59 UTC"),
                    HasSubstr("still shown: its errors are within 0.00")));
  EXPECT_THAT(account.explanations, IsEmpty());
  EXPECT_THAT(account.budgets, SizeIs(1));
}

TEST(ClockAccount, LocalTimeIsTakenOff) {
  const ClockErrorS wave = [](double s) { return 2e-3 * std::sin(s / 3); };
  for (const double zone_h : {2.0, -7.0, 5.5, 5.75}) {
    const double start_s = kRigDayS + 3600 * zone_h;
    const std::vector<HostLog> logs = {{"", rig_log({.start_s = start_s, .error_s = wave})}};
    const ClockAccount account = clock_account(clocked_host(wave, kRigDayS), logs);
    EXPECT_EQ(account.logs[0].placing, LogPlacing::kByZone);
    EXPECT_DOUBLE_EQ(account.logs[0].shift_s, -3600 * zone_h);
    EXPECT_THAT(kinds_of_clocks(account), IsSupersetOf({"log_in_local_time", "clocks_explain"}));
  }
  const std::vector<HostLog> logs = {{"", rig_log({.start_s = kRigDayS + 7200})}};
  EXPECT_THAT(
      clock_text_of(clock_account(clocked_host(keeps_time, kRigDayS), logs), "log_in_local_time"),
      HasSubstr("clock.csv is 2 h ahead of the arrivals, as local time is: taken off"));
}

// A long log that overlaps as it is, but whose step is two hours off.
TEST(ClockAccount, StepsTellTheZoneOfALongLog) {
  const ClockErrorS step = step_at(30, 0.25);
  const ClockRigLog log{
      .start_s = kRigDayS + 7200, .from_s = -20'000, .until_s = 100, .error_s = step};
  const std::vector<HostLog> logs = {{"", rig_log(log)}};
  const ClockAccount account = clock_account(clocked_host(step, kRigDayS), logs);
  EXPECT_DOUBLE_EQ(account.logs[0].shift_s, -7200);
  EXPECT_THAT(account.matches, SizeIs(1));
}

TEST(ClockAccount, DaylightSavingInsideALogIsUndone) {
  const ClockErrorS wave = [](double s) { return 2e-3 * std::sin(s / 3); };
  for (const double by_s : {3600.0, -3600.0}) {
    ClockLog log = rig_log({.start_s = kRigDayS + 7200, .error_s = wave});
    std::size_t moved = 0;
    for (ClockLogPoint& point : log.points) {
      if (to_seconds(point.time) < kRigDayS + 7200 + 30) continue;
      if (moved++ == 0 && by_s < 0) {
        log.segments.push_back(static_cast<std::size_t>(&point - log.points.data()));
      }
      point.time += Microseconds(std::llround(by_s * 1e6));
    }
    const std::vector<HostLog> logs = {{"", log}};
    const ClockAccount account = clock_account(clocked_host(wave, kRigDayS), logs);
    ASSERT_TRUE(account.logs[0].daylight_saving);
    EXPECT_DOUBLE_EQ(account.logs[0].daylight_saving->by_s, by_s);
    EXPECT_DOUBLE_EQ(account.logs[0].shift_s, -7200);
    EXPECT_THAT(clock_text_of(account, "daylight_saving"),
                AllOf(HasSubstr(by_s > 0 ? "forth" : "back"), HasSubstr("2024-09-03 12:30:29")));
    EXPECT_THAT(kinds_of_clocks(account), Contains("clocks_explain"));
  }
}

TEST(ClockAccount, HostsWithoutALogAndLogsWithoutAHostAreNamed) {
  const std::vector<HostLog> logs = {{"", rig_log({.file = "logs/B.csv"})},
                                     {"C", rig_log({.file = "c.csv"})},
                                     {"", rig_log({.file = "some.csv"})}};
  const ClockAccount account = clock_account(clocked_hosts(keeps_time, keeps_time), logs);
  EXPECT_EQ(account.logs[0].host, "B");
  EXPECT_FALSE(account.logs[1].has_host);
  EXPECT_FALSE(account.logs[2].has_host);
  EXPECT_THAT(clock_text_of(account, "host_without_log"),
              HasSubstr("no log is of host A (cameras x, y)"));
  std::string texts;
  for (const ClockFinding& finding : account.findings) texts += finding.text + "\n";
  EXPECT_THAT(texts, HasSubstr("c.csv is of host C, which has no camera here (hosts: A, B)"));
  EXPECT_THAT(texts, HasSubstr("some.csv names no host, and the recording has several (A, B)"));
  for (const SpreadBudget& budget : account.budgets) {
    EXPECT_EQ(std::isnan(budget.host_clock.rms_ms), budget.host != budget.host_against);
  }
}

TEST(ClockAccount, CamerasThatShareNoTimeWithTheLogAreNamed) {
  std::vector<RecordedStream> streams = clocked_host(keeps_time);
  streams.push_back(rig_recording({.name = "late", .start_s = 500}));
  const std::vector<HostLog> logs = {{"", rig_log({})}};
  EXPECT_THAT(clock_text_of(clock_account(streams, logs), "no_common_time"),
              HasSubstr("camera late shares no time with any log of the host"));
}

TEST(ClockAccount, ALogFromTheBootIsPlacedByItsStepsOrTheTimeOfTheBoot) {
  const ClockErrorS step = step_at(30, -0.25);
  ClockLog log = rig_log({.start_s = 5374018, .error_s = step});
  const std::vector<RecordedStream> streams = clocked_host(step, kRigDayS);
  const std::vector<HostLog> plain_logs = {{"", log}};
  const ClockAccount by_steps = clock_account(streams, plain_logs);
  EXPECT_EQ(by_steps.logs[0].placing, LogPlacing::kBySteps);
  EXPECT_NEAR(by_steps.logs[0].shift_s, kRigDayS - 5374018, 1);
  log.boots = {{.point = 0, .at_s = kRigDayS - 5374018}};
  const std::vector<HostLog> dated_logs = {{"", log}};
  const ClockAccount dated = clock_account(streams, dated_logs);
  EXPECT_EQ(dated.logs[0].placing, LogPlacing::kAsIs);
  EXPECT_THAT(dated.matches, SizeIs(1));
  const std::vector<HostLog> quiet = {{"", rig_log({.start_s = 5374018})}};
  EXPECT_THAT(clock_text_of(clock_account(streams, quiet), "log_from_boot"),
              AllOf(HasSubstr("counts from the boot"), HasSubstr("still shown")));
}

// Every 20 s another program sets the clock by 5 ms; the servo pulls it back within 8 s.
double pulled_back_s(double now_s) {
  const double since_s = now_s - 20 * std::floor(now_s / 20);
  return 5e-3 * std::exp(-since_s / 3);
}

TEST(ClockAccount, AnotherProgramThatSetsTheClockIsNamed) {
  const ClockRigLog log{.until_s = 130, .error_s = pulled_back_s};
  const std::vector<HostLog> logs = {{"", rig_log(log)}};
  std::vector<RecordedStream> streams = {
      rig_recording({.name = "x", .error_s = pulled_back_s, .frames = 3600}),
      rig_recording({.name = "y", .error_s = pulled_back_s, .frames = 3600})};
  const ClockAccount account = clock_account(streams, logs);
  EXPECT_THAT(clock_text_of(account, "another_program"),
              AllOf(HasSubstr("another program sets the clock of host A: "),
                    HasSubstr("equal steps of +"), HasSubstr("one in 20 s")));
  EXPECT_THAT(kinds_of_clocks(account), Contains("clocks_explain"));
}

// As phc2sys does at its usual gains: most is pulled back within two seconds.
TEST(ClockAccount, StepsThatAQuickServoPullsBackAreAnotherProgram) {
  const ClockErrorS brief = [](double now_s) {
    const double since_s = now_s - 20 * std::floor(now_s / 20);
    return 5e-3 * std::exp(-since_s);
  };
  const std::vector<HostLog> logs = {{"", rig_log({.until_s = 130, .error_s = brief})}};
  EXPECT_THAT(kinds_of_clocks(clock_account(clocked_host(brief), logs)),
              Contains("another_program"));
}

// Every 20 s the clock runs away for 8 s at 500 ppm, and is put back at once.
TEST(ClockAccount, RampsBeyondACrystalsRateAreAnotherProgram) {
  const ClockErrorS ramps = [](double now_s) {
    const double since_s = now_s - 20 * std::floor(now_s / 20);
    return since_s < 8 ? 500e-6 * since_s : 0;
  };
  const std::vector<HostLog> logs = {{"", rig_log({.until_s = 130, .error_s = ramps})}};
  const ClockAccount account = clock_account(clocked_host(ramps), logs);
  EXPECT_THAT(clock_text_of(account, "another_program"),
              AllOf(HasSubstr("slews the clock of host A"), HasSubstr("500 ppm")));
  EXPECT_THAT(kinds_of_clocks(account), Contains("host_clock_slew"));
}

TEST(ClockAccount, DelaysThatFollowTheLogAreExplained) {
  const ClockErrorS wave = [](double s) { return 2e-3 * std::sin(s / 3); };
  const std::vector<HostLog> logs = {{"A", rig_log({.error_s = wave})}, {"B", rig_log({})}};
  const ClockAccount account = clock_account(clocked_hosts(wave, wave), logs);
  ASSERT_THAT(account.explanations, SizeIs(3));
  const ClockExplanation& follows = account.explanations[0];
  EXPECT_GE(follows.share, 0.9);
  EXPECT_LE(follows.coefficient_low, 1.02);
  EXPECT_GE(follows.coefficient_high, 0.98);
  EXPECT_LT(account.explanations[2].share, 0.1);
  EXPECT_THAT(clock_text_of(account, "clocks_explain"),
              AllOf(HasSubstr("host A explains more than 99 %"), HasSubstr("cameras x, y")));
  EXPECT_THAT(clock_text_of(account, "clocks_do_not_explain"), HasSubstr("camera z"));
}

TEST(ClockAccount, HostsLockedAndExposuresApart) {
  std::vector<RecordedStream> streams = clocked_hosts(keeps_time, keeps_time);
  streams[2] = rig_recording({.name = "z", .host = "B", .phase_ms = 5.2});
  const std::vector<HostLog> logs = {{"A", rig_log({.noise_s = 3e-6})},
                                     {"B", rig_log({.noise_s = 3e-6})}};
  const ClockAccount account = clock_account(streams, logs);
  EXPECT_THAT(clock_text_of(account, "locked_but_apart"),
              AllOf(HasSubstr("the clocks of hosts B and A are within 0.01"),
                    HasSubstr("the frames of z and x arrive 5.2"), HasSubstr("not the cause")));
}

TEST(ClockAccount, ClocksApartAreTheSpread) {
  const ClockErrorS ahead = [](double) { return 5e-3; };
  const std::vector<HostLog> logs = {{"A", rig_log({})}, {"B", rig_log({.error_s = ahead})}};
  const ClockAccount account = clock_account(clocked_hosts(keeps_time, ahead), logs);
  EXPECT_THAT(clock_text_of(account, "spread_by_clocks"),
              HasSubstr("hosts B and A are 5 ms (RMS) apart by their logs: more than 99 %"));
  EXPECT_THAT(kinds_of_clocks(account), Not(Contains("locked_but_apart")));
}

TEST(ClockAccount, ErrorsOfCardAndSystemClockAdd) {
  const ClockErrorS card = [](double s) { return 2e-3 * std::sin(s / 3); };
  const ClockErrorS system = [](double s) { return 1e-3 * std::sin(s / 5); };
  const ClockErrorS both = [=](double s) { return card(s) + system(s); };
  const std::vector<HostLog> logs = {{"", rig_log({.format = "ptp4l", .error_s = card})},
                                     {"", rig_log({.format = "phc2sys", .error_s = system})}};
  const ClockAccount account = clock_account(clocked_host(both), logs);
  EXPECT_GT(account.explanations[0].share, 0.9);
  EXPECT_NEAR(account.explanations[0].coefficient, 1, 0.05);
}

TEST(ClockAccount, LogsAreReadFromText) {
  const ClockErrorS step = step_at(30, -0.25);
  std::string ptp4l;
  std::string chrony;
  std::string csv = "time,error_ms\n";
  for (int i = 0; i < 60; ++i) {
    const double error_s = step(i) + 1e-6 * (i % 3);
    ptp4l += fmt::format("ptp4l[{}.250]: master offset {:10} s2 freq  -30575 path delay  10286\n",
                         5000 + i, std::llround(1e9 * error_s));
    std::string date = iso_time_of(kRigDayS + i);
    csv += fmt::format("{}+02:00,{:.6f}\n", iso_time_of(kRigDayS + i + 7200), 1e3 * error_s);
    date[10] = ' ';
    chrony += fmt::format(
        "{} 203.0.113.15     2     -3.541      0.075 {:10.3e} N  2  2.940e-06 -2.084e-04  "
        "1.534e-02  3.472e-04  8.304e-03\n",
        date, error_s);
  }
  const std::vector<std::string> texts = {ptp4l, chrony, csv};
  for (const std::string& text : texts) {
    const std::vector<HostLog> logs = {{"A", parse_clock_log(text, "A.log")}};
    const ClockAccount account = clock_account(clocked_host(step, kRigDayS), logs);
    EXPECT_TRUE(account.logs[0].is_placed()) << account.logs[0].format;
    ASSERT_THAT(account.matches, SizeIs(1)) << account.logs[0].format;
    EXPECT_NEAR(account.logs[0].changes[account.matches[0].change].by_s, -0.25, 1e-3);
  }
}

// Heavy tails and a random walk, as NTP over the internet has them.
TEST(ClockAccount, ANoisyLogIsNoOtherProgram) {
  int found = 0;
  for (std::uint32_t seed = 1; seed <= 50; ++seed) {
    boost::random::mt19937 random(seed);
    boost::random::normal_distribution<double> noise(0, 1);
    ClockLog log = rig_log({.until_s = 3000});
    double walk_s = 0;
    for (ClockLogPoint& point : log.points) {
      walk_s += 20e-6 * noise(random);
      const double tail = noise(random) / std::max(0.05, std::abs(noise(random)));
      point.error_s = walk_s + 1e-4 * tail;
    }
    const std::vector<HostLog> logs = {{"", log}};
    const std::vector<std::string> kinds =
        kinds_of_clocks(clock_account(clocked_host(keeps_time), logs));
    found += static_cast<int>(std::ranges::count(kinds, "another_program"));
  }
  EXPECT_EQ(found, 0);
}

// chrony with a poll of 64 s beside a minute of frames.
TEST(ClockAccount, ALogWithTooFewPointsIsNamed) {
  const ClockRigLog log{.from_s = -640, .until_s = 640, .interval_s = 64};
  const std::vector<HostLog> logs = {{"", rig_log(log)}};
  EXPECT_THAT(kinds_of_clocks(clock_account(clocked_host(keeps_time), logs)),
              ElementsAre("log_too_coarse"));
}

TEST(ClockAccount, ALogOfOnePointIsNoError) {
  ClockLog log = rig_log({});
  log.points.resize(1);
  log.points[0].time = Microseconds(30'000'000);
  const std::vector<HostLog> logs = {{"", log}};
  EXPECT_TRUE(clock_account(clocked_host(keeps_time), logs).logs[0].is_placed());
}

// Stamps of the host move with its clock: their difference from the arrivals shows nothing of it.
TEST(ClockAccount, StampsOfAHostDoNotShowItsClock) {
  const ClockErrorS step = step_at(30, 0.25);
  std::vector<RecordedStream> streams = clocked_host(step);
  for (RecordedStream& stream : streams) stream.stamped_by_host = true;
  const std::vector<HostLog> logs = {{"", rig_log({.error_s = step})}};
  const ClockAccount account = clock_account(streams, logs);
  EXPECT_THAT(account.jumps, IsEmpty());
  EXPECT_THAT(account.explanations, IsEmpty());
  EXPECT_THAT(kinds_of_clocks(account), Not(Contains("unseen_step")));
}

TEST(ClockAccount, SummariesGiveTheLargestErrorOnly) {
  std::string text;
  for (int i = 0; i < 60; ++i) {
    text += fmt::format("ptp4l[{}.250]: rms   67 max  1200 freq -30575 +/- 12 delay 10 +/- 0\n", i);
  }
  const std::vector<HostLog> logs = {{"", parse_clock_log(text, "p.log")}};
  const ClockAccount account = clock_account(clocked_host(keeps_time), logs);
  EXPECT_THAT(kinds_of_clocks(account), Contains("log_of_summaries"));
  EXPECT_THAT(account.explanations, IsEmpty());
  EXPECT_NEAR(host_within_s(account, "A", 0, 60), 1.2e-6, 1e-12);
}

TEST(ClockAccount, TimesAreSaidInUtcOrSeconds) {
  EXPECT_EQ(clock_time_text(kRigDayS + 0.5), "2024-09-03 10:30:00 UTC");
  EXPECT_EQ(clock_time_text(12.34), "12.3 s");
}

}  // namespace
}  // namespace simbench::evaluation
