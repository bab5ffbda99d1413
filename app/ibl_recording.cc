#include "app/ibl_recording.h"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

#include "algorithms/device_time/unwrap.h"
#include "recording/line_reader.h"
#include "recording/number_in.h"
#include "recording/rs_csv.h"
#include "recording/text_fields.h"
#include "scenarios/input_file.h"

namespace simbench::app {
namespace {

constexpr std::int64_t kCyclesPerSecond = 8000;
constexpr std::int64_t kOffsetsPerCycle = 3072;
constexpr std::int64_t kTicksPerSecond = kCyclesPerSecond * kOffsetsPerCycle;
constexpr std::int64_t kNsPerTick = 100;  // the host's ticks
constexpr std::int64_t kTicksPerMs = 1'000'000 / kNsPerTick;
constexpr std::size_t kIsoDigits = 27;  // 2020-08-19T12:42:57.7903616
constexpr std::size_t kRowBytes = 4 * sizeof(double);

// A reading in units of 1/24576000 s; nothing if its cycles or offsets exceed their limits.
std::optional<std::int64_t> cycle_clock_ticks(std::uint32_t reading) {
  const std::int64_t seconds = reading >> 25;
  const std::int64_t cycles = (reading >> 12) & 0x1fff;
  const std::int64_t offsets = reading & 0xfff;
  if (cycles >= kCyclesPerSecond || offsets >= kOffsetsPerCycle) return std::nullopt;
  return (seconds * kCyclesPerSecond + cycles) * kOffsetsPerCycle + offsets;
}

// Unwraps the readings of a recording.
class CycleClock {
 public:
  std::optional<Nanoseconds> stamp(std::uint32_t reading) {
    const std::optional<std::int64_t> ticks = cycle_clock_ticks(reading);
    if (!ticks) return std::nullopt;
    const double seconds =
        static_cast<double>(unwrapper_.unwrap(*ticks)) / static_cast<double>(kTicksPerSecond);
    return Nanoseconds(std::llround(seconds * 1e9));
  }

 private:
  CounterUnwrapper<128 * kTicksPerSecond> unwrapper_;
};

// "2020-08-19T12:42:57.7903616-04:00" as time since 1970 in UTC.
std::optional<Nanoseconds> iso_time(std::string_view text) {
  using std::chrono::hours, std::chrono::minutes, std::chrono::seconds;
  if (text.size() != kIsoDigits + 6) return std::nullopt;
  const auto field = [&](std::size_t at, std::size_t size) {
    return number_in<unsigned>(text.substr(at, size));
  };
  const auto year = field(0, 4), month = field(5, 2), day = field(8, 2);
  const auto hour = field(11, 2), minute = field(14, 2), second = field(17, 2);
  const auto fraction = field(20, 7), zone_hour = field(28, 2), zone_minute = field(31, 2);
  const char sign = text[kIsoDigits];
  if (!year || !month || !day || !hour || !minute || !second || !fraction || !zone_hour ||
      !zone_minute || (sign != '+' && sign != '-')) {
    return std::nullopt;
  }
  const std::chrono::year_month_day date{std::chrono::year(static_cast<int>(*year)),
                                         std::chrono::month(*month), std::chrono::day(*day)};
  if (!date.ok() || *hour > 23 || *minute > 59 || *second > 60) return std::nullopt;
  const Nanoseconds zone = hours(*zone_hour) + minutes(*zone_minute);
  const Nanoseconds local = std::chrono::sys_days{date}.time_since_epoch() + hours(*hour) +
                            minutes(*minute) + seconds(*second) +
                            Nanoseconds(*fraction * kNsPerTick);
  return sign == '-' ? local + zone : local - zone;
}

void count_from_first_arrival(std::vector<StampedFrame>& frames) {
  const Nanoseconds first = frames.front().arrival;
  for (StampedFrame& frame : frames) frame.arrival -= first;
}

// A float that stands for a whole number from 0 to `largest`.
std::optional<std::uint64_t> whole_float(double value, double largest) {
  if (!(value >= 0 && value <= largest) || value != std::floor(value)) return std::nullopt;
  return static_cast<std::uint64_t>(value);
}

// The lines of a *.timestamps.ssv.
class IblTimestamps {
 public:
  void add(std::string_view line, const std::string& place) {
    line = line.substr(0, line.find_last_not_of(" \r") + 1);
    if (line.empty()) return;
    const std::size_t blank = std::min(line.find(' '), line.size());
    const auto arrival = iso_time(line.substr(0, blank));
    const auto reading = number_in<std::uint32_t>(line.substr(std::min(blank + 1, line.size())));
    const auto sensor = reading ? clock_.stamp(*reading) : std::nullopt;
    if (!arrival || !sensor) {
      throw CsvError(fmt::format(
          "{}: allowed: a time as 2020-08-19T12:42:57.7903616-04:00, a blank, a cycle clock",
          place));
    }
    frames_.push_back({.counter = frames_.size(), .sensor = *sensor, .arrival = *arrival});
  }

