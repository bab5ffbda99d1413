#include "reports/text/block.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <boost/algorithm/string/split.hpp>
#include <utility>

#include "algorithms/ports/assert.h"
#include "recording/collected.h"
#include "recording/text_fields.h"
#include "reports/text/escaped_text.h"
#include "reports/text/plain_text.h"

namespace simbench::reports {
namespace {

std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

std::string markdown_cell(const std::string& text) {
  std::string escaped;
  for (const char c : one_line(text)) {
    escaped += c == '|' ? std::string("\\|") : std::string(1, c);
  }
  return escaped;
}

// Writes what a terminal would obey as \xHH: names may come from a file that anyone wrote.
Table printable(Table table) {
  for (Column& column : table.columns) column.header = printable_lines(column.header);
  for (std::vector<std::string>& row : table.rows) {
    for (std::string& cell : row) cell = printable_name(cell);
  }
  return table;
}

Document printable(Document document) {
  const auto show = [](std::vector<std::string>& texts) {
    for (std::string& text : texts) text = printable_lines(text);
  };
  document.title = printable_name(document.title);
  show(document.head);
  for (Block& block : document.blocks) {
    block.heading = printable_name(block.heading);
    show(block.prose);
    show(block.items);
  }
  return document;
}

// Drops the empty line before the first part of a document.
std::string without_first_break(std::string text) {
  if (text.starts_with('\n')) text.erase(0, 1);
  return text;
}

std::string plain_block(const Block& block) {
  std::string out;
  if (!block.heading.empty()) out += fmt::format("\n{}\n", block.heading);
  if (block.table) out += "\n" + plain(*block.table);
  for (const std::string& text : block.prose) out += "\n" + wrapped(text);
  if ((block.table || !block.prose.empty()) && !block.items.empty()) out += "\n";
  for (const std::string& item : block.items) out += wrapped(item, 2);
  return out;
}

std::string markdown_block(const Block& block, const char* level) {
  std::string out;
  if (!block.heading.empty()) out += fmt::format("\n{} {}\n", level, block.heading);
  if (block.table) out += "\n" + markdown(*block.table);
  for (const std::string& text : block.prose) out += fmt::format("\n{}\n", text);
  if (!block.items.empty()) out += "\n";
  for (const std::string& item : block.items) out += fmt::format("- {}\n", item);
  return out;
}

// Sets a minus where a number has one.
std::string latex_cell(const std::string& text) {
  const bool is_negative = text.size() > 1 && text[0] == '-' && text[1] >= '0' && text[1] <= '9';
  return is_negative ? "$-$" + latex_escaped(text.substr(1)) : latex_escaped(text);
}

// After the end of a row a bracket would be its optional argument, and a star a part of it.
std::string latex_row(const std::vector<std::string>& cells) {
  const bool is_argument = cells.front().starts_with('[') || cells.front().starts_with('*');
  return fmt::format("    {}{} \\\\\n", is_argument ? "{}" : "", fmt::join(cells, " & "));
}

// The rows of the header, whose last lines stand in one row.
std::string latex_header(const Table& table) {
  std::vector<std::vector<std::string>> lines;
  std::size_t rows = 1;
  for (const Column& column : table.columns) {
    lines.emplace_back();
    boost::split(lines.back(), column.header, [](char c) { return c == '\n'; });
    rows = std::max(rows, lines.back().size());
  }
  std::string out;
  for (std::size_t row = 0; row < rows; ++row) {
    std::vector<std::string> cells;
    cells.reserve(lines.size());
    for (const std::vector<std::string>& of_column : lines) {
      const std::size_t missing = rows - of_column.size();
      cells.push_back(row < missing ? "" : latex_cell(of_column[row - missing]));
    }
    out += latex_row(cells);
  }
  return out;
}

std::string latex_table(const Table& raw, const std::string& caption) {
  const Table table = printable(raw);
  std::string columns;
  for (const Column& column : table.columns) columns += column.align == Align::kLeft ? 'l' : 'r';
  std::string rows;
  for (const std::vector<std::string>& row : table.rows) {
    const std::vector<std::string> cells = collected(row, latex_cell);
    rows += latex_row(cells);
  }
  const std::string stated =
      caption.empty() ? "" : fmt::format("  \\caption{{{}}}\n", latex_escaped(caption));
  return fmt::format(
      "\\begin{{table}}\n  \\centering\n  \\footnotesize\n{}  \\begin{{tabular}}{{{}}}\n"
      "    \\toprule\n{}    \\midrule\n{}    \\bottomrule\n  \\end{{tabular}}\n\\end{{table}}\n",
      stated, columns, latex_header(table), rows);
}

std::string latex_block(const Block& block) {
  std::string out;
  if (block.table) {
    out += "\n" + latex_table(*block.table, block.heading);
  } else if (!block.heading.empty()) {
    out += fmt::format("\n\\paragraph{{{}}}\n", latex_escaped(block.heading));
  }
  for (const std::string& text : block.prose) out += "\n" + latex_escaped(text) + "\n";
  if (block.items.empty()) return out;
  out += "\n\\begin{itemize}\n";
  // The braces keep an item that begins with '[' from being a label.
  for (const std::string& item : block.items) {
    out += fmt::format("  \\item {{}}{}\n", latex_escaped(item));
  }
  return out + "\\end{itemize}\n";
}

// Attributes of a header's cell.
std::string attributes(const Column& column) {
  std::string out = column.align == Align::kLeft ? " class=\"text\"" : "";
  if (!column.legend.empty()) out += fmt::format(" title=\"{}\"", html_escaped(column.legend));
  return out;
}

std::string sparkline_of(const Table& table, std::size_t row, std::size_t column) {
  const auto found = table.sparklines.find(column);
  return found == table.sparklines.end() ? "" : svg(found->second[row]);
}

std::string html_row(const Table& table, std::size_t row) {
  const std::vector<std::string>& cells = table.rows[row];
  std::string out = "<tr>";
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::string text = html_escaped(cells[i]);
    const char* const align = table.columns[i].align == Align::kLeft ? " class=\"text\"" : "";
    out += i < table.key_columns
               ? fmt::format("<th scope=\"row\" class=\"text\">{}</th>", text)
               : fmt::format("<td{}>{}{}</td>", align, text, sparkline_of(table, row, i));
  }
  return out + "</tr>\n";
}

}  // namespace

