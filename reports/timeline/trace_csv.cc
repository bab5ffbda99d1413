#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <tuple>

#include "reports/timeline/trace.h"

namespace simbench::reports {
namespace {

double to_us(Nanoseconds time) { return static_cast<double>(time.count()) * 1e-3; }

std::string seconds_text(TrueTime at) {
  return fmt::format("{:.9f}", static_cast<double>(at.time_since_epoch().count()) * 1e-9);
}

// The columns in their order; only those with a value are written.
enum class TraceSeries : std::uint8_t {
  kPulse,
  kClock,
  kStep,
  kLatency,
  kStampError,
  kRange,
  kFrames,
  kCertified
};
struct TraceColumn {
  std::uint8_t group = 0;
  std::uint32_t place = 0;
  bool colour = false;
  TraceSeries series = TraceSeries::kPulse;
  friend bool operator<(const TraceColumn& a, const TraceColumn& b) {
    return std::tie(a.group, a.place, a.colour, a.series) <
           std::tie(b.group, b.place, b.colour, b.series);
  }
};

std::string column_name(const TraceColumn& column) {
  const char* colour = column.colour ? "/colour" : "";
  switch (column.series) {
    case TraceSeries::kPulse:
      return "trigger/pulse";
    case TraceSeries::kClock:
      return fmt::format("host{}/clock_error_us", column.place);
    case TraceSeries::kStep:
      return fmt::format("host{}/clock_step_us", column.place);
    case TraceSeries::kLatency:
      return fmt::format("camera{}{}/latency_ms", column.place, colour);
    case TraceSeries::kStampError:
      return fmt::format("camera{}{}/stamp_error_us", column.place, colour);
    case TraceSeries::kRange:
      return "gathering/stamps_range_us";
    case TraceSeries::kCertified:
      return "gathering/certified_ms";
    case TraceSeries::kFrames:
      break;
  }
  return "gathering/frames";
}

class TraceTable {
 public:
  void add(TrueTime at, const TraceColumn& column, double value) {
    if (column.place >= kTraceCsvPlaces) return;
    const auto number = columns_.try_emplace(column, columns_.size()).first->second;
    cells_.push_back({at, number, value});
  }

  void write(std::ostream& out) {
    std::vector<std::size_t> places(columns_.size());
    std::string line = "time_s";
    std::size_t place = 0;
    for (const auto& [column, number] : columns_) {
      places[number] = place++;
      line.append(",").append(column_name(column));
    }
    out << line << '\n';
    std::stable_sort(cells_.begin(), cells_.end(),
                     [](const Cell& a, const Cell& b) { return a.at < b.at; });
    for (auto cell = cells_.cbegin(); cell != cells_.cend();) {
      const TrueTime at = cell->at;
      std::vector<std::string> row(columns_.size());
      for (; cell != cells_.cend() && cell->at == at; ++cell) {
        row[places[cell->column]] = fmt::format("{:.3f}", cell->value);
      }
      out << seconds_text(at);
      for (const std::string& text : row) out << ',' << text;
      out << '\n';
    }
  }

 private:
  struct Cell {
    TrueTime at;
    std::size_t column;
    double value;
  };
  std::map<TraceColumn, std::size_t> columns_;
  std::vector<Cell> cells_;
};

void add_hosts(const Trace& trace, TraceTable& table) {
  for (const TraceClock& clock : trace.clocks) {
    if (clock.host == 0) continue;
    table.add(clock.at, {1, clock.host, false, TraceSeries::kClock}, to_us(clock.error));
  }
  for (const TraceAdjustment& adjustment : trace.adjustments) {
    if (adjustment.step.count() == 0) continue;
    table.add(adjustment.at, {1, adjustment.host, false, TraceSeries::kStep},
              to_us(adjustment.step));
  }
}

void add_frames(const Trace& trace, TraceTable& table) {
  for (const TraceFrame& frame : trace.frames) {
    const ObservedFrame& way = frame.way;
    if (way.fate != FrameFate::kDelivered) continue;
    const bool colour = way.stream == StreamKind::kColour;
    const TrueTime middle = way.exposure_start + (way.exposure_end - way.exposure_start) / 2;
    table.add(way.delivered, {2, way.camera, colour, TraceSeries::kLatency},
              to_ms(way.delivered - middle));
    if (!frame.stamp) continue;
    table.add(way.delivered, {2, way.camera, colour, TraceSeries::kStampError},
              to_us(frame.stamp->time_since_epoch() - frame.reference.time_since_epoch()));
  }
}

}  // namespace

void write_trace_csv(const Trace& trace, std::ostream& out) {
  TraceTable table;
  for (const ObservedPulse& pulse : trace.pulses) {
    table.add(pulse.at, {0, 0, false, TraceSeries::kPulse}, static_cast<double>(pulse.pulse));
  }
  add_hosts(trace, table);
  add_frames(trace, table);
  for (const TraceSet& set : trace.sets) {
    table.add(set.end, {3, 0, false, TraceSeries::kRange}, to_us(set.range));
    table.add(set.end, {3, 0, false, TraceSeries::kFrames}, static_cast<double>(set.members));
    if (set.certified_ms) {
      table.add(set.end, {3, 0, false, TraceSeries::kCertified}, *set.certified_ms);
    }
  }
  table.write(out);
}

std::vector<std::string> trace_csv_notes(const Trace& trace) {
  if (std::max<std::size_t>(trace.hosts, trace.cameras.size()) <= kTraceCsvPlaces) return {};
  return {fmt::format("the table has columns of the first {} of {} cameras and {} hosts",
                      kTraceCsvPlaces, trace.cameras.size(), trace.hosts)};
}

}  // namespace simbench::reports
