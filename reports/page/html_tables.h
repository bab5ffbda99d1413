// The results of an archive as tables of HTML: the same numbers as reports/results/table.h prints.
#ifndef SIMBENCH_REPORTS_PAGE_HTML_TABLES_H_
#define SIMBENCH_REPORTS_PAGE_HTML_TABLES_H_

#include <string>

#include "evaluation/scoring/results.h"

namespace simbench::reports {

// The tables with their headings: the paper's metrics, what only true time can tell, gathering (if
// pipelines differ in it), boards (of a leaderboard), claims, stages, warnings, performance.
// `leaderboard`: /evaluation/table of the scenario is "leaderboard".
std::string html_tables(const evaluation::Results& results, bool leaderboard);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_PAGE_HTML_TABLES_H_
