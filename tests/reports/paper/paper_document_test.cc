#include "reports/paper/paper_document.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "evaluation/scoring/rows.h"
#include "reports/paper/paper_page.h"
#include "scenarios/loader.h"

namespace simbench::reports {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::Optional;

constexpr std::uint64_t kSeeds = 100;

struct Printed {
  double amd_ms = 0;
  double rmdv_ms = 0;
};

// The paper's four rows, a hundred seeds with the AMD factor/100, 2 factor/100, ..., factor times
// `top_ms`, and an RMDV of 0.35 of that.
PaperRun run(const char* table, const char* scenario, const std::map<std::string, Printed>& printed,
             double top_ms) {
  PaperRun run{.table = table, .scenario = scenarios::load_scenario(scenario, {}), .results = {}};
  run.results.scenario = run.scenario.name;
  run.results.seed_count = kSeeds;
  const std::map<std::string, double> factors = {
      {"ntp_last_set", 100}, {"yoon2021_time", 3}, {"yoon2021_network", 2}, {"yoon2021_both", 1}};
  for (const auto& [pipeline, factor] : factors) {
    evaluation::Row row;
    row.pipeline = pipeline;
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
      evaluation::SeedScore score;
      score.seed = seed;
      score.amd_ms = factor * top_ms * static_cast<double>(seed) / kSeeds;
      score.rmdv_ms = 0.35 * score.amd_ms;
      row.amd_ms.values.push_back(score.amd_ms);
      row.rmdv_ms.values.push_back(score.rmdv_ms);
      row.seeds.push_back(score);
    }
    row.amd_ms = evaluation::make_series(row.amd_ms.values);
    row.rmdv_ms = evaluation::make_series(row.rmdv_ms.values);
    const Printed& values = printed.at(pipeline);
    row.published = evaluation::compare({.amd_ms = values.amd_ms, .rmdv_ms = values.rmdv_ms}, row,
                                        evaluation::row_setting(run.scenario));
    run.results.rows.push_back(row);
  }
  return run;
}

// Both: in the middle of its seeds. Network: beyond all. Time: an RMDV that no data have.
PaperResults sample_paper() {
  PaperResults results{.at_15_fps = run("Table 2", "18cam_6host_15fps",
                                        {{"ntp_last_set", {500, 175}},
                                         {"yoon2021_time", {15, 5}},
                                         {"yoon2021_network", {25, 8}},
                                         {"yoon2021_both", {5, 1.8}}},
                                        10),
                       .at_45_fps = run("Table 3", "18cam_6host_45fps",
                                        {{"ntp_last_set", {250, 87.5}},
                                         {"yoon2021_time", {7.5, 6}},
                                         {"yoon2021_network", {5, 1.7}},
                                         {"yoon2021_both", {2.5, 0.9}}},
                                        5)};
  results.no_table_4 = "Left out.";
  return results;
}

const PrintedValue& value_of(const std::vector<PrintedValue>& values, const std::string& pipeline,
                             const std::string& metric) {
  return *std::ranges::find_if(values, [&](const PrintedValue& value) {
    return value.row->pipeline == pipeline && value.metric == metric;
  });
}

TEST(PrintedValues, ArePlacedAmongTheSeedsOfTheirRow) {
  const PaperRun fast = sample_paper().at_45_fps;
  const std::vector<PrintedValue> values = printed_values(fast);
  ASSERT_EQ(values.size(), 8U);
  const PrintedValue& both = value_of(values, "yoon2021_both", "amd_ms");
  EXPECT_DOUBLE_EQ(both.printed, 2.5);
  EXPECT_DOUBLE_EQ(both.percentile.percent, 49.5);
  EXPECT_TRUE(both.is_attainable());
}

