#include "reports/stability/stability_report.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <string>

namespace simbench::reports {
namespace {

using Json = nlohmann::ordered_json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

// 20 s of a clock that is 0.25 ms fast, has a step of 8 ms and a gap.
evaluation::LogStability stepped_clock(const std::string& file, bool remove_frequency = false) {
  evaluation::ClockLog log{.path = file, .format = "csv"};
  for (int i = 0; i < 22; ++i) {
    if (i == 16 || i == 17) continue;
    log.points.push_back({Microseconds(1'000'000 * (50 + i)), i < 8 ? 0.25e-3 : 8.25e-3});
  }
  return evaluation::stability_of_log(log, {.remove_frequency = remove_frequency});
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
                          HasSubstr("step of 8 ms at 8 s after the first point")));
  EXPECT_THAT(text, Not(HasSubstr("nan")));
}

TEST(StabilityReport, TwoPointsHaveMtieAlone) {
  const evaluation::ClockLog log{.path = "two.csv",
                                 .format = "csv",
                                 .points = {{Microseconds(0), 0}, {Microseconds(2'000'000), 1e-9}}};
  const evaluation::LogStability two = evaluation::stability_of_log(log, {});
  EXPECT_THAT(plain(stability_table(two.stability)), HasSubstr("2     -     -     -     -  1e-06"));
  EXPECT_EQ(Json::parse(stability_json({two}))["files"][0]["adev"].size(), 0u);
}

TEST(StabilityReport, CsvHasALineForEachValue) {
  const std::string text = stability_csv({stepped_clock("a,b.csv", true)});
  EXPECT_THAT(text, StartsWith("file,format,quantity,tau_s,value,terms\n"
                               "\"a,b.csv\",csv,first_s,,50,\n"));
  EXPECT_THAT(text, AllOf(HasSubstr("\"a,b.csv\",csv,points,,20,\n"),
                          HasSubstr("\"a,b.csv\",csv,mtie_ms,1,"),
                          HasSubstr("\"a,b.csv\",csv,frequency_offset_ppb,,"),
                          HasSubstr("\"a,b.csv\",csv,steps,,1,\n")));
}

TEST(StabilityReport, ManyStepsAreCountedInTextAndAllInJson) {
  evaluation::LogStability many = stepped_clock("a.csv");
  many.stability.steps.assign(25, {.at_s = 3, .step_s = 1e-3});
  EXPECT_THAT(plain(stability_document({many})), HasSubstr("15 more: JSON has all"));
  EXPECT_EQ(Json::parse(stability_json({many}))["files"][0]["steps"].size(), 25u);
}

}  // namespace
}  // namespace simbench::reports
