// Clock errors of the hosts before, during and after synchronisation, and how much they change
// within stretches of the scored capture (MTIE).
//
//   const Figure figure = host_clocks(run);
#pragma once

#include "evaluation/run/run_detail.h"
#include "reports/figures/figure.h"

namespace simbench::reports {

Figure host_clocks(const evaluation::RunDetail& run);

}  // namespace simbench::reports
