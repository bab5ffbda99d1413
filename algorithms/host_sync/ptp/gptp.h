// Generalised PTP (IEEE 802.1AS): time-aware stations in a chain or tree, by the network cards'
// stamps.
//
// Problem: in a chain of boundary clocks each host's servo follows the servo before it, so that
// noise and every correction of the master grow from hop to hop (gain peaking).
//
// Key idea: nobody steers the clocks that stamp. A station measures how fast its neighbour's clock
// runs against its own (peer delay, once a second) and computes the grandmaster's time at any
// instant of its own clock. As a relay it forwards *that*: preciseOriginTimestamp unchanged, in
// correctionField the delays of the links and the residence in each relay, in the grandmaster's
// time by the cumulative rate ratio. Only the system clock has a servo (as phc2sys), and no other
// host sees what it does.
//
// The master's card follows its system clock, whose time is the domain's. A link whose delay is
// above neighborPropDelayThresh has something in between that does not know 802.1AS: its port is
// not asCapable and takes no Sync; the slave's outcome says so. A switch that knows 802.1AS is
// /network/switch_clock "transparent". Sync is sent at a station's own pace, not as it comes in
// (syncLocked is false); there is no Announce, who is grandmaster is stated. Messages of another
// domain than `domain` are ignored.
//
// A service. A slave reports its outcome when its system clock is first steered, or after
// `patience` without that; it goes on in either case. One without the stamps reports that and ends.
// Source: IEEE 802.1AS-2020, 10.2, 11.2, Annex B; linuxptp, configs/gPTP.cfg (intervals,
// threshold); docs/reference/host_sync.md section 1 (gPTP).
#pragma once

#include <vector>

#include "algorithms/host_sync/clock_service.h"
#include "algorithms/host_sync/ptp/ptp_servo.h"
#include "algorithms/ports/host.h"

namespace simbench {

struct GptpSettings {
  Nanoseconds service_time = from_ms(60e3);  // before the capture
  Nanoseconds sync_interval = from_ms(125);
  Nanoseconds delay_interval = from_ms(1000);
  std::size_t delay_exchanges = 8;  // over which delay and rate ratio are taken
  double most_link_delay_ns = 800;  // neighborPropDelayThresh
  int domain = 0;
  ServoSettings servo_limits{};  // of the system clock
  Nanoseconds patience = from_ms(30e3);

  void bind(ParameterBinder& parameters);
};

Task<void> serve_gptp(Host& host, std::vector<PeerId> slaves, GptpSettings settings);
Task<void> follow_gptp(Host& host, PeerId master, GptpSettings settings);
// A time-aware relay.
Task<void> relay_gptp(Host& host, PeerId master, std::vector<PeerId> slaves, GptpSettings settings);
using Gptp = ClockService<GptpSettings, serve_gptp, follow_gptp, relay_gptp>;

}  // namespace simbench
