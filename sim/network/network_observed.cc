// What the network tells a WorldObserver of its messages; the rest of it is in network.cc.
#include "sim/network/network.h"

namespace simbench::sim {

// The segment's messages arrive then, or never.
void Network::tell(const Segment& segment, std::optional<TrueTime> arrival) const {
  if (observer_ == nullptr) return;
  const Path& path = paths_[segment.path];
  MessageId id = segment.first;
  for (const Bytes& message : segment.messages) {
    observer_->on_message({.from = path.from,
                           .to = path.to,
                           .stream = path.transport == Transport::kStream,
                           .id = id++,
                           .bytes = message.size(),
                           .left = segment.left,
                           .arrived = arrival.value_or(TrueTime{}),
                           .lost = !arrival});
  }
}

}  // namespace simbench::sim
