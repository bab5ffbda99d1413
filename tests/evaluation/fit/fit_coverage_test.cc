// Do the 95 % intervals of a fit hold the truth? On simulated rigs whose rates, losses and
// correlations are known, and on series of known noise.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "evaluation/fit/fit.h"
#include "evaluation/fit/rate_line.h"
#include "evaluation/statistics/statistics.h"
#include "scenarios/loader.h"
#include "sim/engine/random.h"
#include "sim/rig/simulation.h"

namespace simbench::evaluation {
namespace {

constexpr std::int64_t kRigs = 20;
constexpr std::int64_t kRigCameras = 10;

struct Coverage {
  std::int64_t held = 0;
  std::int64_t all = 0;

  void add(const Interval& interval, double truth) {
    held += interval.low <= truth && truth <= interval.high ? 1 : 0;
    ++all;
  }
  double share() const { return static_cast<double>(held) / static_cast<double>(all); }
};

// Exponential delays, or ones without a sharp edge and with rare spikes.
std::vector<double> delays_ms(double scale_ms, bool soft) {
  constexpr int kSteps = 400;
  std::vector<double> table;
  for (int i = 0; i <= kSteps; ++i) {
    const double p = std::clamp(static_cast<double>(i) / kSteps, 1e-3, 1 - 1e-3);
    const double logit = std::log(p / (1 - p));
    const double spike = i > 0.99 * kSteps ? 4 * scale_ms : 0;
    table.push_back(soft ? scale_ms * (8 + logit) + spike : -scale_ms * std::log1p(-p));
  }
  return table;
}

// A rig whose parameters are drawn with the seed.
scenarios::Scenario drawn_rig(std::uint64_t seed) {
  sim::RandomStream random(seed, "rig");
  scenarios::Scenario rig = scenarios::load_scenario("3cam_1host_30fps");
  rig.timeline.frames = static_cast<std::int64_t>(random.uniform(400, 2500));
  rig.timeline.warm_up_ms = 500;
  rig.hosts.clock.oscillator.skew_sigma_ppm = 0;
  rig.cameras.count = kRigCameras;
  rig.cameras.cameras_per_host = kRigCameras;
  for (std::int64_t i = 0; i < kRigCameras; ++i) {
    rig.cameras.skew_of_camera_ppm.push_back(random.uniform(-100, 100));
  }
  rig.cameras.drop_probability = random.uniform(0, 0.1);
  rig.cameras.sensor_stamp_jitter_sigma_us = random.uniform(0, 5);
  // Half of the rigs: 0.2 ppm at 1 s.
  if (random.chance(0.5)) rig.cameras.oscillator.white_frequency_ppb = 200;
  const double scale_ms = std::exp(random.uniform(std::log(0.05), std::log(1.0)));
  rig.usb.delivery_quantiles_ms = delays_ms(scale_ms, random.chance(0.5));
  rig.usb.delivery_correlation = random.uniform(0, 0.8);
  return rig;
}

RigFit fit_of(const scenarios::Scenario& rig, std::uint64_t seed) {
  FitInputSink sink({.warm_up_ms = rig.timeline.warm_up_ms});
  sim::make_simulation(rig)->record({.seed = seed, .pipeline = rig.pipelines.front().name}, sink);
  return fit_rig(sink.take());
}

TEST(FitCoverage, IntervalsHoldTheTruthOfSimulatedRigs) {
  Coverage drifts;
  Coverage losses;
  Coverage correlations;
  for (std::int64_t i = 1; i <= kRigs; ++i) {
    const auto seed = static_cast<std::uint64_t>(i);
    const scenarios::Scenario rig = drawn_rig(seed);
    const RigFit fit = fit_of(rig, seed);
    for (std::size_t camera = 0; camera < fit.skew_ppm.size(); ++camera) {
      drifts.add(interval_of(fit.skew_ppm[camera].value()), rig.cameras.skew_of_camera_ppm[camera]);
    }
    losses.add(fit.drops.value().interval, rig.cameras.drop_probability);
    correlations.add(interval_of(fit.correlation.value()), rig.usb.delivery_correlation);
  }
  const Coverage all{.held = drifts.held + losses.held + correlations.held,
                     .all = drifts.all + losses.all + correlations.all};
  fmt::print(
      "intervals that hold the truth: {:.1f} % of {}: drifts {}/{}, losses {}/{}, "
      "correlations {}/{}\n",
      100 * all.share(), all.all, drifts.held, drifts.all, losses.held, losses.all,
      correlations.held, correlations.all);
  EXPECT_GE(all.all, 200);
  EXPECT_GE(all.share(), 0.90);
  EXPECT_LE(all.share(), 0.98);
}

// Levels of a stream's blocks as the noise has it, a frame each 1/30 s.
template <class Noise>
Coverage slope_coverage(std::size_t frames, Noise&& noise_of) {
  constexpr double kSlope = 40e-6;
  constexpr std::uint64_t kSeries = 400;
  Coverage coverage;
  for (std::uint64_t seed = 1; seed <= kSeries; ++seed) {
    sim::RandomStream random(seed, "series");
    const std::vector<double> noise_ms = noise_of(frames, random);
    std::vector<double> x;
    std::vector<double> y;
    for (std::size_t i = 0; i < frames; ++i) {
      x.push_back(static_cast<double>(i) * 1e3 / 30);
      y.push_back(kSlope * x.back() + noise_ms[i]);
    }
    const RateLine line = rate_line(x, y);
    coverage.add(interval_of({line.slope, line.error, line.freedom}), kSlope);
  }
  return coverage;
}

// z[i] = r z[i - 1] + N(1), for r below 1 from its own distribution; r = 1 is a random walk.
std::vector<double> autoregressive(std::size_t count, double r, sim::RandomStream& random) {
  std::vector<double> values;
  double z = r < 1 ? random.normal(1 / std::sqrt(1 - r * r)) : 0;
  for (std::size_t i = 0; i < count; ++i) {
    values.push_back(z);
    z = r * z + random.normal(1);
  }
  return values;
}

TEST(FitCoverage, ErrorsOfTheRateHaveJitterAndWander) {
  const auto check = [](const char* noise, const Coverage& found, double least = 0.90) {
    fmt::print("{}: {:.1f} % of {}\n", noise, 100 * found.share(), found.all);
    EXPECT_GE(found.share(), least) << noise;
  };
  for (const std::size_t frames : {100U, 300U, 3000U}) {
    check("normal jitter", slope_coverage(frames, [](std::size_t n, sim::RandomStream& random) {
            return autoregressive(n, 0, random);
          }));
    check("jitter that lasts 10 frames",
          slope_coverage(frames, [](std::size_t n, sim::RandomStream& random) {
            return autoregressive(n, 0.9, random);
          }));
    // Blocks of 12 frames, of which 100 have but 8, do not tell a walk from jitter.
    if (frames >= 300) {
      check("a random walk",
            slope_coverage(frames,
                           [](std::size_t n, sim::RandomStream& random) {
                             return autoregressive(n, 1, random);
                           }),
            0.85);
    }
    check("exponential delays",
          slope_coverage(frames, [](std::size_t n, sim::RandomStream& random) {
            std::vector<double> delays;
            for (std::size_t i = 0; i < n; ++i) delays.push_back(random.exponential(1));
            return delays;
          }));
  }
}

}  // namespace
}  // namespace simbench::evaluation
