// One pass of the paper's session between a master and a slave, instant by instant as in
// docs/reference/calibration.md section 2, in a world whose random parts are switched off.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>

#include "tests/sim/host/sim_world.h"

namespace simbench::sim {
namespace {

constexpr int kStamps = 5;
constexpr int kClockCalls = 4;

Bytes bytes_of(HostTime t) {
  const std::int64_t ns = nanoseconds_of(t);
  Bytes bytes(sizeof ns);
  std::memcpy(bytes.data(), &ns, sizeof ns);
  return bytes;
}
HostTime time_of(const Bytes& bytes) {
  std::int64_t ns = 0;
  std::memcpy(&ns, bytes.data(), sizeof ns);
  return HostTime(Nanoseconds(ns));
}

struct Slave {
  double network_delay_ms = 0;  // t_l
  double set_delay_ms = 0;      // t_t
  double measured_ms = 0;       // true time when it sends MEASURED
};

Task<void> run_slave(SimWorld& world, Slave& out) {
  SimHost& host = world.host(1);
  MessageChannel& channel = host.open_channel(0, Transport::kStream);
  const SteadyClock& steady = host.steady_clock();
  co_await channel.receive(kNoDeadline);
  const SteadyTime first = steady.now();
  for (int i = 0; i < kStamps; ++i) co_await channel.receive(kNoDeadline);
  out.network_delay_ms = to_ms(steady.now() - first) / kStamps;
  const SteadyTime before = steady.now();
  for (int i = 0; i < kClockCalls; ++i) {
    const HostTime now = co_await host.clock().now();
    co_await host.clock().set(now);
  }
  out.set_delay_ms = to_ms(steady.now() - before) / (2 * kClockCalls);
  out.measured_ms = world.now_ms();
  co_await channel.send(Bytes(1));
  const std::optional<ReceivedMessage> stamp = co_await channel.receive(kNoDeadline);
  const double delay_ms = out.network_delay_ms + out.set_delay_ms;
  co_await host.clock().set(time_of(stamp->bytes) + from_ms(delay_ms));
  const HostTime now = co_await host.clock().now();
  co_await channel.send(bytes_of(now));
}

struct Master {
  HostTime t_m{};
  HostTime t_s{};
  HostTime t_r{};
  double read_ms = 0;  // true time of T_m
  double reply_ms = 0;
};

Task<void> run_master(SimWorld& world, Master& out) {
  SimHost& host = world.host(0);
  MessageChannel& channel = host.open_channel(1, Transport::kStream);
  for (int i = 0; i < 1 + kStamps; ++i) co_await channel.send(Bytes(8));
  co_await channel.receive(kNoDeadline);
  out.read_ms = world.now_ms();
  out.t_m = co_await host.clock().now();
  co_await channel.send(bytes_of(out.t_m));
  const std::optional<ReceivedMessage> reply = co_await channel.receive(kNoDeadline);
  out.t_s = time_of(reply->bytes);
  out.reply_ms = world.now_ms();
  out.t_r = co_await host.clock().now();
}

TEST(SessionModelTest, EveryInstantOfAPassIsAsCalculated) {
  constexpr double kSend = 0.01;
  constexpr double kLatency = 0.15;
  constexpr double kWake = 0.02;
  constexpr double kRead = 0.001;
  constexpr double kSet = 4.5;
  scenarios::Scenario scenario = ideal_hosts();
  scenario.hosts.send_cost_ms = kSend;
  scenario.hosts.receive_wake_up_ms = kWake;
  scenario.hosts.clock.read_cost_ms = kRead;
  scenario.hosts.clock.set_cost_ms = kSet;
  scenario.hosts.clock.set_effective_fraction = 0.25;
  scenario.hosts.clock.resolution_ms = 1;
  scenario.network.latency_fixed_ms = kLatency;
  SimWorld world(scenario);
  Slave slave;
  Master master;
  world.spawn(run_slave(world, slave));
  world.spawn(run_master(world, master));
  world.engine.run();

  // Steps 1 and 2: the wake-up costs more than the sender's occupancy, so stamps queue.
  double fin = kSend + kLatency + kWake;
  for (int i = 1; i <= kStamps; ++i) {
    fin = std::max((i + 1) * kSend + kLatency, fin) + kWake;
  }
  EXPECT_NEAR(slave.network_delay_ms, kWake, 1e-9);
  // Step 3.
  EXPECT_NEAR(slave.set_delay_ms, (kRead + kSet) / 2, 1e-9);
  EXPECT_NEAR(slave.measured_ms, fin + kClockCalls * (kRead + kSet), 1e-9);
  // Step 4.
  EXPECT_NEAR(master.read_ms, slave.measured_ms + kSend + kLatency + kWake, 1e-9);
  EXPECT_EQ(master.t_m, host_ms(std::floor(master.read_ms)));
  // Step 5: the last step of the slave's clock.
  const double arrival = master.read_ms + kRead + kSend + kLatency + kWake;
  const ClockAdjustment& step = world.record.adjustments.back();
  EXPECT_EQ(step.at, world.hosts.clock(1).steady(at_ms(arrival + 0.25 * kSet)));
  const double set_to_ms = std::floor(ms_of(master.t_m) + kWake + (kRead + kSet) / 2);
  EXPECT_EQ(step.after, host_ms(set_to_ms));
  EXPECT_EQ(master.t_s, host_ms(std::floor(set_to_ms + 0.75 * kSet)));
  // Step 6.
  EXPECT_NEAR(master.reply_ms, arrival + kSet + kRead + kSend + kLatency + kWake, 1e-9);
  EXPECT_EQ(master.t_r, host_ms(std::floor(master.reply_ms)));
}

}  // namespace
}  // namespace simbench::sim
