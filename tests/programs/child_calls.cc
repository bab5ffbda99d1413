// What man pages promise of processes: fork(), exec(), who waits for them, and what they share.
//
//   child_calls check ADDRESS | child_calls echo | child_calls bomb | child_calls leave
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <spawn.h>
#include <sys/epoll.h>
#include <sys/mman.h>
#include <sys/signalfd.h>
#include <sys/time.h>
#include <sys/timerfd.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "tests/programs/promises.h"

namespace {

using namespace promises;

constexpr std::uint16_t kEchoPort = 7;
std::string own_path;

void pause_ms(int ms) { usleep(static_cast<useconds_t>(1000 * ms)); }

template <class Work>
pid_t start(Work work) {
  const pid_t child = fork();
  if (child != 0) return child;
  work();
  _exit(99);
}

void check_forks() {
  const pid_t own = getpid();
  const std::int64_t begin = steady();
  const pid_t child = start([&] {
    if (getppid() != own || getpid() == own) _exit(1);
    pause_ms(30);
    _exit(7);
  });
  expect(child > 0, "fork");
  int status = 0;
  expect(waitpid(child, &status, WNOHANG) == 0, "it still runs");
  expect(waitpid(child, &status, 0) == child && WEXITSTATUS(status) == 7, "waitpid");
  expect(is_about(steady() - begin, 30 * kMillisecond), "a process takes its time");
  expect_error(waitpid(child, &status, 0), ECHILD, "once only");
  expect_error(waitpid(-1, &status, 0), ECHILD, "no child is left");
  const pid_t quick = vfork();
  if (quick == 0) _exit(3);
  siginfo_t info{};
  expect(waitid(P_PID, static_cast<id_t>(quick), &info, WEXITED) == 0 && info.si_pid == quick &&
             info.si_status == 3,
         "vfork and waitid");
  const pid_t first = start([] {
    pause_ms(20);
    _exit(1);
  });
  const pid_t second = start([] {
    pause_ms(10);
    _exit(2);
  });
  expect(wait(&status) == second && wait(&status) == first, "in the order of their ends");
}

volatile sig_atomic_t ended = 0;

void check_signals() {
  struct sigaction action {};
  action.sa_handler = [](int) { ended = ended + 1; };
  sigaction(SIGCHLD, &action, nullptr);
  const pid_t child = start([] {
    pause_ms(5);
    _exit(0);
  });
  expect(sleep(10) == 10 - 1 || ended == 1, "a child's end interrupts a sleep");
  expect(ended == 1, "its signal is handled once");
  waitpid(child, nullptr, 0);
  signal(SIGCHLD, SIG_DFL);
  const pid_t target = start([] {
    pause();
    _exit(0);
  });
  pause_ms(1);
  expect(kill(target, 0) == 0 && kill(target, SIGTERM) == 0, "kill");
  int status = 0;
  expect(
      waitpid(target, &status, 0) == target && WIFSIGNALED(status) && WTERMSIG(status) == SIGTERM,
      "it ends by the signal");
  expect_error(kill(target, SIGTERM), ESRCH, "it is gone");
  expect_error(kill(1, SIGTERM), ESRCH, "nothing else is here");
  const pid_t aborts = start([] { abort(); });
  expect(waitpid(aborts, &status, 0) == aborts && WTERMSIG(status) == SIGABRT, "abort of a child");
  sigset_t set{};
  sigaddset(&set, SIGCHLD);
  sigprocmask(SIG_BLOCK, &set, nullptr);
  const int signals = signalfd(-1, &set, 0);
  const pid_t last = start([] {
    pause_ms(3);
    _exit(0);
  });
  signalfd_siginfo info{};
  expect(read(signals, &info, sizeof info) == sizeof info && info.ssi_signo == SIGCHLD, "signalfd");
  expect(waitpid(last, nullptr, WNOHANG) == last, "its child has ended");
  close(signals);
  sigprocmask(SIG_UNBLOCK, &set, nullptr);
}

void check_groups() {
  const pid_t leader = start([] {
    setpgid(0, 0);
    start([] { pause(); });
    pause();
  });
  pause_ms(1);
  expect(getpgid(leader) == leader && getpgrp() != leader, "a group has its leader's number");
  expect(killpg(leader, SIGKILL) == 0 && waitpid(-leader, nullptr, 0) == leader, "killpg");
  const pid_t session = start([] { _exit(setsid() == getpid() && getsid(0) == getpid() ? 0 : 1); });
  int status = 1;
  waitpid(session, &status, 0);
  expect(status == 0, "setsid");
}

void check_shared_descriptors(const char* host) {
  const int fd = udp();
  const int timer = timerfd_create(CLOCK_MONOTONIC, 0);
  const int set = epoll_create1(0);
  epoll_event event{.events = EPOLLIN, .data = {.fd = fd}};
  epoll_ctl(set, EPOLL_CTL_ADD, fd, &event);
  const pid_t child = start([&] {
    itimerspec soon{};
    soon.it_value.tv_nsec = 5'000'000;
    timerfd_settime(timer, 0, &soon, nullptr);
    send_text(fd, "from a child", address(host, kEchoPort));
    _exit(0);
  });
  epoll_event ready{};
  expect(epoll_wait(set, &ready, 1, 1000) == 1 && ready.data.fd == fd, "a shared socket is ready");
  expect(gets(fd, "from a child"), "the answer to a child's datagram");
  std::uint64_t times = 0;
  expect(read(timer, &times, sizeof times) == sizeof times && times == 1, "a shared timer");
  waitpid(child, nullptr, 0);
  send_text(fd, "after its end", address(host, kEchoPort));
  expect(gets(fd, "after its end"), "the socket outlives the child");
  close(fd);
  expect(epoll_wait(set, &ready, 1, 0) == 0, "a closed socket is forgotten");
  close(timer);
  close(set);
}

// By exec(): a program with the socket that it is left.
void check_exec(const char* host) {
  const int fd = udp();
  connect_to(fd, address(host, kEchoPort));
  const int hidden = udp(SOCK_CLOEXEC);
  const std::string number = std::to_string(fd);
  const std::string other = std::to_string(hidden);
  const pid_t child = start(
      [&] { execl(own_path.c_str(), "child", "use", number.c_str(), other.c_str(), nullptr); });
  int status = 0;
  expect(waitpid(child, &status, 0) == child && status == 0, "exec with a socket");
  expect(gets(fd, "by another program"), "the answer to it");
  char name[] = "child";
  char use[] = "status";
  char* const words[] = {name, use, nullptr};
  pid_t spawned = 0;
  expect(posix_spawn(&spawned, own_path.c_str(), nullptr, nullptr, words, environ) == 0 &&
             waitpid(spawned, &status, 0) == spawned && WEXITSTATUS(status) == 21,
         "posix_spawn");
  expect(posix_spawn(&spawned, "/no/such/program", nullptr, nullptr, words, environ) == ENOENT,
         "what is not there cannot be started");
  expect(execl("/no/such/program", "x", nullptr) == -1 && errno == ENOENT, "nor become");
  expect(steady() > 0, "the link outlives an exec that fails");
}

void check_shells() {
  expect(WEXITSTATUS(system("exit 5")) == 5, "system");
  const std::int64_t begin = steady();
  FILE* lines = popen("echo one; sleep 2; echo two", "r");
  char line[32] = "";
  expect(std::fgets(line, sizeof line, lines) != nullptr && line == std::string("one\n"), "popen");
  expect(steady() - begin < kSecond, "a line comes when it is written");
  expect(std::fgets(line, sizeof line, lines) != nullptr && line == std::string("two\n"), "popen");
  expect(steady() - begin > 2 * kSecond - kMillisecond, "as does the next");
  expect(pclose(lines) == 0, "pclose");
}

void check_memory() {
  auto* shared = static_cast<int*>(
      mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0));
  pthread_mutexattr_t across{};
  pthread_mutexattr_init(&across);
  pthread_mutexattr_setpshared(&across, PTHREAD_PROCESS_SHARED);
  auto* lock = reinterpret_cast<pthread_mutex_t*>(shared + 16);
  pthread_mutex_init(lock, &across);
  pthread_mutex_lock(lock);
  const pid_t child = start([&] {
    pthread_mutex_lock(lock);
    *shared = 2;
    pthread_mutex_unlock(lock);
    _exit(0);
  });
  pause_ms(2);
  *shared = 1;
  pthread_mutex_unlock(lock);
  waitpid(child, nullptr, 0);
  expect(*shared == 2, "a lock that processes share");
}

