#include "recording/recording_columns.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string_view>

#include "recording/date_time.h"
#include "recording/number_in.h"
#include "recording/text_fields.h"

namespace simbench {
namespace {

constexpr std::array<std::string_view, kCsvFields> kFieldNames = {
    "stream", "index",    "counter", "sensor", "arrival",    "camera",
    "host",   "exposure", "backend", "bytes",  "temperature"};

[[noreturn]] void fail_in_table(const TableReader& table, const std::string& problem) {
  throw CsvError(fmt::format("{}:1: {}", table.path(), problem));
}

// What a user would call a column.
std::string column_label(const TableReader& table, std::size_t position) {
  const std::vector<std::string>& heading = table.heading();
  return position < heading.size() ? heading[position] : fmt::format("{}", position + 1);
}

std::string all_labels(const TableReader& table) {
  std::vector<std::string> labels;
  const std::size_t count = table.first_row().size();
  for (std::size_t i = 0; i < count; ++i) labels.push_back(quoted_bytes(column_label(table, i)));
  return fmt::format("{}", fmt::join(labels, ", "));
}

std::optional<std::size_t> position_of(const std::string& name, const TableReader& table) {
  const std::string plain = plain_column_name(name);
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < table.heading().size(); ++i) {
    if (plain_column_name(table.heading()[i]) != plain) continue;
    if (found) fail_in_table(table, "found the column " + quoted_bytes(name) + " twice");
    found = i;
  }
  if (found) return found;
  const std::optional<std::size_t> number = number_in<std::size_t>(name);
  if (!number || *number < 1 || *number > table.first_row().size()) return std::nullopt;
  return *number - 1;
}

std::size_t wanted_position(const std::string& name, const TableReader& table) {
  if (const auto position = position_of(name, table)) return *position;
  fail_in_table(table,
                fmt::format("found no column {}, allowed: {}, or a number from 1 to {}",
                            quoted_bytes(name), all_labels(table), table.first_row().size()));
}

// The numbers of a column in the first rows.
std::vector<double> first_numbers(const TableReader& table, std::size_t position) {
  std::vector<double> numbers;
  for (const std::vector<std::string>& row : table.first_rows()) {
    if (position >= row.size() || is_missing_cell(row[position])) continue;
    if (const auto number = number_in<double>(row[position])) numbers.push_back(*number);
  }
  return numbers;
}

bool has_times_of_day(const TableReader& table, std::size_t position) {
  const std::vector<std::string> row = table.first_row();
  return position < row.size() && date_time_in(row[position]).has_value();
}

std::optional<StampUnit> unit_by_numbers(const TableReader& table, std::size_t position,
                                         std::vector<std::string>& notes) {
  const std::vector<double> numbers = first_numbers(table, position);
  if (numbers.empty()) return std::nullopt;
  const std::string label = quoted_bytes(column_label(table, position));
  if (const auto unit = epoch_unit(numbers.front())) {
    notes.push_back(
        fmt::format("column {}: taken as {} since 1970, by its size", label, unit_text(*unit)));
    return unit;
  }
  std::vector<double> distances;
  for (std::size_t i = 1; i < numbers.size(); ++i) distances.push_back(numbers[i] - numbers[i - 1]);
  if (distances.empty()) return std::nullopt;
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::ranges::nth_element(distances, middle);
  const std::optional<StampUnit> unit = frame_rate_unit(*middle);
  if (unit) {
    notes.push_back(fmt::format("column {}: taken as {}, by its rate ({:.4g} frames a second)",
                                label, unit_text(*unit), 1 / (*middle * unit->seconds())));
  }
  return unit;
}

ResolvedColumns::Stamps stamps_of(const std::string& name, const std::optional<StampUnit>& stated,
                                  std::size_t position, const TableReader& table,
                                  std::vector<std::string>& notes) {
  ResolvedColumns::Stamps stamps{.name = name, .position = position};
  if (stated) {
    stamps.unit = *stated;
    return stamps;
  }
  if (has_times_of_day(table, position)) return stamps;
  std::optional<StampUnit> unit;
  if (position < table.heading().size()) unit = heading_unit(table.heading()[position]);
  if (!unit) unit = unit_by_numbers(table, position, notes);
  if (!unit) {
    fail_in_table(table,
                  fmt::format("found no unit of the stamps of column {}, allowed: one behind "
                              "its name (sensor={}:ns) of {}",
                              quoted_bytes(name), printable_name(name), kUnitsText));
  }
  stamps.unit = *unit;
  return stamps;
}

bool is_called(const std::string& heading, std::initializer_list<std::string_view> names) {
  const std::string plain = plain_column_name(heading);
  return std::ranges::find(names, plain) != names.end();
}

// A column that may have stamps: one of times, or of numbers that ascend and is called so.
bool may_be_stamps(const TableReader& table, std::size_t position) {
  if (has_times_of_day(table, position)) return true;
  const std::vector<double> numbers = first_numbers(table, position);
  if (numbers.empty()) return false;
  if (!std::ranges::is_sorted(numbers)) return false;
  if (epoch_unit(numbers.front())) return true;
  if (position >= table.heading().size()) return table.first_row().size() == 1;
  const std::string plain = plain_column_name(table.heading()[position]);
  return plain.find("time") != std::string::npos || plain.find("stamp") != std::string::npos ||
         heading_unit(table.heading()[position]).has_value();
}

}  // namespace

