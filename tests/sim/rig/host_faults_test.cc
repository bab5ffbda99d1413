// Hosts under bursts of load (sim/network/load.h) and hosts that stop (sim/faults/faults.h), in
// whole runs.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "sim/network/load.h"
#include "tests/sim/rig/ideal_scenario.h"
#include "tests/sim/rig/test_world.h"

namespace simbench::sim {
namespace {

using FrameKey = std::pair<std::uint32_t, std::uint32_t>;  // camera, counter

std::map<FrameKey, double> arrivals_ms(const KeptLists& kept) {
  std::map<FrameKey, double> found;
  for (const auto& frame : kept.frames) {
    found[{frame.record.camera, frame.record.counter}] =
        to_ms(frame.record.arrival.time_since_epoch());
  }
  return found;
}

KeptLists recorded(const scenarios::Scenario& s, std::uint64_t seed = 1) {
  KeptLists kept;
  run_world(s, nullptr, kept, seed);
  return kept;
}

TEST(HostLoad, DelaysAreUniformAndBurstsTakeTheirShareOfTheTime) {
  constexpr ComponentKey kWhat("test");
  HostLoad load({.rate_hz = 2, .duration_exponential_ms = 100, .latency_ms = 3}, 4, 1);
  double delayed = 0;
  double sum_ms = 0;
  double largest_ms = 0;
  constexpr int kSamples = 400'000;
  for (int i = 0; i < kSamples; ++i) {
    const double ms =
        to_ms(load.delay(TrueTime(from_ms(5 * i)), kWhat, 0, static_cast<std::uint64_t>(i)));
    if (ms > 0) delayed += 1;
    sum_ms += ms;
    largest_ms = std::max(largest_ms, ms);
  }
  // Poisson bursts that may overlap: busy with probability 1 - exp(-0.2). 4,000 bursts in 2,000 s.
  EXPECT_NEAR(delayed / kSamples, 1 - std::exp(-0.2), 0.015) << "seed 4";
  EXPECT_NEAR(sum_ms / delayed, 3, 0.05) << "seed 4";
  EXPECT_NEAR(largest_ms, 6, 0.01);
}

TEST(HostLoad, FramesComeLaterDuringBurstsOfTheirHost) {
  scenarios::Scenario s = ideal_scenario();
  s.cameras.count = 4;
  s.cameras.cameras_per_host = 2;
  s.timeline.frames = 45 * 60;
  const auto calm = arrivals_ms(recorded(s, 2));
  s.hosts.load_burst = {.rate_hz = 0.5, .duration_exponential_ms = 500, .latency_ms = 4};
  const auto loaded = arrivals_ms(recorded(s, 2));
  ASSERT_EQ(loaded.size(), calm.size());
  int together = 0;
  int apart = 0;
  double late_ms = 0;
  double late = 0;
  for (const auto& [key, at_ms] : calm) {
    const double delay_ms = loaded.at(key) - at_ms;
    EXPECT_GE(delay_ms, 0);
    EXPECT_LT(delay_ms, 8);
    if (delay_ms > 0) {
      late_ms += delay_ms;
      late += 1;
    }
    if (key.first == 0) {
      const bool busy = delay_ms > 0;
      together += busy == (loaded.at({1, key.second}) > calm.at({1, key.second}));
      apart += busy != (loaded.at({2, key.second}) > calm.at({2, key.second}));
    }
  }
  EXPECT_NEAR(late / static_cast<double>(calm.size()), 1 - std::exp(-0.25), 0.12) << "seed 2";
  EXPECT_NEAR(late_ms / late, 4, 0.3) << "seed 2";
  EXPECT_EQ(together, 45 * 61) << "the cameras of a host are late together";
  EXPECT_GT(apart, 400) << "each host has bursts of its own";
}

Task<void> send_every(Host& host, Nanoseconds interval) {
  MessageChannel& channel = host.open_channel(1, Transport::kDatagram);
  for (;;) {
    co_await channel.send(Bytes(1));
    co_await host.sleep_for(interval);
  }
}

Task<void> note_arrivals(Host& host, std::vector<double>& kernel_ms, std::vector<double>& seen_ms) {
  MessageChannel& channel = host.open_channel(0, Transport::kDatagram);
  for (;;) {
    const auto message = co_await channel.receive(kNoDeadline);
    kernel_ms.push_back(to_ms(message->received.time_since_epoch()));
    const HostTime now = co_await host.clock().now();
    seen_ms.push_back(to_ms(now.time_since_epoch()));
  }
}

TEST(HostLoad, MessagesAreNoticedLaterButStampedByTheKernelInTime) {
  scenarios::Scenario s = ideal_scenario();
  s.network.stamp_point = scenarios::StampPoint::kKernel;
  s.timeline.frames = 45 * 20;
  s.hosts.receive_wake_up_ms = 0.02;
  s.hosts.load_burst = {.rate_hz = 1, .duration_exponential_ms = 500, .latency_ms = 4};
  std::vector<double> kernel_ms;
  std::vector<double> seen_ms;
  Service service([&](Host& host) {
    return host.id() == 0 ? send_every(host, from_ms(20)) : note_arrivals(host, kernel_ms, seen_ms);
  });
  KeptLists kept;
  run_world(s, &service, kept);
  ASSERT_GT(seen_ms.size(), 1000u);
  int late = 0;
  for (std::size_t i = 0; i < seen_ms.size(); ++i) {
    EXPECT_NEAR(kernel_ms[i], 20 * static_cast<double>(i) + 0.1, 1e-5);
    const double wake_up_ms = seen_ms[i] - kernel_ms[i];
    EXPECT_GE(wake_up_ms, 0.02 - 1e-5);
    EXPECT_LT(wake_up_ms, 8.03);
    if (wake_up_ms > 0.021) ++late;
  }
  EXPECT_NEAR(late / static_cast<double>(seen_ms.size()), 1 - std::exp(-0.5), 0.25) << "seed 1";
}

// `Stops` is HostStops or LinkStops.
template <class Stops>
scenarios::Scenario with_stop() {
  scenarios::Scenario s = ideal_scenario();
  s.cameras.clock_poll.interval_ms = 50;
  s.hosts.pulse_lines.trigger = true;
  s.faults = {Stops{.host = 1, .at_ms = 1000, .duration_ms = 500}};
  return s;
}

Task<void> count_pulses(Host& host, std::vector<std::vector<double>>& pulses_ms) {
  for (;;) {
    const auto stamp = co_await host.pulse_input(PulseLine::kTrigger)->next(kNoDeadline);
    pulses_ms[host.id()].push_back(to_ms(stamp->system.time_since_epoch()));
  }
}

bool in_span(double ms) { return ms >= 1100 && ms < 1600; }  // the capture starts at 100 ms

TEST(HostStops, ItsFramesPollsAndPulsesAreMissing) {
  scenarios::Scenario s = with_stop<scenarios::HostStops>();
  std::vector<std::vector<double>> pulses_ms(2);
  Service service([&](Host& host) { return count_pulses(host, pulses_ms); });
  KeptLists stopped;
  run_world(s, &service, stopped);
  s.faults.clear();
  const auto all = arrivals_ms(recorded(s));
  const auto left = arrivals_ms(stopped);
  for (const auto& [key, at_ms] : all) {
    const bool lost = key.first == 1 && in_span(at_ms);
    EXPECT_EQ(left.count(key), lost ? 0u : 1u) << "camera " << key.first << " at " << at_ms;
    if (!lost && left.count(key) > 0) {
      EXPECT_EQ(left.at(key), at_ms);
    }
  }
  EXPECT_NEAR(static_cast<double>(all.size() - left.size()), 22.5, 1);
  for (const DevicePoll& poll : stopped.polls) {
    EXPECT_FALSE(poll.camera == 1 && in_span(to_ms(poll.t1.time_since_epoch())));
  }
  EXPECT_GT(stopped.polls.size(), 100u);
  EXPECT_NEAR(static_cast<double>(pulses_ms[0].size() - pulses_ms[1].size()), 22.5, 1);
}

TEST(LinkStops, OnlyMessagesAreLost) {
  scenarios::Scenario s = with_stop<scenarios::LinkStops>();
  std::vector<double> kernel_ms;
  std::vector<double> seen_ms;
  Service service([&](Host& host) {
    return host.id() == 0 ? send_every(host, from_ms(20)) : note_arrivals(host, kernel_ms, seen_ms);
  });
  KeptLists cut;
  run_world(s, &service, cut);
  EXPECT_EQ(cut.frames.size(), recorded(s).frames.size());
  ASSERT_GT(seen_ms.size(), 100u);
  std::size_t missing = 0;
  for (std::size_t i = 1; i < seen_ms.size(); ++i) {
    EXPECT_FALSE(in_span(seen_ms[i])) << seen_ms[i];
    missing += static_cast<std::size_t>(std::lround((seen_ms[i] - seen_ms[i - 1]) / 20)) - 1;
  }
  EXPECT_EQ(missing, 25u);
}

TEST(HostFaults, AWorldWithThemRepeats) {
  scenarios::Scenario s = with_stop<scenarios::HostStops>();
  s.hosts.load_burst = {.rate_hz = 1, .duration_exponential_ms = 500, .latency_ms = 4};
  KeptLists kept[2];
  RecordingCost cost[2];
  for (const int i : {0, 1}) cost[i] = run_world(s, nullptr, kept[i], 6);
  EXPECT_EQ(cost[0].trace_hash, cost[1].trace_hash);
  EXPECT_EQ(arrivals_ms(kept[0]), arrivals_ms(kept[1]));
}

}  // namespace
}  // namespace simbench::sim
