// Archives of `simbench clocks`: written, read back, compared, held to a baseline.
#include <gmock/gmock.h>

#include <string>

#include "reports/archive/archive.h"
#include "reports/clocks/clock_report.h"
#include "reports/comparison/baseline.h"
#include "reports/comparison/comparison.h"
#include "reports/comparison/gate.h"
#include "reports/results/json.h"
#include "scenarios/loader.h"
#include "tests/nonempty.h"
#include "tests/reports/sample_clocks.h"
#include "tests/reports/sample_results.h"
#include "tests/scratch_folder.h"

namespace simbench::reports {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class ClockArchive : public testing::Test {
 protected:
  ClockArchive() { write("a", written_); }

  void write(const std::string& name, const evaluation::ClockResults& results) const {
    OutputFolder output(folder_ / name, clock_archive_files());
    write_clock_archive(output, results, scenarios::load_scenario("6host_star"),
                        {.command = {"simbench", "clocks"}, .started = {}, .finished = {}});
  }
  Archive read(const std::string& name) const { return read_archive(folder_ / name); }
  // What reading says is wrong after an edit of results.json.
  std::string problem_after(const std::string& from, const std::string& to) const {
    write("edited", written_);
    std::string text = folder_.content("edited/results.json");
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    if (at == std::string::npos) return "";
    folder_.write("edited/results.json", text.replace(at, from.size(), to));
    return refusal([&] { read("edited"); });
  }
  template <class Action>
  static std::string refusal(const Action& action) {
    try {
      action();
    } catch (const scenarios::InputError& error) {
      return error.what();
    }
    return "nothing";
  }

