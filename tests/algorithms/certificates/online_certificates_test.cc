#include "algorithms/certificates/online_certificates.h"

#include <gtest/gtest.h>

#include <array>

namespace simbench {
namespace {

CertifiedRig exact_rig(std::uint32_t hosts, std::vector<std::uint32_t> host_of_camera) {
  return {.hosts = hosts,
          .host_of_camera = std::move(host_of_camera),
          .host_rate_ppm = 0,
          .camera_rate_ppm = 0,
          .host_stamp_error = Nanoseconds(0),
          .sensor_stamp_error = Nanoseconds(0)};
}

PollSample poll_us(std::int64_t device, std::int64_t t0, std::int64_t t1) {
  return {.device = DeviceTime(Microseconds(device)),
          .t0_steady = SteadyTime(Microseconds(t0)),
          .t1_steady = SteadyTime(Microseconds(t1))};
}

DeviceTime device_us(std::int64_t us) { return DeviceTime(Microseconds(us)); }

TEST(OnlineCertificates, TwoPollsBoundTwoFrames) {
  OnlineCertificates rig(exact_rig(1, {0, 0}));
  rig.on_poll(0, poll_us(5'000, 1'000, 1'600));
  rig.on_poll(1, poll_us(90'000, 1'000, 1'600));
  const std::array frames = {rig.on_frame(0, device_us(25'000)),
                             rig.on_frame(1, device_us(110'000))};
  // Both round trips, a step of the registers and the nanoseconds of the host's readings.
  EXPECT_EQ(rig.apart(frames), Picoseconds(from_us(602) + Nanoseconds(2)));
  for (const auto& frame : frames) rig.release(frame);
}

TEST(OnlineCertificates, AFrameFromBeforeAReadingIsAsSure) {
  OnlineCertificates rig(exact_rig(1, {0, 0}));
  rig.on_poll(0, poll_us(5'000, 1'000, 1'600));
  rig.on_poll(1, poll_us(90'000, 1'000, 1'600));
  // Exposed 3 ms before the readings, and delivered after them.
  const std::array frames = {rig.on_frame(0, device_us(2'000)), rig.on_frame(1, device_us(87'000))};
  EXPECT_EQ(rig.apart(frames), Picoseconds(from_us(602) + Nanoseconds(2)));
}

TEST(OnlineCertificates, NothingIsKnownOfCamerasThatWereNotRead) {
  OnlineCertificates rig(exact_rig(1, {0, 0}));
  rig.on_poll(0, poll_us(5'000, 1'000, 1'600));
  const std::array frames = {rig.on_frame(0, device_us(5'000)), rig.on_frame(1, device_us(90'000))};
  EXPECT_EQ(rig.apart(frames), ClockGraph::kUnbounded);
}

TEST(OnlineCertificates, ExchangesTieHosts) {
  OnlineCertificates rig(exact_rig(2, {0, 1}));
  for (const std::uint32_t host : {0U, 1U}) rig.on_adjustment({.host = host});
  const auto host_us = [](std::int64_t us) { return HostTime(Microseconds(us)); };
  rig.on_exchange(1, {.peer = 0,
                      .t1 = host_us(1000),
                      .t2 = host_us(1100),
                      .t3 = host_us(1150),
                      .t4 = host_us(1250)});
  rig.on_poll(0, poll_us(70'000, 2'000, 2'000));
  rig.on_poll(1, poll_us(80'000, 2'000, 2'000));
  const std::array frames = {rig.on_frame(0, device_us(70'000)),
                             rig.on_frame(1, device_us(80'000))};
  EXPECT_NEAR(to_ms(rig.apart(frames)), 0.1, 0.003);
}

TEST(OnlineCertificates, AContradictionEndsAllSureness) {
  CertifiedRig narrow = exact_rig(1, {0, 0});
  OnlineCertificates rig(narrow);
  rig.on_poll(0, poll_us(0, 0, 100));
  rig.on_poll(1, poll_us(0, 0, 100));
  const std::array frames = {rig.on_frame(0, device_us(50)), rig.on_frame(1, device_us(50))};
  EXPECT_LT(rig.apart(frames), Picoseconds(from_ms(1)));
  rig.on_poll(0, poll_us(10'003'000, 10'000'000, 10'000'100));
  EXPECT_TRUE(rig.is_contradicted());
  EXPECT_EQ(rig.apart(frames), ClockGraph::kUnbounded);
}

}  // namespace
}  // namespace simbench
