#include "sim/traffic/frame_bursts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <vector>

#include "sim/engine/random.h"
#include "sim/traffic/tcp_fluid.h"
#include "tests/sim/at_ms.h"

namespace simbench::sim {
namespace {

constexpr double kLine = 0.125;  // bytes/ns: 1 Gbit/s
constexpr double kFrameNs = kFullFrameBytes / kLine;
constexpr std::uint64_t kBurstSeed = 5;
using scenarios::TrafficKind;

double ns_of_wait(FrameBursts& bursts, std::size_t port, TrueTime at) {
  return static_cast<double>(bursts.wait(port, at).count());
}

TEST(FrameBurstsTest, NoTrafficNoWait) {
  FrameBursts bursts(kLine, {}, {0, 128e3}, kBurstSeed);
  EXPECT_EQ(bursts.wait(0, at_ms(5)), Nanoseconds(0));
  EXPECT_EQ(bursts.wait(1, at_ms(5)), Nanoseconds(0));
  EXPECT_EQ(bursts.overload_share(1, at_ms(5)), 0);
}

// 900 Mbit/s in single frames: busy nine tenths of the time, and the rest of a frame is uniform.
TEST(FrameBurstsTest, BehindAPacedStreamOneFrameAtMost) {
  FrameBursts bursts(kLine,
                     {{.kind = TrafficKind::kPaced, .ports = {0, 1}, .bytes_per_ns = 0.9 * kLine}},
                     {0, 128e3}, kBurstSeed);
  constexpr int kQueries = 20'000;
  for (const std::size_t port : {0u, 1u}) {
    double mean_ns = 0;
    for (int i = 0; i < kQueries; ++i) {
      const double wait_ns = ns_of_wait(bursts, port, at_ms(100 + i * 0.012345678));
      ASSERT_LE(wait_ns, kFrameNs + 1);
      mean_ns += wait_ns / kQueries;
    }
    EXPECT_NEAR(mean_ns, 0.9 * kFrameNs / 2, 0.01 * kFrameNs);
  }
}

// A message of 100 bytes that leaves its host directly behind a frame.
TEST(FrameBurstsTest, BehindItsOwnFrameAMessageWaitsAFrameLessItsLength) {
  FrameBursts bursts(kLine,
                     {{.kind = TrafficKind::kPaced, .ports = {0, 1}, .bytes_per_ns = 0.5 * kLine}},
                     {0, 128e3}, kBurstSeed);
  const double own_ns = 100 / kLine;
  int checked = 0;
  for (int i = 0; i < 1000; ++i) {
    const TrueTime at = at_ms(50 + i * 0.0123);
    const Nanoseconds in_host = bursts.wait(0, at);
    if (in_host <= Nanoseconds(1)) continue;
    ++checked;
    const TrueTime at_switch = at + in_host + from_ns(own_ns);
    ASSERT_NEAR(ns_of_wait(bursts, 1, at_switch), kFrameNs - own_ns, 3) << i;
  }
  EXPECT_GT(checked, 400);
}

// Pollaczek and Khinchine: E[W] = rho E[S^2] / (2 (1 - rho) E[S]); one burst in a hundred has two
// frames.
TEST(FrameBurstsTest, SingleRandomFramesAreAnMD1Queue) {
  for (const double load : {0.3, 0.8}) {
    FrameBursts bursts(kLine,
                       {{.kind = TrafficKind::kRandom,
                         .ports = {0, 1},
                         .bytes_per_ns = load * kLine,
                         .tail_exponent = 100}},
                       {0, 1e6}, kBurstSeed);
    RandomStream draws(kBurstSeed, "instants");
    constexpr int kQueries = 40'000;
    double mean_ns = 0;
    for (int i = 0; i < kQueries; ++i) {
      mean_ns += ns_of_wait(bursts, 0, at_ms(100 + i + draws.uniform())) / kQueries;
    }
    EXPECT_NEAR(mean_ns / (load / (2 * (1 - load)) * kFrameNs), 1.02, 0.03)
        << "load " << load << ", seed " << kBurstSeed;
  }
}

std::vector<BurstStream> strange_streams() {
  return {{.kind = TrafficKind::kRandom,
           .ports = {0, 3, 4},
           .bytes_per_ns = 0.2 * kLine,
           .burst_frames = 5},
          {.kind = TrafficKind::kPaced,
           .ports = {1, 3, 4},
           .bytes_per_ns = 0.3 * kLine,
           .burst_frames = 20.5},
          {.kind = TrafficKind::kRandom,
           .ports = {2, 4},
           .bytes_per_ns = 0.1 * kLine,
           .begin = at_ms(200)}};
}

TEST(FrameBurstsTest, DoesNotDependOnWhatIsAsked) {
  const std::vector<double> buffers{0, 0, 0, 128e3, 128e3};
  FrameBursts forwards(kLine, strange_streams(), buffers, kBurstSeed);
  FrameBursts backwards(kLine, strange_streams(), buffers, kBurstSeed);
  std::vector<Nanoseconds> seen;
  for (int i = 0; i < 300; ++i) {
    forwards.wait(3, at_ms(100 + i));
    seen.push_back(forwards.wait(4, at_ms(100 + 1.7 * i)));
  }
  for (int i = 299; i >= 0; --i) {
    ASSERT_EQ(backwards.wait(4, at_ms(100 + 1.7 * i)), seen[static_cast<std::size_t>(i)]) << i;
  }
  EXPECT_GT(*std::max_element(seen.begin(), seen.end()), from_us(20));
}

TEST(FrameBurstsTest, AskedForTooMuchAPortIsFull) {
  FrameBursts bursts(kLine,
                     {{.kind = TrafficKind::kPaced, .ports = {0, 2}, .bytes_per_ns = 0.8 * kLine},
                      {.kind = TrafficKind::kPaced, .ports = {1, 2}, .bytes_per_ns = 0.8 * kLine}},
                     {0, 0, 128e3}, kBurstSeed);
  EXPECT_NEAR(bursts.overload_share(2), 1 - 1 / 1.6, 1e-9);
  EXPECT_NEAR(bursts.overload_share(2, at_ms(1000)), 1 - 1 / 1.6, 1e-9);
  EXPECT_EQ(bursts.overload_share(0), 0);
  EXPECT_NEAR(ns_of_wait(bursts, 2, at_ms(1000)), 128e3 / kLine, 2 * kFrameNs);
}

TEST(FrameBurstsTest, CostIsShown) {
  const std::vector<double> buffers{0, 0, 0, 128e3, 128e3};
  FrameBursts bursts(kLine, strange_streams(), buffers, kBurstSeed);
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < 200; ++i) bursts.wait(4, at_ms(1000 + 10 * i));
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  std::printf("%.0f us for a message\n", took.count() / 200 * 1e6);
}

}  // namespace
}  // namespace simbench::sim
