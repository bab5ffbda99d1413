#include "sim/host/reader_queue.h"

#include <algorithm>

namespace simbench::sim {

ReaderQueue::ReaderQueue(const scenarios::FrameReader& reader)
    : busy_(from_ms(reader.frame_ms)),
      most_(static_cast<std::size_t>(reader.queue_frames)),
      drops_oldest_(reader.full_queue == scenarios::FullQueue::kDropsOldest),
      passed_every_(reader.passed_every) {}

void ReaderQueue::read_before(TrueTime before, std::vector<Outcome>& outcomes) {
  while (!waiting_.empty()) {
    const Waiting next = waiting_.front();
    const TrueTime at = std::max(free_at_, next.since);
    if (at >= before) return;
    waiting_.pop_front();
    free_at_ = at + busy_;
    const bool is_passed = taken_++ % passed_every_ == 0;
    outcomes.push_back({.frame = next.frame,
                        .at = at,
                        .fate = is_passed ? FrameFate::kDelivered : FrameFate::kNotPassed});
  }
}

void ReaderQueue::arrive(std::uint32_t frame, TrueTime at, std::vector<Outcome>& outcomes) {
  // A frame that is taken at this very instant makes room.
  read_before(at + Nanoseconds(1), outcomes);
  if (waiting_.size() == most_) {
    const std::uint32_t dropped = drops_oldest_ ? waiting_.front().frame : frame;
    outcomes.push_back({.frame = dropped, .at = at, .fate = FrameFate::kLostInQueue});
    if (!drops_oldest_) return;
    waiting_.pop_front();
  }
  waiting_.push_back({.frame = frame, .since = at});
}

}  // namespace simbench::sim
