#include "sim/engine/event_queue.h"

namespace simbench::sim {

bool EventQueue::refill() {
  if (ladder_.empty()) return false;
  ladder_.take_run(run_);
  return true;
}

void EventQueue::spill() {
  if (!ladder_.has_room()) return;
  drain_near(spilled_);
  ladder_.spill(spilled_);
}

void EventQueue::drain_near(std::vector<QueueEntry>& out) {
  heap_.drain(out);
  out.insert(out.end(), run_.begin(), run_.end());
  run_.clear();
}

void EventQueue::drain(std::vector<QueueEntry>& out) {
  drain_near(out);
  ladder_.drain(out);
}

}  // namespace simbench::sim
