#include "reports/figures/run_figures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "reports/figures/host_clock_figure.h"
#include "tests/nonempty.h"
#include "tests/reports/figures/hand_made_run.h"

namespace simbench::reports {
namespace {

using evaluation::RunDetail;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

TEST(RunFiguresTest, IntervalsOfRegularStampsAreThePeriod) {
  const Figure figure = stamp_intervals(hand_made_run({0, 3}, 2));
  ASSERT_THAT(figure.panels, SizeIs(4));
  for (const FigurePanel& panel : figure.panels) {
    ASSERT_THAT(panel.series, SizeIs(1));
    EXPECT_THAT(panel.series[0].y, SizeIs(9));  // between 10 frames
    EXPECT_THAT(panel.series[0].y, Each(kPeriodMs));
    EXPECT_EQ(panel.series[0].x.front(), 4);
    EXPECT_TRUE(panel.x_is_pulse);
  }
  EXPECT_EQ(figure.pipeline, "mine");
  EXPECT_EQ(figure.seed, 7U);
  EXPECT_EQ(figure.paper, "Fig. 2");
}

TEST(RunFiguresTest, ALostFrameIsAGapBetweenIntervals) {
  RunDetail run = hand_made_run({0}, 1);
  run.cameras[0].frames.erase(run.cameras[0].frames.begin() + 6);
  const FigureSeries series = stamp_intervals(run).panels[0].series[0];
  ASSERT_THAT(series.y, SizeIs(8));
  EXPECT_TRUE(std::isnan(series.y[2]));  // ends with pulse 7
  EXPECT_EQ(series.x[2], 7);
  EXPECT_EQ(series.y[3], kPeriodMs);
}

TEST(RunFiguresTest, SensorStampsHaveTheirOriginsAndArrivalsCoincide) {
  const Figure figure = stamps(hand_made_run({0, 3}, 3));
  ASSERT_THAT(figure.panels, SizeIs(3));
  ASSERT_THAT(figure.panels[0].series, SizeIs(3));
  for (std::size_t camera = 0; camera < 3; ++camera) {
    EXPECT_EQ(figure.panels[0].series[camera].y.front(),
              3 * kPeriodMs + 1000 * static_cast<double>(camera));
    EXPECT_THAT(figure.panels[2].series[camera].y, Each(0.0));
  }
}

TEST(RunFiguresTest, TheOffsetOfAHostSeparatesTheHosts) {
  const Figure figure = hosts(hand_made_run({0, 2.5}, 3));
  ASSERT_THAT(figure.panels, SizeIs(2));
  EXPECT_THAT(figure.panels[0].series, SizeIs(3));
  ASSERT_THAT(figure.panels[1].series, SizeIs(6));
  for (std::size_t camera = 0; camera < 6; ++camera) {
    EXPECT_THAT(figure.panels[1].series[camera].y, Each(camera < 3 ? 0.0 : 2.5));
    EXPECT_EQ(figure.panels[1].series[camera].colour, camera < 3 ? 0 : 1);
  }
}

// Host 1's clock is 2.5 ms ahead; its exposures are 3 ms longer and their middles 1.5 ms later; its
// stamps are another 0.25 ms later.
TEST(RunFiguresTest, TheCaptionOfHostsSaysWhatTheirDistanceConsistsOf) {
  RunDetail run = hand_made_run({0, 2.5}, 2);
  for (std::size_t camera = 2; camera < 4; ++camera) {
    for (evaluation::FrameDetail& frame : run.cameras[camera].frames) {
      frame.exposure_end_ms += 3;
      frame.reference_ms += 1.5;
      frame.own_host_ms += 1.5;
      frame.global_ms += 1.75;
    }
  }
  EXPECT_THAT(
      hosts(run).caption,
      HasSubstr("the stamps of one host lie within 0; hosts 0 and 1, the farthest, are 4.25 "
                "ms apart: +2.50 ms by their clocks, +1.50 ms by the middles of their "
                "exposures (2.00 ms and 5.00 ms long), +0.250 ms by the delay from there "
                "to the stamp."));
  run.has_truth = false;
  EXPECT_THAT(hosts(run).caption, HasSubstr("nothing tells clocks from exposures"));
}

TEST(RunFiguresTest, AStampThatIsACopyIsNotDrawnAndSaidToLack) {
  RunDetail run = hand_made_run({0}, 1);
  for (evaluation::FrameDetail& frame : run.cameras[0].frames) {
    frame.backend_ms = frame.arrival_ms;
    frame.frame_ms = frame.sensor_ms;
  }
  const Figure figure = stamp_intervals(run);
  ASSERT_THAT(figure.panels, SizeIs(2));
  EXPECT_THAT(figure.caption, HasSubstr("frame none, back-end none, arrival"));
  EXPECT_EQ(std::ranges::count(figure.lacks, false, &FigureLack::was_recorded), 2);
}

TEST(RunFiguresTest, JumpsAreCountedAndTheirLackIsStated) {
  RunDetail run = hand_made_run({0}, 1);
  EXPECT_THAT(stamp_intervals(run).caption, HasSubstr("also has rare large jumps"));
  run.cameras[0].frames[7].arrival_ms += 5;
  const Figure figure = stamp_intervals(run);
  EXPECT_THAT(figure.caption, HasSubstr("1 of 9 arrival intervals"));
  EXPECT_THAT(figure.lacks, IsEmpty());
}

TEST(RunFiguresTest, ARigOfOneHostHasOnePanelOfHostsAndNoClocksToDraw) {
  const RunDetail run = hand_made_run({0}, 1);
  EXPECT_THAT(hosts(run).panels, SizeIs(1));
  EXPECT_THAT(hosts(run).caption, HasSubstr("also has a second host with cameras"));
  EXPECT_THAT(host_clocks(run).absent, HasSubstr("one host"));
  EXPECT_THAT(host_clocks(run).panels, IsEmpty());
}

TEST(RunFiguresTest, FirstSecondsBeginWithTheWarmUp) {
  const Figure figure = first_seconds(hand_made_run({0}, 2));
  ASSERT_THAT(figure.panels, SizeIs(1));
  const FigurePanel& panel = figure.panels[0];
  ASSERT_THAT(panel.series, SizeIs(2));
  EXPECT_NEAR(panel.series[0].x.front(), kPeriodMs / 1000, 1e-12);
  EXPECT_THAT(panel.series[0].y, Each(kPeriodMs));
  ASSERT_THAT(panel.spans, SizeIs(1));
  EXPECT_NEAR(panel.spans[0].to, 3 * kPeriodMs / 1000, 1e-12);
}

// The second camera exposes 0.5 ms later than the first, the third 0.25 ms earlier and lacks a
// frame.
TEST(RunFiguresTest, ExposuresAreDrawnAgainstTheFirstCamera) {
  RunDetail run = hand_made_run({0}, 3);
  for (std::size_t camera = 1; camera < 3; ++camera) {
    for (evaluation::FrameDetail& frame : run.cameras[camera].frames) {
      frame.exposure_start_ms += camera == 1 ? 0.5 : -0.25;
      frame.exposure_end_ms += camera == 1 ? 0.5 : -0.25;
    }
  }
  run.cameras[2].frames.erase(run.cameras[2].frames.begin() + 5);
  const Figure figure = exposures(run);
  ASSERT_THAT(figure.panels, SizeIs(2));
  ASSERT_THAT(figure.panels[0].series, SizeIs(2));
  const FigurePanel& spread = figure.panels[1];
  ASSERT_THAT(spread.series, SizeIs(1));
  const std::size_t frames = run.cameras[0].frames.size();
  ASSERT_THAT(spread.series[0].y, SizeIs(frames));
  for (std::size_t i = 0; i < frames; ++i) {
    EXPECT_NEAR(figure.panels[0].series[0].y[i], 0.5, 1e-9);
    if (i == 5) {
      EXPECT_TRUE(std::isnan(figure.panels[0].series[1].y[i]));
      EXPECT_TRUE(std::isnan(spread.series[0].y[i]));
    } else {
      EXPECT_NEAR(figure.panels[0].series[1].y[i], -0.25, 1e-9);
      EXPECT_NEAR(spread.series[0].y[i], 0.75, 1e-9);
    }
  }
  EXPECT_FALSE(spread.log_y);
  ASSERT_THAT(spread.spans, SizeIs(1));
  EXPECT_EQ(spread.spans[0].label, "warm-up");
  run.has_truth = false;
  EXPECT_THAT(exposures(run).absent, HasSubstr("simulated world"));
  EXPECT_THAT(exposures(hand_made_run({0}, 1)).absent, HasSubstr("two cameras"));
}

TEST(RunFiguresTest, ClocksAreDrawnOverAllOfTheRunAndAfterSynchronisation) {
  RunDetail run = hand_made_run({0, 2}, 1);
  run.world_start_ms = -100;
  run.sync_end_ms = -50;
  for (double at_ms = -100; at_ms <= 260; at_ms += 10) {
    run.clocks.push_back({at_ms, {0, at_ms < -50 ? 300.0 : 2.0}});
  }
  const Figure figure = host_clocks(run);
  ASSERT_THAT(figure.panels, SizeIs(2));
  ASSERT_THAT(figure.panels[0].series, SizeIs(1));  // the master's is not drawn
  EXPECT_EQ(figure.panels[0].series[0].y.front(), 300);
  EXPECT_THAT(figure.panels[1].series[0].y, Each(2.0));
  ASSERT_THAT(figure.panels[0].spans, SizeIs(3));
  EXPECT_EQ(figure.panels[0].spans[0].label, "synchronisation");
  EXPECT_EQ(figure.panels[0].spans[0].to, -0.05);
  EXPECT_EQ(figure.panels[1].spans[0].label, "warm-up");
}

TEST(RunFiguresTest, GatheringTellsWhatBecameOfEveryFrame) {
  RunDetail run = hand_made_run({0}, 3);
  run.cameras[1].frames.erase(run.cameras[1].frames.begin() + 12);
  run.lost.push_back({.camera = 1, .counter = 12, .pulse = 12});
  run.sets.pop_back();
  run.sets.back().pure = false;  // pulse 11
  const Figure figure = gathering(run);
  ASSERT_THAT(figure.panels, SizeIs(2));
  std::vector<std::pair<double, double>> mixed;
  std::vector<std::pair<double, double>> left_over;
  std::vector<std::pair<double, double>> dropped;
  int lines = 0;
  for (const FigureSeries& series : nonempty(figure.panels[0].series)) {
    if (series.mark == Mark::kLine) {
      ++lines;
      EXPECT_THAT(series.x, ElementsAre(2.5, 10.5));
      continue;
    }
    for (std::size_t i = 0; i < series.x.size(); ++i) {
      const std::pair<double, double> point(series.x[i], series.y[i]);
      if (series.label == "in a set of several pulses") mixed.push_back(point);
      if (series.label == "in no set") left_over.push_back(point);
      if (series.label == "dropped") dropped.push_back(point);
    }
  }
  EXPECT_EQ(lines, 3);
  EXPECT_THAT(mixed, ElementsAre(std::pair(11, 0.3), std::pair(11, 1.3), std::pair(11, 2.3)));
  EXPECT_THAT(left_over, ElementsAre(std::pair(12, -0.3), std::pair(12, 1.7)));
  EXPECT_THAT(dropped, ElementsAre(std::pair(12, 1.3)));
}

TEST(RunFiguresTest, WithoutTruthStampsAreComparedWithTheirMedian) {
  RunDetail run = hand_made_run({0, 1, 5}, 1);
  run.has_truth = false;
  const Figure figure = hosts(run);
  EXPECT_THAT(figure.panels[1].series[0].y, Each(-1.0));
  EXPECT_THAT(figure.panels[1].series[1].y, Each(0.0));
}

TEST(RunFiguresTest, FreeRunningFramesAreDrawnAgainstTheirNumber) {
  RunDetail run = hand_made_run({0, 2}, 1);
  run.has_pulses = false;
  for (evaluation::CameraDetail& camera : run.cameras) {
    for (evaluation::FrameDetail& frame : camera.frames) {
      frame.pulse = -1;
      frame.evaluated = false;
    }
  }
  const Figure figure = hosts(run);
  EXPECT_EQ(figure.panels[1].x_label, "frame");
  EXPECT_FALSE(figure.panels[1].x_is_pulse);
  EXPECT_THAT(figure.panels[1].series[1].y, Each(2.0));
}

TEST(RunFiguresTest, ARunWithoutFramesSaysSo) {
  RunDetail run = hand_made_run({0, 1}, 1);
  for (evaluation::CameraDetail& camera : run.cameras) camera.frames.clear();
  run.sets.clear();
  for (const Figure& figure : nonempty(run_figures(run))) {
    EXPECT_FALSE(figure.absent.empty()) << figure.id;
    EXPECT_THAT(figure.panels, IsEmpty()) << figure.id;
  }
}

}  // namespace
}  // namespace simbench::reports
