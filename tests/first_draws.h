// The first numbers of a generator, for comparisons with published and with equal ones.
//
//   EXPECT_THAT(first_draws(SplitMix64(7), 2), ElementsAre(...));
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace simbench {

template <class Generator>
std::vector<std::uint64_t> first_draws(Generator generator, int count) {
  std::vector<std::uint64_t> draws;
  draws.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) draws.push_back(generator());
  return draws;
}

}  // namespace simbench
