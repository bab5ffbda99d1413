#include "sim/host/message_stack.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/sim/host/sim_world.h"

namespace simbench::sim {
namespace {

constexpr std::uint64_t kStackSeed = 11;

scenarios::Stack no_delay() {
  scenarios::Stack stack;
  stack.sleep_time_ms = 1;
  return stack;
}

scenarios::Hosts hosts_with(const scenarios::Stack& stack) {
  scenarios::Hosts hosts;
  hosts.count = 2;
  hosts.stack = stack;
  return hosts;
}

double us_of(Nanoseconds duration) { return to_ms(duration) * 1e3; }

TEST(DelayProcess, AnExponentialHasItsMeanAndItsVariance) {
  const scenarios::DelayLaw law{.fixed_us = 3, .exponential_us = 5};
  DelayProcess process(law, kStackSeed, ComponentKey("test"), 0, 1);
  constexpr std::uint64_t kDraws = 40'000;
  double sum = 0;
  double squares = 0;
  for (std::uint64_t id = 0; id < kDraws; ++id) {
    const double us = us_of(process.draw({}, {.direction = 1, .message = id}));
    EXPECT_GE(us, 3);
    sum += us;
    squares += us * us;
  }
  const double mean_us = sum / kDraws;
  EXPECT_NEAR(mean_us, 8, 5 * 5 / std::sqrt(1.0 * kDraws)) << "seed " << kStackSeed;
  EXPECT_NEAR(std::sqrt(squares / kDraws - mean_us * mean_us), 5, 0.25) << "seed " << kStackSeed;
}

TEST(DelayProcess, ATableTakesThePlaceOfTheRest) {
  const scenarios::DelayLaw law{.fixed_us = 100, .exponential_us = 100, .quantiles_us = {1, 2, 9}};
  DelayProcess process(law, kStackSeed, ComponentKey("test"), 0, 2);
  std::vector<double> all_us;
  for (std::uint64_t id = 0; id < 10'000; ++id) {
    all_us.push_back(us_of(process.draw({}, {.direction = 1, .message = id})));
  }
  std::ranges::sort(all_us);
  EXPECT_GE(all_us.front(), 2);
  EXPECT_LE(all_us.back(), 18);
  EXPECT_NEAR(all_us[all_us.size() / 2], 4, 0.4) << "twice the median, seed " << kStackSeed;
}

TEST(DelayProcess, ACommonShareLeavesTheLawAndJoinsNeighbours) {
  scenarios::DelayLaw law{.exponential_us = 5, .common_share = 1, .common_time_ms = 100};
  DelayProcess process(law, kStackSeed, ComponentKey("test"), 0, 1);
  const double now_us = us_of(process.draw(at_ms(50), {.direction = 1, .message = 0}));
  const double soon_us = us_of(process.draw(at_ms(50.001), {.direction = 2, .message = 7}));
  EXPECT_NEAR(soon_us, now_us, 0.01) << "another message, the same moment";
  law.common_share = 0.5;
  double sum_us = 0;
  constexpr int kDraws = 20'000;
  DelayProcess half(law, kStackSeed, ComponentKey("test"), 0, 1);
  for (int i = 0; i < kDraws; ++i) {
    sum_us += us_of(half.draw(at_ms(1000.0 * i), {.message = static_cast<std::uint64_t>(i)}));
  }
  EXPECT_NEAR(sum_us / kDraws, 5, 5 * 5 / std::sqrt(1.0 * kDraws)) << "seed " << kStackSeed;
}

TEST(MessageStack, WithoutAStatementNothingTakesTime) {
  scenarios::Hosts hosts;
  MessageStack stack(hosts, kStackSeed, 0);
  EXPECT_EQ(stack.transmit(at_ms(1), {}), Nanoseconds(0));
  EXPECT_EQ(stack.to_card(at_ms(1), {}), Nanoseconds(0));
  EXPECT_EQ(stack.receive(at_ms(1), {}), at_ms(1));
  EXPECT_EQ(stack.wake_up(at_ms(1), {}), Nanoseconds(0));
}

TEST(MessageStack, InterruptsAreModerated) {
  scenarios::Stack stated = no_delay();
  stated.interrupt_moderation_us = 50;
  const scenarios::Hosts hosts = hosts_with(stated);
  MessageStack stack(hosts, kStackSeed, 0);
  EXPECT_EQ(stack.receive(at_ms(1), {.message = 0}), at_ms(1)) << "the first at once";
  EXPECT_EQ(stack.receive(at_ms(1.01), {.message = 1}), at_ms(1.05)) << "50 us after the last";
  EXPECT_EQ(stack.receive(at_ms(1.02), {.message = 2}), at_ms(1.05)) << "by the same interrupt";
  EXPECT_EQ(stack.receive(at_ms(1.06), {.message = 3}), at_ms(1.1));
  EXPECT_EQ(stack.receive(at_ms(2), {.message = 4}), at_ms(2));
}

// A Poisson process of rate r that blocks for T finds it blocked with probability rT / (1 + rT).
TEST(MessageStack, OtherTrafficModeratesToo) {
  scenarios::Stack stated = no_delay();
  stated.interrupt_moderation_us = 100;
  stated.interrupts_per_s = 10'000;
  const scenarios::Hosts hosts = hosts_with(stated);
  MessageStack stack(hosts, kStackSeed, 0);
  constexpr int kMessages = 20'000;
  int waits = 0;
  double sum_us = 0;
  for (int i = 0; i < kMessages; ++i) {
    const TrueTime at = at_ms(10.0 * i);
    const Nanoseconds wait = stack.receive(at, {.message = static_cast<std::uint64_t>(i)}) - at;
    waits += wait.count() > 0 ? 1 : 0;
    sum_us += us_of(wait);
  }
  EXPECT_NEAR(1.0 * waits / kMessages, 0.5, 5 * 0.5 / std::sqrt(1.0 * kMessages));
  EXPECT_NEAR(sum_us / waits, 50, 5 * 29 / std::sqrt(1.0 * waits)) << "seed " << kStackSeed;
}

TEST(MessageStack, ASleepingProcessorWakesFirst) {
  scenarios::Stack stated = no_delay();
  stated.sleep_share = 0.3;
  stated.sleep_exit_us = 80;
  const scenarios::Hosts hosts = hosts_with(stated);
  MessageStack stack(hosts, kStackSeed, 0);
  constexpr int kMessages = 20'000;
  int late = 0;
  for (int i = 0; i < kMessages; ++i) {
    const TrueTime at = at_ms(10.0 * i);
    const Nanoseconds wait = stack.receive(at, {.message = static_cast<std::uint64_t>(i)}) - at;
    EXPECT_TRUE(wait == Nanoseconds(0) || wait == std::chrono::microseconds(80)) << wait.count();
    late += wait.count() > 0 ? 1 : 0;
  }
  EXPECT_NEAR(1.0 * late / kMessages, 0.3, 5 * 0.46 / std::sqrt(1.0 * kMessages))
      << "seed " << kStackSeed;
}

TEST(MessageStack, AProcessorThatWasJustUsedIsAwake) {
  scenarios::Stack stated = no_delay();
  stated.sleep_share = 1;
  stated.sleep_exit_us = 80;
  stated.awake_us = 500;
  const scenarios::Hosts hosts = hosts_with(stated);
  MessageStack stack(hosts, kStackSeed, 0);
  EXPECT_EQ(stack.receive(at_ms(1), {.message = 0}), at_ms(1.08)) << "it slept";
  EXPECT_EQ(stack.receive(at_ms(1.5), {.message = 1}), at_ms(1.5));
  EXPECT_EQ(stack.receive(at_ms(2.1), {.message = 2}), at_ms(2.18)) << "it sleeps again";
  stack.transmit(at_ms(5), {.message = 3});
  EXPECT_EQ(stack.receive(at_ms(5.4), {.message = 4}), at_ms(5.4)) << "an answer";
}

TEST(MessageStack, MessagesKeepTheirOrder) {
  scenarios::Stack stated = no_delay();
  stated.transmit_to_card.exponential_us = 100;
  stated.receive.exponential_us = 100;
  const scenarios::Hosts hosts = hosts_with(stated);
  MessageStack stack(hosts, kStackSeed, 0);
  TrueTime at_card = TrueTime::min();
  TrueTime stamped = TrueTime::min();
  for (int i = 0; i < 1000; ++i) {
    const TrueTime at = at_ms(0.01 * i);
    const MessageKey key{.message = static_cast<std::uint64_t>(i)};
    const TrueTime next_at_card = at + stack.to_card(at, key);
    const TrueTime next_stamped = stack.receive(at, key);
    EXPECT_GE(next_at_card, at_card);
    EXPECT_GE(next_stamped, stamped);
    at_card = next_at_card;
    stamped = next_stamped;
  }
}

TEST(MessageStack, HostsDifferInSpeed) {
  scenarios::Stack stated = no_delay();
  stated.receive.fixed_us = 10;
  stated.speed_log_sigma = 0.3;
  const scenarios::Hosts hosts = hosts_with(stated);
  double sum = 0;
  double squares = 0;
  constexpr int kSeeds = 4000;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    MessageStack stack(hosts, seed, 1);
    const double log_speed = std::log(us_of(stack.receive(at_ms(0), {}) - at_ms(0)) / 10);
    sum += log_speed;
    squares += log_speed * log_speed;
  }
  EXPECT_NEAR(sum / kSeeds, 0, 5 * 0.3 / std::sqrt(1.0 * kSeeds)) << "seeds 1-4000";
  EXPECT_NEAR(std::sqrt(squares / kSeeds), 0.3, 5 * 0.3 / std::sqrt(2.0 * kSeeds));
}

// Each part of the way where it belongs: send 1, to the card 2, wire 100, receive 4, wake-up 8 us.
TEST(MessageStack, StampsAreTakenBetweenTheParts) {
  scenarios::Scenario scenario = ideal_hosts();
  scenarios::Stack stack = no_delay();
  stack.transmit.fixed_us = 1;
  stack.transmit_to_card.fixed_us = 2;
  stack.receive.fixed_us = 4;
  stack.wake_up.fixed_us = 8;
  scenario.hosts.stack = stack;
  scenario.hosts.nic.hardware_stamps = true;
  scenario.network.latency_fixed_ms = 0.1;
  scenario.network.stamp_point = scenarios::StampPoint::kKernel;
  SimWorld world(scenario, kStackSeed);
  std::optional<ReceivedMessage> got;
  HostTime transmitted{};
  double returned_us = 0;
  const auto send = [](SimWorld& in, HostTime& stamp, HardwareTime& card) -> Task<void> {
    MessageChannel& channel = in.host(0).open_channel(1, Transport::kDatagram);
    const MessageId id = co_await channel.send(Bytes(8));
    const std::optional<HostTime> kernel = co_await channel.transmit_stamp(id, kNoDeadline);
    const std::optional<HardwareTime> hardware =
        co_await channel.hardware_transmit_stamp(id, kNoDeadline);
    stamp = kernel.value();
    card = hardware.value();
  };
  const auto receive = [](SimWorld& in, std::optional<ReceivedMessage>& out,
                          double& at_us) -> Task<void> {
    MessageChannel& channel = in.host(1).open_channel(0, Transport::kDatagram);
    out = co_await channel.receive(kNoDeadline);
    at_us = in.now_ms() * 1e3;
  };
  HardwareTime sent_by_card{};
  world.spawn(receive(world, got, returned_us));
  world.spawn(send(world, transmitted, sent_by_card));
  world.engine.run();
  ASSERT_TRUE(got);
  EXPECT_EQ(transmitted.time_since_epoch(), std::chrono::microseconds(1));
  EXPECT_EQ(got->received.time_since_epoch(), std::chrono::microseconds(107));
  EXPECT_NEAR(returned_us, 115, 1e-6);
  // The cards' clocks have offsets of their own; the wire is between them.
  RandomStream draw(kStackSeed, "test");
  const Nanoseconds apart =
      world.host(1).nic()->stamp(TrueTime{}, draw) - world.host(0).nic()->stamp(TrueTime{}, draw);
  EXPECT_NEAR(us_of(*got->received_hardware - sent_by_card - apart), 100, 0.01);
}

scenarios::Hosts busy_hosts() {
  scenarios::Hosts hosts;
  hosts.count = 2;
  hosts.cpu_load = scenarios::CpuLoad{.cold_after_ms = 10,
                                      .cold_transmit = {.fixed_us = 20},
                                      .cold_wake_up = {.fixed_us = 30},
                                      .wake_up = {.fixed_us = 3},
                                      .receive = {.fixed_us = 2}};
  return hosts;
}

TEST(MessageStack, ABusyProcessorsFirstStepIsCold) {
  const scenarios::Hosts hosts = busy_hosts();
  MessageStack stack(hosts, kStackSeed, 0);
  const TrueTime start{};
  EXPECT_EQ(us_of(stack.transmit(start, {1, 0})), 20);
  EXPECT_EQ(us_of(stack.transmit(start + from_ms(1), {1, 1})), 0) << "warm";
  EXPECT_EQ(us_of(stack.wake_up(start + from_ms(2), {2, 0})), 3) << "warm, but scheduled";
  EXPECT_EQ(us_of(stack.wake_up(start + from_ms(20), {2, 1})), 33) << "cold again";
  EXPECT_EQ(us_of(stack.transmit(start + from_ms(29), {1, 2})), 0);
  EXPECT_EQ(us_of(stack.transmit(start + from_ms(39.1), {1, 3})), 20);
  EXPECT_EQ(stack.receive(start + from_ms(50), {2, 2}), start + from_ms(50) + from_us(2));
}

TEST(MessageStack, AnIdleHostHasNoneOfTheLoad) {
  scenarios::Hosts hosts = busy_hosts();
  hosts.cpu_load.reset();
  MessageStack stack(hosts, kStackSeed, 0);
  EXPECT_EQ(stack.transmit({}, {1, 0}), Nanoseconds(0));
  EXPECT_EQ(stack.wake_up({}, {1, 0}), Nanoseconds(0));
  EXPECT_EQ(stack.receive({}, {1, 0}), TrueTime{});
}

TEST(MessageStack, TheLoadOfAHostIsItsOwn) {
  scenarios::Hosts hosts = busy_hosts();
  hosts.cpu_load->host_log_sigma = 0.5;
  std::vector<double> logs;
  for (PeerId host = 0; host < 2000; ++host) {
    MessageStack stack(hosts, kStackSeed, host);
    logs.push_back(std::log(us_of(stack.transmit({}, {1, 0})) / 20));
  }
  double squares = 0;
  for (const double log : logs) squares += log * log;
  EXPECT_NEAR(std::sqrt(squares / 2000), 0.5, 0.03) << "seed " << kStackSeed;
}

}  // namespace
}  // namespace simbench::sim
