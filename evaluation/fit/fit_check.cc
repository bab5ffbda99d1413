#include "evaluation/fit/fit_check.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "evaluation/statistics/statistics.h"
#include "recording/collected.h"

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

constexpr double kDoubt = 0.05;  // how often agreement is called a difference
constexpr std::array<double, 3> kAlignedAt = {0, 0.25, 0.5};
constexpr double kComparedMs = 0.01;

// The heights over this quantile, in steps that are coarser than those of the stamps.
std::vector<double> heights_over(std::vector<double> excess_ms, double at) {
  const double zero = quantile(excess_ms, at);
  for (double& value : excess_ms) value = std::round((value - zero) / kComparedMs) * kComparedMs;
  return excess_ms;
}

double delay_distance(const std::vector<double>& recorded, const std::vector<double>& simulated) {
  double least = 1;
  for (const double at : kAlignedAt) {
    least = std::min(least, ks_distance(heights_over(recorded, at), heights_over(simulated, at)));
  }
  return least;
}

// Whether two values differ by no more than their errors allow, in all but `doubt` of all cases.
bool within_errors(const FittedValue& a, const FittedValue& b, double doubt) {
  const double one = a.error * a.error;
  const double other = b.error * b.error;
  const double variance = one + other;
  if (!(variance > 0)) return a.value == b.value;
  const double freedom = variance * variance / (one * one / a.freedom + other * other / b.freedom);
  const double limit = student_t_exceeded(doubt / 2, freedom) * std::sqrt(variance);
  return std::abs(a.value - b.value) <= limit;
}

std::string with_error(const FittedValue& value, int decimals) {
  return fmt::format("{:.{}f} +- {:.{}f}", value.value, decimals, value.error, decimals);
}

FitVerdict delay_verdict(const FitCheck& check) {
  return {.what = "delays",
          .agrees = check.ks <= check.ks_limit,
          .text = fmt::format("delays: KS {:.3f}, limit {:.3f}", check.ks, check.ks_limit)};
}

void add_correlation_verdict(FitCheck& check, double doubt) {
  const auto& recorded = check.recorded.correlation;
  const auto& simulated = check.simulated.correlation;
  if (!recorded || !simulated) return;
  check.verdicts.push_back(
      {.what = "correlation",
       .agrees = within_errors(*recorded, *simulated, doubt),
       .text = fmt::format("correlation of successive delays: {} of the model, {} recorded",
                           with_error(*simulated, 3), with_error(*recorded, 3))});
}

void add_drift_verdicts(const RigFit& fitted, const std::vector<std::string>& cameras, double doubt,
                        FitCheck& check) {
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const std::optional<FittedValue>& model = fitted.skew_ppm[i];
    const std::optional<FittedValue>& recorded = check.recorded.skew_ppm[i];
    if (!model || !recorded) continue;
    check.verdicts.push_back(
        {.what = "drift",
         .agrees = within_errors(*model, *recorded, doubt),
         .text = fmt::format("drift of camera {}: {} ppm of the model, {} "
                             "recorded",
                             cameras[i], with_error(*model, 1), with_error(*recorded, 1))});
  }
}

std::string loss_text(const DropFit& drops) {
  return fmt::format("{:.3g} % [{:.3g}, {:.3g}]", drops.share() * 100, drops.interval.low * 100,
                     drops.interval.high * 100);
}

void add_loss_verdict(const RigFit& fitted, FitCheck& check) {
  const std::optional<DropFit>& recorded = check.recorded.drops;
  if (!recorded || !fitted.drops) return;
  const Interval& a = recorded->interval;
  const Interval& b = fitted.drops->interval;
  check.verdicts.push_back({.what = "losses",
                            .agrees = a.low <= b.high && b.low <= a.high,
                            .text = fmt::format("lost frames: {} of the model, {} recorded",
                                                loss_text(*fitted.drops), loss_text(*recorded))});
}

// What speaks against the model.
std::vector<std::string> doubts_in(const FitStudy& study, bool has_delays) {
  std::vector<std::string> against;
  if (!has_delays) {
    against.emplace_back("arrivals and device stamps are the same, and show no delay and no drift");
  }
  const FitVerdict own_delays = delay_verdict(study.whole);
  if (!own_delays.agrees) {
    against.push_back("the model misses its own recording's " + own_delays.text);
  }
  if (!study.hold_out) return against;
  for (const FitVerdict& verdict : study.hold_out->verdicts) {
    if (!verdict.agrees) against.push_back("the second half differs in its " + verdict.text);
  }
  return against;
}

FitTrust trust_in(const FitStudy& study, bool has_delays) {
  const std::vector<std::string> against = doubts_in(study, has_delays);
  const bool held_out = study.hold_out.has_value();
  FitTrust trust{.held_out = held_out, .holds = std::nullopt, .text = {}};
  if (!against.empty()) {
    trust.holds = false;
    trust.text = fmt::format("Do not trust it: {}.", fmt::join(against, "; "));
  } else if (held_out) {
    trust.holds = true;
    trust.text = "The model predicts the half that it was not fitted to.";
  }
  if (!held_out) {
    trust.text += fmt::format(
        "{}Nothing was held back, no stream has {} frames: whether the model predicts is not "
        "known.",
        trust.text.empty() ? "" : " ", 2 * kFewestFrames);
  }
  return trust;
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

FitCheck check_fit(const RigFit& recorded, const RigFit& fitted, const scenarios::Scenario& model,
                   const std::vector<std::string>& cameras, const WorldFactory& make_world,
                   std::int64_t most_pulses) {
  constexpr std::int64_t kFewest = 1000;
  const auto streams = static_cast<std::int64_t>(recorded.streams.size());
  const std::int64_t lost = recorded.drops ? recorded.drops->lost : 0;
  const std::int64_t pulses = std::clamp((recorded.frames + lost) / streams, kFewest, most_pulses);
  const RigFit simulated = simulate_fit(model, pulses, make_world);
  FitCheck check;
  check.recorded = fit_side(recorded);
  check.simulated = fit_side(simulated);
  check.ks = delay_distance(recorded.excess_ms, simulated.excess_ms);
  check.ks_limit = ks_critical_distance(effective_size(recorded), effective_size(simulated));
  check.verdicts.push_back(delay_verdict(check));
  const double doubt = kDoubt / static_cast<double>(cameras.size() + 1);
  add_correlation_verdict(check, doubt);
  add_drift_verdicts(fitted, cameras, doubt, check);
  add_loss_verdict(fitted, check);
  return check;
}

FitStudy study_fit(const FitInput& input, const FitBase& base, const std::string& path,
                   const WorldFactory& make_world) {
  const std::vector<std::string> cameras = collected(input.cameras, &FitCamera::name);
  FitStudy study;
  const RigFit whole = fit_rig(input);
  study.model = fit_model(whole, input, base, path);
  study.whole = check_fit(whole, whole, study.model.scenario, cameras, make_world);
  const bool has_halves = std::any_of(
      input.streams.begin(), input.streams.end(),
      [](const FitStream& stream) { return stream.frames.size() >= 2 * kFewestFrames; });
  if (has_halves) {
    const auto [first, second] = halves(input);
    const RigFit fitted = fit_rig(first);
    const FitModel half = fit_model(fitted, first, base, path);
    study.hold_out = check_fit(fit_rig(second), fitted, half.scenario, cameras, make_world);
  }
  study.trust = trust_in(study, whole.has_delays);
  return study;
}

}  // namespace simbench::evaluation
