#include "recording/rs_csv.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <system_error>
#include <utility>

#include "recording/counted.h"
#include "recording/date_time.h"
#include "recording/line_reader.h"
#include "recording/number_in.h"
#include "recording/table.h"
#include "recording/text_fields.h"

namespace simbench {
namespace {

constexpr const char* kHeader = "Stream Type,Index,F#,HW Timestamp (ms),Host Timestamp(ms)";
constexpr std::size_t kHeaderLines = 200;  // the header stands in the first ones
constexpr std::size_t kHeaderBytes = std::size_t{1} << 20;

// What rs-data-collect calls its columns, by field; the last two are optional.
constexpr std::array<std::string_view, kCsvFields> kUsualNames = {
    "streamtype", "index",       "f#",      "hwtimestamp(ms)", "hosttimestamp(ms)", "camera",
    "host",       "exposure_us", "backend", "bytes",           "temperature_c"};
constexpr std::size_t kUsualFields = 5;

using Positions = std::array<std::optional<std::size_t>, kCsvFields>;

// A place in the text, for messages.
struct CsvPlace {
  const std::string& path;
  std::size_t line = 0;

  [[noreturn]] void fail(const std::string& problem) const {
    throw CsvError(path + ":" + std::to_string(line) + ": " + problem);
  }
};

// Nothing where a quote does not end.
std::optional<std::vector<std::string_view>> cells_at_commas(std::string_view line,
                                                             std::deque<std::string>& unquoted) {
  std::vector<std::string_view> cells;
  if (!split_row(line, ',', cells, unquoted)) return std::nullopt;
  return cells;
}

// Nothing if it is no header.
std::optional<Positions> usual_positions(const std::vector<std::string_view>& cells,
                                         const CsvPlace& place) {
  Positions found;
  std::optional<std::size_t> repeated;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::string plain = plain_column_name(cells[i]);
    for (std::size_t field = 0; field < kCsvFields; ++field) {
      if (plain != kUsualNames[field]) continue;
      if (found[field]) repeated = i;
      found[field] = i;
    }
  }
  for (std::size_t field = 0; field < kUsualFields; ++field) {
    const bool is_needed = field != static_cast<std::size_t>(CsvField::kCounter);
    if (!found[field] && is_needed) return std::nullopt;
  }
  if (repeated) place.fail("found the column " + quoted_bytes(cells[*repeated]) + " twice");
  return found;
}

bool is_preamble(std::string_view line) { return line.starts_with("Configuration"); }

bool is_motion(std::string_view stream) {
  return stream == "Gyro" || stream == "Accel" || stream == "Pose";
}

Nanoseconds stamp_of(std::string_view cell, const ResolvedColumns::Stamps& column,
                     const CsvPlace& place) {
  std::optional<Nanoseconds> stamp = column.unit == kMillisecondUnit
                                         ? parse_ms(cell, kLargestStampMs)
                                         : time_in(cell, column.unit);
  if (!stamp) stamp = date_time_in(cell);
  if (stamp && std::abs(stamp->count()) <= kLargestStampMs * 1'000'000) return *stamp;
  place.fail(column.name + ": found " + quoted_bytes(cell) + ", allowed: a number of " +
             unit_text(column.unit) + " up to 126 years, or a time such as 2024-09-03T10:32:22Z");
}

// A counter that numpy wrote as a double is whole all the same.
std::uint64_t counter_of(std::string_view cell, const CsvPlace& place) {
  constexpr double kExact = 9e15;
  if (const auto counter = number_in<std::uint64_t>(cell)) return *counter;
  const std::optional<double> value = number_in<double>(cell);
  if (value && *value >= 0 && *value <= kExact && *value == std::floor(*value)) {
    return static_cast<std::uint64_t>(*value);
  }
  place.fail("counter: found " + quoted_bytes(cell) + ", allowed: a whole number");
}

ResolvedColumns usual_columns(const Positions& positions) {
  const auto stamps = [&](CsvField field, const char* name) {
    return ResolvedColumns::Stamps{.name = name,
                                   .position = *positions[static_cast<std::size_t>(field)],
                                   .unit = kMillisecondUnit};
  };
  return {.position = positions,
          .sensors = {stamps(CsvField::kSensor, "HW Timestamp (ms)")},
          .arrival = stamps(CsvField::kArrival, "Host Timestamp(ms)")};
}

}  // namespace

