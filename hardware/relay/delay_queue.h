// Things to be done at exact instants, in order of time: the waiting room of a relay.
//
// Waits on one timer of the monotonic clock (timerfd, no slack) and, for the last
// kSpin, by looking at the clock: a timer wakes its thread some tens of microseconds late, which
// would be added to every latency.
//
// Contract: what is due at the same instant is done in the order of adding. Bounded: beyond
// kMaxWaiting things or kMaxBytes add() refuses, and the caller loses the message or stops reading.
// Lateness: how long after its instant each was begun, the newest kSamples of them.
// One thread; the context must not run after this has gone.
//
//   DelayQueue queue(context);
//   bool taken = queue.add(at, bytes, [](Bytes message) { ... });
#ifndef SIMBENCH_HARDWARE_RELAY_DELAY_QUEUE_H_
#define SIMBENCH_HARDWARE_RELAY_DELAY_QUEUE_H_

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

  // False: full, and nothing was taken.
  bool add(MonotonicTime at, Bytes message, Action action);
  std::size_t waiting() const { return heap_.size(); }
  // Forgets what waits; nothing more happens.
  void stop();

  // The q-quantile of the lateness, if anything was done yet.
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

#endif  // SIMBENCH_HARDWARE_RELAY_DELAY_QUEUE_H_
