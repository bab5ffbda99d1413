// Archives side by side in a table of HTML.
#ifndef SIMBENCH_REPORTS_PAGE_HTML_COMPARISON_H_
#define SIMBENCH_REPORTS_PAGE_HTML_COMPARISON_H_

#include <string>
#include <vector>

#include "reports/archive/archive_reader.h"

namespace simbench::reports {

// Median and band of AMD and of the absolute error of every pipeline, archives side by side; empty
// for a single one.
std::string html_comparison(const std::vector<const Archive*>& archives);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_PAGE_HTML_COMPARISON_H_
