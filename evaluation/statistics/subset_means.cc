#include "evaluation/statistics/subset_means.h"

#include <algorithm>
#include <array>
#include <bit>
#include <boost/random/mersenne_twister.hpp>
#include <cmath>
#include <cstdint>

#include "algorithms/ports/assert.h"

namespace simbench::evaluation {
namespace {

constexpr std::uint64_t kSubsetSeed = 20'151'104;  // arbitrary, but always the same
constexpr std::size_t kBlock = 8;                  // pairs whose sums are tabulated together
constexpr std::size_t kBlockSubsets = std::size_t{1} << kBlock;

// The sums over every subset of up to eight pairs.
struct BlockSums {
  std::array<double, kBlockSubsets> a{};
  std::array<double, kBlockSubsets> difference{};
};

std::vector<BlockSums> block_sums(const std::vector<Pair>& pairs) {
  std::vector<BlockSums> blocks((pairs.size() + kBlock - 1) / kBlock);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    BlockSums& block = blocks[i / kBlock];
    const std::size_t bit = std::size_t{1} << (i % kBlock);
    for (std::size_t below = 0; below < bit; ++below) {
      block.a[bit | below] = block.a[below] + pairs[i].a;
      block.difference[bit | below] = block.difference[below] + (pairs[i].b - pairs[i].a);
    }
  }
  return blocks;
}

// Subsets of n pairs as masks of 64 pairs each: all of them one after the other, or drawn.
class SubsetMasks {
 public:
  SubsetMasks(std::size_t pairs, bool all) : masks_((pairs + 63) / 64), all_(all) {
    if (pairs % 64 != 0) last_ = (std::uint64_t{1} << (pairs % 64)) - 1;
  }

  // Never empty.
  const std::vector<std::uint64_t>& next() {
    if (all_) {
      ++masks_.front();
      return masks_;
    }
    do {
      for (std::uint64_t& mask : masks_) mask = random_();
      masks_.back() &= last_;
    } while (std::all_of(masks_.begin(), masks_.end(), [](std::uint64_t m) { return m == 0; }));
    return masks_;
  }

 private:
  std::vector<std::uint64_t> masks_;
  std::uint64_t last_ = ~std::uint64_t{0};
  bool all_;
  boost::random::mt19937_64 random_{kSubsetSeed};
};

}  // namespace

SubsetMeans::SubsetMeans(const std::vector<Pair>& pairs, unsigned bits) {
  SIMBENCH_ASSERT(!pairs.empty() && bits >= 1 && bits <= 24, "subsets are of some pairs");
  double sum_a = 0;
  double sum_difference = 0;
  const double first = pairs.front().b - pairs.front().a;
  for (const Pair& pair : pairs) {
    constexpr double kRoundingShare = 1e-13;
    sum_a += pair.a;
    sum_difference += pair.b - pair.a;
    rounding_ += kRoundingShare * std::abs(pair.b - pair.a);
    all_equal_ = all_equal_ && pair.b - pair.a == first;
  }
  difference_ = all_equal_ ? first : sum_difference / static_cast<double>(pairs.size());
  if (sum_a > 0) ratio_ = 1 + sum_difference / sum_a;

  const std::vector<BlockSums> blocks = block_sums(pairs);
  const bool all = pairs.size() <= bits;
  SubsetMasks subsets(pairs.size(), all);
  const std::size_t count = (std::size_t{1} << (all ? pairs.size() : bits)) - 1;
  differences_.reserve(count);
  ratios_.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::vector<std::uint64_t>& masks = subsets.next();
    std::size_t members = 0;
    sum_a = sum_difference = 0;
    for (const std::uint64_t mask : masks) members += static_cast<std::size_t>(std::popcount(mask));
    for (std::size_t block = 0; block < blocks.size(); ++block) {
      const auto subset = masks[block / kBlock] >> (block % kBlock * kBlock) & (kBlockSubsets - 1);
      sum_a += blocks[block].a[subset];
      sum_difference += blocks[block].difference[subset];
    }
    take_subset(members, sum_a, sum_difference);
  }

  const auto is_from_0 = [](double mean) { return mean >= 0; };
  const auto is_up_to_0 = [](double mean) { return mean <= 0; };
  const auto from_0 = std::count_if(differences_.begin(), differences_.end(), is_from_0);
  const auto up_to_0 = std::count_if(differences_.begin(), differences_.end(), is_up_to_0);
  const auto smaller = static_cast<double>(std::min(from_0, up_to_0));
  p_ = std::min(1.0, 2 * (1 + smaller) / static_cast<double>(count + 1));
}

void SubsetMeans::take_subset(std::size_t members, double sum_a, double sum_difference) {
  if (std::abs(sum_difference) <= rounding_) sum_difference = 0;
  differences_.push_back(sum_difference / static_cast<double>(members));
  has_ratios_ = has_ratios_ && sum_a > 0;
  if (has_ratios_) ratios_.push_back(1 + sum_difference / sum_a);
}

Estimate SubsetMeans::between(const std::vector<double>& means, double value, double error) const {
  const auto whole = static_cast<double>(differences_.size() + 1);
  const auto k = static_cast<std::size_t>(std::floor(whole * error / 2));
  if (k == 0) return {.value = value};
  std::vector<double> sorted = means;
  const auto low = sorted.begin() + static_cast<std::ptrdiff_t>(k - 1);
  const auto high = sorted.end() - static_cast<std::ptrdiff_t>(k);
  std::nth_element(sorted.begin(), low, sorted.end());
  const double lowest = *low;
  std::nth_element(sorted.begin(), high, sorted.end());
  return {.value = value, .low = lowest, .high = *high};
}

Estimate SubsetMeans::difference(double error) const {
  Estimate estimate = between(differences_, difference_, error);
  if (all_equal_ && !std::isnan(estimate.low)) estimate.low = estimate.high = difference_;
  return estimate;
}

Estimate SubsetMeans::ratio(double error) const {
  if (!has_ratios_) return {.value = ratio_};
  return between(ratios_, ratio_, error);
}

}  // namespace simbench::evaluation