// One file as it is read, line by line.
class CsvRecordingReader::File {
 public:
  File(CsvRecordingReader& reader, const std::string& path, std::string name,
       const ReadProgress& progress)
      : reader_(reader), place_{.path = path}, name_(std::move(name)), progress_(progress) {
    if (name_.empty()) name_ = std::filesystem::path(path).stem().string();
  }

  void read(LineReader lines);

 private:
  using Cells = std::vector<std::string_view>;

  bool is_usual(LineReader& lines) const;
  void read_usual(LineReader& lines);
  void read_usual_line(std::string_view line);
  void read_table(LineReader lines);
  void read_row(const Cells& cells);
  void check_width(const Cells& cells, std::size_t fewest, std::size_t most) const;
  void add_frame(const Cells& cells, std::string_view camera, std::string_view host,
                 const ResolvedColumns::Stamps& sensor);
  void report(const LineReader& lines);
  void end(bool torn, bool empty);
  void note(const std::string& text) { reader_.notes_.push_back(place_.path + ": " + text); }

  RecordedStream& stream_of(std::string_view camera, std::string_view host, const Cells& cells);
  const Naming& naming_of(std::string_view camera, std::string_view host);
  void check_naming(const Naming& naming, std::string_view camera, std::string_view host) const;

  bool has(CsvField field) const {
    return columns_.position[static_cast<std::size_t>(field)].has_value();
  }
  void add_columns(const Cells& cells, RecordedStream& stream) const;
  // NaN for a cell that is no number.
  double number_of(const Cells& cells, CsvField field) const {
    return number_in<double>(cell(cells, field)).value_or(std::numeric_limits<double>::quiet_NaN());
  }
  std::string_view cell(const Cells& cells, CsvField field) const {
    return cells[*columns_.position[static_cast<std::size_t>(field)]];
  }
  // "Depth 0"; "frame" where no column says it.
  std::string stream_name(const Cells& cells) const {
    if (!has(CsvField::kStream)) return "frame";
    std::string name(cell(cells, CsvField::kStream));
    if (has(CsvField::kIndex)) name.append(" ").append(cell(cells, CsvField::kIndex));
    return name;
  }

  CsvRecordingReader& reader_;
  CsvPlace place_;
  std::string name_;
  const ReadProgress& progress_;
  std::uint64_t reported_ = 0;
  ResolvedColumns columns_{};
  std::size_t width_ = 0;  // cells of a row
  bool preamble_ = false;
  bool usual_ = false;  // in the form of rs-data-collect, which counts frames
  bool any_frame_ = false;
  std::uint64_t missing_ = 0;
  std::size_t first_missing_ = 0;  // its line
  std::deque<std::string> unquoted_{};
  std::string key_{};
};

void CsvRecordingReader::File::read(LineReader lines) {
  bool usual = false;
  if (!reader_.columns_) {
    lines.mark();
    usual = is_usual(lines);
    lines.rewind();
  }
  usual_ = usual;
  if (usual) {
    read_usual(lines);
  } else {
    read_table(std::move(lines));
  }
}

// By its header, or by what stands before it.
bool CsvRecordingReader::File::is_usual(LineReader& lines) const {
  std::size_t bytes = 0;
  for (std::size_t i = 0; i < kHeaderLines && bytes < kHeaderBytes; ++i) {
    const std::optional<std::string_view> line = lines.next();
    if (!line) return false;
    bytes += line->size();
    if (is_preamble(*line)) return true;
    std::deque<std::string> unquoted;
    const std::optional<Cells> cells = cells_at_commas(*line, unquoted);
    if (cells && usual_positions(*cells, {place_.path, lines.line()})) return true;
  }
  return false;
}

