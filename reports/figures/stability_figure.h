// The figures of measured clocks: ADEV, TDEV and MTIE over tau with their 95 % intervals, and the
// limits that they are judged by; and the time error itself, a panel for each clock.
//
// Limits of dTE_L are of the low-passed time error and stand beside curves that are not filtered.
//
//   const Figure figure = stability_figure({}, {});
#pragma once

#include <string>
#include <vector>

#include "evaluation/stability/masks.h"
#include "reports/figures/figure.h"
#include "reports/stability/stability_report.h"

namespace simbench::reports {

Figure stability_figure(const std::vector<StabilityFinding>& findings,
                        const std::vector<evaluation::ClockMask>& masks);

// The points that the deviations are of, with the largest steps between them and, where a mask
// limits the largest time error, that limit on either side. Summaries have no points to draw.
Figure time_error_figure(const std::vector<StabilityFinding>& findings,
                         const std::vector<evaluation::ClockMask>& masks);

// A limit over tau as a line, from the tau where the curves begin.
FigureSeries limit_line(const evaluation::MaskLimit& limit, std::string label, int colour,
                        double first_tau_s);

}  // namespace simbench::reports
