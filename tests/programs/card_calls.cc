// What Linux' documentation of PTP hardware clocks and of time stamping promises.
//
//   card_calls answer   sends back what comes, on port 319
//   card_calls check ADDRESS
#include <fcntl.h>
#include <linux/errqueue.h>
#include <linux/ethtool.h>
#include <linux/net_tstamp.h>
#include <linux/ptp_clock.h>
#include <linux/sockios.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/timex.h>

#include "tests/programs/promises.h"

namespace {

using promises::address;
using promises::bind_to;
using promises::expect;
using promises::expect_error;
using promises::finish;
using promises::has_input;
using promises::kMillisecond;
using promises::kSecond;
using promises::read_clock;
using promises::send_text;
using promises::set_number;
using promises::steady;
using promises::to_ns;
using promises::udp;

constexpr std::uint16_t kPort = 319;

clockid_t clock_of(int fd) { return (~static_cast<clockid_t>(fd) << 3) | 3; }

timex read_adjustment(clockid_t clock) {
  timex now{};
  expect(clock_adjtime(clock, &now) == 0, "clock_adjtime that reads");
  return now;
}

void check_clock() {
  const int fd = open("/dev/ptp0", O_RDWR);
  const clockid_t clock = clock_of(fd);
  const std::int64_t before = read_clock(clock);
  expect(read_clock(clock) > before, "it runs");
  const timespec set{.tv_sec = 1'800'000'000, .tv_nsec = 5};
  expect(clock_settime(clock, &set) == 0, "clock_settime");
  expect(std::llabs(read_clock(clock) - to_ns(set)) < 100'000, "has what it was set to");
  timex step{};
  step.modes = ADJ_SETOFFSET | ADJ_NANO;
  step.time = {.tv_sec = -2, .tv_usec = 500'000'000};
  const std::int64_t at = read_clock(clock);
  expect(clock_adjtime(clock, &step) == 0, "ADJ_SETOFFSET");
  expect(std::llabs(read_clock(clock) - at + 1'500 * kMillisecond) < 100'000, "by this much");
  step.time.tv_usec = kSecond;
  expect_error(clock_adjtime(clock, &step), EINVAL, "nanoseconds of a second");
  const std::int64_t own = read_clock(clock) - steady();
  timex faster{};
  faster.modes = ADJ_FREQUENCY;
  faster.freq = 1000L << 16;
  sleep(1);
  const std::int64_t drift = read_clock(clock) - steady() - own;
  expect(clock_adjtime(clock, &faster) == 0, "ADJ_FREQUENCY");
  expect(read_adjustment(clock).freq == faster.freq, "is read back");
  const std::int64_t begin = read_clock(clock) - steady();
  sleep(1);
  const std::int64_t gained = read_clock(clock) - steady() - begin - drift;
  expect(std::llabs(gained - kMillisecond) < 10'000, "1000 ppm are 1 ms in 1 s");
  faster.freq = 62'500L << 16;
  expect_error(clock_adjtime(clock, &faster), ERANGE, "rates end");
  timex phase{};
  phase.modes = ADJ_OFFSET;
  expect_error(clock_adjtime(clock, &phase), EOPNOTSUPP, "no phase adjustments");
  close(fd);
  timespec time{};
  expect_error(clock_gettime(clock, &time), EINVAL, "a closed clock");
  expect_error(open("/dev/ptp0x", O_RDWR), ENOENT, "there is one clock");
}

bool is_between(const ptp_clock_time& before, const ptp_clock_time& after) {
  const std::int64_t ns = (after.sec - before.sec) * kSecond + after.nsec - before.nsec;
  return ns > 0 && ns < 100'000;
}

void check_requests() {
  const int fd = open("/dev/ptp0", O_RDWR);
  ptp_clock_caps abilities{};
  expect(ioctl(fd, PTP_CLOCK_GETCAPS, &abilities) == 0 && abilities.max_adj == 62'499'999 &&
             abilities.pps == 0,
         "PTP_CLOCK_GETCAPS");
  ptp_sys_offset_extended extended{};
  extended.n_samples = 3;
  expect(ioctl(fd, PTP_SYS_OFFSET_EXTENDED, &extended) == 0 &&
             is_between(extended.ts[2][0], extended.ts[2][2]) &&
             is_between(extended.ts[0][1], extended.ts[1][1]),
         "PTP_SYS_OFFSET_EXTENDED");
  ptp_sys_offset offset{};
  offset.n_samples = 2;
  expect(ioctl(fd, PTP_SYS_OFFSET, &offset) == 0 && is_between(offset.ts[0], offset.ts[2]) &&
             is_between(offset.ts[1], offset.ts[3]) && is_between(offset.ts[2], offset.ts[4]),
         "PTP_SYS_OFFSET");
  extended.n_samples = PTP_MAX_SAMPLES + 1;
  expect_error(ioctl(fd, PTP_SYS_OFFSET_EXTENDED, &extended), EINVAL, "too many samples");
  ptp_sys_offset_precise precise{};
  expect_error(ioctl(fd, PTP_SYS_OFFSET_PRECISE, &precise), EOPNOTSUPP, "no cross stamps");
  close(fd);
}

void switch_stamps_on() {
  const int fd = udp();
  ifreq card{};
  std::strcpy(card.ifr_name, "eth0");
  ethtool_ts_info info{};
  info.cmd = ETHTOOL_GET_TS_INFO;
  card.ifr_data = reinterpret_cast<char*>(&info);
  expect(ioctl(fd, SIOCETHTOOL, &card) == 0 && info.phc_index == 0 &&
             (info.so_timestamping & SOF_TIMESTAMPING_RAW_HARDWARE) != 0,
         "the card stamps");
  hwtstamp_config config{};
  card.ifr_data = reinterpret_cast<char*>(&config);
  expect(ioctl(fd, SIOCGHWTSTAMP, &card) == 0 && config.rx_filter == HWTSTAMP_FILTER_NONE,
         "nothing at first");
  config.tx_type = HWTSTAMP_TX_ONESTEP_SYNC;
  expect_error(ioctl(fd, SIOCSHWTSTAMP, &card), ERANGE, "no one-step clock");
  config.tx_type = HWTSTAMP_TX_ON;
  config.rx_filter = HWTSTAMP_FILTER_PTP_V2_EVENT;
  expect(ioctl(fd, SIOCSHWTSTAMP, &card) == 0 && config.rx_filter == HWTSTAMP_FILTER_ALL,
         "SIOCSHWTSTAMP");
  close(fd);
}

struct Stamped {
  ssize_t size = -1;
  std::int64_t software = 0;
  std::int64_t hardware = 0;
  std::uint32_t number = 0;
};

Stamped receive(int fd, int flags) {
  char bytes[200];
  alignas(cmsghdr) char control[512];
  iovec piece{.iov_base = bytes, .iov_len = sizeof bytes};
  msghdr message{};
  message.msg_iov = &piece;
  message.msg_iovlen = 1;
  message.msg_control = control;
  message.msg_controllen = sizeof control;
  Stamped result{.size = recvmsg(fd, &message, flags)};
  for (cmsghdr* each = CMSG_FIRSTHDR(&message); result.size >= 0 && each != nullptr;
       each = CMSG_NXTHDR(&message, each)) {
    if (each->cmsg_level == SOL_SOCKET && each->cmsg_type == SCM_TIMESTAMPING) {
      timespec stamps[3];
      std::memcpy(stamps, CMSG_DATA(each), sizeof stamps);
      result.software = to_ns(stamps[0]);
      result.hardware = to_ns(stamps[2]);
    }
    if (each->cmsg_level == IPPROTO_IP && each->cmsg_type == IP_RECVERR) {
      sock_extended_err error{};
      std::memcpy(&error, CMSG_DATA(each), sizeof error);
      result.number = error.ee_data;
    }
  }
  return result;
}

bool waits_for_stamp(int fd) {
  pollfd interest{.fd = fd, .events = POLLPRI, .revents = 0};
  return poll(&interest, 1, 10) == 1 &&
         (interest.revents & (POLLPRI | POLLERR)) == (POLLPRI | POLLERR);
}

void check_stamps(const char* master) {
  const int clock_fd = open("/dev/ptp0", O_RDWR);
  const clockid_t clock = clock_of(clock_fd);
  const int fd = udp();
  set_number(fd, SOL_SOCKET, SO_SELECT_ERR_QUEUE, 1);
  const int card =
      SOF_TIMESTAMPING_TX_HARDWARE | SOF_TIMESTAMPING_RX_HARDWARE | SOF_TIMESTAMPING_RAW_HARDWARE;
  const int software =
      SOF_TIMESTAMPING_TX_SOFTWARE | SOF_TIMESTAMPING_RX_SOFTWARE | SOF_TIMESTAMPING_SOFTWARE;
  expect(set_number(fd, SOL_SOCKET, SO_TIMESTAMPING, card) == 0, "SO_TIMESTAMPING by the card");
  const std::int64_t before = read_clock(clock);
  send_text(fd, "echo", address(master, kPort));
  expect(waits_for_stamp(fd), "a wait for the stamp of a departure");
  const Stamped left = receive(fd, MSG_ERRQUEUE);
  expect(left.size > 4 && left.software == 0 && left.hardware > before, "its stamp");
  expect(has_input(fd), "the echo comes");
  const Stamped came = receive(fd, 0);
  expect(came.size == 4 && came.software == 0 && came.hardware > left.hardware &&
             came.hardware < read_clock(clock),
         "stamps lie between the readings");
  expect(set_number(fd, SOL_SOCKET, SO_TIMESTAMPING, card | software) == 0, "both kinds");
  send_text(fd, "echo", address(master, kPort));
  expect(waits_for_stamp(fd) && receive(fd, MSG_ERRQUEUE).hardware != 0, "of which the card's");
  expect_error(receive(fd, MSG_ERRQUEUE).size, EAGAIN, "comes alone");
  expect(has_input(fd), "again");
  const Stamped both = receive(fd, 0);
  expect(both.software != 0 && both.hardware != 0, "an arrival has both");
  set_number(fd, SOL_SOCKET, SO_TIMESTAMPING,
             card | software | SOF_TIMESTAMPING_OPT_TX_SWHW | SOF_TIMESTAMPING_OPT_ID |
                 SOF_TIMESTAMPING_OPT_TSONLY);
  send_text(fd, "one", address("224.0.1.129", kPort));
  send_text(fd, "two", address("224.0.1.129", kPort));
  usleep(1000);
  Stamped stamps[4];
  for (Stamped& each : stamps) each = receive(fd, MSG_ERRQUEUE);
  expect(stamps[0].size == 0 && stamps[0].software != 0 && stamps[0].number == 0,
         "multicasts have stamps without their bytes");
  int by_card = 0;
  for (const Stamped& each : stamps) by_card += each.hardware != 0 ? 1 : 0;
  expect(by_card == 2 && stamps[3].number == 1, "of each kind, with their numbers");
  close(fd);
  close(clock_fd);
}

// Control data may ask for the stamp of one message.
void check_stamp_of_one(const char* master) {
  const int fd = udp();
  set_number(fd, SOL_SOCKET, SO_SELECT_ERR_QUEUE, 1);
  set_number(fd, SOL_SOCKET, SO_TIMESTAMPING, SOF_TIMESTAMPING_RAW_HARDWARE);
  const sockaddr_in to = address(master, kPort);
  send_text(fd, "none", to);
  expect(!waits_for_stamp(fd), "no stamp was asked for");
  alignas(cmsghdr) char control[CMSG_SPACE(sizeof(unsigned))] = {};
  char bytes[] = "one";
  iovec piece{.iov_base = bytes, .iov_len = 3};
  msghdr message{};
  message.msg_name = const_cast<sockaddr_in*>(&to);
  message.msg_namelen = sizeof to;
  message.msg_iov = &piece;
  message.msg_iovlen = 1;
  message.msg_control = control;
  message.msg_controllen = sizeof control;
  cmsghdr* head = CMSG_FIRSTHDR(&message);
  head->cmsg_level = SOL_SOCKET;
  head->cmsg_type = SO_TIMESTAMPING;
  head->cmsg_len = CMSG_LEN(sizeof(unsigned));
  const unsigned flags = SOF_TIMESTAMPING_TX_HARDWARE;
  std::memcpy(CMSG_DATA(head), &flags, sizeof flags);
  expect(sendmsg(fd, &message, 0) == 3, "sendmsg");
  expect(waits_for_stamp(fd) && receive(fd, MSG_ERRQUEUE).hardware != 0,
         "the stamp that a message asks for");
  close(fd);
}

[[noreturn]] void answer() {
  const int fd = udp();
  expect(bind_to(fd, address("0.0.0.0", kPort)) == 0, "bind");
  for (;;) {
    char bytes[1500];
    sockaddr_in from{};
    socklen_t size = sizeof from;
    auto* name = reinterpret_cast<sockaddr*>(&from);
    const ssize_t got = recvfrom(fd, bytes, sizeof bytes, 0, name, &size);
    sendto(fd, bytes, static_cast<std::size_t>(got), 0, name, size);
  }
}

}  // namespace

int main(int count, char** words) {
  if (count > 1 && std::strcmp(words[1], "answer") == 0) answer();
  if (count < 3) return 2;
  check_clock();
  check_requests();
  switch_stamps_on();
  check_stamps(words[2]);
  check_stamp_of_one(words[2]);
  finish();
}
