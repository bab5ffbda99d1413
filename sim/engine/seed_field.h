// Which random numbers of a run are drawn anew or moved: a world beside a world, for rare events.
//
// A run is a function of the words of its streams (sim/engine/random.h). A field of mutations
// replaces them: each mutation changes a chosen share of all words and leaves the others as they
// are. Which words those are follows from the mutation's key and the word itself alone, so it does
// not depend on their order. Changed words are drawn anew; with a step below 1 they are moved, x' =
// sqrt(1 - step^2) x + step N(0, 1), x being a word's normal quantile (the preconditioned
// Crank-Nicolson proposal), so that a rare draw stays rare. Both leave the law of the words as it
// is and are reversible: a mutation is a step of a Markov chain over runs whose law is that of
// independent runs. evaluation/rare/splitting.h rests on that.
//
// A field counts on the thread that has a SeedFieldScope of it. There, normal and exponential
// numbers are made of one word each, by inversion instead of a ziggurat: so a word moved a little
// moves the number a little, its tails included, and no later draw. An empty field thus gives
// another run than no field, of the same law. For the same reason the delays of a camera's frame
// have a stream for each frame (sim/usb/host_stack.h), since a jump takes one word more.
//
// A backend keeps a world for its seed (sim/rig/simulation.h): make one for each field.
//
// The lowest eleven bits of a word are not moved: they are beyond a double's digits.
//
// Source: Cotter, Roberts, Stuart and White, "MCMC methods for functions", Statistical Science
// 28(3), 2013. Cost: some nanoseconds a word and mutation since the last that renewed it, 0.1 us
// more for a word that was moved, 50 ns for a normal number.
//
//   SeedField field;
//   field.add({.key = 7, .share = 0.1});              // a tenth of the words anew
//   field.add({.key = 8, .share = 0.5, .step = 0.3});  // half of them moved
//   const SeedFieldScope scope(field);
//   make_simulation(scenario)->record(request, sink);
#pragma once

#include <cstdint>
#include <vector>

namespace simbench::sim {

struct Mutation {
  std::uint64_t key = 0;  // no two of a field have the same
  double share = 1;       // of the words, 0 to 1
  double step = 1;        // above 0; 1: anew
};

class SeedField {
 public:
  void add(const Mutation& mutation);
  // The word in place of this.
  std::uint64_t replaced(std::uint64_t word) const;

 private:
  struct Step {
    std::uint64_t key;
    std::uint64_t factor;  // odd; a word's hash is their product
    std::uint64_t most;    // a word takes part whose hash is not above this
    double step;
    double kept;  // of a moved quantile
  };
  std::vector<Step> steps_;
};

// Only one at a time on a thread. The field must outlive this.
class SeedFieldScope {
 public:
  explicit SeedFieldScope(const SeedField& field);
  ~SeedFieldScope();
  SeedFieldScope(const SeedFieldScope&) = delete;
  SeedFieldScope& operator=(const SeedFieldScope&) = delete;
};

}  // namespace simbench::sim
