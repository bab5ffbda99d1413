// The columns of a table that is wider than its page, in parts: in order over as few as possible,
// each with the key columns first, and all of similar widths. A column that does not fit beside the
// keys has a part of its own. Any unit of width.
//
//   column_parts({10, 5, 5, 5}, 1, 2, 24);   // {{0, 1, 2}, {0, 3}}
#pragma once

#include <cstddef>
#include <vector>

namespace simbench::reports {

// `gap`: between two columns.
std::vector<std::vector<std::size_t>> column_parts(const std::vector<std::size_t>& widths,
                                                   std::size_t key_columns, std::size_t gap,
                                                   std::size_t page);

}  // namespace simbench::reports
