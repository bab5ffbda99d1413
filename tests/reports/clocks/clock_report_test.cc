#include "reports/clocks/clock_report.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "reports/text/json_node.h"
#include "scenarios/loader.h"
#include "tests/nonempty.h"
#include "tests/reports/sample_clocks.h"

namespace simbench::reports {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

std::vector<std::string> members_of(const Json& object) {
  std::vector<std::string> names;
  names.reserve(object.size());
  for (const auto& member : object.items()) names.push_back(member.key());
  return names;
}

TEST(ClockJson, SaysWhatItIs) {
  const Json root = Json::parse(clock_json(sample_clock_results()));
  EXPECT_THAT(members_of(root),
              ElementsAre("schema_version", "kind", "version", "commit", "scenario", "seeds",
                          "duration_s", "from_s", "interval_s", "rows", "warnings", "load_reality",
                          "answer", "performance"));
  EXPECT_EQ(root["kind"], "clocks");
  EXPECT_EQ(root["scenario"], "6host_star");
  EXPECT_EQ(root["seeds"], Json::parse(R"({"first": 4, "count": 3})"));
  EXPECT_EQ(root["duration_s"], 36'000);
  EXPECT_EQ(root["from_s"], 300);
  EXPECT_EQ(root["interval_s"], 1.0);
  EXPECT_EQ(root["warnings"], Json::parse(R"(["one was left out"])"));
  EXPECT_EQ(root["rows"].size(), 2U);
}

TEST(ClockJson, UnderLoadTheAnswerSaysHowFarOffTheBenchWas) {
  evaluation::ClockResults loaded = sample_clock_results();
  loaded.results.load_reality = {"within a factor of 2 of real rigs", "no real rig was measured"};
  const Json root = Json::parse(clock_json(loaded));
  EXPECT_EQ(root["load_reality"], Json(loaded.results.load_reality));
  EXPECT_THAT(root["answer"]["lines"],
              Contains(Json{{"label", "Load"},
                            {"text",
                             "Within a factor of 2 of real rigs; no real rig was "
                             "measured. See `simbench reality`."}}));
}

TEST(ClockJson, ARowHasTheMembersThatAreStated) {
  Json row = Json::parse(clock_json(sample_clock_results()))["rows"][0];
  EXPECT_EQ(row["metrics"]["clock_spread_ms"],
            Json::parse(R"({"median": 1.0, "p05": 0.55, "p95": 2.8, "values": [0.5, 1.0, 3.0]})"));
  EXPECT_EQ(row["metrics"].size(), evaluation::metrics(evaluation::ResultKind::kClockRuns).size());
  for (const char* const curve : {"adev", "mdev", "hdev", "tdev_ms", "mtie_ms"}) {
    ASSERT_EQ(row[curve].size(), 3U) << curve;
    EXPECT_THAT(members_of(row[curve][0]), ElementsAre("tau_s", "value", "terms"));
    EXPECT_EQ(row[curve][2]["tau_s"], 4.0);
    EXPECT_EQ(row[curve][2]["terms"], 20);
  }
  EXPECT_EQ(row["adev"][0]["value"], 1e-9);
  EXPECT_DOUBLE_EQ(row["mdev"][0]["value"].get<double>(), 1.1e-9);
  EXPECT_DOUBLE_EQ(row["rms_te_ms"].get<double>(), std::sqrt((0.25 + 1 + 9) / 3));
  for (const char* const seen :
       {"metrics", "adev", "mdev", "hdev", "tdev_ms", "mtie_ms", "rms_te_ms"}) {
    EXPECT_EQ(row.erase(seen), 1U) << seen;
  }
  EXPECT_EQ(row, Json::parse(R"({
    "pipeline": "good", "host_sync": "good", "device_time": "raw_arrival", "gathering": "yoon2021",
    "clock_spread_ms": {"mean": 1.5, "median": 1.5, "p95": 1.5, "max": 3.0, "values": [0.5, 1.0, 3.0]},
    "notes": [], "unsynchronised_hosts": 0, "max_te_ms": 3.0, "constant_te_ms": 3.0, "dynamic_te_ms": 3.0,
    "below_ms": {"1": 20.0, "0.1": null, "0.01": null},
    "holdover_ms": {"60": 1.0, "600": 1.0}, "recovery_s": 5.0, "packets_per_s": 1.0})"));
}

// A seed that never comes there is later than all others.
TEST(ClockJson, MediansOfTimesCountTheSeedsThatNeverComeThere) {
  const auto below_of = [](std::vector<double> values) {
    evaluation::ClockResults results = sample_clock_results();
    results.results.rows[0].below_1_ms_s = evaluation::make_series(std::move(values));
    Json root = Json::parse(clock_json(results));
    return Json(root["rows"][0]["below_ms"]["1"]);
  };
  constexpr double kNever = evaluation::kNan;
  EXPECT_EQ(below_of({1, 3, 2}), 2.0);
  EXPECT_EQ(below_of({1, 3, kNever}), 3.0);
  EXPECT_EQ(below_of({kNever, 1, 4, 2}), 3.0);
  EXPECT_EQ(below_of({kNever, 1, kNever, 2}), nullptr);
  EXPECT_EQ(below_of({kNever, 1, kNever}), nullptr);
  EXPECT_EQ(below_of({7}), 7.0);
  EXPECT_EQ(below_of({}), nullptr);
}

TEST(ClockReport, NothingIsNotANumber) {
  evaluation::ClockResults results = sample_clock_results();
  evaluation::Row& row = results.results.rows[0];
  for (const evaluation::Metric& metric : evaluation::metrics(evaluation::ResultKind::kClockRuns)) {
    metric.series(row) = evaluation::make_series(std::vector<double>(3, evaluation::kNan));
  }
  std::ostringstream series;
  write_series_csv(results, series);
  const Document document = clock_document(results, "summary");
  for (std::string text : {clock_json(results), clock_csv(results), series.str(), plain(document),
                           markdown(document)}) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    EXPECT_THAT(text, AllOf(Not(HasSubstr("nan")), Not(HasSubstr("inf"))));
  }
}

TEST(ClockCsv, HasMetricsThenCurves) {
  const std::string text = clock_csv(sample_clock_results());
  EXPECT_THAT(text, testing::StartsWith("pipeline,measure,tau_s,value\ngood,clock_spread_ms,,1\n"));
  EXPECT_THAT(text, HasSubstr("\ngood,below_1_ms_s,,20\n"));
  EXPECT_THAT(text, HasSubstr("\ngood,below_0_1_ms_s,,\n")) << "as in JSON";
  EXPECT_THAT(text, HasSubstr("\ngood,adev,1,1e-09\n"));
  EXPECT_THAT(text, HasSubstr("\noracle,mtie_ms,4,0\n"));
  evaluation::ClockResults changed = sample_clock_results();
  changed.results.derivation = {.base = "built_in", .changes = {{"/a", "1", "[1,2]"}}};
  EXPECT_THAT(clock_csv(changed),
              AllOf(HasSubstr("tau_s,value,changed\n"),
                    HasSubstr("good,adev,1,1e-09,\"changed: /a 1 → [1,2]\"\n")));
}

TEST(ClockCsv, TheSeriesKeepsPicosecondsOfAnyError) {
  std::ostringstream out;
  write_series_csv(sample_clock_results(), out);
  EXPECT_EQ(out.str(),
            "pipeline,seed,time_s,host,te_s\n"
            "good,4,300,1,0.000001250000\n"
            "good,4,300,2,-0.000002000000\n"
            "good,4,301,1,0.300000000002\n"
            "good,4,301,2,0.000000000000\n"
            "oracle,4,300,1,0.000000000000\n"
            "oracle,4,300,2,0.000000000000\n"
            "oracle,4,301,1,0.000000000000\n"
            "oracle,4,301,2,0.000000000000\n");
}

TEST(ClockReport, TheTextHasEveryPipelineAndCurve) {
  const std::string text = plain(clock_document(sample_clock_results(), "what it is"));
  for (const char* const part :
       {"6host_star", "The hosts' clocks", "Allan deviation", "Time deviation, ms",
        "Maximum time interval error, ms", "measured from 300 to 36000 s", "good", "oracle"}) {
    EXPECT_THAT(text, HasSubstr(part));
  }
}

TEST(ClockFigure, HasCurvesAndMasksOnLogarithmicAxes) {
  const Figure figure = clock_figure(sample_clock_results());
  ASSERT_EQ(figure.panels.size(), 3U);
  EXPECT_EQ(figure.panels[0].y_label, "ADEV");
  EXPECT_EQ(figure.panels[1].y_label, "TDEV ms");
  EXPECT_EQ(figure.panels[2].y_label, "MTIE ms");
  for (const FigurePanel& panel : figure.panels) {
    EXPECT_TRUE(panel.log_x);
    EXPECT_TRUE(panel.log_y);
    for (const FigureSeries& series : nonempty(panel.series)) {
      ASSERT_EQ(series.x.size(), series.y.size());
      for (const double x : series.x) EXPECT_GT(x, 0) << series.label;
      for (const double y : series.y) EXPECT_GT(y, 0) << series.label;
    }
    EXPECT_EQ(panel.series[0].label, "good");
    EXPECT_EQ(panel.series[0].x.size(), 3U);
    EXPECT_TRUE(panel.series[1].x.empty()) << "an oracle's zeros have no place on such an axis";
  }
  EXPECT_EQ(figure.panels[0].series.size(), 2U);
  for (const std::size_t masked : {1U, 2U}) {
    const std::vector<FigureSeries>& series = figure.panels[masked].series;
    ASSERT_EQ(series.size(), 4U);
    EXPECT_EQ(series[2].label, "G.8262 option 1");
    EXPECT_EQ(series[3].label, "G.8273.2 dTE_L");
    EXPECT_EQ(series[2].x.back(), 1000);
  }
  EXPECT_DOUBLE_EQ(figure.panels[2].series[2].y.front(), 40e-6) << "40 ns";
  EXPECT_THAT(figure.caption, HasSubstr("for orientation"));
}

}  // namespace
}  // namespace simbench::reports
