#include "recording/rs_csv.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <utility>

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

std::optional<Header> parse_header(const std::vector<std::string_view>& cells) {
  Header header;
  header.position.fill(kAbsent);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const auto* column = std::find(kColumns.begin(), kColumns.end(), plain_name(cells[i]));
    if (column == kColumns.end()) continue;
    header.position[static_cast<std::size_t>(column - kColumns.begin())] = i;
    header.cells_needed = i + 1;
  }
  const auto required_end = header.position.begin() + kRequiredColumns;
  if (std::find(header.position.begin(), required_end, kAbsent) != required_end) {
    return std::nullopt;
  }
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

CameraStream& CsvRecordingReader::stream_of(std::string_view camera, std::string_view host,
                                            std::string_view stream) {
  key_.assign(camera).append(",").append(stream);
  const auto [entry, is_new] = index_.try_emplace(key_, streams_.size());
  if (is_new) {
    streams_.push_back({std::string(camera), std::string(host), std::string(stream), {}});
  }
  return streams_[entry->second];
}

void CsvRecordingReader::read_file(const std::string& path) {
  std::error_code no_folder;
  if (std::filesystem::is_directory(path, no_folder)) {
    throw CsvError(path + ": is a folder, not a CSV file");
  }
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  std::ostringstream content;
  if (file) content << file.rdbuf();
  if (!file || file.bad()) {
    throw CsvError(path + ": cannot be read: " + std::strerror(errno ? errno : EIO));
  }
  read_text(content.view(), path);
}

void CsvRecordingReader::read_text(std::string_view text, const std::string& path) {
  Place place{.path = path};
  const std::string name = std::filesystem::path(path).stem().string();
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  std::optional<Header> header;
  bool preamble = false;
  bool any_frame = false;
  std::vector<std::string_view> cells;
  std::string stream_name;
  while (!text.empty()) {
    ++place.line;
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = trimmed(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.empty()) continue;
    split(line, cells);
    if (!header || is_header_again(cells)) {
      header = parse_header(cells);
      if (header) {
        preamble = false;
        continue;
      }
      preamble = preamble || line.starts_with("Configuration");
      if (preamble) continue;
      place.fail("found " + quoted_bytes(line) + ", allowed: the header " + kHeader);
    }
    if (cells.size() < header->cells_needed) {
      place.fail("found " + std::to_string(cells.size()) + " cells, allowed: at least " +
                 std::to_string(header->cells_needed) + "; is the line complete?");
    }
    const auto cell = [&](ColumnId id) { return cells[header->position[id]]; };
    if (is_motion(cell(kStream))) continue;
    const std::string_view camera = header->position[kCamera] == kAbsent ? name : cell(kCamera);
    const std::string_view host = header->position[kHost] == kAbsent ? name : cell(kHost);
    if (camera.empty() || host.empty() || cell(kStream).empty()) {
      place.fail("found an empty cell, allowed: the name of a stream, camera or host");
    }
    stream_name.assign(cell(kStream)).append(" ").append(cell(kIndex));
    stream_of(camera, host, stream_name).frames.push_back(frame_of(cells, *header, place));
    any_frame = true;
  }
  if (place.line == 0)
    throw CsvError(path + ":1: the file is empty, allowed: the header " + kHeader);
  if (!any_frame) place.fail("the file ends without a frame");
}

std::vector<CameraStream> CsvRecordingReader::take() {
  index_.clear();
  return std::exchange(streams_, {});
}

std::vector<CameraStream> read_recordings(const std::vector<std::string>& files) {
  CsvRecordingReader reader;
  for (auto file = files.begin(); file != files.end(); ++file) {
    if (std::find(files.begin(), file, *file) != file) throw CsvError(*file + ": given twice");
    reader.read_file(*file);
  }
  return reader.take();
}

}  // namespace simbench
