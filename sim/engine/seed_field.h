// Which random streams of a run are drawn anew: a world beside a world, for rare events.
//
// A run is a function of its streams (sim/engine/random.h), each of which follows from a root, the
// hash of (run seed, component, keys). A field replaces roots: every mutation gives a chosen share
// of all streams new roots and leaves the others as they are. Which streams those are follows from
// the mutation's key and the stream's own root alone, so it does not depend on their order, nor on
// what they drew. So a run with a field is a run with independent streams like any other, and a
// mutation is a step of a Markov chain over runs whose law is that of independent runs: each stream
// keeps its numbers, or gets new ones, by a coin that knows neither (evaluation/rare/splitting.h
// rests on that).
//
// A field counts on the thread that has a SeedFieldScope of it, for streams made during its
// lifetime. Streams that are otherwise one for a whole run (delays of a camera's frames, jitter of
// a host) are then one for each frame or period, with the same distribution, so that a mutation can
// change a part of a run. So an empty field gives another run than no field.
//
// A backend keeps a world for its seed (sim/rig/simulation.h): make one for each field.
//
// Cost: a stream costs some nanoseconds more for each mutation since the last that replaced it.
//
//   SeedField field;
//   field.add({.key = 7, .share = 0.1});   // a tenth of the streams
//   const SeedFieldScope scope(field);
//   make_simulation(scenario)->record(request, sink);
#ifndef SIMBENCH_SIM_ENGINE_SEED_FIELD_H_
#define SIMBENCH_SIM_ENGINE_SEED_FIELD_H_

#include <cstdint>
#include <vector>

namespace simbench::sim {

struct Mutation {
  std::uint64_t key = 0;  // no two of a field have the same
  double share = 1;       // of the streams, 0 to 1
};

class SeedField {
 public:
  void add(const Mutation& mutation);
  // The root in place of this one.
  std::uint64_t replaced(std::uint64_t root) const;

 private:
  struct Step {
    std::uint64_t key;
    std::uint64_t below;  // a stream takes part whose hash is not above this
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

#endif  // SIMBENCH_SIM_ENGINE_SEED_FIELD_H_
