#include "hardware/net/notice.h"

#include <algorithm>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <utility>

namespace simbench::hardware {
namespace {

// Removes the waiter from the list, also when its coroutine is destroyed.
class Listed {
 public:
  Listed(std::vector<boost::asio::steady_timer*>& waiters, boost::asio::steady_timer& timer)
      : waiters_(waiters), timer_(timer) {
    waiters_.push_back(&timer_);
  }
  ~Listed() { std::erase(waiters_, &timer_); }
  Listed(const Listed&) = delete;
  Listed& operator=(const Listed&) = delete;

 private:
  std::vector<boost::asio::steady_timer*>& waiters_;
  boost::asio::steady_timer& timer_;
};

}  // namespace

Task<void> ended(boost::asio::steady_timer& timer) {
  boost::system::error_code cancelled;
  co_await timer.async_wait(boost::asio::redirect_error(boost::asio::use_awaitable, cancelled));
}

Task<void> pause(boost::asio::any_io_executor executor, Nanoseconds interval) {
  boost::asio::steady_timer timer(executor, interval);
  co_await ended(timer);
}

Task<bool> Notice::wait(MonotonicTime deadline) {
  if (deadline <= monotonic_now()) co_return false;
  boost::asio::steady_timer timer(executor_, for_timer(deadline));
  const Listed listed(waiters_, timer);
  boost::system::error_code ended;
  co_await timer.async_wait(boost::asio::redirect_error(boost::asio::use_awaitable, ended));
  co_return ended || deadline > monotonic_now();
}

void Notice::notify() {
  for (boost::asio::steady_timer* timer : waiters_) timer->cancel();
}

std::size_t Inbox::push(ReceivedMessage message) {
  if (closed_) return 0;
  std::size_t dropped = 0;
  const std::size_t size = message.bytes.size();
  while (!messages_.empty() && (messages_.size() >= kMaxMessages || bytes_ + size > kMaxBytes)) {
    pop();
    ++dropped;
  }
  bytes_ += size;
  messages_.push_back(std::move(message));
  arrived_.notify();
  return dropped;
}

Task<std::optional<ReceivedMessage>> Inbox::next(MonotonicTime deadline) {
  while (messages_.empty()) {
    if (closed_) co_return std::nullopt;
    const bool in_time = co_await arrived_.wait(deadline);
    if (!in_time && messages_.empty()) co_return std::nullopt;
  }
  co_return pop();
}

void Inbox::clear() {
  messages_.clear();
  bytes_ = 0;
}

void Inbox::close() {
  clear();
  closed_ = true;
  arrived_.notify();
}

ReceivedMessage Inbox::pop() {
  ReceivedMessage message = std::move(messages_.front());
  messages_.pop_front();
  bytes_ -= message.bytes.size();
  return message;
}

}  // namespace simbench::hardware
