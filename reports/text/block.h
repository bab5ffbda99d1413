// What a report says, as plain data, and the three ways to draw it: text for a terminal, Markdown,
// HTML. Whoever has something to report builds blocks once; no renderer decides about columns,
// cells or sentences, so terminal and page cannot differ.
//
//   Document document{.title = "sample: 2 seeds"};
//   Block block{.heading = "The paper's metrics", .table = Table({{"pipeline", Align::kLeft},
//                                                                 {"AMD\nmedian ms"}})};
//   block.table->add({"oracle", "0.012"});
//   document.blocks.push_back(block);
//   std::cout << plain(document);
//
// A header may have several lines ('\n'); Markdown and HTML join them by blanks. Headers and cells
// are text: renderers escape what their format reads. Plain cells are taken for ASCII: their width
// is their length. Every line ends with '\n', none with a blank.
//
// Plain text is laid out for the page of reports/text/plain_text.h. A table wider than the page is
// divided into parts, each with the key columns first; long prose in cells goes on below. Only a
// word wider than the page stands out. Markdown and HTML know no page.
#ifndef SIMBENCH_REPORTS_TEXT_BLOCK_H_
#define SIMBENCH_REPORTS_TEXT_BLOCK_H_

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace simbench::reports {

enum class Align : std::uint8_t { kLeft, kRight };

struct Column {
  std::string header;
  Align align = Align::kRight;
  std::string legend{};  // what it means; HTML shows it when pointed at
};

struct Table {
  // The first `keys` columns say what a row is about: every part of a wide table repeats them.
  explicit Table(std::vector<Column> its_columns, std::size_t keys = 1)
      : columns(std::move(its_columns)), key_columns(keys) {}
  // As many cells as there are columns.
  void add(std::vector<std::string> cells);

  std::vector<Column> columns;
  std::size_t key_columns;
  std::vector<std::vector<std::string>> rows{};
};

// A column, and its cell for a row that is about a `Subject`.
template <class Subject>
struct Field {
  Column column;
  std::function<std::string(const Subject&)> cell;
};

template <class Subject, class Subjects>
Table table_of(const std::vector<Field<Subject>>& fields, const Subjects& subjects,
               std::size_t keys = 1) {
  std::vector<Column> columns;
  columns.reserve(fields.size());
  for (const Field<Subject>& field : fields) columns.push_back(field.column);
  Table table(std::move(columns), keys);
  for (const Subject& subject : subjects) {
    std::vector<std::string> cells;
    cells.reserve(fields.size());
    for (const Field<Subject>& field : fields) cells.push_back(field.cell(subject));
    table.add(std::move(cells));
  }
  return table;
}

// Its parts in this order; each may be missing.
struct Block {
  std::string heading{};
  std::optional<Table> table{};
  std::vector<std::string> prose{};  // paragraphs
  std::vector<std::string> items{};  // a list
  bool is_warning = false;           // HTML sets it apart
};

struct Document {
  std::string title{};
  std::vector<std::string> head{};  // paragraphs
  std::vector<Block> blocks{};
};

std::string plain(const Table& table);
std::string plain(const Document& document);

std::string markdown(const Table& table);
std::string markdown(const Document& document);

// `caption` is for who cannot see the heading above.
std::string html(const Table& table, const std::string& caption);
// A <section>. A document's title and head are the page's own affair.
std::string html(const Block& block);
std::string html(const std::vector<Block>& blocks);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_TEXT_BLOCK_H_
