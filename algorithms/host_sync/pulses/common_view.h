// Common view: every host sees the same pulses, so their clocks can be compared without the
// network's delays (after TriggerSync).
//
// Each host notes when it saw the pulses with the least delay (pulse_observer.h): as frames of its
// cameras, on a trigger line, or as PPS. Once per steer_interval a slave asks the master when it
// saw some pulse, and finds the pulse that it saw itself nearest to that. The two sightings are of
// one instant, plus the difference of the least delays, which for equal cameras is 0:
//
//   c = (master's clock, by the two-way hull, at the own sighting) - (the master's sighting)
//
// is the error of the two-way hull: the half asymmetry of the link. It is a constant, taken off the
// hull's line. So the rate and everything before the first pulse come from the network
// (two_way_estimators.h), which also tells which pulse is which (wrong if its error ever exceeds
// half a period), and the pulses correct its offset, during the capture too.
//
// c is known with a standard deviation s (split halves of both hosts' pulses). Before there are
// many pulses it is worse than the network, so only w c is taken off, with
//
//   w = a^2 / (a^2 + s^2),  a = asymmetry_sigma / 2;   w = 1 if |c| > 8 s
//
// What it cannot know: unequal least delays between hosts (other USB controllers, other cameras,
// cables) go into the offset as they are, where the network alone would have been right.
//
// Frames and trigger lines have pulses during the capture only, PPS always.
// A slave without the port reports that as its outcome and ends; without answers from the master
// (it lacks the port) the network alone counts.
// Source: TriggerSync (docs/reference/host_sync.md names it; method as described here).
#ifndef SIMBENCH_ALGORITHMS_HOST_SYNC_PULSES_COMMON_VIEW_H_
#define SIMBENCH_ALGORITHMS_HOST_SYNC_PULSES_COMMON_VIEW_H_

#include <cstdint>
#include <optional>
#include <vector>

#include "algorithms/host_sync/pulses/pulse_observer.h"
#include "algorithms/host_sync/two_way/two_way.h"
#include "algorithms/host_sync/two_way/two_way_estimators.h"
#include "algorithms/ports/host.h"

namespace simbench {

// The messages in which the master tells its slaves when it saw a pulse.
//
// 28 bytes, little-endian, request and answer alike:
//
//   offset  size  field
//   0       2     magic 0x5643 ("CV")
//   2       1     version, 1
//   3       1     kind: 1 request, 2 answer
//   4       4     index of the request, from 1
//   8       8     answer: the pulse, on the master's system clock, ns; else 0
//   16      8     answer: its standard deviation, ns; else 0
//   24      4     answer: 1 if there is a pulse; else 0
struct CommonViewMessage {
  // What the master saw.
  struct Pulse {
    HostTime at{};
    std::int64_t sigma_ns = 0;  // not negative
    friend bool operator==(const Pulse&, const Pulse&) = default;
  };
  bool is_answer = false;
  std::uint32_t index = 0;
  std::optional<Pulse> pulse{};  // in answers
  friend bool operator==(const CommonViewMessage&, const CommonViewMessage&) = default;
};

Bytes encode(const CommonViewMessage& message);

// Nothing, if the bytes are not what encode() makes of some message with times within +-4e18 ns.
std::optional<CommonViewMessage> decode_common_view_message(const Bytes& bytes);

struct CommonViewSettings {
  TwoWaySettings two_way;
  TwoWayHull::Settings hull;
  PulseObserver::Settings pulses;
  double asymmetry_sigma_us = 10;
};

// c and how far it can be trusted.
struct CommonViewCorrection {
  double offset_ns = 0;
  double sigma_ns = 0;
};

// The part of c to take off.
double common_view_correction_ns(CommonViewCorrection measured, double asymmetry_sigma_us);

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

#endif  // SIMBENCH_ALGORITHMS_HOST_SYNC_PULSES_COMMON_VIEW_H_
