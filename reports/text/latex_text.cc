// The LaTeX of a document (reports/text/block.h).
//
// Tables fit the text of the class article at 10, 11 and 12 pt, on A4 and Letter: columns that do
// not fit go into further parts, each with the key columns; words go into lines of a column that
// wraps, and a table of more lines than a page has is a longtable.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <boost/algorithm/string/split.hpp>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <utility>

#include "reports/text/block.h"
#include "reports/text/escaped_text.h"
#include "reports/text/table_parts.h"

namespace simbench::reports {
namespace {

// Widths are in points at 10 pt, where \footnotesize is 8 pt and a line of text 345 pt. At 12 pt
// letters grow by a factor of 1.176 and the line by 1.13: what fits there fits everywhere.
constexpr std::size_t kLatexLine = 330;
constexpr std::size_t kLatexGap = 8;      // between columns: twice \tabcolsep
constexpr std::size_t kLatexWraps = 110;  // a wider column of text wraps
constexpr std::size_t kLatexNarrow = 90;  // and is at least so wide
constexpr double kLatexEm = 8.5;
constexpr std::size_t kLinesOfAPage = 38;
constexpr std::size_t kLongWord = 16;  // letters; such a word may be broken

// Widths of ' ' to '~' in Computer Modern, in thousandths of an em.
constexpr std::array<int, 95> kLetters = {
    333, 278, 500, 833, 500, 833, 778, 278,  389, 389, 500, 778, 278, 333, 278, 500,  // to '/'
    500, 500, 500, 500, 500, 500, 500, 500,  500, 500, 278, 278, 778, 778, 778, 472,  // to '?'
    778, 750, 708, 722, 764, 681, 653, 785,  750, 361, 514, 778, 625, 917, 750, 778,  // to 'O'
    681, 778, 736, 556, 722, 750, 750, 1028, 750, 750, 611, 278, 500, 278, 611, 500,  // to '_'
    500, 500, 556, 444, 556, 444, 306, 500,  556, 278, 306, 528, 278, 833, 556, 500,  // to 'o'
    556, 528, 392, 394, 389, 556, 528, 722,  528, 528, 444, 500, 278, 500, 611};      // to '~'
constexpr int kOtherLetter = 800;

std::size_t latex_width(std::string_view text) {
  int thousandths = 0;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool is_continued = byte >= 0x80 && byte < 0xc0;  // of a letter of several bytes
    if (byte >= ' ' && byte <= '~') {
      thousandths += kLetters[byte - static_cast<unsigned char>(' ')];
    } else if (!is_continued) {
      thousandths += kOtherLetter;
    }
  }
  return static_cast<std::size_t>(std::ceil(kLatexEm * thousandths / 1000));
}

// Escaped; a word that no line may have room for can be broken behind its punctuation.
std::string latex_prose(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    const bool is_long = end > kLongWord;
    for (std::size_t from = 0; from < end;) {
      const std::size_t at = is_long ? text.find_first_of("_/.,=+-:;", from) : end;
      const std::size_t next = std::min(at == std::string_view::npos ? end : at + 1, end);
      out += latex_escaped(text.substr(from, next - from));
      if (next < end) out += "\\allowbreak{}";
      from = next;
    }
    if (end < text.size()) out += ' ';
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return out;
}

struct LatexColumn {
  Align align = Align::kLeft;
  bool wraps = false;
  std::size_t width = 0;    // what it needs at least
  std::size_t natural = 0;  // in one line
};

std::vector<std::string> header_lines(const Column& column) {
  std::vector<std::string> lines;
  boost::split(lines, column.header, [](char c) { return c == '\n'; });
  return lines;
}

std::vector<LatexColumn> latex_columns(const Table& table) {
  std::vector<LatexColumn> columns;
  columns.reserve(table.columns.size());
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    LatexColumn made{.align = table.columns[c].align};
    for (const std::string& line : header_lines(table.columns[c])) {
      made.natural = std::max(made.natural, latex_width(line));
    }
    for (const auto& row : table.rows) made.natural = std::max(made.natural, latex_width(row[c]));
    made.wraps = made.natural > kLatexWraps && made.align == Align::kLeft;
    made.width = made.wraps ? kLatexNarrow : made.natural;
    columns.push_back(made);
  }
  return columns;
}

