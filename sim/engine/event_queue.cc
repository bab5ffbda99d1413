#include "sim/engine/event_queue.h"

namespace simbench::sim {

bool EventQueue::refill() {
  if (ladder_.empty()) return false;
  ladder_.take_run(run_);
  return true;
}

void EventQueue::insert_into_full(std::int64_t time_ns, std::uint64_t payload,
                                  std::uint64_t sequence) {
  make_room();
  insert({.time_ns = time_ns, .payload = payload, .sequence = sequence});
}

// A tournament of its full size spills into the ladder. While a run as long is being popped, which
// would have to go back with it, a larger tournament costs less.
void EventQueue::make_room() {
  if (near_.size() < kNearEntries || near_.size() < run_.size() || !ladder_.has_room()) {
    near_.grow();
    return;
  }
  drain_near(spilled_);
  ladder_.spill(spilled_);
}

void EventQueue::drain_near(std::vector<QueueEntry>& out) {
  near_.drain(out);
  out.insert(out.end(), run_.begin(), run_.end());
  run_.clear();
}

void EventQueue::drain(std::vector<QueueEntry>& out) {
  drain_near(out);
  ladder_.drain(out);
}

}  // namespace simbench::sim
