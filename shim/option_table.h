// The options of sockets that are numbers: where they are, what they begin with, what they may be,
// and whether the world must know. Others are in shim/socket_options.cc.
//
// Options that change nothing which a program of the simulated network would notice are kept and
// read back.
//
// Source: socket(7), ip(7), ipv6(7), tcp(7), packet(7); the values that Linux 6.18 begins with.
//
//   const OptionRule* rule = find_rule(kOfUdp4, IPPROTO_IP, IP_TTL);
//   const int begins_with = rule->initial;
#pragma once

#include <cstdint>

#include "shim/protocol.h"

namespace simbench::shim {

// Kinds of sockets, as bits.
enum OptionOwner : std::uint8_t {
  kOfUdp4 = 1,
  kOfUdp6 = 2,
  kOfTcp4 = 4,
  kOfTcp6 = 8,
  kOfPackets = 16,
  kOfNetlink = 32,
  kOfIpv6Sockets = kOfUdp6 | kOfTcp6,
  kOfIp = kOfUdp4 | kOfTcp4 | kOfIpv6Sockets,
  kOfStreams = kOfTcp4 | kOfTcp6,
  kOfDatagrams = kOfUdp4 | kOfUdp6 | kOfPackets,
  kOfAll = kOfIp | kOfPackets | kOfNetlink,
};

enum class OptionForm : std::uint8_t {
  kNumber,   // between `least` and `most`, else EINVAL
  kSwitch,   // any number; 0 or 1 is kept
  kDefault,  // a number, -1 for what it began with
  kByte,     // the lower eight bits of any number
  kRoom,     // twice the number, between `least` and `most`
};

struct OptionRule {
  int level;
  int option;
  std::uint8_t owners;
  OptionForm form;
  int initial;
  int least;
  int most;
  bool is_told;  // to the world, as this:
  SocketOption as;
};

inline constexpr int kMostOptionRules = 128;

// Null if sockets of this kind do not have it.
const OptionRule* find_rule(std::uint8_t owner, int level, int option);
// Its place among all, below kMostOptionRules.
int place_of(const OptionRule& rule);

}  // namespace simbench::shim
