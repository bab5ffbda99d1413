// Tries to get out of the simulated world: by calls that pass libc by, by files outside its folder,
// by other processes, and by not ending. What fails without ending the program is printed, as
// "NAME: errno"; then "still there", and it exits with status 0.
//
//   escapes ATTEMPT [PATH]
#include <errno.h>
#include <fcntl.h>
#include <grp.h>
#include <linux/capability.h>
#include <linux/futex.h>
#include <poll.h>
#include <pthread.h>
#include <pwd.h>
#include <sched.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/timex.h>
#include <sys/un.h>
#include <syslog.h>
#include <time.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "tests/programs/attempts.h"

namespace {

using attempts::Attempt;
using attempts::path;
using attempts::say;

timespec a_millisecond{.tv_sec = 0, .tv_nsec = 1'000'000};
timespec a_day{.tv_sec = 86'400, .tv_nsec = 0};
char no_word[] = "";
char* no_words[] = {no_word, nullptr};

// By the system call itself.

void set_clock() { say("clock_settime", syscall(SYS_clock_settime, CLOCK_REALTIME, &a_day)); }
void set_day() { say("settimeofday", syscall(SYS_settimeofday, &a_day, nullptr)); }
void adjust() {
  timex setting{};
  say("adjtimex", syscall(SYS_adjtimex, &setting));
}
void adjust_clock() {
  timex setting{};
  say("clock_adjtime", syscall(SYS_clock_adjtime, CLOCK_REALTIME, &setting));
}
void read_clock() { say("clock_gettime", syscall(SYS_clock_gettime, CLOCK_REALTIME, &a_day)); }
void internet() { say("AF_INET", syscall(SYS_socket, AF_INET, SOCK_DGRAM, 0)); }
void netlink() { say("AF_NETLINK", syscall(SYS_socket, AF_NETLINK, SOCK_RAW, 0)); }
void packet() { say("AF_PACKET", syscall(SYS_socket, AF_PACKET, SOCK_RAW, 0)); }
void nap() { say("nanosleep", syscall(SYS_nanosleep, &a_millisecond, nullptr)); }
void wait_for_nothing() { say("ppoll", syscall(SYS_ppoll, nullptr, 0, &a_millisecond, 0, 8)); }
void wait_for_lock() {
  std::uint32_t lock = 0;
  say("futex", syscall(SYS_futex, &lock, FUTEX_WAIT_PRIVATE, 0, &a_millisecond, nullptr, 0));
}
void timer() { say("timerfd", syscall(SYS_timerfd_create, CLOCK_MONOTONIC, 0)); }
void new_process() { say("clone", syscall(SYS_clone, SIGCHLD, 0, 0, 0, 0)); }
void old_vfork() { say("vfork", vfork()); }  // NOLINT: it is refused
void execute() { say("execve", execve("/bin/true", no_words, no_words)); }
void spawn() {
  say("posix_spawn", posix_spawn(nullptr, "/bin/true", nullptr, nullptr, no_words, no_words));
}
void shell() { say("system", system("true")); }
void trace() { say("ptrace", syscall(SYS_ptrace, 16, getppid(), 0, 0)); }
void mount_there() { say("mount", syscall(SYS_mount, "none", ".", "tmpfs", 0, nullptr)); }
void name_host() { say("sethostname", syscall(SYS_sethostname, "x", 1)); }
void other_abi() { say("x32", syscall(0x40000000 | SYS_getppid)); }

// SIGSYS stays the shim's.
void catch_it() {
  signal(SIGSYS, SIG_IGN);
  set_clock();
}
void block_it() {
  sigset_t all;
  sigfillset(&all);
  sigprocmask(SIG_SETMASK, &all, nullptr);
  set_clock();
}

// What fails, and lets the program go on.

void files() {
  say("write outside", open(path, O_WRONLY | O_CREAT, 0600));
  say("move outside", std::rename("program0.log", path));
  say("remove", unlink("/etc/hostname"));
  say("device", open("/dev/kmsg", O_WRONLY));
  say("read", open("/etc/passwd", O_RDONLY));
  say("null", open("/dev/null", O_RDWR));
  say("own", open("own.txt", O_WRONLY | O_CREAT, 0600));
  say("folder", mkdir("sub", 0700));
  say("move", std::rename("own.txt", "sub/own.txt"));
}
void read_named() {
  const char* variable = std::getenv("FILE");
  const char* file = variable != nullptr ? variable : path;
  say("read", open(file, O_RDONLY));
  say("write", open(file, O_WRONLY));
}
// Who it is for the kernel.
// What it may as whoever it is.
void user() {
  say("make", open("made", O_WRONLY | O_CREAT, 0644));
  say("read what is closed", open("closed", O_RDONLY));
}
void neighbours() {
  say("io_uring", syscall(SYS_io_uring_setup, 1, nullptr));
  say("shared memory", syscall(SYS_shmget, 1, 4096, 0600));
  say("limit", syscall(SYS_prlimit64, 1, RLIMIT_NOFILE, nullptr, nullptr));
  say("link's name", fcntl(3, F_GETFD));
}
void rights() {
  say("setgroups", setgroups(0, nullptr));
  say("setgid", setgid(12345));
  say("setuid", setuid(12345));
  std::printf("user %d, group %d\n", static_cast<int>(geteuid()), static_cast<int>(getegid()));
  say("keep", prctl(PR_SET_KEEPCAPS, 1, 0, 0, 0));
  say("mlockall", mlockall(MCL_CURRENT | MCL_FUTURE));
  const sched_param priority{.sched_priority = 50};
  say("real time", sched_setscheduler(0, SCHED_FIFO, &priority));
  say("priority", setpriority(PRIO_PROCESS, 0, -20));
  const rlimit more{.rlim_cur = RLIM_INFINITY, .rlim_max = RLIM_INFINITY};
  say("limit", setrlimit(RLIMIT_CORE, &more));
  rlimit now{};
  getrlimit(RLIMIT_CORE, &now);
  std::printf("core files of %d bytes\n", static_cast<int>(now.rlim_max));
  say("owner", chown("/etc/hostname", 1, 1));
  say("gain", prctl(PR_SET_PDEATHSIG, 0));
  const passwd* user = getpwnam("_nobody_has_this_name");
  std::printf("%s is %d\n", user->pw_name, static_cast<int>(user->pw_uid));
  __user_cap_header_struct head{.version = _LINUX_CAPABILITY_VERSION_3, .pid = 0};
  __user_cap_data_struct all[_LINUX_CAPABILITY_U32S_3] = {};
  say("capset", syscall(SYS_capset, &head, all));
  say("capget", syscall(SYS_capget, &head, all));
  std::printf("capabilities %x %x\n", all[0].effective | all[0].permitted, all[0].inheritable);
  std::fflush(stdout);
  openlog("named", LOG_PID, LOG_DAEMON);
  errno = ENOENT;
  syslog(LOG_INFO, "a message: %m");
}
void own_signals() {
  signal(SIGUSR1, [](int) { std::puts("got it"); });
  say("raise", raise(SIGUSR1));
}

// What does not end, or ends badly.

void write_much() {
  static char text[1 << 16];
  std::memset(text, 'x', sizeof text);
  while (write(STDOUT_FILENO, text, sizeof text) > 0) {
  }
}
void allocate_much() {
  constexpr std::size_t kBlock = std::size_t{16} << 20;
  std::size_t blocks = 0;
  // Compilers leave out what is allocated and not used.
  for (void* volatile block = &blocks; block != nullptr; ++blocks) block = std::malloc(kBlock);
  std::printf("no memory after %zu MiB\n", blocks * 16);
}
void compute() {
  for (volatile unsigned int i = 0;;) i = i + 1;
}
void crash() { *reinterpret_cast<volatile int*>(8) = 1; }
void be_killed() { raise(SIGKILL); }
void abort_it() {
  std::puts("it cannot be");
  std::fflush(stdout);
  std::abort();
}
void many_threads() {
  pthread_t thread{};
  const auto pause_for_ever = [](void*) -> void* {
    nanosleep(&a_millisecond, nullptr);
    return nullptr;
  };
  pthread_create(&thread, nullptr, pause_for_ever, nullptr);
  pthread_join(thread, nullptr);
}

constexpr Attempt kAttempts[] = {{"clock_settime", set_clock},
                                 {"settimeofday", set_day},
                                 {"adjtimex", adjust},
                                 {"clock_adjtime", adjust_clock},
                                 {"clock_gettime", read_clock},
                                 {"internet", internet},
                                 {"netlink", netlink},
                                 {"packet", packet},
                                 {"nanosleep", nap},
                                 {"ppoll", wait_for_nothing},
                                 {"futex", wait_for_lock},
                                 {"timerfd_create", timer},
                                 {"clone", new_process},
                                 {"vfork", old_vfork},
                                 {"execve", execute},
                                 {"posix_spawn", spawn},
                                 {"system", shell},
                                 {"ptrace", trace},
                                 {"mount", mount_there},
                                 {"sethostname", name_host},
                                 {"other_abi", other_abi},
                                 {"catch", catch_it},
                                 {"block", block_it},
                                 {"files", files},
                                 {"read", read_named},
                                 {"user", user},
                                 {"neighbours", neighbours},
                                 {"rights", rights},
                                 {"own_signals", own_signals},
                                 {"write", write_much},
                                 {"allocate", allocate_much},
                                 {"compute", compute},
                                 {"crash", crash},
                                 {"killed", be_killed},
                                 {"abort", abort_it},
                                 {"threads", many_threads}};

}  // namespace

int main(int count, char** words) { return attempts::make(kAttempts, count, words); }
