#include "reports/text/text_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

#include "algorithms/ports/assert.h"
#include "reports/text/table_layout.h"

namespace simbench::reports {
namespace {

std::optional<std::size_t> the_page_width;

std::string markdown_cell(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  std::string escaped;
  for (const char c : text) escaped += c == '|' ? std::string("\\|") : std::string(1, c);
  return escaped;
}

// Breaks one line; blanks between words stay as they are, but at the end of a line.
void append_broken(std::string& out, std::string_view line, std::size_t width) {
  constexpr std::size_t kDeeper = 2;
  const std::size_t indent = std::min(line.find_first_not_of(' '), line.size());
  std::size_t margin = 0;
  while (margin + line.size() > width) {
    const std::size_t first = std::min(line.find_first_not_of(' '), line.size());
    const std::size_t room = width - std::min(width, margin);
    std::size_t at = line.rfind(' ', room);
    if (at == std::string_view::npos || at < first) at = line.find(' ', std::max(first, room));
    if (at == std::string_view::npos) break;
    const std::string_view part = line.substr(0, line.find_last_not_of(' ', at) + 1);
    out += fmt::format("{:{}}{}\n", "", margin, part);
    line.remove_prefix(std::min(line.find_first_not_of(' ', at), line.size()));
    margin = std::min(indent + kDeeper, width / 2);
  }
  out += fmt::format("{:{}}{}", "", margin, line);
}

}  // namespace

void set_page_width(std::optional<std::size_t> columns) { the_page_width = columns; }

std::optional<std::size_t> page_width() { return the_page_width; }

void TextTable::add(std::vector<std::string> cells) {
  SIMBENCH_ASSERT(cells.size() == columns_.size(), "a row has a cell for every column");
  rows_.push_back(std::move(cells));
}

std::string TextTable::plain() const {
  return laid_out(columns_, rows_, {.width = the_page_width, .key_columns = key_columns_});
}

std::string TextTable::markdown() const {
  std::string out = "|";
  for (const Column& column : columns_) out += fmt::format(" {} |", markdown_cell(column.header));
  out += "\n|";
  for (const Column& column : columns_) out += column.align == Align::kLeft ? "---|" : "---:|";
  out += "\n";
  for (const auto& row : rows_) {
    out += "|";
    for (const std::string& cell : row) out += fmt::format(" {} |", markdown_cell(cell));
    out += "\n";
  }
  return out;
}

std::string wrapped(std::string_view text, std::size_t indent) {
  const std::size_t width = std::min(kTextWidth, the_page_width.value_or(kTextWidth));
  const std::string margin(indent, ' ');
  std::string out;
  for (const std::string& line : words_in_lines(text, width - std::min(width, indent))) {
    out += fmt::format("{}{}\n", margin, line);
  }
  return out;
}

std::string fitted(std::string_view text) {
  if (!the_page_width) return std::string(text);
  std::string out;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    append_broken(out, text.substr(0, end), *the_page_width);
    if (end < text.size()) out += '\n';
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return out;
}

}  // namespace simbench::reports