// Gives columns that wrap what is left of the line, the narrowest first.
void widen_wrapped(std::vector<LatexColumn>& part) {
  std::size_t used = kLatexGap * part.size();
  for (const LatexColumn& column : part) used += column.width;
  for (; used < kLatexLine; ++used) {
    LatexColumn* narrowest = nullptr;
    for (LatexColumn& column : part) {
      const bool takes = column.wraps && column.width < column.natural;
      if (takes && (narrowest == nullptr || column.width < narrowest->width)) narrowest = &column;
    }
    if (narrowest == nullptr) return;
    ++narrowest->width;
  }
}

std::string column_specification(const LatexColumn& column) {
  if (!column.wraps) return column.align == Align::kLeft ? "l" : "r";
  return fmt::format(">{{\\raggedright\\arraybackslash}}p{{{:.1f}em}}",
                     static_cast<double>(column.width) / kLatexEm);
}

// Sets a minus where a number has one.
std::string latex_cell(const std::string& text, bool wraps) {
  const bool is_negative = text.size() > 1 && text[0] == '-' && text[1] >= '0' && text[1] <= '9';
  const std::string_view shown = std::string_view{text}.substr(is_negative ? 1 : 0);
  return (is_negative ? "$-$" : "") + (wraps ? latex_prose(shown) : latex_escaped(shown));
}

// After the end of a row a bracket would be its optional argument, and a star a part of it.
std::string latex_row(const std::vector<std::string>& cells) {
  const bool is_argument = cells.front().starts_with('[') || cells.front().starts_with('*');
  return fmt::format("    {}{} \\\\\n", is_argument ? "{}" : "", fmt::join(cells, " & "));
}

// Some columns of a table, as far as they fit a page together.
struct LatexPart {
  std::vector<std::size_t> of_table{};  // the columns' places
  std::vector<LatexColumn> columns{};
};

std::vector<LatexPart> latex_parts(const Table& table) {
  const std::vector<LatexColumn> columns = latex_columns(table);
  std::vector<std::size_t> widths;
  widths.reserve(columns.size());
  for (const LatexColumn& column : columns) widths.push_back(column.width);
  std::vector<LatexPart> parts;
  for (auto& chosen : column_parts(widths, table.key_columns, kLatexGap, kLatexLine - kLatexGap)) {
    LatexPart part{.of_table = std::move(chosen)};
    for (const std::size_t c : part.of_table) part.columns.push_back(columns[c]);
    widen_wrapped(part.columns);
    parts.push_back(std::move(part));
  }
  return parts;
}

// The rows of the header, whose last lines stand in one row.
std::vector<std::string> latex_header(const Table& table, const LatexPart& part) {
  std::vector<std::vector<std::string>> lines;
  std::size_t height = 1;
  for (const std::size_t c : part.of_table) {
    lines.push_back(header_lines(table.columns[c]));
    height = std::max(height, lines.back().size());
  }
  std::vector<std::string> rows;
  for (std::size_t row = 0; row < height; ++row) {
    std::vector<std::string> cells;
    cells.reserve(lines.size());
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const std::size_t missing = height - lines[i].size();
      cells.push_back(row < missing ? ""
                                    : latex_cell(lines[i][row - missing], part.columns[i].wraps));
    }
    rows.push_back(latex_row(cells));
  }
  return rows;
}

struct LatexRows {
  std::string text{};
  std::size_t lines = 0;  // on the page, about
};

