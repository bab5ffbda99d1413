// A table of text cells, laid out for a terminal or as markdown.
//
// A header may have several lines ('\n'); in markdown they are joined by spaces. Cells are plain
// ASCII: their width is their length. Every line ends with '\n', none with a blank.
//
//   TextTable t({{"name", Align::kLeft}, {"AMD\nms", Align::kRight}});
//   t.add({"oracle", "0.012"});
//   std::cout << t.plain();
#ifndef SIMBENCH_REPORTS_TEXT_TABLE_H_
#define SIMBENCH_REPORTS_TEXT_TABLE_H_

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace simbench::reports {

enum class Align : std::uint8_t { kLeft, kRight };

struct Column {
  std::string header;
  Align align = Align::kRight;
};

class TextTable {
 public:
  explicit TextTable(std::vector<Column> columns) : columns_(std::move(columns)) {}
  // As many cells as there are columns.
  void add(std::vector<std::string> cells);
  std::string plain() const;
  std::string markdown() const;

 private:
  std::vector<Column> columns_;
  std::vector<std::vector<std::string>> rows_;
};

inline constexpr std::size_t kTextWidth = 140;

// Prose in lines of at most kTextWidth columns (a longer word has a line of its own), each after
// `indent` blanks and ended by '\n'.
std::string wrapped(std::string_view text, std::size_t indent = 0);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_TEXT_TABLE_H_
