// What became of the pulses: how many were due, and how many of these every camera exposed.
//
// Scores are over pulses that all cameras delivered, so where half of the pulses are missing they
// look as if none were. This counts from what was due:
//
//   due        the evaluated pulses, of these such as all cameras are to expose
//   exposed    those of them that every camera exposed
//   delivered  those of which every camera delivered its frame (SetCounts::complete_pulses)
//   whole      those that gathering found whole (SetCounts::pure)
//
// A camera counts what it exposes: between two frames of it a gap of the counter is exposures that
// were lost on the way, and a pulse more than that was not exposed. Where a gap has both, nothing
// tells which pulse was which, and the exposures are taken to lie evenly in it. Behind the last
// frame of a camera nothing tells: one or two pulses are taken to be exposed (their frames were
// lost and none came after them), more are a camera that stopped. A counter that does not fit (a
// reset) makes no exposure.
//
// Memory: 4 bytes for each pulse and camera. Cost: a store for each frame.
//
//   PulseAccount account(/*first_pulse=*/225, /*pulses=*/480, /*cameras=*/18);
//   account.add(/*camera=*/3, /*pulse=*/230, /*counter=*/77);   // each frame of a pulse
//   account.add_to(seed_score.sets);
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "evaluation/scoring/metrics.h"

namespace simbench::evaluation {

class PulseAccount {
 public:
  // A pulse is due if its number is a multiple of `due_every`.
  PulseAccount(std::int64_t first_pulse, std::int64_t pulses, std::size_t cameras,
               std::int64_t due_every = 1);

  // A delivered frame, in any order; also of the warm-up and behind the evaluated pulses, whose
  // counters bound the gaps at both ends.
  void add(std::uint32_t camera, std::int64_t pulse, std::uint32_t counter);

  // Sets due_pulses and exposed_pulses.
  void add_to(SetCounts& counts) const;

 private:
  struct Frame {
    std::int64_t pulse = 0;
    std::uint32_t counter = 0;
  };
  // The frames of a camera nearest to the evaluated pulses.
  struct Ends {
    std::optional<Frame> before;
    std::optional<Frame> after;
  };

  // Takes the pulses between two frames that the camera did not expose out of `exposed`.
  void take_out(const Frame& last, const Frame& next, std::vector<bool>& exposed) const;

  std::int64_t first_pulse_;
  std::int64_t due_every_;
  std::size_t pulses_;
  std::vector<Ends> ends_;             // by camera
  std::vector<std::uint32_t> frames_;  // by pulse of each camera: 1 + its counter; 0: none
};

}  // namespace simbench::evaluation
