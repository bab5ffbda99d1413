#include "app/clock_causes.h"

#include "app/interrupt.h"
#include "evaluation/answer/answer.h"
#include "evaluation/clock_run/clock_causes.h"

namespace simbench::app {

evaluation::ClockCauses causes_of(const evaluation::ClockResults& results,
                                  const scenarios::Scenario& scenario,
                                  const evaluation::ClockOptions& options,
                                  const evaluation::Progress& progress) {
  const evaluation::Row* const best = evaluation::best_of(results.results);
  if (best == nullptr) return {};
  return evaluation::clock_causes(scenario, best->pipeline, simulated_clocks, options, progress);
}

}  // namespace simbench::app
