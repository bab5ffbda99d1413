#include "reports/text/table_layout.h"

#include <algorithm>
#include <utility>

namespace simbench::reports {
namespace {

using Lines = std::vector<std::string>;
using Rows = std::vector<std::vector<std::string>>;

constexpr std::size_t kGap = 2;
constexpr std::size_t kNarrowest = 12;

// Which column of the table, and how wide it is set.
struct Slot {
  std::size_t column;
  std::size_t width;
};
using Block = std::vector<Slot>;

Lines lines_of(const std::string& text) {
  Lines lines;
  std::size_t begin = 0;
  for (std::size_t end = 0; end != std::string::npos; begin = end + 1) {
    end = text.find('\n', begin);
    lines.push_back(text.substr(begin, end == std::string::npos ? end : end - begin));
  }
  return lines;
}

std::size_t widest(const Lines& lines) {
  std::size_t width = 0;
  for (const std::string& line : lines) width = std::max(width, line.size());
  return width;
}

std::string pad(const std::string& text, std::size_t width, Align align) {
  const std::string blanks(width - std::min(width, text.size()), ' ');
  return align == Align::kLeft ? text + blanks : blanks + text;
}

// What a column takes: as it is, and narrowed as far as it may be.
struct Need {
  std::size_t natural = 0;
  std::size_t least = 0;
};

Need need_of(const Column& column, std::size_t index, const Rows& rows) {
  Need need;
  need.natural = need.least = widest(lines_of(column.header));
  for (const auto& row : rows) {
    const std::string& cell = row[index];
    need.natural = std::max(need.natural, cell.size());
    const std::size_t least = cell.size() <= kProseWidth
                                  ? cell.size()
                                  : std::max(kProseWidth, widest(words_in_lines(cell, 0)));
    need.least = std::max(need.least, least);
  }
  return need;
}

std::size_t width_of(const Block& block) {
  std::size_t width = kGap * (block.size() - 1);
  for (const Slot& slot : block) width += slot.width;
  return width;
}

// Widens what was narrowed to what is left of the page: the narrowest first, so that the widest
// give most.
void widen(Block& block, const std::vector<Need>& needs, std::size_t page_width) {
  const std::size_t used = width_of(block);
  for (std::size_t left = page_width - std::min(page_width, used); left > 0; --left) {
    Slot* narrowest = nullptr;
    for (Slot& slot : block) {
      if (slot.width < needs[slot.column].natural &&
          (narrowest == nullptr || slot.width < narrowest->width)) {
        narrowest = &slot;
      }
    }
    if (narrowest == nullptr) return;
    ++narrowest->width;
  }
}

// Where even one column does not fit beside the keys, only its longest words stand out.
void narrow_last(Block& block, std::size_t page_width) {
  const std::size_t used = width_of(block);
  if (used <= page_width) return;
  std::size_t& width = block.back().width;
  width -= std::min(used - page_width, width - std::min(width, kNarrowest));
}

// The columns in order, as many to a block as fit.
std::vector<Block> dealt_out(const std::vector<Need>& needs, const Block& keys, std::size_t width) {
  std::vector<Block> blocks = {keys};
  for (std::size_t c = keys.size(); c < needs.size(); ++c) {
    const bool fits = width_of(blocks.back()) + kGap + needs[c].least <= width;
    if (!fits && blocks.back().size() > keys.size()) blocks.push_back(keys);
    blocks.back().push_back({c, needs[c].least});
  }
  return blocks;
}

std::vector<Block> blocks_of(const std::vector<Need>& needs, const Page& page) {
  Block all;
  for (std::size_t c = 0; c < needs.size(); ++c) all.push_back({c, needs[c].natural});
  if (!page.width || all.empty() || width_of(all) <= *page.width) return {all};
  Block keys;
  for (std::size_t c = 0; c < std::min(page.key_columns, needs.size()); ++c) {
    keys.push_back({c, needs[c].least});
  }
  std::vector<Block> blocks = dealt_out(needs, keys, *page.width);
  // As many blocks, but of like widths: no column is left over for the last.
  for (std::size_t width = *page.width; width > 0; --width) {
    std::vector<Block> narrower = dealt_out(needs, keys, width);
    if (narrower.size() > blocks.size()) break;
    blocks = std::move(narrower);
  }
  for (Block& block : blocks) {
    widen(block, needs, *page.width);
    narrow_last(block, *page.width);
  }
  return blocks;
}

// Cells side by side, each of one line or more; the short ones are filled up at the top (headers
// stand on the rule) or at the bottom.
std::string side_by_side(const std::vector<Lines>& cells, const Block& block,
                         const std::vector<Column>& columns, bool fill_top) {
  std::size_t height = 0;
  for (const Lines& cell : cells) height = std::max(height, cell.size());
  std::string out;
  for (std::size_t i = 0; i < height; ++i) {
    std::string line;
    for (std::size_t s = 0; s < block.size(); ++s) {
      const std::size_t missing = fill_top ? height - cells[s].size() : 0;
      const bool there = i >= missing && i - missing < cells[s].size();
      if (s > 0) line.append(kGap, ' ');
      line +=
          pad(there ? cells[s][i - missing] : "", block[s].width, columns[block[s].column].align);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    out.append(line).append("\n");
  }
  return out;
}

std::string block_text(const Block& block, const std::vector<Column>& columns, const Rows& rows) {
  std::vector<Lines> cells;
  std::vector<Lines> rule;
  for (const Slot& slot : block) {
    cells.push_back(lines_of(columns[slot.column].header));
    rule.push_back({std::string(slot.width, '-')});
  }
  std::string out = side_by_side(cells, block, columns, true);
  out += side_by_side(rule, block, columns, false);
  for (const auto& row : rows) {
    for (std::size_t s = 0; s < block.size(); ++s) {
      const std::string& cell = row[block[s].column];
      cells[s] = cell.size() <= block[s].width ? Lines{cell} : words_in_lines(cell, block[s].width);
    }
    out += side_by_side(cells, block, columns, false);
  }
  return out;
}

}  // namespace

std::vector<std::string> words_in_lines(std::string_view text, std::size_t width) {
  Lines lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    const std::string_view word = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (word.empty()) continue;
    if (lines.empty() || lines.back().size() + 1 + word.size() > width) {
      lines.emplace_back(word);
    } else {
      lines.back().append(" ").append(word);
    }
  }
  return lines;
}

std::string laid_out(const std::vector<Column>& columns, const Rows& rows, const Page& page) {
  std::vector<Need> needs;
  needs.reserve(columns.size());
  for (std::size_t c = 0; c < columns.size(); ++c) needs.push_back(need_of(columns[c], c, rows));
  std::string out;
  for (const Block& block : blocks_of(needs, page)) {
    out.append(out.empty() ? "" : "\n").append(block_text(block, columns, rows));
  }
  return out;
}

}  // namespace simbench::reports
