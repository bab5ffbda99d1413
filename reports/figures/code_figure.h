// The figure of a coded trigger: what the cameras' own clocks show of the pulses, and how the
// search for their places goes.
#pragma once

#include "evaluation/run/run_detail.h"
#include "reports/figures/figure.h"

namespace simbench::reports {

// The first evaluated pulses of a camera of each host, three at most: the sensor stamps against the
// camera's own line through the even grid, beside the code; and the probability that the search
// still gives all places but the best, frame by frame. The run must have pulses with a code.
Figure coded_trigger(const evaluation::RunDetail& run);

}  // namespace simbench::reports
