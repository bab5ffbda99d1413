// Prints what a program can learn of the machine, its time and its chance: two runs of a world must
// print the same.
#include <dirent.h>
#include <elf.h>
#include <fcntl.h>
#include <ftw.h>
#include <glob.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <sys/auxv.h>
#include <sys/random.h>
#include <sys/resource.h>
#include <sys/signalfd.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/sysinfo.h>
#include <sys/times.h>
#include <sys/utsname.h>
#include <sys/vfs.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>
#include <utime.h>
#include <utmp.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <fstream>
#include <functional>
#include <iostream>
#include <iterator>
#include <memory>
#include <random>
#include <string>
#include <thread>

#ifdef __x86_64__
#include <x86intrin.h>
#endif

namespace {

void say(const std::string& what, const auto&... values) {
  std::cout << what;
  ((std::cout << ' ' << values), ...);
  std::cout << std::endl;
}

std::uint64_t ns(const timespec& time) {
  return static_cast<std::uint64_t>(time.tv_sec) * 1'000'000'000U +
         static_cast<std::uint64_t>(time.tv_nsec);
}

void say_clocks() {
  for (const clockid_t clock : {CLOCK_REALTIME, CLOCK_MONOTONIC, CLOCK_MONOTONIC_RAW,
                                CLOCK_REALTIME_COARSE, CLOCK_MONOTONIC_COARSE, CLOCK_BOOTTIME,
                                CLOCK_TAI, CLOCK_PROCESS_CPUTIME_ID, CLOCK_THREAD_CPUTIME_ID}) {
    timespec now{};
    clock_gettime(clock, &now);
    say("clock", clock, ns(now));
  }
  tms used{};
  const clock_t ticks = times(&used);
  say("times", ticks, used.tms_utime, used.tms_stime, used.tms_cutime, used.tms_cstime);
  say("clock()", clock());
  clockid_t own{};
  timespec now{};
  pthread_getcpuclockid(pthread_self(), &own);
  clock_gettime(own, &now);
  say("thread's CPU time", ns(now));
  clock_getcpuclockid(0, &own);
  clock_gettime(own, &now);
  say("process's CPU time", ns(now));
#ifdef __x86_64__
  unsigned int processor = 0;
  say("counter", __rdtsc());
  say("counter", __rdtscp(&processor), processor);
#endif
}

// Past libc: the kernel's own function for readers of clocks.
// What the kernel has given as a number.
template <class Pointer>
Pointer pointer_to(std::uintptr_t number) {
  return reinterpret_cast<Pointer>(number);  // NOLINT(performance-no-int-to-ptr)
}

void say_vdso() {
  const auto* image = pointer_to<const unsigned char*>(getauxval(AT_SYSINFO_EHDR));
  if (image == nullptr) return;
  const auto* head = reinterpret_cast<const Elf64_Ehdr*>(image);
  const auto* parts = reinterpret_cast<const Elf64_Phdr*>(image + head->e_phoff);
  const Elf64_Sym* symbols = nullptr;
  const char* names = nullptr;
  for (int i = 0; i < head->e_phnum; ++i) {
    if (parts[i].p_type != PT_DYNAMIC) continue;
    for (const auto* each = reinterpret_cast<const Elf64_Dyn*>(image + parts[i].p_offset);
         each->d_tag != DT_NULL; ++each) {
      if (each->d_tag == DT_SYMTAB) {
        symbols = reinterpret_cast<const Elf64_Sym*>(image + each->d_un.d_ptr);
      }
      if (each->d_tag == DT_STRTAB) {
        names = reinterpret_cast<const char*>(image + each->d_un.d_ptr);
      }
    }
  }
  const auto* end = reinterpret_cast<const Elf64_Sym*>(names);
  for (const Elf64_Sym* each = symbols; each + 1 <= end; ++each) {
    const std::string name = names + each->st_name;
    if (name == "__vdso_clock_gettime") {
      timespec now{};
      const auto* place = image + each->st_value;
      pointer_to<int (*)(clockid_t, timespec*)>(reinterpret_cast<std::uintptr_t>(place))(
          CLOCK_REALTIME, &now);
      say("vDSO", ns(now));
    }
    if (name == "__vdso_getcpu") {
      unsigned int cpu = 0;
      unsigned int node = 0;
      const auto* place = image + each->st_value;
      pointer_to<int (*)(unsigned int*, unsigned int*, void*)>(
          reinterpret_cast<std::uintptr_t>(place))(&cpu, &node, nullptr);
      say("vDSO's processor", cpu, node);
    }
  }
}

void say_use() {
  for (const int who : {RUSAGE_SELF, RUSAGE_CHILDREN, RUSAGE_THREAD}) {
    rusage used{};
    getrusage(static_cast<__rusage_who_t>(who), &used);
    say("getrusage", who, used.ru_utime.tv_sec, used.ru_utime.tv_usec, used.ru_stime.tv_usec,
        used.ru_maxrss, used.ru_minflt, used.ru_majflt, used.ru_nvcsw, used.ru_nivcsw,
        used.ru_inblock, used.ru_oublock);
  }
  struct sysinfo info {};
  sysinfo(&info);
  say("sysinfo", info.uptime, info.loads[0], info.totalram, info.freeram, info.bufferram,
      info.procs, info.freeswap, info.mem_unit);
  double loads[3] = {};
  say("getloadavg", getloadavg(loads, 3), loads[0], loads[1], loads[2]);
  cpu_set_t cpus;
  sched_getaffinity(0, sizeof cpus, &cpus);
  say("processors", sched_getcpu(), CPU_COUNT(&cpus), CPU_ISSET(0, &cpus),
      sysconf(_SC_NPROCESSORS_ONLN), sysconf(_SC_NPROCESSORS_CONF),
      std::thread::hardware_concurrency());
  say("memory", sysconf(_SC_PHYS_PAGES), sysconf(_SC_AVPHYS_PAGES));
  struct statfs disk {};
  statfs(".", &disk);
  say("statfs", disk.f_type, disk.f_bsize, disk.f_blocks, disk.f_bfree, disk.f_files, disk.f_ffree);
}

void say_chance() {
  std::random_device device;
  say("random_device", device(), device());
  for (const char* token : {"/dev/urandom", "getentropy", "rdrand"}) {
    if (std::strcmp(token, "rdrand") == 0) continue;  // the instruction cannot be taken away
    try {
      std::random_device other(token);
      say(token, other());
    } catch (const std::exception&) {
      say(token, "none");
    }
  }
  std::uint64_t number = 0;
  getrandom(&number, sizeof number, 0);
  say("getrandom", number);
  say("arc4random", arc4random());
  const auto* given = pointer_to<const unsigned char*>(getauxval(AT_RANDOM));
  std::memcpy(&number, given, sizeof number);
  say("AT_RANDOM", number);
}

void say_places() {
  const int on_stack = 0;
  const auto on_heap = std::make_unique<int>(0);
  static int in_program = 0;
  say("places", static_cast<const void*>(&on_stack), static_cast<const void*>(on_heap.get()),
      static_cast<const void*>(&in_program), reinterpret_cast<const void*>(&printf),
      std::this_thread::get_id());
  std::thread([] { say("a thread", std::this_thread::get_id(), gettid()); }).join();
}

void say_identity() {
  say("ids", getpid(), getppid(), gettid(), getpgrp(), getsid(0), getuid(), geteuid());
  utsname system{};
  uname(&system);
  char folder[4096];
  say("host", system.nodename, getcwd(folder, sizeof folder), get_current_dir_name());
  setutent();
  int known = 0;
  while (getutent() != nullptr) ++known;
  say("utmp", known);
  for (const int resource : {RLIMIT_NOFILE, RLIMIT_STACK, RLIMIT_CORE, RLIMIT_NPROC}) {
    rlimit limit{};
    getrlimit(static_cast<__rlimit_resource>(resource), &limit);
    say("limit", resource, limit.rlim_cur, limit.rlim_max);
  }
  for (char** each = environ; *each != nullptr; ++each) {
    if (std::strncmp(*each, "LD_", 3) != 0) say("environment", *each);
  }
}

std::string status_of(const struct stat& status) {
  std::string text = std::to_string(status.st_ino) + " on " + std::to_string(status.st_dev) + ", ";
  text += std::to_string(status.st_nlink) + " links, ";
  text += std::to_string(status.st_uid) + ':' + std::to_string(status.st_gid) + ", mode ";
  text += std::to_string(status.st_mode) + ", " + std::to_string(status.st_size) + " bytes in ";
  text += std::to_string(status.st_blocks) + " of " + std::to_string(status.st_blksize);
  for (const timespec* each : {&status.st_atim, &status.st_mtim, &status.st_ctim}) {
    text += ", " + std::to_string(ns(*each));
  }
  return text;
}

void say_status(const char* path) {
  struct stat status {};
  if (lstat(path, &status) != 0) return say(path, "none");
  say(path, status_of(status));
  struct statx more {};
  statx(AT_FDCWD, path, AT_SYMLINK_NOFOLLOW, STATX_ALL, &more);
  say("statx", more.stx_ino, more.stx_dev_major, more.stx_dev_minor, more.stx_mnt_id,
      more.stx_nlink, more.stx_uid, more.stx_blocks, more.stx_mtime.tv_sec, more.stx_mtime.tv_nsec,
      more.stx_ctime.tv_nsec, more.stx_atime.tv_nsec, more.stx_btime.tv_sec,
      more.stx_btime.tv_nsec);
}

void write_files() {
  for (const char* name : {"zebra", "apple", "mango", "sub/one", "sub/another"}) {
    mkdir("sub", 0755);
    std::ofstream(name) << "of " << name << '\n';
    usleep(30'000);
  }
  rename("apple", "pear");
  link("pear", "twin");
  symlink("pear", "way");
  mkfifo("queue", 0600);
}

int see(const char* path, const struct stat* status, int /*kind*/, FTW* /*place*/) {
  say("nftw", path, status->st_mtim.tv_sec);
  return 0;
}

void say_files() {
  write_files();
  const int open_one = open("open", O_CREAT | O_RDWR, 0644);
  if (write(open_one, "text", 4) != 4) say("no write");
  struct stat status {};
  fstat(open_one, &status);
  say("open", status_of(status));
  usleep(100'000);
  fstat(open_one, &status);
  say("open", status_of(status));
  for (const char* path : {"zebra", "pear", "twin", "way", "queue", "sub", ".", "sub/one", "open",
                           "/files", "/files/zebra", "/usr/bin", "/etc/passwd", "/"}) {
    say_status(path);
  }
  utimbuf before{.actime = 1'000'000, .modtime = 2'000'000};
  utime("zebra", &before);
  say_status("zebra");
  utime("zebra", nullptr);
  say_status("zebra");
  const timespec both[2] = {{.tv_sec = 5, .tv_nsec = UTIME_OMIT}, {.tv_sec = 7, .tv_nsec = 8}};
  utimensat(AT_FDCWD, "pear", both, 0);
  say_status("pear");
  futimens(open_one, both);
  say_status("open");
  unlink("zebra");
  std::ofstream("new") << "new";
  say_status("new");
}

// The machine gives the number of one that is gone to the next, which may be made in the same tick
// of its clock or not.
void say_short_files() {
  struct Kind {
    const char* path;
    int flags;
  };
  for (const Kind& kind : {Kind{"/proc/uptime", O_RDONLY}, Kind{".", O_TMPFILE | O_RDWR},
                           Kind{"short", O_CREAT | O_RDWR}}) {
    for (int i = 0; i < 60; ++i) {
      const int file = open(kind.path, kind.flags, 0600);
      struct stat status {};
      fstat(file, &status);
      say("short", kind.path, status.st_ino);
      close(file);
      unlink("short");
    }
  }
}

void say_folders() {
  DIR* folder = opendir(".");
  while (const dirent* each = readdir(folder)) say("entry", each->d_name, each->d_ino, each->d_off);
  closedir(folder);
  std::string listed;
  dirent** names = nullptr;
  const int count = scandir(".", &names, nullptr, nullptr);
  for (int i = 0; i < count; ++i) listed += std::string(" ") + names[i]->d_name;
  say("scandir", listed);
  for (const char* pattern : {"*", "/files/*", "/run/*", "sub/*"}) {
    glob_t found{};
    glob(pattern, GLOB_NOSORT, nullptr, &found);
    listed.clear();
    for (std::size_t i = 0; i < found.gl_pathc; ++i) listed += std::string(" ") + found.gl_pathv[i];
    say("glob", pattern, listed);
    globfree(&found);
  }
  nftw(".", see, 8, FTW_PHYS);
  for (const char* path : {"/tmp", "/run", "/dev/shm"}) {
    folder = opendir(path);
    listed.clear();
    while (folder != nullptr) {
      const dirent* each = readdir(folder);
      if (each == nullptr) break;
      listed += std::string(" ") + each->d_name;
    }
    if (folder != nullptr) closedir(folder);
    say(path, listed);
  }
  char name[] = P_tmpdir "/fileXXXXXX";
  close(mkstemp(name));
  say("mkstemp", name);
  char linked[4096] = "";
  const int fd = open("pear", O_RDONLY);
  const std::string descriptor = "/proc/self/fd/" + std::to_string(fd);
  say("the descriptor's", readlink(descriptor.c_str(), linked, sizeof linked - 1), linked);
  int ends[2];
  if (pipe(ends) == 0) {
    std::memset(linked, 0, sizeof linked);
    const std::string end = "/proc/self/fd/" + std::to_string(ends[0]);
    say("the pipe's", readlink(end.c_str(), linked, sizeof linked - 1), linked);
  }
}

void say_machine_files() {
  for (const char* path : {"/proc/uptime",
                           "/proc/loadavg",
                           "/proc/stat",
                           "/proc/self/stat",
                           "/proc/self/status",
                           "/proc/self/statm",
                           "/proc/meminfo",
                           "/proc/interrupts",
                           "/proc/sys/kernel/random/boot_id",
                           "/proc/sys/kernel/random/uuid",
                           "/proc/sys/kernel/hostname",
                           "/proc/self/maps",
                           "/proc/self/schedstat",
                           "/proc/self/mountinfo",
                           "/proc/self/environ",
                           "/proc/net/dev",
                           "/proc/timer_list",
                           "/sys/devices/system/clocksource/clocksource0/current_clocksource",
                           "/sys/class/net/eth0/address",
                           "/sys/class/net/eth0/statistics/rx_bytes",
                           "/etc/machine-id",
                           "/etc/hostname",
                           "/etc/adjtime",
                           "/var/lib/dbus/machine-id",
                           "/var/log/wtmp",
                           "/run/utmp"}) {
    std::ifstream file(path);
    std::string text{std::istreambuf_iterator<char>(file), {}};
    // Where the machine has put what is of this build.
    if (std::strcmp(path, "/proc/self/environ") == 0) text.clear();
    say(path, text.size(), std::hash<std::string>{}(text), text.substr(0, 60));
  }
}

void on_signal(int number, siginfo_t* info, void* /*context*/) {
  say("signal", number, info->si_code, info->si_pid, info->si_uid, info->si_utime, info->si_stime,
      info->si_status);
}

void say_children() {
  struct sigaction action {};
  action.sa_sigaction = on_signal;
  action.sa_flags = SA_SIGINFO;
  sigaction(SIGCHLD, &action, nullptr);
  sigaction(SIGUSR1, &action, nullptr);
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child == 0) {
    kill(parent, SIGUSR1);
    usleep(50'000);
    _exit(3);
  }
  for (int i = 0; i < 4; ++i) usleep(100'000);
  int status = 0;
  rusage used{};
  say("wait4", wait4(child, &status, 0, &used), status, used.ru_utime.tv_usec, used.ru_maxrss);
  sigval value{.sival_int = 5};
  sigqueue(getpid(), SIGUSR1, value);
  usleep(1000);
  sigset_t blocked{};
  sigaddset(&blocked, SIGUSR2);
  sigprocmask(SIG_BLOCK, &blocked, nullptr);
  const int signals = signalfd(-1, &blocked, 0);
  kill(getpid(), SIGUSR2);
  signalfd_siginfo read_one{};
  if (read(signals, &read_one, sizeof read_one) > 0) {
    say("signalfd", read_one.ssi_signo, read_one.ssi_pid, read_one.ssi_uid);
  }
  int ends[2];
  ucred peer{};
  socklen_t size = sizeof peer;
  if (socketpair(AF_UNIX, SOCK_STREAM, 0, ends) == 0 &&
      getsockopt(ends[0], SOL_SOCKET, SO_PEERCRED, &peer, &size) == 0) {
    say("peer", peer.pid, peer.uid, peer.gid);
  }
  kill(getpid(), SIGUSR2);
  siginfo_t taken{};
  sigwaitinfo(&blocked, &taken);
  say("sigwaitinfo", taken.si_signo, taken.si_pid);
}

}  // namespace

int main() {
  say_clocks();
  say_vdso();
  say_use();
  say_chance();
  say_places();
  say_identity();
  say_files();
  say_folders();
  say_machine_files();
  say_children();
  say_short_files();
  say("done");
  for (;;) sleep(3600);
}
