#include "reports/reality/reality_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

namespace simbench::reports {
namespace {

using testing::HasSubstr;

const scenarios::RealRecording& measured_rig() {
  static const scenarios::RealRecording recording = [] {
    scenarios::RealRecording all{.name = "test",
                                 .title = "Two hosts",
                                 .source = "somebody, 2021",
                                 .instrument = "an analyser",
                                 .settings = {},
                                 .unknown = {{.what = "buffer",
                                              .pointer = "/network/buffer_kb",
                                              .nominal = "96",
                                              .values = {"50"},
                                              .source = "a data sheet"}}};
    all.settings.push_back({.name = "idle",
                            .scenario = "4host_chain",
                            .set = {},
                            .pipeline = "chrony_hw",
                            .measured_us = {10, 20, 30},
                            .factor = 2,
                            .used_for = {}});
    all.settings.push_back(all.settings.front());
    all.settings.back().name = "loaded";
    all.settings.back().used_for = "the mechanism";
    return all;
  }();
  return recording;
}

std::vector<RealityResult> reality_results(double idle_us) {
  const scenarios::RealRecording& recording = measured_rig();
  return {{.recording = &recording,
           .rows = {{.setting = recording.settings.data(),
                     .predicted_us = {idle_us},
                     .spans = {{.parameter = recording.unknown.data(),
                                .value = "50",
                                .predicted_us = 5 * idle_us}}},
                    {.setting = &recording.settings[1], .predicted_us = {1}}}}};
}

TEST(RealityReport, TheHeadlineCountsWhatNothingWasChosenBy) {
  EXPECT_THAT(plain(reality_document(reality_results(30))),
              HasSubstr("1 of 1 figures that nothing was chosen by are predicted within their "
                        "factor; the furthest is off by a factor of 1.5: idle."));
  EXPECT_THAT(plain(reality_document(reality_results(5))),
              HasSubstr("0 of 1 figures that nothing was chosen by"));
  EXPECT_THAT(plain(reality_document(reality_results(5))), HasSubstr("NOT within 2 (known)"));
}

TEST(RealityReport, WhatIsUnknownSaysWhatItSpans) {
  EXPECT_THAT(plain(reality_document(reality_results(30))), HasSubstr("idle 30.0 to 150 us"));
}

TEST(RealityReport, JsonHasEachRow) {
  const auto json = nlohmann::json::parse(reality_json(reality_results(30)));
  EXPECT_EQ(json["kind"], "reality");
  const auto& row = json["recordings"][0]["rows"][0];
  EXPECT_EQ(row["measured_us"]["median"], 20);
  EXPECT_EQ(row["ratio"], 1.5);
  EXPECT_EQ(row["is_within"], true);
  EXPECT_EQ(row["spans"][0]["pointer"], "/network/buffer_kb");
  EXPECT_EQ(json["recordings"][0]["rows"][1]["used_for"], "the mechanism");
}

}  // namespace
}  // namespace simbench::reports
