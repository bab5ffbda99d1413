// Looks at what a program sees where only the clock is the world's: its host's clock runs wrong by
// 1 s and 100 ppm, and everything else is the machine's. Prints a line for each promise that does
// not hold, and "done".
#include <linux/net_tstamp.h>
#include <sys/select.h>
#include <sys/time.h>
#include <sys/timerfd.h>
#include <sys/timex.h>

#include "tests/programs/promises.h"

namespace {

using promises::address;
using promises::bind_to;
using promises::expect;
using promises::expect_error;
using promises::kMillisecond;
using promises::kSecond;
using promises::read_clock;
using promises::set_number;
using promises::steady;
using promises::to_ns;
using promises::udp;

// The host's clock is a second wrong, and this machine may be busy for a while.
bool is_near(std::int64_t a, std::int64_t b, std::int64_t tolerance = 400 * kMillisecond) {
  return (a > b ? a - b : b - a) <= tolerance;
}

std::int64_t system_time() { return read_clock(CLOCK_REALTIME); }

void check_readings() {
  timeval coarse{};
  gettimeofday(&coarse, nullptr);
  expect(is_near(coarse.tv_sec * kSecond + coarse.tv_usec * 1000, system_time()), "gettimeofday");
  expect(is_near(read_clock(CLOCK_REALTIME_COARSE), system_time()), "coarse");
  expect(is_near(time(nullptr) * kSecond + kSecond / 2, system_time(), kSecond), "time");
}

// Both clocks at one instant: the closest of some readings, since others run on this machine too.
struct Instant {
  std::int64_t system = 0;
  std::int64_t monotonic = 0;
};
Instant closest_readings() {
  Instant closest;
  std::int64_t smallest = INT64_MAX;
  for (int tried = 0; tried < 1000 && smallest > 500; ++tried) {
    const std::int64_t before = steady();
    const std::int64_t system = system_time();
    const std::int64_t passed = steady() - before;
    if (passed >= smallest) continue;
    smallest = passed;
    closest = {.system = system, .monotonic = before + passed / 2};
  }
  return closest;
}

// In ppm.
double measured_rate(int ms) {
  const Instant begin = closest_readings();
  usleep(static_cast<useconds_t>(ms) * 1000);
  const Instant end = closest_readings();
  const auto passed = static_cast<double>(end.monotonic - begin.monotonic);
  return (static_cast<double>(end.system - begin.system) / passed - 1) * 1e6;
}

void check_adjustments() {
  timex setting{};
  expect(adjtimex(&setting) == TIME_ERROR, "the clock is not synchronised at first");
  expect(setting.tick == 10'000 && setting.freq == 0, "no correction at first");
  const double before = measured_rate(200);
  expect(before > 80 && before < 120, "the oscillator's own rate");
  setting.modes = ADJ_TICK | ADJ_FREQUENCY;
  setting.tick = 10'010;
  setting.freq = -65'536L * 400;
  expect(adjtimex(&setting) >= 0, "adjtimex");
  const double after = measured_rate(200);
  expect(after > 680 && after < 720, "100 ppm of its own, 600 of adjtimex()");
  setting.modes = ADJ_TICK;
  setting.tick = 20'000;
  expect_error(adjtimex(&setting), EINVAL, "a tick that is too long");
  timex offset{};
  offset.modes = ADJ_SETOFFSET | ADJ_NANO;
  offset.time.tv_sec = 5;
  const std::int64_t system = system_time();
  expect(clock_adjtime(CLOCK_REALTIME, &offset) >= 0, "ADJ_SETOFFSET");
  expect(is_near(system_time() - system, 5 * kSecond), "a step of 5 s");
  timeval slew{.tv_sec = 0, .tv_usec = 1000};
  timeval left{};
  expect(adjtime(&slew, nullptr) == 0 && adjtime(nullptr, &left) == 0, "adjtime");
  expect(left.tv_usec > 0 && left.tv_usec <= 1000, "what adjtime() has left");
}

void check_settings() {
  const timespec wanted{.tv_sec = 1'900'000'000, .tv_nsec = 250'000'000};
  expect(clock_settime(CLOCK_REALTIME, &wanted) == 0, "clock_settime");
  expect(is_near(system_time(), to_ns(wanted)), "reads what it was set to");
  expect_error(clock_settime(CLOCK_MONOTONIC, &wanted), EINVAL, "no other clock can be set");
}

void check_waits() {
  const std::int64_t begin = steady();
  const std::int64_t at = system_time() + 50 * kMillisecond;
  const timespec until{.tv_sec = at / kSecond, .tv_nsec = at % kSecond};
  expect(clock_nanosleep(CLOCK_REALTIME, TIMER_ABSTIME, &until, nullptr) == 0, "clock_nanosleep");
  expect(system_time() >= at && is_near(steady() - begin, 50 * kMillisecond),
         "sleeps until a time of its host's clock");
  const int timer = timerfd_create(CLOCK_REALTIME, 0);
  const std::int64_t next = system_time() + 50 * kMillisecond;
  itimerspec setting{};
  setting.it_value = {.tv_sec = next / kSecond, .tv_nsec = next % kSecond};
  expect(timerfd_settime(timer, TFD_TIMER_ABSTIME, &setting, nullptr) == 0, "timerfd_settime");
  std::uint64_t times = 0;
  expect(read(timer, &times, sizeof times) == sizeof times && times == 1, "a timer expires once");
  expect(system_time() >= next && is_near(system_time(), next), "at a time of its host's clock");
  close(timer);
}

// The stamp by software in the message's control data; 0 without one.
std::int64_t stamp_in(msghdr& message) {
  for (cmsghdr* head = CMSG_FIRSTHDR(&message); head != nullptr;
       head = CMSG_NXTHDR(&message, head)) {
    timespec exact{};
    timeval rounded{};
    if (head->cmsg_level != SOL_SOCKET) continue;
    if (head->cmsg_type == SCM_TIMESTAMP) {
      std::memcpy(&rounded, CMSG_DATA(head), sizeof rounded);
      return rounded.tv_sec * kSecond + rounded.tv_usec * 1000;
    }
    if (head->cmsg_type != SCM_TIMESTAMPNS && head->cmsg_type != SCM_TIMESTAMPING) continue;
    std::memcpy(&exact, CMSG_DATA(head), sizeof exact);
    return to_ns(exact);
  }
  return 0;
}

std::int64_t stamp_of_next(int fd, int flags) {
  char text[256];
  char control[256];
  iovec piece{.iov_base = text, .iov_len = sizeof text};
  msghdr message{};
  message.msg_iov = &piece;
  message.msg_iovlen = 1;
  message.msg_control = control;
  message.msg_controllen = sizeof control;
  expect(recvmsg(fd, &message, flags) >= 0, "recvmsg");
  return stamp_in(message);
}

void check_stamps(int option, int value, const char* name) {
  const int from = udp();
  const int to = udp();
  const sockaddr_in there = address("127.0.0.1", 0);
  expect(bind_to(to, there) == 0, "bind");
  sockaddr_in name_of_it{};
  socklen_t size = sizeof name_of_it;
  getsockname(to, reinterpret_cast<sockaddr*>(&name_of_it), &size);
  expect(set_number(to, SOL_SOCKET, option, value) == 0, name);
  const int departures = SOF_TIMESTAMPING_SOFTWARE | SOF_TIMESTAMPING_TX_SOFTWARE;
  expect(set_number(from, SOL_SOCKET, SO_TIMESTAMPING, departures) == 0, "SO_TIMESTAMPING");
  const std::int64_t before = system_time();
  expect(promises::send_text(from, "hello", name_of_it) == 5, "sendto");
  expect(promises::has_input(to), "the machine's network carries it");
  // A step before the stamp is read does not change what the clock read then.
  timex step{};
  step.modes = ADJ_SETOFFSET;
  step.time.tv_sec = 1;
  const std::int64_t after = system_time();
  adjtimex(&step);
  constexpr std::int64_t kRounding = 20'000;
  const std::int64_t arrived = stamp_of_next(to, 0);
  expect(arrived > before - kRounding && arrived < after + kRounding, name);
  const std::int64_t left = stamp_of_next(from, MSG_ERRQUEUE);
  expect(left > before - kRounding && left < after + kRounding, "the stamp of a departure");
  close(from);
  close(to);
}

}  // namespace

int main() {
  expect(getuid() == 0, "root of its host");
  check_readings();
  check_adjustments();
  check_settings();
  check_waits();
  check_stamps(SO_TIMESTAMP, 1, "SO_TIMESTAMP");
  check_stamps(SO_TIMESTAMPNS, 1, "SO_TIMESTAMPNS");
  check_stamps(SO_TIMESTAMPING, SOF_TIMESTAMPING_SOFTWARE | SOF_TIMESTAMPING_RX_SOFTWARE,
               "SO_TIMESTAMPING");
  std::puts("done");
}
