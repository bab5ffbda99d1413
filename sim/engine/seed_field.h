// Which random streams of a run are drawn anew: a world beside a world, for rare events.
//
// A run is a function of its streams (sim/engine/random.h), each of which follows from a root, the
// hash of (run seed, component, keys). A field of mutations replaces them: each mutation changes a
// chosen share of all streams and leaves the others as they are. Which streams those are follows
// from the mutation's key and the stream's own root alone, so it does not depend on their order,
// nor on what they drew. Changed streams get new numbers throughout; with a step below 1 their
// first number is only moved, x' = sqrt(1 - step^2) x + step N(0, 1), x being its normal quantile
// (the preconditioned Crank-Nicolson proposal), so that a rare draw stays rare. Both leave the law
// of the streams as it is and are reversible: a mutation is a step of a Markov chain over runs
// whose law is that of independent runs. evaluation/rare/splitting.h rests on that.
//
// A field counts on the thread that has a SeedFieldScope of it, for streams made during its
// lifetime. Streams that are otherwise one for a whole run (delays of a camera's frames, jitter of
// a host) are then one for each frame or period, with the same distribution, so that a mutation can
// change a part of a run. So an empty field gives another run than no field.
//
// A backend keeps a world for its seed (sim/rig/simulation.h): make one for each field.
//
// Of a stream's words the first alone is moved, its lowest eleven bits excepted, which choose a
// layer of a ziggurat; xoshiro's state is shifted so that its first output is.
//
// Source: Cotter, Roberts, Stuart and White, "MCMC methods for functions", Statistical Science
// 28(3), 2013. Cost: some nanoseconds a stream and mutation since the last that renewed it, 0.1 us
// more for a stream that was moved.
//
//   SeedField field;
//   field.add({.key = 7, .share = 0.1});              // a tenth of the streams anew
//   field.add({.key = 8, .share = 0.5, .step = 0.3});  // half of them moved
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
  double step = 1;        // above 0; 1: anew
};

// What a stream is made of: its root, and by how much its first word is greater.
struct StreamOrigin {
  std::uint64_t root = 0;
  std::uint64_t shift = 0;
};

class SeedField {
 public:
  void add(const Mutation& mutation);
  // The origin in place of this root.
  StreamOrigin origin(std::uint64_t root) const;

 private:
  struct Step {
    std::uint64_t key;
    std::uint64_t salt;  // of the streams' hashes
    std::uint64_t most;  // a stream takes part whose hash is not above this
    double step;
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
