// GNSS-disciplined hosts: each has a receiver whose PPS interrupts it and whose message has the
// time of the pulse. All hosts, the master too, follow GNSS time; no message passes between them.
//
// Interrupts are late, never early. The lower envelope of (GNSS time, steady clock minus GNSS time)
// of the last pulses therefore has, at the middle of the window, a touching line that gives offset
// and rate; the system clock is steered along it (clock_steering.h). The interrupt's least delay is
// in every host's clock alike, and so in no difference between them.
//
// A service. A slave without the line, or whose receiver sends no time within 10 s, reports
// that as its outcome.
// Source: theory; PulseStamp::gnss in algorithms/ports/host.h.
#pragma once

#include <optional>
#include <vector>

#include "algorithms/host_sync/clock_service.h"
#include "algorithms/host_sync/clock_steering.h"
#include "algorithms/host_sync/two_way/two_way_estimators.h"
#include "algorithms/ports/host.h"
#include "laws/lower_hull.h"

namespace simbench {

struct GnssSettings {
  Nanoseconds service_time = from_ms(60e3);  // before the capture
  Nanoseconds window = from_ms(60e3);
  SteeringSettings steering{};

  void bind(ParameterBinder& parameters);
};

// GNSS time over a steady clock, from pulses that are seen late. Only computes.
class GnssEstimator {
 public:
  static constexpr std::size_t kFewestPulses = 4;

  explicit GnssEstimator(Nanoseconds window);
  // A pulse at `gnss`, seen at `seen`. One that is more than kJumpNs off starts the fit anew.
  void add(Nanoseconds gnss, SteadyTime seen);
  // Nothing before kFewestPulses, nor for a rate beyond 0.1 %, which no clock has.
  std::optional<ClockLine> line() const;

 private:
  static constexpr double kJumpNs = 1e6;

  Envelope lateness_;
  bool has_zero_ = false;
  Nanoseconds zero_gnss_{0};
  SteadyTime zero_seen_{};
  std::size_t pulses_ = 0;
};

Task<void> serve_gnss(Host& host, std::vector<PeerId> slaves, GnssSettings settings);
Task<void> follow_gnss(Host& host, PeerId master, GnssSettings settings);
using Gnss = ClockService<GnssSettings, serve_gnss, follow_gnss>;

}  // namespace simbench
