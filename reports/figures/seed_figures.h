// Figures that compare pipelines at one seed: the same pulses, the same cameras.
//
// Each takes the runs that are there, in any order. It looks for the pipelines of the paper by name
// and takes others where these are missing, which the caption then says.
#ifndef SIMBENCH_REPORTS_FIGURES_SEED_FIGURES_H_
#define SIMBENCH_REPORTS_FIGURES_SEED_FIGURES_H_

#include <span>
#include <vector>

#include "evaluation/run/run_detail.h"
#include "reports/figures/figure.h"

namespace simbench::reports {

// Fig. 8: the global stamps of all cameras without and with synchronisation, less a common
// reference (as in run_figures.h).
Figure synchronisation(std::span<const evaluation::RunDetail> runs);

// Fig. 11 to 13: what six cameras see of a millisecond clock on a 120 Hz display, in the frames
// that a pipeline takes for simultaneous: those whose global stamps are nearest to that of the
// master's first camera at a pulse in the middle of the capture. The display shows a new reading
// every 1/120 s, so frames that differ by less may look alike.
Figure digital_clocks(std::span<const evaluation::RunDetail> runs);

// Both, in this order.
std::vector<Figure> seed_figures(std::span<const evaluation::RunDetail> runs);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_FIGURES_SEED_FIGURES_H_
