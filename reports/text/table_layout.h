// How the cells of a table are set in lines of a page; what TextTable::plain() does.
//
// A table that fits is one block. Else the columns are dealt out in order to as few blocks as they
// need, an empty line between two, each with the key columns first. A column of prose (a cell of
// more than kProseWidth with a blank in it) may be narrowed to that, its cells going on below; as
// much as a block must, its widest first. A single word is never broken, and a column that does not
// fit beside the keys has a block of its own, where its longest words stand out.
#ifndef SIMBENCH_REPORTS_TEXT_TABLE_LAYOUT_H_
#define SIMBENCH_REPORTS_TEXT_TABLE_LAYOUT_H_

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "reports/text/text_table.h"

namespace simbench::reports {

inline constexpr std::size_t kProseWidth = 24;

struct Page {
  std::optional<std::size_t> width = std::nullopt;  // in columns; none: as wide as need be
  std::size_t key_columns = 1;
};

std::string laid_out(const std::vector<Column>& columns,
                     const std::vector<std::vector<std::string>>& rows, const Page& page);

// The words of `text` in lines of at most `width`, one blank between words; a longer word has a
// line of its own. No line for no words.
std::vector<std::string> words_in_lines(std::string_view text, std::size_t width);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_TEXT_TABLE_LAYOUT_H_
