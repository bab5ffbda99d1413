#include "reports/recordings/diagnose_answer.h"

#include <gmock/gmock.h>

#include <cmath>
#include <string>
#include <vector>

#include "reports/page/diagnose_page.h"
#include "reports/recordings/diagnose_figure.h"
#include "tests/reports/whole_text.h"

namespace simbench::reports {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

// A minute of two cameras at 30 Hz on one host; the second is `ppm` slow.
evaluation::Diagnosis two_cameras(double ppm) {
  std::vector<RecordedStream> all = {{"left", "pc", "Depth 0", {}}, {"right", "pc", "Depth 0", {}}};
  for (int i = 0; i < 1800; ++i) {
    const double ms = i * 1000.0 / 30;
    const double late_ms = 9 + i * 7919 % 97 * 0.005;
    const auto counter = static_cast<std::uint64_t>(i);
    all[0].frames.push_back(
        {.counter = counter, .sensor = from_ms(ms), .arrival = from_ms(ms + late_ms)});
    all[1].frames.push_back({.counter = counter,
                             .sensor = from_ms(ms),
                             .arrival = from_ms(ms * (1 + ppm * 1e-6) + late_ms)});
  }
  return evaluation::diagnose(all, {});
}

std::string diagnosis_text(double ppm) { return whole_text(diagnose_answer(two_cameras(ppm))); }

TEST(DiagnoseAnswer, SaysThatTheSyncWorksAndWhatStampsCannotShow) {
  const std::string text = diagnosis_text(0);
  EXPECT_THAT(text, StartsWith("Depth 0: hardware sync works: all 2 cameras"));
  EXPECT_THAT(text, HasSubstr("No camera's stamps slip by whole frames; no frame is missing."));
  EXPECT_THAT(text, HasSubstr("These stamps show frame periods to "));
  EXPECT_THAT(text, HasSubstr("Stamps alone cannot show whether the exposures coincide, nor which "
                              "frames belong together."));
  EXPECT_THAT(text, Not(HasSubstr("drifts most")));
}

// 60 ppm are 3.6 ms a minute: 33.3 ms within 9.26 minutes. Either of two cameras may be the one.
TEST(DiagnoseAnswer, NamesTheCameraThatDrifts) {
  const std::string text = diagnosis_text(60);
  EXPECT_THAT(text, HasSubstr("hardware sync does not work, because free-running"));
  EXPECT_THAT(text, HasSubstr("drifts most: "));
  EXPECT_THAT(text, testing::ContainsRegex("3.60 ms a minute .* whole frame within 9.26 minutes"));
}

// Ten minutes in which the second stream of the camera is 1000 ppm slow, by their one clock. Two
// periods of the first have no frame, which its counter did not count.
TEST(DiagnoseAnswer, NamesStreamsThatRunFreeAndPeriodsWithoutAFrame) {
  std::vector<RecordedStream> all = {{"cam", "pc", "depth", {}}, {"cam", "pc", "rgb", {}}};
  std::uint64_t counter = 0;
  for (int i = 0; i < 18'000; ++i) {
    const double ms = i * 1000.0 / 30;
    const double late_ms = 9 + i * 7919 % 97 * 0.005;
    const double slow_ms = ms * (1 + 1000e-6);
    all[1].frames.push_back({.counter = static_cast<std::uint64_t>(i),
                             .sensor = from_ms(slow_ms),
                             .arrival = from_ms(slow_ms + late_ms)});
    if (i == 700 || i == 900) continue;
    all[0].frames.push_back(
        {.counter = counter++, .sensor = from_ms(ms), .arrival = from_ms(ms + late_ms)});
  }
  const std::string text = whole_text(diagnose_answer(evaluation::diagnose(all, {})));
  // 1000 ppm of a minute by the slow stream's stamps: 60 ms / 1.001.
  EXPECT_THAT(text,
              StartsWith("Camera cam: rgb does not follow depth: it runs free, its offset drifts "
                         "59.9 ms per minute (+999 ppm)."));
  EXPECT_THAT(text,
              HasSubstr("But 2 periods are without a frame, most of camera cam: never exposed."));
  EXPECT_THAT(text, Not(HasSubstr("no frame is missing")));
}

TEST(DiagnoseAnswer, WithoutCamerasThereIsNothingToSay) {
  EXPECT_EQ(paragraphs(diagnose_answer({})).front(), "There is no camera.");
}

TEST(DiagnoseFigure, ADriftIsALineAndATriggerIsLevel) {
  const evaluation::Diagnosis diagnosis = two_cameras(60);
  const Figure figure = diagnose_figure(diagnosis);
  ASSERT_EQ(figure.panels.size(), 2U);
  const FigurePanel& phases = figure.panels[0];
  ASSERT_EQ(phases.series.size(), 2U);
  const auto moved = [&phases](std::size_t i) {
    return phases.series[i].y.back() - phases.series[i].y.front();
  };
  // Over the 55 s that count; one of the two is the standard.
  EXPECT_NEAR(std::abs(moved(1) - moved(0)), 60e-6 * 55'000, 0.15);
  EXPECT_NEAR(std::min(std::abs(moved(0)), std::abs(moved(1))), 0, 0.05);
  // The lateness is spread evenly over 0.48 ms.
  EXPECT_EQ(figure.panels[1].categories, (std::vector<std::string>{"left", "right"}));
  for (const double jitter : figure.panels[1].series[0].y) EXPECT_NEAR(jitter, 0.9 * 0.48, 0.02);
}

TEST(DiagnoseFigure, IsAbsentWithoutAPeriod) {
  EXPECT_NE(diagnose_figure({}).absent, "");
  EXPECT_TRUE(diagnose_figure({}).panels.empty());
}

TEST(DiagnosePage, BeginsWithTheAnswerAndEscapesNames) {
  const std::string page = diagnose_html({.diagnosis = two_cameras(60),
                                          .inputs = {"<b>.csv"},
                                          .command = {"simbench", "diagnose", "<b>.csv"}});
  EXPECT_EQ(page.find("<b>"), std::string::npos);
  const std::size_t answer = page.find("class=\"answer\"");
  const std::size_t figure = page.find("data-figures=\"phases\"");
  const std::size_t table = page.find("<h3>The cameras</h3>");
  EXPECT_LT(answer, figure);
  EXPECT_LT(figure, table);
  EXPECT_NE(table, std::string::npos);
}

}  // namespace
}  // namespace simbench::reports
