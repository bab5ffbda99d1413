#include "sim/engine/tournament.h"

#include <algorithm>

#include "algorithms/ports/assert.h"

namespace simbench::sim {

void Tournament::grow() {
  close();
  const std::size_t old = capacity_;
  capacity_ = std::max(kFewPlaces, 2 * old);
  SIMBENCH_ASSERT(capacity_ <= std::size_t{1} << kPlaceBits, "too many events at one time");
  nodes_.resize(2 * capacity_, nobody());
  payloads_.resize(capacity_);
  free_.resize(capacity_);
  const auto places = nodes_.begin() + static_cast<std::ptrdiff_t>(capacity_);
  const auto first = nodes_.begin() + static_cast<std::ptrdiff_t>(old);
  std::fill(std::copy_n(first, old, places), nodes_.end(), nobody());
  for (std::size_t at = capacity_ - 1; at > 0; --at) {
    nodes_[at] = std::min(nodes_[2 * at], nodes_[2 * at + 1]);
  }
  for (std::size_t place = capacity_; place > old;) {
    free_[free_count_++] = static_cast<std::uint32_t>(--place);
  }
}

void Tournament::drain(std::vector<QueueEntry>& out) {
  close();
  for (std::size_t place = 0; place < capacity_; ++place) {
    const QueueKey node = nodes_[capacity_ + place];
    if (node != nobody()) out.push_back(entry_of(node));
  }
  nodes_.clear();
  capacity_ = free_count_ = 0;
}

}  // namespace simbench::sim
