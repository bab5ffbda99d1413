// Names the system call that the kernel's filter has stopped.
#include "shim/refused_calls.h"

#include <signal.h>
#include <stdlib.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "shim/link.h"

namespace simbench::shim {
namespace {

const char* reason_of(Refusal refusal) {
  return refusal == Refusal::kForbidden ? " is not for programs of the simulated world"
                                        : " was not intercepted";
}

// The call waits at the filter, on the thread that made it.
[[noreturn]] void on_refused_call(int /*signal*/, siginfo_t* info, void* /*context*/) {
  for (const RefusedCall& call : kRefusedCalls) {
    if (call.number == info->si_syscall) give_up(call.name, reason_of(call.refusal));
  }
  give_up("a system call was not intercepted");
}

// The kernel's struct sigaction, which is not libc's.
struct KernelAction {
  void (*handler)(int, siginfo_t*, void*);
  unsigned long flags;
  void (*restorer)();  // where a handler returns to; this one does not
  unsigned long mask;
};

#ifdef SA_RESTORER
constexpr unsigned long kRestorer = SA_RESTORER;
#else
constexpr unsigned long kRestorer = 0x04000000;
#endif

// Makes the system call itself: the filter lets nobody else have this signal.
__attribute__((constructor)) void name_refused_calls() {
  if (getenv(kLinkVariable) == nullptr) return;
  const KernelAction action{.handler = on_refused_call,
                            .flags = SA_SIGINFO | SA_NODEFER | kRestorer,
                            .restorer = abort,
                            .mask = 0};
  syscall(SYS_rt_sigaction, SIGSYS, &action, nullptr, sizeof action.mask, kOfTheShim);
}

}  // namespace
}  // namespace simbench::shim
