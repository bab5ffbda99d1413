#include "reports/stability/stability_report.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "reports/stability/verdict_text.h"
#include "reports/text/json_node.h"

namespace simbench::reports {
namespace {

using testing::AllOf;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

// 20 s of a clock that is 0.25 ms fast, has a step of 8 ms and a gap.
StabilityFinding stepped_clock(const std::string& file, bool remove_frequency = false) {
  evaluation::ClockLog log{.path = file, .format = "csv"};
  for (int i = 0; i < 22; ++i) {
    if (i == 16 || i == 17) continue;
    log.points.push_back({Microseconds(1'000'000 * (50 + i)), i < 8 ? 0.25e-3 : 8.25e-3});
  }
  return {.log = evaluation::stability_of_log(log, {.remove_frequency = remove_frequency})};
}

TEST(StabilityReport, JsonHasEveryMember) {
  const Json root =
      Json::parse(stability_json({stepped_clock("a.csv"), stepped_clock("b.csv", true)}));
  EXPECT_EQ(root["schema_version"], 1);
  ASSERT_EQ(root["files"].size(), 2u);
  const Json& file = root["files"][0];
  EXPECT_EQ(file["file"], "a.csv");
  EXPECT_EQ(file["format"], "csv");
  EXPECT_EQ(file["first_s"], 50);
  EXPECT_EQ(file["interval_s"], 1);
  EXPECT_EQ(file["points"], 20);
  EXPECT_EQ(file["left_out"], 0);
  EXPECT_EQ(file["gaps"], 1);
  EXPECT_EQ(file["longest_gap_s"], 3);
  EXPECT_TRUE(file["frequency_offset_ppb"].is_null());
  EXPECT_EQ(file["max_te_ms"], 8.25);
  EXPECT_DOUBLE_EQ(file["constant_te_ms"].get<double>(), (8 * 0.25 + 12 * 8.25) / 20);
  EXPECT_EQ(file["dynamic_te_p2p_ms"], 8);
  EXPECT_EQ(file["mtie_ms"][0]["tau_s"], 1);
  EXPECT_EQ(file["mtie_ms"][0]["value"], 8);
  EXPECT_EQ(file["mtie_ms"][0]["terms"], 15 + 3);
  EXPECT_EQ(file["adev"][1]["tau_s"], 2);
  for (const char* member : {"rms_te_ms", "dynamic_te_ms", "mdev", "hdev", "tdev_ms"}) {
    EXPECT_TRUE(file.contains(member)) << member;
  }
  ASSERT_EQ(file["steps"].size(), 1u);
  EXPECT_EQ(file["steps"][0]["at_s"], 8);
  EXPECT_EQ(file["steps"][0]["step_ms"], 8);
  EXPECT_EQ(file["notes"].size(), 1u);
  EXPECT_GT(root["files"][1]["frequency_offset_ppb"], 0);
}

TEST(StabilityReport, TextHasASectionForEachFile) {
  const std::string text =
      plain(stability_document({stepped_clock("a.csv"), stepped_clock("b.csv", true)}));
  EXPECT_THAT(text, AllOf(StartsWith("stability of 2 measured clocks"), HasSubstr("\na.csv\n\n"),
                          HasSubstr("\nb.csv\n\n"),
                          HasSubstr("step of 8.00 ms at 8 s after the first point")));
  EXPECT_THAT(text, Not(HasSubstr("nan")));
}

TEST(StabilityReport, TwoPointsHaveMtieAlone) {
  const evaluation::ClockLog log{.path = "two.csv",
                                 .format = "csv",
                                 .points = {{Microseconds(0), 0}, {Microseconds(2'000'000), 1e-9}}};
  const StabilityFinding two{.log = evaluation::stability_of_log(log, {})};
  EXPECT_THAT(plain(stability_table(two.log.stability)),
              HasSubstr("2     -         -     -     -     -         -     1"));
  EXPECT_EQ(Json::parse(stability_json({two}))["files"][0]["adev"].size(), 0u);
}

TEST(StabilityReport, CsvHasALineForEachValue) {
  const std::string text = stability_csv({stepped_clock("a,b.csv", true)});
  EXPECT_THAT(text, StartsWith("file,format,quantity,tau_s,value,terms,low,high,noise,reliable\n"
                               "\"a,b.csv\",csv,first_s,,50,,,,,\n"));
  EXPECT_THAT(text, AllOf(HasSubstr("\"a,b.csv\",csv,points,,20,,,,,\n"),
                          HasSubstr("\"a,b.csv\",csv,mtie_ms,1,"),
                          HasSubstr("\"a,b.csv\",csv,frequency_offset_ppb,,"),
                          HasSubstr("\"a,b.csv\",csv,steps,,1,,,,,\n")));
}

// Noise of which each octave's type is known.
StabilityFinding noisy_clock() {
  evaluation::ClockLog log{.path = "noisy.csv", .format = "csv"};
  unsigned state = 1;
  for (int i = 0; i < 200; ++i) {
    state = state * 1664525U + 1013904223U;
    log.points.push_back({Microseconds(1'000'000 * i), 1e-15 * static_cast<double>(state)});
  }
  return {.log = evaluation::stability_of_log(log, {})};
}

TEST(StabilityReport, DeviationsHaveTheirIntervalAndTheirNoise) {
  const StabilityFinding noisy = noisy_clock();
  const Json file = Json::parse(stability_json({noisy}))["files"][0];
  for (const char* curve : {"adev", "mdev", "hdev", "tdev_ms"}) {
    const Json& first = file[curve][0];
    EXPECT_EQ(first["noise"], "white_pm") << curve;
    EXPECT_EQ(first["reliable"], true);
    EXPECT_LT(first["low"], first["value"]);
    EXPECT_GT(first["high"], first["value"]);
  }
  EXPECT_EQ(file["mdev"].back()["reliable"], false);
  EXPECT_FALSE(file["mtie_ms"][0].contains("low"));
  EXPECT_LT(file["p50_te_ms"], file["p95_te_ms"]);
  EXPECT_LT(file["p99_te_ms"], file["p99_9_te_ms"]);
  const std::string text = plain(stability_document({noisy}));
  EXPECT_THAT(text, AllOf(HasSubstr("?"), HasSubstr(".."), HasSubstr("of the points.")));
  std::istringstream lines(plain(stability_table(noisy.log.stability)));
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100U) << line;
  EXPECT_THAT(stability_csv({noisy}),
              AllOf(ContainsRegex("noisy.csv,csv,adev,1,[^,]+,198,[^,]+,[^,]+,white_pm,1\n"),
                    ContainsRegex("noisy.csv,csv,mtie_ms,1,[^,]+,199,,,,\n")));
}

TEST(StabilityReport, WhatHasNoIntervalIsNotReliable) {
  const Json file = Json::parse(stability_json({stepped_clock("a.csv")}))["files"][0];
  EXPECT_TRUE(file["adev"][0]["low"].is_null());
  EXPECT_TRUE(file["adev"][0]["noise"].is_null());
  EXPECT_EQ(file["adev"][0]["reliable"], false);
  EXPECT_THAT(stability_csv({stepped_clock("a.csv")}),
              ContainsRegex("a.csv,csv,adev,1,[^,]+,[0-9]+,,,,0\n"));
}

TEST(StabilityReport, VerdictsAreSentencesAndNumbers) {
  StabilityFinding finding = stepped_clock("a.csv");
  const evaluation::Stability& stability = finding.log.stability;
  finding.verdicts = {evaluation::judge(stability, evaluation::limits_mask({"mtie@1s=9ms"})),
                      evaluation::judge(stability, evaluation::mask_named("prtc_a"))};
  EXPECT_EQ(mask_verdict_text(finding.verdicts[0]),
            "--limit: passes; nearest: MTIE is 8.00 ms at tau 1 s, allowed 9.00 ms.");
  EXPECT_EQ(mask_verdict_text(finding.verdicts[1]),
            "ITU-T G.8272 PRTC-A: fails: max|TE| is 8.25 ms, allowed 0.100 us (0 % of the points "
            "within).");
  EXPECT_THAT(plain(stability_document({finding})),
              AllOf(HasSubstr("Limits: 2 verdicts: 1 passed, 1 failed, 0 cannot be judged"),
                    HasSubstr("\n  --limit: passes; nearest: MTIE")));
  const Json verdicts = Json::parse(stability_json({finding}))["files"][0]["verdicts"];
  ASSERT_EQ(verdicts.size(), 2u);
  EXPECT_EQ(verdicts[0]["judgement"], "passes");
  EXPECT_EQ(verdicts[0]["limits"][0]["quantity"], "mtie_ms");
  EXPECT_EQ(verdicts[0]["limits"][0]["tau_s"], 1);
  EXPECT_EQ(verdicts[1]["mask"], "prtc_a");
  EXPECT_EQ(verdicts[1]["judgement"], "fails");
  EXPECT_EQ(verdicts[1]["limits"][0]["share_within"], 0);
  EXPECT_EQ(verdicts[1]["limits"][2]["judgement"], "fails");
  EXPECT_THAT(stability_csv({finding}),
              AllOf(HasSubstr(",limit,,1,,,,,\n"), HasSubstr(",prtc_a,,0,,,,,\n")));
}

TEST(StabilityReport, WhatCannotBeJudgedSaysWhy) {
  StabilityFinding finding = stepped_clock("a.csv");
  finding.verdicts = {
      evaluation::judge(finding.log.stability, evaluation::limits_mask({"tdev@100s=1ns"}))};
  EXPECT_THAT(plain(stability_document({finding})),
              HasSubstr("--limit: cannot be judged as a whole: TDEV judged nowhere, of tau 100 s"));
  const Json limit = Json::parse(stability_json({finding}))["files"][0]["verdicts"][0]["limits"][0];
  EXPECT_TRUE(limit["value"].is_null());
  EXPECT_THAT(limit["reason"].get<std::string>(), HasSubstr("points 1 s apart over 20 s"));
}

TEST(StabilityReport, ManyStepsAreCountedInTextAndAllInJson) {
  StabilityFinding many = stepped_clock("a.csv");
  many.log.stability.steps.assign(25, {.at_s = 3, .step_s = 1e-3});
  EXPECT_THAT(plain(stability_document({many})), HasSubstr("15 more: JSON has all"));
  EXPECT_EQ(Json::parse(stability_json({many}))["files"][0]["steps"].size(), 25u);
}

}  // namespace
}  // namespace simbench::reports
