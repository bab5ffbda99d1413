// The median of the last N values: linuxptp's delay filter (N = 10).
//
// For an even count it is the mean of the middle two, rounded towards zero.
// Complexity: O(N) a value. Source: docs/reference/host_sync.md section 1 (linuxptp).
//
//   MovingMedian median(10);
//   Nanoseconds delay = median.add(measured);
#ifndef SIMBENCH_ALGORITHMS_HOST_SYNC_PTP_MOVING_MEDIAN_H_
#define SIMBENCH_ALGORITHMS_HOST_SYNC_PTP_MOVING_MEDIAN_H_

#include <algorithm>
#include <cstddef>
#include <deque>
#include <vector>

#include "algorithms/ports/time.h"

namespace simbench {

class MovingMedian {
 public:
  // `length` of at least 1.
  explicit MovingMedian(std::size_t length) : length_(length) {}

  Nanoseconds add(Nanoseconds value) {
    values_.push_back(value);
    if (values_.size() > length_) values_.pop_front();
    std::vector<Nanoseconds> sorted(values_.begin(), values_.end());
    std::sort(sorted.begin(), sorted.end());
    const std::size_t middle = sorted.size() / 2;
    if (sorted.size() % 2 == 1) return sorted[middle];
    return (sorted[middle - 1] + sorted[middle]) / 2;
  }
  void clear() { values_.clear(); }

 private:
  std::size_t length_;
  std::deque<Nanoseconds> values_;
};

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_HOST_SYNC_PTP_MOVING_MEDIAN_H_
