#include "watch/rig_watch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/watch/watched_rig.h"

namespace simbench::watch {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// All events of a watch that is fed so many pulses at a time.
std::vector<WatchEvent> watched(const WatchedRig& rig, int pulses, int piece, RigWatch& watch) {
  std::vector<WatchEvent> events;
  for (int pulse = 0; pulse < pulses; pulse += piece) {
    watch.add(rig.frames(pulse, std::min(pulse + piece, pulses)));
    for (WatchEvent& event : watch.look()) events.push_back(std::move(event));
  }
  return events;
}

std::vector<WatchEvent> watched(const WatchedRig& rig, int pulses, int piece = 15) {
  RigWatch watch;
  return watched(rig, pulses, piece, watch);
}

std::vector<std::string> outline(const std::vector<WatchEvent>& events) {
  std::vector<std::string> lines;
  for (const WatchEvent& event : events) {
    lines.push_back(event.kind + " " + event.subject + (event.is_alarm ? "" : " over"));
  }
  return lines;
}

TEST(RigWatchTest, ARigInOrderHasNoEvent) {
  for (const double jitter_ms : {0.0, 0.5, 3.0}) {
    for (const double period_ms : {1000.0 / 90, 1000.0 / 30, 200.0}) {
      const WatchedRig rig{.cameras = 6, .period_ms = period_ms, .jitter_ms = jitter_ms};
      EXPECT_THAT(outline(watched(rig, 6000)), IsEmpty()) << jitter_ms << ' ' << period_ms;
    }
  }
}

// It is known with three stretches, 1.5 s, wherever in a stretch it happened.
TEST(RigWatchTest, ASlipIsKnownWithinTwoSeconds) {
  for (int slip = 600; slip < 616; slip += 3) {
    const WatchedRig rig{.later_ms = [slip](std::size_t camera, int pulse) {
      return camera == 1 && pulse >= slip ? 11.0 : 0.0;
    }};
    const std::vector<WatchEvent> events = watched(rig, 900, 1);
    ASSERT_THAT(outline(events), ElementsAre("slipped camera c1")) << slip;
    const double at_s = 10 + slip / 30.0;
    EXPECT_GT(events[0].at_s, at_s);
    EXPECT_LT(events[0].at_s, at_s + 2);
    EXPECT_THAT(events[0].text, HasSubstr("later against the others"));
  }
}

TEST(RigWatchTest, TheReferenceCameraIsBlamedIfItSlips) {
  const WatchedRig rig{.later_ms = [](std::size_t camera, int pulse) {
    return camera == 0 && pulse >= 600 ? -8.0 : 0.0;
  }};
  EXPECT_THAT(outline(watched(rig, 900)), ElementsAre("slipped camera c0"));
}

TEST(RigWatchTest, OfTwoCamerasNobodyIsBlamed) {
  const WatchedRig rig{.cameras = 2, .later_ms = [](std::size_t camera, int pulse) {
                         return camera == 0 && pulse >= 600 ? 8.0 : 0.0;
                       }};
  EXPECT_THAT(outline(watched(rig, 900)), ElementsAre("slipped cameras c0 and c1"));
}

// What all share is no slip: the host's clock is set, or the host is busy.
TEST(RigWatchTest, WhatAllCamerasShareIsNoSlip) {
  const WatchedRig step{
      .cameras = 4, .later_ms = [](std::size_t, int pulse) { return pulse >= 600 ? 20.0 : 0.0; }};
  EXPECT_THAT(outline(watched(step, 1200)), IsEmpty());
  const WatchedRig slew{.cameras = 4,
                        .later_ms = [](std::size_t, int pulse) { return 0.0005 * 33.3 * pulse; }};
  EXPECT_THAT(outline(watched(slew, 6000)), IsEmpty());
}

// 50 ppm of 33 ms: a twentieth of a period is left within 40 s.
TEST(RigWatchTest, ACameraOnItsOwnClockDrifts) {
  const WatchedRig rig{.cameras = 4, .later_ms = [](std::size_t camera, int pulse) {
                         return camera == 2 ? 50e-6 * pulse * 1000 / 30 : 0.0;
                       }};
  RigWatch watch;
  const std::vector<WatchEvent> events = watched(rig, 30 * 120, 15, watch);
  ASSERT_THAT(outline(events), ElementsAre("drifts camera c2"));
  EXPECT_LT(events[0].at_s, 10 + 45);
  EXPECT_GT(watch.cameras()[2].phase.moved_ms(), 3.0);
  EXPECT_TRUE(watch.cameras()[2].drifts);
}

TEST(RigWatchTest, ASilentCameraIsKnownAndComesBack) {
  const WatchedRig rig{.arrives = [](std::size_t camera, int pulse) {
    return camera != 1 || pulse < 600 || pulse >= 900;
  }};
  const std::vector<WatchEvent> events = watched(rig, 1500, 3);
  ASSERT_THAT(outline(events), ElementsAre("silent camera c1", "silent camera c1 over",
                                           "losing camera c1", "losing camera c1 over"));
}

TEST(RigWatchTest, LossesAreCountedByTheCounter) {
  const WatchedRig rig{.arrives = [](std::size_t camera, int pulse) {
    return camera != 2 || pulse < 600 || pulse >= 750 || pulse % 5 != 0;
  }};
  RigWatch watch;
  const std::vector<WatchEvent> events = watched(rig, 1800, 15, watch);
  ASSERT_THAT(outline(events), ElementsAre("losing camera c2", "losing camera c2 over"));
  EXPECT_EQ(watch.cameras()[2].lost, 30);
  EXPECT_EQ(watch.cameras()[0].lost, 0);
}

TEST(RigWatchTest, TheSameFramesGiveTheSameEventsInAnyPieces) {
  const WatchedRig rig{
      .cameras = 5,
      .later_ms =
          [](std::size_t camera, int pulse) {
            return camera == 3 && pulse >= 500 ? 9.0 : camera == 1 ? 1e-3 * pulse : 0.0;
          },
      .arrives = [](std::size_t camera, int pulse) { return camera != 4 || pulse % 17 != 0; }};
  const std::vector<std::string> expected = outline(watched(rig, 3000, 1));
  for (const int piece : {7, 30, 151})
    EXPECT_EQ(outline(watched(rig, 3000, piece)), expected) << piece;
}

TEST(RigWatchTest, MemoryIsBounded) {
  RigWatch watch;
  const WatchedRig rig{.cameras = 2};
  watched(rig, 30 * 600, 300, watch);
  for (const WatchedCamera& camera : watch.cameras()) {
    EXPECT_LE(camera.kept.size(), 30 * kKeptS + 2);
    EXPECT_LE(camera.losses.size(), 1u);
    EXPECT_EQ(camera.frames, 30 * 600);
  }
}

}  // namespace
}  // namespace simbench::watch
