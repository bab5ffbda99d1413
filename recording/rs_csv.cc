#include "recording/rs_csv.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <system_error>
#include <utility>

#include "recording/line_reader.h"
#include "recording/number_in.h"
#include "recording/text_fields.h"

namespace simbench {
namespace {

constexpr const char* kHeader = "Stream Type,Index,F#,HW Timestamp (ms),Host Timestamp(ms)";
constexpr std::size_t kAbsent = static_cast<std::size_t>(-1);

constexpr std::array<std::string_view, kCsvFields> kFieldNames = {
    "stream", "index", "counter", "sensor", "arrival", "camera", "host"};

struct Unit {
  std::string_view name;
  int exponent;  // of ten, to milliseconds
};
constexpr std::array<Unit, 4> kUnits = {{{"ns", -6}, {"us", -3}, {"ms", 0}, {"s", 3}}};

// Returns the columns that rs-data-collect writes.
const RecordingColumns& usual_columns() {
  static const RecordingColumns columns{{{{"Stream Type"},
                                          {"Index"},
                                          {"F#"},
                                          {"HW Timestamp (ms)"},
                                          {"Host Timestamp(ms)"},
                                          {"camera"},
                                          {"host"}}}};
  return columns;
}

struct Header {
  std::array<std::size_t, kCsvFields> position = {};
  char separator = ',';
  std::size_t cells = 0;         // of the header itself; a line with more has decimal commas
  std::size_t cells_needed = 0;  // a line with fewer is truncated
};

// A place in the text, for messages.
struct CsvPlace {
  const std::string& path;
  std::size_t line = 0;

  [[noreturn]] void fail(const std::string& problem) const {
    throw CsvError(path + ":" + std::to_string(line) + ": " + problem);
  }
};

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r";
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

void split(std::string_view line, char separator, std::vector<std::string_view>& cells) {
  cells.clear();
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(separator, begin), line.size());
    cells.push_back(trimmed(line.substr(begin, end - begin)));
    begin = end + 1;
  }
}

// The plain name: blanks and capitals differ between versions of the tool.
std::string plain_name(std::string_view cell) {
  std::string name;
  for (const char c : cell) {
    if (c == ' ') continue;
    name += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  }
  return name;
}

// Whether a file must have the column: rs-data-collect writes five, others those that are named.
bool is_required(const RecordingColumns& columns, CsvField field, bool usual) {
  if (usual) return field != CsvField::kCamera && field != CsvField::kHost;
  return !columns.of(field).name.empty();
}

// Nothing if it is no header.
std::optional<Header> parse_header(const std::vector<std::string_view>& cells,
                                   const RecordingColumns& columns, bool usual,
                                   const CsvPlace& place) {
  Header header;
  header.cells = cells.size();
  header.position.fill(kAbsent);
  std::optional<std::size_t> repeated;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    for (std::size_t field = 0; field < kCsvFields; ++field) {
      const std::string& name = columns.columns[field].name;
      if (name.empty() || plain_name(cells[i]) != plain_name(name)) continue;
      if (header.position[field] != kAbsent) repeated = i;
      header.position[field] = i;
      header.cells_needed = i + 1;
    }
  }
  for (std::size_t field = 0; field < kCsvFields; ++field) {
    if (header.position[field] == kAbsent &&
        is_required(columns, static_cast<CsvField>(field), usual)) {
      return std::nullopt;
    }
  }
  if (repeated) place.fail("found the column " + quoted_bytes(cells[*repeated]) + " twice");
  return header;
}

// Finds the separator of a header, whatever its columns.
char separator_of(std::string_view line) {
  char best = ',';
  for (const char candidate : {';', '\t'}) {
    if (std::count(line.begin(), line.end(), candidate) >
        std::count(line.begin(), line.end(), best)) {
      best = candidate;
    }
  }
  return best;
}

