#include "reports/text/block.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "algorithms/ports/assert.h"
#include "recording/text_fields.h"
#include "reports/text/escaped_text.h"
#include "reports/text/plain_text.h"
#include "scenarios/loader.h"

namespace simbench::reports {
namespace {

std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

std::vector<std::string> the_table_columns;

// Nothing if it has none of them.
std::optional<Table> chosen_columns(const Table& table, const std::vector<std::string>& names) {
  std::vector<std::size_t> kept;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    const bool is_named = std::ranges::count(names, one_line(table.columns[c].header)) > 0;
    if (c < table.key_columns || is_named) kept.push_back(c);
  }
  if (kept.size() == table.key_columns) return std::nullopt;
  std::vector<Column> columns;
  columns.reserve(kept.size());
  for (const std::size_t c : kept) columns.push_back(table.columns[c]);
  Table chosen(std::move(columns), table.key_columns);
  for (const std::vector<std::string>& row : table.rows) {
    std::vector<std::string> cells;
    cells.reserve(kept.size());
    for (const std::size_t c : kept) cells.push_back(row[c]);
    chosen.add(std::move(cells));
  }
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const auto pictures = table.sparklines.find(kept[i]);
    if (pictures != table.sparklines.end()) chosen.sparklines[i] = pictures->second;
  }
  return chosen;
}

std::string markdown_cell(const std::string& text) {
  std::string escaped;
  for (const char c : one_line(text)) {
    escaped += c == '|' ? std::string("\\|") : std::string(1, c);
  }
  return escaped;
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

Document with_columns(Document document, const std::vector<std::string>& names) {
  if (names.empty()) return document;
  std::vector<std::string> known;
  for (Block& block : document.blocks) {
    if (!block.table) continue;
    for (std::size_t c = block.table->key_columns; c < block.table->columns.size(); ++c) {
      known.push_back(one_line(block.table->columns[c].header));
    }
    block.table = chosen_columns(*block.table, names);
  }
  for (const std::string& name : names) {
    if (std::ranges::count(known, name) > 0) continue;
    throw scenarios::InputError(
        fmt::format("--table-columns: found '{}', allowed: {}", name, fmt::join(known, ", ")));
  }
  return document;
}

void set_table_columns(std::vector<std::string> names) { the_table_columns = std::move(names); }

std::string drawn_as(const std::string& format, const Document& raw) {
  const Document document = with_columns(raw, the_table_columns);
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
