#include "shim/card.h"

#include <errno.h>
#include <fcntl.h>
#include <linux/ptp_clock.h>
#include <string.h>

#include "shim/link.h"

namespace simbench::shim {
namespace {

ptp_clock_time to_ptp(std::int64_t ns) {
  ptp_clock_time time{};
  time.sec = ns / kSecond;
  time.nsec = static_cast<std::uint32_t>(ns % kSecond);
  return time;
}

CardSample samples[PTP_MAX_SAMPLES];

// False with errno.
bool take_samples(unsigned count) {
  if (count > PTP_MAX_SAMPLES) {
    errno = EINVAL;
    return false;
  }
  return ask_for({.call = Call::kReadCard, .a = count}, samples) >= 0;
}

int read_offset(ptp_sys_offset& offset) {
  if (!take_samples(offset.n_samples)) return -1;
  for (unsigned i = 0; i < offset.n_samples; ++i) {
    offset.ts[2 * i] = to_ptp(samples[i].before);
    offset.ts[2 * i + 1] = to_ptp(samples[i].card);
    offset.ts[2 * i + 2] = to_ptp(samples[i].after);
  }
  return 0;
}

int read_offset(ptp_sys_offset_extended& offset) {
  if (!take_samples(offset.n_samples)) return -1;
  for (unsigned i = 0; i < offset.n_samples; ++i) {
    offset.ts[i][0] = to_ptp(samples[i].before);
    offset.ts[i][1] = to_ptp(samples[i].card);
    offset.ts[i][2] = to_ptp(samples[i].after);
  }
  return 0;
}

}  // namespace

bool is_card(const char* path) {
  return has_world() && strncmp(path, "/dev/ptp", strlen("/dev/ptp")) == 0;
}

int open_card(const char* path, int flags) {
  if (identity().has_card_clock == 0 || strcmp(path, "/dev/ptp0") != 0) return refuse(ENOENT);
  return open_descriptor(Kind::kCard, (flags & O_NONBLOCK) != 0, (flags & O_CLOEXEC) != 0);
}

int card_ioctl(unsigned long what, void* argument) {
  switch (what) {
    case PTP_CLOCK_GETCAPS:
    case PTP_CLOCK_GETCAPS2: {
      auto& capabilities = *static_cast<ptp_clock_caps*>(argument);
      capabilities = {};
      capabilities.max_adj = identity().most_card_rate;
      return 0;
    }
    case PTP_SYS_OFFSET:
    case PTP_SYS_OFFSET2:
      return read_offset(*static_cast<ptp_sys_offset*>(argument));
    case PTP_SYS_OFFSET_EXTENDED:
    case PTP_SYS_OFFSET_EXTENDED2:
      return read_offset(*static_cast<ptp_sys_offset_extended*>(argument));
    case PTP_SYS_OFFSET_PRECISE:
    case PTP_SYS_OFFSET_PRECISE2:
      return refuse(EOPNOTSUPP);
    default:
      return refuse(ENOTTY);
  }
}

bool world_clock(clockid_t clock, std::int64_t& result) {
  constexpr clockid_t kKind = 7;
  constexpr clockid_t kOfDescriptor = 3;
  result = clock;
  if (clock >= 0) return true;
  if ((clock & kKind) != kOfDescriptor) {  // CPU time of a process, or of a thread of it
    constexpr clockid_t kOfThread = 4;
    result = (clock & kOfThread) != 0 ? CLOCK_THREAD_CPUTIME_ID : CLOCK_PROCESS_CPUTIME_ID;
    return true;
  }
  result = kCardClock;
  if (kind_of(~(clock >> 3)) == Kind::kCard) return true;
  errno = EINVAL;
  return false;
}

}  // namespace simbench::shim