bool is_header_again(const std::vector<std::string_view>& cells, const Header& header,
                     const RecordingColumns& columns, bool usual) {
  const CsvField field = usual ? CsvField::kStream : CsvField::kSensor;
  const std::size_t position = usual ? 0 : header.position[static_cast<std::size_t>(field)];
  return position < cells.size() &&
         plain_name(cells[position]) == plain_name(columns.of(field).name);
}

bool is_motion(std::string_view stream) {
  return stream == "Gyro" || stream == "Accel" || stream == "Pose";
}

// The number times a power of ten, digit by digit: a double would lose some. Nothing if the text is
// no plain decimal number.
std::optional<std::string> shifted(std::string_view text, int exponent) {
  const bool negative = text.starts_with('-');
  if (negative) text.remove_prefix(1);
  const std::size_t point = std::min(text.find('.'), text.size());
  std::string digits(text.substr(0, point));
  std::string fraction(text.substr(std::min(point + 1, text.size())));
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  if (digits.empty() || !std::ranges::all_of(digits, is_digit) ||
      !std::ranges::all_of(fraction, is_digit)) {
    return std::nullopt;
  }
  for (; exponent > 0; --exponent) {
    digits += fraction.empty() ? '0' : fraction.front();
    fraction.erase(0, fraction.empty() ? 0 : 1);
  }
  for (; exponent < 0; ++exponent) {
    fraction.insert(0, 1, digits.empty() ? '0' : digits.back());
    if (!digits.empty()) digits.pop_back();
  }
  return (negative ? "-" : "") + (digits.empty() ? "0" : digits) + "." + fraction + "0";
}

Nanoseconds stamp_of(std::string_view cell, const RecordingColumns::Column& column,
                     const CsvPlace& place) {
  std::optional<Nanoseconds> stamp;
  if (column.exponent == 0) {
    stamp = parse_ms(cell, kLargestStampMs);
  } else if (const auto ms = shifted(cell, column.exponent)) {
    stamp = parse_ms(*ms, kLargestStampMs);
  }
  if (stamp) return *stamp;
  place.fail(column.name + ": found " + quoted_bytes(cell) + ", allowed: a number of " +
             (column.exponent == 0 ? "milliseconds up to 4e12" : "its unit, up to 126 years"));
}

std::uint64_t counter_of(std::string_view cell, const std::string& column, const CsvPlace& place) {
  if (const auto counter = number_in<std::uint64_t>(cell)) return *counter;
  place.fail(column + ": found " + quoted_bytes(cell) + ", allowed: a whole number");
}

}  // namespace

// One file as it is read, line by line.
class CsvRecordingReader::File {
 public:
  File(CsvRecordingReader& reader, const std::string& path, std::string name)
      : reader_(reader),
        columns_(reader.columns_ ? *reader.columns_ : usual_columns()),
        place_{.path = path},
        name_(std::move(name)) {
    if (name_.empty()) name_ = std::filesystem::path(path).stem().string();
  }

  void read_line(std::string_view line);
  // After the last line; `torn`: bytes without a line end follow.
  void end(bool torn);

 private:
  bool is_usual() const { return !reader_.columns_; }
  bool take_header(std::string_view line);
  [[noreturn]] void fail_header(std::string_view line) const;
  void check_cells() const;
  StampedFrame frame(std::uint64_t order) const;
  RecordedStream& stream_of(std::string_view camera, std::string_view host);
  const Naming& naming_of(std::string_view camera, std::string_view host);
  void check_naming(const Naming& naming, std::string_view camera, std::string_view host) const;

  bool has(CsvField field) const {
    return header_->position[static_cast<std::size_t>(field)] != kAbsent;
  }
  std::string_view cell(CsvField field) const {
    return cells_[header_->position[static_cast<std::size_t>(field)]];
  }
  // "Depth 0"; "frame" where no column says it.
  std::string stream_name() const {
    if (!has(CsvField::kStream)) return "frame";
    std::string name(cell(CsvField::kStream));
    if (has(CsvField::kIndex)) name.append(" ").append(cell(CsvField::kIndex));
    return name;
  }
  bool is_motion_line() const { return is_usual() && is_motion(cell(CsvField::kStream)); }

