// What the stamps of a stream count: whether they can be compared with those of other cameras, and
// which constant lies between them.
//
// Stamps that count from an epoch are compared with arrivals that do (else with the stamps of the
// other cameras): stamp less arrival is a constant less a delay, and delays are short. A constant
// of 37 s, 18 s, whole quarters of an hour, the distance of two epochs or whole seconds is named,
// since no delay is that long; a stamp that lies in the future of its own arrival is of a clock
// ahead. Stamps of a camera's own clock, which counts from when it was switched on, are compared
// with nothing; those of several cameras whose difference from their arrivals agrees to kSameBootS
// and whose rates agree are of one clock that counts from boot.
//
// Bounds: leap seconds are those of 2017 and later (TAI - UTC 37 s, GPS - UTC 18 s).
// Source: IERS Bulletin C; IEEE 1588-2019 7.2 (PTP counts TAI from 1970); ISO/IEC 14496-12 (1904).
//
//   const StampScale scale = stamp_scale(stream_facts(stream));
//   if (scale.kind == ScaleKind::kShifted) print(scale.name, scale.shift_s);
//
// Complexity: constant for each stream.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "evaluation/diagnosis/stream_facts.h"

namespace simbench::evaluation {

inline constexpr double kSameBootS = 0.5;
inline constexpr double kLongestDelayS = 5;  // more is no delay of a frame

enum class ScaleKind : std::uint8_t {
  kOwnClock,  // a camera's, or a computer's that counts from boot
  kUnixTime,  // of the arrivals' scale, no constant between
  kShifted,   // by a constant that has a name
  kAhead,     // in the future of its arrivals, by no constant that has a name
  kBehind     // too far in the past for a delay
};

struct StampScale {
  ScaleKind kind = ScaleKind::kOwnClock;
  double shift_s = 0;            // stamps are ahead by that; taken out in what follows
  std::string name{};            // of a shift: what the stamps count
  std::string cause{};           // what makes such a shift, and what to do
  double delay_ms = kNan;        // median of arrivals after stamps
  double least_delay_ms = kNan;  // 1 % are below
};

// The constant by which stamps are ahead, if it has a name. `ahead_s`: of stamps over arrivals (or
// over the stamps of others).
std::optional<StampScale> named_shift(double ahead_s);

// `others_ahead_s`: by how much other cameras' stamps are ahead of their arrivals, where arrivals
// do not count from an epoch themselves.
StampScale stamp_scale(const StreamFacts& facts, std::optional<double> others_ahead_s = {});

}  // namespace simbench::evaluation
