// What a series says of a mask: whether its time error is within the limits of
// evaluation/stability/ masks.h.
//
// Judging: a limit over a range of tau is judged at the octaves of the interval within it, a limit
// at one tau at the whole number of intervals that is within kTauShare of it. Deviations are judged
// up to a twelfth of the measured time, as G.811 wants it for TDEV: beyond, they are uncertain.
//
//   kFails         a value is beyond its limit
//   kPasses        all that the mask limits was judged and none is beyond
//   kCannotTell    none is beyond where it was judged, but not all was: the series is too short or
//                  too coarse; `reason` says from where to where
//
// Complexity: O(N) for each limit, O(N log N) for filtered MTIE.
//
//   TimeErrorSeries series{.interval_s = 1, .pieces = {{.start_s = 0, .x_s = {0, 1e-6, 3e-6}}}};
//   const MaskVerdict verdict = judge(stability_of(series), mask_named("prtc_a"));
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/stability/masks.h"
#include "evaluation/stability/stability.h"

namespace simbench::evaluation {

inline constexpr double kTauShare = 0.05;
inline constexpr double kSpansOfDeviation = 12;

enum class Judgement : std::uint8_t { kPasses, kFails, kCannotTell };

struct LimitVerdict {
  MaskLimit limit{};
  Judgement judgement = Judgement::kCannotTell;
  // The first value beyond its limit, else the one that is nearest to its limit; nothing where none
  // was judged.
  std::optional<double> value{};
  double allowed = 0;                    // there
  std::optional<double> tau_s{};         // there, of a limit that has a tau
  std::optional<double> share_within{};  // the points within the limit of max|TE|
  std::string reason{};                  // why it cannot be told
};

struct MaskVerdict {
  std::string mask{};  // id
  std::string title{};
  Judgement judgement = Judgement::kCannotTell;
  std::vector<LimitVerdict> limits{};
};

// Fails if one limit does, and passes if all do.
MaskVerdict judge(const Stability& stability, const ClockMask& mask);

}  // namespace simbench::evaluation
