// A figure as tidy CSV: one line for each point, to be drawn by whatever the reader likes.
//
//   panel,series,x,y
//   Sensor stamp,camera 0,225,22.222
//
// A gap has an empty y; where categories stand on the x axis, x is the category. A published value
// or the like is a series of one point without x (or y, if it is vertical), a shaded stretch one of
// two points without y. Photographs: the pipeline as the panel, the camera as the series, what is
// read as x, its share as y.
#ifndef SIMBENCH_REPORTS_FIGURES_FIGURE_CSV_H_
#define SIMBENCH_REPORTS_FIGURES_FIGURE_CSV_H_

#include <string>

#include "reports/figures/figure.h"

namespace simbench::reports {

std::string figure_csv(const Figure& figure);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_FIGURES_FIGURE_CSV_H_
