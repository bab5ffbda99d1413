#include "algorithms/host_sync/ntp/ntp_association.h"

#include <gtest/gtest.h>

#include <boost/random/mersenne_twister.hpp>
#include <boost/random/uniform_int_distribution.hpp>
#include <functional>
#include <optional>
#include <vector>

#include "tests/algorithms/host_sync/script_host.h"

namespace simbench {
namespace {

constexpr Nanoseconds kLatency{2'000'000};
constexpr Nanoseconds kTimeout{1'000'000'000};

Task<void> ask(Host& host, int times, std::vector<std::optional<NtpMeasurement>>& results) {
  NtpAssociation association(host, 0, NtpStamps::kApplication);
  for (int i = 0; i < times; ++i) {
    std::optional<NtpMeasurement> result = co_await association.exchange(kTimeout);
    results.push_back(result);
    co_await host.sleep_for(from_ms(10));
  }
}

Task<void> listen(Host& host, Nanoseconds until, std::vector<NtpBroadcast>& heard) {
  NtpAssociation association(host, 0, NtpStamps::kApplication);
  while (true) {
    const std::optional<NtpBroadcast> broadcast =
        co_await association.next_broadcast(SteadyTime(until));
    if (!broadcast) co_return;
    heard.push_back(*broadcast);
  }
}

using Reply = std::function<std::vector<NtpPacket>(const NtpPacket& request)>;

// A server of the test's own making.
Task<void> impersonate(Host& host, Reply reply) {
  MessageChannel& channel = host.open_channel(1, Transport::kDatagram);
  while (true) {
    const auto received = co_await channel.receive(host.steady_clock().now() + kTimeout * 10);
    if (!received) co_return;
    const auto request = decode_ntp_packet(received->bytes);
    if (!request) continue;
    for (const NtpPacket& packet : reply(*request)) {
      Bytes bytes = encode(packet);
      co_await channel.send(std::move(bytes));
    }
  }
}

NtpPacket good_reply(const NtpPacket& request) {
  NtpPacket packet;
  packet.mode = kNtpModeServer;
  packet.stratum = 1;
  packet.origin = request.transmit;
  packet.receive = to_ntp(HostTime(from_ms(500)));
  packet.transmit = to_ntp(HostTime(from_ms(501)));
  return packet;
}

std::optional<NtpMeasurement> result_with(const Reply& reply) {
  ScriptWorld world(2);
  world.connect(kLatency).host(1).offset = from_ms(50);
  std::vector<std::optional<NtpMeasurement>> results;
  world.start(impersonate(world.host(0), reply));
  world.start(ask(world.host(1), 1, results));
  world.run(from_ms(5e3));
  return results.at(0);
}

TEST(NtpAssociation, MeasuresOffsetAndDelay) {
  ScriptWorld world(2);
  world.connect(kLatency).host(0).offset = from_ms(350);
  world.host(0).costs.send = from_ms(0.25);
  world.host(1).costs.send = from_ms(0.25);
  std::vector<std::optional<NtpMeasurement>> results;
  world.start(serve_ntp(world.host(0), {1}));
  world.start(ask(world.host(1), 1, results));
  world.run(from_ms(100));
  ASSERT_TRUE(results.at(0));
  EXPECT_DOUBLE_EQ(results[0]->offset_s(), 0.35);
  EXPECT_DOUBLE_EQ(results[0]->delay_s(), 4.5e-3);
  ASSERT_EQ(world.host(1).exchanges.size(), 1U);
  EXPECT_EQ(*world.host(1).exchanges[0].t2, HostTime(from_ms(350 + 2.25)));
}

TEST(NtpAssociation, UnequalLatenciesCountHalf) {
  ScriptWorld world(2);
  world.connect(kLatency).set_latency(0, 1, from_ms(7));
  std::vector<std::optional<NtpMeasurement>> results;
  world.start(serve_ntp(world.host(0), {1}));
  world.start(ask(world.host(1), 1, results));
  world.run(from_ms(100));
  ASSERT_TRUE(results.at(0));
  EXPECT_DOUBLE_EQ(results[0]->offset_s(), -2.5e-3);
}

TEST(NtpAssociation, UsesAGoodReplyOnly) {
  EXPECT_TRUE(
      result_with([](const NtpPacket& request) { return std::vector{good_reply(request)}; }));
  const std::vector<std::function<void(NtpPacket&)>> faults = {
      [](NtpPacket& packet) { packet.stratum = 0; },  // kiss-o'-death
      [](NtpPacket& packet) { packet.stratum = 16; },
      [](NtpPacket& packet) { packet.leap = kNtpLeapAlarm; },
      [](NtpPacket& packet) { packet.mode = kNtpModeClient; },
      [](NtpPacket& packet) { packet.mode = kNtpModeBroadcast; },
      [](NtpPacket& packet) { packet.origin.fraction += 1; },
      [](NtpPacket& packet) { packet.origin = {}; },
      [](NtpPacket& packet) { packet.receive = {}; },
      [](NtpPacket& packet) { packet.transmit = {}; },
  };
  for (std::size_t i = 0; i < faults.size(); ++i) {
    const auto faulty = [&](const NtpPacket& request) {
      NtpPacket packet = good_reply(request);
      faults[i](packet);
      return packet;
    };
    EXPECT_FALSE(result_with([&](const NtpPacket& request) {
      return std::vector{faulty(request)};
    })) << "fault "
        << i;
    EXPECT_TRUE(result_with([&](const NtpPacket& request) {
      return std::vector{faulty(request), good_reply(request)};
    })) << "fault "
        << i << " must not hide the good reply";
  }
}

TEST(NtpAssociation, LostDuplicatedAndLateRepliesAreNoneOfTheNextRequest) {
  ScriptWorld world(2);
  world.connect(kLatency);
  // The first is lost, the second comes twice, the third after the timeout.
  world.script_link(0, 1, [](std::size_t index, const Bytes&) -> std::vector<Nanoseconds> {
    if (index == 0) return {};
    if (index == 1) return {kLatency, kLatency * 6};
    if (index == 2) return {kTimeout + from_ms(5)};
    return {kLatency};
  });
  std::vector<std::optional<NtpMeasurement>> results;
  world.start(serve_ntp(world.host(0), {1}));
  world.start(ask(world.host(1), 5, results));
  world.run(from_ms(10e3));
  ASSERT_EQ(results.size(), 5U);
  EXPECT_FALSE(results[0]);
  EXPECT_FALSE(results[2]);
  for (const int i : {1, 3, 4}) {
    ASSERT_TRUE(results[i]) << i;
    EXPECT_DOUBLE_EQ(results[i]->delay_s(), 4e-3) << i;
  }
}

TEST(NtpAssociation, ABroadcastLacksItsOwnDelay) {
  ScriptWorld world(3);
  for (const PeerId slave : world.slaves()) world.set_latency(0, slave, kLatency * slave);
  world.host(0).offset = from_ms(20);
  std::vector<NtpBroadcast> heard;
  world.start(broadcast_ntp(world.host(0), world.slaves(), from_ms(64e3)));
  world.start(listen(world.host(2), from_ms(200e3), heard));
  world.run(from_ms(201e3));
  ASSERT_EQ(heard.size(), 4U);
  for (const NtpBroadcast& broadcast : heard) {
    EXPECT_DOUBLE_EQ(broadcast.offset_s(), 20e-3 - 4e-3);
  }
  EXPECT_EQ(world.host(2).exchanges.size(), 4U);
  EXPECT_FALSE(world.host(2).exchanges[0].t1);
}

Bytes association_noise(boost::random::mt19937& engine) {
  boost::random::uniform_int_distribution<int> byte(0, 255);
  boost::random::uniform_int_distribution<int> kind(0, 3);
  const bool is_packet = kind(engine) != 0;
  Bytes bytes(is_packet ? kNtpPacketBytes : static_cast<std::size_t>(byte(engine)));
  for (std::byte& each : bytes) each = static_cast<std::byte>(byte(engine));
  // A header that is looked at: version 4, mode 3, 4 or 5.
  if (is_packet) bytes[0] = static_cast<std::byte>(0x23 + kind(engine) % 3);
  return bytes;
}

TEST(NtpAssociation, NoiseHurtsNeitherSide) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    boost::random::mt19937 engine(seed);
    ScriptWorld world(2);
    world.connect(kLatency);
    std::vector<std::optional<NtpMeasurement>> results;
    world.start(serve_ntp(world.host(0), {1}));
    world.start(ask(world.host(1), 50, results));
    for (int i = 0; i < 500; ++i) {
      const PeerId to = i % 2 == 0 ? 0 : 1;
      world.call_at(from_ms(i * 1.1), [&world, to, bytes = association_noise(engine)] {
        world.host(to).deliver(1 - to, bytes);
      });
    }
    world.run(from_ms(60e3));
    ASSERT_EQ(results.size(), 50U) << "seed " << seed;
    for (const auto& result : results) {
      ASSERT_TRUE(result) << "seed " << seed;
      EXPECT_EQ(result->offset_s(), 0) << "seed " << seed;
    }
  }
}

TEST(NtpAssociation, NoiseAsBroadcastIsStillATime) {
  boost::random::mt19937 engine(7);
  ScriptWorld world(2);
  std::vector<NtpBroadcast> heard;
  world.start(listen(world.host(1), from_ms(1000), heard));
  for (int i = 0; i < 200; ++i) {
    world.call_at(from_ms(i),
                  [&world, bytes = association_noise(engine)] { world.host(1).deliver(0, bytes); });
  }
  world.run(from_ms(1001));
  EXPECT_FALSE(heard.empty());
  for (const NtpBroadcast& broadcast : heard) {
    EXPECT_LT(std::abs(broadcast.offset_s()), 69.0 * 365.25 * 86400) << "within half an era";
  }
}

}  // namespace
}  // namespace simbench
