// What man pages promise of the calls that the shim takes, looked at by a program in the simulated
// world: prints a line for each promise that does not hold, and "done".
//
//   calls echo | calls check ADDRESS | calls spin|garbage|exit
#include <arpa/inet.h>
#include <errno.h>
#include <fcntl.h>
#include <linux/errqueue.h>
#include <linux/net_tstamp.h>
#include <netinet/in.h>
#include <poll.h>
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

#include "tests/programs/promises.h"

namespace {

using namespace promises;

constexpr std::uint16_t kEchoPort = 7;

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
  expect(connect_to(other, address("203.0.113.1", 1)) == -1 && errno == ENETUNREACH,
         "no way out of the simulated network");
  expect(socket(AF_BLUETOOTH, SOCK_RAW, 0) == -1 && errno == EAFNOSUPPORT, "no other network");
  expect(socket(AF_INET, SOCK_RAW, IPPROTO_ICMP) == -1 && errno == ESOCKTNOSUPPORT,
         "no raw sockets");
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

}  // namespace

int main(int count, char** words) {
  const char* what = count > 1 ? words[1] : "";
  if (std::strcmp(what, "echo") == 0) return echo();
  if (std::strcmp(what, "check") == 0 && count == 3) return check(words[2]);
  if (std::strcmp(what, "spin") == 0) {
    for (;;) steady();
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
