// chrony as deployed: chronyd as the client on each slave, a stratum 1 server on the master.
//
// The client polls every 2^poll s (and up to 2 % more, at random), first four times at 2 s
// (iburst). Its samples are fitted by a line (chrony_source_stats.h), of which frequency and offset
// are taken over after every good sample from the third on (chrony_reference.h): the frequency at
// once, the offset by a slew, never by a step. The poll adapts (chrony_poll.h). A sample with a
// delay above 3 s, or one that is_good() refuses, is dropped.
//
// The system clock is stamped while it slews. Offsets are therefore kept for the clock as it would
// read if what is left of the slew had been added at once.
//
// A service: warm_up() is how long it has run when the capture starts; it never ends. Outcome:
// synchronised at the first correction of the clock; not, after eight polls without a valid reply.
//
// Not here: several sources and their selection, makestep, the sample filter option, interleaved
// mode, refclocks. chrony has no broadcast client.
//
// Source: docs/reference/host_sync.md sections 1 and 2 (chrony); chrony.conf documentation.
//
//   ChronyService chrony({});
#ifndef SIMBENCH_ALGORITHMS_HOST_SYNC_CHRONY_CHRONY_SERVICE_H_
#define SIMBENCH_ALGORITHMS_HOST_SYNC_CHRONY_CHRONY_SERVICE_H_

#include <optional>
#include <vector>

#include "algorithms/host_sync/chrony/chrony_reference.h"
#include "algorithms/host_sync/chrony/chrony_source_stats.h"
#include "algorithms/host_sync/ntp/ntp_association.h"
#include "algorithms/ports/host_sync.h"

namespace simbench {

struct ChronySettings {
  ChronyStatsSettings stats;
  ChronyReferenceSettings reference;
  int poll_min = 6;  // log2 s
  int poll_max = 10;
  double poll_target = 8;  // samples
  bool initial_burst = true;
  NtpStamps stamps = NtpStamps::kApplication;
  Nanoseconds service_time = from_ms(4 * 3600e3);
};

class ChronyService : public HostSync {
 public:
  explicit ChronyService(const ChronySettings& settings) : settings_(settings) {}
  std::optional<Nanoseconds> warm_up() const override { return settings_.service_time; }
  Task<void> run_master(Host& host, std::vector<PeerId> slaves) override;
  Task<void> run_slave(Host& host, PeerId master) override;

 private:
  ChronySettings settings_;
};

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_HOST_SYNC_CHRONY_CHRONY_SERVICE_H_
