// PTP (IEEE 1588-2008) in the manner of linuxptp: two-step, one master, its slaves.
//
// The master sends each slave a Sync every sync_interval and its departure in a Follow_Up.
// The slave measures the delay, end to end (Delay_Req, Delay_Resp; at random times, on average
// every delay_interval) or by peer delay (Pdelay_*, every delay_interval), filters it
// (ptp_port.h), and a servo (ptp_servo.h), whose constants follow the interval, steers the clock
// that stamps (stamps.h):
//
//   software stamps  the system clock, stamped by the kernel; by the program if asked for
//   hardware stamps  the network card's clock. A second stage, linuxptp's phc2sys
//                    (ptp_clocks.h), then steers the system clock. On the master it runs the other
//                    way round and the card's clock follows the system clock; no Sync is sent
//                    before that is locked.
//
// The corrections of transparent clocks on the way are subtracted. Messages go as datagrams from
// host to host, where real PTP would multicast: a slave costs four messages per interval (peer
// delay: five). Lost, duplicated, reordered and foreign messages cost their measurement only; those
// of another domain than `domain`, and of 802.1AS, are foreign. There
// is no Announce: who is master is stated, so the election's first seconds are not in the results.
//
// A service. Exchanges are reported for software stamps (t1, t2: Delay_Req or Pdelay_Req; t3, t4:
// Sync or Pdelay_Resp); the card's stamps are no host times. A slave reports its outcome when its
// system clock is first steered, or after `patience` without that; it goes on in either case. One
// without the stamps reports that and ends.
//
// The names: ptp_e2e_* and ptp_p2p_*, once a second as linuxptp's defaults are; *_16hz sixteen
// times a second.
// Source: IEEE 1588-2008 clauses 11 and 13; docs/reference/host_sync.md section 1 (linuxptp).
#pragma once

#include <cstddef>
#include <vector>

#include "algorithms/host_sync/clock_service.h"
#include "algorithms/host_sync/ptp/ptp_servo.h"
#include "algorithms/host_sync/stamps.h"
#include "algorithms/ports/host.h"

namespace simbench {

enum class ServoKind : std::uint8_t { kPi, kLinearRegression };

struct PtpSettings {
  bool is_peer_delay = false;
  StampSource stamps = StampSource::kKernel;
  Nanoseconds service_time = from_ms(300e3);  // before the capture
  int domain = 0;
  Nanoseconds sync_interval = from_ms(1000);
  Nanoseconds delay_interval = from_ms(1000);
  std::size_t median_length = 10;
  ServoKind servo = ServoKind::kPi;
  // The port's servo and phc2sys have these limits, each with an interval of its own.
  ServoSettings servo_limits{};
  Nanoseconds patience = from_ms(30e3);  // beyond what the servo needs for its first frequency

  void bind(ParameterBinder& parameters);
};

Task<void> serve_ptp(Host& host, std::vector<PeerId> slaves, PtpSettings settings);
Task<void> follow_ptp(Host& host, PeerId master, PtpSettings settings);
// A boundary clock: its slave's port steers the clock that stamps, which its other ports serve once
// that is locked.
Task<void> relay_ptp(Host& host, PeerId master, std::vector<PeerId> slaves, PtpSettings settings);
using Ptp = ClockService<PtpSettings, serve_ptp, follow_ptp, relay_ptp>;

}  // namespace simbench
