#include "shim/hidden.h"

#include <elf.h>
#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <time.h>
#include <ucontext.h>
#include <unistd.h>

#include "shim/begin.h"
#include "shim/link.h"
#include "shim/senders.h"

namespace simbench::shim {
namespace {

constexpr std::size_t kPage = 4096;
char own_path[4096];
MachineIds own_ids;

struct sigaction fault_action {};                // the program's own
void (*handlers[NSIG])(int, siginfo_t*, void*);  // likewise, of those that look at the sender

// What the kernel's functions for readers of clocks do from now on: the system call, which the
// filter hands to the shim.
struct Replaced {
  const char* name;
  Word call;
};
constexpr Replaced kReplaced[] = {
    {"__vdso_clock_gettime", SYS_clock_gettime},
    {"__kernel_clock_gettime", SYS_clock_gettime},
    {"__vdso_gettimeofday", SYS_gettimeofday},
    {"__kernel_gettimeofday", SYS_gettimeofday},
#ifdef SYS_time
    {"__vdso_time", SYS_time},
#endif
    {"__vdso_getcpu", SYS_getcpu},
};

void write_call(unsigned char* place, Word call) {
#if defined(__x86_64__)
  const auto number = static_cast<std::uint32_t>(call);
  unsigned char code[] = {0xB8, 0, 0, 0, 0, 0x0F, 0x05, 0xC3};  // mov eax, call; syscall; ret
  memcpy(code + 1, &number, sizeof number);
#elif defined(__aarch64__)
  // mov x8, #call; svc #0; ret
  const std::uint32_t code[] = {0xD2800008U | static_cast<std::uint32_t>(call) << 5U, 0xD4000001U,
                                0xD65F03C0U};
#endif
  memcpy(place, code, sizeof code);
}

struct Symbols {
  const Elf64_Sym* symbols = nullptr;
  const char* names = nullptr;
  std::size_t count = 0;
};

Symbols symbols_of(const unsigned char* image, const Elf64_Ehdr& head) {
  Symbols found;
  const auto* parts = reinterpret_cast<const Elf64_Phdr*>(image + head.e_phoff);
  for (unsigned i = 0; i < head.e_phnum; ++i) {
    if (parts[i].p_type != PT_DYNAMIC) continue;
    for (const auto* entry = reinterpret_cast<const Elf64_Dyn*>(image + parts[i].p_offset);
         entry->d_tag != DT_NULL; ++entry) {
      const unsigned char* place = image + entry->d_un.d_ptr;
      if (entry->d_tag == DT_SYMTAB) found.symbols = reinterpret_cast<const Elf64_Sym*>(place);
      if (entry->d_tag == DT_STRTAB) found.names = reinterpret_cast<const char*>(place);
    }
  }
  // The names follow the symbols.
  if (found.symbols != nullptr && found.names != nullptr) {
    const auto* end = reinterpret_cast<const unsigned char*>(found.names);
    const auto* begin = reinterpret_cast<const unsigned char*>(found.symbols);
    found.count = end > begin ? static_cast<std::size_t>(end - begin) / sizeof(Elf64_Sym) : 0;
  }
  return found;
}

void replace_clock_readers(unsigned char* image) {
  Elf64_Ehdr head{};
  memcpy(&head, image, sizeof head);
  const Symbols known = symbols_of(image, head);
  for (std::size_t i = 0; i < known.count; ++i) {
    const Elf64_Sym& symbol = known.symbols[i];
    for (const Replaced& each : kReplaced) {
      if (symbol.st_value == 0 || strcmp(known.names + symbol.st_name, each.name) != 0) continue;
      unsigned char* page = image + symbol.st_value / kPage * kPage;
      // It may lie across two pages. A kernel that has sealed them leaves the machine's clock.
      if (mprotect(page, 2 * kPage, PROT_READ | PROT_WRITE | PROT_EXEC) != 0 &&
          mprotect(page, kPage, PROT_READ | PROT_WRITE | PROT_EXEC) != 0) {
        continue;
      }
      write_call(image + symbol.st_value, each.call);
      mprotect(page, kPage, PROT_READ | PROT_EXEC);
    }
  }
}

#if defined(__x86_64__)
// RDTSC and RDTSCP give nanoseconds of the world's oscillator: a counter of 1 GHz.
bool serve_counter(ucontext_t& context) {
  auto& registers = context.uc_mcontext.gregs;
  const auto* code = at<const unsigned char>(registers[REG_RIP]);
  const bool is_plain = code[0] == 0x0F && code[1] == 0x31;
  const bool has_processor = code[0] == 0x0F && code[1] == 0x01 && code[2] == 0xF9;
  if (!is_plain && !has_processor) return false;
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  const auto count = static_cast<std::uint64_t>(nanoseconds(now));
  registers[REG_RAX] = static_cast<greg_t>(count & 0xFFFFFFFFU);
  registers[REG_RDX] = static_cast<greg_t>(count >> 32U);
  if (has_processor) registers[REG_RCX] = 0;
  registers[REG_RIP] += is_plain ? 2 : 3;
  return true;
}
#else
bool serve_counter(ucontext_t& /*context*/) { return false; }
#endif

void on_fault(int signal, siginfo_t* info, void* stopped) {
  const int before = errno;
  // What the kernel raises for the counter has no address.
  if (info->si_code == SI_KERNEL && serve_counter(*static_cast<ucontext_t*>(stopped))) {
    errno = before;
    return;
  }
  errno = before;
  if ((fault_action.sa_flags & SA_SIGINFO) != 0) {
    return fault_action.sa_sigaction(signal, info, stopped);
  }
  if (fault_action.sa_handler != SIG_DFL && fault_action.sa_handler != SIG_IGN) {
    return fault_action.sa_handler(signal);
  }
  const bool is_raised = info->si_code <= 0;
  if (is_raised && fault_action.sa_handler == SIG_IGN) return;
  // A fault comes again, and ends the program.
  struct sigaction usual {};
  usual.sa_handler = SIG_DFL;
  SIMBENCH_REAL(sigaction)(SIGSEGV, &usual, nullptr);
  if (is_raised) raise(SIGSEGV);
}

bool is_id(std::uint64_t type) {
  return type == AT_UID || type == AT_EUID || type == AT_GID || type == AT_EGID;
}

// 16 bytes that the kernel took from its chance.
void replace_chance(unsigned char* bytes) {
  Received reply{.data = bytes, .capacity = 16};
  ask({.call = Call::kRandom, .a = 16}, {}, {}, &reply);
}

}  // namespace

const char* shim_path() { return own_path; }

const MachineIds& machine_ids() { return own_ids; }

void set_counter_hidden(bool hidden) {
  machine_call(SYS_prctl, PR_SET_TSC, hidden ? PR_TSC_SIGSEGV : PR_TSC_ENABLE, 0, 0, 0);
}

void hide_machine(char** environment) {
  char** entry = environment;
  constexpr char kPreload[] = "LD_PRELOAD=";
  for (; *entry != nullptr; ++entry) {
    if (strncmp(*entry, kPreload, sizeof kPreload - 1) != 0) continue;
    const char* path = *entry + sizeof kPreload - 1;
    snprintf(own_path, sizeof own_path, "%.*s", static_cast<int>(strcspn(path, ": ")), path);
  }
  for (auto* fact = reinterpret_cast<Elf64_auxv_t*>(entry + 1); fact->a_type != AT_NULL; ++fact) {
    auto* place = at<unsigned char>(static_cast<Word>(fact->a_un.a_val));
    if (fact->a_type == AT_SYSINFO_EHDR) replace_clock_readers(place);
    if (fact->a_type == AT_RANDOM) replace_chance(place);
    if (fact->a_type == AT_EUID) own_ids.user = static_cast<std::uint32_t>(fact->a_un.a_val);
    if (fact->a_type == AT_EGID) own_ids.group = static_cast<std::uint32_t>(fact->a_un.a_val);
    if (is_id(fact->a_type)) fact->a_un.a_val = 0;
  }
  handle_in_shim(SIGSEGV, on_fault);
  set_counter_hidden(true);
}

namespace {

void deliver(int signal, siginfo_t* info, void* stopped) {
  const int before = errno;
  siginfo_t seen = *info;
  show_sender(seen);
  errno = before;
  handlers[signal](signal, &seen, stopped);
}

}  // namespace

// The shim's handler stays the first, and signals that it needs are never blocked.
SIMBENCH_CALL int sigaction(int signal, const struct sigaction* action, struct sigaction* before) {
  if (!is_simulated()) return SIMBENCH_REAL(sigaction)(signal, action, before);
  if (signal == SIGSEGV) {
    if (before != nullptr) *before = fault_action;
    if (action != nullptr) fault_action = *action;
    return 0;
  }
  if (signal <= 0 || signal >= NSIG) return refuse(EINVAL);
  const auto own = handlers[signal];
  struct sigaction changed {};
  if (action != nullptr) {
    changed = *action;
    sigdelset(&changed.sa_mask, SIGSYS);
    sigdelset(&changed.sa_mask, SIGSEGV);
    const bool has_handler = changed.sa_handler != SIG_DFL && changed.sa_handler != SIG_IGN;
    if ((changed.sa_flags & SA_SIGINFO) != 0 && has_handler) {
      handlers[signal] = changed.sa_sigaction;
      changed.sa_sigaction = deliver;
    }
  }
  struct sigaction former {};
  if (SIMBENCH_REAL(sigaction)(signal, action != nullptr ? &changed : nullptr, &former) < 0) {
    handlers[signal] = own;
    return -1;
  }
  if ((former.sa_flags & SA_SIGINFO) != 0 && former.sa_sigaction == deliver) {
    former.sa_sigaction = own;
  }
  if (before != nullptr) *before = former;
  return 0;
}

namespace {

using Handler = void (*)(int);

Handler set_handler(int number, Handler handler, int flags) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = flags;
  struct sigaction before {};
  return sigaction(number, &action, &before) < 0 ? SIG_ERR : before.sa_handler;
}

template <class Change>
int change_mask(const sigset_t* wanted, Change change) {
  if (wanted == nullptr || !is_simulated()) return change(wanted);
  sigset_t set = *wanted;
  sigdelset(&set, SIGSYS);
  sigdelset(&set, SIGSEGV);
  return change(&set);
}

}  // namespace

SIMBENCH_CALL Handler signal(int number, Handler handler) {
  return set_handler(number, handler, SA_RESTART);
}

SIMBENCH_CALL int sigprocmask(int how, const sigset_t* wanted, sigset_t* before) {
  return change_mask(
      wanted, [&](const sigset_t* set) { return SIMBENCH_REAL(sigprocmask)(how, set, before); });
}

SIMBENCH_CALL int pthread_sigmask(int how, const sigset_t* wanted, sigset_t* before) {
  return change_mask(wanted, [&](const sigset_t* set) {
    return SIMBENCH_REAL(pthread_sigmask)(how, set, before);
  });
}

}  // namespace simbench::shim
