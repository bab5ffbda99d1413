#include "evaluation/model/evidence.h"

#include "algorithms/ports/assert.h"

namespace simbench::evaluation {
namespace {

// rests_on: theory, this experiment, a real recording, published figures, assumption.
constexpr StageEvidence kStages[] = {
    {"trigger",
     {false, false, false, true, true},
     "sync modes and advised pulse rates as vendor and users document them; pulse jitter and the "
     "delays of cables and branches are assumed"},
    {"exposure",
     {false, false, false, true, true},
     "delay after the pulse, pulses ignored in genlock, waiting slaves: reported for the D455, "
     "measured on none here; the spread of exposures in the calibrated worlds is a fit to eight "
     "published numbers"},
    {"device clock",
     {true, false, false, true, true},
     "32-bit microseconds and their wrap as in the SDK's code, wander tested against the Allan "
     "deviation it is set to; rate errors and wander of a camera's quartz are assumed"},
    {"USB and host stack",
     {false, false, false, true, true},
     "whole latencies as reported for the D455; how they divide, the law of the jitter and the "
     "sharing of a controller are assumed. simbench fit puts a rig's own quantiles in their place"},
    {"host oscillator",
     {true, false, false, true, true},
     "simulated Allan deviation follows the configured one; sizes are those of ordinary quartz. "
     "The experiment's hosts share one oscillator: their skews are set, no wander is in it"},
    {"clock interface (get and set)",
     {false, true, false, false, true},
     "the nodes' software clock is part of the experiment; cost and ticks of the system calls in "
     "the calibrated worlds are fitted, no document supports them"},
    {"network latency",
     {false, false, false, true, true},
     "near the round trips that others published for one wired link; unequal links and bursts are "
     "assumed. The experiment imposes the scenario's latencies, so it cannot confirm them"},
    {"transport and kernel stamps",
     {false, true, false, false, false},
     "real sockets and kernel stamps under the scenario's delay, jitter, loss and reordering; what "
     "the simulator leaves out of them is in the gap above. No network card, switch or second "
     "kernel is in it"},
    {"host_sync protocols",
     {true, true, false, true, false},
     "the same code in both worlds; closed forms, recorded outputs of chrony's regression and "
     "linuxptp's servos, and true clock errors of the experiment. The paper's own rig is not "
     "reproduced"},
    {"device_time",
     {true, false, true, true, false},
     "closed forms, and a recording of other cameras with a real drift of -215 ppm; it has no true "
     "exposure times, so that a constant delay stays unknown"},
    {"gathering",
     {true, false, false, true, false},
     "exact small cases, and the test vectors of the projects whose policies are here; in the "
     "experiment gathering runs on stamps of simulated cameras"},
    {"metrics",
     {true, false, false, true, false},
     "the definitions of the paper with bounds that hold for any data; two published rows break "
     "the bound of eq. (4) and are marked, not chased"},
};

}  // namespace

std::string_view name_of(Evidence evidence) {
  switch (evidence) {
    case Evidence::kTheory:
      return "theory";
    case Evidence::kExperiment:
      return "this experiment";
    case Evidence::kRecording:
      return "a real recording";
    case Evidence::kPublished:
      return "published figures";
    case Evidence::kAssumption:
      return "assumption";
  }
  SIMBENCH_ASSERT(false, "an evidence has a name");
  return "";
}

std::span<const StageEvidence> model_evidence() { return kStages; }

}  // namespace simbench::evaluation
