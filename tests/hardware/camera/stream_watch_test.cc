#include "hardware/camera/stream_watch.h"

#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "tests/hardware/camera/camera_values.h"

namespace simbench::hardware {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using EventKind = CameraEvent::Kind;

struct Notified {
  std::vector<CameraEvent> events;
  CameraEventHandler handler() {
    return [this](const CameraEvent& event) { events.push_back(event); };
  }
  std::vector<EventKind> kinds() const {
    std::vector<EventKind> result;
    result.reserve(events.size());
    for (const CameraEvent& event : events) result.push_back(event.kind);
    return result;
  }
};

MonotonicTime watched_at_ms(double ms) { return MonotonicTime(from_ms(1e6 + ms)); }

CameraSettings depth(const std::string& mode, double mode_rate_hz, double trigger_rate_hz = 0) {
  return settings(mode, {stream("depth", mode_rate_hz)}, trigger_rate_hz);
}

CameraFrame watched_frame(std::uint32_t counter, double ms, std::uint32_t zero_us = 0) {
  const auto us = static_cast<std::uint32_t>(static_cast<std::int64_t>(ms * 1000)) + zero_us;
  return {.counter = counter,
          .sensor = {us},
          .frame = {us},
          .backend = std::nullopt,
          .arrived = watched_at_ms(ms)};
}

TEST(StreamWatch, ASteadyStreamIsNoEvent) {
  Notified notified;
  StreamWatch watch(depth("default", 30), false);
  watch.start(watched_at_ms(0));
  for (std::uint32_t i = 0; i < 300; ++i) {
    watch.on_frame(watched_frame(i, 33.3 * i), notified.handler());
    watch.check(watched_at_ms(33.3 * i + 30), notified.handler());
  }
  EXPECT_THAT(notified.events, IsEmpty());
}

TEST(StreamWatch, NeitherTheCountersNorTheStampsWrapIsAnEvent) {
  Notified notified;
  StreamWatch watch(depth("default", 30), false);
  watch.start(watched_at_ms(0));
  for (std::uint32_t i = 0; i < 100; ++i) {
    watch.on_frame(watched_frame(0xffffffffU - 50 + i, 33.3 * i, 0xffffffffU - 1'000'000),
                   notified.handler());
  }
  EXPECT_THAT(notified.events, IsEmpty());
  EXPECT_EQ(watch.lost_frames(), 0U);
}

TEST(StreamWatch, AGapAtTheWrapIsCounted) {
  Notified notified;
  StreamWatch watch(depth("default", 30), false);
  watch.start(watched_at_ms(0));
  watch.on_frame(watched_frame(0xfffffffeU, 0), notified.handler());
  watch.on_frame(watched_frame(2, 133), notified.handler());  // 0xffffffff, 0 and 1 are missing
  EXPECT_EQ(watch.lost_frames(), 3U);
  ASSERT_EQ(notified.kinds(), std::vector{EventKind::kNote});
  EXPECT_THAT(notified.events[0].text, HasSubstr("from 4294967294 to 2: 3 frames lost"));
}

TEST(StreamWatch, ManyGapsAreFewNotes) {
  Notified notified;
  StreamWatch watch(depth("default", 100), false);
  watch.start(watched_at_ms(0));
  for (std::uint32_t i = 0; i < 1000; ++i)
    watch.on_frame(watched_frame(2 * i, 20.0 * i), notified.handler());
  EXPECT_EQ(watch.lost_frames(), 999U);
  ASSERT_EQ(notified.events.size(), 2U);  // 20 s: at the first, and 10 s after that
  EXPECT_THAT(notified.events[1].text, HasSubstr("501 frames lost since the start"));
}

TEST(StreamWatch, AStallIsToldOnceAndItsEndToo) {
  Notified notified;
  StreamWatch watch(depth("default", 30), false);
  watch.start(watched_at_ms(0));
  watch.on_frame(watched_frame(0, 10), notified.handler());
  watch.check(watched_at_ms(1010), notified.handler());
  EXPECT_THAT(notified.events, IsEmpty());  // exactly 1 s
  watch.check(watched_at_ms(1011), notified.handler());
  watch.check(watched_at_ms(5000), notified.handler());
  EXPECT_EQ(notified.kinds(), std::vector{EventKind::kStalled});
  watch.on_frame(watched_frame(1, 6010), notified.handler());
  ASSERT_EQ(notified.kinds(), (std::vector{EventKind::kStalled, EventKind::kNote}));
  EXPECT_THAT(notified.events[1].text, HasSubstr("after 6.0 s"));
  watch.check(watched_at_ms(7020), notified.handler());
  EXPECT_EQ(notified.kinds().back(), EventKind::kStalled);
}

TEST(StreamWatch, ThePatienceIsTenPeriodsOfWhatIsSlower) {
  const auto stalls_at = [](const CameraSettings& wanted, double ms) {
    Notified notified;
    StreamWatch watch(wanted, false);
    watch.start(watched_at_ms(-5));
    watch.on_frame(watched_frame(0, 0), notified.handler());
    watch.check(watched_at_ms(ms), notified.handler());
    return !notified.events.empty();
  };
  EXPECT_FALSE(stalls_at(depth("default", 6), 1660));
  EXPECT_TRUE(stalls_at(depth("default", 6), 1670));
  EXPECT_FALSE(stalls_at(depth("slave", 30, 5), 1999));
  EXPECT_TRUE(stalls_at(depth("slave", 30, 5), 2001));
  EXPECT_TRUE(stalls_at(depth("default", 30, 5), 1001));  // a trigger that nobody follows
}

TEST(StreamWatch, ACameraIsGivenTimeToStart) {
  Notified notified;
  StreamWatch watch(depth("default", 30), false);
  watch.start(watched_at_ms(0));
  watch.check(watched_at_ms(4000), notified.handler());
  EXPECT_THAT(notified.events, IsEmpty());
  watch.check(watched_at_ms(4001), notified.handler());
  ASSERT_EQ(notified.kinds(), std::vector{EventKind::kStalled});
  EXPECT_EQ(notified.events[0].text, "depth: no frame for 4.0 s");
}

TEST(StreamWatch, ACameraThatWaitsForTriggersIsWatchedFromItsFirstFrame) {
  Notified notified;
  StreamWatch watch(depth("genlock", 90, 45), true);
  watch.start(watched_at_ms(0));
  watch.check(watched_at_ms(60'000), notified.handler());
  EXPECT_THAT(notified.events, IsEmpty());
  watch.on_frame(watched_frame(0, 60'010), notified.handler());
  watch.check(watched_at_ms(61'020), notified.handler());
  EXPECT_EQ(notified.kinds(), std::vector{EventKind::kStalled});
}

TEST(StreamWatch, ARestartedCameraIsReported) {
  Notified notified;
  StreamWatch watch(depth("default", 30), false);
  watch.start(watched_at_ms(0));
  watch.on_frame(watched_frame(1000, 0), notified.handler());
  watch.on_frame(watched_frame(0, 33), notified.handler());
  ASSERT_EQ(notified.kinds(), std::vector{EventKind::kNote});
  EXPECT_THAT(notified.events[0].text, HasSubstr("frame counter jumped between frames 1000 and 0"));
  EXPECT_EQ(watch.lost_frames(), 0U);

  Notified clock;
  watch.start(watched_at_ms(0));
  watch.on_frame(watched_frame(0, 0), clock.handler());
  watch.on_frame(watched_frame(1, 33, 1'100'000), clock.handler());
  ASSERT_EQ(clock.kinds(), std::vector{EventKind::kNote});
  EXPECT_THAT(clock.events[0].text, HasSubstr("clock jumped between frames 0 and 1"));
}

TEST(StreamWatch, AStampOfAnotherClockMayJump) {
  Notified notified;
  StreamWatch watch(depth("default", 30), false);
  watch.start(watched_at_ms(0));
  CameraFrame first = watched_frame(0, 0);
  CameraFrame second = watched_frame(1, 33, 5'000'000);
  first.domain = second.domain = StampDomain::kSystemTime;
  watch.on_frame(first, notified.handler());
  watch.on_frame(second, notified.handler());
  EXPECT_THAT(notified.events, IsEmpty());
}

TEST(StreamWatch, DepthAndColourCountForThemselves) {
  Notified notified;
  StreamWatch watch(settings("default", {stream("depth", 30), stream("colour", 30)}), false);
  watch.start(watched_at_ms(0));
  for (std::uint32_t i = 0; i < 60; ++i) {
    watch.on_frame(watched_frame(i, 33.3 * i), notified.handler());
    if (i > 5) continue;
    CameraFrame colour = watched_frame(700 + i, 33.3 * i + 5);
    colour.stream = StreamKind::kColour;
    watch.on_frame(colour, notified.handler());
  }
  watch.check(watched_at_ms(2000), notified.handler());
  ASSERT_EQ(notified.kinds(), std::vector{EventKind::kStalled});
  EXPECT_THAT(notified.events[0].text, HasSubstr("colour: no frame for 1.8 s, the last was 705"));
}

TEST(StreamWatch, MissingMetadataIsToldOnceWithTheCure) {
  Notified notified;
  StreamWatch watch(depth("default", 30), false);
  watch.start(watched_at_ms(0));
  watch.missing_metadata("SENSOR_TIMESTAMP", notified.handler());
  watch.missing_metadata("SENSOR_TIMESTAMP", notified.handler());
  ASSERT_EQ(notified.kinds(), std::vector{EventKind::kMissingMetadata});
  EXPECT_THAT(notified.events[0].text, HasSubstr("lack SENSOR_TIMESTAMP"));
  EXPECT_THAT(notified.events[0].text, HasSubstr("kernel patches"));
  EXPECT_THAT(notified.events[0].text, HasSubstr("FORCE_RSUSB_BACKEND"));
}

}  // namespace
}  // namespace simbench::hardware
