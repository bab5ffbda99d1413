// The network card's clock, /dev/ptp0, as a descriptor of the simulated world: its readings and
// settings through a clock number that the descriptor makes (clock_gettime(2), "dynamic clocks"),
// its ioctls, and the external stamps that are read from it.
//
// Where the host has a line with a pulse per second, the card has a pin, SDP0, that is wired to it,
// and stamps its rising edges (sim/programs/pulse_devices.h). There are no alarms, falling edges,
// periodic outputs, pulses of the card's own (PTP_ENABLE_PPS), cross stamps by the processor
// (PTP_SYS_OFFSET_PRECISE) or phase adjustments.
//
//   const int fd = open("/dev/ptp0", O_RDWR);
//   const clockid_t clock = (~static_cast<clockid_t>(fd) << 3) | 3;  // FD_TO_CLOCKID
#pragma once

#include <sys/types.h>
#include <time.h>

#include <cstddef>
#include <cstdint>

namespace simbench::shim {

int card_ioctl(int fd, unsigned long what, void* argument);
// read(): ptp_extts_event[]. As in Linux it waits, whatever O_NONBLOCK says.
ssize_t read_card(int fd, void* data, std::size_t size);
// What the world knows a clock by: its number, or kCardClock for one that a descriptor makes. False
// with EINVAL for a descriptor of something else.
bool world_clock(clockid_t clock, std::int64_t& result);

}  // namespace simbench::shim
