// Which hosts a message to a group is for: what the switches have learnt from the hosts' reports
// (IGMP snooping). Reports take no time and no bandwidth.
//
// A group is a multicast address, or kEveryone for broadcasts, which each host that takes part has
// joined.
//
// Source: RFC 1112; RFC 4541, section 2.1.1. Cost: linear in the members of a group.
//
//   Groups groups;
//   groups.join(0xE0000181, 3);  // 224.0.1.129: PTP
//   for (PeerId host : groups.members(0xE0000181)) send(host);
#pragma once

#include <cstdint>
#include <map>
#include <set>

#include "algorithms/ports/exchange.h"

namespace simbench::sim {

class Groups {
 public:
  static constexpr std::uint32_t kEveryone = 0xFFFFFFFF;

  void join(std::uint32_t group, PeerId host) { members_[group].insert(host); }
  void leave(std::uint32_t group, PeerId host) { members_[group].erase(host); }
  // In order of their numbers.
  const std::set<PeerId>& members(std::uint32_t group) { return members_[group]; }

 private:
  std::map<std::uint32_t, std::set<PeerId>> members_;
};

}  // namespace simbench::sim
