// Networks of two or three hosts in one io_context, on the loopback interface.
#pragma once

#include <boost/asio/io_context.hpp>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hardware/net/peer_network.h"
#include "tests/hardware/net/in_time.h"
#include "tests/hardware/net/plain_clock.h"
#include "tests/hardware/net/stream_pair.h"

namespace simbench::hardware {

struct Networks {
  // `hosts_address`: of every host, as a rig file states it.
  explicit Networks(std::size_t hosts, std::string hosts_address = "127.0.0.1")
      : address(std::move(hosts_address)), networks(hosts) {
    for (PeerId host = 0; host < hosts; ++host) start(host);
  }

  // Hosts of lower number are known by then, those of higher number tell their ports.
  void start(PeerId host, SecretKey key = key_from_digit('7')) {
    PeerNetworkSettings settings;
    settings.me = host;
    settings.key = key;
    settings.listen = {"127.0.0.1", 0};
    for (PeerId peer = 0; peer < networks.size(); ++peer) {
      const bool known = peer < host && networks[peer];
      settings.peers.push_back(
          {address, known ? networks[peer]->port() : static_cast<std::uint16_t>(0)});
    }
    networks[host] = std::make_unique<PeerNetwork>(context, settings, clock);
    networks[host]->start();
  }

  // All links are up, and each has carried a datagram both ways.
  bool connect() {
    const auto up = [this] {
      for (PeerId a = 0; a < networks.size(); ++a) {
        for (PeerId b = 0; b < networks.size(); ++b) {
          if (a != b && !networks[a]->connected(b)) return false;
        }
      }
      return true;
    };
    if (!until(context, up)) return false;
    // What the hosts tell each other first.
    pass(context, 20);
    return true;
  }

  MessageChannel& channel(PeerId from, PeerId to, Transport transport) {
    return networks[from]->channel(to, transport);
  }
  MessageId send(PeerId from, PeerId to, Transport transport, const std::string& text) {
    return in_time(context, channel(from, to, transport).send(bytes_of(text)));
  }
  std::optional<ReceivedMessage> receive(PeerId at, PeerId from, Transport transport,
                                         Nanoseconds patience = std::chrono::seconds(20)) {
    return in_time(context, channel(at, from, transport).receive(clock.steady_now() + patience));
  }
  std::string text(PeerId at, PeerId from, Transport transport,
                   Nanoseconds patience = std::chrono::seconds(20)) {
    const auto message = receive(at, from, transport, patience);
    return message ? text_of(message->bytes) : "(nothing)";
  }
  const NetworkStatistics& statistics(PeerId host) const { return networks[host]->statistics(); }

  std::string address;
  boost::asio::io_context context;
  PlainClock clock;
  std::vector<std::unique_ptr<PeerNetwork>> networks;
};

}  // namespace simbench::hardware
