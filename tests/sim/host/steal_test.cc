#include "sim/host/steal.h"

#include <gtest/gtest.h>

#include "sim/host/message_stack.h"
#include "tests/sim/at_ms.h"

namespace simbench::sim {
namespace {

constexpr std::uint64_t kStealSeed = 11;

double ms_of_wait(const StolenTime& stolen, double at) {
  return to_ns(stolen.wait(at_ms(at))) * 1e-6;
}

TEST(StolenTime, WhatComesWaitsForTheEndOfTheSlice) {
  const StolenTime stolen({.share = 0.25, .slice_ms = 4}, kStealSeed, 1);
  int away = 0;
  double waited_ms = 0;
  constexpr int kInstants = 200'000;
  for (int i = 0; i < kInstants; ++i) {
    const double at = i * 0.37;
    const double wait = ms_of_wait(stolen, at);
    ASSERT_LE(wait, 4);
    away += wait > 0;
    waited_ms += wait / kInstants;
    // All that falls into a slice ends with it.
    if (wait > 0.2) {
      ASSERT_NEAR(ms_of_wait(stolen, at + 0.1), wait - 0.1, 2e-6);
    }
  }
  EXPECT_NEAR(static_cast<double>(away) / kInstants, 0.25, 0.005);
  EXPECT_NEAR(waited_ms, 0.25 * 4 / 2, 0.01);
}

TEST(StolenTime, HostsHaveSlicesOfTheirOwn) {
  const scenarios::Steal steal{.share = 0.5, .slice_ms = 4};
  int both = 0;
  for (PeerId host = 0; host < 400; host += 2) {
    const StolenTime one(steal, kStealSeed, host);
    const StolenTime other(steal, kStealSeed, host + 1);
    for (int i = 0; i < 200; ++i) {
      both += ms_of_wait(one, i * 1.37) > 0 && ms_of_wait(other, i * 1.37) > 0;
    }
  }
  EXPECT_NEAR(both / 40'000.0, 0.25, 0.02);
}

TEST(StolenTime, NothingStolenIsNoWait) {
  const StolenTime stolen({.share = 0, .slice_ms = 4}, kStealSeed, 1);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(stolen.wait(at_ms(i)), Nanoseconds(0));
}

TEST(StolenTime, SoftwareWaitsAndTheCardDoesNot) {
  scenarios::Hosts hosts;
  hosts.count = 2;
  hosts.steal = scenarios::Steal{.share = 0.9, .slice_ms = 9};
  MessageStack stack(hosts, kStealSeed, 0);
  const StolenTime stolen(*hosts.steal, kStealSeed, 0);
  double at = 1;
  while (ms_of_wait(stolen, at) < 1) at += 0.5;
  const Nanoseconds wait = stolen.wait(at_ms(at));
  EXPECT_EQ(stack.transmit(at_ms(at), {1, 0}), wait);
  EXPECT_EQ(stack.receive(at_ms(at), {1, 0}), at_ms(at) + wait);
  EXPECT_EQ(stack.wake_up(at_ms(at), {1, 0}), wait);
  EXPECT_EQ(stack.to_card(at_ms(at), {1, 0}), Nanoseconds(0));
}

TEST(IoLoad, PutsOffTheKernelAndWakeUps) {
  scenarios::Hosts hosts;
  hosts.count = 2;
  hosts.io_load = scenarios::IoLoad{.receive = {.fixed_us = 100}, .wake_up = {.fixed_us = 7}};
  MessageStack stack(hosts, kStealSeed, 0);
  EXPECT_EQ(stack.transmit(at_ms(1), {1, 0}), Nanoseconds(0));
  EXPECT_EQ(stack.receive(at_ms(1), {1, 0}), at_ms(1) + from_us(100));
  EXPECT_EQ(stack.wake_up(at_ms(1), {1, 0}), from_us(7));
}

}  // namespace
}  // namespace simbench::sim
