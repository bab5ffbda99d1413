#include "hardware/net/inbox.h"

#include <utility>

#include "hardware/net/peer_network.h"

namespace simbench::hardware {

std::size_t Inbox::push(ReceivedMessage message) {
  if (closed_) return 0;
  std::size_t dropped = 0;
  const std::size_t size = message.bytes.size();
  while (!messages_.empty() &&
         (messages_.size() >= PeerNetwork::kChannelQueue || bytes_ + size > kMaxBytes)) {
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
