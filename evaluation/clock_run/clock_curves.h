// The curves of stability: what each is called in files and figures, and where it is kept.
#ifndef SIMBENCH_EVALUATION_CLOCK_RUN_CLOCK_CURVES_H_
#define SIMBENCH_EVALUATION_CLOCK_RUN_CLOCK_CURVES_H_

#include <span>
#include <vector>

#include "evaluation/clock_run/clock_score.h"

namespace simbench::evaluation {

struct ClockCurve {
  const char* id;  // in JSON and CSV
  const char* title;
  const char* axis;  // with its unit
  bool in_text;      // and in figures
  std::vector<StabilityPoint> StabilityCurves::*points;
};

inline constexpr ClockCurve kClockCurves[] = {
    {"adev", "Allan deviation", "ADEV", true, &StabilityCurves::adev},
    {"mdev", "Modified Allan deviation", "MDEV", false, &StabilityCurves::mdev},
    {"hdev", "Hadamard deviation", "HDEV", false, &StabilityCurves::hdev},
    {"tdev_ms", "Time deviation, ms", "TDEV ms", true, &StabilityCurves::tdev_ms},
    {"mtie_ms", "Maximum time interval error, ms", "MTIE ms", true, &StabilityCurves::mtie_ms},
};
inline std::span<const ClockCurve> clock_curves() { return kClockCurves; }

}  // namespace simbench::evaluation

#endif  // SIMBENCH_EVALUATION_CLOCK_RUN_CLOCK_CURVES_H_
