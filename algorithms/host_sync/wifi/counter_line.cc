#include "algorithms/host_sync/wifi/counter_line.h"

namespace simbench {

void CounterLine::add(Nanoseconds at, Nanoseconds ahead) {
  const std::optional<Fit> known = fit();
  if (known) {
    const Nanoseconds off = ahead - known->ahead(at);
    if (off > kJump || -off > kJump) readings_.clear();
  }
  readings_.push_back({at, ahead});
  while (readings_.front().at < at - window_) readings_.pop_front();
}

std::optional<CounterLine::Fit> CounterLine::fit() const {
  if (readings_.size() < kFewestReadings || readings_.front().at >= readings_.back().at) {
    return std::nullopt;
  }
  const Reading& zero = readings_.back();
  LineSums sums(readings_.size());
  for (const Reading& reading : readings_) {
    sums.add({.x = micros(reading.at - zero.at), .y = (reading.ahead - zero.ahead).count()});
  }
  return Fit{.zero_at = zero.at, .zero_ahead = zero.ahead, .line = sums.line()};
}

}  // namespace simbench
