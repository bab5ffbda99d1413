// Figures as the JSON that the report's page draws, small enough to be mailed.
//
//   {"figures": [figures with their panels, series and photographs, names as in figure.h],
//    "columns": [...]}
//
// The x and y of a series are numbers of columns, and equal columns are stored once. A column is
// what takes least room and is exact to 3e-8 of its range (whole numbers: exact):
//
//   {"n", "from", "step"}   equal steps
//   {"min", "unit", "u24"}  min + k unit; k in three bytes, least significant first, in base64;
//                           0xffffff is NaN
//   {"f64"}                 eight bytes each, little endian, in base64: logarithmic axes, and whole
//                           numbers too far apart for three bytes
//
// A curve or cloud with very many points is thinned without hiding an extreme (thinned() of
// reports/figures/figure_parts.h).
#ifndef SIMBENCH_REPORTS_PAGE_HTML_FIGURES_H_
#define SIMBENCH_REPORTS_PAGE_HTML_FIGURES_H_

#include <cstddef>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "reports/figures/figure.h"

namespace simbench::reports {

std::string figures_json(const std::vector<Figure>& figures);

// RFC 4648, with padding.
std::string base64(const std::string& bytes);

// Columns in the order in which they were first asked for, equal ones once.
class HtmlColumns {
 public:
  // The number of the column. `relative`: every value to its own size, not to the range of all.
  std::size_t add(const std::vector<double>& values, bool relative);
  const nlohmann::ordered_json& json() const { return columns_; }

 private:
  nlohmann::ordered_json columns_ = nlohmann::ordered_json::array();
  std::map<std::string, std::size_t> known_;  // by their text
};

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_PAGE_HTML_FIGURES_H_
