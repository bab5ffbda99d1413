// Text in LaTeX.
#ifndef SIMBENCH_REPORTS_TEXT_LATEX_TEXT_H_
#define SIMBENCH_REPORTS_TEXT_LATEX_TEXT_H_

#include <string>
#include <string_view>

namespace simbench::reports {

// Text with its special characters as LaTeX writes them: "50 %_a" is "50 \%\_a". Every other
// character stays, in UTF-8, which LaTeX reads since 2018.
std::string latex_escaped(std::string_view text);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_TEXT_LATEX_TEXT_H_
