// SPTP, the Simple Precision Time Protocol of Meta: PTP's messages, but the client asks.
//
//   client                 server
//   Delay_Req  t3 ------>  t4
//              t2 <------  t1  Sync      (t4 in its time)
//                 <------      Announce  (t1 in its time, the Delay_Req's correction in its own)
//
// Every interval each client makes one exchange with the server, three messages, and feeds the
// offset to its servo (sptp_servo.h). Stamps, clocks and transparent clocks are PTP's: software
// stamps steer the system clock; hardware stamps the card's, which the system clock follows
// (ptp_clocks.h). The server keeps no state of its clients.
//
// An exchange that is not complete within its timeout is lost, and so is one with a negative
// correction; the clock then runs at the servo's mean frequency.
//
// A service; exchanges (of software stamps) and outcomes are reported as PTP reports them (ptp.h).
// Only one server: its choice among several, and the asymmetry that it finds by that, have nothing
// to choose from here. The Delay_Req is without its TLV of six bytes.
//
// Source: facebook/time, ptp/sptp (README.md, client/), ptp/ptp4u/server/worker.go.
//
//   Sptp sync({.stamps = StampSource::kCard});
#pragma once

#include <vector>

#include "algorithms/host_sync/clock_service.h"
#include "algorithms/host_sync/ptp/sptp_servo.h"
#include "algorithms/host_sync/stamps.h"
#include "algorithms/ports/host.h"

namespace simbench {

struct SptpSettings {
  StampSource stamps = StampSource::kKernel;
  Nanoseconds service_time = from_ms(60e3);  // before the capture
  Nanoseconds interval = from_ms(1000);
  Nanoseconds exchange_timeout = from_ms(100);  // at most half of the interval
  SptpPathDelay::Settings path_delay{};
  // The client's servo and phc2sys have these limits, each with an interval of its own.
  // It takes the kernel's tolerance for the system clock's (500 ppm, without the tick), and the
  // driver's limit for the card's.
  ServoSettings servo_limits{.max_frequency_ppb = 500e3};
  Nanoseconds patience = from_ms(30e3);

  void bind(ParameterBinder& parameters);
};

Task<void> serve_sptp(Host& host, std::vector<PeerId> clients, SptpSettings settings);
Task<void> follow_sptp(Host& host, PeerId server, SptpSettings settings);
using Sptp = ClockService<SptpSettings, serve_sptp, follow_sptp>;

}  // namespace simbench
