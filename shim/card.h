// The network card's clock, /dev/ptp0, as a descriptor of the simulated world: its readings and
// settings through a clock number that the descriptor makes (clock_gettime(2), "dynamic clocks"),
// and its ioctls.
//
// There are no alarms, external stamps, periodic outputs, pins, cross stamps by the processor or
// phase adjustments; rates end at 62 499 999 ppb.
//
//   const int fd = open("/dev/ptp0", O_RDWR);
//   const clockid_t clock = (~static_cast<clockid_t>(fd) << 3) | 3;  // FD_TO_CLOCKID
#pragma once

#include <time.h>

#include <cstdint>

namespace simbench::shim {

// Whether the path is that of a card's clock, there or not.
bool is_card(const char* path);
// As open().
int open_card(const char* path, int flags);
int card_ioctl(unsigned long what, void* argument);
// What the world knows a clock by: its number, or kCardClock for one that a descriptor makes. False
// with EINVAL for a descriptor of something else.
bool world_clock(clockid_t clock, std::int64_t& result);

}  // namespace simbench::shim
