// The page as text; how it looks is tested in a browser (tests/browser/).
#include "reports/page/stability_page.h"

#include <gmock/gmock.h>

#include <string>

namespace simbench::reports {
namespace {

// `ppb` fast, with noise that is the same in every run.
StabilityFinding measured_clock(const std::string& path, double ppb) {
  evaluation::ClockLog log{.path = path, .format = "csv"};
  unsigned state = 1;
  for (int i = 0; i < 300; ++i) {
    state = state * 1664525U + 1013904223U;
    log.points.push_back(
        {Microseconds(1'000'000 * i), 1e-9 * ppb * i + 1e-17 * static_cast<double>(state)});
  }
  return {.log = evaluation::stability_of_log(log, {})};
}

std::string clocks_page(const std::vector<std::string>& limits) {
  StabilityPage page{.findings = {measured_clock("a.csv", 1), measured_clock("b.csv", 5)},
                     .command = {"simbench", "stability", "a.csv", "b.csv"}};
  if (!limits.empty()) page.masks = {evaluation::limits_mask(limits)};
  for (StabilityFinding& finding : page.findings) {
    for (const evaluation::ClockMask& mask : page.masks) {
      finding.verdicts.push_back(evaluation::judge(finding.log.stability, mask));
    }
  }
  return stability_html(page);
}

TEST(StabilityPage, BeginsWithTheVerdictThenTheFigures) {
  const std::string page = clocks_page({"max_te=1us"});
  const std::size_t verdict = page.find("2 verdicts: 1 passed, 1 failed");
  const std::size_t largest = page.find("<dt>Time error</dt>");
  const std::size_t figures = page.find("data-figures=\"time_error stability\"");
  const std::size_t table = page.find("<h3>Time error (TE)</h3>");
  EXPECT_LT(verdict, largest);
  EXPECT_LT(largest, figures);
  EXPECT_LT(figures, table);
  EXPECT_NE(table, std::string::npos);
  EXPECT_NE(page.find("simbench stability a.csv b.csv"), std::string::npos);
}

TEST(StabilityPage, WithoutLimitsItBeginsWithTheTimeError) {
  const std::string page = clocks_page({});
  EXPECT_NE(page.find("Of 2 clocks, b.csv has the largest time error"), std::string::npos);
  EXPECT_EQ(page.find("<dt>Time error</dt>"), std::string::npos);
}

TEST(StabilityPage, DrawsTheEndsOfIntervals) {
  const std::string page = clocks_page({});
  EXPECT_NE(page.find("\"label\":\"a.csv, 95 %\""), std::string::npos);
}

}  // namespace
}  // namespace simbench::reports