std::string plain_column_name(std::string_view cell) {
  std::string name;
  for (const char c : cell) {
    if (c == ' ' || (c == '#' && name.empty() && cell.size() > 2)) continue;
    name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return name;
}

RecordingColumns RecordingColumns::parse(const std::string& text) {
  const auto fail = [](std::string_view found) {
    throw CsvError(
        "--columns: found " + quoted_bytes(found) +
        ", allowed: FIELD=COLUMN or FIELD=COLUMN:UNIT with commas between them; fields "
        "stream, index, counter, sensor, arrival, camera, host, exposure, backend, bytes, "
        "temperature; units " +
        kUnitsText);
  };
  RecordingColumns parsed;
  const std::string_view all = text;
  for (std::size_t begin = 0; begin <= all.size();) {
    const std::size_t end = std::min(all.find(',', begin), all.size());
    const std::string_view part = all.substr(begin, end - begin);
    begin = end + 1;
    const std::size_t equals = part.find('=');
    const auto* const field =
        std::find(kFieldNames.begin(), kFieldNames.end(), part.substr(0, equals));
    if (equals == std::string_view::npos || field == kFieldNames.end()) fail(part);
    Column column{.name = std::string(part.substr(equals + 1))};
    if (const std::size_t colon = column.name.rfind(':'); colon != std::string::npos) {
      column.unit = unit_named(column.name.substr(colon + 1));
      if (!column.unit) fail(part);
      column.name.erase(colon);
    }
    if (column.name.empty()) fail(part);
    Column& known = parsed.columns[static_cast<std::size_t>(field - kFieldNames.begin())];
    const bool sensor = *field == "sensor";
    if (!known.name.empty() && !sensor) fail(part);
    if (sensor) parsed.cameras.push_back(column);
    if (known.name.empty()) known = column;
  }
  if (parsed.of(CsvField::kSensor).name.empty()) {
    throw CsvError("--columns: found " + quoted_bytes(text) + ", allowed: at least sensor=COLUMN");
  }
  if (parsed.cameras.size() == 1) parsed.cameras.clear();
  if (!parsed.cameras.empty() && !parsed.of(CsvField::kCamera).name.empty()) {
    throw CsvError("--columns: found " + quoted_bytes(text) +
                   ", allowed: several sensor=COLUMN, or camera=COLUMN");
  }
  return parsed;
}

ResolvedColumns resolve(const RecordingColumns& columns, const TableReader& table,
                        std::vector<std::string>& notes) {
  ResolvedColumns found;
  for (std::size_t field = 0; field < kCsvFields; ++field) {
    const std::string& name = columns.columns[field].name;
    if (!name.empty()) found.position[field] = wanted_position(name, table);
  }
  std::vector<RecordingColumns::Column> sensors = columns.cameras;
  if (sensors.empty()) sensors.push_back(columns.of(CsvField::kSensor));
  for (const RecordingColumns::Column& sensor : sensors) {
    found.sensors.push_back(
        stamps_of(sensor.name, sensor.unit, wanted_position(sensor.name, table), table, notes));
  }
  const RecordingColumns::Column& arrival = columns.of(CsvField::kArrival);
  if (arrival.name.empty()) {
    notes.emplace_back("no column is the arrival: stamps stand for it, so there is one clock only");
  } else {
    found.arrival =
        stamps_of(arrival.name, arrival.unit, wanted_position(arrival.name, table), table, notes);
  }
  found.exposure_unit = columns.of(CsvField::kExposure).unit;
  const RecordingColumns::Column& backend = columns.of(CsvField::kBackend);
  if (!backend.name.empty()) {
    found.backend =
        stamps_of(backend.name, backend.unit, wanted_position(backend.name, table), table, notes);
  }
  find_frame_columns(table.heading(), found);
  return found;
}

void find_frame_columns(const std::vector<std::string>& heading, ResolvedColumns& found) {
  const auto find = [&](CsvField field, std::initializer_list<std::string_view> names) {
    std::optional<std::size_t>& position = found.position[static_cast<std::size_t>(field)];
    for (std::size_t i = 0; i < heading.size() && !position; ++i) {
      if (!is_called(heading[i], names)) continue;
      position = i;
      if (field == CsvField::kExposure) found.exposure_unit = heading_unit(heading[i]);
    }
  };
  find(CsvField::kExposure, {"exposure", "exposure_us", "exposure_ms", "exposure_ns", "exposure_s",
                             "exposure(us)", "exposure(ms)", "exposure_time", "exposuretime",
                             "exposure_time_us", "actual_exposure", "actualexposure"});
  find(CsvField::kBytes, {"bytes", "frame_bytes", "size_bytes", "frame_size", "payload_bytes"});
  find(CsvField::kTemperature, {"temperature", "temperature_c", "temp_c", "asic_temperature"});
}

ResolvedColumns found_columns(const TableReader& table, std::vector<std::string>& notes) {
  std::vector<std::size_t> stamps;
  std::optional<std::size_t> counter;
  const std::size_t count = table.first_row().size();
  for (std::size_t i = 0; i < count; ++i) {
    const bool named = i < table.heading().size();
    if (named && is_called(table.heading()[i], {"frame", "seq", "counter", "frame_number", "f#",
                                                "frame_counter", "framenumber"})) {
      counter = i;
    } else if (may_be_stamps(table, i)) {
      stamps.push_back(i);
    }
  }
  if (stamps.size() != 1) {
    std::vector<std::string> choices;
    choices.reserve(stamps.size());
    for (const std::size_t i : stamps) choices.push_back(printable_name(column_label(table, i)));
    const std::string proposal =
        choices.size() == 2
            ? fmt::format("--columns sensor={},arrival={} (or the other way round)", choices[0],
                          choices[1])
            : std::string(
                  "--columns sensor=COLUMN:UNIT,arrival=COLUMN:UNIT with two of them, or their "
                  "numbers from 1");
    fail_in_table(table, fmt::format("found a table with the columns {}, which is none of "
                                     "rs-data-collect, allowed: {}",
                                     all_labels(table), proposal));
  }
  const std::string label = column_label(table, stamps.front());
  ResolvedColumns found;
  found.sensors.push_back(stamps_of(label, std::nullopt, stamps.front(), table, notes));
  found.position[static_cast<std::size_t>(CsvField::kCounter)] = counter;
  find_frame_columns(table.heading(), found);
  notes.push_back(
      fmt::format("column {} is taken for the stamps of the frames, and for their "
                  "arrivals: there is one clock only",
                  quoted_bytes(label)));
  return found;
}

}  // namespace simbench
