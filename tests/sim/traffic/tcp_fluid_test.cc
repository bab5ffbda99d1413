#include "sim/traffic/tcp_fluid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/nonempty.h"
#include "tests/sim/at_ms.h"

namespace simbench::sim {
namespace {

constexpr double kGigabit = 0.125;  // bytes/ns
constexpr std::uint64_t kTcpSeed = 11;

FluidConnection connection_of(std::vector<std::size_t> data, std::vector<std::size_t> acks) {
  return {
      .data_ports = std::move(data), .ack_ports = std::move(acks), .base_round_trip = from_us(80)};
}

// Hosts 0 and 1 send to host 2; ports 0 to 2 are the hosts', 3 to 5 the switch's.
TcpFluid two_senders(std::uint64_t seed = kTcpSeed) {
  std::vector<FluidPort> ports(3, {.bytes_per_ns = kGigabit});
  ports.resize(6, {.bytes_per_ns = kGigabit, .buffer_bytes = 128e3});
  return TcpFluid(ports, {connection_of({0, 5}, {2, 3}), connection_of({1, 5}, {2, 4})}, {}, seed);
}

TEST(TcpFluidTest, ALoneConnectionQueuesInItsHostAsFarAsItMay) {
  TcpFluid fluid(
      {{.bytes_per_ns = kGigabit}, {.bytes_per_ns = kGigabit, .buffer_bytes = 128e3}},
      {{.data_ports = {0, 1}, .connection_bytes = 100e3, .base_round_trip = from_us(80)}}, {},
      kTcpSeed);
  for (int ms = 1000; ms < 20'000; ms += 13) {
    ASSERT_NEAR(1e3 * to_ms(fluid.delay(0, at_ms(ms))), 100e3 / kGigabit / 1e3, 1) << ms;
    ASSERT_EQ(fluid.delay(1, at_ms(ms)), Nanoseconds(0)) << ms;
    ASSERT_EQ(fluid.loss_share(1, at_ms(ms)), 0) << ms;
  }
}

TEST(TcpFluidTest, NoQueueBeforeTheBeginAndAfterTheEnd) {
  FluidConnection first = connection_of({0, 5}, {2, 3});
  FluidConnection second = connection_of({1, 5}, {2, 4});
  first.begin = second.begin = at_ms(1000);
  first.end = second.end = at_ms(3000);
  std::vector<FluidPort> ports(3, {.bytes_per_ns = kGigabit});
  ports.resize(6, {.bytes_per_ns = kGigabit, .buffer_bytes = 128e3});
  TcpFluid fluid(ports, {first, second}, {}, kTcpSeed);
  EXPECT_EQ(fluid.delay(5, at_ms(-500)), Nanoseconds(0));
  EXPECT_EQ(fluid.delay(5, at_ms(999)), Nanoseconds(0));
  EXPECT_GT(fluid.delay(5, at_ms(2500)), from_us(300));
  EXPECT_EQ(fluid.delay(5, at_ms(3001)), Nanoseconds(0));
  EXPECT_EQ(fluid.delay(5, at_ms(1e9)), Nanoseconds(0));
}

TEST(TcpFluidTest, TheQueueStaysWithinTheBuffer) {
  TcpFluid fluid = two_senders();
  double losses = 0;
  for (int ms = 0; ms < 10'000; ++ms) {
    ASSERT_LE(1e3 * to_ms(fluid.delay(5, at_ms(ms))), 128e3 / kGigabit / 1e3) << ms;
    ASSERT_GE(fluid.delay(5, at_ms(ms)), Nanoseconds(0)) << ms;
    losses += fluid.loss_share(5, at_ms(ms)) / 10'000;
  }
  EXPECT_GT(losses, 1e-4);
  EXPECT_LT(losses, 1e-2);
}

TEST(TcpFluidTest, OthersTakeTheirShareAndTheBufferStaysAsLong) {
  std::vector<FluidPort> ports(3, {.bytes_per_ns = kGigabit});
  ports.resize(6, {.bytes_per_ns = kGigabit, .buffer_bytes = 128e3});
  TcpFluid fluid(ports, {connection_of({0, 5}, {2, 3})}, {{.port = 5, .share = 0.5}}, kTcpSeed);
  Nanoseconds longest{0};
  for (int ms = 1000; ms < 5000; ++ms) longest = std::max(longest, fluid.delay(5, at_ms(ms)));
  EXPECT_NEAR(1e3 * to_ms(longest), 128e3 / kGigabit / 1e3, 40);
  // It cannot fill its own host's port.
  EXPECT_EQ(fluid.delay(0, at_ms(5000)), Nanoseconds(0));
}

TEST(TcpFluidTest, DoesNotDependOnWhatIsAsked) {
  TcpFluid often = two_senders();
  TcpFluid seldom = two_senders();
  TcpFluid other = two_senders(kTcpSeed + 1);
  bool differs = false;
  for (int i = 1; i < 50'000; ++i) {
    const TrueTime at = at_ms(0.1 * i);
    const Nanoseconds delay = often.delay(5, at);
    if (i % 997 != 0) continue;
    ASSERT_EQ(delay, seldom.delay(5, at)) << i;
    // A look back changes nothing.
    ASSERT_EQ(often.delay(5, at - from_ms(1)), seldom.delay(5, at - from_ms(1))) << i;
    differs = differs || delay != other.delay(5, at);
  }
  EXPECT_TRUE(differs);
}

// 128 kB hold 83 full frames of 12.3 us, and some of them are never waited for.
TEST(TcpFluidTest, APortThatPausesItsSendersStaysFull) {
  std::vector<FluidPort> ports(3, {.bytes_per_ns = kGigabit});
  ports.resize(6, {.bytes_per_ns = kGigabit, .buffer_bytes = 128e3, .pauses = true});
  TcpFluid fluid(ports, {connection_of({0, 5}, {2, 3}), connection_of({1, 5}, {2, 4})}, {},
                 kTcpSeed);
  for (int ms = 1000; ms < 20'000; ms += 7) {
    ASSERT_NEAR(1e3 * to_ms(fluid.delay(5, at_ms(ms))), 1010, 15) << ms;
    ASSERT_EQ(fluid.loss_share(5, at_ms(ms)), 0) << ms;
    // What is too much waits in the senders, as much as a connection may have there.
    for (const std::size_t host : {std::size_t{0}, std::size_t{1}}) {
      ASSERT_GT(fluid.delay(host, at_ms(ms)), from_us(200)) << ms;
      ASSERT_LT(fluid.delay(host, at_ms(ms)), from_us(6000)) << ms;
    }
    ASSERT_EQ(fluid.delay(2, at_ms(ms)), Nanoseconds(0)) << ms;
  }
}

}  // namespace
}  // namespace simbench::sim
