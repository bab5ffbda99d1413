#include "app/rare_sets.h"

#include <algorithm>
#include <memory>

#include "app/interrupt.h"
#include "evaluation/run/pipeline_choice.h"
#include "sim/engine/seed_field.h"

namespace simbench::app {
namespace {

using evaluation::PulseScore;
using evaluation::RareScore;
using evaluation::SeedScore;

double largest_spread_ms(const SeedScore& score) {
  double largest = 0;
  for (const PulseScore& pulse : score.pulses) largest = std::max(largest, pulse.spread_ms);
  return largest;
}

double share_of_pulses(const SeedScore& score, double bound_ms) {
  const auto beyond = std::ranges::count_if(
      score.pulses, [bound_ms](const PulseScore& pulse) { return pulse.spread_ms > bound_ms; });
  return static_cast<double>(beyond) / static_cast<double>(score.pulses.size());
}

double share_of_wrong_sets(const SeedScore& score) {
  if (score.sets.emitted == 0) return 0;
  return static_cast<double>(score.sets.emitted - score.sets.pure) /
         static_cast<double>(score.sets.emitted);
}

}  // namespace

double wrong_set_bound_ms(const scenarios::Scenario& scenario) {
  return 1e3 / scenario.trigger.pulse_rate_hz() / 4;
}

evaluation::RareFunction rare_sets(const scenarios::Scenario& scenario, const std::string& pipeline,
                                   RareEvent event, double bound_ms) {
  const auto choice = std::make_shared<const evaluation::PipelineChoice>(
      evaluation::choose_pipelines(scenario, {pipeline}).front());
  return [&scenario, choice, event, bound_ms](const evaluation::RareRun& run) {
    sim::SeedField field;
    for (const evaluation::RareChange& change : run.changes) {
      field.add({.key = change.key, .share = change.share, .step = change.step});
    }
    const sim::SeedFieldScope scope(field);
    const auto source = simulated_world(scenario);
    evaluation::PipelineScorer scorer(evaluation::scorer_setup(scenario, *choice));
    const SeedScore score = evaluation::score_run(*source, *choice, run.seed, scorer, scorer);
    RareScore rare{.level = largest_spread_ms(score), .share = 0};
    if (score.pulses.empty() || rare.level <= bound_ms) return rare;
    rare.share =
        event == RareEvent::kSpread ? share_of_pulses(score, bound_ms) : share_of_wrong_sets(score);
    return rare;
  };
}

}  // namespace simbench::app
