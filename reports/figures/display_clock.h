// A clock on a display, as a camera sees it: the paper's millisecond clock on a 120 Hz tablet.
//
// The display shows true time, as it is at the beginning of each of its frames, for 1/120 s. Its
// frames begin at true zero.
#ifndef SIMBENCH_REPORTS_FIGURES_DISPLAY_CLOCK_H_
#define SIMBENCH_REPORTS_FIGURES_DISPLAY_CLOCK_H_

#include <vector>

#include "reports/figures/figure.h"

namespace simbench::reports {

inline constexpr double kDisplayRateHz = 120;

// What is on the display from `start_ms` to `end_ms` (true time), with the shares of that time; an
// exposure of no length sees one reading. What is shown for less than 1 % of it leaves no trace. At
// most 24 readings, the first ones. The shares add up to 1.
std::vector<PhotographedReading> display_readings(double start_ms, double end_ms);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_FIGURES_DISPLAY_CLOCK_H_
