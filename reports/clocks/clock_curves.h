// The curves of stability in reports: what each is called, and where it is kept.
#ifndef SIMBENCH_REPORTS_CLOCKS_CLOCK_CURVES_H_
#define SIMBENCH_REPORTS_CLOCKS_CLOCK_CURVES_H_

#include <span>
#include <vector>

#include "evaluation/clock_run/clock_score.h"

namespace simbench::reports {

struct ClockCurve {
  const char* id;  // in JSON and CSV
  const char* title;
  const char* axis;  // with its unit
  bool in_text;      // and in figures
  std::vector<evaluation::StabilityPoint> evaluation::StabilityCurves::*points;
};

inline constexpr ClockCurve kClockCurves[] = {
    {"adev", "Allan deviation", "ADEV", true, &evaluation::StabilityCurves::adev},
    {"mdev", "Modified Allan deviation", "MDEV", false, &evaluation::StabilityCurves::mdev},
    {"hdev", "Hadamard deviation", "HDEV", false, &evaluation::StabilityCurves::hdev},
    {"tdev_ms", "Time deviation, ms", "TDEV ms", true, &evaluation::StabilityCurves::tdev_ms},
    {"mtie_ms", "Maximum time interval error, ms", "MTIE ms", true,
     &evaluation::StabilityCurves::mtie_ms},
};
inline std::span<const ClockCurve> clock_curves() { return kClockCurves; }

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_CLOCKS_CLOCK_CURVES_H_
