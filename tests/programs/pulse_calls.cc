// What RFC 2783, Linux' <linux/pps.h> and its external stamps of PTP hardware clocks promise.
//
//   pulse_calls absent           on a host without a line
//   pulse_calls check NS SLACK   the pulses' stamps are so far from full seconds, within the slack
//   pulse_calls card NS          the line's stamps are so late, those of the card are not
//   pulse_calls print COUNT      the stamps of so many pulses, ns
#include <fcntl.h>
#include <linux/pps.h>
#include <linux/ptp_clock.h>
#include <signal.h>
#include <sys/epoll.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <sys/timex.h>
#include <sys/wait.h>

#include "tests/programs/promises.h"

namespace {

using promises::expect;
using promises::expect_error;
using promises::finish;
using promises::has_input;
using promises::kMillisecond;
using promises::kSecond;
using promises::read_clock;
using promises::steady;

std::int64_t to_ns(const pps_ktime& time) { return time.sec * kSecond + time.nsec; }
std::int64_t to_ns(const ptp_clock_time& time) { return time.sec * kSecond + time.nsec; }

pps_ktime to_pps(std::int64_t ns) {
  pps_ktime time{};
  time.sec = ns / kSecond;
  time.nsec = static_cast<std::int32_t>(ns % kSecond);
  return time;
}

// Below 0: for as long as it takes.
int fetch(int fd, std::int64_t timeout_ns, pps_kinfo& info) {
  pps_fdata data{};
  data.timeout = to_pps(timeout_ns < 0 ? 0 : timeout_ns);
  data.timeout.flags = timeout_ns < 0 ? PPS_TIME_INVALID : 0;
  const int result = ioctl(fd, PPS_FETCH, &data);
  info = data.info;
  return result;
}

pps_kinfo next_pulse(int fd) {
  pps_kinfo info{};
  expect(fetch(fd, -1, info) == 0, "a fetch without a timeout");
  return info;
}

void check_absence() {
  struct stat status {};
  expect_error(open("/dev/pps0", O_RDWR), ENOENT, "no line, no device");
  expect_error(stat("/dev/pps0", &status), ENOENT, "no line, no file");
  expect_error(access("/dev/pps0", R_OK), ENOENT, "no line, no access");
  const int card = open("/dev/ptp0", O_RDWR);
  ptp_clock_caps abilities{};
  expect(ioctl(card, PTP_CLOCK_GETCAPS, &abilities) == 0 && abilities.n_pins == 0 &&
             abilities.n_ext_ts == 0,
         "no line, no pin");
  ptp_pin_desc pin{};
  expect_error(ioctl(card, PTP_PIN_GETFUNC, &pin), EINVAL, "no pin to ask for");
  ptp_extts_request request{};
  request.flags = PTP_ENABLE_FEATURE | PTP_RISING_EDGE;
  expect_error(ioctl(card, PTP_EXTTS_REQUEST2, &request), EINVAL, "no channel to enable");
  expect(!has_input(card, 2000), "no stamps");
}

void check_parameters(int fd) {
  int abilities = 0;
  expect(ioctl(fd, PPS_GETCAP, &abilities) == 0 &&
             abilities == (PPS_CAPTUREASSERT | PPS_OFFSETASSERT | PPS_CANWAIT | PPS_TSFMT_TSPEC),
         "PPS_GETCAP");
  pps_kparams parameters{};
  expect(ioctl(fd, PPS_GETPARAMS, &parameters) == 0 && parameters.api_version == PPS_API_VERS_1 &&
             (parameters.mode & PPS_CAPTUREASSERT) != 0,
         "PPS_GETPARAMS");
  pps_kparams wanted{};
  expect_error(ioctl(fd, PPS_SETPARAMS, &wanted), EINVAL, "no edge to capture");
  wanted.mode = PPS_CAPTUREBOTH;
  expect_error(ioctl(fd, PPS_SETPARAMS, &wanted), EINVAL, "no clear events");
  wanted.mode = PPS_CAPTUREASSERT;
  expect(ioctl(fd, PPS_SETPARAMS, &wanted) == 0, "PPS_SETPARAMS");
  expect(ioctl(fd, PPS_GETPARAMS, &parameters) == 0 &&
             parameters.mode == (PPS_CAPTUREASSERT | PPS_TSFMT_TSPEC | PPS_CANWAIT),
         "is read back, with what cannot be changed");
  pps_bind_args kernel{};
  expect_error(ioctl(fd, PPS_KC_BIND, &kernel), EOPNOTSUPP, "no kernel consumer");
  expect_error(ioctl(fd, PTP_CLOCK_GETCAPS, &kernel), ENOTTY, "a request of another device");
  expect_error(ioctl(fd, PPS_GETCAP, nullptr), EFAULT, "nowhere to write to");
}

void check_device(int fd) {
  struct stat by_name {};
  struct stat by_number {};
  expect(stat("/dev/pps0", &by_name) == 0 && S_ISCHR(by_name.st_mode), "stat");
  expect(fstat(fd, &by_number) == 0 && by_number.st_rdev == by_name.st_rdev, "fstat");
  expect(access("/dev/pps0", R_OK | W_OK) == 0, "access");
  expect_error(open("/dev/pps1", O_RDWR), ENOENT, "there is one line");
  char byte = 0;
  expect_error(read(fd, &byte, 1), EINVAL, "read");
  expect_error(write(fd, &byte, 1), EINVAL, "write");
}

bool is_near_second(const pps_kinfo& info, std::int64_t late_ns, std::int64_t slack_ns) {
  std::int64_t off = (to_ns(info.assert_tu) - late_ns) % kSecond;
  if (off > kSecond / 2) off -= kSecond;
  if (std::llabs(off) <= slack_ns) return true;
  std::printf("%lld ns off a second\n", static_cast<long long>(off));
  return false;
}

void check_pulses(int fd, std::int64_t late_ns, std::int64_t slack_ns) {
  pps_kinfo before{};
  expect(fetch(fd, 0, before) == 0 && before.assert_sequence == 0 && to_ns(before.assert_tu) == 0,
         "nothing yet");
  for (unsigned i = 1; i <= 3; ++i) {
    const pps_kinfo pulse = next_pulse(fd);
    expect(pulse.assert_sequence == i, "each is counted");
    expect(pulse.clear_sequence == 0 && to_ns(pulse.clear_tu) == 0, "there are no clear events");
    expect(is_near_second(pulse, late_ns, slack_ns), "the stamp is the pulse's, late as stated");
    expect(read_clock(CLOCK_REALTIME) - to_ns(pulse.assert_tu) < 1000, "a wait ends with it");
    const std::int64_t interval = to_ns(pulse.assert_tu) - to_ns(before.assert_tu);
    expect(i == 1 || std::llabs(interval - kSecond) <= slack_ns, "one a second");
    before = pulse;
  }
  pps_kinfo again{};
  expect(fetch(fd, 0, again) == 0 && again.assert_sequence == 3, "the last one stays");
  const std::int64_t begin = steady();
  expect_error(fetch(fd, 100 * kMillisecond, again), ETIMEDOUT, "none in time");
  expect(std::llabs(steady() - begin - 100 * kMillisecond) < kMillisecond, "in simulated time");
  expect(fetch(fd, 2 * kSecond, again) == 0 && again.assert_sequence == 4, "one in time");
}

void on_alarm(int /*signal*/) {}

void check_signal(int fd) {
  struct sigaction action {};
  action.sa_handler = on_alarm;
  action.sa_flags = SA_RESTART;
  sigaction(SIGALRM, &action, nullptr);
  next_pulse(fd);
  const itimerval soon{.it_interval = {}, .it_value = {.tv_sec = 0, .tv_usec = 1000}};
  setitimer(ITIMER_REAL, &soon, nullptr);
  pps_kinfo info{};
  expect_error(fetch(fd, -1, info), EINTR, "a handler ends a fetch");
}

void check_readiness(int fd) {
  next_pulse(fd);
  expect(!has_input(fd, 500), "not ready before the next pulse");
  expect(has_input(fd, 1000) && has_input(fd, 0), "ready until it is fetched");
  const int other = open("/dev/pps0", O_RDONLY);
  pps_kinfo info{};
  expect(fetch(fd, 0, info) == 0 && !has_input(fd, 0), "not ready after that");
  const int set = epoll_create1(0);
  epoll_event event{.events = EPOLLIN | EPOLLET, .data = {.fd = other}};
  expect(epoll_ctl(set, EPOLL_CTL_ADD, other, &event) == 0, "epoll_ctl");
  expect(epoll_wait(set, &event, 1, 500) == 0, "nothing yet");
  for (int i = 0; i < 2; ++i) {
    expect(epoll_wait(set, &event, 1, 1000) == 1 && event.data.fd == other, "epoll_wait");
    expect(epoll_wait(set, &event, 1, 10) == 0, "an event for each pulse");
  }
  close(set);
  close(other);
}

void check_offset(int fd) {
  const pps_kinfo plain = next_pulse(fd);
  pps_kparams parameters{};
  ioctl(fd, PPS_GETPARAMS, &parameters);
  parameters.mode |= PPS_OFFSETASSERT;
  parameters.assert_off_tu.sec = -3;
  parameters.assert_off_tu.nsec = 999'000'000;
  expect(ioctl(fd, PPS_SETPARAMS, &parameters) == 0, "an offset");
  const pps_kinfo shifted = next_pulse(fd);
  const std::int64_t interval = to_ns(shifted.assert_tu) - to_ns(plain.assert_tu);
  expect(std::llabs(interval - kSecond + 2'001 * kMillisecond) < 100'000, "shifts the stamp");
  expect((shifted.current_mode & PPS_OFFSETASSERT) != 0, "which is said with it");
}

// A child has the same line; a fetch of its does not take the parent's pulse.
void check_child(int fd) {
  const pid_t child = fork();
  if (child == 0) {
    const pps_kinfo own = next_pulse(open("/dev/pps0", O_RDWR));
    _exit(own.assert_sequence % 100);
  }
  const pps_kinfo own = next_pulse(fd);
  int status = 0;
  expect(waitpid(child, &status, 0) == child &&
             WEXITSTATUS(status) == static_cast<int>(own.assert_sequence % 100),
         "two processes see one pulse");
}

// The external stamps of the card.

clockid_t clock_of(int fd) { return (~static_cast<clockid_t>(fd) << 3) | 3; }

int request_stamps(int fd, unsigned flags, unsigned channel = 0) {
  ptp_extts_request request{};
  request.index = channel;
  request.flags = flags;
  return ioctl(fd, PTP_EXTTS_REQUEST2, &request);
}

int set_pin(int fd, unsigned function, unsigned channel = 0, unsigned index = 0) {
  ptp_pin_desc pin{};
  pin.index = index;
  pin.func = function;
  pin.chan = channel;
  return ioctl(fd, PTP_PIN_SETFUNC2, &pin);
}

void check_pin(int fd) {
  ptp_clock_caps abilities{};
  expect(ioctl(fd, PTP_CLOCK_GETCAPS2, &abilities) == 0 && abilities.n_pins == 1 &&
             abilities.n_ext_ts == 1 && abilities.n_per_out == 0 && abilities.pps == 0,
         "PTP_CLOCK_GETCAPS");
  ptp_pin_desc pin{};
  expect(ioctl(fd, PTP_PIN_GETFUNC2, &pin) == 0 && std::strcmp(pin.name, "SDP0") == 0 &&
             pin.func == PTP_PF_NONE,
         "PTP_PIN_GETFUNC");
  constexpr unsigned kOn = PTP_ENABLE_FEATURE | PTP_RISING_EDGE;
  expect_error(request_stamps(fd, kOn), EBUSY, "the pin is not for stamps");
  expect_error(set_pin(fd, PTP_PF_EXTTS, 1), EINVAL, "no second channel");
  expect_error(set_pin(fd, PTP_PF_EXTTS, 0, 1), EINVAL, "no second pin");
  expect_error(set_pin(fd, PTP_PF_PEROUT), EINVAL, "no periodic outputs");
  expect_error(set_pin(fd, PTP_PF_PHYSYNC), EOPNOTSUPP, "no clock recovery");
  expect(set_pin(fd, PTP_PF_EXTTS) == 0, "PTP_PIN_SETFUNC");
  expect(ioctl(fd, PTP_PIN_GETFUNC, &pin) == 0 && pin.func == PTP_PF_EXTTS, "is read back");
  expect_error(request_stamps(fd, kOn, 1), EINVAL, "no such channel");
  expect_error(request_stamps(fd, PTP_ENABLE_FEATURE), EINVAL, "no edge");
  expect_error(request_stamps(fd, kOn | PTP_FALLING_EDGE), EOPNOTSUPP, "no falling edges");
  expect_error(ioctl(fd, PTP_ENABLE_PPS, 1), EOPNOTSUPP, "no pulses of the card's own");
  ptp_perout_request output{};
  expect_error(ioctl(fd, PTP_PEROUT_REQUEST, &output), EINVAL, "no outputs");
  expect(!has_input(fd, 2000), "no stamps before they are asked for");
  expect(request_stamps(fd, kOn) == 0, "PTP_EXTTS_REQUEST");
}

// The next stamp of the card; it must be about now.
std::int64_t next_stamp(int fd) {
  ptp_extts_event event{};
  const std::int64_t begin = read_clock(clock_of(fd));
  expect(read(fd, &event, sizeof event) == sizeof event && event.index == 0, "read");
  const std::int64_t stamp = to_ns(event.t);
  expect(stamp > begin && read_clock(clock_of(fd)) - stamp < 100'000, "a read waits for the pulse");
  return stamp;
}

// How far the card's clock is ahead of the system's.
std::int64_t card_ahead(int fd) {
  ptp_sys_offset_extended offset{};
  offset.n_samples = 1;
  expect(ioctl(fd, PTP_SYS_OFFSET_EXTENDED, &offset) == 0, "PTP_SYS_OFFSET_EXTENDED");
  return to_ns(offset.ts[0][1]) - (to_ns(offset.ts[0][0]) + to_ns(offset.ts[0][2])) / 2;
}

void check_stamps(int fd, std::int64_t late_ns) {
  const int line = open("/dev/pps0", O_RDWR);
  for (int i = 0; i < 5; ++i) {
    const std::int64_t card = next_stamp(fd);
    const std::int64_t ahead = card_ahead(fd);
    pps_kinfo info{};
    expect(fetch(line, 0, info) == 0, "the line's own stamp");
    // Both are rounded down to 8 ns, and the card drifts by some 10 ppm in 50 us.
    const std::int64_t pulse = to_ns(info.assert_tu) - late_ns;
    expect(std::llabs(card - ahead - pulse) <= 10, "the card stamps the pulse itself");
  }
  close(line);
}

void check_rate(int fd) {
  const std::int64_t first = next_stamp(fd);
  const std::int64_t second = next_stamp(fd);
  timex faster{};
  faster.modes = ADJ_FREQUENCY;
  faster.freq = 1000L << 16;
  expect(clock_adjtime(clock_of(fd), &faster) == 0, "ADJ_FREQUENCY");
  const std::int64_t third = next_stamp(fd);
  const std::int64_t fourth = next_stamp(fd);
  const std::int64_t gained = (fourth - third) - (second - first);
  // 1 ms, of the card's own second.
  expect(std::llabs(gained - kMillisecond) <= 100, "1000 ppm more are 1 ms more in 1 s");
  expect(third > second, "and it goes on");
}

void check_queue(int fd) {
  ptp_extts_event events[40];
  const std::int64_t before = next_stamp(fd);
  usleep(200'500'000);
  expect_error(read(fd, events, sizeof events[0] - 1), EINVAL, "a part of a stamp");
  ssize_t count = 0;
  std::int64_t first = 0;
  for (ssize_t size = sizeof events; has_input(fd, 0);) {
    size = read(fd, events, sizeof events);
    if (count == 0) {
      expect(size == 30 * ssize_t{sizeof events[0]}, "30 at once");
      first = to_ns(events[0].t);
    }
    count += size / ssize_t{sizeof events[0]};
  }
  expect(count == 127, "the last 127 are kept");
  const std::int64_t skipped = (first - before + kSecond / 2) / kSecond;
  expect(skipped == 200 - 127 + 1, "the oldest are gone");
}

void check_card(std::int64_t late_ns) {
  const int fd = open("/dev/ptp0", O_RDWR | O_NONBLOCK);
  check_pin(fd);
  check_stamps(fd, late_ns);
  check_rate(fd);
  check_queue(fd);
  expect(set_pin(fd, PTP_PF_NONE) == 0 && !has_input(fd, 2000), "a pin for nothing stamps nothing");
  expect(set_pin(fd, PTP_PF_EXTTS) == 0 && !has_input(fd, 2000), "until it is asked to");
  expect(request_stamps(fd, PTP_ENABLE_FEATURE | PTP_RISING_EDGE) == 0, "again");
  const int set = epoll_create1(0);
  epoll_event event{.events = EPOLLIN, .data = {.fd = fd}};
  expect(epoll_ctl(set, EPOLL_CTL_ADD, fd, &event) == 0, "epoll_ctl");
  expect(epoll_wait(set, &event, 1, 1500) == 1 && event.events == EPOLLIN, "epoll_wait");
  ptp_extts_event stamp{};
  const int other = open("/dev/ptp0", O_RDONLY);
  expect(read(other, &stamp, sizeof stamp) == sizeof stamp, "another descriptor of the card");
  expect(!has_input(fd, 0), "takes what all have");
  close(other);
  close(set);
  close(fd);
}

void check(std::int64_t late_ns, std::int64_t slack_ns) {
  const int fd = open("/dev/pps0", O_RDWR);
  expect(fd >= 0, "open");
  check_device(fd);
  check_parameters(fd);
  check_pulses(fd, late_ns, slack_ns);
  check_signal(fd);
  check_readiness(fd);
  check_offset(fd);
  check_child(fd);
  close(fd);
}

void print_stamps(int count) {
  const int fd = open("/dev/pps0", O_RDWR);
  for (int i = 0; i < count; ++i) {
    std::printf("%lld\n", static_cast<long long>(to_ns(next_pulse(fd).assert_tu)));
  }
}

}  // namespace

int main(int count, char** words) {
  const char* const what = count > 1 ? words[1] : "";
  if (std::strcmp(what, "absent") == 0) {
    check_absence();
  } else if (std::strcmp(what, "check") == 0 && count > 3) {
    check(std::atoll(words[2]), std::atoll(words[3]));
  } else if (std::strcmp(what, "card") == 0 && count > 2) {
    check_card(std::atoll(words[2]));
  } else if (std::strcmp(what, "print") == 0 && count > 2) {
    print_stamps(std::atoi(words[2]));
  } else {
    return 2;
  }
  finish();
}
