#include "sim/engine/seed_field.h"

#include <algorithm>
#include <boost/math/policies/policy.hpp>
#include <boost/math/special_functions/erf.hpp>
#include <boost/random/normal_distribution.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "algorithms/ports/assert.h"
#include "sim/engine/normal_process.h"
#include "sim/engine/random.h"

namespace simbench::sim {
namespace {

// Of a word: choose a layer of a ziggurat, and are beyond a double's digits.
constexpr int kLowBits = 11;
constexpr std::uint64_t kLowMask = (std::uint64_t{1} << kLowBits) - 1;
constexpr double kUpperValues = 0x1p53;

// Boost would compute in long double, which takes several times as long.
using InDouble = boost::math::policies::policy<boost::math::policies::promote_double<false>>;

// A generator for Boost's distributions that is no RandomStream: those ask the field.
class MutationWords {
 public:
  using result_type = std::uint64_t;
  explicit MutationWords(std::uint64_t state) : words_(state) {}
  static constexpr result_type min() { return 0; }
  static constexpr result_type max() { return std::numeric_limits<result_type>::max(); }
  result_type operator()() { return words_(); }

 private:
  SplitMix64 words_;
};

double standard_normal(std::uint64_t state) {
  MutationWords words(state);
  return boost::random::normal_distribution<double>(0.0, 1.0)(words);
}

// The normal quantile of the upper bits of a word, and back.
double quantile_of_word(std::uint64_t word) {
  const double share = (static_cast<double>(word >> kLowBits) + 0.5) / kUpperValues;
  return -std::numbers::sqrt2 * boost::math::erfc_inv(2 * share, InDouble());
}

std::uint64_t word_of_quantile(double quantile, std::uint64_t low_bits) {
  const double share = normal_probability(quantile);
  const double upper = std::clamp(std::floor(share * kUpperValues), 0.0, kUpperValues - 1);
  return (static_cast<std::uint64_t>(upper) << kLowBits) | low_bits;
}

}  // namespace

void SeedField::add(const Mutation& mutation) {
  SIMBENCH_ASSERT(mutation.share >= 0 && mutation.share <= 1, "a share is from 0 to 1");
  SIMBENCH_ASSERT(mutation.step > 0 && mutation.step <= 1, "a step is up to 1");
  if (mutation.share == 0) return;
  const std::uint64_t most = mutation.share == 1
                                 ? std::numeric_limits<std::uint64_t>::max()
                                 : static_cast<std::uint64_t>(std::ldexp(mutation.share, 64));
  steps_.push_back({mutation.key, SplitMix64(mutation.key)(), most, mutation.step});
}

StreamOrigin SeedField::origin(std::uint64_t root) const {
  const auto hash_in = [root](const Step& step) { return SplitMix64::mix(root ^ step.salt); };
  const auto fresh = [root](const Step& step, std::uint64_t hash) {
    return SplitMix64::mix(SplitMix64(hash ^ step.key)() + root);
  };
  StreamOrigin origin{.root = root};
  // From the last mutation that renewed the stream on.
  std::size_t first = steps_.size();
  bool is_moved = false;
  while (first > 0) {
    const Step& step = steps_[first - 1];
    const std::uint64_t hash = hash_in(step);
    if (hash <= step.most) {
      if (step.step == 1) {
        origin.root = fresh(step, hash);
        break;
      }
      is_moved = true;
    }
    --first;
  }
  if (!is_moved) return origin;
  const std::uint64_t word = Xoshiro256PlusPlus(RandomStream::plain_state(origin.root))();
  double quantile = quantile_of_word(word);
  for (std::size_t i = first; i < steps_.size(); ++i) {
    const Step& step = steps_[i];
    const std::uint64_t hash = hash_in(step);
    if (hash > step.most) continue;
    quantile = std::sqrt(1 - step.step * step.step) * quantile +
               step.step * standard_normal(fresh(step, hash));
  }
  origin.shift = word_of_quantile(quantile, word & kLowMask) - word;
  return origin;
}

SeedFieldScope::SeedFieldScope(const SeedField& field) {
  SIMBENCH_ASSERT(active_seed_field == nullptr, "one field at a time");
  active_seed_field = &field;
}

SeedFieldScope::~SeedFieldScope() { active_seed_field = nullptr; }

// The first output is rotl(s0 + s3, 23) + s0: it is greater by `shift` while s0 + s3 stays.
Xoshiro256PlusPlus::State RandomStream::expand_in_field(std::uint64_t root) {
  const StreamOrigin origin = active_seed_field->origin(root);
  Xoshiro256PlusPlus::State state = plain_state(origin.root);
  state[0] += origin.shift;
  state[3] -= origin.shift;
  return state;
}

}  // namespace simbench::sim
