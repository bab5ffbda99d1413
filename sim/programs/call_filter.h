// The kernel's filter of system calls, made of the table of refused ones (shim/refused_calls.h).
//
// Calls of another architecture than the machine's own kill the program. A call that ends the
// program is SECCOMP_RET_TRAP: the kernel raises SIGSYS on the thread that made it.
//
//   std::vector<sock_filter> filter = call_filter("/usr/sbin/chronyd");
//   set_own_process(filter, 4711);
//   const sock_fprog ready{static_cast<unsigned short>(filter.size()), filter.data()};
//
// Source: seccomp(2), bpf(4).
#ifndef SIMBENCH_SIM_PROGRAMS_CALL_FILTER_H_
#define SIMBENCH_SIM_PROGRAMS_CALL_FILTER_H_

#include <linux/filter.h>

#include <cstdint>
#include <span>
#include <vector>

namespace simbench::sim {

// execve() is allowed for the name at this address, which is where the caller of execve() has it.
// Signals are allowed to one process, which is kOwnProcess until set_own_process() replaces it.
std::vector<sock_filter> call_filter(const char* program);

// What is written where the number of the process goes.
inline constexpr std::uint32_t kOwnProcess = 0x7FFFFFFE;
void set_own_process(std::span<sock_filter> filter, std::uint32_t process);

}  // namespace simbench::sim

#endif  // SIMBENCH_SIM_PROGRAMS_CALL_FILTER_H_
