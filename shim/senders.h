// Who sent a signal: the kernel's numbers of processes are the machine's, and signals from one
// process of the world to another come by way of the world.
//
//   siginfo_t info{};
//   show_sender(info);
//   print(info.si_pid);
#pragma once

#include <signal.h>
#include <sys/signalfd.h>

namespace simbench::shim {

// As the program is to see it.
void show_sender(siginfo_t& info);
void show_sender(signalfd_siginfo& info);

}  // namespace simbench::shim
