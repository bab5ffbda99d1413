#include "hardware/camera/stream_watch.h"

#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "tests/hardware/camera/camera_values.h"

namespace simbench::hardware {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using Kind = CameraEvent::Kind;

struct Told {
  std::vector<CameraEvent> events;
  CameraEventHandler handler() {
    return [this](const CameraEvent& event) { events.push_back(event); };
  }
  std::vector<Kind> kinds() const {
    std::vector<Kind> result;
    result.reserve(events.size());
    for (const CameraEvent& event : events) result.push_back(event.kind);
    return result;
  }
};

MonotonicTime at_ms(double ms) { return MonotonicTime(from_ms(1e6 + ms)); }

CameraSettings depth(const std::string& mode, double mode_rate_hz, double trigger_rate_hz = 0) {
  return settings(mode, {stream("depth", mode_rate_hz)}, trigger_rate_hz);
}

CameraFrame watched_frame(std::uint32_t counter, double ms, std::uint32_t zero_us = 0) {
  const auto us = static_cast<std::uint32_t>(static_cast<std::int64_t>(ms * 1000)) + zero_us;
  return {.counter = counter,
          .sensor = {us},
          .frame = {us},
          .backend = std::nullopt,
          .arrived = at_ms(ms)};
}

TEST(StreamWatch, ASteadyStreamIsNoEvent) {
  Told told;
  StreamWatch watch(depth("default", 30), false);
  watch.start(at_ms(0));
  for (std::uint32_t i = 0; i < 300; ++i) {
    watch.on_frame(watched_frame(i, 33.3 * i), told.handler());
    watch.check(at_ms(33.3 * i + 30), told.handler());
  }
  EXPECT_THAT(told.events, IsEmpty());
}

TEST(StreamWatch, NeitherTheCountersNorTheStampsWrapIsAnEvent) {
  Told told;
  StreamWatch watch(depth("default", 30), false);
  watch.start(at_ms(0));
  for (std::uint32_t i = 0; i < 100; ++i) {
    watch.on_frame(watched_frame(0xffffffffU - 50 + i, 33.3 * i, 0xffffffffU - 1'000'000),
                   told.handler());
  }
  EXPECT_THAT(told.events, IsEmpty());
  EXPECT_EQ(watch.lost_frames(), 0U);
}

TEST(StreamWatch, AGapAtTheWrapIsCounted) {
  Told told;
  StreamWatch watch(depth("default", 30), false);
  watch.start(at_ms(0));
  watch.on_frame(watched_frame(0xfffffffeU, 0), told.handler());
  watch.on_frame(watched_frame(2, 133), told.handler());  // 0xffffffff, 0 and 1 are missing
  EXPECT_EQ(watch.lost_frames(), 3U);
  ASSERT_EQ(told.kinds(), std::vector{Kind::kNote});
  EXPECT_THAT(told.events[0].text, HasSubstr("from 4294967294 to 2: 3 frames lost"));
}

TEST(StreamWatch, ManyGapsAreFewNotes) {
  Told told;
  StreamWatch watch(depth("default", 100), false);
  watch.start(at_ms(0));
  for (std::uint32_t i = 0; i < 1000; ++i)
    watch.on_frame(watched_frame(2 * i, 20.0 * i), told.handler());
  EXPECT_EQ(watch.lost_frames(), 999U);
  ASSERT_EQ(told.events.size(), 2U);  // 20 s: at the first, and 10 s after that
  EXPECT_THAT(told.events[1].text, HasSubstr("501 frames lost since the start"));
}

TEST(StreamWatch, AStallIsToldOnceAndItsEndToo) {
  Told told;
  StreamWatch watch(depth("default", 30), false);
  watch.start(at_ms(0));
  watch.on_frame(watched_frame(0, 10), told.handler());
  watch.check(at_ms(1010), told.handler());
  EXPECT_THAT(told.events, IsEmpty());  // exactly 1 s
  watch.check(at_ms(1011), told.handler());
  watch.check(at_ms(5000), told.handler());
  EXPECT_EQ(told.kinds(), std::vector{Kind::kStalled});
  watch.on_frame(watched_frame(1, 6010), told.handler());
  ASSERT_EQ(told.kinds(), (std::vector{Kind::kStalled, Kind::kNote}));
  EXPECT_THAT(told.events[1].text, HasSubstr("after 6.0 s"));
  watch.check(at_ms(7020), told.handler());
  EXPECT_EQ(told.kinds().back(), Kind::kStalled);
}

TEST(StreamWatch, ThePatienceIsTenPeriodsOfWhatIsSlower) {
  const auto stalls_at = [](const CameraSettings& wanted, double ms) {
    Told told;
    StreamWatch watch(wanted, false);
    watch.start(at_ms(-5));
    watch.on_frame(watched_frame(0, 0), told.handler());
    watch.check(at_ms(ms), told.handler());
    return !told.events.empty();
  };
  EXPECT_FALSE(stalls_at(depth("default", 6), 1660));
  EXPECT_TRUE(stalls_at(depth("default", 6), 1670));
  EXPECT_FALSE(stalls_at(depth("slave", 30, 5), 1999));
  EXPECT_TRUE(stalls_at(depth("slave", 30, 5), 2001));
  EXPECT_TRUE(stalls_at(depth("default", 30, 5), 1001));  // a trigger that nobody follows
}

TEST(StreamWatch, ACameraIsGivenTimeToStart) {
  Told told;
  StreamWatch watch(depth("default", 30), false);
  watch.start(at_ms(0));
  watch.check(at_ms(4000), told.handler());
  EXPECT_THAT(told.events, IsEmpty());
  watch.check(at_ms(4001), told.handler());
  ASSERT_EQ(told.kinds(), std::vector{Kind::kStalled});
  EXPECT_EQ(told.events[0].text, "depth: no frame for 4.0 s");
}

TEST(StreamWatch, ACameraThatWaitsForTriggersIsWatchedFromItsFirstFrame) {
  Told told;
  StreamWatch watch(depth("genlock", 90, 45), true);
  watch.start(at_ms(0));
  watch.check(at_ms(60'000), told.handler());
  EXPECT_THAT(told.events, IsEmpty());
  watch.on_frame(watched_frame(0, 60'010), told.handler());
  watch.check(at_ms(61'020), told.handler());
  EXPECT_EQ(told.kinds(), std::vector{Kind::kStalled});
}

TEST(StreamWatch, ARestartedCameraIsTold) {
  Told told;
  StreamWatch watch(depth("default", 30), false);
  watch.start(at_ms(0));
  watch.on_frame(watched_frame(1000, 0), told.handler());
  watch.on_frame(watched_frame(0, 33), told.handler());
  ASSERT_EQ(told.kinds(), std::vector{Kind::kNote});
  EXPECT_THAT(told.events[0].text, HasSubstr("frame counter jumped between frames 1000 and 0"));
  EXPECT_EQ(watch.lost_frames(), 0U);

  Told clock;
  watch.start(at_ms(0));
  watch.on_frame(watched_frame(0, 0), clock.handler());
  watch.on_frame(watched_frame(1, 33, 1'100'000), clock.handler());
  ASSERT_EQ(clock.kinds(), std::vector{Kind::kNote});
  EXPECT_THAT(clock.events[0].text, HasSubstr("clock jumped between frames 0 and 1"));
}

TEST(StreamWatch, AStampOfAnotherClockMayJump) {
  Told told;
  StreamWatch watch(depth("default", 30), false);
  watch.start(at_ms(0));
  CameraFrame first = watched_frame(0, 0);
  CameraFrame second = watched_frame(1, 33, 5'000'000);
  first.domain = second.domain = StampDomain::kSystemTime;
  watch.on_frame(first, told.handler());
  watch.on_frame(second, told.handler());
  EXPECT_THAT(told.events, IsEmpty());
}

TEST(StreamWatch, DepthAndColourCountForThemselves) {
  Told told;
  StreamWatch watch(settings("default", {stream("depth", 30), stream("colour", 30)}), false);
  watch.start(at_ms(0));
  for (std::uint32_t i = 0; i < 60; ++i) {
    watch.on_frame(watched_frame(i, 33.3 * i), told.handler());
    if (i > 5) continue;
    CameraFrame colour = watched_frame(700 + i, 33.3 * i + 5);
    colour.stream = StreamKind::kColour;
    watch.on_frame(colour, told.handler());
  }
  watch.check(at_ms(2000), told.handler());
  ASSERT_EQ(told.kinds(), std::vector{Kind::kStalled});
  EXPECT_THAT(told.events[0].text, HasSubstr("colour: no frame for 1.8 s, the last was 705"));
}

TEST(StreamWatch, MissingMetadataIsToldOnceWithTheCure) {
  Told told;
  StreamWatch watch(depth("default", 30), false);
  watch.start(at_ms(0));
  watch.missing_metadata("SENSOR_TIMESTAMP", told.handler());
  watch.missing_metadata("SENSOR_TIMESTAMP", told.handler());
  ASSERT_EQ(told.kinds(), std::vector{Kind::kMissingMetadata});
  EXPECT_THAT(told.events[0].text, HasSubstr("lack SENSOR_TIMESTAMP"));
  EXPECT_THAT(told.events[0].text, HasSubstr("kernel patches"));
  EXPECT_THAT(told.events[0].text, HasSubstr("FORCE_RSUSB_BACKEND"));
}

}  // namespace
}  // namespace simbench::hardware
