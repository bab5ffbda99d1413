// What sets the frames of two cameras apart: an account of the difference of their arrivals at the
// same pulse.
//
// Frames are paired by arrival, each host's clock put right by its log, at the phase that most
// have, to within half a period. The difference d of a pair is a sum of six series:
//  exposure    the difference of the exposure lengths, if they are known: a frame leaves after it
//  host clock  the difference of the hosts' errors by their logs; 0 on one host
//  stamp       the difference of the sensor stamps about a line, in each block of time
//  delivery    the difference of (arrival - sensor stamp) about a line, in each block
//  constant    the mean of what remains
//  unexplained what remains then: all that is slower than a block and in no log
// What moves both cameras alike, as a trigger's jitter does, is in none of them. A part that is
// unknown (NaN) is in the constant and in the unexplained one.
//
// Parts are root mean squares; their 95 % intervals are by the mean squares of the blocks and
// Student's t. A share is mean(part x d) / mean(d^2): shares add up to 1, and a part that takes
// back what another one does has a negative share. For independent parts the share is the part's
// square over the total's.
//
// Complexity: O(n log n) in the frames.
//
//   const auto budget = spread_budget({delays_a, error_a, {}}, {delays_b, error_b, {}});
//   if (budget) print(budget->total.rms_ms, budget->host_clock.share);
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "evaluation/diagnosis/camera_delays.h"
#include "evaluation/diagnosis/clock_explanation.h"

namespace simbench::evaluation {

struct SpreadPart {
  double rms_ms = kNan;  // NaN: unknown
  double low_ms = kNan;
  double high_ms = kNan;
  double share = kNan;
};

struct SpreadBudget {
  std::string camera{};
  std::string host{};
  std::string against{};
  std::string host_against{};
  std::string stream{};
  std::size_t pairs = 0;  // of frames
  double block_s = kNan;
  double period_ms = kNan;
  double constant_ms = kNan;  // with its sign: positive, `camera` is later
  // The mean difference of the sensor stamps, if both count from 1970 and are no host's.
  double stamps_apart_ms = kNan;
  SpreadPart total{};
  SpreadPart exposure{};
  SpreadPart stamp{};
  SpreadPart delivery{};
  SpreadPart host_clock{};
  SpreadPart constant{};
  SpreadPart unexplained{};
};

// One of the two cameras; what is named outlives the call.
struct SpreadSide {
  const CameraDelays& delays;
  ErrorOfClock error_s{};                  // empty: no log
  std::span<const double> exposures_ms{};  // by frame of the recording; empty: unknown
};

// Nothing with fewer than 160 pairs, or where they cover less than half of the frames (cameras that
// share no time, or a log that covers little of it: call it without that log then).
std::optional<SpreadBudget> spread_budget(const SpreadSide& camera, const SpreadSide& against);

}  // namespace simbench::evaluation