  std::vector<StampedFrame> take(const LineReader& lines, const std::string& path) {
    if (lines.torn()) {
      throw CsvError(fmt::format(
          "{}: found no line end, so the line may be cut; remove it or end it", lines.place()));
    }
    if (frames_.empty()) throw CsvError(path + ":1: the file has no frame");
    count_from_first_arrival(frames_);
    return std::move(frames_);
  }

 private:
  std::vector<StampedFrame> frames_;
  CycleClock clock_;
};

std::vector<StampedFrame> read_ibl_timestamps(const std::string& path) {
  try {
    LineReader lines(path, Pipes::kRefused);
    IblTimestamps timestamps;
    while (const auto line = lines.next()) timestamps.add(*line, lines.place());
    return timestamps.take(lines, path);
  } catch (const LineError& error) {
    throw CsvError(error.what());
  }
}

}  // namespace

std::vector<StampedFrame> parse_ibl_frame_data(std::string_view bytes, const std::string& path) {
  static_assert(std::endian::native == std::endian::little, "the file is little-endian");
  if (bytes.empty() || bytes.size() % kRowBytes != 0) {
    throw CsvError(fmt::format("{}: found {} bytes, allowed: rows of {} bytes", path, bytes.size(),
                               kRowBytes));
  }
  std::vector<StampedFrame> frames;
  CycleClock clock;
  std::optional<std::uint64_t> first_ticks;
  for (std::size_t row = 0; row * kRowBytes < bytes.size(); ++row) {
    std::array<double, 4> cells = {};
    std::memcpy(cells.data(), bytes.data() + row * kRowBytes, kRowBytes);
    const auto ticks = whole_float(cells[0], 0x1p62);
    const auto reading = whole_float(cells[1], std::numeric_limits<std::uint32_t>::max());
    const auto counter = whole_float(cells[2], 0x1p53);
    const auto sensor = reading ? clock.stamp(static_cast<std::uint32_t>(*reading)) : std::nullopt;
    if (ticks && !first_ticks) first_ticks = ticks;
    // Ticks since the year 1 do not fit 64-bit nanoseconds; those since the first frame do.
    const auto since_first = static_cast<std::int64_t>(ticks.value_or(0) - first_ticks.value_or(0));
    if (!ticks || !sensor || !counter || std::abs(since_first) > kLargestStampMs * kTicksPerMs) {
      throw CsvError(fmt::format(
          "{}: row {}: allowed: host ticks, a cycle clock, a frame counter, GPIO bits", path, row));
    }
    frames.push_back(
        {.counter = *counter, .sensor = *sensor, .arrival = Nanoseconds(since_first * kNsPerTick)});
  }
  return frames;
}

bool is_ibl_recording(const std::string& path) {
  return path.ends_with(".timestamps.ssv") || path.ends_with(".frameData.bin");
}

std::vector<StampedFrame> read_ibl_recording(const std::string& path) {
  const bool timestamps = path.ends_with(".ssv");
  if (!timestamps && !path.ends_with(".bin")) {
    throw CsvError(path + ": allowed: a file named *.timestamps.ssv or *.frameData.bin");
  }
  if (timestamps) return read_ibl_timestamps(path);
  constexpr std::size_t kLargest = std::size_t{512} << 20;
  try {
    return parse_ibl_frame_data(file_content(path, kLargest, Pipes::kRefused), path);
  } catch (const FileError& error) {
    throw CsvError(fmt::format("{}: cannot be read: {}", path, error.what()));
  }
}

RecordedStream ibl_stream(std::vector<StampedFrame> frames) {
  RecordedStream stream;
  stream.stream = "Color 0";
  stream.frames = std::move(frames);
  return stream;
}

}  // namespace simbench::app
