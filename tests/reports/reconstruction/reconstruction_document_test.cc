#include "reports/reconstruction/reconstruction_document.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <sstream>

#include "reports/text/json_node.h"
#include "reports/text/plain_text.h"
#include "tests/reports/sample_reconstruction.h"

namespace simbench::reports {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

std::string reconstruction_table() {
  return plain(reconstruction_document(sample_reconstruction()));
}
Json reconstruction_as_json() { return Json::parse(reconstruction_json(sample_reconstruction())); }

TEST(ReconstructionTable, HasTheRowsOfTable4) {
  const std::string text = reconstruction_table();
  EXPECT_THAT(text, HasSubstr("a_studio: 3 seeds (1-3), 10 frame sets each\n"));
  // The 5 % and 95 % quantiles of 6, 8, 13 are 6.2 and 12.5.
  EXPECT_THAT(text, ContainsRegex("ntp_last_set +8.00 \\[6.20, 12.50\\] +9.70, too few seeds +"
                                  "4.00 \\[3.10, 6.25\\] +12.14, too few seeds\n"));
  EXPECT_THAT(text, ContainsRegex("yoon2021_both +2.40 \\[2.04, 2.58\\] +2.39, too few seeds +"
                                  "1.20 \\[1.02, 1.29\\] +1.80, too few seeds\n"));
  EXPECT_THAT(text, ContainsRegex("oracle +2.10 \\[2.01, 2.19\\] +- +1.05 \\[[^]]*\\] +-\n"));
}

TEST(ReconstructionTable, PlacesPublishedValuesByTheirPercentile) {
  auto results = sample_reconstruction();
  std::vector<double> means;
  means.reserve(80);
  for (int i = 0; i < 80; ++i) means.push_back(9 + 0.02 * i);  // 35 below 9.703; half of all < 12
  const auto published = results.rows[0].published;
  results.rows[0] = sample_row("ntp_last_set", means, 547, false);
  results.rows[0].published = published;
  const std::string text = plain(reconstruction_document(results));
  EXPECT_THAT(text, ContainsRegex("ntp_last_set .*9.70, inside .*12.14, outside\n"));
  EXPECT_THAT(text, HasSubstr("too few seeds: neither (outside takes 72 seeds)"));
  const Json row = Json::parse(reconstruction_json(results))["rows"][0];
  EXPECT_EQ(row["published"]["mean_inside"], true);
  EXPECT_EQ(row["published"]["std_inside"], false);
}

TEST(ReconstructionTable, SaysHowTheRowsCameAbout) {
  const std::string text = reconstruction_table();
  EXPECT_THAT(text, ContainsRegex("ntp_last_set +2.00 +24.00 +547.0 \\[547.0, 547.0\\] +66.7 % +"
                                  "30 +0 +7\n"));
  EXPECT_THAT(text,
              ContainsRegex("oracle +0.53 +6.30 +0.250 \\[0.250, 0.250\\] +0 % +20 +10 +0\n"));
  EXPECT_THAT(text, HasSubstr("  oracle: seed 2: too little of the subject was seen\n"));
  EXPECT_THAT(text, HasSubstr("  oracle = oracle + regression_30 + yoon2021\n"));
}

TEST(ReconstructionTable, DrawsItsConclusions) {
  const std::string text = reconstruction_table();
  EXPECT_THAT(text, HasSubstr("ntp_last_set : yoon2021_both = 3.33 [3.03, 4.83] in the mean error, "
                              "seed by seed; published: 4.05.\n"));
  EXPECT_THAT(text, HasSubstr("No speed of the subject up to 2.40 m/s gives"));
  EXPECT_THAT(text, ContainsRegex("speed +0 ms +10 ms +100 ms\n"));
  EXPECT_THAT(text, ContainsRegex("1.20 m/s +2.00 +2.00 +2.90\n"));
  EXPECT_THAT(text, ContainsRegex("0.60 m/s +2.00 +> 100 +0.0002\n"));
  EXPECT_THAT(text, ContainsRegex("1.20 m/s +2.00 +30.0 +0.0100\n"));
}

TEST(ReconstructionTable, IsHonest) {
  const std::string text = reconstruction_table();
  EXPECT_THAT(text, HasSubstr("The subject is a simulated person of 1.75 m, motion "
                              "\"walk_and_turn\" at 1.2 m/s and 1 rad/s; the paper states"));
  EXPECT_THAT(text, HasSubstr("calibration errors of 10 mm and 0.29 degrees per axis"));
  // 1.2 m/s * 5 ms = 6 mm.
  EXPECT_THAT(text, HasSubstr("In the 5.0 ms of yoon2021_both the subject moves 0.60 cm: that row "
                              "measures calibration and depth noise"));
  EXPECT_THAT(text, HasSubstr("  the mesh has 3 holes\n"));
}

TEST(ReconstructionTable, SaysNothingOfWhatWasNotAskedFor) {
  auto results = sample_reconstruction();
  results.curve.clear();
  results.speed_needed.reset();
  results.rows.erase(results.rows.begin());
  results.seeds = results.frames = 1;
  const std::string text = plain(reconstruction_document(results));
  EXPECT_THAT(text, HasSubstr("a_studio: 1 seed (1), 1 frame set each\n"));
  for (const char* part : {"How good must", "all hosts off", "ntp_last_set", "published:"}) {
    EXPECT_THAT(text, Not(HasSubstr(part)));
  }
}

TEST(ReconstructionTable, FitsAPageOf100Columns) {
  auto results = sample_reconstruction();
  results.rows[0].pipeline = "two_way_hull_upstream";
  results.rows[0].seeds[0].errors.mean_cm = 123.456;
  set_page_width(100);
  const std::string text = plain(reconstruction_document(results));
  set_page_width(std::nullopt);
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100U) << line;
  // Not divided into blocks: its heading stands there once.
  EXPECT_EQ(text.find("standard deviation"), text.rfind("standard deviation"));
  EXPECT_THAT(text, ContainsRegex("95 % +desynchronisation +seeds without +missing\n"));
}

