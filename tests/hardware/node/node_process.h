// The real `simbench node` as a process of its own, on 127.0.0.1, with cameras that play a CSV.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>

#include "hardware/clock/monotonic_time.h"

namespace simbench::hardware {

// A rig of one host and three cameras that all play the same frames: number i (from 1 on) is due
// (i - 1) periods after the zero, which the trigger file holds.
class NodeProcess {
 public:
  static constexpr Nanoseconds kPeriod = std::chrono::milliseconds(11);  // as 90.9 fps
  static constexpr std::uint32_t kFrames = 2000;

  // Everything lies in `folder`, which is there.
  explicit NodeProcess(std::filesystem::path folder);
  ~NodeProcess();
  NodeProcess(const NodeProcess&) = delete;
  NodeProcess& operator=(const NodeProcess&) = delete;

  // Returns when it listens; throws std::runtime_error if it does not within 20 s.
  void start();
  // SIGKILL; returns when it is gone, says when the signal was sent.
  MonotonicTime kill();
  void set_trigger(MonotonicTime zero) const;

  std::uint16_t port() const { return port_; }
  pid_t id() const { return process_; }

 private:
  std::filesystem::path folder_;
  std::uint16_t port_;
  pid_t process_ = -1;
};

}  // namespace simbench::hardware
