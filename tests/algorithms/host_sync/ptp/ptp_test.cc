#include "algorithms/host_sync/ptp/ptp.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "algorithms/host_sync/ptp/ptp_port.h"
#include "tests/algorithms/host_sync/closed_loop.h"

namespace simbench {
namespace {

constexpr Nanoseconds kPtpLatency{150'000};

TEST(PtpOffsetTest, EndToEndAndPeerDelayFindTheOffset) {
  // Slave 5000 ahead, delay 300 each way.
  PtpOffset filter(10);
  filter.add_request(0, 0, 1);
  EXPECT_FALSE(filter.offset());
  filter.add_sync(1'000'000, 1'000'300 + 5'000);
  EXPECT_FALSE(filter.offset());
  filter.add_request(1'205'000, 1'200'300, 1);
  EXPECT_EQ(filter.offset(), Nanoseconds(5000));
  PtpOffset peer(10);
  peer.add_peer_delay(1'005'000, 1'000'300, 1'000'700, 1'006'000);
  peer.add_sync(2'000'000, 2'000'300 + 5'000);
  EXPECT_EQ(peer.offset(), Nanoseconds(5000));
  peer.forget_sync();
  EXPECT_FALSE(peer.offset());
}

TEST(PtpOffsetTest, ALateRequestDoesNotCountInTheMedian) {
  PtpOffset filter(3);
  filter.add_sync(1000, 1300);
  for (const std::int64_t late : {0, 90'000, 0}) filter.add_request(2000, 2300 + late, 1);
  EXPECT_EQ(filter.offset(), Nanoseconds(0));
}

TEST(PtpOffsetTest, TheRateRatioTakesTheDriftBetweenSyncAndRequestOut) {
  // The slave's clock gains 1e-4 on the master's; between Sync and request pass 0.5 s.
  PtpOffset filter(10);
  filter.add_sync(1'000'000, 1'000'300);
  filter.add_request(501'050'300, 501'000'300 + 300, 1 - 1e-4);
  // Without the ratio the delay would come out some 25 us too short.
  filter.add_sync(2'000'000, 2'000'300);
  EXPECT_NEAR(static_cast<double>(filter.offset()->count()), 0, 4);
}

class PtpTest : public testing::TestWithParam<bool> {};

TEST_P(PtpTest, TheRateOfTheMessagesIsTheSettings) {
  PtpSettings settings;
  settings.is_peer_delay = GetParam();
  settings.sync_interval = settings.delay_interval = from_ms(62.5);
  ScriptWorld world(2);
  world.host(0).stamps_departures = world.host(1).stamps_departures = true;
  world.host(1).offset = from_ms(-400);
  std::size_t from_master = 0;
  std::size_t from_slave = 0;
  world.script_link(0, 1, [&from_master](std::size_t, const Bytes&) {
    ++from_master;
    return std::vector{kPtpLatency};
  });
  world.script_link(1, 0, [&from_slave](std::size_t, const Bytes&) {
    ++from_slave;
    return std::vector{kPtpLatency};
  });
  world.host(1).uniform = 0.5;  // of an interval that is varied from 0 to twice itself
  Ptp sync(settings);
  world.run(sync, from_ms(60e3));
  // Sync and Follow_Up; the answers: Delay_Resp, or Pdelay_Resp and its Follow_Up.
  EXPECT_NEAR(static_cast<double>(from_master), 60 * 16 * (GetParam() ? 4 : 3), 8);
  EXPECT_NEAR(static_cast<double>(from_slave), 60 * 16, 4);
  expect_aligned(world);
}

// The largest correction of a slave's clock after its master's has jumped by 0.5 s: kp of 0.1 asks
// for 50 000 ppm and more.
double largest_correction_ppm(double max_frequency_ppb, const PtpSettings& settings) {
  ScriptWorld world(2);
  world.connect(kPtpLatency);
  world.host(0).stamps_departures = world.host(1).stamps_departures = true;
  world.host(1).max_frequency_ppb = max_frequency_ppb;
  world.host(1).uniform = 0.5;
  world.call_at(from_ms(60e3), [&world] { world.host(0).offset += from_ms(500); });
  Ptp sync(settings);
  world.run(sync, from_ms(70e3));
  double largest = 0;
  for (const double ppb : nonempty(world.host(1).frequencies_ppb)) {
    largest = std::max(largest, std::abs(ppb) / 1e3);
  }
  return largest;
}

TEST(PtpLimits, AClockIsSteeredAsFarAsItGoes) {
  EXPECT_GT(largest_correction_ppm(100e6, {}), 50e3);
  EXPECT_LE(largest_correction_ppm(100e6, {}), 100e3);
  EXPECT_DOUBLE_EQ(largest_correction_ppm(400e3, {}), 400);
  EXPECT_DOUBLE_EQ(largest_correction_ppm(100e6, {.servo_limits = {.max_frequency_ppb = 7e5}}),
                   700);
}

INSTANTIATE_TEST_SUITE_P(EndToEndAndPeerDelay, PtpTest, testing::Bool());

}  // namespace
}  // namespace simbench
