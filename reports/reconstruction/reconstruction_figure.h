// What a millisecond costs, as a figure (reports/figures/figure.h), which anything that draws
// figures can draw.
//
// One panel: the median mean error over desynchronisation, a curve for each speed of the subject,
// and the published means as lines. A second one, where it was looked for: the error over the
// speed, at the desynchronisation of the row with the largest published mean. With neither there is
// nothing to draw (Figure::absent).
#ifndef SIMBENCH_REPORTS_RECONSTRUCTION_RECONSTRUCTION_FIGURE_H_
#define SIMBENCH_REPORTS_RECONSTRUCTION_RECONSTRUCTION_FIGURE_H_

#include "reconstruction/results.h"
#include "reports/figures/figure.h"

namespace simbench::reports {

Figure reconstruction_figure(const reconstruction::ReconstructionResults& results);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_RECONSTRUCTION_RECONSTRUCTION_FIGURE_H_
