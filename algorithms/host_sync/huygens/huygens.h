// Huygens: coded probes between many pairs of hosts, a line of largest margin for each pair, and
// the network effect, by which the pairs correct each other.
//
//  1. The master tells each slave whom to probe (network_effect.h): every other host in a rig of up
//     to `neighbours` + 1.
//  2. Every probe_interval each host sends each of its peers a pair of probes, `spacing` apart.
//  When
//     they left is told with the next pair. Impure pairs are dropped (coded_probes.h).
//  3. Each `window` of pairs gives two clouds of points for a pair of hosts a < b: b sends a the
//  lower
//     hull of its cloud, a finds the line that separates it from its own and sends it to the
//     master.
//  4. Once per window the master corrects the leads of all pairs around their loops, at the middle
//  of
//     the direct lines' windows, and sends each slave one point of the line between the slave's raw
//     clock (raw_clock.h) and the master's system clock.
//  5. A slave fits a line to its last `points` such points (least squares) and steers its system
//     clock along it (clock_steering.h).
//
// Steps 1 to 4 are the paper's, except that the line is that of a hard margin (which needs only the
// hulls, some tens of points). Step 5 is ours: the paper corrects stamps afterwards, here clocks
// have to be right now, two windows later.
//
// A service. The cost: 2 (hosts - 1) hosts / probe_interval probes, and some messages per window
// for each pair. Lost, repeated and foreign messages cost their pair or window only. A slave
// reports its outcome when it first steers, after 30 s without that (with the share of pure pairs:
// where ports are busy for nine tenths of the time, hardly any is), or when it lacks the stamps.
//
// Source: Geng et al., Exploiting a Natural Network Effect for Scalable, Fine-grained Clock
// Synchronization, NSDI 2018; docs/reference/host_sync.md section 1 (Huygens).
//
//   Huygens sync({.stamps = StampSource::kCard, .purity = from_us(0.2)});
#pragma once

#include <cstddef>
#include <vector>

#include "algorithms/host_sync/clock_service.h"
#include "algorithms/host_sync/clock_steering.h"
#include "algorithms/host_sync/stamps.h"
#include "algorithms/ports/host.h"

namespace simbench {

struct HuygensSettings {
  StampSource stamps = StampSource::kKernel;
  Nanoseconds service_time = from_ms(60e3);  // before the capture
  std::size_t neighbours = 10;
  Nanoseconds probe_interval = from_ms(40);
  Nanoseconds spacing = from_us(100);
  Nanoseconds purity = from_us(5);
  Nanoseconds window = from_ms(2e3);
  std::size_t points = 8;
  double max_rate_ppm = 500;
  SteeringSettings steering{};

  void bind(ParameterBinder& parameters);
};

Task<void> serve_huygens(Host& host, std::vector<PeerId> slaves, HuygensSettings settings);
Task<void> follow_huygens(Host& host, PeerId master, HuygensSettings settings);
using Huygens = ClockService<HuygensSettings, serve_huygens, follow_huygens>;

}  // namespace simbench
