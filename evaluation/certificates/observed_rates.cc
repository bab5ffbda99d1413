#include "evaluation/certificates/observed_rates.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "laws/line_fit.h"

namespace simbench::evaluation {
namespace {

constexpr std::int64_t kShortestNs = kSecondNs;

// A reading of one clock by another: when, by how much it is ahead, and how long it may have waited
// (or a measure of that).
struct ClockReading {
  LinePoint point;
  double waited = 0;
};

double slope_of(const std::vector<ClockReading>& readings) {
  LineSums sums(readings.size());
  for (const ClockReading& reading : readings) sums.add(reading.point);
  return sums.line().slope;
}

// The slope of the quicker half; nothing of too few.
std::optional<double> quick_slope(std::vector<ClockReading> readings) {
  if (readings.size() < kFewestObserved) return std::nullopt;
  const auto at = [](const ClockReading& reading) { return reading.point.x; };
  const auto [first, last] = std::ranges::minmax(readings, {}, at);
  if (last.point.x - first.point.x < kShortestNs) return std::nullopt;
  // From the first one, so that the sums are exact for any epoch.
  const LinePoint zero = first.point;
  for (ClockReading& reading : readings) {
    reading.point.x -= zero.x;
    reading.point.y -= zero.y;
  }
  std::ranges::stable_sort(readings, {}, &ClockReading::waited);
  readings.resize((readings.size() + 1) / 2);
  return slope_of(readings);
}

// Messages of one direction by how far they lie above a line through all of them.
std::optional<double> message_slope(std::vector<ClockReading> readings, double sign) {
  if (readings.size() < kFewestObserved) return std::nullopt;
  LineSums sums(readings.size());
  const LinePoint zero = readings.front().point;
  for (ClockReading& reading : readings) {
    reading.point.x -= zero.x;
    reading.point.y -= zero.y;
    sums.add(reading.point);
  }
  const Line line = sums.line();
  for (ClockReading& reading : readings) {
    reading.waited = sign * (static_cast<double>(reading.point.y) - line.at(reading.point.x));
  }
  return quick_slope(std::move(readings));
}

// How fast host `b` is against host `a`.
std::optional<double> host_slope(const CaptureEvidence& evidence, std::uint32_t a,
                                 std::uint32_t b) {
  std::vector<ClockReading> there, back;
  for (const HostMessage& message : evidence.messages()) {
    const std::int64_t sent = nanoseconds_of(message.sent);
    const std::int64_t received = nanoseconds_of(message.received);
    if (message.from == a && message.to == b) there.push_back({{sent, received - sent}});
    if (message.from == b && message.to == a) back.push_back({{received, sent - received}});
  }
  const auto forward = message_slope(std::move(there), 1);
  const auto backward = message_slope(std::move(back), -1);
  if (forward && backward) return (*forward + *backward) / 2;
  return forward ? forward : backward;
}

std::optional<double> camera_slope(const CaptureEvidence& evidence, std::uint32_t camera) {
  std::vector<ClockReading> readings;
  for (const ClockPollEvidence& poll : evidence.polls()) {
    if (poll.camera != camera) continue;
    const Nanoseconds round_trip = poll.t1 - poll.t0;
    const std::int64_t middle = nanoseconds_of(poll.t0) + round_trip.count() / 2;
    readings.push_back({{middle, nanoseconds_of(poll.device) - middle}, to_ns(round_trip)});
  }
  return quick_slope(std::move(readings));
}

// Nothing beyond what an oscillator may be off: then the stamps are no readings.
std::optional<double> chained_ppm(double own_ppm, double slope) {
  const double ppm = ((1 + own_ppm * 1e-6) * (1 + slope) - 1) * 1e6;
  return std::abs(ppm) <= Assumptions::kMostRate_ppm ? std::optional(ppm) : std::nullopt;
}

}  // namespace

std::vector<std::optional<double>> observed_rates_ppm(const CaptureEvidence& evidence) {
  const std::uint32_t hosts = evidence.layout().hosts;
  const auto ends = hosts + static_cast<std::uint32_t>(evidence.outside_clocks().size());
  std::vector<std::optional<double>> rates(evidence.clocks());
  rates[0] = 0;
  // From host to host, or to a clock outside, as far as messages lead.
  std::vector<std::uint32_t> reached = {0};
  for (std::size_t next = 0; next < reached.size(); ++next) {
    for (std::uint32_t other = 0; other < ends; ++other) {
      std::optional<double>& rate = rates[evidence.clock_of(other)];
      if (rate) continue;
      const auto slope = host_slope(evidence, reached[next], other);
      if (!slope) continue;
      rate = chained_ppm(*rates[evidence.clock_of(reached[next])], *slope);
      if (rate) reached.push_back(other);
    }
  }
  for (std::uint32_t camera = 0; camera < evidence.layout().cameras.size(); ++camera) {
    const std::optional<double>& host = rates[evidence.layout().cameras[camera].host];
    const auto slope = camera_slope(evidence, camera);
    if (host && slope) rates[hosts + camera] = chained_ppm(*host, *slope);
  }
  return rates;
}

}  // namespace simbench::evaluation
