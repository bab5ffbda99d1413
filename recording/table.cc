#include "recording/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <utility>

#include "recording/date_time.h"
#include "recording/number_in.h"
#include "recording/stamp_unit.h"

namespace simbench {
namespace {

constexpr std::size_t kRowsAhead = 100;
constexpr std::size_t kBytesAhead = std::size_t{4} << 20;
constexpr std::size_t kMostComments = 1000;
constexpr std::string_view kTableBlanks = " \t\r";

std::string_view without_blanks(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kTableBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kTableBlanks) - first + 1);
}

std::size_t comment_mark(std::string_view line) {
  if (line.starts_with("//")) return 2;
  return line.starts_with('#') || line.starts_with('%') ? 1 : 0;
}

bool is_number_cell(std::string_view cell) {
  return time_in(cell, kSecondUnit).has_value() || number_in<double>(cell).has_value();
}

bool is_decimal_comma(std::string_view cell) {
  if (std::ranges::count(cell, ',') != 1 || cell.find('.') != std::string_view::npos) return false;
  if (cell.ends_with(',')) return false;
  std::string pointed(cell);
  std::ranges::replace(pointed, ',', '.');
  return is_number_cell(pointed);
}

// A day and the time behind it are one cell, though a blank separates them.
void join_days_and_times(std::vector<std::string_view>& cells) {
  for (std::size_t i = 0; i + 1 < cells.size(); ++i) {
    if (!day_in(cells[i]) || cells[i + 1].find(':') == std::string_view::npos) continue;
    const char* end = cells[i + 1].data() + cells[i + 1].size();
    const std::string_view both(cells[i].data(), static_cast<std::size_t>(end - cells[i].data()));
    if (!date_time_in(both)) continue;
    cells[i] = both;
    cells.erase(cells.begin() + static_cast<std::ptrdiff_t>(i) + 1);
  }
}

bool split_at_blanks(std::string_view line, std::vector<std::string_view>& cells) {
  for (std::size_t at = line.find_first_not_of(kTableBlanks); at != std::string_view::npos;) {
    const bool quoted = line[at] == '"';
    std::size_t end = quoted ? line.find('"', at + 1) : line.find_first_of(kTableBlanks, at);
    if (quoted && end == std::string_view::npos) return false;
    end = std::min(end, line.size());
    cells.push_back(quoted ? line.substr(at + 1, end - at - 1) : line.substr(at, end - at));
    at = line.find_first_not_of(kTableBlanks, quoted ? end + 1 : end);
  }
  join_days_and_times(cells);
  return true;
}

// How many of the rows have the number of cells that most have, and that number, if it is more than
// one.
struct Fit {
  std::size_t rows = 0;
  std::size_t cells = 0;
};

Fit fit_of(char separator, const std::vector<std::string_view>& rows) {
  std::map<std::size_t, std::size_t> counts;
  std::vector<std::string_view> cells;
  std::deque<std::string> unquoted;
  for (const std::string_view row : rows) {
    cells.clear();
    if (split_row(row, separator, cells, unquoted)) ++counts[cells.size()];
  }
  const auto most = std::ranges::max_element(
      counts, {}, [](const auto& count) { return std::pair(count.second, count.first); });
  if (most == counts.end() || most->first < 2) return {};
  return {most->second, most->first};
}

// Whether commas are those of numbers: what stands between blanks are numbers, some with a comma.
bool are_decimal_commas(const std::vector<std::string_view>& rows) {
  std::vector<std::string_view> cells;
  std::deque<std::string> unquoted;
  bool any = false;
  for (const std::string_view row : rows) {
    cells.clear();
    if (!split_row(row, TableDialect::kBlanks, cells, unquoted) || cells.size() < 2) return false;
    for (const std::string_view cell : cells) {
      const bool comma = is_decimal_comma(cell);
      any = any || comma;
      if (!comma && !is_value_cell(cell)) return false;
    }
  }
  return any;
}