TEST(ReconstructionJson, HasRowsWithSeries) {
  const Json root = reconstruction_as_json();
  EXPECT_EQ(root["schema_version"], 1);
  EXPECT_EQ(root["scenario"], "a_studio");
  EXPECT_EQ(root["frames"], 10);
  const Json& row = root["rows"][0];
  EXPECT_EQ(row["pipeline"], "ntp_last_set");
  EXPECT_EQ(row["gathering"], "yoon2021");
  EXPECT_EQ(row["mean_cm"]["median"], 8);
  EXPECT_EQ(row["mean_cm"]["values"], Json({6, 8, 13}));
  EXPECT_NEAR(row["std_cm"]["p95"].get<double>(), 6.25, 1e-12);
  EXPECT_EQ(row["desync_ms"]["median"], 547);
  EXPECT_EQ(row["sets"], 30);
  EXPECT_EQ(row["missing_frames"], 7);
  EXPECT_NEAR(row["no_gathered_set_share"].get<double>(), 2.0 / 3, 1e-12);
  EXPECT_EQ(row["published"]["mean_cm"], 9.703);
  EXPECT_EQ(row["published"]["mean_inside"], nullptr);  // three seeds do not tell
  EXPECT_EQ(row["published"]["std_inside"], nullptr);
  EXPECT_EQ(root["rows"][2]["published"], nullptr);
  EXPECT_EQ(root["published"]["yoon2021_both"]["std_cm"], 1.7967);
}

TEST(ReconstructionJson, WhatDoesNotExistIsNull) {
  const Json root = reconstruction_as_json();
  EXPECT_EQ(root["rows"][2]["mean_cm"]["values"][1], nullptr);
  EXPECT_EQ(root["limits"][0]["limit_ms"], nullptr);
  EXPECT_EQ(root["speed_needed"]["speed_m_per_s"], nullptr);
  auto results = sample_reconstruction();
  results.speed_needed.reset();
  results.rows.clear();
  const Json empty = Json::parse(reconstruction_json(results));
  EXPECT_EQ(empty["speed_needed"], nullptr);
  EXPECT_EQ(empty["published_ratio"], nullptr);
  EXPECT_EQ(empty["rows"], Json::array());
}

TEST(ReconstructionJson, HasCurveLimitsAndPerformance) {
  const Json root = reconstruction_as_json();
  ASSERT_EQ(root["curve"].size(), 6U);
  EXPECT_EQ(root["curve"][5]["desync_ms"], 100);
  EXPECT_EQ(root["curve"][5]["mean_cm"]["median"], 2.9);
  EXPECT_NEAR(root["limits"][1]["limit_ms"].get<double>(), 30, 1e-9);
  EXPECT_NEAR(root["limits"][1]["cost_cm_per_ms"].get<double>(), 0.01, 1e-12);
  EXPECT_EQ(root["speed_needed"]["points"].size(), 2U);
  EXPECT_NEAR(root["published_ratio"]["ratio"]["median"].get<double>(), 8 / 2.4, 1e-12);
  EXPECT_EQ(root["performance"]["wall_s"], 61.25);
  EXPECT_EQ(root["notes"].size(), 4U);
}

TEST(ReconstructionCsv, HasALineForEachPipeline) {
  auto results = sample_reconstruction();
  results.rows[2].pipeline = "a,b";
  const std::string text = reconstruction_csv(results);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 4);
  EXPECT_THAT(text, HasSubstr("pipeline,host_sync,device_time,gathering,mean_cm,mean_cm_p05,"));
  EXPECT_THAT(text, HasSubstr("ntp_last_set,ntp_last_set,regression_30,yoon2021,8,"));
  EXPECT_THAT(text, HasSubstr(",9.703,12.1391\n"));
  EXPECT_THAT(text, HasSubstr("\"a,b\",oracle,"));
  EXPECT_THAT(text, HasSubstr(",20,10,0,0,,\n"));
}

TEST(ReconstructionStages, NameWhatSteersTheExposures) {
  auto results = sample_reconstruction();
  EXPECT_FALSE(reconstruction_as_json()["rows"][0].contains("capture_alignment"));
  results.rows[1].capture_alignment = "phase_rate";
  const Json root = Json::parse(reconstruction_json(results));
  EXPECT_FALSE(root["rows"][0].contains("capture_alignment"));
  EXPECT_EQ(root["rows"][1]["capture_alignment"], "phase_rate");
  const std::string csv = reconstruction_csv(results);
  EXPECT_THAT(csv, HasSubstr("pipeline,host_sync,capture_alignment,device_time,gathering,"));
  EXPECT_THAT(csv, HasSubstr("ntp_last_set,ntp_last_set,,regression_30,yoon2021,8,"));
  const std::string& host_sync = results.rows[1].host_sync;
  EXPECT_THAT(csv, HasSubstr(host_sync + ",phase_rate,regression_30,yoon2021,"));
  EXPECT_THAT(plain(reconstruction_document(results)),
              HasSubstr(host_sync + " + phase_rate + regression_30 + yoon2021"));
}

}  // namespace
}  // namespace simbench::reports
