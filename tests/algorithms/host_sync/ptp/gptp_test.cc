#include "algorithms/host_sync/ptp/gptp.h"

#include <gmock/gmock.h>

#include <cmath>
#include <memory>

#include "algorithms/host_sync/ptp/gptp_time.h"
#include "algorithms/host_sync/ptp/ptp_message.h"

namespace simbench {
namespace {

// A neighbour whose clock runs 50 ppm faster, 400 of its nanoseconds away.
PeerDelayExchange peer_exchange_at(std::int64_t t1, std::int64_t held_ns) {
  const double rate = 1 + 50e-6;
  const auto there = [rate](double own) { return std::llround(rate * own); };
  const double flight = 400 / rate;
  const double back = static_cast<double>(t1) + flight + static_cast<double>(held_ns);
  return {.t1 = t1,
          .t2 = there(static_cast<double>(t1) + flight),
          .t3 = there(back),
          .t4 = std::llround(back + flight)};
}

TEST(LinkDelay, TheNeighboursRateTakesTheTimeItHoldsARequestOutOfTheDelay) {
  LinkDelay link(8);
  EXPECT_EQ(link.delay(), std::nullopt);
  link.add(peer_exchange_at(0, 10'000'000));
  EXPECT_EQ(link.rate_ratio(), std::nullopt);
  EXPECT_NEAR(*link.delay(), 400 - 50e-6 * 10e6 / 2, 1) << "without a rate, half of what it gained";
  for (int i = 1; i < 20; ++i) link.add(peer_exchange_at(i * 1'000'000'000L, 10'000'000));
  EXPECT_NEAR(*link.rate_ratio() - 1, 50e-6, 1e-9);
  EXPECT_NEAR(*link.delay(), 400, 1);
}

TEST(LinkDelay, ANeighbourWhoseClockWentBackHasNoRate) {
  LinkDelay link(2);
  link.add({.t1 = 0, .t2 = 5000, .t3 = 6000, .t4 = 1800});
  link.add({.t1 = 10'000, .t2 = 500, .t3 = 600, .t4 = 10'900});
  EXPECT_EQ(link.rate_ratio(), std::nullopt);
}

TEST(GrandmasterTime, GoesOnAtItsRate) {
  const GrandmasterTime time{
      .origin_ns = 1'000, .local_ns = 500, .after_origin_ns = 30.5, .rate = 1 + 1e-3};
  EXPECT_DOUBLE_EQ(time.after_origin_at(2'500), 30.5 + 2'002);
  EXPECT_DOUBLE_EQ(time.ahead_ns(2'500), 1'000 + 30.5 + 2'002 - 2'500);
}

TEST(GrandmasterTime, RateOffsetsAreScaledBy2ToThe41) {
  EXPECT_EQ(scaled_rate_offset(1 + 1e-6), 2'199'023);
  EXPECT_NEAR(rate_of_scaled(scaled_rate_offset(1 - 3.3e-5)), 1 - 3.3e-5, 1e-12);
  EXPECT_EQ(scaled_rate_offset(2), 2'147'483'647) << "as much as the field holds";
}

TEST(GptpMessage, FollowUpHasTheRateInItsInformation) {
  const PtpMessage message{.type = PtpType::kFollowUp,
                           .sender = 3,
                           .sequence = 9,
                           .domain = 20,
                           .is_generalised = true,
                           .scaled_rate_offset = -2};
  Bytes bytes = encode(message);
  ASSERT_EQ(bytes.size(), 76U);
  const auto at = [&bytes](std::size_t i) { return std::to_integer<int>(bytes[i]); };
  EXPECT_EQ(at(0), 0x18);
  EXPECT_EQ(at(3), 76);
  EXPECT_EQ(at(4), 20);
  EXPECT_EQ(at(45), 3) << "ORGANIZATION_EXTENSION";
  EXPECT_EQ(at(47), 28);
  EXPECT_EQ(at(49), 0x80);
  EXPECT_EQ(at(50), 0xc2);
  EXPECT_EQ(at(53), 1);
  EXPECT_EQ(at(57), 0xfe) << "the last of the rate's four bytes";
  EXPECT_EQ(decode_ptp_message(bytes), message);
  bytes[50] = std::byte{0xc3};
  EXPECT_EQ(decode_ptp_message(bytes), std::nullopt) << "of another organisation";
}

}  // namespace
}  // namespace simbench
