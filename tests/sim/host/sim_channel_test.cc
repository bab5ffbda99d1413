#include "sim/host/sim_channel.h"

#include <gtest/gtest.h>

#include <boost/asio/experimental/awaitable_operators.hpp>
#include <optional>
#include <vector>

#include "tests/sim/host/sim_world.h"

namespace simbench::sim {
namespace {

Bytes message(std::uint8_t number) { return Bytes(8, std::byte{number}); }

struct Received {
  bool got_one;
  std::uint8_t number;
  double returned_ms;
  HostTime stamp;
  SteadyTime steady;
};

Task<void> send_many(SimWorld& world, std::size_t from, PeerId to, int count,
                     std::vector<double>* returned_ms = nullptr,
                     Transport transport = Transport::kStream) {
  MessageChannel& channel = world.host(from).open_channel(to, transport);
  for (int i = 0; i < count; ++i) {
    co_await channel.send(message(static_cast<std::uint8_t>(i)));
    if (returned_ms != nullptr) returned_ms->push_back(world.now_ms());
  }
}

Task<void> send_one_at(SimWorld& world, TrueTime at) {
  MessageChannel& channel = world.host(0).open_channel(1, Transport::kStream);
  co_await sleep_until(world.context, at, "test");
  co_await channel.send(message(1));
}

// Receives on host 1 from host 0, `count` times or until a deadline passes.
Task<void> receive_many(SimWorld& world, int count, double patience_ms,
                        std::vector<Received>& out) {
  SimHost& host = world.host(1);
  MessageChannel& channel = host.open_channel(0, Transport::kStream);
  for (int i = 0; i < count; ++i) {
    const SteadyTime deadline = host.steady_clock().now() + from_ms(patience_ms);
    const std::optional<ReceivedMessage> got = co_await channel.receive(deadline);
    if (got) {
      out.push_back({true, std::to_integer<std::uint8_t>(got->bytes.at(0)), world.now_ms(),
                     got->received, got->received_steady});
    } else {
      out.push_back({false, 0, world.now_ms(), {}, {}});
      co_return;
    }
  }
}

std::vector<double> returned_ms(const std::vector<Received>& received) {
  std::vector<double> all;
  all.reserve(received.size());
  for (const Received& one : received) all.push_back(one.returned_ms);
  return all;
}

Task<void> echo(SimWorld& world, int count) {
  MessageChannel& channel = world.host(1).open_channel(0, Transport::kStream);
  for (int i = 0; i < count; ++i) {
    std::optional<ReceivedMessage> got = co_await channel.receive(kNoDeadline);
    co_await channel.send(std::move(got->bytes));
  }
}

Task<void> ping(SimWorld& world, int count, std::vector<double>& round_trips_ms) {
  MessageChannel& channel = world.host(0).open_channel(1, Transport::kStream);
  for (int i = 0; i < count; ++i) {
    const double start_ms = world.now_ms();
    co_await channel.send(message(1));
    const std::optional<ReceivedMessage> got = co_await channel.receive(kNoDeadline);
    EXPECT_TRUE(got);
    round_trips_ms.push_back(world.now_ms() - start_ms);
  }
}

TEST(SimChannelTest, ASendOccupiesTheSenderAndThenTheMessageLeaves) {
  scenarios::Scenario scenario = ideal_hosts();
  scenario.hosts.send_cost_ms = 2;
  scenario.network.latency_fixed_ms = 5;
  SimWorld world(scenario);
  std::vector<double> sent_ms;
  std::vector<Received> received;
  world.spawn(send_many(world, 0, 1, 3, &sent_ms));
  world.spawn(receive_many(world, 3, 1000, received));
  world.engine.run();
  EXPECT_EQ(sent_ms, (std::vector<double>{2, 4, 6}));
  EXPECT_EQ(returned_ms(received), (std::vector<double>{7, 9, 11}));
  EXPECT_EQ(received[2].number, 2);
}

// docs/reference/calibration.md section 2, step 2: toc = max(arrival, fin) + wake.
TEST(SimChannelTest, EachReceiveCostsAWakeUpAfterTheMessageIsThere) {
  scenarios::Scenario scenario = ideal_hosts();
  scenario.hosts.receive_wake_up_ms = 3;
  scenario.hosts.send_cost_ms = 2;
  scenario.network.latency_fixed_ms = 5;
  SimWorld world(scenario);
  std::vector<Received> received;
  world.spawn(send_many(world, 0, 1, 4));
  world.spawn(receive_many(world, 4, 1000, received));
  world.engine.run();
  // Arrivals 7, 9, 11, 13; each is found waiting after the first.
  EXPECT_EQ(returned_ms(received), (std::vector<double>{10, 13, 16, 19}));
}

TEST(SimChannelTest, SendsOfOneHostQueueOnItsCpu) {
  scenarios::Scenario scenario = ideal_hosts(3);
  scenario.hosts.send_cost_ms = 2;
  SimWorld world(scenario);
  std::vector<double> to_1;
  std::vector<double> to_2;
  world.spawn(send_many(world, 0, 1, 2, &to_1));
  world.spawn(send_many(world, 0, 2, 2, &to_2));
  world.engine.run();
  EXPECT_EQ(to_1, (std::vector<double>{2, 6}));
  EXPECT_EQ(to_2, (std::vector<double>{4, 8}));
}

TEST(SimChannelTest, ADeadlineReturnsNothingAtItsSteadyTime) {
  scenarios::Scenario scenario = ideal_hosts();
  scenario.hosts.clock.oscillator.skew_sigma_ppm = 1000;
  SimWorld world(scenario);
  std::vector<Received> received;
  world.spawn(receive_many(world, 1, 1000, received));
  world.engine.run();
  ASSERT_EQ(received.size(), 1u);
  EXPECT_FALSE(received[0].got_one);
  const double skew = world.hosts.clock(1).oscillator().skew();
  EXPECT_NEAR(received[0].returned_ms, 1000 / (1 + skew), 2e-6);
}

TEST(SimChannelTest, AFarDeadlineIsMetExactlyThroughNoise) {
  scenarios::Scenario scenario = ideal_hosts();
  scenario.hosts.clock.oscillator = {.skew_sigma_ppm = 1000,
                                     .white_frequency_ppb = 100,
                                     .random_walk_ppb_per_sqrt_s = 100,
                                     .wander_step_ms = 100};
  SimWorld world(scenario);
  std::vector<Received> received;
  const SystemClock& clock = world.hosts.clock(1);
  const SteadyTime deadline = clock.steady(TrueTime{}) + from_ms(500e3);
  world.spawn(receive_many(world, 1, 500e3, received));
  world.engine.run();
  EXPECT_GE(clock.steady(world.now()), deadline);
  EXPECT_LT(clock.steady(world.now() - Nanoseconds(1)), deadline);
}

TEST(SimChannelTest, HoursBeforeZeroAreLikeAnyOtherTime) {
  scenarios::Scenario scenario = ideal_hosts();
  scenario.network.latency_fixed_ms = 2;
  const TrueTime start{-std::chrono::hours(7)};
  SimWorld world(scenario, 1, InitialClocks::kUnsynchronised, "test@world", start);
  std::vector<double> round_trips_ms;
  world.spawn(echo(world, 3));
  world.spawn(ping(world, 3, round_trips_ms));
  world.engine.run();
  EXPECT_EQ(round_trips_ms.size(), 3u);
  EXPECT_EQ(world.now(), start + from_ms(3 * 4));
}

TEST(SimChannelTest, AMessageThatArrivesInTimeIsReturnedAfterItsWakeUp) {
  scenarios::Scenario scenario = ideal_hosts();
  scenario.hosts.receive_wake_up_ms = 3;
  SimWorld world(scenario);
  std::vector<Received> received;
  world.spawn(receive_many(world, 2, 10, received));
  world.spawn(send_one_at(world, at_ms(9)));
  world.engine.run();
  ASSERT_EQ(received.size(), 2u);
  EXPECT_TRUE(received[0].got_one);
  EXPECT_EQ(received[0].returned_ms, 12);
  EXPECT_FALSE(received[1].got_one);
  EXPECT_EQ(received[1].returned_ms, 22);
}

TEST(SimChannelTest, PingPong) {
  scenarios::Scenario scenario = ideal_hosts();
  scenario.hosts.send_cost_ms = 0.25;
  scenario.hosts.receive_wake_up_ms = 0.5;
  scenario.network.latency_fixed_ms = 2;
  SimWorld world(scenario);
  std::vector<double> round_trips_ms;
  world.spawn(echo(world, 10));
  world.spawn(ping(world, 10, round_trips_ms));
  world.engine.run();
  EXPECT_EQ(round_trips_ms, std::vector<double>(10, 2 * (0.25 + 2 + 0.5)));
}

TEST(SimChannelTest, ApplicationStampsAreCoarseReadingsAtTheReturn) {
  scenarios::Scenario scenario = ideal_hosts();
  scenario.hosts.receive_wake_up_ms = 3;
  scenario.hosts.clock.resolution_ms = 1;
  scenario.network.latency_fixed_ms = 5.5;
  SimWorld world(scenario);
  std::vector<Received> received;
  world.spawn(send_many(world, 0, 1, 1));
  world.spawn(receive_many(world, 1, 1000, received));
  world.engine.run();
  EXPECT_EQ(received.at(0).stamp, host_ms(8));
  EXPECT_EQ(received.at(0).steady, world.hosts.clock(1).steady(at_ms(8.5)));
}

TEST(SimChannelTest, KernelStampsAreTakenAtTheArrival) {
  scenarios::Scenario scenario = ideal_hosts();
  scenario.hosts.receive_wake_up_ms = 3;
  scenario.hosts.clock.resolution_ms = 1;
  scenario.network.latency_fixed_ms = 5.5;
  scenario.network.stamp_point = scenarios::StampPoint::kKernel;
  SimWorld world(scenario);
  std::vector<Received> received;
  world.spawn(send_many(world, 0, 1, 1));
  world.spawn(receive_many(world, 1, 1000, received));
  world.engine.run();
  EXPECT_EQ(received.at(0).stamp, host_ms(5.5));
  EXPECT_EQ(received.at(0).steady, world.hosts.clock(1).steady(at_ms(5.5)));
  EXPECT_EQ(received.at(0).returned_ms, 8.5);
}

struct Stamp {
  std::optional<HostTime> stamp;
  double returned_ms = -1;
};

Task<void> send_two_and_ask(SimWorld& world, double patience_ms, Stamp& second) {
  SimHost& host = world.host(0);
  MessageChannel& channel = host.open_channel(1, Transport::kStream);
  co_await channel.send(message(1));
  const MessageId id = co_await channel.send(message(2));
  const SteadyTime deadline = host.steady_clock().now() + from_ms(patience_ms);
  second.stamp = co_await channel.transmit_stamp(id, deadline);
  second.returned_ms = world.now_ms();
}

TEST(SimChannelTest, TransmitStampIsWhenTheMessageLeft) {
  scenarios::Scenario scenario = ideal_hosts();
  scenario.hosts.send_cost_ms = 2.5;
  scenario.network.stamp_point = scenarios::StampPoint::kKernel;
  SimWorld world(scenario);
  Stamp stamp;
  world.spawn(send_two_and_ask(world, 100, stamp));
  world.engine.run();
  EXPECT_EQ(stamp.stamp, host_ms(5));
  EXPECT_EQ(stamp.returned_ms, 5);
}

TEST(SimChannelTest, AnApplicationHasNoTransmitStamps) {
  SimWorld world(ideal_hosts());
  Stamp stamp;
  world.spawn(send_two_and_ask(world, 100, stamp));
  world.engine.run();
  EXPECT_FALSE(stamp.stamp);
  EXPECT_EQ(stamp.returned_ms, 0);
}

Task<void> give_up_a_send(SimWorld& world, Stamp& next) {
  using boost::asio::experimental::awaitable_operators::operator||;
  SimHost& host = world.host(0);
  MessageChannel& channel = host.open_channel(1, Transport::kStream);
  co_await (channel.send(message(1)) || host.sleep_for(from_ms(1)));
  const MessageId id = co_await channel.send(message(2));
  next.stamp = co_await channel.transmit_stamp(id, kNoDeadline);
  next.returned_ms = world.now_ms();
}

TEST(SimChannelTest, ACancelledSendSendsNothingAndTheNextOneIsUnharmed) {
  scenarios::Scenario scenario = ideal_hosts();
  scenario.hosts.send_cost_ms = 2;
  scenario.network.stamp_point = scenarios::StampPoint::kKernel;
  SimWorld world(scenario);
  Stamp next;
  std::vector<Received> received;
  world.spawn(give_up_a_send(world, next));
  world.spawn(receive_many(world, 2, 100, received));
  world.engine.run();
  ASSERT_EQ(received.size(), 2u);
  EXPECT_EQ(received[0].number, 2);
  EXPECT_FALSE(received[1].got_one);
  EXPECT_EQ(next.stamp, host_ms(4));  // after the CPU time of both
}

Task<void> give_up_a_receive(SimWorld& world, std::vector<Received>& received) {
  using boost::asio::experimental::awaitable_operators::operator||;
  SimHost& host = world.host(1);
  MessageChannel& channel = host.open_channel(0, Transport::kStream);
  co_await (channel.receive(kNoDeadline) || host.sleep_for(from_ms(7)));
  co_await receive_many(world, 1, 100, received);
}

TEST(SimChannelTest, ACancelledReceiveLeavesTheMessageToTheNext) {
  scenarios::Scenario scenario = ideal_hosts();
  scenario.hosts.receive_wake_up_ms = 5;
  SimWorld world(scenario);
  std::vector<Received> received;
  world.spawn(give_up_a_receive(world, received));
  world.spawn(send_one_at(world, at_ms(4)));  // would be received at 9 ms
  world.engine.run();
  ASSERT_EQ(received.size(), 1u);
  EXPECT_TRUE(received[0].got_one);
  EXPECT_EQ(received[0].returned_ms, 12);
}

// Under Nagle's algorithm the second message leaves when the first is acknowledged.
TEST(SimChannelTest, TransmitStampWaitsUntilTheMessageHasLeft) {
  scenarios::Scenario scenario = ideal_hosts();
  scenario.network.stamp_point = scenarios::StampPoint::kKernel;
  scenario.network.latency_fixed_ms = 1;
  scenario.network.nagle = true;
  scenario.network.delayed_ack_ms = 40;
  for (const double patience_ms : {100.0, 20.0}) {
    SimWorld world(scenario);
    Stamp stamp;
    world.spawn(send_two_and_ask(world, patience_ms, stamp));
    world.engine.run();
    if (patience_ms > 42) {
      EXPECT_EQ(stamp.stamp, host_ms(42));
      EXPECT_EQ(stamp.returned_ms, 42);
    } else {
      EXPECT_FALSE(stamp.stamp);
      EXPECT_EQ(stamp.returned_ms, 20);
    }
  }
}

TEST(SimChannelTest, MoreMessagesToOneHostMoveNoNumbersOfAnother) {
  scenarios::Scenario scenario = ideal_hosts(3);
  scenario.hosts.send_cost_exponential_ms = 0.01;
  scenario.network.latency_exponential_ms = 0.3;
  const auto arrivals = [&](int others) {
    SimWorld world(scenario);
    std::vector<Received> received;
    world.spawn(send_many(world, 2, 1, others));
    world.spawn(send_many(world, 0, 1, 50));
    world.spawn(receive_many(world, 50, 1000, received));
    world.engine.run();
    return returned_ms(received);
  };
  EXPECT_EQ(arrivals(0), arrivals(40));
}

// Only what a run's load explains may differ between pipelines.
TEST(SimChannelTest, OccupancyOfASessionDependsOnTheLoadKey) {
  scenarios::Scenario scenario = ideal_hosts();
  scenario.hosts.send_cost_session_exponential_ms = 3;
  scenario.hosts.load_log_sigma = 0.6;
  const auto cost_ms = [&](std::string_view load_key, std::size_t from) {
    SimWorld world(scenario, 1, InitialClocks::kUnsynchronised, load_key);
    std::vector<double> sent_ms;
    world.spawn(send_many(world, from, from == 0 ? 1 : 0, 1, &sent_ms));
    world.engine.run();
    return sent_ms.at(0);
  };
  EXPECT_EQ(cost_ms("both@world", 0), cost_ms("both@world", 0));
  EXPECT_NE(cost_ms("both@world", 0), cost_ms("both@world", 1));
  EXPECT_NE(cost_ms("both@world", 0), cost_ms("time@world", 0));
}

TEST(SimChannelTest, AWorldMayEndWhileItsCoroutinesWait) {
  SimWorld world(ideal_hosts());
  std::vector<Received> received;
  double woken_ms = -1;
  const auto sleep = [](SimWorld& in, double& out) -> Task<void> {
    co_await in.host(0).sleep_until(host_ms(1e6));
    out = in.now_ms();
  };
  world.spawn(receive_many(world, 1, 1e6, received));
  world.spawn(sleep(world, woken_ms));
  world.spawn(send_one_at(world, at_ms(1e5)));
  world.engine.run_until(at_ms(1000));
  EXPECT_TRUE(received.empty());
  EXPECT_EQ(woken_ms, -1);
}

}  // namespace
}  // namespace simbench::sim
