// How long a datagram takes through this machine's network stack, between the calls of a program
// and the stamps of the kernel.
//
// Two threads in two network namespaces, joined by a veth pair, send each other nothing but the
// measured datagrams, of 48 bytes as NTP's, 5 to 15 ms apart by chance. The kernel stamps each in
// software as it leaves and as it arrives (SO_TIMESTAMPING); the receiver waits in poll(2), as
// daemons do. All instants are of one clock, CLOCK_REALTIME:
//
//   send call -- transmit --> software stamp -- passage --> software stamp -- wake-up --> recvmsg
//                                                                                         returns
//
// What it cannot see: a network card, its interrupt and the driver's rings. The passage is a
// virtual cable; veth hands the datagram to the receiver's queue within the sender's call.
//
// Contract: the calling thread is in NetworkSandbox::enter()'s namespace. `busy_threads` threads
// compute all the while, at the priority of the two.
//
// Errors: SandboxError; std::runtime_error if the kernel gives no stamps, a datagram is lost, or
// the system clock was set meanwhile.
//
// Source: the kernel's Documentation/networking/timestamping.rst, veth(4).
//
//   NetworkSandbox::enter();
//   StackDelays idle = measure_stack_delays({.messages = 6000});
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace simbench::hardware {

struct StackDelaySettings {
  std::size_t messages = 6000;
  unsigned busy_threads = 0;
  std::function<bool()> cancelled{};  // may be empty; then fewer messages are returned
};

// The delays of each message, in the order of sending, as drawn above.
struct StackDelays {
  std::vector<double> transmit_us;  // from the send call to the software stamp of the departure
  std::vector<double> passage_us;   // from that stamp to the one of the arrival
  std::vector<double> wake_up_us;   // from that one to the return of recvmsg()
};

StackDelays measure_stack_delays(const StackDelaySettings& settings);

}  // namespace simbench::hardware
