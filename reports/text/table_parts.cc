#include "reports/text/table_parts.h"

#include <algorithm>
#include <utility>

namespace simbench::reports {
namespace {

using ColumnsOfPart = std::vector<std::size_t>;

// As many columns in a part as fit.
std::vector<ColumnsOfPart> dealt_out(const std::vector<std::size_t>& widths, std::size_t keys,
                                     std::size_t gap, std::size_t page) {
  ColumnsOfPart key_columns;
  std::size_t key_width = 0;
  for (std::size_t c = 0; c < keys; ++c) {
    key_columns.push_back(c);
    key_width += widths[c] + (c > 0 ? gap : 0);
  }
  std::vector<ColumnsOfPart> parts = {key_columns};
  std::size_t used = key_width;
  for (std::size_t c = keys; c < widths.size(); ++c) {
    if (used + gap + widths[c] > page && parts.back().size() > keys) {
      parts.push_back(key_columns);
      used = key_width;
    }
    parts.back().push_back(c);
    used += gap + widths[c];
  }
  return parts;
}

}  // namespace

std::vector<std::vector<std::size_t>> column_parts(const std::vector<std::size_t>& widths,
                                                   std::size_t key_columns, std::size_t gap,
                                                   std::size_t page) {
  const std::size_t keys = std::min(key_columns, widths.size());
  std::vector<ColumnsOfPart> parts = dealt_out(widths, keys, gap, page);
  // As many parts again, now of similar widths.
  for (std::size_t width = page; width > 0; --width) {
    std::vector<ColumnsOfPart> narrower = dealt_out(widths, keys, gap, width);
    if (narrower.size() > parts.size()) break;
    parts = std::move(narrower);
  }
  return parts;
}

}  // namespace simbench::reports
