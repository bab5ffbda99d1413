#include "reports/figures/seed_figures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "tests/nonempty.h"
#include "tests/reports/figures/hand_made_run.h"

namespace simbench::reports {
namespace {

using evaluation::RunDetail;
using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::SizeIs;

TEST(SeedFiguresTest, SynchronisationShowsHostsApartAndTogether) {
  const std::vector<RunDetail> runs = {hand_made_run({0, 0.1}, 2, "yoon2021_both"),
                                       hand_made_run({0, 300}, 2, "ntp_last_set")};
  const Figure figure = synchronisation(runs);
  ASSERT_THAT(figure.panels, SizeIs(2));
  EXPECT_EQ(figure.panels[0].title, "Without: ntp_last_set");
  EXPECT_THAT(figure.panels[0].series[3].y, Each(300.0));
  EXPECT_EQ(figure.panels[1].title, "With: yoon2021_both");
  EXPECT_NEAR(figure.panels[1].series[3].y[0], 0.1, 1e-9);
  EXPECT_EQ(figure.seed, 7U);
}

TEST(SeedFiguresTest, OtherPipelinesStandInForThePapers) {
  std::vector<RunDetail> runs = {hand_made_run({0, 4}, 1, "bad"), hand_made_run({0, 1}, 1, "good")};
  runs[0].score.amd_ms = 4;
  runs[1].score.amd_ms = 1;
  const Figure figure = synchronisation(runs);
  ASSERT_THAT(figure.panels, SizeIs(2));
  EXPECT_EQ(figure.panels[0].title, "Without: bad");
  EXPECT_EQ(figure.panels[1].title, "With: good");
  EXPECT_THAT(figure.caption, HasSubstr("replace them"));
}

TEST(SeedFiguresTest, NoRunsNoFigures) {
  for (const Figure& figure : nonempty(seed_figures({}))) {
    EXPECT_FALSE(figure.absent.empty()) << figure.id;
  }
}

TEST(DigitalClocksTest, RightClocksPhotographEqualReadings) {
  const std::vector<RunDetail> runs = {hand_made_run({0, 0, 0, 0, 0, 0}, 3, "oracle")};
  const Figure figure = digital_clocks(runs);
  ASSERT_THAT(figure.photographs, SizeIs(1));
  ASSERT_THAT(figure.photographs[0].photographs, SizeIs(6));
  const Photograph& first = figure.photographs[0].photographs[0];
  for (const Photograph& photograph : figure.photographs[0].photographs) {
    ASSERT_EQ(photograph.readings.size(), first.readings.size());
    EXPECT_EQ(photograph.readings[0].text, first.readings[0].text);
  }
  // Six hosts, a camera of each.
  EXPECT_EQ(figure.photographs[0].photographs[5].label, "host 5, camera 15");
}

TEST(DigitalClocksTest, AClockThatIsTwoFramesAheadPhotographsThePast) {
  const std::vector<RunDetail> runs = {hand_made_run({0, 2 * kPeriodMs}, 1, "ntp_last_set")};
  const Figure figure = digital_clocks(runs);
  const std::vector<Photograph>& photographs = figure.photographs.at(0).photographs;
  // Pulse 8 is in the middle: exposed from 159 to 161 ms. Pulse 6: from 119 to 121 ms.
  EXPECT_EQ(photographs.at(0).readings.at(0).text, "00:00.158");
  EXPECT_EQ(photographs.at(1).readings.at(0).text, "00:00.116");
}

TEST(DigitalClocksTest, RowsAreThoseOfThePaperInItsOrder) {
  const std::vector<RunDetail> runs = {
      hand_made_run({0}, 1, "ntp_w32time"), hand_made_run({0}, 1, "other"),
      hand_made_run({0}, 1, "yoon2021_both"), hand_made_run({0}, 1, "genlock")};
  const Figure figure = digital_clocks(runs);
  ASSERT_THAT(figure.photographs, SizeIs(3));
  EXPECT_EQ(figure.photographs[0].label, "genlock");
  EXPECT_EQ(figure.photographs[1].label, "yoon2021_both");
  EXPECT_EQ(figure.photographs[2].label, "ntp_w32time");
  EXPECT_THAT(figure.caption, HasSubstr("8.3 ms"));
}

// Colour is exposed `later_ms` after depth, in frames of its own.
void add_colour(RunDetail& run, double later_ms) {
  for (evaluation::CameraDetail& camera : run.cameras) {
    for (const evaluation::FrameDetail& frame : camera.frames) {
      camera.others.push_back({.sensor_ms = frame.sensor_ms + later_ms,
                               .exposure_start_ms = frame.exposure_start_ms + later_ms,
                               .exposure_end_ms = frame.exposure_end_ms + later_ms});
    }
  }
}

TEST(DigitalClocksTest, ColourHasARowOfItsOwnOfTheNearestFrames) {
  std::vector<RunDetail> runs = {hand_made_run({0, 0}, 1, "yoon2021_both")};
  EXPECT_THAT(digital_clocks(runs).caption, HasSubstr("also has colour frames"));
  add_colour(runs[0], 6);
  const Figure figure = digital_clocks(runs);
  ASSERT_THAT(figure.photographs, SizeIs(2));
  EXPECT_EQ(figure.photographs[0].label, "yoon2021_both in genlock, depth");
  EXPECT_EQ(figure.photographs[1].label, "yoon2021_both in genlock, colour");
  // Pulse 8 is in the middle: depth is exposed from 159 to 161 ms, colour 6 ms later.
  EXPECT_EQ(figure.photographs[0].photographs.at(1).readings.at(0).text, "00:00.158");
  EXPECT_EQ(figure.photographs[1].photographs.at(1).readings.at(0).text, "00:00.158");
  EXPECT_THAT(
      figure.caption,
      HasSubstr("colour: 2 of 2 show 00:00.158 (mostly), middles of the exposures within 0."));
  EXPECT_THAT(figure.lacks, ::testing::IsEmpty());
}

TEST(DigitalClocksTest, AStreamThatNoPulseExposesIsNamed) {
  std::vector<RunDetail> runs = {hand_made_run({0}, 2, "genlock")};
  runs[0].stream = scenarios::StreamKind::kColour;
  for (evaluation::CameraDetail& camera : runs[0].cameras) {
    for (evaluation::FrameDetail& frame : camera.frames) frame.global_ms = evaluation::kNan;
  }
  EXPECT_THAT(digital_clocks(runs).absent,
              HasSubstr("no trigger pulse exposes that stream in genlock; with /evaluation/stream "
                        "\"depth\" both"));
  runs[0].has_truth = false;
  EXPECT_THAT(digital_clocks(runs).absent, HasSubstr("simbench record --scenario"));
}

TEST(DigitalClocksTest, RunsOfSeveralModesStandByMode) {
  using scenarios::SyncMode;
  std::vector<RunDetail> runs;
  for (const auto& [mode, pipeline] :
       {std::pair{SyncMode::kGenlock, "genlock"}, std::pair{SyncMode::kSlave, "yoon2021_both"},
        std::pair{SyncMode::kFullSlave, "ntp_last_set"},
        std::pair{SyncMode::kFullSlave, "yoon2021_both"}}) {
    runs.push_back(hand_made_run({0}, 2, pipeline));
    runs.back().sync_mode = mode;
    add_colour(runs.back(), 1);
  }
  std::vector<std::string> labels;
  for (const PhotographRow& row : digital_clocks(runs).photographs) labels.push_back(row.label);
  EXPECT_THAT(labels,
              ::testing::ElementsAre(
                  "genlock in genlock, depth", "genlock in genlock, colour",
                  "yoon2021_both in slave, depth", "yoon2021_both in slave, colour",
                  "yoon2021_both in full_slave, depth", "yoon2021_both in full_slave, colour",
                  "ntp_last_set in full_slave, depth", "ntp_last_set in full_slave, colour"));
}

TEST(DisplayClockTest, AReadingHoldsForAStep) {
  // Steps begin at 0, 8 1/3, 16 2/3, 25 ms ...
  const auto sharp = display_readings(9, 16);
  ASSERT_THAT(sharp, SizeIs(1));
  EXPECT_EQ(sharp[0].text, "00:00.008");
  EXPECT_EQ(sharp[0].share, 1);
  const auto ghosted = display_readings(22.5, 27.5);
  ASSERT_THAT(ghosted, SizeIs(2));
  EXPECT_EQ(ghosted[0].text, "00:00.016");
  EXPECT_NEAR(ghosted[0].share, 0.5, 1e-9);
  EXPECT_EQ(ghosted[1].text, "00:00.025");
}

TEST(DisplayClockTest, SharesAddUpToOneForAnyExposure) {
  for (const double start_ms : {-70'000.0, -0.001, 0.0, 3.7, 61'234.5, 3'599'999.0}) {
    for (const double length_ms : {0.0, 1e-9, 0.5, 8.4, 33.0, 5000.0}) {
      double sum = 0;
      for (const PhotographedReading& r :
           nonempty(display_readings(start_ms, start_ms + length_ms))) {
        EXPECT_THAT(r.text, SizeIs(9));
        sum += r.share;
      }
      EXPECT_NEAR(sum, 1, 1e-9) << start_ms << " for " << length_ms;
    }
  }
}

}  // namespace
}  // namespace simbench::reports