// Commas before blanks, since a list with blanks behind its commas has both.
char separator_of(const std::vector<std::string_view>& rows) {
  const bool are_times = std::ranges::all_of(
      rows, [](std::string_view row) { return date_time_in(without_blanks(row)).has_value(); });
  if (are_times) return TableDialect::kOneColumn;
  if (are_decimal_commas(rows)) return TableDialect::kBlanks;
  char best = TableDialect::kOneColumn;
  std::size_t most = (rows.size() - 1) / 2;
  for (const char separator : {'\t', ';', ',', TableDialect::kBlanks}) {
    const Fit fit = fit_of(separator, rows);
    if (fit.rows <= most) continue;
    best = separator;
    most = fit.rows;
  }
  return best;
}

}  // namespace

bool is_missing_cell(std::string_view cell) {
  constexpr std::array<std::string_view, 8> kMissing = {"nan",  "na", "n/a", "null",
                                                        "none", "-",  "--",  "nat"};
  if (cell.empty()) return true;
  if (cell.size() > 4) return false;
  std::array<char, 4> letters{};
  std::ranges::transform(cell, letters.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::ranges::find(kMissing, std::string_view(letters.data(), cell.size())) !=
         kMissing.end();
}

bool is_value_cell(std::string_view cell, bool decimal_comma) {
  if (is_missing_cell(cell) || is_number_cell(cell)) return true;
  if (decimal_comma && is_decimal_comma(cell)) return true;
  return date_time_in(cell).has_value() || time_of_day_in(cell).has_value();
}

bool split_row(std::string_view line, char separator, std::vector<std::string_view>& cells,
               std::deque<std::string>& unquoted) {
  if (separator == TableDialect::kBlanks) return split_at_blanks(line, cells);
  if (separator == TableDialect::kOneColumn) {
    cells.push_back(without_blanks(line));
    return true;
  }
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t first = line.find_first_not_of(" \r", begin);
    if (first == std::string_view::npos || line[first] != '"') {
      const std::size_t end = std::min(line.find(separator, begin), line.size());
      cells.push_back(without_blanks(line.substr(begin, end - begin)));
      begin = end + 1;
      continue;
    }
    bool doubled = false;
    std::size_t close = line.find('"', first + 1);
    while (close != std::string_view::npos && close + 1 < line.size() && line[close + 1] == '"') {
      doubled = true;
      close = line.find('"', close + 2);
    }
    if (close == std::string_view::npos) return false;
    std::string_view cell = line.substr(first + 1, close - first - 1);
    if (doubled) {
      std::string& plain = unquoted.emplace_back();
      for (std::size_t i = 0; i < cell.size(); ++i) {
        plain += cell[i];
        if (cell[i] == '"') ++i;
      }
      cell = plain;
    }
    cells.push_back(without_blanks(cell));
    begin = std::min(line.find(separator, close + 1), line.size()) + 1;
  }
  return true;
}

TableReader::TableReader(LineReader lines) : lines_(std::move(lines)) {
  look_ahead();
  find_dialect();
  find_heading();
}

// Keeps the first rows, and the comments before them.
void TableReader::look_ahead() {
  std::size_t bytes = 0;
  while (ahead_.size() < kRowsAhead && bytes < kBytesAhead) {
    const std::optional<std::string_view> line = lines_.next();
    if (!line) return;
    const std::string_view text = without_blanks(*line);
    bytes += text.size();
    if (text.empty()) continue;
    const std::size_t mark = comment_mark(text);
    if (mark == 0) {
      ahead_.push_back({std::string(text), lines_.line()});
    } else if (ahead_.empty() && comments_.size() < kMostComments) {
      const std::size_t begin = std::min(text.find_first_not_of("#%/"), text.size());
      comments_.emplace_back(without_blanks(text.substr(begin)));
    }
  }
}

