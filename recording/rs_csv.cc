#include "recording/rs_csv.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <map>
#include <optional>
#include <system_error>
#include <utility>

#include "recording/line_reader.h"
#include "recording/text_fields.h"

namespace simbench {
namespace {

constexpr const char* kHeader = "Stream Type,Index,F#,HW Timestamp (ms),Host Timestamp(ms)";
constexpr std::size_t kAbsent = static_cast<std::size_t>(-1);

enum ColumnId : std::size_t { kStream, kIndex, kCounter, kSensor, kArrival, kCamera, kHost };
constexpr std::array<std::string_view, 7> kColumns = {
    "streamtype", "index", "f#", "hwtimestamp(ms)", "hosttimestamp(ms)", "camera", "host"};
constexpr std::size_t kRequiredColumns = 5;

struct Header {
  std::array<std::size_t, kColumns.size()> position = {};
  std::size_t cells = 0;         // of the header itself; a line with more has decimal commas
  std::size_t cells_needed = 0;  // a line with fewer is truncated
};

// A place in the text, for messages.
struct Place {
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

void split(std::string_view line, std::vector<std::string_view>& cells) {
  cells.clear();
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
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

// Nothing if it is no header.
std::optional<Header> parse_header(const std::vector<std::string_view>& cells, const Place& place) {
  Header header;
  header.cells = cells.size();
  header.position.fill(kAbsent);
  std::optional<std::size_t> repeated;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const auto* column = std::find(kColumns.begin(), kColumns.end(), plain_name(cells[i]));
    if (column == kColumns.end()) continue;
    std::size_t& position = header.position[static_cast<std::size_t>(column - kColumns.begin())];
    if (position != kAbsent) repeated = i;
    position = i;
    header.cells_needed = i + 1;
  }
  const auto required_end = header.position.begin() + kRequiredColumns;
  if (std::find(header.position.begin(), required_end, kAbsent) != required_end) {
    return std::nullopt;
  }
  if (repeated) place.fail("found the column " + quoted_bytes(cells[*repeated]) + " twice");
  return header;
}

bool is_header_again(const std::vector<std::string_view>& cells) {
  return plain_name(cells.front()) == kColumns[kStream];
}

bool is_motion(std::string_view stream) {
  return stream == "Gyro" || stream == "Accel" || stream == "Pose";
}

Nanoseconds stamp_of(std::string_view cell, const char* column, const Place& place) {
  const std::optional<Nanoseconds> stamp = parse_ms(cell, kLargestStampMs);
  if (!stamp) {
    place.fail(std::string(column) + ": found " + quoted_bytes(cell) +
               ", allowed: a number of milliseconds up to 4e12");
  }
  return *stamp;
}

std::uint64_t counter_of(std::string_view cell, const Place& place) {
  std::uint64_t counter = 0;
  const auto [stop, error] = std::from_chars(cell.data(), cell.data() + cell.size(), counter);
  if (error != std::errc() || stop != cell.data() + cell.size()) {
    place.fail("F#: found " + quoted_bytes(cell) + ", allowed: a whole number");
  }
  return counter;
}

StampedFrame frame_of(const std::vector<std::string_view>& cells, const Header& header,
                      const Place& place) {
  StampedFrame frame;
  frame.counter = counter_of(cells[header.position[kCounter]], place);
  frame.sensor = stamp_of(cells[header.position[kSensor]], "HW Timestamp (ms)", place);
  if (frame.sensor < Nanoseconds::zero()) {
    place.fail("HW Timestamp (ms): found " + quoted_bytes(cells[header.position[kSensor]]) +
               ", allowed: 0 or more");
  }
  frame.arrival = stamp_of(cells[header.position[kArrival]], "Host Timestamp(ms)", place);
  return frame;
}

}  // namespace

// One file as it is read, line by line.
class CsvRecordingReader::File {
 public:
  File(CsvRecordingReader& reader, const std::string& path, std::string name)
      : reader_(reader), place_{.path = path}, name_(std::move(name)) {
    if (name_.empty()) name_ = std::filesystem::path(path).stem().string();
  }