void add(std::optional<Block> block, std::vector<Block>& blocks) {
  if (block) blocks.push_back(std::move(*block));
}

void Table::add(std::vector<std::string> cells) {
  SIMBENCH_ASSERT(cells.size() == columns.size(), "a row has a cell for every column");
  rows.push_back(std::move(cells));
}

std::string plain(const Table& table) { return aligned(printable(table)); }

std::string plain(const Document& raw) {
  const Document document = printable(raw);
  std::string out;
  if (!document.title.empty()) out += document.title + "\n";
  for (const std::string& text : document.head) out += wrapped(text);
  for (const Block& block : document.blocks) out += plain_block(block);
  return fitted(without_first_break(std::move(out)));
}

std::string markdown(const Table& raw) {
  const Table table = printable(raw);
  std::string out = "|";
  for (const Column& column : table.columns) {
    out += fmt::format(" {} |", markdown_cell(column.header));
  }
  out += "\n|";
  for (const Column& column : table.columns) {
    out += column.align == Align::kLeft ? "---|" : "---:|";
  }
  out += "\n";
  for (const auto& row : table.rows) {
    out += "|";
    for (const std::string& cell : row) out += fmt::format(" {} |", markdown_cell(cell));
    out += "\n";
  }
  return out;
}

std::string markdown(const Document& raw) {
  const Document document = printable(raw);
  std::string out;
  if (!document.title.empty()) out += fmt::format("## {}\n", document.title);
  for (const std::string& text : document.head) out += fmt::format("\n{}\n", text);
  const char* const level = document.title.empty() ? "##" : "###";
  for (const Block& block : document.blocks) out += markdown_block(block, level);
  return without_first_break(std::move(out));
}

std::string latex(const Document& raw) {
  const Document document = printable(raw);
  std::string out = "% Needs \\usepackage{booktabs}.\n";
  if (!document.title.empty()) {
    out += fmt::format("\\subsection*{{{}}}\n", latex_escaped(document.title));
  }
  for (const std::string& text : document.head) out += "\n" + latex_escaped(text) + "\n";
  for (const Block& block : document.blocks) out += latex_block(block);
  return out;
}

std::string drawn_as(const std::string& format, const Document& document) {
  if (format == "markdown") return markdown(document);
  if (format == "html") return html(document);
  return format == "latex" ? latex(document) : plain(document);
}

std::string html(const Table& table, const std::string& caption) {
  std::string head;
  for (const Column& column : table.columns) {
    head += fmt::format("<th scope=\"col\"{}>{}</th>", attributes(column),
                        html_escaped(one_line(column.header)));
  }
  std::string rows;
  for (std::size_t row = 0; row < table.rows.size(); ++row) rows += html_row(table, row);
  return fmt::format(
      "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"{0}\">\n"
      "<table><caption>{0}</caption>\n<thead><tr>{1}</tr></thead>\n<tbody>\n{2}</tbody></table>"
      "</div>\n",
      html_escaped(caption), head, rows);
}

std::string html(const Block& block) {
  std::string out = block.is_warning ? "<section class=\"warnings\">\n" : "<section>\n";
  if (!block.heading.empty()) out += fmt::format("<h3>{}</h3>\n", html_escaped(block.heading));
  if (block.table) out += html(*block.table, block.heading);
  for (const std::string& text : block.prose) {
    out += fmt::format("<p class=\"legend\">{}</p>\n", html_escaped(text));
  }
  if (!block.items.empty()) {
    std::string items;
    for (const std::string& item : block.items) {
      items += fmt::format("<li>{}</li>\n", html_escaped(item));
    }
    out += fmt::format("<ul{}>\n{}</ul>\n", block.is_warning ? "" : " class=\"legend\"", items);
  }
  return out + "</section>\n";
}

std::string html(const std::vector<Block>& blocks) {
  std::string out;
  for (const Block& block : blocks) out += html(block);
  return out;
}

std::string html(const Document& document) {
  std::string out;
  for (const std::string& text : document.head)
    out += fmt::format("<p>{}</p>\n", html_escaped(text));
  return out + html(document.blocks);
}

}  // namespace simbench::reports
