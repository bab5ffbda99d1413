#include "sim/network/switch_clock.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "sim/network/network.h"
#include "tests/sim/at_ms.h"

namespace simbench::sim {
namespace {

using scenarios::SwitchClockKind;

// A PTPv2 message of this type, with this in its correctionField.
Bytes ptp(std::uint8_t type, std::int64_t correction = 0, std::size_t size = 44) {
  Bytes message(size);
  message[0] = std::byte{static_cast<std::uint8_t>(0xF0 | type)};  // transportSpecific is no matter
  message[1] = std::byte{0x12};                                    // minor version 1
  message[3] = static_cast<std::byte>(size);
  auto field = static_cast<std::uint64_t>(correction);
  for (std::size_t i = 16; i-- > 8; field >>= 8) message[i] = static_cast<std::byte>(field & 0xFF);
  return message;
}

double correction_ns(const Bytes& message) {
  std::uint64_t field = 0;
  for (std::size_t i = 8; i < 16; ++i) field = (field << 8) | std::to_integer<unsigned>(message[i]);
  return static_cast<double>(static_cast<std::int64_t>(field)) / 65536;
}

scenarios::Network with_switch(scenarios::SwitchClockKind kind, double error_ns = 0) {
  scenarios::Network network{};
  network.switch_clock = kind;
  network.switch_clock_error_ns = error_ns;
  network.stamp_point = scenarios::StampPoint::kKernel;
  return network;
}

TEST(SwitchClock, KnowsEventMessagesOfVersion2) {
  const SwitchClock clock(with_switch(SwitchClockKind::kTransparent), 1);
  for (std::uint8_t type = 0; type < 16; ++type) {
    EXPECT_EQ(clock.corrects(ptp(type)), type <= 3) << int{type};
  }
  EXPECT_FALSE(clock.corrects(ptp(0, 0, 43)));
  EXPECT_TRUE(clock.corrects(ptp(0, 0, 100)));
  Bytes with_trailer = ptp(0);
  with_trailer.resize(124);
  EXPECT_TRUE(clock.corrects(with_trailer));
  with_trailer.resize(125);
  EXPECT_FALSE(clock.corrects(with_trailer));
  // An NTP request of stratum 2 begins like an event message of version 2.
  Bytes ntp(48);
  ntp[0] = std::byte{0x23};
  ntp[1] = std::byte{2};
  ntp[2] = std::byte{6};
  EXPECT_FALSE(clock.corrects(ntp));
  Bytes version_1 = ptp(0);
  version_1[1] = std::byte{1};
  EXPECT_FALSE(clock.corrects(version_1));
  EXPECT_FALSE(clock.corrects({}));
  EXPECT_FALSE(SwitchClock(with_switch(SwitchClockKind::kNone), 1).corrects(ptp(0)));
}

TEST(SwitchClock, AddsToTheCorrectionFieldInItsUnitAndByteOrder) {
  const SwitchClock clock(with_switch(SwitchClockKind::kTransparent), 1);
  Bytes message = ptp(1);
  clock.correct(message, {.from = 0, .to = 1}, Nanoseconds(0x1234), at_ms(0));
  EXPECT_EQ(message[12], std::byte{0x12});
  EXPECT_EQ(message[13], std::byte{0x34});
  for (const std::size_t zero : {8u, 9u, 10u, 11u, 14u, 15u})
    EXPECT_EQ(message[zero], std::byte{0});
  Bytes negative = ptp(1, -5 * 65536 - 32768);  // -5.5 ns
  clock.correct(negative, {.from = 0, .to = 1}, Nanoseconds(7), at_ms(0));
  EXPECT_EQ(correction_ns(negative), 1.5);
  EXPECT_EQ(negative.size(), 44u);
  EXPECT_EQ(negative[0], ptp(1)[0]);
}

TEST(SwitchClock, TheErrorIsDrawnPerMessage) {
  const SwitchClock clock(with_switch(SwitchClockKind::kTransparent, 40), 9);
  double sum = 0;
  double squares = 0;
  constexpr int kMessages = 10'000;
  for (int id = 0; id < kMessages; ++id) {
    Bytes message = ptp(0);
    clock.correct(message, {.from = 0, .to = 1, .id = static_cast<MessageId>(id)},
                  Nanoseconds(1000), at_ms(id));
    const double error = correction_ns(message) - 1000;
    sum += error;
    squares += error * error;
  }
  EXPECT_NEAR(sum / kMessages, 0, 5 * 40 / std::sqrt(kMessages)) << "seed 9";
  EXPECT_NEAR(std::sqrt(squares / kMessages), 40, 5 * 40 / std::sqrt(2.0 * kMessages)) << "seed 9";
}

// The stationary variance of the servo's error x for noise of variance 1, by iterating the
// covariance of (x, integral) under x' = x - kp (x + n) - d', d' = d + ki (x + n).
double servo_variance() {
  constexpr double kProportional = 0.7;
  constexpr double kIntegral = 0.3;
  const double gain = kProportional + kIntegral;
  double xx = 0;
  double xd = 0;
  double dd = 0;
  for (int i = 0; i < 1000; ++i) {
    // x' = (1 - gain) x - d - gain n; d' = d + ki x + ki n.
    const double a = 1 - gain;
    const double next_xx = a * a * xx - 2 * a * xd + dd + gain * gain;
    const double next_xd = a * kIntegral * xx + (a - kIntegral) * xd - dd - gain * kIntegral;
    dd = kIntegral * kIntegral * xx + 2 * kIntegral * xd + dd + kIntegral * kIntegral;
    xx = next_xx;
    xd = next_xd;
  }
  return xx;
}

TEST(BoundaryClock, HasTheVarianceOfItsServo) {
  const scenarios::Network network = with_switch(SwitchClockKind::kBoundary, 40);
  double squares = 0;
  constexpr int kSeeds = 4000;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const double error_ns = BoundaryClock(network, seed, 0).error_ns(at_ms(0));
    squares += error_ns * error_ns;
  }
  EXPECT_NEAR(std::sqrt(squares / kSeeds) / (40 * std::sqrt(servo_variance())), 1,
              5 / std::sqrt(2.0 * kSeeds))
      << "seeds 1-4000";
}

TEST(BoundaryClock, FollowsAWalkingOscillatorAndDoesNotRunAway) {
  scenarios::Network network = with_switch(SwitchClockKind::kBoundary, 0);
  network.switch_clock_wander_ppb_per_sqrt_s = 1;
  const BoundaryClock clock(network, 3, 0);
  double largest_ns = 0;
  for (int s = 0; s < 36'000; ++s) {
    largest_ns = std::max(largest_ns, std::abs(clock.error_ns(at_ms(1e3 * s))));
  }
  EXPECT_GT(largest_ns, 1) << "seed 3";
  EXPECT_LT(largest_ns, 30) << "seed 3";
}

TEST(BoundaryClock, ReadingsDoNotDependOnTheirOrder) {
  const scenarios::Network network = with_switch(SwitchClockKind::kBoundary, 40);
  const BoundaryClock forward(network, 8, 2);
  const BoundaryClock backward(network, 8, 2);
  std::vector<double> errors_ns;
  errors_ns.reserve(100);
  for (int s = 0; s < 100; ++s) errors_ns.push_back(forward.error_ns(at_ms(997 * s)));
  for (int s = 100; s-- > 0;) {
    EXPECT_EQ(backward.error_ns(at_ms(997 * s)), errors_ns[static_cast<std::size_t>(s)]) << s;
  }
}

TEST(SwitchClock, SlavesOfABoundaryClockAreAheadOfTheMasterByItsError) {
  scenarios::Network network = with_switch(SwitchClockKind::kBoundary, 1000);
  network.switch_of_host = {0, 0, 0, 1};
  const SwitchClock clock(network, 5);
  const double near_ns = clock.boundary_error_ns(2, at_ms(7));
  const double far_ns = clock.boundary_error_ns(3, at_ms(7));
  EXPECT_NE(near_ns, far_ns);
  EXPECT_EQ(near_ns, BoundaryClock(network, 5, 0).error_ns(at_ms(7)));
  EXPECT_EQ(far_ns, near_ns + BoundaryClock(network, 5, 1).error_ns(at_ms(7)));
  network.switch_clock = SwitchClockKind::kTransparent;
  const SwitchClock transparent(network, 5);
  const auto extra_ns = [&](PeerId from, PeerId to) {
    Bytes boundary = ptp(0);
    Bytes plain = ptp(0);
    clock.correct(boundary, {.from = from, .to = to}, Nanoseconds(0), at_ms(7));
    transparent.correct(plain, {.from = from, .to = to}, Nanoseconds(0), at_ms(7));
    return correction_ns(boundary) - correction_ns(plain);
  };
  EXPECT_NEAR(extra_ns(0, 2), near_ns, 1e-4);
  EXPECT_NEAR(extra_ns(0, 3), far_ns, 1e-4);
  EXPECT_NEAR(extra_ns(3, 0), -far_ns, 1e-4);
  EXPECT_EQ(extra_ns(2, 3), 0);
}

// What arrived at one end of a link, with the times when it left the other's card.
struct LinkEnd final : Endpoint {
  LinkEnd(SimNetwork& net, PeerId from, PeerId to, Transport transport)
      : network(net), path(net.open(from, to, transport, *this)) {}
  void send(Bytes message) { network.send(path, next++, std::move(message)); }
  void on_arrival() override {
    for (ArrivedMessage& message : network.inbox(path)) arrived.push_back(std::move(message));
    network.inbox(path).clear();
  }
  void on_left(MessageId, std::size_t, const HostDeparture& departure) override {
    passed.push_back(departure.passed);
  }

