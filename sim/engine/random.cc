#include "sim/engine/random.h"

#include "algorithms/ports/assert.h"

namespace simbench::sim {

// The high word of draw * n, rejecting the draws that would make some results more likely
// (Lemire, "Fast random integer generation in an interval", ACM TOMACS 29(1), 2019).
std::uint64_t RandomStream::below(std::uint64_t n) {
  __extension__ using Wide = unsigned __int128;
  SIMBENCH_ASSERT(n > 0, "there is no number below 0");
  Wide product = static_cast<Wide>((*this)()) * n;
  if (static_cast<std::uint64_t>(product) < n) {
    const std::uint64_t threshold = (0 - n) % n;
    while (static_cast<std::uint64_t>(product) < threshold) {
      product = static_cast<Wide>((*this)()) * n;
    }
  }
  return static_cast<std::uint64_t>(product >> 64);
}

}  // namespace simbench::sim