  ScratchFolder folder_;
  evaluation::ClockResults written_ = sample_clock_results();
};

TEST_F(ClockArchive, WhatIsWrittenIsRead) {
  EXPECT_THAT(folder_.names("a"), testing::UnorderedElementsAre("manifest.json", "results.json",
                                                                "curves.csv", "series.csv"));
  const Archive archive = read("a");
  EXPECT_EQ(archive.results.kind, evaluation::ResultKind::kClockRuns);
  EXPECT_EQ(archive.results.clock_period, written_.results.clock_period);
  ASSERT_EQ(archive.curves.size(), 2U);
  for (std::size_t row = 0; row < archive.curves.size(); ++row) {
    for (const evaluation::ClockCurve& curve : nonempty(evaluation::clock_curves())) {
      const auto& points = archive.curves[row].*curve.points;
      const auto& expected = written_.curves[row].*curve.points;
      ASSERT_EQ(points.size(), expected.size());
      for (std::size_t i = 0; i < points.size(); ++i) {
        EXPECT_EQ(points[i].tau_s, expected[i].tau_s);
        EXPECT_EQ(points[i].value, expected[i].value);
        EXPECT_EQ(points[i].terms, expected[i].terms);
      }
    }
  }
  EXPECT_EQ(clock_json(clock_results_of(archive)), clock_json(written_));
  EXPECT_EQ(folder_.content("a/curves.csv"), clock_csv(written_));
}

TEST_F(ClockArchive, AResultAloneIsRead) {
  EXPECT_EQ(read("a/results.json").results.rows.size(), 2U);
}

TEST_F(ClockArchive, SaysWhereACurveIsDamaged) {
  EXPECT_THAT(problem_after("\"tau_s\": 2.0", "\"tau_s\": -2.0"),
              AllOf(HasSubstr("results.json:"), HasSubstr("/rows/0/adev/1/tau_s"),
                    HasSubstr("found -2.0, allowed: a number above 0")));
  EXPECT_THAT(problem_after("\"value\": 1e-09", "\"value\": null"),
              AllOf(HasSubstr("/rows/0/adev/0/value"), HasSubstr("allowed: a number from 0")));
  EXPECT_THAT(problem_after("\"value\": 1e-09", "\"value\": \"small\""),
              HasSubstr("/rows/0/adev/0/value: found \"small\""));
  EXPECT_THAT(problem_after("\"terms\": 100", "\"terms\": 1.5"),
              HasSubstr("/rows/0/adev/0/terms: found 1.5"));
  EXPECT_THAT(problem_after("\"hdev\"", "\"hdef\""),
              AllOf(HasSubstr("/rows/0"), HasSubstr("'hdev' is missing")));
}

TEST_F(ClockArchive, SaysWhereAMetricIsDamaged) {
  EXPECT_THAT(problem_after("\"clock_spread_median_ms\"", "\"clock_sprat_median_ms\""),
              HasSubstr("'clock_spread_median_ms' is missing"));
  EXPECT_THAT(problem_after("\"count\": 3", "\"count\": 4"),
              HasSubstr("found 3 values, allowed: 4, one for each seed"));
  EXPECT_THAT(problem_after("\"kind\": \"clocks\"", "\"kind\": \"cuckoos\""),
              HasSubstr("/kind: found \"cuckoos\", allowed: \"clocks\", or no member \"kind\""));
  EXPECT_THAT(problem_after("\"from_s\": 300", "\"from_s\": -1"), HasSubstr("/from_s: found -1"));
}

evaluation::ClockResults ten_times_worse() {
  evaluation::ClockResults results = sample_clock_results();
  results.results.rows[0] = clock_row("good", 5);
  return results;
}

TEST_F(ClockArchive, IsComparedByItsOwnMetrics) {
  write("worse", ten_times_worse());
  const Comparison comparison = compare_archives(read("a"), read("worse"), {});
  const auto judged = evaluation::judged_metrics(evaluation::ResultKind::kClockRuns);
  EXPECT_EQ(comparison.judged, judged);
  ASSERT_EQ(comparison.pipelines.size(), 2U);
  ASSERT_EQ(comparison.pipelines[0].metrics.size(), judged.size());
  for (const auto& metric : nonempty(comparison.pipelines[0].metrics)) {
    EXPECT_EQ(metric.pairs, 3U);
    EXPECT_DOUBLE_EQ(metric.mean_b, 10 * metric.mean_a);
  }
  EXPECT_THAT(comparison_json(comparison), HasSubstr("\"clock_spread_ms\""));
  EXPECT_THAT(plain(comparison_document(comparison)), HasSubstr("spread"));
  EXPECT_THAT(comparison_csv(comparison), HasSubstr("good,good,max_te_ms,3,0,1.5,15"));
}

TEST_F(ClockArchive, IsNotComparedWithAnotherKindOrSpan) {
  evaluation::ClockResults longer = written_;
  longer.results.clock_period.duration_s = 72'000;
  write("longer", longer);
  EXPECT_THAT(refusal([&] { compare_archives(read("a"), read("longer"), {}); }),
              HasSubstr("measured from 300 to 36000 s and from 300 to 72000 s; allowed: the same "
                        "--from-s and --duration-s"));
  folder_.write("captures.json", json(sample_results()));
  EXPECT_THAT(refusal([&] { compare_archives(read("a"), read("captures.json"), {}); }),
              HasSubstr("one is of `simbench clocks` and the other is not"));
  EXPECT_THAT(refusal([&] { compare_archives(read("captures.json"), read("a"), {}); }),
              HasSubstr("one is of `simbench clocks` and the other is not"));
}

TEST_F(ClockArchive, IsHeldToABaseline) {
  write_baseline(make_baseline(read("a")), folder_ / "b.json");
  const Baseline baseline = read_baseline(folder_ / "b.json");
  EXPECT_EQ(baseline.kind, evaluation::ResultKind::kClockRuns);
  EXPECT_EQ(baseline.clock_period, written_.results.clock_period);
  const GateReport same = gate(read("a"), baseline, GateMode::kExact);
  EXPECT_TRUE(same.passed());
  EXPECT_EQ(same.count(GateOutcome::kSame), same.checks.size());
  EXPECT_THAT(same.reproduce, testing::Contains(HasSubstr("simbench clocks")));
  write("worse", ten_times_worse());
  const GateReport worse = gate(read("worse"), baseline, GateMode::kExact);
  EXPECT_FALSE(worse.passed());
  EXPECT_EQ(worse.count(GateOutcome::kFailed), same.checks.size() / 2);
  EXPECT_THAT(gate_text(worse), HasSubstr("spread of the clocks"));
}

TEST_F(ClockArchive, IsNotHeldToABaselineOfAnotherKindOrSpan) {
  const Baseline baseline = make_baseline(read("a"));
  evaluation::ClockResults later = written_;
  later.results.clock_period.from_s = 600;
  write("later", later);
  constexpr const char* kAllowed = "allowed: both of `simbench clocks` with the same --from-s";
  EXPECT_THAT(refusal([&] { gate(read("later"), baseline, GateMode::kExact); }),
              HasSubstr(kAllowed));
  folder_.write("captures.json", json(sample_results()));
  EXPECT_THAT(refusal([&] { gate(read("captures.json"), baseline, GateMode::kExact); }),
              HasSubstr(kAllowed));
}

}  // namespace
}  // namespace simbench::reports
