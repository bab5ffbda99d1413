// Attacks on the machine's state by system calls that pass libc by: the second word is the call's
// name. Their arguments are zero, so that one that is not refused does no harm.
//
//   machine_attacks call NAME
//   machine_attacks socket FAMILY
#include <errno.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <csetjmp>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "tests/programs/attempts.h"

namespace {

using attempts::Attempt;
using attempts::path;
using attempts::say;

struct SystemCall {
  const char* name;
  long number;
};
#define CALL(name) \
  SystemCall { #name, SYS_##name }

constexpr SystemCall kCalls[] = {
    // clocks and timers
    CALL(settimeofday),
    CALL(clock_settime),
    CALL(adjtimex),
    CALL(clock_adjtime),
    CALL(clock_nanosleep),
    CALL(nanosleep),
    CALL(timer_create),
    CALL(timerfd_create),
    CALL(setitimer),
    CALL(semtimedop),
    // file systems and namespaces
    CALL(mount),
    CALL(umount2),
    CALL(pivot_root),
    CALL(chroot),
    CALL(open_tree),
    CALL(move_mount),
    CALL(fsopen),
    CALL(fspick),
    CALL(fsconfig),
    CALL(fsmount),
    CALL(mount_setattr),
    CALL(setns),
    CALL(unshare),
    CALL(swapon),
    CALL(swapoff),
    CALL(quotactl),
    CALL(quotactl_fd),
    CALL(fanotify_init),
    CALL(acct),
    // the kernel
    CALL(reboot),
    CALL(kexec_load),
    CALL(init_module),
    CALL(finit_module),
    CALL(delete_module),
    CALL(bpf),
    CALL(perf_event_open),
    CALL(userfaultfd),
    CALL(io_uring_setup),
    CALL(io_setup),
    CALL(keyctl),
    CALL(add_key),
    CALL(request_key),
    CALL(syslog),
    CALL(vhangup),
    CALL(sethostname),
    CALL(setdomainname),
    CALL(personality),
    CALL(sync),
    CALL(mq_unlink),
    CALL(shmctl),
    CALL(semctl),
    CALL(semop),
    CALL(msgctl),
    CALL(msgsnd),
    CALL(msgrcv),
    CALL(migrate_pages),
    CALL(process_mrelease),
    CALL(clone3),
    CALL(futex_waitv),
#ifdef __x86_64__
    CALL(iopl),
    CALL(ioperm),
    CALL(modify_ldt),
    CALL(kexec_file_load),
    CALL(alarm),
    CALL(pause),
#endif
};

void call() {
  for (const SystemCall& each : kCalls) {
    if (std::strcmp(each.name, path) == 0) say(path, syscall(each.number, 0, 0, 0, 0, 0, 0));
  }
}
void make_socket() {
  const int family = std::atoi(path);
  say("stream", syscall(SYS_socket, family, SOCK_STREAM, 0));
  say("datagram", syscall(SYS_socket, family, SOCK_DGRAM, 0));
  say("raw", syscall(SYS_socket, family, SOCK_RAW, 0));
}
void younger() { say("younger", syscall(1000, 0, 0, 0, 0, 0, 0)); }

#ifdef __x86_64__
void other_abi() { say("x32", syscall(0x40000000 | SYS_getppid)); }
void old_abi() {
  constexpr int kGetppid = 64;  // of i386
  int result = kGetppid;
  asm volatile("int $0x80" : "+a"(result) : : "memory");
  say("i386", result);
}
// The page of the oldest programs, at a fixed address: time() of the machine.
void old_page() {
  constexpr std::uintptr_t kTime = 0xFFFFFFFFFF600400;
  const auto time = reinterpret_cast<long (*)(long*)>(kTime);
  say("vsyscall", time(nullptr));
}
#else
void other_abi() { std::abort(); }
void old_abi() { std::abort(); }
void old_page() { std::abort(); }
#endif

constexpr Attempt kAttempts[] = {{"call", call},       {"socket", make_socket},
                                 {"younger", younger}, {"other_abi", other_abi},
                                 {"old_abi", old_abi}, {"old_page", old_page}};

}  // namespace

int main(int count, char** words) { return attempts::make(kAttempts, count, words); }
