#include "shim/card.h"

#include <errno.h>
#include <linux/ptp_clock.h>
#include <string.h>

#include "shim/link.h"

namespace simbench::shim {
namespace {

ptp_clock_time to_ptp(std::int64_t ns) {
  const timespec split = to_timespec(ns);
  ptp_clock_time time{};
  time.sec = split.tv_sec;
  time.nsec = static_cast<std::uint32_t>(split.tv_nsec);
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

// Each is a channel for external stamps, too.
unsigned pins() { return identity().has_card_clock != 0 && identity().has_pulse_line != 0 ? 1 : 0; }

// The second version of a request has nothing in what is reserved.
template <std::size_t kCount>
bool is_reserved_zero(const unsigned (&reserved)[kCount]) {
  for (const unsigned each : reserved) {
    if (each != 0) return false;
  }
  return true;
}

int request_stamps(int fd, const ptp_extts_request& request, bool is_second) {
  const unsigned flags = request.flags & (is_second ? ~0U : unsigned{PTP_EXTTS_V1_VALID_FLAGS});
  const bool enables = (flags & PTP_ENABLE_FEATURE) != 0;
  if (is_second) {
    const bool has_edge = !enables || (flags & PTP_EXTTS_EDGES) != 0;
    const bool is_known = (flags & ~unsigned{PTP_EXTTS_VALID_FLAGS}) == 0;
    if (!has_edge || !is_known || !is_reserved_zero(request.rsv)) return refuse(EINVAL);
  }
  if (request.index >= pins()) return refuse(EINVAL);
  if (enables && (flags & PTP_FALLING_EDGE) != 0) return refuse(EOPNOTSUPP);
  return ask({.call = Call::kStampPulses, .fd = fd, .a = enables ? 1 : 0}) < 0 ? -1 : 0;
}

int get_pin(int fd, ptp_pin_desc& pin, bool is_second) {
  if ((is_second && !is_reserved_zero(pin.rsv)) || pin.index >= pins()) return refuse(EINVAL);
  const std::int64_t function = ask({.call = Call::kPin, .fd = fd, .a = -1});
  if (function < 0) return -1;
  pin = {};
  strcpy(pin.name, "SDP0");
  pin.func = static_cast<unsigned>(function);
  return 0;
}

int set_pin(int fd, const ptp_pin_desc& pin, bool is_second) {
  if ((is_second && !is_reserved_zero(pin.rsv)) || pin.index >= pins()) return refuse(EINVAL);
  return ask({.call = Call::kPin, .fd = fd, .a = pin.func, .b = pin.chan}) < 0 ? -1 : 0;
}

}  // namespace

int card_ioctl(int fd, unsigned long what, void* argument) {
  if (what == PTP_ENABLE_PPS || what == PTP_ENABLE_PPS2) return refuse(EOPNOTSUPP);
  if (argument == nullptr) return refuse(EFAULT);
  switch (what) {
    case PTP_CLOCK_GETCAPS:
    case PTP_CLOCK_GETCAPS2: {
      auto& capabilities = *static_cast<ptp_clock_caps*>(argument);
      capabilities = {};
      capabilities.max_adj = identity().most_card_rate;
      capabilities.n_ext_ts = static_cast<int>(pins());
      capabilities.n_pins = static_cast<int>(pins());
      return 0;
    }
    case PTP_EXTTS_REQUEST:
    case PTP_EXTTS_REQUEST2:
      return request_stamps(fd, *static_cast<ptp_extts_request*>(argument),
                            what == PTP_EXTTS_REQUEST2);
    case PTP_PIN_GETFUNC:
    case PTP_PIN_GETFUNC2:
      return get_pin(fd, *static_cast<ptp_pin_desc*>(argument), what == PTP_PIN_GETFUNC2);
    case PTP_PIN_SETFUNC:
    case PTP_PIN_SETFUNC2:
      return set_pin(fd, *static_cast<ptp_pin_desc*>(argument), what == PTP_PIN_SETFUNC2);
    case PTP_PEROUT_REQUEST:
    case PTP_PEROUT_REQUEST2:
      return refuse(EINVAL);  // for no channel
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

ssize_t read_card(int fd, void* data, std::size_t size) {
  constexpr std::size_t kMost = 30;  // PTP_BUF_TIMESTAMPS
  if (size % sizeof(ptp_extts_event) != 0) return refuse(EINVAL);
  const std::size_t room = size / sizeof(ptp_extts_event);
  std::int64_t stamps[kMost];
  Received reply{.data = stamps, .capacity = sizeof stamps};
  const Request request{.call = Call::kTakeStamps,
                        .fd = fd,
                        .a = static_cast<std::int64_t>(room < kMost ? room : kMost)};
  while (ask(request, {}, {}, &reply) < 0) {
    if (errno != EAGAIN || !wait_for_input(fd, -1)) return -1;
  }
  const std::size_t count = reply.size / sizeof stamps[0];
  auto* events = static_cast<ptp_extts_event*>(data);
  for (std::size_t i = 0; i < count; ++i) {
    events[i] = {};
    events[i].t = to_ptp(stamps[i]);
  }
  return static_cast<ssize_t>(count * sizeof(ptp_extts_event));
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