  SimNetwork& network;
  PathId path;
  MessageId next = 0;
  std::vector<ArrivedMessage> arrived;
  std::vector<TrueTime> passed;
};

struct Link {
  explicit Link(const scenarios::Network& given, Transport transport = Transport::kDatagram)
      : parameters(given),
        load(1, "load", scenarios::Hosts{}, parameters),
        network(engine, parameters, 1, 2, load, outages),
        ends{{network, 0, 1, transport}, {network, 1, 0, transport}} {}

  scenarios::Network parameters;
  Engine engine;
  Outages outages{std::vector<scenarios::Fault>{}};
  RunLoad load;
  SimNetwork network;
  LinkEnd ends[2];
};

scenarios::Network rough_network(SwitchClockKind kind) {
  scenarios::Network network = with_switch(kind);
  network.latency_fixed_ms = 0.5;
  network.latency_exponential_ms = 0.3;
  network.asymmetry_sigma_ms = 0.1;
  network.spike_probability = 0.1;
  network.spike_max_ms = 5;
  network.burst = {.rate_hz = 5, .duration_exponential_ms = 50, .latency_ms = 2};
  network.bandwidth_mbit_per_s = 100;
  network.switch_of_host = {0, 2};
  network.switch_residence_ms = 0.01;
  network.cross_traffic_share = 0.5;
  network.overhead_bytes = 46;
  network.reorder_probability = 0.1;
  network.reorder_max_ms = 3;
  network.duplicate_probability = 0.1;
  network.retransmit_timeout_ms = 200;
  return network;
}

TEST(SwitchClock, OnlyTheCableIsLeftAfterTheCorrection) {
  Link link(rough_network(SwitchClockKind::kTransparent));
  for (int i = 0; i < 200; ++i) {
    for (LinkEnd& end : link.ends) {
      link.engine.call_at(at_ms(i), [&end] { end.send(ptp(0)); });
    }
  }
  link.engine.run();
  double cable_ms[2] = {};
  for (const int to : {0, 1}) {
    const LinkEnd& end = link.ends[to];
    EXPECT_GT(end.arrived.size(), 205u) << "there are duplicates";
    for (const ArrivedMessage& message : end.arrived) {
      const Nanoseconds delay = message.at - link.ends[1 - to].passed.at(message.id);
      const double left_ms = to_ms(delay) - correction_ns(message.bytes) * 1e-6;
      if (cable_ms[to] == 0) cable_ms[to] = left_ms;
      EXPECT_NEAR(left_ms, cable_ms[to], 2e-6) << "message " << message.id;
      EXPECT_GE(correction_ns(message.bytes), 0);
    }
  }
  EXPECT_NEAR(cable_ms[0] + cable_ms[1], 2 * 0.5, 1e-5);
  EXPECT_GT(std::abs(cable_ms[0] - cable_ms[1]), 1e-4) << "the asymmetry stays";
}

TEST(SwitchClock, TouchesNothingElse) {
  Link link(rough_network(SwitchClockKind::kTransparent));
  link.ends[0].send(ptp(8));
  link.ends[0].send(Bytes(44, std::byte{0xAB}));
  link.engine.run();
  EXPECT_EQ(link.ends[1].arrived.at(0).bytes, ptp(8));
  EXPECT_EQ(link.ends[1].arrived.at(1).bytes, Bytes(44, std::byte{0xAB}));
  Link stream(rough_network(SwitchClockKind::kTransparent), Transport::kStream);
  stream.ends[0].send(ptp(0));
  stream.engine.run();
  EXPECT_EQ(stream.ends[1].arrived.at(0).bytes, ptp(0));
}

TEST(SwitchClock, ChangesNoTiming) {
  Link knowing(rough_network(SwitchClockKind::kBoundary));
  Link plain(rough_network(SwitchClockKind::kNone));
  for (Link* link : {&knowing, &plain}) {
    for (int i = 0; i < 100; ++i) {
      link->engine.call_at(at_ms(i), [link] { link->ends[0].send(ptp(0)); });
    }
    link->engine.run();
  }
  EXPECT_EQ(knowing.engine.trace_hash(), plain.engine.trace_hash());
}

}  // namespace
}  // namespace simbench::sim
