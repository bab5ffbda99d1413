// Unchecked text (names, paths, messages) as each format writes it. What a reader would obey
// instead of show stands as \xHH (printable_name() of recording/text_fields.h) in all but LaTeX,
// whose documents are escaped as a whole (reports/text/block.h). Cells of a CSV: csv_cell() there.
//
//   html_escaped("a < b & \"c\"")   "a &lt; b &amp; &quot;c&quot;", for content and attributes
//   latex_escaped("50 %_a")         "50 \%\_a"
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace simbench::reports {

// Also for XML 1.0.
std::string html_escaped(std::string_view text);

// Text with the special characters of LaTeX escaped. Every other character stays, in UTF-8, which
// LaTeX reads since 2018.
std::string latex_escaped(std::string_view text);

// JSON in which no HTML parser finds the end of a script, and no reader of the page's source obeys
// anything: '<' and such characters stand in strings only, where an escape means the same.
std::string script_safe(std::string_view json);

// Replaces each {{name}} of a template by its value, which is not searched again. A name without a
// value is a programming error.
std::string filled(std::string_view page,
                   const std::vector<std::pair<std::string_view, std::string>>& values);

}  // namespace simbench::reports
