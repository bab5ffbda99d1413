// The pulse lines of hosts in whole runs (sim/host/pulse_lines.h).
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "sim/host/pulse_lines.h"
#include "sim/trigger/trigger_tree.h"
#include "tests/nonempty.h"
#include "tests/sim/rig/ideal_scenario.h"
#include "tests/sim/rig/test_world.h"

namespace simbench::sim {
namespace {

constexpr auto kSecond = std::chrono::seconds(1);

scenarios::Scenario wired_scenario() {
  scenarios::Scenario s = ideal_scenario();
  s.hosts.pulse_lines = {.pps = true,
                         .gnss = true,
                         .trigger = true,
                         .pps_jitter_sigma_us = 0,
                         .interrupt_latency_us = 5,
                         .interrupt_latency_exponential_us = 0};
  return s;
}

using Stamps = std::vector<std::vector<PulseStamp>>;  // by host

Task<void> collect(Host& host, PulseLine line, Stamps& stamps) {
  PulseInput* input = host.pulse_input(line);
  for (;;) {
    const auto stamp = co_await input->next(kNoDeadline);
    stamps[host.id()].push_back(*stamp);
  }
}

Stamps collected(const scenarios::Scenario& s, PulseLine line, Nanoseconds warm_up,
                 std::uint64_t seed = 1, RecordingCost* cost = nullptr) {
  Stamps stamps(static_cast<std::size_t>(s.hosts.count));
  Service service([&](Host& host) { return collect(host, line, stamps); }, warm_up);
  KeptLists kept;
  const RecordingCost spent = run_world(s, &service, kept, seed);
  if (cost != nullptr) *cost = spent;
  return stamps;
}

TEST(PulseInput, PpsComesAtFullSecondsOfGnssTimePlusTheLatency) {
  const Stamps stamps = collected(wired_scenario(), PulseLine::kPps, 10 * kSecond);
  for (const auto& of_host : nonempty(stamps)) {
    ASSERT_GE(of_host.size(), 13u);
    for (std::size_t i = 0; i < of_host.size(); ++i) {
      const Nanoseconds gnss = of_host[i].gnss.value();
      EXPECT_EQ(gnss % kSecond, Nanoseconds(0));
      // Clocks are exact: they read true time.
      EXPECT_EQ(of_host[i].system.time_since_epoch(),
                gnss - kGnssTimeAtTrueZero + std::chrono::microseconds(5));
      if (i > 0) {
        EXPECT_EQ(of_host[i].system - of_host[i - 1].system, kSecond);
        EXPECT_EQ(of_host[i].steady - of_host[i - 1].steady, kSecond);
      }
    }
  }
  EXPECT_EQ(stamps[0][0].gnss, stamps[1][0].gnss) << "GNSS time is the same for all hosts";
}

TEST(PulseInput, LinesThatAreNotWiredAreNull) {
  scenarios::Scenario s = ideal_scenario();
  bool asked = false;
  Service service([&](Host& host) -> Task<void> {
    EXPECT_EQ(host.pulse_input(PulseLine::kPps), nullptr);
    EXPECT_EQ(host.pulse_input(PulseLine::kTrigger), nullptr);
    asked = true;
    return host.sleep_for(from_ms(0));
  });
  KeptLists kept;
  run_world(s, &service, kept);
  EXPECT_TRUE(asked);
  s = wired_scenario();
  s.hosts.pulse_lines.gnss = false;
  EXPECT_FALSE(collected(s, PulseLine::kPps, kSecond)[0][0].gnss.has_value());
}

TEST(PulseInput, LatencyAndReceiverErrorHaveTheirLaws) {
  scenarios::Scenario s = wired_scenario();
  s.hosts.count = 4;
  s.hosts.pulse_lines.pps_jitter_sigma_us = 20;
  s.hosts.pulse_lines.interrupt_latency_exponential_us = 30;
  const Stamps stamps = collected(s, PulseLine::kPps, 1000 * kSecond, 11);
  double sum = 0;
  double squares = 0;
  double products = 0;
  double n = 0;
  const auto late_us = [](const PulseStamp& stamp) {
    return to_ms(stamp.system.time_since_epoch() - *stamp.gnss + kGnssTimeAtTrueZero) * 1e3 - 35;
  };
  for (std::size_t i = 0; i < 1000; ++i) {
    for (const auto& of_host : stamps) {
      const double late = late_us(of_host[i]);
      sum += late;
      squares += late * late;
      n += 1;
    }
    products += late_us(stamps[0][i]) * late_us(stamps[1][i]);
  }
  const double variance = 20.0 * 20 + 30.0 * 30;
  EXPECT_NEAR(sum / n, 0, 5 * std::sqrt(variance / n)) << "seed 11";
  EXPECT_NEAR(squares / n, variance, 0.15 * variance) << "seed 11";
  EXPECT_NEAR(products / 1000, 0, 5 * variance / std::sqrt(1000.0)) << "hosts are independent";
}

Task<void> sleep_then_collect_stamps(Host& host, Nanoseconds pause,
                                     std::vector<PulseStamp>& stamps) {
  PulseInput* input = host.pulse_input(PulseLine::kPps);
  co_await host.sleep_for(pause);
  while (const auto stamp = co_await input->next(host.steady_clock().now())) {
    stamps.push_back(*stamp);
  }
}

TEST(PulseInput, KeepsTheLast1024PulsesAtNoCostMeanwhile) {
  scenarios::Scenario s = wired_scenario();
  s.hosts.count = 1;
  s.cameras.cameras_per_host = 2;
  s.timeline.frames = 1;
  std::vector<PulseStamp> stamps;
  Service service(
      [&](Host& host) { return sleep_then_collect_stamps(host, 20'000 * kSecond, stamps); },
      20'000 * kSecond);
  KeptLists kept;
  const RecordingCost cost = run_world(s, &service, kept);
  ASSERT_EQ(stamps.size(), 1024u);
  EXPECT_EQ(*stamps.back().gnss - *stamps.front().gnss, 1023 * kSecond);
  // The last pulse before true zero, when the sleep ends.
  EXPECT_EQ(stamps.back().system.time_since_epoch(),
            -std::chrono::milliseconds(250) + std::chrono::microseconds(5));
  EXPECT_LT(cost.events, 1000u);
}

Task<void> step_between_pulses(Host& host, std::vector<PulseStamp>& stamps) {
  PulseInput* input = host.pulse_input(PulseLine::kPps);
  co_await host.sleep_for(from_ms(2000));
  const HostTime before = co_await host.clock().now();
  co_await host.clock().set(before + from_ms(10'000));
  while (stamps.size() < 4) {
    const auto stamp = co_await input->next(kNoDeadline);
    stamps.push_back(*stamp);
  }
}

TEST(PulseInput, AStampIsTheClocksReadingAtThePulseWheneverItIsAskedFor) {
  scenarios::Scenario s = wired_scenario();
  s.hosts.count = 1;
  s.cameras.cameras_per_host = 2;
  s.timeline.frames = 180;
  std::vector<PulseStamp> stamps;
  Service service([&](Host& host) { return step_between_pulses(host, stamps); });
  KeptLists kept;
  run_world(s, &service, kept);
  ASSERT_EQ(stamps.size(), 4u);
  EXPECT_EQ(stamps[1].system - stamps[0].system, kSecond);
  EXPECT_EQ(stamps[2].system - stamps[1].system, 11 * kSecond);
  EXPECT_EQ(stamps[2].steady - stamps[1].steady, kSecond);
  EXPECT_EQ(stamps[3].system - stamps[2].system, kSecond);
}

TEST(PulseInput, TheTriggerLineHasThePulsesOfTheCapture) {
  scenarios::Scenario s = wired_scenario();
  s.trigger.pulse_jitter_sigma_us = 3;
  s.trigger.missed_pulse_probability = 0.2;
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const Stamps stamps = collected(s, PulseLine::kTrigger, 100 * kSecond, seed);
    TriggerTree tree(s.trigger, 2, seed);
    tree.start(TrueTime(from_ms(100)));
    for (const auto& of_host : nonempty(stamps)) {
      std::size_t next = 0;
      for (std::int64_t slot = 0; slot < 45 + 90; ++slot) {
        const auto pulse = tree.pulse(slot);
        if (!pulse) continue;
        ASSERT_LT(next, of_host.size()) << "seed " << seed;
        EXPECT_EQ(of_host[next++].system.time_since_epoch(),
                  pulse->time_since_epoch() + std::chrono::microseconds(5))
            << "seed " << seed << ", slot " << slot;
      }
      EXPECT_EQ(of_host.size(), next) << "no pulse after the capture, seed " << seed;
      EXPECT_FALSE(of_host[0].gnss.has_value());
    }
  }
}

Task<void> give_up_on_pulse(Host& host, PulseLine line, std::vector<Nanoseconds>& waited) {
  const SteadyTime begin = host.steady_clock().now();
  const auto none = co_await host.pulse_input(line)->next(begin + from_ms(40));
  EXPECT_FALSE(none.has_value());
  waited.push_back(host.steady_clock().now() - begin);
}

TEST(PulseInput, AWaitEndsAtItsDeadlineAlsoBeforeThereIsATrigger) {
  for (const PulseLine line : {PulseLine::kPps, PulseLine::kTrigger}) {
    std::vector<Nanoseconds> waited;
    Service service([&](Host& host) { return give_up_on_pulse(host, line, waited); });
    KeptLists kept;
    run_world(wired_scenario(), &service, kept);
    EXPECT_EQ(waited, std::vector<Nanoseconds>(2, from_ms(40)));
  }
}

TEST(PulseInput, AnOpenLineMovesNobodysNumbersAndAWaitCostsAnEventOrTwo) {
  scenarios::Scenario s = wired_scenario();
  s.usb.delivery_jitter_transfers = 0.5;
  Stamps stamps(2);
  Service listening([&](Host& host) { return collect(host, PulseLine::kPps, stamps); },
                    100 * kSecond);
  Service opening(
      [&](Host& host) -> Task<void> {
        host.pulse_input(PulseLine::kPps);
        host.pulse_input(PulseLine::kTrigger);
        return host.sleep_for(from_ms(0));
      },
      100 * kSecond);
  Service idle([&](Host& host) -> Task<void> { return host.sleep_for(from_ms(0)); }, 100 * kSecond);
  KeptLists with;
  KeptLists open;
  KeptLists without;
  const RecordingCost listened = run_world(s, &listening, with, 5);
  const RecordingCost opened = run_world(s, &opening, open, 5);
  const RecordingCost plain = run_world(s, &idle, without, 5);
  EXPECT_EQ(opened.trace_hash, plain.trace_hash);
  EXPECT_LE(listened.events, plain.events + 3 * (stamps[0].size() + stamps[1].size()));
  ASSERT_EQ(with.frames.size(), without.frames.size());
  for (std::size_t i = 0; i < with.frames.size(); ++i) {
    EXPECT_EQ(with.frames[i].record.arrival, without.frames[i].record.arrival);
  }
}

}  // namespace
}  // namespace simbench::sim