void CsvRecordingReader::File::read_usual(LineReader& lines) {
  bool empty = true;
  while (const auto line = lines.next()) {
    empty = false;
    place_.line = lines.line();
    read_usual_line(*line);
    report(lines);
  }
  place_.line = lines.line();
  end(lines.torn(), empty);
}

void CsvRecordingReader::File::read_usual_line(std::string_view line) {
  unquoted_.clear();
  const std::optional<Cells> whole = cells_at_commas(line, unquoted_);
  if (!whole && width_ == 0 && preamble_) return;
  if (!whole) place_.fail("found a quote without its end, allowed: a row on one line");
  const Cells& cells = *whole;
  if (cells.size() == 1 && cells.front().empty()) return;
  if (width_ == 0 || plain_column_name(cells.front()) == kUsualNames.front()) {
    if (const auto positions = usual_positions(cells, place_)) {
      columns_ = usual_columns(*positions);
      width_ = cells.size();
      return;
    }
    preamble_ = width_ == 0 && (preamble_ || is_preamble(line));
    if (preamble_) return;
    place_.fail("found " + quoted_bytes(line) + ", allowed: the header " + kHeader);
  }
  std::size_t fewest = 0;
  for (const auto& position : columns_.position) {
    if (position) fewest = std::max(fewest, *position + 1);
  }
  // Motion has more values than older versions of the tool have columns.
  const bool motion = cells.size() >= fewest && is_motion(cell(cells, CsvField::kStream));
  check_width(cells, fewest, motion ? cells.size() : width_);
  if (!motion) read_row(cells);
}

void CsvRecordingReader::File::read_table(LineReader lines) {
  TableReader table(std::move(lines));
  place_.line = 1;
  if (table.first_row().empty()) end(table.torn(), table.heading().empty());
  std::vector<std::string> notes;
  columns_ =
      reader_.columns_ ? resolve(*reader_.columns_, table, notes) : found_columns(table, notes);
  for (const std::string& text : notes) note(text);
  width_ = std::max(table.heading().size(), table.first_row().size());
  while (const Cells* cells = table.next()) {
    place_.line = table.line();
    check_width(*cells, width_, width_);
    read_row(*cells);
    report(table.lines());
  }
  if (table.torn()) place_.line = table.lines().line();
  end(table.torn(), false);
}

void CsvRecordingReader::File::report(const LineReader& lines) {
  constexpr std::uint64_t kProgressBytes = std::uint64_t{1} << 20;
  if (!progress_ || lines.bytes_read() - reported_ < kProgressBytes) return;
  reported_ = lines.bytes_read();
  progress_(reported_, lines.size());
}

void CsvRecordingReader::File::check_width(const Cells& cells, std::size_t fewest,
                                           std::size_t most) const {
  if (cells.size() < fewest) {
    place_.fail("found " + std::to_string(cells.size()) +
                " cells, allowed: " + (most > fewest ? "at least " : "") + std::to_string(fewest) +
                "; is the line complete?");
  }
  if (cells.size() > most) {
    place_.fail("found " + std::to_string(cells.size()) + " cells, allowed: " +
                std::to_string(most) + ", as in the header; do the numbers have decimal commas?");
  }
}

void CsvRecordingReader::File::read_row(const Cells& cells) {
  const std::string_view host = has(CsvField::kHost) ? cell(cells, CsvField::kHost) : name_;
  for (const ResolvedColumns::Stamps& sensor : columns_.sensors) {
    std::string_view camera = name_;
    if (has(CsvField::kCamera)) {
      camera = cell(cells, CsvField::kCamera);
    } else if (columns_.sensors.size() > 1) {
      camera = sensor.name;
    }
    if (camera.empty() || host.empty() ||
        (has(CsvField::kStream) && cell(cells, CsvField::kStream).empty())) {
      place_.fail("found an empty cell, allowed: the name of a stream, camera or host");
    }
    add_frame(cells, camera, host, sensor);
  }
}

