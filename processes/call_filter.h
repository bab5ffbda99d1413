// The kernel's filter of system calls, made of the table of refused ones (shim/refused_calls.h).
//
// Calls of another architecture than the machine's own kill the program. A call that ends the
// program is SECCOMP_RET_TRAP: the kernel raises SIGSYS on the thread that made it.
//
//   std::vector<sock_filter> filter = call_filter();
//   set_own_process(filter, 4711);
//   const sock_fprog ready{static_cast<unsigned short>(filter.size()), filter.data()};
//
// Source: seccomp(2), bpf(4).
#pragma once

#include <linux/filter.h>

#include <cstdint>
#include <span>
#include <vector>

namespace simbench::processes {

// What the world has of a program's surroundings: all of it, or the system clock alone. Then the
// machine's waits, timers and sockets (IP, and routing to look at) may be used; no clock may be
// set.
enum class Served : std::uint8_t { kAll, kClock };

// Signals are allowed to one process, which is kOwnProcess until set_own_process() replaces it.
// What the program starts has the same filter.
std::vector<sock_filter> call_filter(Served served = Served::kAll);

// What is written where the number of the process goes.
inline constexpr std::uint32_t kOwnProcess = 0x7FFFFFFE;
void set_own_process(std::span<sock_filter> filter, std::uint32_t process);

}  // namespace simbench::processes
