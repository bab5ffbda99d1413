#include "sim/network/nagle.h"

#include <algorithm>
#include <utility>

namespace simbench::sim {
namespace {

// Ethernet's 1500 bytes less the headers of IP and TCP.
constexpr double kFullSegmentBytes = 1460;

}  // namespace

std::optional<Segment> Nagle::add(PathId path, MessageId id, Bytes message) {
  if (waiting_.messages.empty()) waiting_ = {.path = path, .first = id};
  waiting_.bytes += static_cast<double>(message.size());
  waiting_.messages.push_back(std::move(message));
  if (acknowledged_ != sent_ && waiting_.bytes < kFullSegmentBytes) return std::nullopt;
  return std::exchange(waiting_, {});
}

std::optional<Segment> Nagle::on_ack() {
  acknowledged_ = acks_on_the_way_.front();
  acks_on_the_way_.pop_front();
  if (acknowledged_ != sent_ || waiting_.messages.empty()) return std::nullopt;
  return std::exchange(waiting_, {});
}

std::optional<TrueTime> Nagle::on_arrival(TrueTime now) {
  ++delivered_;
  if (owes_ack_ || ack_delay_.count() == 0) return std::nullopt;
  owes_ack_ = true;
  ack_due_ = now + ack_delay_;
  return ack_due_;
}

std::uint64_t Nagle::acknowledge() {
  owes_ack_ = false;
  acks_on_the_way_.push_back(delivered_);
  return acks_++;
}

TrueTime Nagle::ack_in_order(TrueTime at) {
  last_ack_ = std::max(last_ack_, at);
  return last_ack_;
}

}  // namespace simbench::sim
