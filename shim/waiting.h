// Waits of other calls than those that are made for it.
//
//   pollfd interest{.fd = 7, .events = POLLIN, .revents = 0};
//   if (wait_for_ready(7, POLLIN, -1)) print("data");
//   if (!wait_for_activity(false)) print("a signal");
#pragma once

#include <poll.h>
#include <signal.h>

#include <cstdint>

#include "shim/protocol.h"

namespace simbench::shim {

struct Until {
  Deadline kind = Deadline::kNever;
  std::int64_t ns = 0;
};

// Below 0: for ever.
Until after_ms(int timeout_ms);

// The signal mask of ppoll() and its kin, while they wait; null: it stays.
class Mask {
 public:
  explicit Mask(const sigset_t* wanted);
  ~Mask();
  Mask(const Mask&) = delete;
  Mask& operator=(const Mask&) = delete;
  // Whether it let a signal through that had waited.
  bool has_handled() const { return has_handled_; }

 private:
  bool is_set_;
  bool has_handled_ = false;
  sigset_t before_{};
};

// As poll(): which of the descriptors are ready, at the latest then. What is left of the time goes
// to `until` and `left_ns`.
int wait(pollfd* interests, nfds_t count, Until& until, std::int64_t* left_ns = nullptr);

// Waits until the descriptor is ready for one of these events of poll(); a timeout below 0: for
// ever. False with errno: EAGAIN at the timeout, EINTR after a handler, unless that says SA_RESTART
// and there is no timeout (signal(7)).
bool wait_for_ready(int fd, short events, std::int64_t timeout_ns);
// Waits until another thread of the host has done something to what is real: descriptors, files,
// processes. False with EINTR, as above. `has_only_looked`: since it did so before.
bool wait_for_activity(bool has_only_looked);

}  // namespace simbench::shim
