#include "recording/recorded_stream_sink.h"

#include <gtest/gtest.h>

namespace simbench {
namespace {

FrameRecord stamped_frame(std::uint32_t camera, StreamKind kind, std::uint32_t counter) {
  FrameRecord frame;
  frame.camera = camera;
  frame.stream = kind;
  frame.counter = counter;
  frame.sensor = DeviceStamp{4'000'000'000U + counter};
  frame.arrival_steady = SteadyTime(std::chrono::milliseconds(10 * counter));
  return frame;
}

TEST(CameraStreams, AreThoseOfTheCapture) {
  RecordedStreamSink sink({.hosts = {"pc"}, .cameras = {"left"}});
  sink.on_start({.hosts = 2, .cameras = {{0}, {1}}});
  sink.on_frame(stamped_frame(1, StreamKind::kDepth, 7), nullptr);
  sink.on_frame(stamped_frame(0, StreamKind::kColour, 3), nullptr);
  sink.on_frame(stamped_frame(1, StreamKind::kDepth, 8), nullptr);
  const std::vector<RecordedStream> streams = sink.take();
  ASSERT_EQ(streams.size(), 2U);
  EXPECT_EQ(streams[0].camera, "camera1");
  EXPECT_EQ(streams[0].host, "host1");
  EXPECT_EQ(streams[0].stream, "depth");
  EXPECT_EQ(streams[1].camera, "left");
  EXPECT_EQ(streams[1].host, "pc");
  EXPECT_EQ(streams[1].stream, "colour");
  ASSERT_EQ(streams[0].frames.size(), 2U);
  EXPECT_EQ(streams[0].frames[1].counter, 8U);
  EXPECT_EQ(streams[0].frames[1].sensor.count(), 4'000'000'008'000);
  EXPECT_EQ(streams[0].frames[1].arrival.count(), 80'000'000);
}

TEST(CameraStreams, ACaptureWithoutFramesHasNone) {
  RecordedStreamSink sink({});
  sink.on_start({.hosts = 1, .cameras = {{0}}});
  EXPECT_TRUE(sink.take().empty());
}

}  // namespace
}  // namespace simbench
