// Random choices, the same on every machine: the standard's distributions are not.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

namespace simbench::robustness {

class Random {
 public:
  Random(std::uint64_t seed, std::uint64_t index) : engine_(seed * 0x9e3779b97f4a7c15 + index) {}

  // Below `count`, which is not 0.
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(engine_() % count); }
  bool one_in(std::size_t count) { return below(count) == 0; }
  double unit() { return static_cast<double>(engine_() >> 11U) * 0x1p-53; }
  double between(double low, double high) { return low + (high - low) * unit(); }
  // Both above 0.
  double log_between(double low, double high) { return low * std::pow(high / low, unit()); }
  template <class T>
  const T& of(const std::vector<T>& choices) {
    return choices[below(choices.size())];
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace simbench::robustness
