// How stable a clock is: deviations, wander and time error of a measured or simulated series of its
// time error, as people who judge clocks and links read them.
//
// The time error x is what the clock shows minus what it should show, in seconds, at points one
// interval tau0 apart. A series may have gaps: it consists of evenly spaced pieces. No difference
// reaches over a gap and nothing is interpolated; the terms of all pieces are pooled, and each
// result says of how many it is. A piece of N points has, at an averaging time tau = m tau0,
//
//   name        value                                                         terms of a piece
//   ADEV        sqrt(mean(d_i^2) / 2) / tau,  d_i = x_(i+2m) - 2 x_(i+m) + x_i     N - 2m
//   ADEV plain  the same, i = 0, m, 2m ...                                    (N - 1) div m - 1
//   MDEV        sqrt(mean(D_j^2) / 2) / tau,  D_j = mean of d_j ... d_(j+m-1)      N - 3m + 1
//   HDEV        sqrt(mean(h_i^2) / 6) / tau,
//                 h_i = x_(i+3m) - 3 x_(i+2m) + 3 x_(i+m) - x_i               N - 3m
//   HDEV plain  the same, i = 0, m, 2m ...                                    (N - 1) div m - 2
//   TDEV        tau MDEV / sqrt(3), in seconds                                as MDEV
//   MTIE        max over i of (max - min of x_i ... x_(i+m)), in seconds      N - m
//
// and none where that is less than 1. A value without a term in any piece does not exist: it is
// absent, never NaN and never 0. HDEV is that of three-point frequency differences, which a linear
// frequency drift leaves as it is. With a constant frequency offset MTIE grows without end; the
// deviations do not see it.
//
// Each deviation has the power-law noise that the series shows at its tau and the 95 % confidence
// interval under it (evaluation/stability/noise_type.h, confidence.h), where the noise can be told
// and the value is not 0. MTIE has none: it is a largest value, which grows with the length of the
// series, not an estimate of a mean.
//
// Numerics: differences are taken first, so that an offset of the clock costs no digits; rolling
// sums are compensated. Complexity: O(N) for each value; MTIE over all octaves O(N log N), by
// doubling its windows; MTIE at one m O(N log m). Memory: two series.
//
// Sources: W. J. Riley, Handbook of Frequency Stability Analysis, NIST SP 1065, 2008, section 5.2
// (Allan, overlapping Allan, modified Allan, time and Hadamard variance); Recommendation ITU-T
// G.810 (08/96), appendix II (estimators of ADEV, MDEV, TDEV and MTIE).
//
//   TimeErrorSeries series{.interval_s = 1, .pieces = {{.start_s = 0, .x_s = {0, 1e-6, 3e-6}}}};
//   const Stability stability = stability_of(series);
//   const std::optional<StabilityPoint> mtie = deviation_at(series, Deviation::kMtie, 2);
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "evaluation/stability/noise_type.h"
#include "evaluation/stability/time_error.h"

namespace simbench::evaluation {

enum class Deviation : std::uint8_t {
  kAdev,  // the overlapping one
  kAdevPlain,
  kMdev,
  kHdev,  // the overlapping one
  kHdevPlain,
  kTdev,
  kMtie
};

struct Certainty {
  double low = 0;  // the 95 % confidence interval, in the value's unit
  double high = 0;
  NoiseType noise = NoiseType::kWhiteFm;
  bool reliable = true;  // kFewestDegrees of freedom or more
};

struct StabilityPoint {
  double tau_s = 0;
  double value = 0;        // without a unit; of TDEV and MTIE see where it stands
  std::int64_t terms = 0;  // differences, or windows of MTIE, that it is of
  std::optional<Certainty> certainty{};
};

// At tau = m intervals, m >= 1, without its certainty; TDEV and MTIE in seconds. Nothing if no
// piece is long enough.
std::optional<StabilityPoint> deviation_at(const TimeErrorSeries& series, Deviation deviation,
                                           std::int64_t m);

// At m = 1, 2, 4 ... as far as it exists, without certainty; TDEV and MTIE in seconds.
std::vector<StabilityPoint> deviation_over_octaves(const TimeErrorSeries& series,
                                                   Deviation deviation);

// All of that over octaves; ADEV and HDEV are the overlapping ones.
struct StabilityCurves {
  std::vector<StabilityPoint> adev{};
  std::vector<StabilityPoint> mdev{};
  std::vector<StabilityPoint> hdev{};
  std::vector<StabilityPoint> tdev_ms{};
  std::vector<StabilityPoint> mtie_ms{};
};

// What each curve is called in files and figures, and where it is kept.
struct ClockCurve {
  const char* id;  // in JSON and CSV
  const char* title;
  const char* axis;  // with its unit
  bool in_text;      // and in figures
  Deviation deviation;
  std::vector<StabilityPoint> StabilityCurves::*points;
};

inline constexpr ClockCurve kClockCurves[] = {
    {"adev", "Allan deviation", "ADEV", true, Deviation::kAdev, &StabilityCurves::adev},
    {"mdev", "Modified Allan deviation", "MDEV", false, Deviation::kMdev, &StabilityCurves::mdev},
    {"hdev", "Hadamard deviation", "HDEV", false, Deviation::kHdev, &StabilityCurves::hdev},
    {"tdev_ms", "Time deviation, ms", "TDEV ms", true, Deviation::kTdev, &StabilityCurves::tdev_ms},
    {"mtie_ms", "Maximum time interval error, ms", "MTIE ms", true, Deviation::kMtie,
     &StabilityCurves::mtie_ms},
};
inline std::span<const ClockCurve> clock_curves() { return kClockCurves; }

// The curves alone, without certainty.
StabilityCurves stability_curves(const TimeErrorSeries& series);

// The curves with their certainty, and the time error itself.
// Everything of a series without points is 0 and empty.
struct Stability : StabilityCurves {
  double interval_s = 0;
  std::int64_t points = 0;
  std::int64_t pieces = 0;  // that have points
  TimeErrorSummary time_error{};
  std::vector<TimeErrorStep> steps{};
  TimeErrorSeries series{};  // that all of this is of
};
Stability stability_of(TimeErrorSeries series);

}  // namespace simbench::evaluation
