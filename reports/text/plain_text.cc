#include "reports/text/plain_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <string_view>
#include <utility>

#include "recording/text_fields.h"
#include "reports/text/block.h"
#include "reports/text/table_parts.h"

namespace simbench::reports {
namespace {

using Lines = std::vector<std::string>;
using Rows = std::vector<std::vector<std::string>>;

std::optional<std::size_t> the_page_width;
bool the_page_colour = false;

constexpr std::size_t kGap = 2;
constexpr std::size_t kNarrowest = 12;
// ECMA-48's escapes.
constexpr const char* kGreenText = "\x1b[32m";
constexpr const char* kRedText = "\x1b[31m";
constexpr const char* kCyanText = "\x1b[36m";
constexpr const char* kUncoloured = "\x1b[0m";

// A column of the table and its width in a part.
struct Slot {
  std::size_t column;
  std::size_t width;
};
using Part = std::vector<Slot>;

Lines text_lines(const std::string& text) {
  Lines lines;
  std::size_t begin = 0;
  for (std::size_t end = 0; end != std::string::npos; begin = end + 1) {
    end = text.find('\n', begin);
    lines.push_back(text.substr(begin, end == std::string::npos ? end : end - begin));
  }
  return lines;
}

std::size_t widest(const Lines& lines) {
  std::size_t width = 0;
  for (const std::string& line : lines) width = std::max(width, line.size());
  return width;
}

// The escape of what a verdict's first word says; "" for none.
const char* verdict_colour(std::string_view verdict) {
  struct Words {
    const char* escape = "";
    std::initializer_list<std::string_view> words;
  };
  static const Words words[] = {{kGreenText, {"better", "best", "inside", "yes", "passed"}},
                                {kRedText, {"worse", "possibly worse", "outside", "no", "FAILED"}},
                                {kCyanText, {"limit", "reference"}}};
  const std::string_view said = verdict.substr(0, verdict.find_first_of(",:("));
  for (const Words& each : words) {
    if (std::ranges::find(each.words, said) != each.words.end()) return each.escape;
  }
  return "";
}

// The colour's escape with which the text begins; empty if it begins with none of the page's.
std::string_view colour_at(std::string_view text) {
  for (const std::string_view own : {kGreenText, kRedText, kCyanText, kUncoloured}) {
    if (text.starts_with(own)) return own;
  }
  return {};
}

// The cell, coloured where it is a verdict and colour is wanted, between its blanks.
std::string coloured(std::string padded, const std::string& text, const Column& column) {
  const char* const escape = the_page_colour && column.is_verdict ? verdict_colour(text) : "";
  if (*escape == '\0') return padded;
  const std::size_t at = padded.find(text);
  padded.insert(at + text.size(), kUncoloured);
  return padded.insert(at, escape);
}

std::string pad(const std::string& text, std::size_t width, Align align) {
  const std::string blanks(width - std::min(width, text.size()), ' ');
  return align == Align::kLeft ? text + blanks : blanks + text;
}

// The width of a column: natural, and narrowed as far as possible.
struct ColumnWidth {
  std::size_t natural = 0;
  std::size_t least = 0;
};

ColumnWidth need_of(const Column& column, std::size_t index, const Rows& rows) {
  ColumnWidth need;
  need.natural = need.least = widest(text_lines(column.header));
  for (const auto& row : rows) {
    const std::string& cell = row[index];
    need.natural = std::max(need.natural, cell.size());
    const std::size_t least = cell.size() <= kProseWidth
                                  ? cell.size()
                                  : std::max(kProseWidth, widest(words_in_lines(cell, 0)));
    need.least = std::max(need.least, least);
  }
  return need;
}

std::size_t width_of(const Part& part) {
  std::size_t width = kGap * (part.size() - 1);
  for (const Slot& slot : part) width += slot.width;
  return width;
}

// Widens narrowed columns to the page's width, the narrowest first, so that the widest lose most.
void widen(Part& part, const std::vector<ColumnWidth>& needs, std::size_t page_width) {
  const std::size_t used = width_of(part);
  for (std::size_t left = page_width - std::min(page_width, used); left > 0; --left) {
    Slot* narrowest = nullptr;
    for (Slot& slot : part) {
      if (slot.width < needs[slot.column].natural &&
          (narrowest == nullptr || slot.width < narrowest->width)) {
        narrowest = &slot;
      }
    }
    if (narrowest == nullptr) return;
    ++narrowest->width;
  }
}

// If even one column does not fit beside the keys, only its longest words exceed it.
void narrow_last(Part& part, std::size_t page_width) {
  const std::size_t used = width_of(part);
  if (used <= page_width) return;
  std::size_t& width = part.back().width;
  width -= std::min(used - page_width, width - std::min(width, kNarrowest));
}

std::vector<Part> parts_of(const std::vector<ColumnWidth>& needs, std::size_t key_columns) {
  Part all;
  for (std::size_t c = 0; c < needs.size(); ++c) all.push_back({c, needs[c].natural});
  if (!the_page_width || all.empty() || width_of(all) <= *the_page_width) return {all};
  const std::size_t page = *the_page_width;
  std::vector<std::size_t> widths;
  widths.reserve(needs.size());
  for (const ColumnWidth& need : needs) widths.push_back(need.least);
  std::vector<Part> parts;
  for (const std::vector<std::size_t>& columns : column_parts(widths, key_columns, kGap, page)) {
    Part& part = parts.emplace_back();
    for (const std::size_t c : columns) part.push_back({c, needs[c].least});
  }
  for (Part& part : parts) {
    widen(part, needs, page);
    narrow_last(part, page);
  }
  return parts;
}

// Cells side by side, each of one line or more; short ones have empty lines at the top (headers) or
// at the bottom.
std::string side_by_side(const std::vector<Lines>& cells, const Part& part,
                         const std::vector<Column>& columns, bool fill_top) {
  std::size_t height = 0;
  for (const Lines& cell : cells) height = std::max(height, cell.size());
  std::string out;
  for (std::size_t i = 0; i < height; ++i) {
    std::string line;
    for (std::size_t s = 0; s < part.size(); ++s) {
      const std::size_t missing = fill_top ? height - cells[s].size() : 0;
      const bool there = i >= missing && i - missing < cells[s].size();
      if (s > 0) line.append(kGap, ' ');
      const Column& column = columns[part[s].column];
      const std::string text = there ? cells[s][i - missing] : "";
      line += coloured(pad(text, part[s].width, column.align), text, column);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    out.append(line).append("\n");
  }
  return out;
}

std::string part_text(const Part& part, const std::vector<Column>& columns, const Rows& rows) {
  std::vector<Lines> cells;
  std::vector<Lines> rule;
  for (const Slot& slot : part) {
    cells.push_back(text_lines(columns[slot.column].header));
    rule.push_back({std::string(slot.width, '-')});
  }
  std::string out = side_by_side(cells, part, columns, true);
  out += side_by_side(rule, part, columns, false);
  for (const auto& row : rows) {
    for (std::size_t s = 0; s < part.size(); ++s) {
      const std::string& cell = row[part[s].column];
      cells[s] = cell.size() <= part[s].width ? Lines{cell} : words_in_lines(cell, part[s].width);
    }
    out += side_by_side(cells, part, columns, false);
  }
  return out;
}

// Breaks one line; blanks between words stay, except at the end of a line.
void append_broken(std::string& out, std::string_view line, std::size_t width) {
  constexpr std::size_t kDeeper = 2;
  const std::size_t indent = std::min(line.find_first_not_of(' '), line.size());
  std::size_t margin = 0;
  // A line of a table, which fits already; its escapes have no width.
  const bool is_coloured = line.find('\x1b') != std::string_view::npos;
  while (!is_coloured && margin + line.size() > width) {
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

void set_page_colour(bool wanted) { the_page_colour = wanted; }

bool page_colour() { return the_page_colour; }

std::string printable_page(std::string_view text) {
  std::string out;
  while (true) {
    const std::size_t escape = the_page_colour ? text.find('\x1b') : std::string_view::npos;
    out += printable_lines(text.substr(0, escape));
    if (escape == std::string_view::npos) return out;
    text.remove_prefix(escape);
    const std::string_view own = colour_at(text);
    out += own.empty() ? printable_name(text.substr(0, 1)) : std::string(own);
    text.remove_prefix(std::max<std::size_t>(own.size(), 1));
  }
}

std::vector<std::string> words_in_lines(std::string_view text, std::size_t width) {
  Lines lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    const std::string_view word = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (word.empty()) continue;
    if (lines.empty() || lines.back().size() + 1 + word.size() > width) {
      lines.emplace_back(word);
    } else {
      lines.back().append(" ").append(word);
    }
  }
  return lines;
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

std::string aligned(const Table& table) {
  std::vector<ColumnWidth> needs;
  needs.reserve(table.columns.size());
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    needs.push_back(need_of(table.columns[c], c, table.rows));
  }
  std::string out;
  for (const Part& part : parts_of(needs, table.key_columns)) {
    out.append(out.empty() ? "" : "\n").append(part_text(part, table.columns, table.rows));
  }
  return out;
}

}  // namespace simbench::reports