void TableReader::find_dialect() {
  // A heading may have fewer commas than the rows, so it does not count if there is more.
  std::vector<std::string_view> rows;
  for (const Kept& row : ahead_) rows.push_back(row.text);
  if (rows.empty()) return;
  dialect_.separator =
      separator_of(rows.size() == 1 ? rows : std::vector(rows.begin() + 1, rows.end()));
  if (dialect_.separator == ',') return;
  std::size_t commas = 0;
  std::size_t points = 0;
  std::vector<std::string_view> cells;
  for (const std::string_view row : rows) {
    cells.clear();
    if (!split_row(row, dialect_.separator, cells, unquoted_)) continue;
    for (const std::string_view cell : cells) {
      if (is_decimal_comma(cell)) ++commas;
      if (cell.find('.') != std::string_view::npos && is_number_cell(cell)) ++points;
    }
  }
  dialect_.decimal_comma = commas > 0 && points == 0;
}

void TableReader::find_heading() {
  if (ahead_.empty()) return;
  std::vector<std::string_view> cells;
  if (!split_row(ahead_.front().text, dialect_.separator, cells, unquoted_)) return;
  const auto no_value = [&](std::string_view cell) {
    return cell.empty() || !is_value_cell(cell, dialect_.decimal_comma);
  };
  const bool named =
      std::ranges::all_of(cells, no_value) && !std::ranges::all_of(cells, &std::string_view::empty);
  if (named && (ahead_.size() > 1 || cells.size() > 1)) {
    heading_.assign(cells.begin(), cells.end());
    ahead_.pop_front();
    return;
  }
  if (comments_.empty()) return;
  // A line above a list of stamps is its heading only if it says so.
  if (cells.size() < 2 && !comments_.back().starts_with("timestamp")) return;
  std::vector<std::string_view> names;
  if (split_row(comments_.back(), dialect_.separator, names, unquoted_) &&
      names.size() == cells.size()) {
    heading_.assign(names.begin(), names.end());
  }
}

std::vector<std::string> TableReader::cells_of(const Kept& row) const {
  std::vector<std::string_view> cells;
  std::deque<std::string> unquoted;
  if (!split_row(row.text, dialect_.separator, cells, unquoted)) return {};
  return {cells.begin(), cells.end()};
}

std::vector<std::string> TableReader::first_row() const {
  return ahead_.empty() ? std::vector<std::string>{} : cells_of(ahead_.front());
}

std::vector<std::vector<std::string>> TableReader::first_rows() const {
  std::vector<std::vector<std::string>> rows;
  for (const Kept& row : ahead_) rows.push_back(cells_of(row));
  return rows;
}

const std::vector<std::string_view>* TableReader::next() {
  if (!ahead_.empty()) {
    current_ = std::move(ahead_.front().text);
    line_ = ahead_.front().line;
    ahead_.pop_front();
    return row_of(current_);
  }
  while (const std::optional<std::string_view> line = lines_.next()) {
    const std::string_view text = without_blanks(*line);
    if (text.empty() || comment_mark(text) > 0) continue;
    line_ = lines_.line();
    return row_of(text);
  }
  return nullptr;
}

const std::vector<std::string_view>* TableReader::row_of(std::string_view line) {
  cells_.clear();
  unquoted_.clear();
  if (!split_row(line, dialect_.separator, cells_, unquoted_)) {
    throw LineError(
        fmt::format("{}: found a quote without its end, allowed: a row on one line", place()));
  }
  if (!dialect_.decimal_comma) return &cells_;
  for (std::string_view& cell : cells_) {
    if (!is_decimal_comma(cell)) continue;
    std::string& pointed = unquoted_.emplace_back(cell);
    std::ranges::replace(pointed, ',', '.');
    cell = pointed;
  }
  return &cells_;
}

std::string TableReader::place() const { return fmt::format("{}:{}", lines_.path(), line_); }

}  // namespace simbench
