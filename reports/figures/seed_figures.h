// Figures that compare pipelines at one seed: the same pulses, the same cameras.
//
// Each takes the existing runs, in any order. It uses the pipelines of the paper by name, or others
// if these are missing; the caption then states so.
#pragma once

#include <span>
#include <vector>

#include "evaluation/run/run_detail.h"
#include "reports/figures/figure.h"

namespace simbench::reports {

// Fig. 8: the global stamps of all cameras without and with synchronisation, less a common
// reference (as in run_figures.h).
Figure synchronisation(std::span<const evaluation::RunDetail> runs);

// Fig. 11 to 13: a millisecond clock on a 120 Hz display as six cameras see it, in the frames that
// a pipeline takes for simultaneous: those whose global stamps are nearest to that of the master's
// first camera at a pulse in the middle of the capture. The display shows a new reading every 1/120
// s, so frames that differ by less may look alike. Where there are depth and colour, each pipeline
// has a row for each; runs of several sync modes stand together by mode.
Figure digital_clocks(std::span<const evaluation::RunDetail> runs);

// Both, in this order.
std::vector<Figure> seed_figures(std::span<const evaluation::RunDetail> runs);

// The display is the paper's millisecond clock on a 120 Hz tablet. It shows the true time at the
// beginning of each of its frames for 1/120 s. Its frames begin at true zero.
inline constexpr double kDisplayRateHz = 120;

// Returns the readings of the display from `start_ms` to `end_ms` (true time) with their shares of
// that time, which add up to 1; one reading for an exposure without length. Readings of less than 1
// % are invisible. At most the first 24 readings.
std::vector<PhotographedReading> display_readings(double start_ms, double end_ms);

}  // namespace simbench::reports
