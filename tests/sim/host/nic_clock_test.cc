#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "sim/host/host_clocks.h"
#include "tests/nonempty.h"
#include "tests/sim/host/sim_world.h"

namespace simbench::sim {
namespace {

// Hosts whose clocks are exact: they read true time. No skew, no noise, full resolution.
scenarios::Scenario stamping_hosts(std::int64_t count = 2) {
  scenarios::Scenario s = ideal_hosts(count);
  s.hosts.nic = {.hardware_stamps = true,
                 .skew_sigma_ppm = 0,
                 .stamp_resolution_ns = 1,
                 .stamp_jitter_sigma_ns = 0,
                 .cross_stamp_cost_ms = 0.004};
  s.network.latency_fixed_ms = 0.1;
  return s;
}

Task<void> cross_stamps(Host& host, int count, Nanoseconds interval,
                        std::vector<CrossStamp>& stamps) {
  for (int i = 0; i < count; ++i) {
    const CrossStamp stamp = co_await host.hardware_clock()->cross_stamp();
    stamps.push_back(stamp);
    co_await host.sleep_for(interval - from_ms(0.004));
  }
}

std::vector<CrossStamp> stamps_of(const scenarios::Scenario& s, int count, std::uint64_t seed = 1) {
  SimWorld world(s, seed);
  std::vector<CrossStamp> stamps;
  world.spawn(cross_stamps(world.host(1), count, from_ms(1000), stamps));
  world.engine.run();
  return stamps;
}

// Card minus system clock, as a program works it out.
Nanoseconds card_ahead(const CrossStamp& stamp) {
  const HostTime middle = stamp.before + (stamp.after - stamp.before) / 2;
  return stamp.hardware.time_since_epoch() - middle.time_since_epoch();
}

TEST(NicClock, ACrossStampIsReadInTheMiddleOfTheCall) {
  const auto stamps = stamps_of(stamping_hosts(), 3);
  ASSERT_EQ(stamps.size(), 3u);
  EXPECT_EQ(stamps[0].before, HostTime{});
  for (const CrossStamp& stamp : stamps) {
    EXPECT_EQ(stamp.after - stamp.before, from_ms(0.004));
    EXPECT_EQ(card_ahead(stamp), card_ahead(stamps[0]));
  }
  EXPECT_GT(card_ahead(stamps[0]), Nanoseconds(0)) << "the card's zero is its own";
  EXPECT_LT(card_ahead(stamps[0]), std::chrono::hours(1));
}

TEST(NicClock, SkewsAreDrawnPerHostAndSeed) {
  scenarios::Scenario s = stamping_hosts();
  s.hosts.nic.skew_sigma_ppm = 10;
  double squares = 0;
  constexpr int kSeeds = 500;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const auto stamps = stamps_of(s, 2, seed);
    const double ppm =
        static_cast<double>((card_ahead(stamps[1]) - card_ahead(stamps[0])).count()) * 1e-3;
    squares += ppm * ppm;
  }
  EXPECT_NEAR(std::sqrt(squares / kSeeds), 10, 5 * 10 / std::sqrt(2.0 * kSeeds)) << "seeds 1-500";
}

TEST(NicClock, ReadingsHaveTheirNoiseAndResolution) {
  scenarios::Scenario s = stamping_hosts();
  s.hosts.nic.stamp_jitter_sigma_ns = 100;
  const auto stamps = stamps_of(s, 2000, 3);
  double sum = 0;
  double squares = 0;
  for (const CrossStamp& stamp : stamps) {
    const auto ns = static_cast<double>((card_ahead(stamp) - card_ahead(stamps[0])).count());
    sum += ns;
    squares += ns * ns;
  }
  const double mean = sum / 2000;
  EXPECT_NEAR(std::sqrt(squares / 2000 - mean * mean), 100, 8) << "seed 3";
  s.hosts.nic.stamp_jitter_sigma_ns = 0;
  s.hosts.nic.stamp_resolution_ns = 8;
  for (const CrossStamp& stamp : nonempty(stamps_of(s, 10))) {
    EXPECT_EQ(stamp.hardware.time_since_epoch().count() % 8, 0);
  }
}

Task<void> discipline(Host& host, std::vector<CrossStamp>& stamps) {
  HardwareClock& card = *host.hardware_clock();
  co_await cross_stamps(host, 1, from_ms(1000), stamps);
  co_await card.adjust_frequency(1000);
  co_await cross_stamps(host, 2, from_ms(1000), stamps);
  co_await card.step(from_ms(-7));
  co_await cross_stamps(host, 1, from_ms(1000), stamps);
}

TEST(NicClock, TakesStepsAndRates) {
  SimWorld world(stamping_hosts());
  std::vector<CrossStamp> stamps;
  world.spawn(discipline(world.host(1), stamps));
  world.engine.run();
  ASSERT_EQ(stamps.size(), 4u);
  // The rate counts from the middle of its call, 4 us before the middle of the cross stamp.
  EXPECT_EQ(card_ahead(stamps[1]), card_ahead(stamps[0]));
  EXPECT_EQ(card_ahead(stamps[2]) - card_ahead(stamps[1]), Nanoseconds(1000));
  EXPECT_EQ(card_ahead(stamps[3]) - card_ahead(stamps[2]), from_ms(-7) + Nanoseconds(1000));
}

struct Conversation {
  std::vector<HardwareTime> sent;
  std::vector<ReceivedMessage> received;
  CrossStamp sender;
  CrossStamp receiver;
};

Task<void> sender(Host& host, int count, std::size_t bytes, Conversation& talk) {
  talk.sender = co_await host.hardware_clock()->cross_stamp();
  MessageChannel& channel = host.open_channel(1, Transport::kDatagram);
  for (int i = 0; i < count; ++i) {
    const MessageId id = co_await channel.send(Bytes(bytes));
    const auto stamp = co_await channel.hardware_transmit_stamp(id, kNoDeadline);
    talk.sent.push_back(stamp.value());
    co_await host.sleep_for(from_ms(10));
  }
}

Task<void> receiver(Host& host, int count, Conversation& talk) {
  talk.receiver = co_await host.hardware_clock()->cross_stamp();
  MessageChannel& channel = host.open_channel(0, Transport::kDatagram);
  for (int i = 0; i < count; ++i) {
    const auto message = co_await channel.receive(kNoDeadline);
    talk.received.push_back(*message);
  }
}

Conversation converse(const scenarios::Scenario& s, int count, std::size_t bytes) {
  SimWorld world(s);
  Conversation talk;
  world.spawn(receiver(world.host(1), count, talk));
  world.spawn(sender(world.host(0), count, bytes, talk));
  world.engine.run();
  return talk;
}

TEST(NicClock, MessagesAreStampedWhereTheyPassTheCards) {
  scenarios::Scenario s = stamping_hosts();
  s.hosts.send_cost_ms = 2;
  s.hosts.receive_wake_up_ms = 3;
  s.network.bandwidth_mbit_per_s = 8;  // 1 us per byte
  s.network.overhead_bytes = 50;
  const Conversation talk = converse(s, 3, 150);
  for (std::size_t i = 0; i < 3; ++i) {
    const Nanoseconds sent = talk.sent[i].time_since_epoch() - card_ahead(talk.sender);
    const Nanoseconds received =
        talk.received[i].received_hardware->time_since_epoch() - card_ahead(talk.receiver);
    // The switch's port to the receiver takes another 200 us, the link 100 us.
    EXPECT_EQ(received - sent, from_ms(0.3));
    // Stamped before the wake-up: the application's stamp is 3 ms later.
    EXPECT_EQ(talk.received[i].received.time_since_epoch() - received, from_ms(3));
    // The call's 4 us, the send's 2 ms, 0.2 ms through the port; 10 ms and once more 0.2 ms that
    // waiting for the stamp took.
    EXPECT_EQ(sent, from_ms(0.004 + 2.2 + static_cast<double>(i) * 12.2));
  }
}

Task<void> sleepy_receiver(Host& host, std::vector<Nanoseconds>& received) {
  HardwareClock& card = *host.hardware_clock();
  const CrossStamp before = co_await card.cross_stamp();
  MessageChannel& channel = host.open_channel(0, Transport::kDatagram);
  co_await host.sleep_for(from_ms(50));
  co_await card.step(from_ms(1000));
  const auto message = co_await channel.receive(kNoDeadline);
  received.push_back(message->received_hardware->time_since_epoch() - card_ahead(before));
}

TEST(NicClock, AStampIsTheCardsReadingWhenTheMessageCame) {
  SimWorld world(stamping_hosts());
  Conversation talk;
  std::vector<Nanoseconds> received;
  world.spawn(sleepy_receiver(world.host(1), received));
  world.spawn(sender(world.host(0), 1, 10, talk));
  world.engine.run();
  EXPECT_EQ(received, std::vector<Nanoseconds>{from_ms(0.104)}) << "not 1000 ms later";
}

Task<void> talk_without_card(Host& host, PeerId peer, int& checks) {
  EXPECT_EQ(host.hardware_clock(), nullptr);
  MessageChannel& channel = host.open_channel(peer, Transport::kDatagram);
  const MessageId id = co_await channel.send(Bytes(4));
  const auto stamp = co_await channel.hardware_transmit_stamp(id, kNoDeadline);
  EXPECT_FALSE(stamp.has_value());
  const auto message = co_await channel.receive(kNoDeadline);
  EXPECT_FALSE(message->received_hardware.has_value());
  ++checks;
}

TEST(NicClock, WithoutHardwareStampsThereIsNone) {
  SimWorld world(ideal_hosts());
  int checks = 0;
  world.spawn(talk_without_card(world.host(0), 1, checks));
  world.spawn(talk_without_card(world.host(1), 0, checks));
  world.engine.run();
  EXPECT_EQ(checks, 2);
}

Task<void> many_readings(Host& host) {
  for (int i = 0; i < 5; ++i) co_await host.hardware_clock()->cross_stamp();
}

TEST(NicClock, MoreReadingsMoveNoMessagesStamp) {
  scenarios::Scenario s = stamping_hosts();
  s.hosts.nic.stamp_jitter_sigma_ns = 50;
  s.hosts.nic.cross_stamp_cost_ms = 0;
  const Conversation quiet = converse(s, 4, 64);
  SimWorld world(s);
  Conversation busy;
  world.spawn(receiver(world.host(1), 4, busy));
  world.spawn(sender(world.host(0), 4, 64, busy));
  world.spawn(many_readings(world.host(0)));
  world.spawn(many_readings(world.host(1)));
  world.engine.run();
  EXPECT_EQ(quiet.sent, busy.sent);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(quiet.received[i].received_hardware, busy.received[i].received_hardware);
  }
}

}  // namespace
}  // namespace simbench::sim
