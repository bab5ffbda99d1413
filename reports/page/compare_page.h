// A comparison as one self-contained HTML file (`simbench compare --html`), and as a part of a
// report of several archives: the verdicts, A and B side by side, their differences seed by seed,
// the table and how to read it.
//
//   const Archive monday = read_archive("monday");
//   file << compare_html(compare_with_baseline(monday, "ntp_last_set", {}),
//                        {"simbench", "compare", "monday", "--with-baseline", "ntp_last_set"});
#pragma once

#include <string>
#include <vector>

#include "reports/comparison/comparison.h"
#include "reports/page/html_page.h"

namespace simbench::reports {

// `command`: argv of what makes the page. The figures of its data are comparison_figures().
HtmlArticle comparison_article(const Comparison& comparison,
                               const std::vector<std::string>& command);

std::string compare_html(const Comparison& comparison, const std::vector<std::string>& command);

}  // namespace simbench::reports
