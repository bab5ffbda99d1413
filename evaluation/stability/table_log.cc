#include "evaluation/stability/table_log.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <chrono>
#include <cmath>
#include <utility>

#include "evaluation/stability/log_lines.h"
#include "evaluation/statistics/statistics.h"
#include "recording/counted.h"
#include "recording/date_time.h"
#include "recording/number_in.h"
#include "recording/text_fields.h"

namespace simbench::evaluation {
namespace {

constexpr std::size_t kNoColumn = static_cast<std::size_t>(-1);
// Fractions of a second below this cannot be meant in a smaller unit by a sane writer, who would
// then write parts of a picosecond, or a clock that good.
constexpr double kSurelySeconds = 1e-4;

std::string small_letters(std::string_view text) {
  std::string letters(text);
  std::ranges::transform(letters, letters.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return letters;
}

bool is_time_heading(std::string_view heading) {
  constexpr std::array<std::string_view, 11> kTimes = {"time",    "timestamp", "date", "datetime",
                                                       "elapsed", "epoch",     "mjd",  "seconds",
                                                       "sec",     "t",         "s"};
  const std::string letters = small_letters(heading);
  const std::string first = letters.substr(0, letters.find_first_of(" _-:.([/"));
  return std::ranges::find(kTimes, first) != kTimes.end() &&
         letters.find("error") == std::string::npos && letters.find("offset") == std::string::npos;
}

// Which columns have times and errors.
struct TableColumns {
  std::size_t time = kNoColumn;  // none: rows are one interval apart
  std::size_t error = kNoColumn;
};

// The columns that tell series apart: of a pipeline, a seed, a host.
using KeyColumns = std::array<std::size_t, 3>;

// A heading may be longer than the rows: what they do not have tells nothing apart.
KeyColumns key_columns(const TableReader& table) {
  constexpr std::array<std::array<std::string_view, 3>, 3> kNames = {
      {{"pipeline", "program", "run"}, {"seed", "process", "port"}, {"host", "source", "clock"}}};
  KeyColumns keys{kNoColumn, kNoColumn, kNoColumn};
  const std::size_t named = std::min(table.heading().size(), table.first_row().size());
  for (std::size_t i = 0; i < named; ++i) {
    const std::string letters = small_letters(table.heading()[i]);
    for (std::size_t key = 0; key < kNames.size(); ++key) {
      if (std::ranges::find(kNames[key], letters) != kNames[key].end()) keys[key] = i;
    }
  }
  return keys;
}

bool has_keys(const KeyColumns& keys) {
  return std::ranges::any_of(keys, [](std::size_t key) { return key != kNoColumn; });
}

std::vector<std::size_t> value_columns(const TableReader& table) {
  std::vector<std::size_t> found;
  const std::vector<std::string> row = table.first_row();
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (is_value_cell(row[i], table.dialect().decimal_comma)) found.push_back(i);
  }
  return found;
}

std::string column_name(const TableReader& table, std::size_t column) {
  const std::vector<std::string>& heading = table.heading();
  if (column < heading.size() && !heading[column].empty()) return heading[column];
  return fmt::format("{}", column + 1);
}

class TableLog {
 public:
  TableLog(TableReader& table, const ClockLogOptions& options, LogSeriesSet& series)
      : table_(table),
        options_(options),
        series_(series),
        cells_(table.first_row().size()),
        keys_(key_columns(table)) {
    log_.path = table.path();
    log_.format = "csv";
    find_columns();
    find_units();
  }

  ClockLog read();

 private:
  LogPlace place() const { return {log_.path, table_.line()}; }
  LogPlace begin() const { return {log_.path, 1}; }
  std::string name_of(std::size_t column) const { return column_name(table_, column); }
  void note(const std::string& text) { log_.notes.push_back(log_.path + ": " + text); }

