// A network of some hosts, and the ends of its links.
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "sim/network/network.h"
#include "tests/sim/at_ms.h"

namespace simbench::sim {

inline constexpr std::uint64_t kNetworkSeed = 4242;

// Latency 1 ms each way and nothing else.
inline scenarios::Network plain_network() {
  scenarios::Network network{};
  network.latency_fixed_ms = 1;
  network.retransmit_timeout_ms = 200;
  network.stamp_point = scenarios::StampPoint::kApplication;
  return network;
}

struct Seen {
  std::uint8_t number;
  double at_ms;
};

// One end of a link: remembers what arrives, and when what it sends has left.
class Probe : public Endpoint {
 public:
  Probe(SimNetwork& network, const Engine& engine, PeerId from, PeerId to, Transport transport)
      : network_(network),
        engine_(engine),
        from_(from),
        path_(network.open(from, to, transport, *this)) {}

  void send(std::uint8_t number, std::size_t bytes = 1) {
    Bytes message(bytes);
    message[0] = std::byte{number};
    network_.send(path_, next_++, std::move(message));
  }
  // From this probe's host, one copy to the other end of each of these.
  void send_to_group(const std::vector<Probe*>& to, std::uint8_t number, std::size_t bytes) {
    std::vector<SimNetwork::Recipient> recipients;
    recipients.reserve(to.size());
    for (Probe* each : to) recipients.push_back({each->path_, each->next_++});
    Bytes message(bytes);
    message[0] = std::byte{number};
    network_.send_to_group(from_, left_ms.size(), std::move(recipients), std::move(message), *this);
  }
  void on_arrival() override {
    for (const ArrivedMessage& message : network_.inbox(path_)) {
      arrived.push_back({std::to_integer<std::uint8_t>(message.bytes[0]), ms_of(message.at)});
    }
    network_.inbox(path_).clear();
  }
  void on_left(MessageId first, std::size_t count, const HostDeparture&) override {
    EXPECT_EQ(first, left_ms.size());
    left_ms.insert(left_ms.end(), count, ms_of(engine_.now()));
  }

  std::vector<Seen> arrived;
  std::vector<double> left_ms;

 private:
  SimNetwork& network_;
  const Engine& engine_;
  PeerId from_;
  PathId path_;
  MessageId next_ = 0;
};

// A network of some hosts in which things are sent at given times.
class World {
 public:
  explicit World(const scenarios::Network& parameters, std::uint64_t seed = kNetworkSeed)
      : parameters_(parameters),
        load_(seed, "load", scenarios::Hosts{}, parameters_),
        network_(engine_, parameters_, seed, 8, load_, outages_) {}

  Probe& probe(PeerId from, PeerId to, Transport transport = Transport::kStream) {
    probes_.push_back(std::make_unique<Probe>(network_, engine_, from, to, transport));
    return *probes_.back();
  }
  void send_at(double ms, Probe& probe, std::uint8_t number, std::size_t bytes = 1) {
    engine_.call_at(at_ms(ms), [&probe, number, bytes] { probe.send(number, bytes); });
  }
  // To a group: the other ends of these probes, which must live as long as the world.
  void send_to_group_at(double ms, Probe& sender, const std::vector<Probe*>& to,
                        std::uint8_t number, std::size_t bytes) {
    engine_.call_at(at_ms(ms),
                    [&sender, &to, number, bytes] { sender.send_to_group(to, number, bytes); });
  }
  void run() { engine_.run(); }

 private:
  scenarios::Network parameters_;
  Engine engine_;
  RunLoad load_;
  Outages outages_{std::vector<scenarios::Fault>{}};
  SimNetwork network_;
  std::vector<std::unique_ptr<Probe>> probes_;
};

inline std::vector<std::uint8_t> numbers(const std::vector<Seen>& seen) {
  std::vector<std::uint8_t> all;
  all.reserve(seen.size());
  for (const Seen& message : seen) all.push_back(message.number);
  return all;
}
inline std::vector<double> times(const std::vector<Seen>& seen) {
  std::vector<double> all;
  all.reserve(seen.size());
  for (const Seen& message : seen) all.push_back(message.at_ms);
  return all;
}

}  // namespace simbench::sim
