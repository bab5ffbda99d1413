#include "sim/engine/seed_field.h"

#include <cmath>
#include <limits>

#include "algorithms/ports/assert.h"
#include "sim/engine/random.h"

namespace simbench::sim {

void SeedField::add(const Mutation& mutation) {
  SIMBENCH_ASSERT(mutation.share >= 0 && mutation.share <= 1, "a share is from 0 to 1");
  if (mutation.share == 0) return;
  const std::uint64_t below = mutation.share == 1
                                  ? std::numeric_limits<std::uint64_t>::max()
                                  : static_cast<std::uint64_t>(std::ldexp(mutation.share, 64));
  steps_.push_back({mutation.key, below});
}

// The last mutation that a stream took part in decides.
std::uint64_t SeedField::replaced(std::uint64_t root) const {
  for (auto step = steps_.rbegin(); step != steps_.rend(); ++step) {
    const std::uint64_t hash = SplitMix64::mix(root ^ SplitMix64(step->key)());
    if (hash <= step->below) return SplitMix64::mix(SplitMix64(hash ^ step->key)() + root);
  }
  return root;
}

SeedFieldScope::SeedFieldScope(const SeedField& field) {
  SIMBENCH_ASSERT(active_seed_field == nullptr, "one field at a time");
  active_seed_field = &field;
}

SeedFieldScope::~SeedFieldScope() { active_seed_field = nullptr; }

std::uint64_t RandomStream::replaced(std::uint64_t root) {
  return active_seed_field->replaced(root);
}

}  // namespace simbench::sim
