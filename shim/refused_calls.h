// The system calls that a program of the simulated world cannot make, and what it gets instead.
//
// Programs ask the world through libc (shim/link.h). One that passes libc by, as libc itself does
// inside, meets a filter of the kernel (processes/confinement.h), which is made of this table. The
// shim then serves the call (shim/served_calls.h), or names it from the table and the world ends
// the program. Calls that are not here, up to kYoungest, are the real ones; younger ones are
// ENOSYS.
//
//   for (const RefusedCall& call : kRefusedCalls) {
//     if (call.number == SYS_ptrace) print(call.name);
//   }
//
// Source: syscalls(2), and the man page of each.
#pragma once

#include <sys/syscall.h>

#include <cstdint>

namespace simbench::shim {

enum class Refusal : std::uint8_t {
  kNotIntercepted,  // the shim serves it where it can; else the program ends
  kForbidden,       // the program ends
  kPartly,          // as kNotIntercepted, for some arguments
  kDenied,          // EPERM: programs try these, and go on
  kAbsent,          // ENOSYS: libraries have another way
  kIgnored,         // 0 without any effect, as for the root of a host of its own
};

struct RefusedCall {
  int number;
  Refusal refusal;
  const char* name;
};

// What the shim says in the fifth argument, which the kernel does not read: of rt_sigaction(), that
// this handler is its own; of ppoll() and rt_sigtimedwait(), that it only looks; of
// epoll_create1(), in the sixth, that the world knows of it.
inline constexpr std::uint32_t kOfTheShim = 0x5348494D;

inline constexpr int kYoungest = SYS_set_mempolicy_home_node;

#define SIMBENCH_REFUSED(refusal, call) \
  RefusedCall { SYS_##call, Refusal::refusal, #call }

inline constexpr RefusedCall kRefusedCalls[] = {
    // Clocks.
    SIMBENCH_REFUSED(kNotIntercepted, clock_settime),
    SIMBENCH_REFUSED(kNotIntercepted, settimeofday),
    SIMBENCH_REFUSED(kNotIntercepted, adjtimex),
    SIMBENCH_REFUSED(kNotIntercepted, clock_adjtime),
    SIMBENCH_REFUSED(kNotIntercepted, gettimeofday),
    SIMBENCH_REFUSED(kNotIntercepted, clock_gettime),
    // What a program has used, and of what.
    SIMBENCH_REFUSED(kNotIntercepted, getrusage),
    SIMBENCH_REFUSED(kNotIntercepted, times),
    SIMBENCH_REFUSED(kNotIntercepted, sysinfo),
    SIMBENCH_REFUSED(kNotIntercepted, getcpu),
    SIMBENCH_REFUSED(kNotIntercepted, sched_getaffinity),
    // Chance.
    SIMBENCH_REFUSED(kNotIntercepted, getrandom),
    // Networks.
    SIMBENCH_REFUSED(kPartly, socket),
    SIMBENCH_REFUSED(kPartly, socketpair),
    // Waiting.
    SIMBENCH_REFUSED(kNotIntercepted, nanosleep),
    SIMBENCH_REFUSED(kNotIntercepted, clock_nanosleep),
    SIMBENCH_REFUSED(kNotIntercepted, pselect6),
    SIMBENCH_REFUSED(kPartly, ppoll),
    SIMBENCH_REFUSED(kPartly, epoll_create1),
    SIMBENCH_REFUSED(kPartly, epoll_pwait),
    SIMBENCH_REFUSED(kNotIntercepted, epoll_pwait2),
    SIMBENCH_REFUSED(kNotIntercepted, timerfd_create),
    SIMBENCH_REFUSED(kNotIntercepted, timer_create),
    SIMBENCH_REFUSED(kNotIntercepted, setitimer),
    SIMBENCH_REFUSED(kNotIntercepted, rt_sigsuspend),
    SIMBENCH_REFUSED(kPartly, rt_sigtimedwait),
    SIMBENCH_REFUSED(kNotIntercepted, futex),
    SIMBENCH_REFUSED(kAbsent, futex_waitv),
    SIMBENCH_REFUSED(kAbsent, io_uring_setup),
    SIMBENCH_REFUSED(kAbsent, io_setup),
    // Other processes.
    SIMBENCH_REFUSED(kPartly, clone),
    SIMBENCH_REFUSED(kAbsent, clone3),
    SIMBENCH_REFUSED(kForbidden, execveat),
    SIMBENCH_REFUSED(kForbidden, ptrace),
    SIMBENCH_REFUSED(kForbidden, process_vm_readv),
    SIMBENCH_REFUSED(kForbidden, process_vm_writev),
    SIMBENCH_REFUSED(kForbidden, pidfd_getfd),
    SIMBENCH_REFUSED(kDenied, pidfd_open),
    SIMBENCH_REFUSED(kDenied, pidfd_send_signal),
    SIMBENCH_REFUSED(kDenied, kcmp),
    SIMBENCH_REFUSED(kDenied, process_madvise),
    SIMBENCH_REFUSED(kDenied, process_mrelease),
    SIMBENCH_REFUSED(kDenied, move_pages),
    SIMBENCH_REFUSED(kDenied, migrate_pages),
    SIMBENCH_REFUSED(kDenied, shmget),
    SIMBENCH_REFUSED(kDenied, shmat),
    SIMBENCH_REFUSED(kDenied, shmctl),
    SIMBENCH_REFUSED(kDenied, semget),
    SIMBENCH_REFUSED(kDenied, semop),
    SIMBENCH_REFUSED(kDenied, semtimedop),
    SIMBENCH_REFUSED(kDenied, semctl),
    SIMBENCH_REFUSED(kDenied, msgget),
    SIMBENCH_REFUSED(kDenied, msgsnd),
    SIMBENCH_REFUSED(kDenied, msgrcv),
    SIMBENCH_REFUSED(kDenied, msgctl),
    SIMBENCH_REFUSED(kDenied, mq_open),
    SIMBENCH_REFUSED(kDenied, mq_unlink),
    // The machine.
    SIMBENCH_REFUSED(kForbidden, mount),
    SIMBENCH_REFUSED(kForbidden, umount2),
    SIMBENCH_REFUSED(kForbidden, pivot_root),
    SIMBENCH_REFUSED(kForbidden, open_tree),
    SIMBENCH_REFUSED(kForbidden, move_mount),
    SIMBENCH_REFUSED(kForbidden, fsopen),
    SIMBENCH_REFUSED(kForbidden, fsconfig),
    SIMBENCH_REFUSED(kForbidden, fsmount),
    SIMBENCH_REFUSED(kForbidden, fspick),
    SIMBENCH_REFUSED(kForbidden, mount_setattr),
    SIMBENCH_REFUSED(kForbidden, setns),
    SIMBENCH_REFUSED(kForbidden, unshare),
    SIMBENCH_REFUSED(kForbidden, reboot),
    SIMBENCH_REFUSED(kForbidden, kexec_load),
    SIMBENCH_REFUSED(kForbidden, init_module),
    SIMBENCH_REFUSED(kForbidden, finit_module),
    SIMBENCH_REFUSED(kForbidden, delete_module),
    SIMBENCH_REFUSED(kForbidden, swapon),
    SIMBENCH_REFUSED(kForbidden, swapoff),
    SIMBENCH_REFUSED(kForbidden, bpf),
    SIMBENCH_REFUSED(kForbidden, perf_event_open),
    SIMBENCH_REFUSED(kForbidden, open_by_handle_at),
    SIMBENCH_REFUSED(kForbidden, sethostname),
    SIMBENCH_REFUSED(kForbidden, setdomainname),
    SIMBENCH_REFUSED(kForbidden, acct),
    SIMBENCH_REFUSED(kForbidden, quotactl),
    SIMBENCH_REFUSED(kForbidden, quotactl_fd),
    SIMBENCH_REFUSED(kForbidden, fanotify_init),
    SIMBENCH_REFUSED(kDenied, vhangup),
    SIMBENCH_REFUSED(kDenied, userfaultfd),
    SIMBENCH_REFUSED(kDenied, personality),
    SIMBENCH_REFUSED(kDenied, keyctl),
    SIMBENCH_REFUSED(kDenied, add_key),
    SIMBENCH_REFUSED(kDenied, request_key),
    SIMBENCH_REFUSED(kDenied, syslog),
    SIMBENCH_REFUSED(kDenied, name_to_handle_at),
    // Root's rights, which it has on its host and nowhere else.
    SIMBENCH_REFUSED(kIgnored, getuid),
    SIMBENCH_REFUSED(kIgnored, geteuid),
    SIMBENCH_REFUSED(kIgnored, getgid),
    SIMBENCH_REFUSED(kIgnored, getegid),
    SIMBENCH_REFUSED(kIgnored, getgroups),
    SIMBENCH_REFUSED(kIgnored, setuid),
    SIMBENCH_REFUSED(kIgnored, setgid),
    SIMBENCH_REFUSED(kIgnored, setreuid),
    SIMBENCH_REFUSED(kIgnored, setregid),
    SIMBENCH_REFUSED(kIgnored, setresuid),
    SIMBENCH_REFUSED(kIgnored, setresgid),
    SIMBENCH_REFUSED(kIgnored, setfsuid),
    SIMBENCH_REFUSED(kIgnored, setfsgid),
    SIMBENCH_REFUSED(kIgnored, setgroups),
    SIMBENCH_REFUSED(kIgnored, capset),
    SIMBENCH_REFUSED(kIgnored, chroot),
    SIMBENCH_REFUSED(kIgnored, seccomp),
    SIMBENCH_REFUSED(kIgnored, fchmod),
    SIMBENCH_REFUSED(kIgnored, fchmodat),
    SIMBENCH_REFUSED(kIgnored, fchown),
    SIMBENCH_REFUSED(kIgnored, fchownat),
    SIMBENCH_REFUSED(kPartly, utimensat),
    SIMBENCH_REFUSED(kDenied, setxattr),
    SIMBENCH_REFUSED(kDenied, lsetxattr),
    SIMBENCH_REFUSED(kDenied, fsetxattr),
    SIMBENCH_REFUSED(kDenied, removexattr),
    SIMBENCH_REFUSED(kDenied, lremovexattr),
    SIMBENCH_REFUSED(kDenied, fremovexattr),
    // Real resources.
    SIMBENCH_REFUSED(kAbsent, memfd_create),
    SIMBENCH_REFUSED(kAbsent, memfd_secret),
    SIMBENCH_REFUSED(kPartly, fallocate),
    SIMBENCH_REFUSED(kIgnored, sync),
    SIMBENCH_REFUSED(kIgnored, syncfs),
    SIMBENCH_REFUSED(kIgnored, mlock),
    SIMBENCH_REFUSED(kIgnored, mlock2),
    SIMBENCH_REFUSED(kIgnored, mlockall),
    SIMBENCH_REFUSED(kIgnored, munlockall),
    SIMBENCH_REFUSED(kIgnored, setpriority),
    SIMBENCH_REFUSED(kIgnored, ioprio_set),
    SIMBENCH_REFUSED(kIgnored, sched_setscheduler),
    SIMBENCH_REFUSED(kIgnored, sched_setparam),
    SIMBENCH_REFUSED(kIgnored, sched_setattr),
    SIMBENCH_REFUSED(kIgnored, sched_setaffinity),
#ifdef __x86_64__
    // What later architectures do without.
    SIMBENCH_REFUSED(kNotIntercepted, time),
    SIMBENCH_REFUSED(kNotIntercepted, select),
    SIMBENCH_REFUSED(kPartly, poll),
    SIMBENCH_REFUSED(kNotIntercepted, epoll_create),
    SIMBENCH_REFUSED(kNotIntercepted, epoll_wait),
    SIMBENCH_REFUSED(kNotIntercepted, alarm),
    SIMBENCH_REFUSED(kNotIntercepted, pause),
    SIMBENCH_REFUSED(kNotIntercepted, fork),
    SIMBENCH_REFUSED(kNotIntercepted, vfork),
    SIMBENCH_REFUSED(kForbidden, kexec_file_load),
    SIMBENCH_REFUSED(kForbidden, iopl),
    SIMBENCH_REFUSED(kForbidden, ioperm),
    SIMBENCH_REFUSED(kForbidden, modify_ldt),
    SIMBENCH_REFUSED(kIgnored, chmod),
    SIMBENCH_REFUSED(kIgnored, chown),
    SIMBENCH_REFUSED(kIgnored, lchown),
    SIMBENCH_REFUSED(kIgnored, utime),
    SIMBENCH_REFUSED(kIgnored, utimes),
    SIMBENCH_REFUSED(kIgnored, futimesat),
#endif
};

#undef SIMBENCH_REFUSED

}  // namespace simbench::shim