void check_alarms() {
  itimerval soon{};
  soon.it_value.tv_usec = 4'000;
  setitimer(ITIMER_REAL, &soon, nullptr);
  const pid_t child = start([] {
    itimerval own{};
    getitimer(ITIMER_REAL, &own);
    _exit(own.it_value.tv_usec == 0 ? 0 : 1);
  });
  int status = 1;
  itimerval none{};
  setitimer(ITIMER_REAL, &none, nullptr);
  waitpid(child, &status, 0);
  expect(status == 0, "a child has none of its parent's alarms");
}

void check(const char* host) {
  check_forks();
  check_signals();
  check_groups();
  check_shared_descriptors(host);
  check_exec(host);
  check_shells();
  check_memory();
  check_alarms();
  finish();
}

void echo() {
  const int fd = udp();
  bind_to(fd, address("0.0.0.0", kEchoPort));
  for (;;) {
    char bytes[1500];
    sockaddr_in from{};
    socklen_t size = sizeof from;
    const ssize_t got =
        recvfrom(fd, bytes, sizeof bytes, 0, reinterpret_cast<sockaddr*>(&from), &size);
    sendto(fd, bytes, static_cast<std::size_t>(got), 0, reinterpret_cast<sockaddr*>(&from), size);
  }
}

int use(int fd, int hidden) {
  if (fcntl(hidden, F_GETFD) >= 0) return 1;
  const char text[] = "by another program";
  return send(fd, text, sizeof text - 1, 0) == static_cast<ssize_t>(sizeof text - 1) ? 0 : 2;
}

// Each process makes two, until there may be no more.
void bomb() {
  for (;;) {
    if (fork() < 0) std::printf("fork: %s\n", strerrorname_np(errno));
    std::fflush(stdout);
    pause_ms(1);
  }
}

}  // namespace

int main(int count, char** words) {
  char path[4096] = "";
  own_path.assign(path, static_cast<std::size_t>(
                            std::max<ssize_t>(0, readlink("/proc/self/exe", path, sizeof path))));
  const std::string what = count > 1 ? words[1] : "";
  if (what == "check" && count > 2) check(words[2]);
  if (what == "echo") echo();
  if (what == "use" && count > 3) return use(std::atoi(words[2]), std::atoi(words[3]));
  if (what == "status") return 21;
  if (what == "bomb") bomb();
  if (what == "leave") {
    if (daemon(0, 1) < 0) return 1;
    sleep(3);
    std::puts("in the background");
    finish();
  }
  return 2;
}
