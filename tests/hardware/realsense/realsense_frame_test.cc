#include "hardware/realsense/realsense_frame.h"

#include <gmock/gmock.h>

#include <cstdint>
#include <vector>

#include "tests/hardware/realsense/software_camera.h"

namespace simbench::hardware {
namespace {

constexpr double kWallMs = 1.7e12 + 5;

// What read_frame makes of the frames that are injected.
class RealsenseFrame : public ::testing::Test {
 protected:
  RealsenseFrame() {
    camera_.depth.open(camera_.depth_profiles.front());
    camera_.depth.start([this](const rs2::frame& frame) {
      read_.push_back(read_frame(frame, {MonotonicTime(from_ms(9000)), kWallMs}, 1));
    });
  }
  ~RealsenseFrame() override {
    camera_.depth.stop();
    camera_.depth.close();
  }

  SoftwareCamera camera_;
  std::vector<ReadFrame> read_;
};

TEST_F(RealsenseFrame, AllStampsAreRead) {
  camera_.set_all(77, 1'000'000, 1'036'767);
  camera_.set(RS2_FRAME_METADATA_BACKEND_TIMESTAMP, 1'700'000'000'000);
  camera_.inject(1036.767);
  ASSERT_EQ(read_.size(), 1U);
  const CameraFrame& frame = read_[0].frame;
  EXPECT_EQ(read_[0].missing, "");
  EXPECT_EQ(frame.stream, StreamKind::kDepth);
  EXPECT_EQ(frame.domain, StampDomain::kHardwareClock);
  EXPECT_EQ(frame.counter, 77U);
  EXPECT_EQ(frame.exposure_us, 6951U);
  EXPECT_EQ(frame.sensor, DeviceStamp{1'000'000});
  EXPECT_EQ(frame.frame, DeviceStamp{1'036'767});
  EXPECT_EQ(frame.arrived, MonotonicTime(from_ms(9000)));
  ASSERT_TRUE(frame.backend);
  EXPECT_EQ(*frame.backend, MonotonicTime(from_ms(8995)));
}

TEST_F(RealsenseFrame, StampsWrapAsTheRegisterDoes) {
  camera_.set_all(1, 0xffff'fff0, 0x1'0000'0010);
  camera_.inject();
  camera_.set_all(2, 0x1'0000'8225, 0x1'0000'8245);
  camera_.inject();
  ASSERT_EQ(read_.size(), 2U);
  EXPECT_EQ(read_[0].frame.sensor, DeviceStamp{0xffff'fff0});
  EXPECT_EQ(read_[0].frame.frame, DeviceStamp{0x10});
  EXPECT_EQ(read_[1].frame.sensor.us - read_[0].frame.sensor.us, 0x8235U);
}

TEST_F(RealsenseFrame, WithoutMetadataTheFramesOwnNumbersStandIn) {
  camera_.inject(4294968.296, RS2_TIMESTAMP_DOMAIN_HARDWARE_CLOCK, 42);
  ASSERT_EQ(read_.size(), 1U);
  EXPECT_EQ(read_[0].missing, "SENSOR_TIMESTAMP");
  EXPECT_EQ(read_[0].frame.counter, 42U);
  EXPECT_EQ(read_[0].frame.frame, DeviceStamp{1000});  // 4294967.296 ms is the wrap
  EXPECT_EQ(read_[0].frame.sensor, DeviceStamp{1000});
  EXPECT_EQ(read_[0].frame.exposure_us, 0U);
  EXPECT_FALSE(read_[0].frame.backend);
}

TEST_F(RealsenseFrame, WithoutASensorStampTheFrameStampStandsIn) {
  camera_.set(RS2_FRAME_METADATA_FRAME_TIMESTAMP, 5000);
  camera_.inject(7);
  EXPECT_EQ(read_.at(0).missing, "SENSOR_TIMESTAMP");
  EXPECT_EQ(read_[0].frame.sensor, DeviceStamp{5000});
}

TEST_F(RealsenseFrame, WithoutAFrameStampTheTimestampStandsIn) {
  camera_.set(RS2_FRAME_METADATA_SENSOR_TIMESTAMP, 5000);
  camera_.inject(7);
  EXPECT_EQ(read_.at(0).missing, "FRAME_TIMESTAMP");
  EXPECT_EQ(read_[0].frame.sensor, DeviceStamp{5000});
  EXPECT_EQ(read_[0].frame.frame, DeviceStamp{7000});
}

TEST_F(RealsenseFrame, ABackendStampThatCannotBeIsNone) {
  camera_.set_all(1, 1000, 2000);
  const double first = kWallMs - 5;
  for (const double ms : {0.0, first - 1996, first - 1995, first + 5, first + 6}) {
    camera_.set(RS2_FRAME_METADATA_BACKEND_TIMESTAMP, static_cast<std::int64_t>(ms));
    camera_.inject();
  }
  ASSERT_EQ(read_.size(), 5U);
  EXPECT_FALSE(read_[0].frame.backend);  // the RSUSB backend
  EXPECT_FALSE(read_[1].frame.backend);  // over two seconds ago
  EXPECT_EQ(read_[2].frame.backend, MonotonicTime(from_ms(7000)));
  EXPECT_EQ(read_[3].frame.backend, MonotonicTime(from_ms(9000)));
  EXPECT_FALSE(read_[4].frame.backend);  // after the arrival
}

TEST_F(RealsenseFrame, TheDomainIsTheFrames) {
  camera_.set_all(1, 1000, 2000);
  camera_.inject(2, RS2_TIMESTAMP_DOMAIN_HARDWARE_CLOCK);
  camera_.inject(2, RS2_TIMESTAMP_DOMAIN_SYSTEM_TIME);
  camera_.inject(2, RS2_TIMESTAMP_DOMAIN_GLOBAL_TIME);
  ASSERT_EQ(read_.size(), 3U);
  EXPECT_EQ(read_[0].frame.domain, StampDomain::kHardwareClock);
  EXPECT_EQ(read_[1].frame.domain, StampDomain::kSystemTime);
  EXPECT_EQ(read_[2].frame.domain, StampDomain::kGlobalTime);
}

}  // namespace
}  // namespace simbench::hardware
