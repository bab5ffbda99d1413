#include "reports/recordings/model_gap_report.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <string>

#include "evaluation/statistics/statistics.h"
#include "tests/reports/sample_results.h"

namespace simbench::reports {
namespace {

using testing::HasSubstr;
using testing::Not;

MeasuredStudy study() {
  MeasuredStudy study{.date = "2026-11-21",
                      .machine = "2 cores, Linux 6.1",
                      .scenario = "relay",
                      .commit = "abc",
                      .rows = {{.pipeline = "both", .seeds = {}, .notes = {"repetition 3: lost"}}}};
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const auto x = static_cast<double>(seed);
    study.rows[0].seeds.push_back({{.amd_ms = x, .host_error_ms = 0.01 * x}, seed});
  }
  return study;
}

evaluation::Results simulated_relay() {
  evaluation::Results results;
  results.scenario = "relay";
  results.seed_count = 4;
  evaluation::Row row;
  row.pipeline = "both";
  row.amd_ms = evaluation::make_series({2, 3, 3, 4});
  row.host_error_ms = evaluation::make_series({1, 1, 2, 2});
  row.rmdv_ms = row.absolute_error_ms = evaluation::make_series({kNaN, kNaN, kNaN, kNaN});
  results.rows = {row};
  return results;
}

TEST(ModelGapReport, JsonHasBothSidesAndTheDistance) {
  const auto root =
      nlohmann::json::parse(model_gap_json(model_gap_report(study(), simulated_relay())));
  EXPECT_EQ(root["scenario"], "relay");
  EXPECT_EQ(root["measured_on"]["date"], "2026-11-21");
  EXPECT_EQ(root["measured_on"]["machine"], "2 cores, Linux 6.1");
  EXPECT_EQ(root["simulated_seeds"], 4);
  ASSERT_EQ(root["rows"].size(), 2);
  const auto& host = root["rows"][0];
  EXPECT_EQ(host["metric"], "host_error_ms");
  EXPECT_EQ(host["ks"], 1);
  EXPECT_EQ(host["significant"], true);
  EXPECT_TRUE(host["within_20_percent"].is_null());  // 0.03 ms
  const auto& amd = root["rows"][1];
  EXPECT_EQ(amd["pipeline"], "both");
  EXPECT_EQ(amd["metric"], "amd_ms");
  EXPECT_EQ(amd["measured"]["median"], 3);
  EXPECT_DOUBLE_EQ(amd["measured"]["p05"], 1.2);
  EXPECT_DOUBLE_EQ(amd["measured"]["p95"], 4.8);
  EXPECT_EQ(amd["measured"]["count"], 5);
  EXPECT_EQ(amd["simulated"]["median"], 3);
  EXPECT_EQ(amd["simulated"]["p25"], 2.75);
  EXPECT_EQ(amd["within_20_percent"], true);
  EXPECT_DOUBLE_EQ(amd["ks"], 0.2);
  EXPECT_EQ(amd["significant"], false);
  EXPECT_EQ(root["notes"][0], "both, repetition 3: lost");
}

TEST(ModelGapReport, JsonSaysWhatEachStageRestsOn) {
  const auto root =
      nlohmann::json::parse(model_gap_json(model_gap_report(study(), simulated_relay())));
  ASSERT_EQ(root["evidence"].size(), 12);
  EXPECT_EQ(root["evidence"][0]["stage"], "trigger");
  for (const auto& stage : root["evidence"]) {
    EXPECT_FALSE(stage["rests_on"].empty());
    EXPECT_FALSE(stage["why"].get<std::string>().empty());
  }
}

TEST(ModelGapReport, TableForPeople) {
  const std::string text = plain(model_gap_document(model_gap_report(study(), simulated_relay())));
  EXPECT_THAT(text, HasSubstr("relay: measured beside simulated\n"
                              "Measured 2026-11-21 on 2 cores, Linux 6.1 (simbench abc); "));
  EXPECT_THAT(text, HasSubstr("simulated with 4 seeds"));
  EXPECT_THAT(text, HasSubstr("1 of 1 medians above 0.05 ms are within 20 %; 1 of 2 distributions "
                              "differ at the 5 % level (*)."));
  EXPECT_THAT(text, HasSubstr("amd_ms         5/4      3.00      [2.00, 4.00]      [1.20, 4.80]"));
  EXPECT_THAT(text, HasSubstr("+0.0 %     yes   0.200"));
  EXPECT_THAT(text, HasSubstr("1.00 *"));
  EXPECT_THAT(text, HasSubstr("both, repetition 3: lost"));
  EXPECT_THAT(text, HasSubstr("assumption"));
  EXPECT_THAT(text, HasSubstr("no cameras"));
}

TEST(ModelGapReport, MarkdownHasTheSameTables) {
  const std::string text =
      markdown(model_gap_document(model_gap_report(study(), simulated_relay())));
  EXPECT_THAT(text, HasSubstr("## relay: measured beside simulated"));
  EXPECT_THAT(text, HasSubstr("| both | amd_ms | 5/4 | 3.00 | [2.00, 4.00] |"));
  EXPECT_THAT(text, HasSubstr("| transport and kernel stamps |  | x |  |  |  |\n"));
}

TEST(ModelGapReport, WithoutCommonPipelinesThereAreNoRows) {
  evaluation::Results others = simulated_relay();
  others.rows[0].pipeline = "another";
  const ModelGapReport report = model_gap_report(study(), others);
  EXPECT_TRUE(report.rows.empty());
  EXPECT_THAT(plain(model_gap_document(report)), HasSubstr("0 of 0 medians"));
  EXPECT_THAT(model_gap_json(report), HasSubstr("\"rows\": []"));
}

TEST(ModelGapReport, NothingWentWrongIsNotSaid) {
  MeasuredStudy fine = study();
  fine.rows[0].notes.clear();
  EXPECT_THAT(plain(model_gap_document(model_gap_report(fine, simulated_relay()))),
              Not(HasSubstr("What went wrong")));
}

}  // namespace
}  // namespace simbench::reports
