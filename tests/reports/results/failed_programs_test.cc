// Rows of real programs that ended, in every report: a standing, a reason, and no numbers.
#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "evaluation/scoring/program_failures.h"
#include "reports/clocks/clock_report.h"
#include "reports/comparison/comparison.h"
#include "reports/recordings/model_gap_report.h"
#include "reports/results/budget_report.h"
#include "reports/results/json.h"
#include "reports/results/results_document.h"
#include "reports/sweep/sweep_report.h"
#include "reports/text/plain_text.h"
#include "scenarios/loader.h"
#include "tests/reports/sample_archive.h"
#include "tests/reports/sample_clocks.h"
#include "tests/reports/sample_results.h"
#include "tests/reports/whole_text.h"
#include "tests/scratch_folder.h"

namespace simbench::reports {
namespace {

using evaluation::kNan;
using evaluation::Row;
using nlohmann::ordered_json;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

const char* const kReason =
    "a program ended in 1 of 3 seeds: seed 5, host 2, at 0.250000 s: chronyd: exited with status "
    "1: No such file";

// In seed 5, the second of three.
void fail_second_seed(Row& row, const std::string& log = "") {
  row.is_of_programs = true;
  row.unsynchronised_hosts = 1;
  row.program_failures = {{.seed = 5,
                           .failure = {.host = 2,
                                       .program = "chronyd",
                                       .at = from_ms(250),
                                       .how = "exited with status 1",
                                       .last_words = "No such file",
                                       .log = log}}};
  row.notes = {"repetition 5: host 2, at 0.250000 s: chronyd: exited with status 1: No such file"};
  for (const evaluation::Metric& metric : evaluation::metrics(evaluation::ResultKind::kClockRuns)) {
    std::vector<double> values = metric.series(row).values;
    if (values.size() == 3) values[1] = kNan;
    metric.series(row) = evaluation::make_series(std::move(values));
  }
}

evaluation::ClockResults clocks_with_failure(const std::string& log = "") {
  evaluation::ClockResults results = sample_clock_results();
  results.results.rows[1] = clock_row("mine", 2);
  fail_second_seed(results.results.rows[1], log);
  return results;
}

TEST(FailedPrograms, AnArchiveOfClocksKeepsThem) {
  const ScratchFolder folder;
  OutputFolder output(folder / "a", clock_archive_files());
  write_clock_archive(output, clocks_with_failure("logs/mine/0_chronyd.log"),
                      scenarios::load_scenario("6host_star"), {});
  const Archive archive = read_archive(folder / "a");
  const Row& good = archive.results.rows[0];
  EXPECT_FALSE(good.is_of_programs);
  const Row& mine = archive.results.rows[1];
  EXPECT_TRUE(mine.is_of_programs);
  ASSERT_THAT(mine.program_failures, SizeIs(1));
  const auto& [seed, failure] = mine.program_failures.front();
  EXPECT_EQ(seed, 5U);
  EXPECT_EQ(failure.host, 2U);
  EXPECT_EQ(failure.program, "chronyd");
  EXPECT_EQ(failure.at, from_ms(250));
  EXPECT_EQ(failure.how, "exited with status 1");
  EXPECT_EQ(failure.last_words, "No such file");
  EXPECT_EQ(failure.log, "logs/mine/0_chronyd.log");
  EXPECT_THAT(mine.notes, SizeIs(1));
  EXPECT_EQ(evaluation::program_failure_text(mine), kReason);
}

TEST(FailedPrograms, AnArchiveOfARunToo) {
  const ScratchFolder folder;
  evaluation::Results results = sample_results();
  results.scenario = "3cam_1host_30fps";
  results.rows[0].is_of_programs = true;
  results.rows[0].program_failures = {{.seed = 2, .failure = {.host = 1, .program = "ptp4l"}}};
  OutputFolder output(folder / "a");
  write_archive(output, results, scenarios::load_scenario("3cam_1host_30fps"), {});
  const Archive archive = read_archive(folder / "a");
  ASSERT_THAT(archive.results.rows[0].program_failures, SizeIs(1));
  EXPECT_EQ(archive.results.rows[0].program_failures[0].failure.program, "ptp4l");
  EXPECT_TRUE(archive.results.rows[1].program_failures.empty());
  EXPECT_FALSE(archive.results.rows[1].is_of_programs);
}

TEST(FailedPrograms, JsonOfClocksHasStandingAndReason) {
  const ordered_json rows = ordered_json::parse(clock_json(clocks_with_failure()))["rows"];
  EXPECT_FALSE(rows[0].contains("program_failures")) << "an algorithm's";
  const ordered_json& mine = rows[1];
  EXPECT_EQ(mine["standing"], "failed");
  EXPECT_EQ(mine["failed"], kReason);
  EXPECT_EQ(mine["program_failures"][0]["at_s"], 0.25);
  EXPECT_TRUE(mine["program_failures"][0]["log"].is_null());
  EXPECT_TRUE(mine["clock_spread_ms"]["values"][1].is_null());
  EXPECT_EQ(mine["clock_spread_ms"]["values"][0], 2.0);
}

TEST(FailedPrograms, AProgramThatRunsIsRanked) {
  evaluation::ClockResults results = sample_clock_results();
  results.results.rows[0].is_of_programs = true;
  const ordered_json row = ordered_json::parse(clock_json(results))["rows"][0];
  EXPECT_EQ(row["standing"], "ranked");
  EXPECT_TRUE(row["failed"].is_null());
  EXPECT_EQ(row["program_failures"], ordered_json::array());
}

TEST(FailedPrograms, TheTableOfClocksSaysWhichRowFailed) {
  EXPECT_THAT(plain(clock_document(sample_clock_results(), "")), Not(HasSubstr("pipeline  is")));
  const std::string text = plain(clock_document(clocks_with_failure(), ""));
  EXPECT_THAT(text, AllOf(HasSubstr("pipeline  is"), HasSubstr("mine      failed"),
                          HasSubstr("good      best"),
                          HasSubstr("--program-log DIR keeps what programs print")));
  EXPECT_THAT(plain(clock_document(clocks_with_failure("logs/0.log"), "")),
              HasSubstr("What the program of mine printed: logs/0.log"));
}

TEST(FailedPrograms, CsvOfClocksHasTwoLinesMore) {
  EXPECT_THAT(clock_csv(clocks_with_failure()),
              AllOf(HasSubstr("\nmine,standing,,failed\n"),
                    HasSubstr("\nmine,failed,,\"a program ended in 1 of 3 seeds: seed 5, host 2")));
  EXPECT_THAT(clock_csv(sample_clock_results()), Not(HasSubstr("standing")));
}

// Three seeds of four have values all the same.
TEST(FailedPrograms, NothingOfThemIsCompared) {
  Archive archive = sample_archive("a");
  Row& plain_row = archive.results.rows[0];
  plain_row.is_of_programs = true;
  plain_row.program_failures = {{.seed = 3, .failure = {.host = 1, .program = "ptp4l"}}};
  const Comparison comparison = compare_pipelines(archive, "plain", "good", {});
  for (const evaluation::PairedComparison& each : comparison.pipelines.front().metrics) {
    EXPECT_EQ(each.pairs, 0U);
  }
  EXPECT_THAT(comparison.notes,
              Contains(HasSubstr("plain failed, so nothing of it is compared: a program ended in "
                                 "1 of 32 seeds: seed 3, host 1")));
}

TEST(FailedPrograms, TheGapToTheModelIsNone) {
  evaluation::ClockResults results = clocks_with_failure();
  results.results.rows[1].model = "good";
  const auto block = program_gap_block(results.results);
  ASSERT_TRUE(block);
  EXPECT_THAT(block->table->rows.front(),
              ElementsAre("mine", "good", "-", testing::_, "-", "-", testing::_, "-"));
}

TEST(FailedPrograms, ABudgetSaysWhyThereIsNone) {
  BudgetReport report{.scenario = "sample", .first_seed = 1, .seeds = 4, .budgets = {}};
  evaluation::Budget budget;
  budget.pipeline = "mine";
  budget.failed = kReason;
  report.budgets.push_back({budget, {.pipeline = "mine", .note = kReason}});
  EXPECT_THAT(plain(budget_document(report)), HasSubstr("mine failed: a program ended"));
  const ordered_json entry = ordered_json::parse(budget_json(report))["budgets"][0];
  EXPECT_EQ(entry["failed"], kReason);
  EXPECT_TRUE(entry["amd_ms"].is_null());
}

TEST(FailedPrograms, NoSimulatedValueStandsBesideAMeasuredOne) {
  const MeasuredStudy measured{.date = "2026-11-21",
                               .machine = "a machine",
                               .scenario = "relay",
                               .commit = "abc",
                               .rows = {{.pipeline = "mine", .seeds = {{{.amd_ms = 2}, 1}}}}};
  evaluation::Results simulated;
  simulated.seed_count = 3;
  Row& row = simulated.rows.emplace_back();
  row.pipeline = "mine";
  row.amd_ms = evaluation::make_series({1, kNan, 3});
  fail_second_seed(row);
  const ModelGapReport report = model_gap_report(measured, simulated);
  ASSERT_THAT(report.rows, SizeIs(1));
  EXPECT_EQ(report.rows.front().simulated.count, 0U);
  EXPECT_THAT(plain(model_gap_document(report)), HasSubstr("mine, simulated: a program ended"));
  evaluation::Results of_nodes = simulated;
  of_nodes.rows.front().seeds.resize(3);
  EXPECT_THAT(measured_study(of_nodes, "", "").rows.front().seeds, IsEmpty());
}

class FailedSweep : public testing::Test {
 protected:
  FailedSweep() {
    plan_.scenario = "6host_star";
    plan_.scenario_json = scenarios::load_scenario("6host_star").resolved_json();
    plan_.axes = {evaluation::parse_axis("/network/latency_fixed_ms=0.1,0.2")};
    plan_.pipelines = {"chrony", "ntp"};
    plan_.seeds = 2;
    plan_.kind = evaluation::ResultKind::kClockRuns;
    for (std::size_t i = 0; i < plan_.runs(); ++i) {
      evaluation::SweepScore score(plan_.kind);
      score.at("clock_spread_ms") = plan_.run(i).pipeline == 0 ? 0.5 : 1;
      scores_.push_back(score);
    }
    // chrony's second seed at the first point; the other seed has the least value of all.
    scores_[0].at("clock_spread_ms") = 1e-6;
    scores_[1].at("clock_spread_ms") = kNan;
    scores_[1].failed = "host 2, at 0.250000 s: chronyd: exited with status 1";
  }

  evaluation::SweepPlan plan_;
  std::vector<evaluation::SweepScore> scores_;
};

TEST_F(FailedSweep, APointWithOneIsNotRanked) {
  const std::vector<evaluation::ResponseRow> rows = evaluation::response(plan_, scores_);
  EXPECT_EQ(rows[0].failed_seeds, 1U);
  const std::string text = whole_text(sweep_answer(plan_, rows));
  EXPECT_THAT(text, HasSubstr("chrony failed at 1 of 2 points: a program ended; at "
                              "/network/latency_fixed_ms=0.1: host 2, at 0.250000 s: chronyd"));
  EXPECT_THAT(text, Not(HasSubstr("1.00 ns")));
}

TEST_F(FailedSweep, ItsRunsHaveTheReasonInTheFile) {
  const std::string csv = sweep_csv(plan_, scores_);
  EXPECT_THAT(csv, HasSubstr(",failed\n"));
  EXPECT_THAT(csv, HasSubstr(",\"host 2, at 0.250000 s: chronyd: exited with status 1\"\n"));
  scores_[1].failed.clear();
  EXPECT_THAT(sweep_csv(plan_, scores_), Not(HasSubstr("failed")));
}

}  // namespace
}  // namespace simbench::reports
