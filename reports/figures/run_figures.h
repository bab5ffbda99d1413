// Figures of one run: one pipeline at one seed.
//
// The paper plots stamps against the frame, where offsets of milliseconds are invisible beside
// seconds. Figures of differences subtract the reading of the master's clock at the mid-exposure of
// the same pulse (of the master's first camera, or the first that has the pulse) from the stamps;
// in captures without truth, the median of the pulse's stamps.
//
// Series of cameras of one host share a colour where hosts are compared.
#pragma once

#include <vector>

#include "evaluation/run/run_detail.h"
#include "reports/figures/figure.h"

namespace simbench::reports {

// Fig. 2: intervals between consecutive stamps of one camera, a panel for each of the four stamps.
Figure stamp_intervals(const evaluation::RunDetail& run);
// Fig. 3: sensor and arrival stamps of the cameras of one host.
Figure stamps(const evaluation::RunDetail& run);
// Fig. 4: global stamps by regression over the last 30 frames and over all frames.
Figure global_stamps(const evaluation::RunDetail& run);
// Fig. 5: global stamps of the cameras of one host, and of two.
Figure hosts(const evaluation::RunDetail& run);
// Fig. 7b: intervals of the global stamps in the first 10 s of the capture.
Figure first_seconds(const evaluation::RunDetail& run);
// How far the true exposures of the cameras are apart, over time: each camera's against the first
// one's, and the range of all.
Figure exposures(const evaluation::RunDetail& run);
// Which frames were gathered, dropped, gathered wrongly or left over.
Figure gathering(const evaluation::RunDetail& run);

// All of these, in this order, with host_clock_figure.h before the last, pulse_figure.h behind and,
// where the trigger has a code, code_figure.h.
std::vector<Figure> run_figures(const evaluation::RunDetail& run);

}  // namespace simbench::reports
