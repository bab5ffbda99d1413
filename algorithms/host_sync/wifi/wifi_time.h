// Hosts that follow the time of their Wi-Fi access point, as their radios know it: no message of
// theirs is in it, so that power save, queues and unequal ways do not matter.
//
// The common time is the access point's counter, the TSF. Every host follows it, the master too,
// be it the access point itself or a station (as in pulses/gnss.h); host clocks thus differ by
// their own errors alone, and what all of them share, as an error of a beacon, is in no difference.
//
//   wifi_tsf  each `interval` a program reads its station's copy of the TSF `readings` times
//             between two readings of its steady clock, and keeps the quickest; the counter counts
//             as read in the middle of that call. A line through the last `window` is followed.
//   wifi_ftm  a session of fine timing measurement, a pause of `interval`, and so on. Each exchange
//             says how far the TSF is ahead of the station's radio,
//             ((t1 - t2) + (t4 - t3)) / 2, and readings of the radio's counter how far that is
//             ahead of the steady clock: two lines, one after the other. The access point has the
//             second one alone.
//
// What stays: the difference of the two parts of the quickest call, which a program cannot see; of
// the TSF the drift between two beacons (half of the interval times the rate); of FTM half of what
// both ends' stamps of receptions are late by, differently.
//
// A service. A slave whose host has no radio for it, or hears nothing in kPatience tries, reports
// that as its outcome. Cost: no message. Source: IEEE 802.11-2020, 11.1.3 and 11.21.6; abbbe/fts
// (FTM, a regression, the counter's ticks); docs/reference/wifi_time.md.
#pragma once

#include <vector>

#include "algorithms/host_sync/clock_service.h"
#include "algorithms/host_sync/clock_steering.h"
#include "algorithms/host_sync/wifi/counter_line.h"
#include "algorithms/ports/radio_clock.h"

namespace simbench {

struct WifiTimeSettings {
  Nanoseconds service_time = from_ms(60e3);  // before the capture
  Nanoseconds interval = from_ms(1000);
  int readings = 8;
  Nanoseconds window = from_ms(60e3);
  SteeringSettings steering{};

  void bind(ParameterBinder& parameters);
};

// How far the TSF is ahead of the station's radio by one exchange; where that radio counts
// `middle_of(exchange)`. The flight cancels.
Nanoseconds tsf_ahead(const FtmExchange& exchange);
HardwareTime middle_of(const FtmExchange& exchange);

Task<void> serve_wifi_tsf(Host& host, std::vector<PeerId> slaves, WifiTimeSettings settings);
Task<void> follow_wifi_tsf(Host& host, PeerId master, WifiTimeSettings settings);
using TsfService = ClockService<WifiTimeSettings, serve_wifi_tsf, follow_wifi_tsf>;

Task<void> serve_wifi_ftm(Host& host, std::vector<PeerId> slaves, WifiTimeSettings settings);
Task<void> follow_wifi_ftm(Host& host, PeerId master, WifiTimeSettings settings);
using FtmService = ClockService<WifiTimeSettings, serve_wifi_ftm, follow_wifi_ftm>;

}  // namespace simbench
