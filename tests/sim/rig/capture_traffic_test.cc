// Frames that their hosts send on delay the hosts' messages (sim/rig/capture_reports.h,
// sim/network/network.h).
#include <gtest/gtest.h>

#include <algorithm>
#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/this_coro.hpp>
#include <utility>
#include <vector>

#include "tests/nonempty.h"
#include "tests/sim/rig/ideal_scenario.h"
#include "tests/sim/rig/test_world.h"

namespace simbench::sim {
namespace {

constexpr double kMbitPerS = 1000;
constexpr double kFrameBytes = 848 * 480 * 2;
constexpr double kFrameMs = kFrameBytes * 8 / kMbitPerS * 1e-3;  // 6.51 ms on the wire
constexpr double kPeriodMs = 1e3 / 45;

// Three cameras on host 1, none on the master: 879 Mbit/s of 1 Gbit/s.
scenarios::Scenario saturated_scenario() {
  scenarios::Scenario s = ideal_scenario();
  s.timeline.frames = 45 * 20;
  s.network.latency_fixed_ms = 0.1;
  s.network.bandwidth_mbit_per_s = kMbitPerS;
  s.network.capture_traffic_share = 1;
  s.network.stamp_point = scenarios::StampPoint::kKernel;
  s.cameras.count = 3;
  s.cameras.cameras_per_host = 3;
  s.cameras.host_of_camera = {1, 1, 1};
  s.cameras.streams[0].width = 848;
  s.cameras.streams[0].height = 480;
  s.usb.delivery_jitter_transfers = 0.1;
  return s;
}

struct Delays {
  std::vector<double> sent_ms;
  std::vector<double> delay_ms;
};

// Clocks are exact, so stamps of two hosts may be subtracted.
Task<void> send_stamps(Host& host, PeerId peer, Nanoseconds interval) {
  MessageChannel& channel = host.open_channel(peer, Transport::kDatagram);
  for (std::int64_t i = 1;; ++i) {
    co_await host.sleep_until(HostTime(i * interval));
    const HostTime now = co_await host.clock().now();
    Bytes message(8);
    auto ns = static_cast<std::uint64_t>(now.time_since_epoch().count());
    for (std::byte& byte : message) {
      byte = static_cast<std::byte>(ns & 0xFF);
      ns >>= 8;
    }
    co_await channel.send(std::move(message));
  }
}

Task<void> receive_stamps(Host& host, PeerId peer, Delays& delays) {
  MessageChannel& channel = host.open_channel(peer, Transport::kDatagram);
  for (;;) {
    const auto message = co_await channel.receive(kNoDeadline);
    std::uint64_t ns = 0;
    for (std::size_t i = 8; i-- > 0;) {
      ns = (ns << 8) | std::to_integer<std::uint64_t>(message->bytes[i]);
    }
    delays.sent_ms.push_back(static_cast<double>(ns) * 1e-6);
    delays.delay_ms.push_back(to_ms(message->received.time_since_epoch()) - delays.sent_ms.back());
  }
}

// Both directions of the link, a message every 7.3 ms each.
class ProbeSync final : public HostSync {
 public:
  std::optional<Nanoseconds> warm_up() const override { return from_ms(0); }
  Task<void> run_master(Host& host, std::vector<PeerId>) override {
    spawn(co_await boost::asio::this_coro::executor, receive_stamps(host, 1, to_master));
    co_await send_stamps(host, 1, from_ms(7.3));
  }
  Task<void> run_slave(Host& host, PeerId master) override {
    spawn(co_await boost::asio::this_coro::executor, receive_stamps(host, master, to_slave));
    co_await send_stamps(host, master, from_ms(7.3));
  }
  Delays to_master;
  Delays to_slave;

 private:
  static void spawn(const boost::asio::any_io_executor& executor, Task<void> task) {
    boost::asio::co_spawn(executor, std::move(task), boost::asio::detached);
  }
};

// When host 1's port is free of the frames that arrived by then.
double backlog_ms(const KeptLists& kept, double at_ms, double frame_ms) {
  double free_at_ms = 0;
  for (const auto& frame : kept.frames) {
    const double arrival_ms = to_ms(frame.record.arrival.time_since_epoch());
    if (arrival_ms >= at_ms) break;
    free_at_ms = std::max(free_at_ms, arrival_ms) + frame_ms;
  }
  return std::max(0.0, free_at_ms - at_ms);
}

TEST(CaptureTraffic, MessagesOfTheHostWaitBehindItsFrames) {
  ProbeSync probe;
  KeptLists kept;
  run_world(saturated_scenario(), &probe, kept);
  ASSERT_GT(probe.to_master.delay_ms.size(), 2700u);
  const double wire_ms = 2 * 8 * 8 / kMbitPerS * 1e-3;
  double sum = 0;
  double largest = 0;
  double n = 0;
  for (std::size_t i = 0; i < probe.to_master.delay_ms.size(); ++i) {
    const double waited_ms = probe.to_master.delay_ms[i] - 0.1 - wire_ms;
    EXPECT_NEAR(waited_ms, backlog_ms(kept, probe.to_master.sent_ms[i], kFrameMs), 1e-3) << i;
    if (probe.to_master.sent_ms[i] < 1000) continue;
    sum += waited_ms;
    largest = std::max(largest, waited_ms);
    n += 1;
  }
  // Three frames come almost together: a queue of 19.5 ms that runs down within the period.
  const double burst_ms = 3 * kFrameMs;
  EXPECT_NEAR(sum / n, burst_ms * burst_ms / (2 * kPeriodMs), 0.6);
  EXPECT_LT(largest, kPeriodMs) << "the queue is empty before the next pulse's frames come";
  EXPECT_GT(largest, 17);
  for (const double delay_ms : nonempty(probe.to_slave.delay_ms)) {
    EXPECT_NEAR(delay_ms, 0.1 + wire_ms, 1e-6) << "the other direction is free";
  }
}

TEST(CaptureTraffic, AShareOfTheFramesIsAShareOfTheQueue) {
  scenarios::Scenario s = saturated_scenario();
  s.network.capture_traffic_share = 0.25;
  ProbeSync probe;
  KeptLists kept;
  run_world(s, &probe, kept);
  for (std::size_t i = 0; i < nonempty(probe.to_master.delay_ms).size(); ++i) {
    EXPECT_NEAR(probe.to_master.delay_ms[i] - 0.1 - 128e-6,
                backlog_ms(kept, probe.to_master.sent_ms[i], kFrameMs / 4), 1e-3);
  }
}

TEST(CaptureTraffic, AnOverloadedPortsQueueIsBounded) {
  scenarios::Scenario s = saturated_scenario();
  s.network.bandwidth_mbit_per_s = 400;
  ProbeSync probe;
  KeptLists kept;
  run_world(s, &probe, kept);
  const double largest_ms =
      *std::max_element(probe.to_master.delay_ms.begin(), probe.to_master.delay_ms.end());
  EXPECT_GT(largest_ms, 1000 - kFrameMs);
  EXPECT_LT(largest_ms, 1000 + 2.5 * kFrameMs + 1);
}

TEST(CaptureTraffic, MovesNoFramesAndCostsNoEvents) {
  scenarios::Scenario s = saturated_scenario();
  KeptLists with;
  const RecordingCost on = run_world(s, nullptr, with);
  s.network.capture_traffic_share = 0;
  KeptLists without;
  const RecordingCost off = run_world(s, nullptr, without);
  EXPECT_EQ(on.trace_hash, off.trace_hash);
}

}  // namespace
}  // namespace simbench::sim
