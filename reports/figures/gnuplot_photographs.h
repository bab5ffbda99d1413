// The part of a gnuplot script that draws photographs; for reports/figures/gnuplot_script.cc.
#ifndef SIMBENCH_REPORTS_FIGURES_GNUPLOT_PHOTOGRAPHS_H_
#define SIMBENCH_REPORTS_FIGURES_GNUPLOT_PHOTOGRAPHS_H_

#include <string>

#include "reports/figures/figure.h"

namespace simbench::reports {

// In points of the picture.
int photographs_height(const Figure& figure);

// After the terminal and the output; ends the picture. `title` is quoted for gnuplot.
std::string photographs_script(const Figure& figure, const std::string& title);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_FIGURES_GNUPLOT_PHOTOGRAPHS_H_