  void find_columns();
  std::size_t named_column(const std::vector<std::size_t>& values) const;
  void find_units();
  std::optional<StampUnit> stated_unit() const;
  void read_row(const std::vector<std::string_view>& row);
  void add_to_series(const std::vector<std::string_view>& row, Microseconds time, double value);
  Microseconds time_of(std::string_view cell);
  void add(Microseconds time, double value);
  void guess_unit();
  [[noreturn]] void fail_without_unit() const;
  void scale();
  void sum_frequencies();
  void add_notes();

  TableReader& table_;
  const ClockLogOptions& options_;
  LogSeriesSet& series_;
  std::size_t cells_;
  KeyColumns keys_;
  TableColumns columns_{};
  std::optional<StampUnit> unit_{};       // of errors
  std::optional<StampUnit> time_unit_{};  // of times that are numbers
  ClockLog log_{};
  bool whole_ = true;  // all errors are whole numbers
  std::size_t rows_ = 0;
  std::size_t missing_ = 0;
  std::size_t first_missing_ = 0;  // its line
};

void TableLog::find_columns() {
  std::vector<std::size_t> values = value_columns(table_);
  std::erase_if(
      values, [&](std::size_t column) { return std::ranges::find(keys_, column) != keys_.end(); });
  const std::vector<std::string>& heading = table_.heading();
  for (const std::size_t column : values) {
    if (columns_.time != kNoColumn || values.size() == 1) break;
    if (column < heading.size() && is_time_heading(heading[column])) columns_.time = column;
  }
  if (columns_.time == kNoColumn && values.size() > 1) columns_.time = values.front();
  columns_.error = named_column(values);
  if (options_.frequencies && has_keys(keys_)) {
    begin().fail(
        "found columns that tell several series apart, allowed with --frequencies: one "
        "series");
  }
  if (columns_.time != kNoColumn) return;
  if (!options_.interval_s) {
    begin().fail(
        "found one column of values, allowed: two (time, time error), or --tau0 with the seconds "
        "between its values");
  }
  note(fmt::format("values are taken to be {:g} s apart, as --tau0 says", *options_.interval_s));
}

std::size_t TableLog::named_column(const std::vector<std::size_t>& values) const {
  std::vector<std::string> names;
  std::size_t only = kNoColumn;
  for (const std::size_t column : values) {
    if (column == columns_.time) continue;
    names.push_back(quoted_bytes(name_of(column)));
    only = column;
  }
  // A name is that of a series then.
  if (options_.series.empty() || (has_keys(keys_) && names.size() == 1)) {
    if (names.size() == 1) return only;
    begin().fail(
        fmt::format("found {} columns of values, allowed: two (time, time error), or "
                    "--series with the name or the number of the second: {}",
                    values.size(), fmt::join(names, ", ")));
  }
  for (std::size_t column = 0; column < std::min(table_.heading().size(), cells_); ++column) {
    if (table_.heading()[column] == options_.series) return column;
  }
  const std::optional<std::size_t> number = number_in<std::size_t>(options_.series);
  if (number && *number >= 1 && *number <= cells_ && *number - 1 != columns_.time) {
    return *number - 1;
  }
  LogPlace{log_.path, 1}.fail("--series", options_.series,
                              fmt::format("the name of a column of values but that of the times, "
                                          "or its number up to {}: {}",
                                          cells_, fmt::join(names, ", ")));
}

// By the heading, or by a comment above a table without one ("# unit: s").
std::optional<StampUnit> TableLog::stated_unit() const {
  const std::vector<std::string>& heading = table_.heading();
  if (columns_.error < heading.size()) return heading_unit(heading[columns_.error]);
  for (const std::string& comment : table_.comments()) {
    const std::size_t at = small_letters(comment).find("unit");
    if (at == std::string::npos) continue;
    const std::size_t value = comment.find_first_of(":= ", at);
    if (value == std::string::npos) continue;
    const std::size_t first = comment.find_first_not_of(":= ", value);
    if (first != std::string::npos) return unit_named(comment.substr(first));
  }
  return std::nullopt;
}

void TableLog::find_units() {
  if (options_.frequencies) {
    unit_ = kSecondUnit;
  } else {
    const std::optional<StampUnit> stated = stated_unit();
    if (stated && options_.unit && *stated != *options_.unit) {
      begin().fail("--unit", unit_text(*options_.unit),
                   fmt::format("{}, which the column {} states", unit_text(*stated),
                               quoted_bytes(name_of(columns_.error))));
    }
    unit_ = stated ? stated : options_.unit;
  }
  const bool named = columns_.time < table_.heading().size();
  const std::optional<StampUnit> stated =
      named ? heading_unit(table_.heading()[columns_.time]) : std::nullopt;
  if (stated && options_.time_unit && *stated != *options_.time_unit) {
    begin().fail("--time-unit", unit_text(*options_.time_unit),
                 fmt::format("{}, which the column {} states", unit_text(*stated),
                             quoted_bytes(name_of(columns_.time))));
  }
  time_unit_ = stated ? stated : options_.time_unit;
}

Microseconds TableLog::time_of(std::string_view cell) {
  const auto microseconds = [](Nanoseconds time) {
    return std::chrono::floor<Microseconds>(time + Nanoseconds(500));
  };
  if (const auto time = date_time_in(cell)) return microseconds(*time);
  if (!time_unit_) {
    const std::optional<double> value = number_in<double>(cell);
    const std::optional<StampUnit> epoch = value ? epoch_unit(*value) : std::nullopt;
    time_unit_ = epoch.value_or(kSecondUnit);
    note(fmt::format("times are taken as {}{}: no heading and no --time-unit says so",
                     unit_text(*time_unit_), epoch ? " since 1970, by their size" : ""));
  }
  const std::optional<Nanoseconds> time = time_in(cell, *time_unit_);
  if (time) return microseconds(*time);
  place().fail(
      "time", cell,
      fmt::format("a number of {} or a time such as 2024-09-03T10:32:22Z", unit_text(*time_unit_)));
}

void TableLog::read_row(const std::vector<std::string_view>& row) {
  ++rows_;
  if (row.size() != cells_) {
    place().fail(
        fmt::format("found {} cells, allowed: {}, as in the first row; is the line "
                    "complete, do the numbers have decimal commas?",
                    row.size(), cells_));
  }
  const std::string_view cell = row[columns_.error];
  const bool without_time = columns_.time != kNoColumn && is_missing_cell(row[columns_.time]);
  if (is_missing_cell(cell) || without_time) {
    if (missing_++ == 0) first_missing_ = table_.line();
    // Its place in the order is kept, as a gap.
    return;
  }
  Microseconds time{};
  if (columns_.time != kNoColumn) {
    time = time_of(row[columns_.time]);
  } else {
    const double time_us = 1e6 * *options_.interval_s * static_cast<double>(rows_ - 1);
    if (time_us > static_cast<double>(kLargestLogTime.count())) {
      place().fail("found a time beyond 12,000 years, allowed: less");
    }
    time = Microseconds(std::llround(time_us));
  }
  const double seconds = unit_ ? unit_->seconds() : 1;
  const double value =
      finite_of(cell, "time error", unit_ ? kLargestErrorS / seconds : 1e19, place());
  whole_ = whole_ && cell.find_first_of(".eE") == std::string_view::npos;
  if (has_keys(keys_)) {
    add_to_series(row, time, value);
  } else {
    add(time, value);
  }
}

void TableLog::add_to_series(const std::vector<std::string_view>& row, Microseconds time,
                             double value) {
  if (!unit_) fail_without_unit();
  const auto key = [&](std::size_t i) {
    return keys_[i] == kNoColumn ? std::string_view() : row[keys_[i]];
  };
  series_.add({.format = "csv",
               .host = key(0),
               .tag = key(1),
               .name = key(2),
               .point = {time, value * unit_->seconds()}},
              place());
}

void TableLog::add(Microseconds time, double value) {
  if (!log_.points.empty() && time < log_.points.back().time) {
    log_.segments.push_back(log_.points.size());
  }
  log_.points.push_back({time, value});
}

// Refuses what may be of two units.
void TableLog::guess_unit() {
  if (unit_) return;
  std::vector<double> sizes;
  for (const ClockLogPoint& point : log_.points) {
    if (point.error_s != 0) sizes.push_back(std::abs(point.error_s));
  }
  const double largest = sizes.empty() ? 0 : *std::ranges::max_element(sizes);
  if (sizes.empty() || (!whole_ && median(std::move(sizes)) < kSurelySeconds)) {
    unit_ = kSecondUnit;
    if (largest > kLargestErrorS) {
      begin().fail(
          fmt::format("column {}: found a time error of {:g} s among its values, allowed: "
                      "up to {:g} s either way",
                      quoted_bytes(name_of(columns_.error)), largest, kLargestErrorS));
    }
    note("time errors are taken as s, by their size: no heading and no --unit says so");
    return;
  }
  fail_without_unit();
}

void TableLog::fail_without_unit() const {
  begin().fail(fmt::format(
      "found no unit of the time errors of column {}, allowed: one in its heading (offset_ns), or "
      "--unit with one of {}",
      quoted_bytes(name_of(columns_.error)), kUnitsText));
}

void TableLog::scale() {
  const double seconds = unit_->seconds();
  if (seconds == 1) return;
  for (ClockLogPoint& point : log_.points) point.error_s *= seconds;
}

// x(t + tau) = x(t) + y tau, from 0 at the first: N frequencies lead from N times to the next one.
void TableLog::sum_frequencies() {
  std::vector<ClockLogPoint>& points = log_.points;
  const auto distance = [&](std::size_t i) { return points[i + 1].time - points[i].time; };
  const std::size_t last = points.size() - 1;
  const Microseconds tau = last > 0
                               ? distance(last - 1)
                               : Microseconds(std::llround(1e6 * options_.interval_s.value_or(1)));
  points.push_back({points.back().time + tau, 0});
  double error_s = 0;
  for (std::size_t i = 0; i <= last; ++i) {
    const double y = std::exchange(points[i].error_s, error_s);
    error_s += y * 1e-6 * static_cast<double>(distance(i).count());
    if (!(std::abs(error_s) <= kLargestErrorS)) {
      place().fail(fmt::format("found frequencies that sum up to more than {:g} s, allowed: less",
                               kLargestErrorS));
    }
  }
  points.back().error_s = error_s;
}

void TableLog::add_notes() {
  if (missing_ > 0) {
    note(fmt::format("{} without a value, the first in line {}: each is a gap",
                     counted(missing_, "row"), first_missing_));
  }
  if (table_.torn()) {
    log_.notes.push_back(table_.lines().place() +
                         ": the last line has no line end and may be cut; it was left out");
  }
  if (!log_.segments.empty()) {
    log_.notes.push_back(segments_note(log_.path, log_.segments.size()));
  }
}

ClockLog TableLog::read() {
  while (const std::vector<std::string_view>* row = table_.next()) read_row(*row);
  if (!series_.empty()) {
    add_notes();
    return std::move(log_);
  }
  if (log_.points.empty()) place().fail("the file ends without a time error");
  guess_unit();
  scale();
  if (options_.frequencies) sum_frequencies();
  add_notes();
  return std::move(log_);
}

}  // namespace

bool has_series_columns(const TableReader& table) { return has_keys(key_columns(table)); }

bool is_table_of_values(const TableReader& table) { return !value_columns(table).empty(); }

std::vector<ClockLogSeries> table_columns(const TableReader& table) {
  std::vector<ClockLogSeries> found;
  for (const std::size_t column : value_columns(table)) {
    found.push_back({.name = printable_name(column_name(table, column)), .format = "csv"});
  }
  return found;
}

ClockLog read_table_log(TableReader& table, const ClockLogOptions& options, LogSeriesSet& series) {
  return TableLog(table, options, series).read();
}

}  // namespace simbench::evaluation
