// A metric is its computation, an entry in evaluation/scoring/metric_table.cc and, for tables, one
// in reports/results/metric_columns.cc: one that is added here, of a quantity that scores have and
// results do not show, is found in every output.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <string>

#include "evaluation/scoring/metrics.h"
#include "evaluation/scoring/rows.h"
#include "evaluation/sweep/sweep_score.h"
#include "reports/comparison/baseline.h"
#include "reports/comparison/comparison.h"
#include "reports/comparison/gate.h"
#include "reports/results/csv.h"
#include "reports/results/json.h"
#include "reports/results/metric_columns.h"
#include "reports/results/results_document.h"
#include "reports/sweep/sweep_report.h"
#include "reports/text/block.h"
#include "reports/text/output_file.h"
#include "tests/reports/sample_archive.h"
#include "tests/scratch_folder.h"

namespace simbench::reports {
namespace {

using evaluation::MetricValues;
using evaluation::Series;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

constexpr evaluation::Metric kTrend = {
    .id = "trend_ms",
    .title = "trend",
    .unit = "ms",
    .place =
        evaluation::SeriesPlace{&MetricValues<double>::trend_ms, &MetricValues<Series>::trend_ms},
    .csv = evaluation::CsvForm::kBand,
    .sweep = "trend_ms",
    .judged = evaluation::kJudgedMs};

constexpr MetricColumn kTrendColumn = {.id = "trend_ms",
                                       .tables = {.paper = 3, .truth = 10, .sets = 11},
                                       .heading = "trend of\nAMD ms",
                                       .legend = "trend: how much AMD grows over the recording."};

// Two pipelines over 32 seeds: the trend is 1, 2, ... ms, of the second twice as much.
evaluation::Row added_row(const std::string& name, double factor) {
  std::vector<evaluation::SeedScore> seeds(32);
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    seeds[i].seed = i + 1;
    seeds[i].amd_ms = 5;
    seeds[i].trend_ms = factor * static_cast<double>(i + 1);
  }
  scenarios::Pipeline pipeline;
  pipeline.name = name;
  return evaluation::make_row(pipeline, std::move(seeds), {});
}

Archive added_archive() {
  Archive archive = sample_archive("results");
  archive.results.rows = {added_row("first", 1), added_row("second", 2)};
  return archive;
}

class AddedMetric : public testing::Test {
 private:
  evaluation::ScopedMetric trend_{kTrend};
  ScopedMetricColumn column_{kTrendColumn};
};

TEST_F(AddedMetric, ItsRowHasMedianAndBand) {
  const evaluation::Row made = added_row("first", 1);
  EXPECT_EQ(made.trend_ms.median, 16.5);
  EXPECT_EQ(made.trend_ms.values.size(), 32U);
}

TEST_F(AddedMetric, IsInJsonAndReadFromTheArchive) {
  const std::string text = json(added_archive().results);
  EXPECT_EQ(nlohmann::json::parse(text)["rows"][1]["trend_ms"]["median"], 33);
  const ScratchFolder folder;
  EXPECT_EQ(read_archive(folder.write("results.json", text)).results.rows[1].trend_ms.median, 33);
}

TEST_F(AddedMetric, IsInCsv) {
  const std::string text = csv(added_archive().results);
  EXPECT_THAT(text.substr(0, text.find('\n')), HasSubstr(",trend_ms,trend_ms_p05,trend_ms_p95,"));
  EXPECT_THAT(text, HasSubstr(",16.5,2.55,30.45,"));
}

TEST_F(AddedMetric, IsInTheTablesOfTerminalMarkdownAndPage) {
  const Document document = results_document(added_archive().results, "");
  EXPECT_THAT(plain(document), AllOf(HasSubstr("trend of"), HasSubstr("33.0 ms"),
                                     HasSubstr("trend: how much AMD grows")));
  EXPECT_THAT(markdown(document), AllOf(HasSubstr("trend of AMD ms"), HasSubstr("33.0 ms")));
  EXPECT_THAT(html(document.blocks), AllOf(HasSubstr("trend of"), HasSubstr("33.0 ms")));
}

TEST_F(AddedMetric, IsInTheSweep) {
  evaluation::SweepPlan plan;
  plan.scenario = "sample";
  plan.scenario_json = "{}";
  plan.pipelines = {"first"};
  plan.seeds = 2;
  std::vector<evaluation::SweepScore> scores(2);
  scores[0].at("trend_ms") = 1.25;
  scores[1].at("trend_ms") = 2.25;
  EXPECT_EQ(evaluation::score_of(evaluation::text_of(scores[1]))->at("trend_ms"), 2.25);
  const std::string text = sweep_csv(plan, scores);
  EXPECT_THAT(text.substr(0, text.find('\n')), HasSubstr(",trend_ms"));
  EXPECT_THAT(text, HasSubstr(",1.25"));
  EXPECT_EQ(evaluation::response(plan, scores).front().of("trend_ms").median, 1.75);
}

TEST_F(AddedMetric, IsCompared) {
  const Comparison comparison = compare_pipelines(added_archive(), "first", "second", {});
  const auto found = nlohmann::json::parse(comparison_json(comparison));
  EXPECT_EQ(found["pipelines"][0]["trend_ms"]["verdict"], "worse");
  EXPECT_NEAR(found["pipelines"][0]["trend_ms"]["ratio"]["value"].get<double>(), 2, 1e-12);
  EXPECT_THAT(comparison_csv(comparison), HasSubstr("first,second,trend_ms,32,0,"));
}

TEST_F(AddedMetric, IsGated) {
  const Baseline baseline = make_baseline(added_archive());
  EXPECT_THAT(baseline_json(baseline), HasSubstr("\"trend_ms\": [1.0,2.0,3.0,"));
  Archive later = added_archive();
  scale(later.results.rows[0].trend_ms, 1.5);
  const GateReport report = gate(later, baseline, GateMode::kExact);
  EXPECT_FALSE(report.passed());
  EXPECT_EQ(report.count(GateOutcome::kFailed), 1U);
  EXPECT_THAT(gate_text(report), HasSubstr("trend of first"));
}

TEST(NoAddedMetric, IsNowhere) {
  EXPECT_THAT(csv(added_archive().results), Not(HasSubstr("trend_ms")));
  EXPECT_THAT(json(added_archive().results), Not(HasSubstr("trend_ms")));
}

}  // namespace
}  // namespace simbench::reports
