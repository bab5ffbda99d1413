// What coroutines wait for: a pause, a notice that something has changed, an inbox of messages.
//
// Notice: any number of coroutines wait, each with its own deadline. A waiter checks its condition,
// waits, and checks again; notify() wakes all. Inbox: the messages that wait in a channel, bounded
// in number and in bytes; the oldest is dropped first.
//
// One thread. Both must outlive their waiters, so they live in the shared state that those hold.
//
//   while (messages.empty()) {
//     if (!co_await notice.wait(deadline)) co_return std::nullopt;
//   }
#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/steady_timer.hpp>
#include <deque>
#include <optional>
#include <vector>

#include "algorithms/ports/host.h"
#include "hardware/clock/monotonic_time.h"

namespace simbench::hardware {

// Returns when the timer has expired or was cancelled.
Task<void> ended(boost::asio::steady_timer& timer);
// Waits for this long.
Task<void> pause(boost::asio::any_io_executor executor, Nanoseconds interval);

class Notice {
 public:
  explicit Notice(boost::asio::any_io_executor executor) : executor_(std::move(executor)) {}
  Notice(const Notice&) = delete;
  Notice& operator=(const Notice&) = delete;

  // False once the deadline has passed.
  Task<bool> wait(MonotonicTime deadline);
  void notify();

 private:
  boost::asio::any_io_executor executor_;
  std::vector<boost::asio::steady_timer*> waiters_;
};

class Inbox {
 public:
  static constexpr std::size_t kMaxMessages = 1024;
  static constexpr std::size_t kMaxBytes = 4u << 20;

  explicit Inbox(boost::asio::any_io_executor executor) : arrived_(std::move(executor)) {}

  // Returns how many messages were dropped for it.
  std::size_t push(ReceivedMessage message);
  // The next message; nothing at the deadline or after close(). The caller keeps this alive.
  Task<std::optional<ReceivedMessage>> next(MonotonicTime deadline);
  void clear();
  void close();

 private:
  ReceivedMessage pop();

  std::deque<ReceivedMessage> messages_;
  std::size_t bytes_ = 0;
  bool closed_ = false;
  Notice arrived_;
};

}  // namespace simbench::hardware
