// Sets of epoll(): the world keeps what they watch of its own, the kernel what they watch of real
// descriptors, with the rules of epoll(7) on both sides. A set that watches another watches it on
// both sides.
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/epoll.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include "shim/link.h"
#include "shim/refused_calls.h"
#include "shim/waiting.h"

namespace simbench::shim {
namespace {

constexpr int kMostEvents = 1024;

bool is_open_descriptor(int fd) { return machine_call(SYS_fcntl, fd, F_GETFD) >= 0; }

// Fails as the kernel does for what is no set.
bool is_set(int epoll) {
  if (kind_of(epoll) == Kind::kEpoll) return true;
  errno = is_open_descriptor(epoll) ? EINVAL : EBADF;
  return false;
}

// The world's first; a set within a set may be ready on both sides, and is one event.
int take_events(int epoll, epoll_event* events, int most) {
  static EpollItem items[kMostEvents];
  if (most > kMostEvents) most = kMostEvents;
  Received reply{.data = items, .capacity = sizeof items};
  if (ask({.call = Call::kTakeEvents, .fd = epoll, .a = most}, {}, {}, &reply) < 0) return -1;
  const int taken = static_cast<int>(reply.size / sizeof items[0]);
  for (int i = 0; i < taken; ++i) {
    events[i].events = items[i].events;
    events[i].data.u64 = items[i].data;
  }
  if (taken == most) return taken;
  const long real =
      machine_call(SYS_epoll_pwait, epoll, events + taken, most - taken, 0, nullptr, 0);
  int count = taken;
  for (int i = taken; i < taken + real; ++i) {
    bool is_known = false;
    for (int j = 0; j < taken; ++j) {
      if (kind_of(items[j].fd) != Kind::kEpoll || events[j].data.u64 != events[i].data.u64)
        continue;
      events[j].events |= events[i].events;
      is_known = true;
    }
    if (!is_known) events[count++] = events[i];
  }
  return count;
}

int wait_for_events(int epoll, epoll_event* events, int most, Until until, const sigset_t* mask) {
  if (!is_set(epoll)) return -1;
  if (most <= 0) return refuse(EINVAL);
  const Mask during(mask);
  if (during.has_handled()) return refuse(EINTR);
  for (;;) {
    pollfd interest{.fd = epoll, .events = POLLIN, .revents = 0};
    const int ready = wait(&interest, 1, until);
    if (ready < 0) return -1;
    const int taken = take_events(epoll, events, most);
    if (taken != 0 || ready == 0) return taken;
  }
}

}  // namespace

SIMBENCH_CALL int epoll_create1(int flags) {
  if (!is_simulated()) return SIMBENCH_REAL(epoll_create1)(flags);
  if ((flags & ~EPOLL_CLOEXEC) != 0) return refuse(EINVAL);
  const int fd = open_descriptor(Kind::kEpoll, false, (flags & EPOLL_CLOEXEC) != 0);
  if (fd >= 0 && ask({.call = Call::kOpenEpoll, .fd = fd}) < 0) {
    discard_descriptor(fd);
    return -1;
  }
  return fd;
}

SIMBENCH_CALL int epoll_create(int size) {
  if (!is_simulated()) return SIMBENCH_REAL(epoll_create)(size);
  return size <= 0 ? refuse(EINVAL) : epoll_create1(0);
}

SIMBENCH_CALL int epoll_ctl(int epoll, int operation, int fd, epoll_event* event) {
  if (!is_simulated()) return SIMBENCH_REAL(epoll_ctl)(epoll, operation, fd, event);
  if (!is_open_descriptor(epoll) || !is_open_descriptor(fd)) return refuse(EBADF);
  const Kind kind = kind_of(fd);
  if (!is_set(epoll) || epoll == fd) {
    // What cannot be waited for has an error of its own, which comes first.
    return is_of_the_world(kind)
               ? refuse(EINVAL)
               : static_cast<int>(machine_call(SYS_epoll_ctl, epoll, operation, fd, event));
  }
  if (!is_of_the_world(kind) || kind == Kind::kEpoll) {
    if (machine_call(SYS_epoll_ctl, epoll, operation, fd, event) < 0) return -1;
    if (kind != Kind::kEpoll) return 0;
  }
  EpollItem item{.number = number_of(fd), .fd = fd};
  if (event != nullptr && operation != EPOLL_CTL_DEL) {
    item.events = event->events;
    item.data = event->data.u64;
  }
  return static_cast<int>(
      ask({.call = Call::kControlEpoll, .fd = epoll, .a = operation}, {&item, sizeof item}));
}

SIMBENCH_CALL int epoll_pwait(int epoll, epoll_event* events, int most, int timeout_ms,
                              const sigset_t* mask) {
  if (!is_simulated()) return SIMBENCH_REAL(epoll_pwait)(epoll, events, most, timeout_ms, mask);
  return wait_for_events(epoll, events, most, after_ms(timeout_ms), mask);
}

SIMBENCH_CALL int epoll_wait(int epoll, epoll_event* events, int most, int timeout_ms) {
  if (!is_simulated()) return SIMBENCH_REAL(epoll_wait)(epoll, events, most, timeout_ms);
  return wait_for_events(epoll, events, most, after_ms(timeout_ms), nullptr);
}

SIMBENCH_CALL int epoll_pwait2(int epoll, epoll_event* events, int most, const timespec* timeout,
                               const sigset_t* mask) {
  if (!is_simulated()) return SIMBENCH_REAL(epoll_pwait2)(epoll, events, most, timeout, mask);
  if (timeout != nullptr && !is_time(*timeout)) return refuse(EINVAL);
  const Until until = timeout == nullptr ? Until{} : Until{Deadline::kAfter, nanoseconds(*timeout)};
  return wait_for_events(epoll, events, most, until, mask);
}

}  // namespace simbench::shim
