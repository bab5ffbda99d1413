// What man pages promise of the calls that the shim takes, looked at by a program in the simulated
// world: prints a line for each promise that does not hold, and "done".
//
//   calls echo | calls check ADDRESS | calls fork|thread|spin|alarm|garbage|exit
#include <arpa/inet.h>
#include <errno.h>
#include <fcntl.h>
#include <linux/errqueue.h>
#include <linux/net_tstamp.h>
#include <netinet/in.h>
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <sys/epoll.h>
#include <sys/random.h>
#include <sys/select.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/timerfd.h>
#include <sys/timex.h>
#include <time.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <initializer_list>

namespace {

constexpr std::uint16_t kEchoPort = 7;
constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::int64_t kMillisecond = 1'000'000;

void expect(bool holds, const char* promise) {
  if (holds) return;
  std::printf("%s (errno %d)\n", promise, errno);
  std::fflush(stdout);
}

std::int64_t read_clock(clockid_t clock) {
  timespec now{};
  expect(clock_gettime(clock, &now) == 0, "clock_gettime");
  return now.tv_sec * kSecond + now.tv_nsec;
}

std::int64_t steady() { return read_clock(CLOCK_MONOTONIC); }
bool is_about(std::int64_t ns, std::int64_t expected) { return std::llabs(ns - expected) < 50'000; }

sockaddr_in address(const char* host, std::uint16_t port) {
  sockaddr_in result{};
  result.sin_family = AF_INET;
  result.sin_port = htons(port);
  inet_pton(AF_INET, host, &result.sin_addr);
  return result;
}

int bind_to(int fd, const sockaddr_in& name) {
  return bind(fd, reinterpret_cast<const sockaddr*>(&name), sizeof name);
}

int connect_to(int fd, const sockaddr_in& name) {
  return connect(fd, reinterpret_cast<const sockaddr*>(&name), sizeof name);
}

int udp(int flags = 0) { return socket(AF_INET, SOCK_DGRAM | flags, 0); }

void check_clocks() {
  const std::int64_t before = read_clock(CLOCK_REALTIME);
  expect(read_clock(CLOCK_REALTIME) > before, "a reading takes time");
  timeval day{};
  expect(gettimeofday(&day, nullptr) == 0 && std::llabs(day.tv_sec - time(nullptr)) <= 1,
         "gettimeofday() and time() agree");
  const timespec set{.tv_sec = 1'800'000'000, .tv_nsec = 5};
  expect(clock_settime(CLOCK_REALTIME, &set) == 0, "clock_settime");
  expect(time(nullptr) == set.tv_sec, "the clock has what it was set to");
  const timespec bad{.tv_sec = 1, .tv_nsec = kSecond};
  expect(clock_settime(CLOCK_REALTIME, &bad) == -1 && errno == EINVAL, "nanoseconds of a second");
  expect(clock_settime(CLOCK_MONOTONIC, &set) == -1 && errno == EINVAL, "no setting of others");
  expect(getpid() == getpid(), "getpid");
}

void check_adjustments() {
  timex now{};
  expect(adjtimex(&now) == TIME_ERROR && now.tick == 10'000 && now.freq == 0, "adjtimex: at first");
  timex faster{};
  faster.modes = ADJ_FREQUENCY;
  faster.freq = 100 << 16;
  const std::int64_t steady_before = steady();
  expect(adjtimex(&faster) >= 0 && faster.freq == 100 << 16, "ADJ_FREQUENCY");
  const std::int64_t before = read_clock(CLOCK_REALTIME);
  sleep(10);
  const std::int64_t gained = read_clock(CLOCK_REALTIME) - before - (steady() - steady_before);
  expect(std::llabs(gained - kMillisecond) < 20'000, "100 ppm are 1 ms in 10 s");
  timex most{};
  most.modes = ADJ_FREQUENCY;
  most.freq = 1000 << 16;
  expect(adjtimex(&most) >= 0 && most.freq == 500 << 16, "frequencies end at 500 ppm");
  timex tick{};
  tick.modes = ADJ_TICK;
  tick.tick = 8'000;
  expect(adjtimex(&tick) == -1 && errno == EINVAL, "ticks end at 9000");
  timex step{};
  step.modes = ADJ_SETOFFSET | ADJ_NANO;
  step.time = {.tv_sec = -1, .tv_usec = 500'000'000};
  const std::int64_t at = read_clock(CLOCK_REALTIME);
  expect(adjtimex(&step) >= 0 && is_about(read_clock(CLOCK_REALTIME) - at, -kSecond / 2) &&
             step.maxerror == 16'000'000,
         "ADJ_SETOFFSET");
  const timeval slew{.tv_sec = 0, .tv_usec = 1000};
  expect(adjtime(&slew, nullptr) == 0, "adjtime");
  ntptimeval reading{};
  expect(ntp_gettime(&reading) == TIME_ERROR && reading.time.tv_sec == time(nullptr),
         "ntp_gettime");
}

void check_sleeps() {
  std::int64_t begin = steady();
  const timespec some{.tv_sec = 0, .tv_nsec = 30 * kMillisecond};
  expect(nanosleep(&some, nullptr) == 0 && is_about(steady() - begin, 30 * kMillisecond),
         "nanosleep");
  begin = steady();
  const std::int64_t wanted = begin + 20 * kMillisecond;
  const timespec until{.tv_sec = wanted / kSecond, .tv_nsec = wanted % kSecond};
  expect(clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == 0 &&
             is_about(steady(), wanted),
         "clock_nanosleep to a time");
  const std::int64_t system = read_clock(CLOCK_REALTIME) + 3 * kSecond;
  const timespec system_until{.tv_sec = system / kSecond, .tv_nsec = system % kSecond};
  expect(clock_nanosleep(CLOCK_REALTIME, TIMER_ABSTIME, &system_until, nullptr) == 0 &&
             is_about(read_clock(CLOCK_REALTIME), system),
         "clock_nanosleep to a system time");
  const timespec bad{.tv_sec = 0, .tv_nsec = -1};
  expect(nanosleep(&bad, nullptr) == -1 && errno == EINVAL, "nanosleep refuses negative times");
  begin = steady();
  expect(usleep(500) == 0 && is_about(steady() - begin, 500'000), "usleep");
}

void check_select() {
  const std::int64_t begin = steady();
  timeval timeout{.tv_sec = 0, .tv_usec = 40'000};
  expect(select(0, nullptr, nullptr, nullptr, &timeout) == 0 &&
             is_about(steady() - begin, 40 * kMillisecond) && timeout.tv_usec == 0,
         "select without descriptors is a sleep");
  const int fd = udp();
  fd_set readers;
  fd_set writers;
  FD_ZERO(&readers);
  FD_ZERO(&writers);
  FD_SET(fd, &readers);
  FD_SET(fd, &writers);
  timeval patience{.tv_sec = 1, .tv_usec = 0};
  expect(select(fd + 1, &readers, &writers, nullptr, &patience) == 1 && !FD_ISSET(fd, &readers) &&
             FD_ISSET(fd, &writers) && patience.tv_sec + patience.tv_usec > 0,
         "a socket can be written to at once");
  pollfd interests[] = {{.fd = fd, .events = POLLIN, .revents = 0},
                        {.fd = -1, .events = POLLIN, .revents = 0}};
  expect(poll(interests, 2, 5) == 0, "poll at its timeout");
  expect(poll(interests, 1, 0) == 0, "poll that only looks");
  int ends[2];
  expect(pipe(ends) == 0 && ::write(ends[1], "x", 1) == 1, "pipes are real");
  interests[0].fd = ends[0];
  expect(poll(interests, 1, 1000) == 1 && interests[0].revents == POLLIN, "poll sees real ones");
  for (const int each : {fd, ends[0], ends[1]}) close(each);
}

void check_timers() {
  const int timer = timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK);
  const int epoll = epoll_create1(0);
  epoll_event watch{};
  watch.events = EPOLLIN;
  watch.data.u32 = 77;
  expect(epoll_ctl(epoll, EPOLL_CTL_ADD, timer, &watch) == 0, "epoll_ctl");
  expect(epoll_ctl(epoll, EPOLL_CTL_ADD, timer, &watch) == -1 && errno == EEXIST, "only once");
  std::uint64_t expirations = 0;
  expect(read(timer, &expirations, 8) == -1 && errno == EAGAIN, "a timer that is not set");
  const itimerspec setting{.it_interval = {.tv_sec = 0, .tv_nsec = 10 * kMillisecond},
                           .it_value = {.tv_sec = 0, .tv_nsec = 25 * kMillisecond}};
  const std::int64_t begin = steady();
  expect(timerfd_settime(timer, 0, &setting, nullptr) == 0, "timerfd_settime");
  itimerspec left{};
  expect(timerfd_gettime(timer, &left) == 0 && is_about(left.it_value.tv_nsec, 25 * kMillisecond) &&
             left.it_interval.tv_nsec == 10 * kMillisecond,
         "timerfd_gettime");
  epoll_event event{};
  expect(epoll_wait(epoll, &event, 1, -1) == 1 && event.data.u32 == 77 &&
             is_about(steady() - begin, 25 * kMillisecond),
         "epoll_wait for a timer");
  expect(read(timer, &expirations, 8) == 8 && expirations == 1, "one expiration");
  usleep(35'000);
  expect(read(timer, &expirations, 8) == 8 && expirations == 3, "three more");
  expect(fcntl(timer, F_SETFL, 0) == 0 && read(timer, &expirations, 8) == 8 && expirations == 1,
         "a blocking read waits");
  close(epoll);
  close(timer);
}

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

void check_own_datagrams() {
  const int receiver = udp(SOCK_NONBLOCK);
  expect(bind_to(receiver, address("0.0.0.0", 5000)) == 0, "bind");
  const int other = udp();
  expect(bind_to(other, address("0.0.0.0", 5000)) == -1 && errno == EADDRINUSE, "EADDRINUSE");
  expect(bind_to(other, address("192.0.2.1", 0)) == -1 && errno == EADDRNOTAVAIL, "EADDRNOTAVAIL");
  expect(send(other, "x", 1, 0) == -1 && errno == EDESTADDRREQ, "EDESTADDRREQ");
  expect(connect_to(other, address("127.0.0.1", 5000)) == 0, "connect");
  sockaddr_in name{};
  socklen_t size = sizeof name;
  expect(getpeername(other, reinterpret_cast<sockaddr*>(&name), &size) == 0 &&
             ntohs(name.sin_port) == 5000,
         "getpeername");
  expect(getsockname(other, reinterpret_cast<sockaddr*>(&name), &size) == 0 && name.sin_port != 0,
         "connect binds");
  char bytes[8];
  expect(recv(receiver, bytes, 8, 0) == -1 && errno == EAGAIN, "EAGAIN");
  expect(send(other, "abcd", 4, 0) == 4, "send");
  expect(recv(receiver, bytes, 2, MSG_PEEK) == 2 && bytes[1] == 'b', "MSG_PEEK leaves it");
  expect(recv(receiver, bytes, 2, MSG_TRUNC) == 4, "MSG_TRUNC is the whole length");
  expect(recv(receiver, bytes, 8, 0) == -1 && errno == EAGAIN, "and the rest is lost");
  const timeval patience{.tv_sec = 0, .tv_usec = 10'000};
  setsockopt(other, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  const std::int64_t begin = steady();
  expect(recv(other, bytes, 8, 0) == -1 && errno == EAGAIN &&
             is_about(steady() - begin, 10 * kMillisecond),
         "SO_RCVTIMEO");
  expect(connect_to(other, address("203.0.113.1", 1)) == 0 && send(other, "x", 1, 0) == -1 &&
             errno == ENETUNREACH,
         "no way out of the simulated network");
  expect(socket(AF_INET6, SOCK_DGRAM, 0) == -1 && errno == EAFNOSUPPORT, "no IPv6");
  expect(socket(AF_INET, SOCK_RAW, IPPROTO_ICMP) == -1, "no raw sockets");
  close(receiver);
  close(other);
  const int again = udp();
  expect(bind_to(again, address("0.0.0.0", 5000)) == 0, "a closed socket leaves its port");
  close(again);
}

// The stamp in a message's control data; 0: none.
std::int64_t stamp_in(msghdr& message, int type) {
  for (cmsghdr* each = CMSG_FIRSTHDR(&message); each != nullptr;
       each = CMSG_NXTHDR(&message, each)) {
    if (each->cmsg_level != SOL_SOCKET || each->cmsg_type != type) continue;
    timespec stamp{};
    std::memcpy(&stamp, CMSG_DATA(each), sizeof stamp);
    return stamp.tv_sec * kSecond + stamp.tv_nsec;
  }
  return 0;
}

void check_stamps(const char* master) {
  const int fd = udp();
  const int flags =
      SOF_TIMESTAMPING_SOFTWARE | SOF_TIMESTAMPING_RX_SOFTWARE | SOF_TIMESTAMPING_TX_SOFTWARE;
  expect(setsockopt(fd, SOL_SOCKET, SO_TIMESTAMPING, &flags, sizeof flags) == 0, "SO_TIMESTAMPING");
  expect(connect_to(fd, address(master, kEchoPort)) == 0, "connect to the master");
  const std::int64_t before = read_clock(CLOCK_REALTIME);
  expect(send(fd, "echo", 4, 0) == 4, "send to the master");
  char bytes[100];
  alignas(cmsghdr) char control[256];
  iovec piece{.iov_base = bytes, .iov_len = sizeof bytes};
  msghdr message{};
  message.msg_iov = &piece;
  message.msg_iovlen = 1;
  message.msg_control = control;
  message.msg_controllen = sizeof control;
  expect(recvmsg(fd, &message, MSG_ERRQUEUE) == 14 + 20 + 8 + 4 &&
             std::memcmp(bytes + 42, "echo", 4) == 0,
         "the error queue has the packet as it left");
  const std::int64_t left = stamp_in(message, SCM_TIMESTAMPING);
  message.msg_controllen = sizeof control;
  pollfd interest{.fd = fd, .events = POLLIN, .revents = 0};
  expect(poll(&interest, 1, 1000) == 1, "the echo comes");
  expect(recvmsg(fd, &message, 0) == 4, "and is read");
  const std::int64_t came = stamp_in(message, SCM_TIMESTAMPING);
  const std::int64_t after = read_clock(CLOCK_REALTIME);
  expect(before <= left && left < came && came <= after, "stamps lie between the readings");
}

void check_chance() {
  std::uint64_t numbers[4] = {};
  expect(getrandom(numbers, 16, 0) == 16 && numbers[0] != numbers[1], "getrandom");
  const int fd = open("/dev/urandom", O_RDONLY);
  expect(read(fd, numbers + 2, 8) == 8 && numbers[2] != 0, "/dev/urandom");
  close(fd);
  FILE* file = std::fopen("/dev/urandom", "r");
  expect(file != nullptr && std::fread(numbers + 3, 8, 1, file) == 1 && numbers[3] != 0,
         "/dev/urandom as a stream");
  if (file != nullptr) std::fclose(file);
  std::printf("chance %016llx\n", static_cast<unsigned long long>(numbers[0] ^ numbers[3]));
}

int check(const char* master) {
  check_adjustments();
  check_clocks();
  check_sleeps();
  check_select();
  check_timers();
  check_alarms();
  check_masks();
  check_posix_timers();
  check_own_datagrams();
  check_stamps(master);
  check_chance();
  std::puts("done");
  std::fflush(stdout);
  for (;;) sleep(3600);
}

int echo() {
  const int fd = udp();
  expect(bind_to(fd, address("0.0.0.0", kEchoPort)) == 0, "bind");
  for (;;) {
    char bytes[1500];
    sockaddr_in from{};
    socklen_t size = sizeof from;
    auto* name = reinterpret_cast<sockaddr*>(&from);
    const ssize_t got = recvfrom(fd, bytes, sizeof bytes, 0, name, &size);
    if (got < 0) return 1;
    sendto(fd, bytes, static_cast<std::size_t>(got), 0, name, size);
  }
}

void* read_in_a_thread(void*) {
  steady();
  return nullptr;
}

}  // namespace

int main(int count, char** words) {
  const char* what = count > 1 ? words[1] : "";
  if (std::strcmp(what, "echo") == 0) return echo();
  if (std::strcmp(what, "check") == 0 && count == 3) return check(words[2]);
  if (std::strcmp(what, "fork") == 0) return fork() < 0 ? 1 : 0;
  if (std::strcmp(what, "thread") == 0) {
    pthread_t thread{};
    pthread_create(&thread, nullptr, read_in_a_thread, nullptr);
    return pthread_join(thread, nullptr);
  }
  if (std::strcmp(what, "spin") == 0) {
    for (;;) steady();
  }
  if (std::strcmp(what, "alarm") == 0) {
    alarm(1);
    for (;;) sleep(10);
  }
  if (std::strcmp(what, "thread timer") == 0) {
    sigevent event{};
    event.sigev_notify = SIGEV_THREAD;
    timer_t timer{};
    timer_create(CLOCK_MONOTONIC, &event, &timer);
  }
  if (std::strcmp(what, "garbage") == 0) {
    const int link = std::atoi(std::getenv("SIMBENCH_LINK"));
    const unsigned char nonsense[32] = {0xFF, 0xFF, 0xFF, 0xFF, 0xFF};
    send(link, nonsense, sizeof nonsense, 0);
    pause();
  }
  std::puts("what it says last");
  return 3;
}
