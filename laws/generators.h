// Generators of random words, the same with every compiler.
//
//   SplitMix64          a generator whose state only counts; each output is a strong mix of its
//   state,
//                       and the mix is a hash of its own. For seeds, keys and few draws.
//   Xoshiro256PlusPlus  256 bits of state, period 2^256 - 1. For streams.
//
// Both are uniform random bit generators, as Boost.Random's distributions want them. Cost: about 1
// ns a word. Source: Steele, Lea and Flood, "Fast splittable pseudorandom number generators",
// OOPSLA 2014; Blackman and Vigna, "Scrambled linear pseudorandom number generators", ACM TOMS
// 47(4), 2021.
//
//   SplitMix64 generator(7);
//   const double share = unit_share(generator());
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <limits>

namespace simbench {

class SplitMix64 {
 public:
  using result_type = std::uint64_t;
  constexpr explicit SplitMix64(std::uint64_t state) : state_(state) {}
  constexpr std::uint64_t operator()() { return mix(state_ += kIncrement); }
  static constexpr result_type min() { return 0; }
  static constexpr result_type max() { return std::numeric_limits<result_type>::max(); }

  static constexpr std::uint64_t kIncrement = 0x9E3779B97F4A7C15;  // 2^64 over the golden ratio
  static constexpr std::uint64_t mix(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EB;
    return z ^ (z >> 31);
  }

 private:
  std::uint64_t state_;
};

// The bits of its state must not all be 0.
class Xoshiro256PlusPlus {
 public:
  using State = std::array<std::uint64_t, 4>;
  using result_type = std::uint64_t;
  constexpr explicit Xoshiro256PlusPlus(const State& state)
      : a_(state[0]), b_(state[1]), c_(state[2]), d_(state[3]) {}
  // Its state are the next four words.
  [[gnu::always_inline]] constexpr explicit Xoshiro256PlusPlus(SplitMix64 words)
      : a_(words()), b_(words()), c_(words()), d_(words()) {}
  static constexpr result_type min() { return 0; }
  static constexpr result_type max() { return std::numeric_limits<result_type>::max(); }

  constexpr std::uint64_t operator()() {
    const std::uint64_t result = std::rotl(a_ + d_, 23) + a_;
    const std::uint64_t shifted = b_ << 17;
    c_ ^= a_;
    d_ ^= b_;
    b_ ^= c_;
    a_ ^= d_;
    c_ ^= shifted;
    d_ = std::rotl(d_, 45);
    return result;
  }

 private:
  // Words by themselves: an array that was just written word by word and is copied as a whole makes
  // the processor wait for it.
  std::uint64_t a_;
  std::uint64_t b_;
  std::uint64_t c_;
  std::uint64_t d_;
};

// The upper 53 bits of a word as a number in [0, 1), a multiple of 2^-53.
constexpr double unit_share(std::uint64_t word) {
  return static_cast<double>(word >> 11) * 0x1p-53;
}

}  // namespace simbench
