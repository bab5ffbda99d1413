// Serves the system call that the kernel's filter has stopped, or names it.
#include "shim/refused_calls.h"

#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/syscall.h>
#include <ucontext.h>
#include <unistd.h>

#include "shim/begin.h"
#include "shim/link.h"
#include "shim/served_calls.h"

namespace simbench::shim {
namespace {

const char* reason_of(Refusal refusal) {
  return refusal == Refusal::kForbidden ? " is not for programs of the simulated world"
                                        : " was not intercepted";
}

[[noreturn]] void name_call(int number, const Word* arguments) {
  const char* name = nullptr;
  const char* reason = " was not intercepted";
  for (const RefusedCall& call : kRefusedCalls) {
    if (call.number != number) continue;
    name = call.name;
    reason = reason_of(call.refusal);
  }
  char text[160];
  if (name != nullptr) {
    snprintf(text, sizeof text, "%s(%#lx, %#lx, %#lx)", name, arguments[0], arguments[1],
             arguments[2]);
  } else {
    snprintf(text, sizeof text, "system call %d", number);
  }
  give_up(text, reason);
}

#if defined(__x86_64__)
void read_arguments(const ucontext_t& context, Word* arguments) {
  constexpr int kPlaces[] = {REG_RDI, REG_RSI, REG_RDX, REG_R10, REG_R8, REG_R9};
  for (int i = 0; i < 6; ++i) arguments[i] = context.uc_mcontext.gregs[kPlaces[i]];
}
void write_result(ucontext_t& context, Word result) { context.uc_mcontext.gregs[REG_RAX] = result; }
#elif defined(__aarch64__)
void read_arguments(const ucontext_t& context, Word* arguments) {
  for (int i = 0; i < 6; ++i) arguments[i] = static_cast<Word>(context.uc_mcontext.regs[i]);
}
void write_result(ucontext_t& context, Word result) {
  context.uc_mcontext.regs[0] = static_cast<unsigned long long>(result);
}
#endif

// The call waits at the filter, on the thread that made it.
void on_refused_call(int /*signal*/, siginfo_t* info, void* stopped) {
  auto& context = *static_cast<ucontext_t*>(stopped);
  const int before = errno;
  Word arguments[6];
  read_arguments(context, arguments);
  Word result = 0;
  if (!serve_call(info->si_syscall, arguments, result)) name_call(info->si_syscall, arguments);
  write_result(context, result);
  errno = before;
}

// The kernel's struct sigaction, which is not libc's.
struct KernelAction {
  void (*handler)(int, siginfo_t*, void*);
  unsigned long flags;
  void (*restorer)();
  unsigned long mask;
};

#ifdef SA_RESTORER
constexpr unsigned long kRestorer = SA_RESTORER;
#else
constexpr unsigned long kRestorer = 0x04000000;
#endif

// Where a handler returns to: with the bytes by which unwinders know it.
#if defined(__x86_64__)
extern "C" void simbench_return_from_signal();
__asm__(
    ".text\n.hidden simbench_return_from_signal\nsimbench_return_from_signal:\n"
    "movq $15, %rax\nsyscall\n");
#elif defined(__aarch64__)
extern "C" void simbench_return_from_signal();
__asm__(
    ".text\n.hidden simbench_return_from_signal\nsimbench_return_from_signal:\n"
    "mov x8, #139\nsvc #0\n");
#endif

}  // namespace

void handle_in_shim(int signal, void (*handler)(int, siginfo_t*, void*)) {
  const KernelAction action{.handler = handler,
                            .flags = SA_SIGINFO | SA_NODEFER | kRestorer,
                            .restorer = simbench_return_from_signal,
                            .mask = 0};
  machine_call(SYS_rt_sigaction, signal, &action, nullptr, sizeof action.mask, kOfTheShim);
}

// Makes the system call itself: the filter lets nobody else have this signal.
void serve_refused_calls() { handle_in_shim(SIGSYS, on_refused_call); }

}  // namespace simbench::shim
