#include "evaluation/fit/fit_check.h"

#include <algorithm>

#include "evaluation/statistics/statistics.h"

namespace simbench::evaluation {
namespace {

FitSide fit_side(const RigFit& fit) {
  FitSide side;
  side.frames = fit.frames;
  for (std::size_t i = 0; i < kFitQuantiles.size(); ++i) {
    side.excess_ms[i] = quantile(fit.excess_ms, kFitQuantiles[i]);
  }
  side.skew_ppm = fit.skew_ppm;
  side.correlation = fit.correlation;
  side.drops = fit.drops;
  return side;
}

// The number of independent frames with the same information; negative correlation counts as none.
std::size_t effective_size(const RigFit& fit) {
  const double r = std::clamp(fit.correlation ? fit.correlation->value : 0.0, 0.0, 0.999);
  const double size = static_cast<double>(fit.excess_ms.size()) * (1 - r) / (1 + r);
  return std::max<std::size_t>(1, static_cast<std::size_t>(size));
}

}  // namespace

RigFit simulate_fit(const scenarios::Scenario& model, std::int64_t pulses,
                    const WorldFactory& make_world, std::uint64_t seed) {
  scenarios::Scenario world = model;
  world.timeline.frames = pulses;
  world.timeline.wait_before_capture_ms = 0;
  FitInputSink sink({.warm_up_ms = world.timeline.warm_up_ms, .true_time = true});
  make_world(world)->record({.seed = seed, .pipeline = world.pipelines.front().name}, sink);
  return fit_rig(sink.take());
}

FitCheck check_fit(const RigFit& recorded, const scenarios::Scenario& model,
                   const WorldFactory& make_world) {
  // As many frames as were recorded, within reason.
  constexpr std::int64_t kFewest = 1000;
  constexpr std::int64_t kMost = 200'000;
  const auto streams = static_cast<std::int64_t>(recorded.streams.size());
  const std::int64_t lost = recorded.drops ? recorded.drops->lost : 0;
  const std::int64_t pulses = std::clamp((recorded.frames + lost) / streams, kFewest, kMost);
  const RigFit simulated = simulate_fit(model, pulses, make_world);
  FitCheck check;
  check.recorded = fit_side(recorded);
  check.simulated = fit_side(simulated);
  check.ks = ks_distance(recorded.excess_ms, simulated.excess_ms);
  check.ks_limit = ks_critical_distance(effective_size(recorded), effective_size(simulated));
  return check;
}

FitStudy study_fit(const FitInput& input, const FitBase& base, const std::string& path,
                   const WorldFactory& make_world) {
  FitStudy study;
  const RigFit whole = fit_rig(input);
  study.model = fit_model(whole, input, base, path);
  study.whole = check_fit(whole, study.model.scenario, make_world);
  const bool has_halves = std::all_of(
      input.streams.begin(), input.streams.end(),
      [](const FitStream& stream) { return stream.frames.size() >= 2 * kFewestFrames; });
  if (!has_halves) return study;
  const auto [first, second] = halves(input);
  const FitModel half = fit_model(fit_rig(first), first, base, path);
  study.hold_out = check_fit(fit_rig(second), half.scenario, make_world);
  return study;
}

}  // namespace simbench::evaluation