  CsvRecordingReader& reader_;
  const RecordingColumns& columns_;
  CsvPlace place_;
  std::string name_;
  std::optional<Header> header_;
  bool preamble_ = false;
  bool any_frame_ = false;
  std::vector<std::string_view> cells_;
  std::string key_;
};

void CsvRecordingReader::File::read_line(std::string_view line) {
  if (++place_.line == 1 && line.starts_with("\xef\xbb\xbf")) line.remove_prefix(3);
  line = trimmed(line);
  if (line.empty()) return;
  split(line, header_ ? header_->separator : is_usual() ? ',' : separator_of(line), cells_);
  if ((!header_ || is_header_again(cells_, *header_, columns_, is_usual())) && take_header(line))
    return;
  check_cells();
  if (is_motion_line()) return;
  const std::string_view camera = has(CsvField::kCamera) ? cell(CsvField::kCamera) : name_;
  const std::string_view host = has(CsvField::kHost) ? cell(CsvField::kHost) : name_;
  if (camera.empty() || host.empty() ||
      (has(CsvField::kStream) && cell(CsvField::kStream).empty())) {
    place_.fail("found an empty cell, allowed: the name of a stream, camera or host");
  }
  RecordedStream& stream = stream_of(camera, host);
  stream.frames.push_back(frame(stream.frames.size()));
  any_frame_ = true;
}

StampedFrame CsvRecordingReader::File::frame(std::uint64_t order) const {
  StampedFrame frame;
  const std::string& name = columns_.of(CsvField::kCounter).name;
  frame.counter =
      has(CsvField::kCounter) ? counter_of(cell(CsvField::kCounter), name, place_) : order;
  const RecordingColumns::Column& sensor = columns_.of(CsvField::kSensor);
  frame.sensor = stamp_of(cell(CsvField::kSensor), sensor, place_);
  if (frame.sensor < Nanoseconds::zero()) {
    place_.fail(sensor.name + ": found " + quoted_bytes(cell(CsvField::kSensor)) +
                ", allowed: 0 or more");
  }
  frame.arrival = stamp_of(cell(CsvField::kArrival), columns_.of(CsvField::kArrival), place_);
  return frame;
}

void CsvRecordingReader::File::end(bool torn) {
  if (torn) {
    ++place_.line;
    reader_.notes_.push_back(place_.path + ":" + std::to_string(place_.line) +
                             ": the last line has no line end and may be cut; it was left out");
  }
  if (place_.line == 0) {
    throw CsvError(place_.path + ":1: the file is empty, allowed: the header " + kHeader);
  }
  if (!any_frame_) place_.fail("the file ends without a frame");
}

// False for a line that is neither a header nor before one.
bool CsvRecordingReader::File::take_header(std::string_view line) {
  const char separator = is_usual() ? ',' : separator_of(line);
  header_ = parse_header(cells_, columns_, is_usual(), place_);
  if (header_) header_->separator = separator;
  preamble_ = !header_ && is_usual() && (preamble_ || line.starts_with("Configuration"));
  if (header_ || preamble_) return true;
  fail_header(line);
}

void CsvRecordingReader::File::fail_header(std::string_view line) const {
  if (is_usual()) {
    place_.fail("found " + quoted_bytes(line) + ", allowed: the header " + kHeader +
                ", or --columns sensor=COLUMN,arrival=COLUMN for columns of other names");
  }
  std::string missing;
  for (const RecordingColumns::Column& column : columns_.columns) {
    const bool there = std::any_of(cells_.begin(), cells_.end(), [&](std::string_view cell) {
      return plain_name(cell) == plain_name(column.name);
    });
    if (!column.name.empty() && !there) missing += (missing.empty() ? "" : ", ") + column.name;
  }
  place_.fail("found no column " + quoted_bytes(missing) + " in the header " + quoted_bytes(line));
}

