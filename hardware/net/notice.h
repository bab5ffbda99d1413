// Something that coroutines wait for: any number of them, each with its own deadline.
//
// A waiter looks at what it waits for, waits, and looks again; notify() wakes all that wait.
// One thread. It must outlive its waiters, so it lives in the shared state that they hold.
//
//   while (queue.empty()) {
//     if (!co_await notice.wait(deadline)) co_return std::nullopt;
//   }
#ifndef SIMBENCH_HARDWARE_NET_NOTICE_H_
#define SIMBENCH_HARDWARE_NET_NOTICE_H_

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/steady_timer.hpp>
#include <vector>

#include "algorithms/ports/host.h"
#include "hardware/clock/monotonic_time.h"

namespace simbench::hardware {

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

}  // namespace simbench::hardware

#endif  // SIMBENCH_HARDWARE_NET_NOTICE_H_
