// Actions at exact instants, in order of time: the waiting room of a relay.
//
// Waits on one timer of the monotonic clock (timerfd, no slack) and polls the clock for the last
// kSpin: a timer wakes its thread some tens of microseconds late, which would add to every latency.
//
// Contract: actions of the same instant run in the order of adding. Bounded: add() refuses beyond
// kMaxWaiting actions or kMaxBytes. The lateness is the time from an action's instant to its start,
// over the newest kSamples actions. One thread; the context must not run after this has gone.
//
//   DelayQueue queue(context);
//   bool taken = queue.add(at, bytes, [](Bytes message) { ... });
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "algorithms/ports/host.h"
#include "hardware/clock/monotonic_time.h"

namespace simbench::hardware {

class DelayQueue {
 public:
  static constexpr std::size_t kMaxWaiting = 16384;
  static constexpr std::size_t kMaxBytes = 64u << 20;
  static constexpr std::size_t kSamples = 65536;
  static constexpr Nanoseconds kSpin = std::chrono::microseconds(60);

  using Action = std::function<void(Bytes)>;

  explicit DelayQueue(boost::asio::io_context& context) : timer_(context) {}
  DelayQueue(const DelayQueue&) = delete;
  DelayQueue& operator=(const DelayQueue&) = delete;

  // Takes the message. False: full, and nothing was taken.
  bool add(MonotonicTime at, Bytes& message, Action action);
  std::size_t waiting() const { return heap_.size(); }
  // Discards all waiting actions and refuses new ones.
  void stop();

  // The q-quantile of the lateness; nothing before the first action.
  std::optional<Nanoseconds> lateness(double q) const;

 private:
  struct Entry {
    MonotonicTime at;
    std::uint64_t number;
    Bytes message;
    Action action;
  };
  static bool later(const Entry& a, const Entry& b) {
    return a.at != b.at ? a.at > b.at : a.number > b.number;
  }
  void arm();
  void run_due();

  boost::asio::steady_timer timer_;
  std::vector<Entry> heap_;
  std::uint64_t next_number_ = 0;
  std::size_t bytes_ = 0;
  std::optional<MonotonicTime> armed_for_;
  std::vector<Nanoseconds> lateness_;  // a ring
  std::uint64_t done_ = 0;
  bool stopped_ = false;
};

}  // namespace simbench::hardware
