#include "sim/rig/capture_reports.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/sim/rig/ideal_scenario.h"
#include "tests/sim/rig/test_world.h"

namespace simbench::sim {
namespace {

// What a program on a host saw of its cameras.
struct SeenReports {
  std::vector<FrameArrival> frames;
  std::vector<SteadyTime> at;
};

Task<void> watch(Host& host, std::vector<SeenReports>& seen) {
  FrameFeed* feed = host.frame_feed();
  if (feed == nullptr) co_return;
  for (;;) {
    const auto frame = co_await feed->next(kNoDeadline);
    seen[host.id()].frames.push_back(*frame);
    seen[host.id()].at.push_back(host.steady_clock().now());
  }
}

Task<void> idle(Host&) { co_return; }

std::vector<FrameRecord> of_host(const scenarios::Scenario& scenario, const KeptLists& kept,
                                 std::int64_t host, StreamKind stream = StreamKind::kDepth) {
  std::vector<FrameRecord> found;
  for (const auto& frame : kept.frames) {
    if (scenario.host_of(frame.record.camera) == host && frame.record.stream == stream) {
      found.push_back(frame.record);
    }
  }
  return found;
}

scenarios::Scenario jittery_scenario() {
  scenarios::Scenario s = ideal_scenario();
  s.cameras.count = 4;
  s.cameras.cameras_per_host = 2;
  s.usb.delivery_jitter_transfers = 0.5;
  return s;
}

TEST(FrameFeeds, EachHostSeesItsOwnCamerasFramesAsTheRecordingHasThem) {
  const scenarios::Scenario s = jittery_scenario();
  std::vector<SeenReports> seen(2);
  Service service([&](Host& host) { return watch(host, seen); });
  KeptLists kept;
  run_world(s, &service, kept);
  for (std::size_t host = 0; host < 2; ++host) {
    const auto frames = of_host(s, kept, static_cast<std::int64_t>(host));
    // The run ends with the delivery of the last frame, before its host can see it.
    ASSERT_GE(frames.size(), 2u * 135);
    ASSERT_GE(seen[host].frames.size(), frames.size() - 1);
    for (std::size_t i = 0; i < seen[host].frames.size(); ++i) {
      const FrameArrival& frame = seen[host].frames[i];
      EXPECT_EQ(frame.camera, frames[i].camera);
      EXPECT_EQ(frame.counter, frames[i].counter);
      EXPECT_EQ(frame.exposure_us, frames[i].exposure_us);
      EXPECT_EQ(frame.sensor, frames[i].sensor);
      EXPECT_EQ(frame.arrival, frames[i].arrival);
      EXPECT_EQ(frame.arrival_steady, frames[i].arrival_steady);
      EXPECT_EQ(seen[host].at[i], frame.arrival_steady) << "seen at the instant of its delivery";
    }
  }
}

TEST(FrameFeeds, OnlyTheScoredStream) {
  scenarios::Scenario s = ideal_scenario();
  s.cameras.streams.push_back(s.cameras.streams[0]);
  s.cameras.streams[1].kind = StreamKind::kColour;
  for (const StreamKind scored : {StreamKind::kDepth, StreamKind::kColour}) {
    s.evaluation.stream = scored;
    std::vector<SeenReports> seen(2);
    Service service([&](Host& host) { return watch(host, seen); });
    KeptLists kept;
    run_world(s, &service, kept);
    const auto frames = of_host(s, kept, 1, scored);
    ASSERT_GE(seen[1].frames.size(), frames.size() - 1);
    for (std::size_t i = 0; i < seen[1].frames.size(); ++i) {
      EXPECT_EQ(seen[1].frames[i].arrival, frames[i].arrival) << to_text(scored);
    }
  }
}

TEST(FrameFeeds, AHostWithoutCamerasHasNone) {
  scenarios::Scenario s = ideal_scenario();
  s.cameras.cameras_per_host = 2;  // both on the master
  std::vector<bool> has_feed(2);
  Service service([&](Host& host) {
    has_feed[host.id()] = host.frame_feed() != nullptr;
    EXPECT_EQ(host.frame_feed(), host.frame_feed());
    return idle(host);
  });
  KeptLists kept;
  run_world(s, &service, kept);
  EXPECT_EQ(has_feed, (std::vector<bool>{true, false}));
}

Task<void> sleep_then_collect(Host& host, std::vector<FrameArrival>& frames) {
  FrameFeed* feed = host.frame_feed();
  co_await host.sleep_for(from_ms(35'000));
  while (const auto frame = co_await feed->next(host.steady_clock().now())) {
    frames.push_back(*frame);
  }
}

TEST(FrameFeeds, KeepsTheLast1024FramesForALateComer) {
  scenarios::Scenario s = ideal_scenario();
  s.hosts.count = 1;
  s.cameras.count = 1;
  s.timeline.frames = 45 * 36;
  std::vector<FrameArrival> frames;
  Service service([&](Host& host) { return sleep_then_collect(host, frames); });
  KeptLists kept;
  run_world(s, &service, kept);
  ASSERT_EQ(frames.size(), 1024u);
  EXPECT_EQ(frames.back().counter - frames.front().counter, 1023u);
  EXPECT_GT(frames.back().counter, 1500u);
}

Task<void> give_up(Host& host, std::vector<SteadyTime>& ends) {
  const SteadyTime begin = host.steady_clock().now();
  const auto none = co_await host.frame_feed()->next(begin + from_ms(50));
  EXPECT_FALSE(none.has_value());
  ends.emplace_back(host.steady_clock().now() - begin);
}

TEST(FrameFeeds, AWaitEndsAtItsDeadline) {
  std::vector<SteadyTime> ends;
  Service service([&](Host& host) { return give_up(host, ends); });
  KeptLists kept;
  run_world(ideal_scenario(), &service, kept);  // the first frame comes after 100 ms
  EXPECT_EQ(ends, std::vector<SteadyTime>(2, SteadyTime(from_ms(50))));
}

Task<void> open_only(Host& host) {
  host.frame_feed();
  co_return;
}

TEST(FrameFeeds, CostNoEventUnlessSomebodyWaits) {
  const scenarios::Scenario s = jittery_scenario();
  Service nothing(idle);
  Service opened(open_only);
  std::vector<SeenReports> seen(2);
  Service watching([&](Host& host) { return watch(host, seen); });
  KeptLists without;
  KeptLists with;
  KeptLists watched;
  const RecordingCost plain = run_world(s, &nothing, without);
  const RecordingCost open = run_world(s, &opened, with);
  const RecordingCost waited = run_world(s, &watching, watched);
  EXPECT_EQ(plain.events, open.events);
  EXPECT_EQ(plain.trace_hash, open.trace_hash);
  // An event for each frame and pulse, and one for each reader of a frame.
  constexpr std::size_t kPulses = 135;
  EXPECT_LE(waited.events, plain.events + 2 * without.frames.size() + kPulses + 10);
  ASSERT_EQ(without.frames.size(), watched.frames.size());
  for (std::size_t i = 0; i < without.frames.size(); ++i) {
    EXPECT_EQ(without.frames[i].record.arrival, watched.frames[i].record.arrival);
  }
}

}  // namespace
}  // namespace simbench::sim