void CsvRecordingReader::File::add_frame(const Cells& cells, std::string_view camera,
                                         std::string_view host,
                                         const ResolvedColumns::Stamps& sensor) {
  const bool without_arrival =
      columns_.arrival && is_missing_cell(cells[columns_.arrival->position]);
  if (is_missing_cell(cells[sensor.position]) || without_arrival) {
    if (missing_++ == 0) first_missing_ = place_.line;
    return;
  }
  RecordedStream& stream = stream_of(camera, host, cells);
  StampedFrame frame;
  frame.counter = has(CsvField::kCounter) ? counter_of(cell(cells, CsvField::kCounter), place_)
                                          : stream.frames.size();
  frame.sensor = stamp_of(cells[sensor.position], sensor, place_);
  frame.arrival = columns_.arrival
                      ? stamp_of(cells[columns_.arrival->position], *columns_.arrival, place_)
                      : frame.sensor;
  stream.frames.push_back(frame);
  add_columns(cells, stream);
  any_frame_ = true;
}

void CsvRecordingReader::File::add_columns(const Cells& cells, RecordedStream& stream) const {
  FrameColumns& columns = stream.columns;
  if (has(CsvField::kExposure)) {
    constexpr double kMicroseconds = 1e6;
    const double scale =
        columns_.exposure_unit ? columns_.exposure_unit->seconds() * kMicroseconds : 1;
    stream.set(columns.exposure_us, number_of(cells, CsvField::kExposure) * scale);
  }
  if (has(CsvField::kBytes)) stream.set(columns.bytes, number_of(cells, CsvField::kBytes));
  if (has(CsvField::kTemperature)) {
    stream.set(columns.temperature_c, number_of(cells, CsvField::kTemperature));
  }
  if (columns_.backend && !is_missing_cell(cells[columns_.backend->position])) {
    const Nanoseconds backend =
        stamp_of(cells[columns_.backend->position], *columns_.backend, place_);
    stream.set(columns.backend_ms, to_ms(backend - stream.frames.back().arrival));
  }
}

void CsvRecordingReader::File::end(bool torn, bool empty) {
  if (torn) {
    reader_.notes_.push_back(place_.path + ":" + std::to_string(place_.line) +
                             ": the last line has no line end and may be cut; it was left out");
  }
  if (empty && !torn) {
    throw CsvError(place_.path + ":1: the file is empty, allowed: the header " + kHeader +
                   ", or a table of stamps");
  }
  if (missing_ > 0) {
    note(counted(missing_, "cell") + " without a stamp left out, the first in line " +
         std::to_string(first_missing_));
  }
  if (!any_frame_) place_.fail("the file ends without a frame");
}

RecordedStream& CsvRecordingReader::File::stream_of(std::string_view camera, std::string_view host,
                                                    const Cells& cells) {
  const std::string name = stream_name(cells);
  key_.assign(camera).append(",").append(name);
  auto known = reader_.index_.find(key_);
  if (known == reader_.index_.end()) {
    const Naming& naming = naming_of(camera, host);
    const std::size_t number = reader_.streams_.size();
    if (number == kMostRecordedStreams) {
      place_.fail("found more than " + std::to_string(kMostRecordedStreams) +
                  " streams of cameras, allowed: at most so many; has the column `camera` names?");
    }
    known = reader_.index_.emplace(key_, Known{number, &naming}).first;
    reader_.streams_.push_back(
        {printable_name(camera), printable_name(naming.host), printable_name(name), {}});
    RecordedStream& added = reader_.streams_.back();
    added.counted = has(CsvField::kCounter);
    added.realsense = usual_ && has(CsvField::kCounter);
    added.origin.file = place_.path;
  }
  check_naming(*known->second.camera, camera, host);
  return reader_.streams_[known->second.stream];
}

const CsvRecordingReader::Naming& CsvRecordingReader::File::naming_of(std::string_view camera,
                                                                      std::string_view host) {
  return reader_.cameras_
      .try_emplace(std::string(camera), Naming{.path = place_.path,
                                               .by_column = has(CsvField::kCamera),
                                               .with_host = has(CsvField::kHost),
                                               .host = std::string(host)})
      .first->second;
}

