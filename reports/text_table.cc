#include "reports/text_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

#include "algorithms/ports/assert.h"

namespace simbench::reports {
namespace {

constexpr const char* kGap = "  ";

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::size_t begin = 0;
  for (std::size_t end = 0; end != std::string::npos; begin = end + 1) {
    end = text.find('\n', begin);
    lines.push_back(text.substr(begin, end == std::string::npos ? end : end - begin));
  }
  return lines;
}

std::string pad(const std::string& text, std::size_t width, Align align) {
  const std::string blanks(width - std::min(width, text.size()), ' ');
  return align == Align::kLeft ? text + blanks : blanks + text;
}

std::string end_line(std::string line) {
  line.erase(line.find_last_not_of(' ') + 1);
  return line + "\n";
}

std::string markdown_cell(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  std::string escaped;
  for (const char c : text) escaped += c == '|' ? std::string("\\|") : std::string(1, c);
  return escaped;
}

}  // namespace

void TextTable::add(std::vector<std::string> cells) {
  SIMBENCH_ASSERT(cells.size() == columns_.size(), "a row has a cell for every column");
  rows_.push_back(std::move(cells));
}

std::string TextTable::plain() const {
  std::vector<std::size_t> widths;
  std::vector<std::vector<std::string>> headers;
  std::size_t header_height = 0;
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    headers.push_back(lines_of(columns_[c].header));
    header_height = std::max(header_height, headers[c].size());
    std::size_t width = 0;
    for (const std::string& line : headers[c]) width = std::max(width, line.size());
    for (const auto& row : rows_) width = std::max(width, row[c].size());
    widths.push_back(width);
  }
  std::string out;
  for (std::size_t i = 0; i < header_height; ++i) {
    std::string line;
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      // Headers stand on the line above the cells: the short ones are filled up at the top.
      const std::size_t missing = header_height - headers[c].size();
      const std::string text = i < missing ? "" : headers[c][i - missing];
      line += (c ? kGap : "") + pad(text, widths[c], columns_[c].align);
    }
    out += end_line(line);
  }
  std::string rule;
  for (std::size_t c = 0; c < widths.size(); ++c) {
    rule += (c ? kGap : "") + std::string(widths[c], '-');
  }
  out += end_line(rule);
  for (const auto& row : rows_) {
    std::string line;
    for (std::size_t c = 0; c < row.size(); ++c) {
      line += (c ? kGap : "") + pad(row[c], widths[c], columns_[c].align);
    }
    out += end_line(line);
  }
  return out;
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
  const std::string margin(indent, ' ');
  std::string out;
  std::string line;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    const std::string_view word = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (word.empty()) continue;
    if (!line.empty() && indent + line.size() + 1 + word.size() > kTextWidth) {
      out += fmt::format("{}{}\n", margin, line);
      line.clear();
    }
    line += fmt::format("{}{}", line.empty() ? "" : " ", word);
  }
  return line.empty() ? out : out + fmt::format("{}{}\n", margin, line);
}

}  // namespace simbench::reports
