// Pieces of HTML from text that nobody has checked: names, paths, messages.
//
//   html_escaped("a < b & \"c\"")   "a &lt; b &amp; &quot;c&quot;", for content and attributes
//   script_safe(json)               JSON that no parser of HTML takes for an end of the script
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

// A template's {{name}} replaced by its value; what is put in is not searched again. A name without
// a value is a programming error.
std::string filled(std::string_view page,
                   const std::vector<std::pair<std::string_view, std::string>>& values);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_TEXT_HTML_TEXT_H_
