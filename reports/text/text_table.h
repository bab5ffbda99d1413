// A table of text cells, laid out for a terminal or as markdown.
//
// A header may have several lines ('\n'); in markdown they are joined by spaces. Cells are plain
// ASCII: their width is their length. Every line ends with '\n', none with a blank.
//
//   TextTable t({{"name", Align::kLeft}, {"AMD\nms", Align::kRight}});
//   t.add({"oracle", "0.012"});
//   std::cout << t.plain();
//
// Plain text is laid out for a page, which is as wide as need be until set_page_width() says
// otherwise: the command does so once at its start, for the terminal it prints to. A table wider
// than the page is divided into blocks of columns, each with the key columns first; long prose in
// cells goes on below. Only a word wider than the page stands out. Markdown knows no page.
#ifndef SIMBENCH_REPORTS_TEXT_TEXT_TABLE_H_
#define SIMBENCH_REPORTS_TEXT_TEXT_TABLE_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace simbench::reports {

enum class Align : std::uint8_t { kLeft, kRight };

struct Column {
  std::string header;
  Align align = Align::kRight;
};

class TextTable {
 public:
  // The first `key_columns` say what a row is about: every block repeats them.
  explicit TextTable(std::vector<Column> columns, std::size_t key_columns = 1)
      : columns_(std::move(columns)), key_columns_(key_columns) {}
  // As many cells as there are columns.
  void add(std::vector<std::string> cells);
  std::string plain() const;
  std::string markdown() const;

 private:
  std::vector<Column> columns_;
  std::size_t key_columns_;
  std::vector<std::vector<std::string>> rows_;
};

// The page's width in columns; std::nullopt: as wide as need be. Not for use while another thread
// prints.
void set_page_width(std::optional<std::size_t> columns);
std::optional<std::size_t> page_width();

inline constexpr std::size_t kTextWidth = 140;

// Prose in lines of at most kTextWidth columns, on a narrower page of its width (a longer word has
// a line of its own), each after `indent` blanks and ended by '\n'.
std::string wrapped(std::string_view text, std::size_t indent = 0);

// The text with every line that is wider than the page broken at a blank; what follows stands two
// blanks deeper than its line. Unchanged where the page is as wide as need be.
std::string fitted(std::string_view text);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_TEXT_TEXT_TABLE_H_
