// The messages that wait in a channel: bounded in number and in bytes, the oldest goes first.
#ifndef SIMBENCH_HARDWARE_NET_INBOX_H_
#define SIMBENCH_HARDWARE_NET_INBOX_H_

#include <boost/asio/any_io_executor.hpp>
#include <deque>
#include <optional>

#include "algorithms/ports/host.h"
#include "hardware/net/notice.h"

namespace simbench::hardware {

class Inbox {
 public:
  static constexpr std::size_t kMaxBytes = 4u << 20;

  explicit Inbox(boost::asio::any_io_executor executor) : arrived_(std::move(executor)) {}

  // How many messages had to go for it.
  std::size_t push(ReceivedMessage message);
  // The next one; nothing at the deadline or when it was closed. The caller keeps this alive.
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

#endif  // SIMBENCH_HARDWARE_NET_INBOX_H_
