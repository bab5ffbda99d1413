// Common view: every host sees the same pulses, so their clocks can be compared without the
// network's delays (after TriggerSync).
//
// Each host observes the pulses (pulse_observer.h): as frames of its cameras, on a trigger line, or
// as PPS. Once per steer_interval a slave requests the time at which the master saw some pulse, and
// finds the pulse nearest to it among its own. The two sightings are of one instant, plus the
// difference of the least delays, which for equal cameras is 0:
//
//   c = (master's clock, by the two-way hull, at the own sighting) - (the master's sighting)
//
// is the error of the two-way hull: half the asymmetry of the link, a constant that is subtracted
// from the hull's line. The rate, and everything before the first pulse, thus comes from the
// network (two_way_estimators.h), which also identifies the pulses (wrongly if its error ever
// exceeds half a period). The pulses correct its offset, during the capture too.
//
// c has a standard deviation s (pulse_observer.h, of both hosts). Before there are many pulses it
// is worse than the network, so only what c says of the error is subtracted. The prior is causality
// alone: no message arrives before it left, so the hull's error is at most half of the least round
// trip, b = width / 2 of its corridor, and every value in between counts the same. Subtracted is
// the mean of the error given c: of N(c, s^2), cut off at +-b.
//
// Limit: unequal least delays between hosts (other USB controllers, other cameras, cables) go into
// the offset, where the network alone would have been right: up to b, and unseen as far as they are
// common to a host's cameras.
//
// Frames and trigger lines have pulses during the capture only, PPS always. A slave without the
// port reports that as its outcome and ends; if the master lacks the port and does not answer, the
// network alone counts.
// Source: TriggerSync (docs/reference/host_sync.md names it; method as described here).
#pragma once

#include <optional>
#include <vector>

#include "algorithms/host_sync/pulses/pulse_observer.h"
#include "algorithms/host_sync/two_way/two_way.h"

namespace simbench {

struct CommonViewSettings {
  TwoWaySettings two_way;
  TwoWayHull::Settings hull;
  PulseObserver::Settings pulses;

  void bind(ParameterBinder& parameters);
};

// c and its standard deviation.
struct CommonViewCorrection {
  double offset_ns = 0;
  double sigma_ns = 0;
};

// The part of c to subtract where the error is at most `bound_ns` either way.
double common_view_correction_ns(CommonViewCorrection measured, double bound_ns);

class CommonView : public HostSync {
 public:
  explicit CommonView(CommonViewSettings settings) : settings_(settings) {}
  std::optional<Nanoseconds> warm_up() const override { return settings_.two_way.service_time; }
  Task<void> run_master(Host& host, std::vector<PeerId> slaves) override;
  Task<void> run_slave(Host& host, PeerId master) override;

 private:
  CommonViewSettings settings_;
};

}  // namespace simbench
