// Where the cables of a host's cards lead.
//
// All hosts are at a switch (sim/network/network.h), to which eth0 is wired. One that knows PTP as
// a transparent clock (/network/switch_clock) stands for the cables of a chain or tree of
// time-aware stations, as for the algorithms (algorithms/host_sync/ptp/gptp.h): each host has a
// card for each neighbour then, the one that it follows (/hosts/follows) first and those that
// follow it after that, in order of their numbers. The master's eth0 leads to the first that
// follows it. All hosts have as many cards as the busiest needs, 16 at most; those beyond a host's
// neighbours have no carrier.
//
// What is sent to one neighbour alone takes a card's cable: frames to an address that no bridge
// forwards by eth0, everything by the others.
//
//   const Cables cables(scenario.hosts, scenario.network, 2, 4);  // host 2 of a chain of 4
//   const std::optional<PeerId> next = cables.neighbour(1);       // host 3, by eth1
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "algorithms/ports/exchange.h"
#include "scenarios/scenario.h"

namespace simbench::sim {

class Cables {
 public:
  static constexpr std::size_t kMostCards = 16;

  Cables(const scenarios::Hosts& parameters, const scenarios::Network& network, PeerId host,
         std::size_t hosts);

  // At least one.
  std::uint32_t cards() const { return cards_; }
  // As bits, of cards whose cable leads somewhere: eth0's does, to the switch.
  std::uint32_t carriers() const;
  // Who is at the other end, if it is one host alone.
  std::optional<PeerId> neighbour(std::uint32_t card) const;
  // The card whose cable leads to the host.
  std::optional<std::uint32_t> card_to(PeerId host) const;

 private:
  std::uint32_t cards_ = 1;
  std::vector<PeerId> neighbours_;
};

}  // namespace simbench::sim