// The bound of eq. (4) for 18 cameras: 1 / sqrt(2) of the AMD.
TEST(PrintedValues, AnRmdvAboveItsBoundIsNotAttainable) {
  const PaperRun fast = sample_paper().at_45_fps;
  const std::vector<PrintedValue> values = printed_values(fast);
  const PrintedValue& time = value_of(values, "yoon2021_time", "rmdv_ms");
  EXPECT_NEAR(time.most, 7.5 / std::sqrt(2), 1e-9);
  EXPECT_FALSE(time.is_attainable());
  EXPECT_TRUE(value_of(values, "yoon2021_both", "rmdv_ms").is_attainable());
}

TEST(NotReached, NamesWhatIsOutsideWithItsReason) {
  const std::vector<std::string> slow = not_reached(sample_paper().at_15_fps);
  ASSERT_EQ(slow.size(), 2U);
  EXPECT_THAT(slow[0], HasSubstr("AMD of yoon2021_network, 25.0 ms: outside, at percentile 100 % "
                                 "[96-100]; one set of parameters"));
  EXPECT_THAT(slow[1],
              HasSubstr("RMDV of yoon2021_network, 8.00 ms: outside, at percentile 100 % [96-100]; "
                        "printed RMDV/AMD is 0.320, that of the seeds 0.350 [0.350, 0.350]"));
  const std::vector<std::string> fast = not_reached(sample_paper().at_45_fps);
  ASSERT_EQ(fast.size(), 1U);
  EXPECT_THAT(fast[0], HasSubstr("RMDV of yoon2021_time, 6.00 ms: not attainable"));
  EXPECT_THAT(fast[0], HasSubstr("with an AMD of 7.50 ms eq. (4) allows at most 5.30 ms"));
}

PaperClaim claim(const PaperResults& results, const std::string& id) {
  const std::vector<PaperClaim> claims = paper_claims(results);
  const auto found = std::ranges::find(claims, id, &PaperClaim::id);
  if (found != claims.end()) return *found;
  ADD_FAILURE() << "no claim " << id;
  return {};
}

TEST(PaperClaims, AreOfEachRateOrOfBoth) {
  const PaperResults results = sample_paper();
  EXPECT_DOUBLE_EQ(claim(results, "C2").at_15_fps.percent, 100);
  EXPECT_TRUE(std::isnan(claim(results, "C2").at_45_fps.percent));
  EXPECT_DOUBLE_EQ(claim(results, "C4").at_both.percent, 100);
  EXPECT_TRUE(std::isnan(claim(results, "C4").at_15_fps.percent));
  EXPECT_DOUBLE_EQ(claim(results, "C2 and C3").at_both.percent, 100);
  EXPECT_DOUBLE_EQ(claim(results, "C1").at_45_fps.percent, 100);
}

TEST(PaperClaims, SayWhatThePrintedNumbersSay) {
  const PaperResults results = sample_paper();
  EXPECT_THAT(claim(results, "C3").printed, Optional(true));
  EXPECT_THAT(claim(results, "C2").printed, Optional(false));         // network above time
  EXPECT_THAT(claim(results, "C2 and C3").printed, Optional(false));  // ... at one of the rates
  EXPECT_EQ(claim(results, "C6").printed, std::nullopt);
}

TEST(PaperDocument, BeginsWithHowManyValuesArePlausible) {
  const std::string text = markdown(paper_document(sample_paper()));
  EXPECT_THAT(text, HasSubstr("Of the paper's 8 AMD values 7 are plausible draws of the fitted "
                              "worlds, one is not."));
  EXPECT_THAT(text, HasSubstr("15 fps: Published AMD, by its percentile [95 % interval]: 3 of 4 "
                              "inside"));
  EXPECT_THAT(text, HasSubstr("Table 2: 15 fps, 18cam_6host_15fps"));
  EXPECT_THAT(text, HasSubstr("A fit, not a validation"));
  EXPECT_THAT(text, HasSubstr("Table 4: the reconstruction\n\nLeft out.\n"));
}

