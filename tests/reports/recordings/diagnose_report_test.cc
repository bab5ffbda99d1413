#include "reports/recordings/diagnose_report.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "reports/text/json_node.h"

namespace simbench::reports {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

// Two cameras of 600 frames at 50 Hz on one trigger; the second halves its rate.
std::vector<RecordedStream> streams() {
  std::vector<RecordedStream> all = {{"front", "pc", "Depth 0", {}}, {"back", "pc", "Depth 0", {}}};
  for (int i = 0; i < 600; ++i) {
    const Nanoseconds at = from_ms(20.0 * i);
    const Nanoseconds late = Microseconds(i * 7919 % 97);
    all[0].frames.push_back(
        {.counter = static_cast<std::uint64_t>(i), .sensor = at, .arrival = at + late});
    if (i % 2 == 0) {
      all[1].frames.push_back(
          {.counter = static_cast<std::uint64_t>(i / 2), .sensor = at, .arrival = at + late});
    }
  }
  return all;
}

TEST(DiagnoseReport, TheTextBeginsWithTheWorstFindingAndTheVerdict) {
  const std::string text = plain(diagnose_document(evaluation::diagnose(streams(), {})));
  EXPECT_THAT(text, testing::StartsWith("Camera back: half the rate (25.000 Hz)"));
  EXPECT_THAT(text, HasSubstr("Depth 0: hardware sync works: all 2 cameras have one "));
  EXPECT_THAT(text, HasSubstr("\n  camera back: half the rate (25.000 Hz)"));
  EXPECT_THAT(text, HasSubstr("What stamps alone cannot show"));
  EXPECT_THAT(text, HasSubstr("Film one"));
}

TEST(DiagnoseReport, JsonHasWhatTheTableHas) {
  const Json root = Json::parse(diagnose_json(evaluation::diagnose(streams(), {}), {"rig.csv"}));
  EXPECT_EQ(root["schema_version"], 1);
  EXPECT_EQ(root["files"], Json::parse(R"(["rig.csv"])"));
  EXPECT_EQ(root["verdict"]["status"], "works");
  EXPECT_EQ(root["streams"].size(), 1U);
  EXPECT_EQ(root["cameras"][0]["follows"], "trigger");
  EXPECT_NEAR(root["cameras"][0]["rate_hz"].get<double>(), 50, 1e-3);
  EXPECT_EQ(root["cameras"][1]["period_multiple"], 2);
  EXPECT_EQ(root["cameras"][1]["lost_frames"], 0);
  EXPECT_EQ(root["findings"][0]["kind"], "divided_rate");
  EXPECT_EQ(root["cannot_know"].size(), 2U);
}

TEST(DiagnoseReport, WhatIsUnknownIsNull) {
  std::vector<RecordedStream> one = streams();
  one.resize(1);
  one[0].frames.resize(1);
  const evaluation::Diagnosis diagnosis = evaluation::diagnose(one, {});
  const std::string text = diagnose_json(diagnosis, {});
  EXPECT_THAT(text, Not(HasSubstr("nan")));
  const Json root = Json::parse(text);
  EXPECT_EQ(root["verdict"]["status"], "cannot_be_told");
  for (const char* key : {"rate_hz", "period_ms", "rate_ppm", "rate_sd_ppm", "moves_ms_per_minute",
                          "phase_ms", "interval_jitter_ms", "on_grid_share", "longest_gap_s"}) {
    EXPECT_TRUE(root["cameras"][0][key].is_null()) << key;
  }
  EXPECT_EQ(root["cameras"][0]["follows"], "unknown");
  EXPECT_THAT(plain(diagnose_document(diagnosis)), HasSubstr("one frame: too few for a diagnosis"));
  EXPECT_THAT(plain(diagnose_document(diagnosis)), Not(HasSubstr("nan")));
}

}  // namespace
}  // namespace simbench::reports
