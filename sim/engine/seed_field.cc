#include "sim/engine/seed_field.h"

#include <algorithm>
#include <boost/math/policies/policy.hpp>
#include <boost/math/special_functions/erf.hpp>
#include <boost/random/normal_distribution.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "algorithms/ports/assert.h"
#include "laws/generators.h"
#include "laws/normal_law.h"
#include "sim/engine/normal_process.h"
#include "sim/engine/random.h"

namespace simbench::sim {
namespace {

// The bits of a word that are beyond a double's digits.
constexpr int kLowBits = 11;
constexpr std::uint64_t kLowMask = (std::uint64_t{1} << kLowBits) - 1;
constexpr double kUpperValues = 0x1p53;

// Boost would compute in long double, which takes several times as long.
using InDouble = boost::math::policies::policy<boost::math::policies::promote_double<false>>;

double standard_normal(std::uint64_t state) {
  SplitMix64 words(state);
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
  steps_.push_back({.key = mutation.key,
                    .factor = SplitMix64(mutation.key)() | 1,
                    .most = most,
                    .step = mutation.step,
                    .kept = std::sqrt(1 - mutation.step * mutation.step)});
}

std::uint64_t SeedField::replaced(std::uint64_t word) const {
  // Multiply-shift hashing (Dietzfelbinger and others, Journal of Algorithms 25(1), 1997).
  const auto takes_part = [word](const Step& step) { return word * step.factor <= step.most; };
  const auto fresh = [word](const Step& step) {
    return SplitMix64::mix(SplitMix64(word ^ step.factor)() + step.key);
  };
  std::uint64_t renewed = word;
  // Mutations count from the last one that renewed the word on.
  std::size_t first = steps_.size();
  bool is_moved = false;
  while (first > 0) {
    const Step& step = steps_[first - 1];
    if (takes_part(step)) {
      if (step.step == 1) {
        renewed = fresh(step);
        break;
      }
      is_moved = true;
    }
    --first;
  }
  if (!is_moved) return renewed;
  double quantile = quantile_of_word(renewed);
  for (std::size_t i = first; i < steps_.size(); ++i) {
    const Step& step = steps_[i];
    if (!takes_part(step)) continue;
    quantile = step.kept * quantile + step.step * standard_normal(fresh(step));
  }
  return word_of_quantile(quantile, renewed & kLowMask);
}

SeedFieldScope::SeedFieldScope(const SeedField& field) {
  SIMBENCH_ASSERT(active_seed_field == nullptr, "one field at a time");
  active_seed_field = &field;
}

SeedFieldScope::~SeedFieldScope() { active_seed_field = nullptr; }

std::uint64_t RandomStream::word_in_field(std::uint64_t word) {
  return active_seed_field->replaced(word);
}

double RandomStream::normal_in_field() { return quantile_of_word((*this)()); }

double RandomStream::exponential_in_field() { return -std::log1p(-uniform()); }

}  // namespace simbench::sim
