// Stage capture_alignment, between host_sync and device_time: can cameras without a trigger cable
// be made to expose at the same time?
//
// A CaptureAlignment steers the exposures of running cameras (frame_control.h), written as
// coroutines over the ports as a HostSync is. One coroutine runs on each host, beside host_sync's,
// from the instant in which the cameras are started until the capture ends; it need not return. The
// object holds parameters, not state.
//
// Hosts talk over Transport::kAlignment, which is a datagram channel of this stage alone. A host
// steers its own cameras only (Host::frame_controls()).
//
// What it thinks it has reached, it reports with Host::report_alignment(), as often as it changes
// its mind: a camera that is reported as aligned and is not, is a wrong lock, and counted.
// A control that a camera lacks, a grid that its rate cannot reach: report it as not aligned, with
// a message that says what would help. Never throw for it.
//
//   class StandsBy : public CaptureAlignment {
//     Task<void> run_master(Host&, std::vector<PeerId>) override { co_return; }
//     Task<void> run_slave(Host&, PeerId) override { co_return; }
//   };
#pragma once

#include <cstdint>
#include <vector>

#include "algorithms/ports/frame_control.h"
#include "algorithms/ports/host.h"

namespace simbench {

// Who decides when the cameras expose.
enum class Steering : std::uint8_t {
  kNone,        // trigger pulses if the cameras wait for them, else each camera's own oscillator
  kByControls,  // no trigger reaches a camera; the algorithm's controls do
  kIdeal,       // all expose at once, as far as their granularity lets them: the limit, needs truth
};

class CaptureAlignment {
 public:
  virtual ~CaptureAlignment() = default;
  virtual Steering steering() const { return Steering::kByControls; }
  virtual Task<void> run_master(Host& host, std::vector<PeerId> slaves) = 0;
  virtual Task<void> run_slave(Host& host, PeerId master) = 0;
};

}  // namespace simbench