  void read_line(std::string_view line);
  // After the last line; `torn`: bytes without a line end follow.
  void end(bool torn);

 private:
  bool take_header(std::string_view line);
  void check_cells() const;
  CameraStream& stream_of(std::string_view camera, std::string_view host);
  const Naming& naming_of(std::string_view camera, std::string_view host);
  void check_naming(const Naming& naming, std::string_view camera, std::string_view host) const;

  bool has(ColumnId id) const { return header_->position[id] != kAbsent; }
  std::string_view cell(ColumnId id) const { return cells_[header_->position[id]]; }

  CsvRecordingReader& reader_;
  Place place_;
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
  split(line, cells_);
  if ((!header_ || is_header_again(cells_)) && take_header(line)) return;
  check_cells();
  if (is_motion(cell(kStream))) return;
  const std::string_view camera = has(kCamera) ? cell(kCamera) : name_;
  const std::string_view host = has(kHost) ? cell(kHost) : name_;
  if (camera.empty() || host.empty() || cell(kStream).empty()) {
    place_.fail("found an empty cell, allowed: the name of a stream, camera or host");
  }
  stream_of(camera, host).frames.push_back(frame_of(cells_, *header_, place_));
  any_frame_ = true;
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
  header_ = parse_header(cells_, place_);
  preamble_ = !header_ && (preamble_ || line.starts_with("Configuration"));
  if (header_ || preamble_) return true;
  place_.fail("found " + quoted_bytes(line) + ", allowed: the header " + kHeader);
}

void CsvRecordingReader::File::check_cells() const {
  if (cells_.size() < header_->cells_needed) {
    place_.fail("found " + std::to_string(cells_.size()) + " cells, allowed: at least " +
                std::to_string(header_->cells_needed) + "; is the line complete?");
  }
  // Motion has more values than older versions of the tool have columns.
  if (cells_.size() > header_->cells && !is_motion(cell(kStream))) {
    place_.fail("found " + std::to_string(cells_.size()) +
                " cells, allowed: " + std::to_string(header_->cells) +
                ", as in the header; do the numbers have decimal commas?");
  }
}

CameraStream& CsvRecordingReader::File::stream_of(std::string_view camera, std::string_view host) {
  key_.assign(camera).append(",").append(cell(kStream)).append(" ").append(cell(kIndex));
  auto known = reader_.index_.find(key_);
  if (known == reader_.index_.end()) {
    const Naming& naming = naming_of(camera, host);
    const std::size_t number = reader_.streams_.size();
    known = reader_.index_.emplace(key_, Known{number, &naming}).first;
    reader_.streams_.push_back(
        {printable_name(camera),
         printable_name(naming.host),
         printable_name(std::string(cell(kStream)).append(" ").append(cell(kIndex))),
         {}});
  }
  check_naming(*known->second.camera, camera, host);
  return reader_.streams_[known->second.stream];
}

const CsvRecordingReader::Naming& CsvRecordingReader::File::naming_of(std::string_view camera,
                                                                      std::string_view host) {
  return reader_.cameras_
      .try_emplace(std::string(camera), Naming{.path = place_.path,
                                               .by_column = has(kCamera),
                                               .with_host = has(kHost),
                                               .host = std::string(host)})
      .first->second;
}

void CsvRecordingReader::File::check_naming(const Naming& naming, std::string_view camera,
                                            std::string_view host) const {
  const bool goes_on = naming.by_column && has(kCamera);
  if (!goes_on && naming.path != place_.path) {
    place_.fail("camera " + quoted_bytes(camera) + " is in " + naming.path +
                " too, allowed: files of different names, or a column `camera` in each");
  }
  if (naming.with_host && has(kHost) && naming.host != host) {
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
    LineReader lines(path);
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

std::vector<CameraStream> CsvRecordingReader::take() {
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

}  // namespace

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
  return names;
}

RecordedStreams read_recordings(const std::vector<std::string>& files, const ReadProgress& progress) {
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
