// The content of a report as plain data, and its four renderings: text for a terminal, Markdown,
// LaTeX, HTML. A report builds blocks once; no renderer chooses columns, cells or sentences, so
// terminal and page cannot differ.
//
//   Document document{.title = "sample: 2 seeds"};
//   Block block{.heading = "The paper's metrics", .table = Table({{"pipeline", Align::kLeft},
//                                                                 {"AMD\nmedian ms"}})};
//   block.table->add({"oracle", "0.012"});
//   document.blocks.push_back(block);
//   std::cout << plain(document);
//
// A header may have several lines ('\n'); Markdown and HTML join them by blanks. Headers and cells
// are text, which renderers escape: what a terminal would obey, plain text and Markdown show as
// \xHH, and so does LaTeX. Plain cells count as ASCII: their width is their length. Every line ends
// with '\n', none with a blank.
//
// Plain text is laid out for the page of reports/text/plain_text.h. A table wider than the page is
// divided into parts, each with the key columns first; long prose in cells wraps. Only a word wider
// than the page exceeds it. The others have no page.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "reports/text/sparkline.h"

namespace simbench::reports {

enum class Align : std::uint8_t { kLeft, kRight };

struct Column {
  std::string header;
  Align align = Align::kRight;
  std::string legend{};     // its meaning; a tooltip in HTML
  bool is_verdict = false;  // better, worse, a limit: coloured by its words where colour is wanted
};

struct Table {
  // The first `keys` columns identify a row: every part of a wide table repeats them.
  explicit Table(std::vector<Column> its_columns, std::size_t keys = 1)
      : columns(std::move(its_columns)), key_columns(keys) {}
  // As many cells as there are columns.
  void add(std::vector<std::string> cells);

  std::vector<Column> columns;
  std::size_t key_columns;
  std::vector<std::vector<std::string>> rows{};
  // Pictures behind the texts of some columns, one for each row; only HTML shows them.
  std::map<std::size_t, std::vector<Sparkline>> sparklines{};
};

// A column, and its cell for a row about a `Subject`.
template <class Subject>
struct Field {
  Column column;
  std::function<std::string(const Subject&)> cell;
  std::function<Sparkline(const Subject&)> sparkline{};
};

// The column of a row's pipeline, a key of most tables.
template <class Row>
Field<Row> pipeline_field() {
  return {{"pipeline", Align::kLeft}, &Row::pipeline};
}

template <class Subject>
const Subject& subject_of(const Subject& subject) {
  return subject;
}
template <class Subject>
const Subject& subject_of(const Subject* subject) {
  return *subject;
}

// `subjects`: a list of them, or of their addresses.
template <class Subject, class Subjects>
Table table_of(const std::vector<Field<Subject>>& fields, const Subjects& subjects,
               std::size_t keys = 1) {
  std::vector<Column> columns;
  columns.reserve(fields.size());
  for (const Field<Subject>& field : fields) columns.push_back(field.column);
  Table table(std::move(columns), keys);
  for (const auto& each : subjects) {
    const Subject& subject = subject_of<Subject>(each);
    std::vector<std::string> cells;
    cells.reserve(fields.size());
    for (const Field<Subject>& field : fields) cells.push_back(field.cell(subject));
    table.add(std::move(cells));
    for (std::size_t i = 0; i < fields.size(); ++i) {
      if (fields[i].sparkline) table.sparklines[i].push_back(fields[i].sparkline(subject));
    }
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

// Adds a block that there may be.
void add(std::optional<Block> block, std::vector<Block>& blocks);

struct Document {
  std::string title{};
  std::vector<std::string> head{};  // paragraphs
  std::vector<Block> blocks{};
};

std::string plain(const Table& table);
std::string plain(const Document& document);

std::string markdown(const Table& table);
std::string markdown(const Document& document);

// Text of a document of the reader's own, whose first line has the packages that it needs: a table
// environment for each table, with the block's heading as its caption; lines of a header are rows.
// A table that is wider than the text of the class article is divided into parts, each with the key
// columns first, and words of its text wrap; one that is longer than a page is a longtable.
std::string latex(const Document& document);

// What a terminal would obey, as \xHH: names may come from a file that anyone wrote. A document's
// without its tables.
Table printable(Table table);
Document printable(Document document);

// The document with these columns of its tables alone, by their headings in one line ("AMD
// median"), beside the key columns; a table that has none of them is left out. No names: all of it.
// Throws scenarios::InputError for a name that no table has.
Document with_columns(Document document, const std::vector<std::string>& names);
// The names for all that drawn_as() draws. Not while another thread prints.
void set_table_columns(std::vector<std::string> names);

// The document as `--format` says: "markdown", "latex", "html", else plain.
std::string drawn_as(const std::string& format, const Document& document);

// `caption`: for screen readers.
std::string html(const Table& table, const std::string& caption);
// A <section>. The page itself has a document's title and head.
std::string html(const Block& block);
std::string html(const std::vector<Block>& blocks);
// The head as paragraphs and the blocks: a part of a page, without the title.
std::string html(const Document& document);

}  // namespace simbench::reports
