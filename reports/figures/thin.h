// Thinning of long series: fewer points, the same picture.
//
// The series is cut into buckets of equally many points, and of each the smallest and the largest
// are kept, in their order, with the first and the last of all: a spike stays, however short. A gap
// (NaN) between two kept points stays a gap.
//
//   panel.series.push_back(thinned(std::move(series), 1000));
#ifndef SIMBENCH_REPORTS_FIGURES_THIN_H_
#define SIMBENCH_REPORTS_FIGURES_THIN_H_

#include <cstddef>

#include "reports/figures/figure.h"

namespace simbench::reports {

// At most `most` points, at least 8. A shorter series is returned as it is. O(n).
FigureSeries thinned(FigureSeries series, std::size_t most);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_FIGURES_THIN_H_