void CsvRecordingReader::File::check_naming(const Naming& naming, std::string_view camera,
                                            std::string_view host) const {
  const bool goes_on = naming.by_column && has(CsvField::kCamera);
  if (!goes_on && naming.path != place_.path) {
    place_.fail("camera " + quoted_bytes(camera) + " is in " + naming.path +
                " too, allowed: files of different names, or a column `camera` in each");
  }
  if (naming.with_host && has(CsvField::kHost) && naming.host != host) {
    place_.fail("camera " + quoted_bytes(camera) + ": found host " + quoted_bytes(host) +
                ", allowed: " + quoted_bytes(naming.host) +
                " as before; cameras need names of "
                "their own");
  }
}

void CsvRecordingReader::read_file(const std::string& path, const std::string& name,
                                   const ReadProgress& progress) {
  try {
    File(*this, path, name, progress).read(LineReader(path, Pipes::kRefused));
  } catch (const LineError& error) {
    throw CsvError(error.what());
  }
}

void CsvRecordingReader::read_text(std::string_view text, const std::string& path) {
  try {
    File(*this, path, {}, {}).read(LineReader(path, text));
  } catch (const LineError& error) {
    throw CsvError(error.what());
  }
}

std::vector<RecordedStream> CsvRecordingReader::take() {
  index_.clear();
  cameras_.clear();
  for (RecordedStream& stream : streams_) stream.complete_columns();
  return std::exchange(streams_, {});
}

namespace {

namespace fs = std::filesystem;

// The last `count` parts of a path, without its extension.
std::string last_parts(const fs::path& path, std::size_t count) {
  const fs::path plain = fs::path(path).replace_extension().lexically_normal();
  std::vector<fs::path> parts(plain.begin(), plain.end());
  if (parts.size() > count) {
    parts.erase(parts.begin(), parts.end() - static_cast<std::ptrdiff_t>(count));
  }
  fs::path name;
  for (const fs::path& part : parts) name /= part;
  return name.generic_string();
}

}  // namespace

void check_given_once(const std::vector<std::string>& files) {
  for (std::size_t i = 0; i < files.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      std::error_code none;
      if (files[i] != files[j] && !fs::equivalent(files[i], files[j], none)) continue;
      throw CsvError(files[i] + ": given twice" +
                     (files[i] == files[j] ? "" : ", also as " + files[j]));
    }
  }
}

std::vector<std::string> camera_names(const std::vector<std::string>& files) {
  std::vector<std::string> names(files.size());
  std::vector<std::size_t> unnamed(files.size());
  for (std::size_t i = 0; i < files.size(); ++i) unnamed[i] = i;
  constexpr std::size_t kMostParts = 64;
  for (std::size_t parts = 1; !unnamed.empty() && parts <= kMostParts; ++parts) {
    std::map<std::string, std::size_t> count;
    for (const std::size_t file : unnamed) {
      names[file] = last_parts(files[file], parts);
      ++count[names[file]];
    }
    std::erase_if(unnamed, [&](std::size_t file) { return count[names[file]] == 1; });
  }
  // They differ by their extension, if at all.
  for (const std::size_t file : unnamed) names[file] = files[file];
  for (std::string& name : names) name = printable_name(name);
  return names;
}

RecordedStreams read_recordings(const std::vector<std::string>& files,
                                const ReadProgress& progress) {
  check_given_once(files);
  const std::vector<std::string> names = camera_names(files);
  std::uint64_t total = 0;
  for (const std::string& file : files) {
    std::error_code none;
    const std::uintmax_t size = fs::file_size(file, none);
    if (!none) total += size;
  }
  CsvRecordingReader reader;
  std::uint64_t before = 0;
  for (std::size_t i = 0; i < files.size(); ++i) {
    std::uint64_t done = 0;
    reader.read_file(files[i], names[i], [&](std::uint64_t bytes, std::uint64_t) {
      done = bytes;
      if (progress) progress(std::min(before + done, total), total);
    });
    before += done;
  }
  return {reader.take(), reader.notes()};
}

}  // namespace simbench
