// NTP as deployed: a server on the master, and on each slave a client that disciplines its clock.
//
// Modes:
//  - unicast: every 2^poll s (and up to 1/16 more, at random) one exchange; while the server has
//    not been reached, and after a step, a burst of eight at 2 s instead (iburst).
//  - broadcast_volley: the server sends a broadcast every interval. The client answers the first
//    with a burst of exchanges, estimates the delay as twice the difference between the offsets of
//    the burst and of the first broadcast that comes at least an interval less 3 s after it, and
//    from then on only listens: offset = (t3 - t4) + delay/2. What the client's clock moves between
//    the two stays in the delay for good: so does the slew of a first offset below 25 ms. A delay
//    above 50 ms is not believed; then, and after a step, all begins anew with the next broadcast.
//  - broadcast_fixed: the same without a burst, with an assumed round trip (broadcastdelay), of
//    which half is added.
//
// Samples pass the clock filter and drive the discipline (both ntp_discipline.h): the kernel's loop
// or the daemon's own. A sample counts from when the discipline is told, as in the reference
// implementation, though the filter may have kept it for up to seven polls. The phase correction,
// once a second in the kernel and the daemon, is a slew that is renewed at every poll with the
// exact exponential: 4 events instead of thousands.
//
// A poll without a reply shifts a zero into the reach register; three in a row put a missing sample
// into the filter. A server whose distance exceeds 1.5 s is not used. There is one server, so no
// selection, clustering or combining.
//
// Where the host has a drift file, the clock starts with its frequency, which is then not measured
// first.
//
// A service: warm_up() is how long it has run when the capture starts. On a slave it ends only by
// panic. The outcome is "synchronised" at the first update of the clock, and a failure after eight
// polls (or broadcast intervals) without a reply or by panic.
//
// Source: RFC 5905; docs/reference/host_sync.md sections 1 and 2.
//
//   NtpSettings settings;
//   settings.mode = NtpMode::kBroadcastVolley;
//   NtpService ntp(settings);
#pragma once

#include <cstdint>
#include <vector>

#include "algorithms/host_sync/clock_service.h"
#include "algorithms/host_sync/ntp/ntp_association.h"
#include "algorithms/host_sync/ntp/ntp_discipline.h"
#include "algorithms/parameter_binder.h"
#include "algorithms/ports/host.h"

namespace simbench {

enum class NtpMode : std::uint8_t { kUnicast, kBroadcastVolley, kBroadcastFixed };

struct NtpSettings {
  NtpMode mode = NtpMode::kUnicast;
  NtpDisciplineSettings discipline{};
  NtpStamps stamps = NtpStamps::kApplication;
  bool initial_burst = true;
  bool reads_drift_file = true;
  Nanoseconds broadcast_interval = from_ms(64e3);
  double broadcast_delay_s = 0.004;  // round trip, of broadcast_fixed
  Nanoseconds service_time = from_ms(16 * 3600e3);

  void bind(ParameterBinder& parameters);
};

Task<void> serve_ntpd(Host& host, std::vector<PeerId> slaves, NtpSettings settings);
// In the broadcast modes the discipline's poll bounds are those of the interval.
Task<void> follow_ntpd(Host& host, PeerId master, NtpSettings settings);
// It says that it is not synchronised until the client's side has updated its clock.
Task<void> relay_ntpd(Host& host, PeerId master, std::vector<PeerId> slaves, NtpSettings settings);
using NtpService = ClockService<NtpSettings, serve_ntpd, follow_ntpd, relay_ntpd>;

}  // namespace simbench
