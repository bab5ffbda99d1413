// One trigger pulse, camera by camera: when each exposed, when its frame was handed to the host's
// program, and which time the pipeline gave it. What a mean of thousands hides is seen here.
//
// Everything is on one scale: milliseconds on the master's clock since the exposure's middle of the
// first camera that has the pulse; without truth since the median of the pulse's stamps. Drawn is
// the scored pulse in the middle of those that most cameras delivered.
//
//   const Figure figure = pulse(run);
#pragma once

#include "evaluation/run/run_detail.h"
#include "reports/figures/figure.h"

namespace simbench::reports {

Figure pulse(const evaluation::RunDetail& run);

}  // namespace simbench::reports
