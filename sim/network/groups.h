// Which hosts a message to a group is for: what the switches have learnt from the hosts' reports
// (IGMP and MLD snooping). Reports take no time and no bandwidth.
//
// A group is an IPv4 multicast address, an Ethernet one, or kEveryone for broadcasts and for what
// switches flood, which each host that takes part has joined.
//
// Source: RFC 1112; RFC 4541, section 2.1.1. Cost: linear in the members of a group.
//
//   Groups groups;
//   groups.join(0xE0000181, 3);  // 224.0.1.129: PTP
//   groups.join(Groups::of_ethernet(0x333300000181), 3);  // ff0e::181
//   for (PeerId host : groups.members(0xE0000181)) send(host);
#pragma once

#include <cstdint>
#include <map>
#include <set>

#include "algorithms/ports/exchange.h"

namespace simbench::sim {

class Groups {
 public:
  using Id = std::uint64_t;
  static constexpr std::uint32_t kEveryone = 0xFFFFFFFF;

  // `address`: its six bytes as a number, the first sent the highest.
  static constexpr Id of_ethernet(std::uint64_t address) {
    return std::uint64_t{1} << 48 | address;
  }

  void join(Id group, PeerId host) { members_[group].insert(host); }
  void leave(Id group, PeerId host) { members_[group].erase(host); }
  // In order of their numbers.
  const std::set<PeerId>& members(Id group) { return members_[group]; }

 private:
  std::map<Id, std::set<PeerId>> members_;
};

}  // namespace simbench::sim
