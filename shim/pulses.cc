#include "shim/pulses.h"

#include <errno.h>
#include <linux/pps.h>
#include <poll.h>
#include <time.h>

#include "shim/link.h"
#include "shim/waiting.h"

namespace simbench::shim {
namespace {

// Below 0: for ever.
std::int64_t timeout_of(const pps_ktime& timeout) {
  if ((timeout.flags & PPS_TIME_INVALID) != 0 || timeout.sec < 0 || timeout.nsec < 0) return -1;
  return nanoseconds({.tv_sec = timeout.sec, .tv_nsec = timeout.nsec});
}

bool wait_for_pulse(int fd, std::int64_t timeout_ns) {
  pollfd interest{.fd = fd, .events = POLLIN, .revents = 0};
  Until until = timeout_ns < 0 ? Until{} : Until{Deadline::kAfter, timeout_ns};
  const int ready = wait(&interest, 1, until);
  if (ready == 0) errno = ETIMEDOUT;
  return ready > 0;
}

int fetch(int fd, pps_fdata& fetched) {
  // From now on a pulse makes the descriptor ready.
  if (ask_for({.call = Call::kFetchPulse, .fd = fd}, fetched.info) < 0) return -1;
  const std::int64_t timeout_ns = timeout_of(fetched.timeout);
  if (timeout_ns == 0) return 0;
  if (!wait_for_pulse(fd, timeout_ns)) return -1;
  return ask_for({.call = Call::kFetchPulse, .fd = fd}, fetched.info) < 0 ? -1 : 0;
}

int get_abilities(int fd, int& abilities) {
  pps_kparams parameters{};
  const std::int64_t able = ask_for({.call = Call::kPulseParameters, .fd = fd}, parameters);
  if (able < 0) return -1;
  abilities = static_cast<int>(able);
  return 0;
}

// What they have become is for who asks.
int set_parameters(int fd, const pps_kparams& wanted) {
  return ask({.call = Call::kPulseParameters, .fd = fd}, {&wanted, sizeof wanted}) < 0 ? -1 : 0;
}

}  // namespace

int pulse_ioctl(int fd, unsigned long what, void* argument) {
  if (argument == nullptr) return refuse(EFAULT);
  switch (what) {
    case PPS_GETCAP:
      return get_abilities(fd, *static_cast<int*>(argument));
    case PPS_GETPARAMS:
      return ask_for({.call = Call::kPulseParameters, .fd = fd},
                     *static_cast<pps_kparams*>(argument)) < 0
                 ? -1
                 : 0;
    case PPS_SETPARAMS:
      return set_parameters(fd, *static_cast<pps_kparams*>(argument));
    case PPS_FETCH:
      return fetch(fd, *static_cast<pps_fdata*>(argument));
    case PPS_KC_BIND:
      return refuse(EOPNOTSUPP);
    default:
      return refuse(ENOTTY);
  }
}

}  // namespace simbench::shim