void CsvRecordingReader::File::check_cells() const {
  if (cells_.size() < header_->cells_needed) {
    place_.fail("found " + std::to_string(cells_.size()) + " cells, allowed: at least " +
                std::to_string(header_->cells_needed) + "; is the line complete?");
  }
  // Motion has more values than older versions of the tool have columns.
  if (cells_.size() > header_->cells && !is_motion_line()) {
    place_.fail("found " + std::to_string(cells_.size()) +
                " cells, allowed: " + std::to_string(header_->cells) +
                ", as in the header; do the numbers have decimal commas?");
  }
}

RecordedStream& CsvRecordingReader::File::stream_of(std::string_view camera,
                                                    std::string_view host) {
  const std::string name = stream_name();
  key_.assign(camera).append(",").append(name);
  auto known = reader_.index_.find(key_);
  if (known == reader_.index_.end()) {
    const Naming& naming = naming_of(camera, host);
    const std::size_t number = reader_.streams_.size();
    known = reader_.index_.emplace(key_, Known{number, &naming}).first;
    reader_.streams_.push_back(
        {printable_name(camera), printable_name(naming.host), printable_name(name), {}});
    RecordedStream& added = reader_.streams_.back();
    added.counted = has(CsvField::kCounter);
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
  constexpr std::uint64_t kProgressBytes = std::uint64_t{1} << 20;
  try {
    LineReader lines(path, Pipes::kRefused);
    File file(*this, path, name);
    std::uint64_t reported = 0;
    while (const auto line = lines.next()) {
      file.read_line(*line);
      if (!progress || lines.bytes_read() - reported < kProgressBytes) continue;
      reported = lines.bytes_read();
      progress(reported, lines.size());
    }
    file.end(lines.torn());
  } catch (const LineError& error) {
    throw CsvError(error.what());
  }
}

void CsvRecordingReader::read_text(std::string_view text, const std::string& path) {
  File file(*this, path, {});
  std::size_t end = 0;
  while ((end = text.find('\n')) != std::string_view::npos) {
    file.read_line(text.substr(0, end));
    text.remove_prefix(end + 1);
  }
  file.end(!text.empty());
}

RecordingColumns RecordingColumns::parse(const std::string& text) {
  const auto fail = [](std::string_view found) {
    throw CsvError("--columns: found " + quoted_bytes(found) +
                   ", allowed: FIELD=COLUMN or FIELD=COLUMN:UNIT with commas between them; fields "
                   "stream, index, counter, sensor, arrival, camera, host; units ns, us, ms, s");
  };
  RecordingColumns parsed;
  std::vector<std::string_view> parts;
  split(text, ',', parts);
  for (const std::string_view part : parts) {
    const std::size_t equals = part.find('=');
    const auto* field = std::find(kFieldNames.begin(), kFieldNames.end(), part.substr(0, equals));
    if (equals == std::string_view::npos || field == kFieldNames.end()) fail(part);
    Column& column = parsed.columns[static_cast<std::size_t>(field - kFieldNames.begin())];
    std::string_view name = part.substr(equals + 1);
    const std::size_t colon = name.rfind(':');
    if (colon != std::string_view::npos) {
      const auto* unit = std::find_if(kUnits.begin(), kUnits.end(), [&](const Unit& known) {
        return known.name == name.substr(colon + 1);
      });
      if (unit == kUnits.end()) fail(part);
      column.exponent = unit->exponent;
      name = name.substr(0, colon);
    }
    if (name.empty() || !column.name.empty()) fail(part);
    column.name = std::string(name);
  }
  if (parsed.of(CsvField::kSensor).name.empty() || parsed.of(CsvField::kArrival).name.empty()) {
    throw CsvError("--columns: found " + quoted_bytes(text) +
                   ", allowed: at least sensor=COLUMN and arrival=COLUMN");
  }
  return parsed;
}

std::vector<RecordedStream> CsvRecordingReader::take() {
  index_.clear();
  cameras_.clear();
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
