// Reads CSV of seconds and time errors.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "evaluation/stability/log_lines.h"
#include "recording/number_in.h"
#include "recording/text_fields.h"

namespace simbench::evaluation {
namespace {

struct UnitName {
  std::string_view name;
  ErrorUnit unit;
  double seconds;
};
constexpr std::array<UnitName, 4> kUnits = {{{"s", ErrorUnit::kS, 1},
                                             {"ms", ErrorUnit::kMs, 1e-3},
                                             {"us", ErrorUnit::kUs, 1e-6},
                                             {"ns", ErrorUnit::kNs, 1e-9}}};

const UnitName& named(ErrorUnit unit) {
  return *std::find_if(kUnits.begin(), kUnits.end(),
                       [unit](const UnitName& of) { return of.unit == unit; });
}

std::string_view trimmed_cell(std::string_view cell) {
  const std::size_t first = cell.find_first_not_of(" \t\"");
  if (first == std::string_view::npos) return {};
  return cell.substr(first, cell.find_last_not_of(" \t\"") - first + 1);
}

std::vector<std::string_view> cells_in_line(std::string_view line) {
  std::vector<std::string_view> cells;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    cells.push_back(trimmed_cell(line.substr(begin, end - begin)));
    begin = end + 1;
  }
  return cells;
}

// The unit at the end of a column's name: "error_ms", "error (ms)", "error [ms]", "error ms".
std::optional<ErrorUnit> unit_of_name(std::string_view name) {
  if (name.ends_with(')') || name.ends_with(']')) name.remove_suffix(1);
  const std::size_t before = name.find_last_of("_ ([");
  if (before == std::string_view::npos) return std::nullopt;
  for (const UnitName& unit : kUnits) {
    if (name.substr(before + 1) == unit.name) return unit.unit;
  }
  return std::nullopt;
}

// Not a number, nor what may have been one.
bool is_column_name(std::string_view cell) {
  if (!cell.empty() && std::string_view("+-.0123456789").find(cell[0]) != std::string_view::npos) {
    return false;
  }
  double value = 0;
  const char* end = cell.data() + cell.size();
  return cell.empty() || std::from_chars(cell.data(), end, value).ptr != end;  // nan, inf
}

class CsvLines final : public LogLines {
 public:
  explicit CsvLines(const ClockLogOptions& options) : options_(options) {}

  const char* format() const override { return "csv"; }

  std::optional<LogLine> read(std::string_view line, const LogPlace& place) override {
    if (line.starts_with('#')) return std::nullopt;
    const std::vector<std::string_view> cells = cells_in_line(line);
    if (columns_ == 0 && begin(cells, place)) return std::nullopt;
    if (cells.size() != columns_) {
      place.fail(
          fmt::format("found {} cells, allowed: {}, as in the first line; is the line "
                      "complete, do the numbers have decimal commas?",
                      cells.size(), columns_));
    }
    const std::optional<Microseconds> time = microseconds_of(cells[0]);
    if (!time) place.fail("time", cells[0], "a number of seconds up to 4e11");
    const double scale = named(unit_).seconds;
    const double error = finite_of(cells[column_], "time error", kLargestErrorS / scale, place);
    return LogLine{{}, {*time, error * scale}};
  }

 private:
  // Reads the first line; returns whether it has names.
  bool begin(const std::vector<std::string_view>& cells, const LogPlace& place) {
    const bool names = std::all_of(cells.begin(), cells.end(), is_column_name);
    columns_ = cells.size();
    column_ = column_of(cells, names, place);
    const std::optional<ErrorUnit> unit = names ? unit_of_name(cells[column_]) : std::nullopt;
    if (unit && options_.unit && *unit != *options_.unit) {
      place.fail("--unit", named(*options_.unit).name,
                 fmt::format("{}, which the column {} states", named(*unit).name,
                             quoted_bytes(cells[column_])));
    }
    unit_ = unit.value_or(options_.unit.value_or(ErrorUnit::kS));
    if (names && unit_of_name(cells[0]).value_or(ErrorUnit::kS) != ErrorUnit::kS) {
      place.fail("time", cells[0], "a first column of seconds");
    }
    return names;
  }

  std::size_t column_of(const std::vector<std::string_view>& cells, bool names,
                        const LogPlace& place) const {
    const auto wanted = std::find(cells.begin() + 1, cells.end(), options_.series);
    if (names && wanted != cells.end()) return static_cast<std::size_t>(wanted - cells.begin());
    const std::optional<std::int64_t> number = number_in<std::int64_t>(options_.series);
    if (number && *number >= 2 && *number <= static_cast<std::int64_t>(cells.size())) {
      return static_cast<std::size_t>(*number - 1);
    }
    if (!options_.series.empty()) {
      place.fail("--series", options_.series,
                 fmt::format("the name of a column but the first, or its number from 2 to {}",
                             cells.size()));
    }
    if (cells.size() != 2) {
      place.fail(
          fmt::format("found {} columns, allowed: two (seconds, error), or --series with the "
                      "name or the number of the second",
                      cells.size()));
    }
    return 1;
  }

  const ClockLogOptions options_;
  std::size_t columns_ = 0;
  std::size_t column_ = 1;
  ErrorUnit unit_ = ErrorUnit::kS;
};

}  // namespace

std::unique_ptr<LogLines> csv_lines(const ClockLogOptions& options) {
  return std::make_unique<CsvLines>(options);
}

}  // namespace simbench::evaluation
