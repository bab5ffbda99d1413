// Reference clocks of a host as programs make them for time daemons, and NTP's shared memory.
//
//   time_sources shm UNIT DELAY_MS   a receiver's serial messages, into NTP's segment
//   time_sources sock PATH           the receiver's pulses, into chronyd's socket
//   time_sources write               a segment that another program reads
//   time_sources read
//
// The receiver's pulses are those of /dev/pps0. Its messages would say which second each begins:
// the first is the one nearest to the host's own clock, as a user has set it.
#include <fcntl.h>
#include <linux/pps.h>
#include <sys/ioctl.h>
#include <sys/ipc.h>
#include <sys/shm.h>
#include <sys/time.h>
#include <sys/un.h>

#include <atomic>

#include "tests/programs/promises.h"

namespace {

using promises::expect;
using promises::expect_error;
using promises::finish;
using promises::kSecond;
using promises::read_clock;

constexpr key_t kNtpKey = 0x4e545030;  // "NTP0"

// As NTP's refclock_shm.c and gpsd have it.
struct ShmTime {
  int mode;  // 1: who reads looks whether `count` has changed meanwhile
  volatile int count;
  std::int64_t clock_s;
  int clock_us;
  std::int64_t receive_s;
  int receive_us;
  int leap;
  int precision;
  int samples;
  volatile int valid;
  unsigned clock_ns;
  unsigned receive_ns;
  int reserved[8];
};

// As chrony's refclock_sock.c has it.
struct SockSample {
  timeval at;
  double offset_s;
  int is_pulse;
  int leap;
  int padding;
  int magic;
};

ShmTime& segment(int unit) {
  const int number = shmget(kNtpKey + unit, sizeof(ShmTime), IPC_CREAT | 0600);
  void* const memory = shmat(number, nullptr, 0);
  if (number < 0 || memory == reinterpret_cast<void*>(-1)) std::exit(1);
  return *static_cast<ShmTime*>(memory);
}

// The stamp of a pulse, and the second that it begins.
struct Pulse {
  std::int64_t stamp_ns;
  std::int64_t second;
};

class Receiver {
 public:
  Receiver() : line_(open("/dev/pps0", O_RDWR)) {
    if (line_ < 0) std::exit(1);
  }
  Pulse next() {
    pps_fdata data{};
    data.timeout.flags = PPS_TIME_INVALID;
    while (ioctl(line_, PPS_FETCH, &data) != 0) {
    }
    const std::int64_t stamp = data.info.assert_tu.sec * kSecond + data.info.assert_tu.nsec;
    if (first_ == 0) first_ = (stamp + kSecond / 2) / kSecond - data.info.assert_sequence;
    return {stamp, first_ + data.info.assert_sequence};
  }

 private:
  int line_;
  std::int64_t first_ = 0;
};

// The message ends so long after its pulse.
[[noreturn]] void feed_memory(int unit, int delay_ms) {
  ShmTime& memory = segment(unit);
  memory.mode = 1;
  for (Receiver receiver;;) {
    const Pulse pulse = receiver.next();
    usleep(static_cast<useconds_t>(delay_ms) * 1000);
    const std::int64_t now = read_clock(CLOCK_REALTIME);
    memory.valid = 0;
    memory.count = memory.count + 1;
    std::atomic_thread_fence(std::memory_order_seq_cst);
    memory.clock_s = pulse.second;
    memory.clock_us = 0;
    memory.clock_ns = 0;
    memory.receive_s = now / kSecond;
    memory.receive_us = static_cast<int>(now % kSecond / 1000);
    memory.receive_ns = static_cast<unsigned>(now % kSecond);
    memory.precision = -10;
    std::atomic_thread_fence(std::memory_order_seq_cst);
    memory.count = memory.count + 1;
    memory.valid = 1;
  }
}

[[noreturn]] void feed_socket(const char* path) {
  constexpr int kMagic = 0x534f434b;
  sockaddr_un name{};
  name.sun_family = AF_UNIX;
  std::strncpy(name.sun_path, path, sizeof name.sun_path - 1);
  const int fd = socket(AF_UNIX, SOCK_DGRAM, 0);
  for (Receiver receiver;;) {
    const Pulse pulse = receiver.next();
    SockSample sample{};
    sample.at = {.tv_sec = pulse.stamp_ns / kSecond, .tv_usec = pulse.stamp_ns % kSecond / 1000};
    sample.offset_s = static_cast<double>(pulse.second * kSecond - pulse.stamp_ns) * 1e-9;
    sample.magic = kMagic;
    sendto(fd, &sample, sizeof sample, 0, reinterpret_cast<sockaddr*>(&name), sizeof name);
  }
}

[[noreturn]] void write_segment() {
  ShmTime& own = segment(2);
  for (int i = 1;; ++i) {
    sleep(1);
    own.clock_s = i;
    own.count = i;
  }
}

[[noreturn]] void read_segment() {
  expect_error(shmget(kNtpKey + 3, sizeof(ShmTime), 0), ENOENT, "a segment that nobody made");
  usleep(500'000);  // the other makes it
  const int number = shmget(kNtpKey + 2, sizeof(ShmTime), 0);
  expect(number >= 0, "shmget of what another program made");
  expect_error(shmget(kNtpKey + 2, sizeof(ShmTime), IPC_CREAT | IPC_EXCL | 0600), EEXIST,
               "IPC_EXCL");
  expect_error(shmget(kNtpKey + 2, 65'536, 0), EINVAL, "a segment is not larger than it was made");
  shmid_ds facts{};
  expect(shmctl(number, IPC_STAT, &facts) == 0 && facts.shm_segsz == sizeof(ShmTime), "IPC_STAT");
  void* const memory = shmat(number, nullptr, SHM_RDONLY);
  const auto& other = *static_cast<const ShmTime*>(memory);
  for (int i = 0; i < 3; ++i) {
    expect(other.count == i && other.clock_s == i, "what the other has written until now");
    sleep(1);
  }
  expect(shmdt(memory) == 0, "shmdt");
  expect_error(shmdt(memory), EINVAL, "shmdt again");
  expect(shmctl(number, IPC_RMID, nullptr) == 0, "IPC_RMID");
  expect_error(shmget(kNtpKey + 2, sizeof(ShmTime), 0), ENOENT, "a segment that is gone");
  finish();
}

}  // namespace

int main(int count, char** words) {
  const char* const what = count > 1 ? words[1] : "";
  if (std::strcmp(what, "shm") == 0 && count > 3)
    feed_memory(std::atoi(words[2]), std::atoi(words[3]));
  if (std::strcmp(what, "sock") == 0 && count > 2) feed_socket(words[2]);
  if (std::strcmp(what, "write") == 0) write_segment();
  if (std::strcmp(what, "read") == 0) read_segment();
  return 2;
}
