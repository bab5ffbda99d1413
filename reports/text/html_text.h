// Pieces of HTML from text that nobody has checked: names, paths, messages.
//
//   html_escaped("a < b & \"c\"")   "a &lt; b &amp; &quot;c&quot;", for content and attributes
//   script_safe(json)               JSON that no parser of HTML takes for an end of the script
#ifndef SIMBENCH_REPORTS_TEXT_HTML_TEXT_H_
#define SIMBENCH_REPORTS_TEXT_HTML_TEXT_H_

#include <cstdint>
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

// A table in a box of its own that scrolls sideways where the page is too narrow.
class HtmlTable {
 public:
  enum class Align : std::uint8_t { kLeft, kRight };
  struct Column {
    std::string header;
    Align align = Align::kRight;
  };

  HtmlTable(std::string caption, std::vector<Column> columns)
      : caption_(std::move(caption)), columns_(std::move(columns)) {}
  // As many cells as there are columns; the first one names the row. Plain text.
  void add(const std::vector<std::string>& cells);
  bool empty() const { return rows_.empty(); }
  std::string html() const;

 private:
  std::string caption_;
  std::vector<Column> columns_;
  std::string rows_;
};

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_TEXT_HTML_TEXT_H_
