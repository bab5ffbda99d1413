#include "algorithms/certificates/steady_readings.h"

#include <algorithm>

#include "algorithms/host_sync/clock_steering.h"

namespace simbench {
namespace {

// The lines are those of the recording within so much.
constexpr Nanoseconds kLineError{2};

ClockLine line_from(SteadyTime at, HostTime reads, double rate_ppb) {
  return {.at = at, .value = reads, .rate_ppb = rate_ppb};
}

}  // namespace

HostTime SteadyReadings::read(const Line& line, SteadyTime at) {
  return line_from(line.at, line.reads, line.rate_ppb).read(at);
}

SteadyTime SteadyReadings::instant(const Line& line, HostTime reading) {
  return line_from(line.at, line.reads, line.rate_ppb).when(reading);
}

void SteadyReadings::add(const ClockAdjustment& adjustment) {
  HostTime highest = HostTime::min();
  if (!lines_.empty()) {
    highest = std::max(lines_.back().highest_before, read(lines_.back(), adjustment.at));
  }
  lines_.push_back({adjustment.at, adjustment.after, adjustment.rate_ppb, highest});
}

std::optional<SteadyRange> SteadyReadings::when(HostTime from, HostTime to) const {
  std::optional<SteadyRange> range;
  for (std::size_t i = lines_.size(); i-- > 0;) {
    const Line& line = lines_[i];
    // The first line goes back before its begin, the last one on for ever.
    const SteadyTime begin = i == 0 ? SteadyTime::min() : line.at;
    const SteadyTime end = i + 1 == lines_.size() ? SteadyTime::max() : lines_[i + 1].at;
    const SteadyTime first = std::max(begin, instant(line, from) - kLineError);
    const SteadyTime last = std::min(end, instant(line, to) + kLineError);
    if (first <= last) {
      if (!range) range = SteadyRange{first, last};
      range->first = std::min(range->first, first);
      range->last = std::max(range->last, last);
    }
    if (line.highest_before + kLineError < from) break;
  }
  return range;
}

}  // namespace simbench