TEST(PaperDocument, FewSeedsPlaceNothingOutside) {
  PaperResults results = sample_paper();
  for (PaperRun* rate : {&results.at_15_fps, &results.at_45_fps}) {
    for (evaluation::Row& row : rate->results.rows) {
      row.amd_ms.values.resize(10);
      row.published = evaluation::compare({.amd_ms = 1000, .rmdv_ms = 1}, row,
                                          evaluation::row_setting(rate->scenario));
    }
    rate->results.seed_count = 10;
  }
  const AnswerText answer = paper_answer(results);
  EXPECT_EQ(answer.lead,
            "Of the paper's 8 AMD values 0 are plausible draws of the fitted worlds, 0 are not; "
            "these seeds cannot place 8.");
  EXPECT_THAT(answer.points[0].text, HasSubstr("10 seeds cannot place ntp_last_set at 100 %"));
  EXPECT_THAT(answer.points[0].text, Not(HasSubstr("outside")));
}

TEST(PaperDocument, ListsItsFiguresByTheNumbersOfThePaper) {
  PaperResults results = sample_paper();
  EXPECT_THAT(plain(paper_document(results)), HasSubstr("Not drawn: -o DIR"));
  results.figures = {
      {.id = "stamps", .title = "Stamps", .caption = "They begin anywhere.", .paper = "Fig. 3"},
      {.id = "hosts", .title = "Hosts", .caption = "", .paper = "Fig. 5", .absent = "one host"}};
  results.figures[0].source.scenario = "3cam";
  results.figures[1].source.scenario = "6cam";
  const std::string text = plain(paper_document(results));
  EXPECT_THAT(text, HasSubstr("Fig. 3, Stamps (3cam): They begin anywhere."));
  EXPECT_THAT(text, HasSubstr("Fig. 5, Hosts (6cam): cannot be drawn here: one host"));
  EXPECT_THAT(text, HasSubstr("Fig. 7 a, the camera's connector for the trigger: not drawn"));
}

TEST(PaperJson, HasTheSameForPrograms) {
  const auto root = nlohmann::json::parse(paper_json(sample_paper()));
  EXPECT_EQ(root["schema_version"], 1);
  ASSERT_EQ(root["runs"].size(), 2U);
  EXPECT_EQ(root["runs"][0]["table"], "Table 2");
  EXPECT_EQ(root["runs"][0]["rate_hz"], 15);
  EXPECT_EQ(root["runs"][0]["printed"].size(), 8U);
  EXPECT_EQ(root["runs"][0]["results"]["scenario"], "18cam_6host_15fps");
  EXPECT_EQ(root["runs"][0]["not_reached"].size(), 2U);
  for (const auto& claim : root["claims"]) {
    if (claim["id"] != "C4") continue;
    EXPECT_EQ(claim["at_both"]["percent"], 100);
    EXPECT_TRUE(claim["at_15_fps"].is_null());
    EXPECT_EQ(claim["printed"], true);
  }
  EXPECT_TRUE(root["table_4"].is_null());
  EXPECT_EQ(root["no_table_4"], "Left out.");
}

TEST(PaperPage, BeginsWithThePaperAndHasAnArchiveOfEachRate) {
  const PaperResults results = sample_paper();
  std::vector<ReportedArchive> archives(2);
  archives[0].archive.path = "paper/18cam_6host_15fps";
  archives[0].archive.results = results.at_15_fps.results;
  archives[1].archive.path = "paper/18cam_6host_45fps";
  archives[1].archive.results = results.at_45_fps.results;
  const std::string page =
      paper_html({.results = results, .archives = archives, .command = {"simbench", "paper"}});
  std::size_t at = 0;
  for (const char* part : {"<h1>simbench <span>what the paper measured", "data-archive=\"0\"",
                           "Table 2: 15 fps", "Table 3: 45 fps", "The paper&#39;s claims",
                           "data-archive=\"1\" data-name=\"paper/18cam_6host_15fps\"",
                           "data-archive=\"2\" data-name=\"paper/18cam_6host_45fps\""}) {
    const std::size_t found = page.find(part, at);
    ASSERT_NE(found, std::string::npos) << part;
    at = found;
  }
}

}  // namespace
}  // namespace simbench::reports
