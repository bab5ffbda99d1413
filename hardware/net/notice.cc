#include "hardware/net/notice.h"

#include <algorithm>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/use_awaitable.hpp>

namespace simbench::hardware {
namespace {

// Takes the waiter from the list also when its coroutine is destroyed.
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

}  // namespace simbench::hardware
