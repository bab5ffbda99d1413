// How often the statistical gate fails, and a comparison shows a verdict, where nothing changed,
// and how often where something did: counted over 200 gates on seeds that no two of them share.
#include <gmock/gmock.h>

#include <algorithm>
#include <cstdint>
#include <iostream>

#include "evaluation/run/evaluate.h"
#include "evaluation/statistics/paired.h"
#include "evaluation/statistics/statistics.h"
#include "reports/comparison/comparison.h"
#include "reports/comparison/gate.h"
#include "scenarios/loader.h"
#include "sim/rig/simulation.h"
#include "tests/nonempty.h"

namespace simbench::reports {
namespace {

constexpr std::uint64_t kGates = 200;
constexpr std::uint64_t kSeeds = 32;  // of a baseline, and as many others of its result

// More than 16 of 200 gates that are wrong once in twenty fail in fewer than 3 of 100 trials.
constexpr int kMostFailures = 16;

evaluation::Series slice(const evaluation::Series& series, std::uint64_t first) {
  const auto begin = series.values.begin() + static_cast<std::ptrdiff_t>(first - 1);
  return evaluation::make_series({begin, begin + kSeeds});
}

class NullGate : public testing::Test {
 protected:
  // One run of all seeds, from 1 on; the scenario is the cheapest that has hosts to synchronise.
  static void SetUpTestSuite() {
    const scenarios::Scenario scenario =
        scenarios::load_scenario("6cam_2host_30fps", {{"/timeline/frames", "30"}});
    archives = new Archive;
    archives->scenario_json = scenario.resolved_json();
    archives->results = evaluation::evaluate(
        scenario, [&] { return sim::make_simulation(scenario); },
        {.seeds = 2 * kGates * kSeeds,
         .pipelines = {"ntp_last_set", "yoon2021_network", "yoon2021_time", "yoon2021_both",
                       "oracle"}},
        nullptr);
  }
  static void TearDownTestSuite() { delete archives; }

  // The archive of the seeds from `first` on.
  static Archive part(std::uint64_t first) {
    Archive archive;
    archive.path = "part";
    archive.scenario_json = archives->scenario_json;
    archive.results.scenario = archives->results.scenario;
    archive.results.first_seed = first;
    archive.results.seed_count = kSeeds;
    for (const evaluation::Row& row : archives->results.rows) {
      evaluation::Row some;
      some.pipeline = row.pipeline;
      some.amd_ms = slice(row.amd_ms, first);
      some.rmdv_ms = slice(row.rmdv_ms, first);
      some.absolute_error_ms = slice(row.absolute_error_ms, first);
      some.seed_recall = slice(row.seed_recall, first);
      archive.results.rows.push_back(std::move(some));
    }
    return archive;
  }

  // Gate i: seeds 64 i + 1 to 64 i + 32 are the baseline's, the next 32 the result's.
  static Archive baseline_part(std::uint64_t i) { return part(2 * kSeeds * i + 1); }
  static Archive result_part(std::uint64_t i) { return part(2 * kSeeds * i + kSeeds + 1); }

  // Whose AMD of oracle is `factor` times what it was.
  static int failures(bool with_margins, double factor) {
    int failed = 0;
    for (std::uint64_t i = 0; i < kGates; ++i) {
      Baseline baseline = make_baseline(baseline_part(i));
      if (!with_margins) baseline.margins = {};
      Archive result = result_part(i);
      for (double& value : result.results.rows.back().amd_ms.values) value *= factor;
      const GateReport report = gate(result, baseline, GateMode::kStatistical);
      EXPECT_TRUE(report.by_index);
      failed += static_cast<int>(!report.passed());
    }
    return failed;
  }

  static Archive* archives;
};

Archive* NullGate::archives = nullptr;

TEST_F(NullGate, FailsSeldomWhereNothingChanged) {
  const int failed = failures(true, 1);
  RecordProperty("failed", failed);
  EXPECT_LE(failed, kMostFailures);
}

// Without margins nothing but the test itself keeps a gate from failing, and still it seldom does:
// but it does, so there is something to keep.
TEST_F(NullGate, FailsSeldomWithoutMarginsToo) {
  const int failed = failures(false, 1);
  RecordProperty("failed", failed);
  EXPECT_LE(failed, kMostFailures);
  EXPECT_GE(failed, 1);
}

// Two archives of the same pipelines on other seeds: whatever a comparison shows is false.
TEST_F(NullGate, AComparisonSeldomShowsAnyVerdict) {
  int some = 0;
  std::size_t verdicts = 0;
  for (std::uint64_t i = 0; i < kGates; ++i) {
    const Comparison c = compare_archives(baseline_part(i), result_part(i), {.by_index = true});
    bool found = false;
    for (const ComparedPipeline& pipeline : c.pipelines) {
      for (const evaluation::PairedComparison& each : pipeline.metrics) {
        found = found || each.adjusted_p <= evaluation::kFamilyError;
      }
    }
    some += static_cast<int>(found);
    verdicts += count_verdicts(c).tests;
  }
  std::cout << "of 200 comparisons of other seeds, " << verdicts << " verdicts in all, " << some
            << " show a difference\n";
  EXPECT_LE(some, kMostFailures);
  EXPECT_GE(verdicts, 10 * kGates);
}

// The t-test of one metric is neither blind nor jumpy: it rejects about as often as its level says.
TEST_F(NullGate, ASingleMetricIsRejectedAboutOnceInTwenty) {
  for (std::size_t row = 0; row < nonempty(archives->results.rows).size(); ++row) {
    int rejected = 0;
    for (std::uint64_t i = 0; i < kGates; ++i) {
      const auto t =
          evaluation::paired_t(evaluation::pair_up(baseline_part(i).results.rows[row].amd_ms.values,
                                                   result_part(i).results.rows[row].amd_ms.values));
      rejected += static_cast<int>(t.p <= 0.05);
    }
    // 10 are expected; outside of this in fewer than 1 of 1000.
    EXPECT_GE(rejected, 1) << archives->results.rows[row].pipeline;
    EXPECT_LE(rejected, 21) << archives->results.rows[row].pipeline;
  }
}

// By index the worlds differ too, so a change has to be as large as their scatter to be seen.
TEST_F(NullGate, FailsMostlyWhereOnePipelineBecameMuchWorse) { EXPECT_GE(failures(true, 4), 190); }

}  // namespace
}  // namespace simbench::reports
