// Pieces of HTML from unchecked text: names, paths, messages.
//
//   html_escaped("a < b & \"c\"")   "a &lt; b &amp; &quot;c&quot;", for content and attributes
//   script_safe(json)               JSON in which no HTML parser finds the end of a script
#ifndef SIMBENCH_REPORTS_TEXT_HTML_TEXT_H_
#define SIMBENCH_REPORTS_TEXT_HTML_TEXT_H_

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace simbench::reports {

std::string html_escaped(std::string_view text);

// In JSON '<' stands in strings only, where an escape means the same.
std::string script_safe(std::string_view json);

// Replaces each {{name}} of a template by its value, which is not searched again. A name without a
// value is a programming error.
std::string filled(std::string_view page,
                   const std::vector<std::pair<std::string_view, std::string>>& values);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_TEXT_HTML_TEXT_H_