LatexRows latex_rows(const Table& table, const LatexPart& part) {
  LatexRows rows;
  for (const std::vector<std::string>& row : table.rows) {
    std::vector<std::string> cells;
    cells.reserve(part.of_table.size());
    std::size_t height = 1;
    for (std::size_t i = 0; i < part.of_table.size(); ++i) {
      const std::string& text = row[part.of_table[i]];
      const LatexColumn& column = part.columns[i];
      cells.push_back(latex_cell(text, column.wraps));
      if (column.wraps) height = std::max(height, 1 + latex_width(text) / column.width);
    }
    rows.text += latex_row(cells);
    rows.lines += height;
  }
  return rows;
}

std::string latex_part(const Table& table, const LatexPart& part, const std::string& caption) {
  std::string columns;
  for (const LatexColumn& column : part.columns) columns += column_specification(column);
  const std::vector<std::string> header = latex_header(table, part);
  const std::string head = fmt::format("{}", fmt::join(header, ""));
  const LatexRows rows = latex_rows(table, part);
  if (rows.lines + header.size() <= kLinesOfAPage) {
    return fmt::format(
        "\\begin{{table}}[!htbp]\n  \\centering\n  \\footnotesize\n"
        "  \\setlength{{\\tabcolsep}}{{4pt}}\n{}  \\begin{{tabular}}{{{}}}\n    \\toprule\n{}"
        "    \\midrule\n{}    \\bottomrule\n  \\end{{tabular}}\n\\end{{table}}\n",
        caption.empty() ? "" : fmt::format("  \\caption{{{}}}\n", caption), columns, head,
        rows.text);
  }
  return fmt::format(
      "{{\\footnotesize\\setlength{{\\tabcolsep}}{{4pt}}\n  \\begin{{longtable}}{{{1}}}\n{0}"
      "    \\toprule\n{2}    \\midrule\n    \\endfirsthead\n"
      "    \\toprule\n{2}    \\midrule\n    \\endhead\n    \\bottomrule\n    \\endfoot\n{3}"
      "  \\end{{longtable}}}}\n",
      caption.empty() ? "" : fmt::format("    \\caption{{{}}} \\\\\n", caption), columns, head,
      rows.text);
}

std::string latex_table(const Table& table, const std::string& heading) {
  const std::vector<LatexPart> parts = latex_parts(table);
  std::string out;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    std::string caption = latex_prose(heading);
    if (parts.size() > 1) {
      caption += fmt::format("{}part {} of {}", caption.empty() ? "" : ", ", i + 1, parts.size());
    }
    out += (i > 0 ? "\n" : "") + latex_part(table, parts[i], caption);
  }
  return out;
}

std::string latex_block(const Block& block) {
  std::string out;
  if (block.table) {
    out += "\n" + latex_table(printable(*block.table), block.heading);
  } else if (!block.heading.empty()) {
    out += fmt::format("\n\\paragraph{{{}}}\n", latex_prose(block.heading));
  }
  for (const std::string& text : block.prose) out += "\n" + latex_prose(text) + "\n";
  if (block.items.empty()) return out;
  out += "\n\\begin{itemize}\n";
  // The braces keep an item that begins with '[' from being a label.
  for (const std::string& item : block.items) {
    out += fmt::format("  \\item {{}}{}\n", latex_prose(item));
  }
  return out + "\\end{itemize}\n";
}

}  // namespace

std::string latex(const Document& raw) {
  const Document document = printable(raw);
  std::string out =
      "% Needs \\usepackage{array,booktabs,longtable}. Fits the class article in one column.\n"
      "{\\sloppy\n";
  if (!document.title.empty()) {
    out += fmt::format("\\subsection*{{{}}}\n", latex_prose(document.title));
  }
  for (const std::string& text : document.head) out += "\n" + latex_prose(text) + "\n";
  for (const Block& block : document.blocks) out += latex_block(block);
  return out + "\\par}\n";
}

}  // namespace simbench::reports
