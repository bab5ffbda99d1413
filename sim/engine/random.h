// Random numbers of the simulated world: one stream per component.
//
// A stream is derived from the run's seed and the component's name, so a component that draws more,
// or a new one, changes no other's numbers. Where the algorithm under test decides the order of
// draws (messages on a link), a stream is keyed instead: one short-lived stream per (link and
// direction, message index), so that extra messages change no other's numbers either.
//
// Within one stream, later draws depend on the number of earlier ones: normal(0) and exponential(0)
// give exactly 0 but still draw, so that a model whose parameter may be 0 keeps its other draws.
//
// Generator: xoshiro256++ 1.0, seeded by splitmix64 (laws/generators.h).
// Distributions: Boost.Random's ziggurats, which give the same numbers with every compiler.
// Cost: a raw draw about 1 ns, a normal one about 4 ns, a new stream a few nanoseconds with a ready
// ComponentKey (docs/reference/event_engine.md section 5).
//
//   RandomStream jitter(run_seed, "camera 3: transfer");
//   const Nanoseconds delay = from_ms(2.0 + jitter.exponential(0.3));
//
//   static constexpr ComponentKey kDelay("link delay");
//   RandomStream draw(run_seed, kDelay, link_and_direction, message_index);
//
//   const KeyedStreams delays = KeyedStreams(run_seed, kDelay).of(link_and_direction);
//   RandomStream same = delays.stream(message_index);  // half of the way is gone already
#pragma once

#include <boost/random/exponential_distribution.hpp>
#include <boost/random/normal_distribution.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string_view>

#include "laws/generators.h"

namespace simbench::sim {

// The hash (64-bit FNV-1a) of a component's name, to be computed once.
class ComponentKey {
 public:
  constexpr explicit ComponentKey(std::string_view name) {
    for (const char c : name) hash_ = (hash_ ^ static_cast<unsigned char>(c)) * 0x100000001B3;
  }
  constexpr std::uint64_t hash() const { return hash_; }

 private:
  std::uint64_t hash_ = 0xCBF29CE484222325;
};

class RandomStream;
class SeedField;

// Replaces the words of the streams that this thread draws from (sim/engine/seed_field.h); null:
// none.
inline thread_local constinit const SeedField* active_seed_field = nullptr;

// The streams of a component's events, as far as their keys are known already.
class KeyedStreams {
 public:
  constexpr KeyedStreams(std::uint64_t run_seed, ComponentKey component)
      : hash_(absorb(SplitMix64(run_seed)(), component.hash())) {}

  // Those whose next key is `a`.
  constexpr KeyedStreams of(std::uint64_t a) const { return KeyedStreams(absorb(hash_, a)); }
  // The one whose last key is `b`.
  RandomStream stream(std::uint64_t b) const;

 private:
  friend class RandomStream;
  constexpr explicit KeyedStreams(std::uint64_t hash) : hash_(hash) {}
  static constexpr std::uint64_t absorb(std::uint64_t hash, std::uint64_t value) {
    return SplitMix64(hash ^ SplitMix64::mix(value + SplitMix64::kIncrement))();
  }

  std::uint64_t hash_;
};

class RandomStream {
 public:
  using result_type = std::uint64_t;

  // The stream of a component.
  RandomStream(std::uint64_t run_seed, std::string_view component)
      : RandomStream(run_seed, ComponentKey(component)) {}
  RandomStream(std::uint64_t run_seed, ComponentKey component)
      : RandomStream(KeyedStreams(run_seed, component)) {}

  // The stream of one event of a component, e.g. (link and direction, message index).
  // Differs from the component's own stream for every a and b.
  RandomStream(std::uint64_t run_seed, std::string_view component, std::uint64_t a,
               std::uint64_t b = 0)
      : RandomStream(run_seed, ComponentKey(component), a, b) {}
  RandomStream(std::uint64_t run_seed, ComponentKey component, std::uint64_t a, std::uint64_t b = 0)
      : RandomStream(KeyedStreams(run_seed, component).of(a).of(b)) {}

  static constexpr result_type min() { return 0; }
  static constexpr result_type max() { return std::numeric_limits<result_type>::max(); }
  result_type operator()() {
    const result_type word = generator_();
    if (active_seed_field != nullptr) [[unlikely]]
      return word_in_field(word);
    return word;
  }

  // In [0, 1), a multiple of 2^-53.
  double uniform() { return unit_share((*this)()); }
  // In [low, high); rounding may give high itself where the two are close.
  double uniform(double low, double high) { return low + (high - low) * uniform(); }

  // Mean 0, standard deviation sigma >= 0; sigma 0 gives exactly 0.
  double normal(double sigma) {
    if (active_seed_field != nullptr) [[unlikely]]
      return sigma * normal_in_field();
    return boost::random::normal_distribution<double>(0.0, sigma)(generator_);
  }
  // Mean >= 0; mean 0 gives exactly 0.
  double exponential(double mean) {
    if (active_seed_field != nullptr) [[unlikely]]
      return mean * exponential_in_field();
    return mean * boost::random::exponential_distribution<double>(1.0)(generator_);
  }
  // exp(N(0, log_sigma)): median 1, mean exp(log_sigma^2 / 2); log_sigma 0 gives exactly 1.
  double lognormal(double log_sigma) { return std::exp(normal(log_sigma)); }

  // True with the given probability: never for 0, always for 1.
  bool chance(double probability) { return uniform() < probability; }

  // In {0, ..., n - 1}, n > 0, each with exactly the same probability.
  std::uint64_t below(std::uint64_t n);

 private:
  friend class KeyedStreams;
  explicit RandomStream(KeyedStreams keyed) : generator_(SplitMix64(keyed.hash_)) {}
  static std::uint64_t word_in_field(std::uint64_t word);
  // By inversion of a word, so that a word moved a little moves the number a little.
  double normal_in_field();
  double exponential_in_field();

  Xoshiro256PlusPlus generator_;
};

inline RandomStream KeyedStreams::stream(std::uint64_t b) const { return RandomStream(of(b)); }

}  // namespace simbench::sim
