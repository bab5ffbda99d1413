// What man pages promise of signals, timers that make them, and duplicates of descriptors, looked
// at by a program in the simulated world: prints a line for each promise that does not hold, and
// "done".
//
//   signals check|alarm|thread
#include <errno.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <poll.h>
#include <signal.h>
#include <sys/select.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/timerfd.h>
#include <time.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstring>

#include "tests/programs/promises.h"

namespace {

using namespace promises;

volatile sig_atomic_t signals_taken = 0;
volatile std::int64_t signal_at = 0;
volatile int signal_value = 0;

void take_signal(int /*signal*/, siginfo_t* info, void* /*context*/) {
  signals_taken = signals_taken + 1;
  signal_at = steady();  // the world can be asked in a handler
  signal_value = info->si_value.sival_int;
}

void take(int signal) {
  struct sigaction action {};
  action.sa_sigaction = take_signal;
  action.sa_flags = SA_SIGINFO;
  sigaction(signal, &action, nullptr);
  signals_taken = 0;
}

void block(int how, int signal) {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, signal);
  sigprocmask(how, &set, nullptr);
}

void check_alarms() {
  take(SIGALRM);
  expect(alarm(2) == 0, "alarm: none before");
  usleep(600'000);
  expect(alarm(1) == 1, "alarm: what was left, to the nearest second");
  std::int64_t begin = steady();
  expect(sleep(3) == 2 && is_about(steady() - begin, kSecond) && signals_taken == 1,
         "alarm ends a sleep");
  itimerval interval{.it_interval = {.tv_sec = 0, .tv_usec = 20'000},
                     .it_value = {.tv_sec = 0, .tv_usec = 50'000}};
  begin = steady();
  expect(setitimer(ITIMER_REAL, &interval, nullptr) == 0, "setitimer");
  timespec left{};
  const timespec minute{.tv_sec = 60, .tv_nsec = 0};
  expect(nanosleep(&minute, &left) == -1 && errno == EINTR &&
             is_about(steady() - begin, 50 * kMillisecond) &&
             is_about(left.tv_sec * kSecond + left.tv_nsec, 60 * kSecond - 50 * kMillisecond),
         "nanosleep says what is left");
  expect(pause() == -1 && errno == EINTR && is_about(steady() - begin, 70 * kMillisecond), "pause");
  expect(poll(nullptr, 0, -1) == -1 && errno == EINTR, "poll is interrupted");
  expect(getitimer(ITIMER_REAL, &interval) == 0 && interval.it_interval.tv_usec == 20'000 &&
             interval.it_value.tv_usec <= 20'000 && interval.it_value.tv_usec > 19'000,
         "getitimer");
  // It expires while the program does not ask, and comes with the next call.
  signals_taken = 0;
  block(SIG_BLOCK, SIGALRM);
  begin = steady();
  usleep(30'000);
  expect(signals_taken == 0 && is_about(steady() - begin, 30 * kMillisecond),
         "a blocked signal ends no sleep");
  block(SIG_UNBLOCK, SIGALRM);
  expect(signals_taken == 1, "it comes when it is unblocked");
  interval = {};
  expect(setitimer(ITIMER_REAL, &interval, nullptr) == 0, "setitimer: disarmed");
  signal(SIGALRM, SIG_IGN);
  expect(ualarm(10'000, 0) == 0 && usleep(20'000) == 0, "an ignored signal ends no sleep");
}

void check_masks() {
  take(SIGALRM);
  block(SIG_BLOCK, SIGALRM);
  sigset_t none;
  sigemptyset(&none);
  std::int64_t begin = steady();
  alarm(1);
  const timespec patience{.tv_sec = 5, .tv_nsec = 0};
  expect(pselect(0, nullptr, nullptr, nullptr, &patience, &none) == -1 && errno == EINTR &&
             is_about(steady() - begin, kSecond) && signals_taken == 1,
         "pselect lets a signal through");
  alarm(1);
  sleep(2);
  begin = steady();
  expect(signals_taken == 1 && ppoll(nullptr, 0, &patience, &none) == -1 && errno == EINTR &&
             signals_taken == 2 && is_about(steady(), begin),
         "ppoll lets one through that waits already");
  alarm(1);
  expect(sigsuspend(&none) == -1 && errno == EINTR && signals_taken == 3, "sigsuspend");
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGALRM);
  begin = steady();
  alarm(2);
  const timespec one{.tv_sec = 1, .tv_nsec = 0};
  expect(sigtimedwait(&set, nullptr, &one) == -1 && errno == EAGAIN &&
             is_about(steady() - begin, kSecond),
         "sigtimedwait at its end");
  expect(sigwaitinfo(&set, nullptr) == SIGALRM && is_about(steady() - begin, 2 * kSecond) &&
             signals_taken == 3,
         "sigwaitinfo takes it without its handler");
  expect(kill(getpid(), SIGALRM) == 0 && sigwaitinfo(&set, nullptr) == SIGALRM, "kill of oneself");
  expect(kill(1, SIGALRM) == -1 && errno == ESRCH, "nobody else is there");
  block(SIG_UNBLOCK, SIGALRM);
}

void take_quietly(int /*signal*/) { signals_taken = signals_taken + 1; }

void check_interrupted_reads() {
  const int fd = udp();
  expect(bind_to(fd, address("0.0.0.0", 5001)) == 0, "bind");
  char byte = 0;
  take(SIGALRM);
  alarm(1);
  expect(recv(fd, &byte, 1, 0) == -1 && errno == EINTR && signals_taken == 1, "recv: EINTR");
  // signal() has SA_RESTART: the read goes on, and the timer's own expiration ends it.
  signal(SIGALRM, take_quietly);
  signals_taken = 0;
  const int timer = timerfd_create(CLOCK_MONOTONIC, 0);
  const itimerspec setting{.it_interval = {}, .it_value = {.tv_sec = 2, .tv_nsec = 0}};
  timerfd_settime(timer, 0, &setting, nullptr);
  alarm(1);
  std::uint64_t expirations = 0;
  expect(read(timer, &expirations, 8) == 8 && expirations == 1 && signals_taken == 1,
         "SA_RESTART begins a read anew");
  const timeval patience{.tv_sec = 3, .tv_usec = 0};
  setsockopt(fd, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  alarm(1);
  expect(recv(fd, &byte, 1, 0) == -1 && errno == EINTR, "one with a timeout does not");
  close(timer);
  close(fd);
}

void check_duplicates() {
  const int fd = udp();
  expect(bind_to(fd, address("0.0.0.0", 5002)) == 0, "bind");
  const int high = fcntl(fd, F_DUPFD, 20);
  expect(high >= 20 && close(fd) == 0, "F_DUPFD");
  const int other = udp();  // it has the number that was closed
  sockaddr_in name{};
  socklen_t size = sizeof name;
  expect(other == fd && getsockname(high, reinterpret_cast<sockaddr*>(&name), &size) == 0 &&
             ntohs(name.sin_port) == 5002,
         "a duplicate outlives its original");
  expect(connect_to(other, address("127.0.0.1", 5002)) == 0 && send(other, "x", 1, 0) == 1, "send");
  char byte = 0;
  expect(recv(high, &byte, 1, 0) == 1 && byte == 'x', "recv of a duplicate");
  expect(dup2(high, other) == other && close(high) == 0, "dup2");
  size = sizeof name;
  expect(getsockname(other, reinterpret_cast<sockaddr*>(&name), &size) == 0 &&
             ntohs(name.sin_port) == 5002,
         "dup2 replaces what was there");
  close(other);
  const int again = udp();
  expect(bind_to(again, address("0.0.0.0", 5002)) == 0, "the last one leaves the port");
  close(again);
}

void check_posix_timers() {
  take(SIGUSR1);
  sigevent event{};
  event.sigev_notify = SIGEV_SIGNAL;
  event.sigev_signo = SIGUSR1;
  event.sigev_value.sival_int = 55;
  timer_t timer{};
  expect(timer_create(CLOCK_MONOTONIC, &event, &timer) == 0, "timer_create");
  const std::int64_t first = steady() + 40 * kMillisecond;
  itimerspec setting{.it_interval = {.tv_sec = 0, .tv_nsec = 10 * kMillisecond},
                     .it_value = {.tv_sec = first / kSecond, .tv_nsec = first % kSecond}};
  expect(timer_settime(timer, TIMER_ABSTIME, &setting, nullptr) == 0, "timer_settime");
  itimerspec left{};
  expect(timer_gettime(timer, &left) == 0 && is_about(left.it_value.tv_nsec, 40 * kMillisecond) &&
             left.it_interval.tv_nsec == 10 * kMillisecond,
         "timer_gettime");
  pause();
  expect(is_about(signal_at, first) && signal_value == 55, "its signal has its value");
  block(SIG_BLOCK, SIGUSR1);
  const timespec some{.tv_sec = 0, .tv_nsec = 35 * kMillisecond};
  expect(nanosleep(&some, nullptr) == 0, "nanosleep");
  block(SIG_UNBLOCK, SIGUSR1);
  expect(signals_taken == 2 && timer_getoverrun(timer) == 2, "three expirations, one signal");
  expect(timer_delete(timer) == 0 && timer_gettime(timer, &left) == -1 && errno == EINVAL,
         "timer_delete");
  expect(timer_create(CLOCK_PROCESS_CPUTIME_ID, &event, &timer) == -1, "no timers of CPU time");
  event.sigev_signo = 1000;
  expect(timer_create(CLOCK_REALTIME, &event, &timer) == -1 && errno == EINVAL, "no such signal");
  expect(timer_create(CLOCK_REALTIME, nullptr, &timer) == 0, "a timer of SIGALRM");
  take(SIGALRM);
  // The clock is set past the time: the timer that waits for it expires.
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  setting = {.it_interval = {}, .it_value = {.tv_sec = now.tv_sec + 1000, .tv_nsec = 0}};
  timer_settime(timer, TIMER_ABSTIME, &setting, nullptr);
  now.tv_sec += 2000;
  clock_settime(CLOCK_REALTIME, &now);
  sleep(2);
  expect(signals_taken == 1, "a timer follows its clock");
  // One that began from now does not.
  setting.it_value = {.tv_sec = 1000, .tv_nsec = 0};
  timer_settime(timer, 0, &setting, nullptr);
  now.tv_sec += 2000;
  clock_settime(CLOCK_REALTIME, &now);
  sleep(2);
  expect(signals_taken == 1, "a timer from now on does not");
  timer_delete(timer);
}

int check() {
  check_alarms();
  check_masks();
  check_interrupted_reads();
  check_posix_timers();
  check_duplicates();
  std::puts("done");
  std::fflush(stdout);
  for (;;) pause();
}

// It has no handler.
int alarm_alone() {
  alarm(1);
  for (;;) sleep(10);
}

int thread_timer() {
  sigevent event{};
  event.sigev_notify = SIGEV_THREAD;
  timer_t timer{};
  return timer_create(CLOCK_MONOTONIC, &event, &timer);
}

}  // namespace

int main(int count, char** words) {
  const char* what = count > 1 ? words[1] : "";
  if (std::strcmp(what, "check") == 0) return check();
  if (std::strcmp(what, "alarm") == 0) return alarm_alone();
  if (std::strcmp(what, "thread") == 0) return thread_timer();
  std::fputs("usage: signals check|alarm|thread\n", stderr);
  return 2;
}
