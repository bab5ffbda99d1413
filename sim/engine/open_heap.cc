#include "sim/engine/open_heap.h"

#include <algorithm>

namespace simbench::sim {

void OpenHeap::drain(std::vector<QueueEntry>& out) {
  const auto first = places_.begin() + (root_is_open_ ? 1 : 0);
  const auto last = places_.begin() + static_cast<std::ptrdiff_t>(used_);
  out.insert(out.end(), first, last);
  std::fill(places_.begin(), last, last_of_all());
  used_ = 0;
  root_is_open_ = false;
}

void OpenHeap::grow() {
  capacity_ = std::max(kFirstCapacity, 2 * capacity_);
  places_.resize(capacity_ + kChildren, last_of_all());
}

}  // namespace simbench::sim
