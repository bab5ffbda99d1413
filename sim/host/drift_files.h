// The drift files of the hosts: the frequency that each host's clock service used when its last run
// ended, age_h before it starts again.
//
// It is the frequency that keeps the host's clock with the master's: that of both oscillators in
// the hour before the service starts, in which the temperature's part is that of the hour in which
// the file was written. The random walk since then is a draw of variance K^2 age, and the file was
// wrong by N(error_ppb) when it was written; both are drawn per host.
//
// Source: chrony.conf documentation (driftfile); RFC 5905 section 12 (the frequency file);
// scenario /hosts/drift_file.
//
//   const DriftFiles files(scenario.hosts, seed, clocks);
//   if (const auto stored = files.read(3, engine.now())) use(stored->ppb);
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "algorithms/ports/host.h"
#include "recording/true_time.h"
#include "scenarios/scenario.h"
#include "sim/clock/system_clock.h"

namespace simbench::sim {

class DriftFiles {
 public:
  // The references must outlive this; the clocks may still be made.
  DriftFiles(const scenarios::Hosts& hosts, std::uint64_t run_seed,
             const std::deque<SystemClock>& clocks)
      : hosts_(hosts), run_seed_(run_seed), clocks_(clocks) {}

  // What the service of that host finds when it starts at `now`; nothing without drift files.
  std::optional<StoredFrequency> read(PeerId host, TrueTime now) const;

 private:
  const scenarios::Hosts& hosts_;
  std::uint64_t run_seed_;
  const std::deque<SystemClock>& clocks_;
};

}  // namespace simbench::sim
