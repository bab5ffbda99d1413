// Fits to simulated recordings whose parameters are known.
#include "evaluation/fit/fit.h"

#include <gmock/gmock.h>

#include <cmath>

#include "evaluation/fit/fit_check.h"
#include "evaluation/fit/fit_model.h"
#include "recording/event.h"
#include "scenarios/loader.h"
#include "sim/rig/simulation.h"

namespace simbench::evaluation {
namespace {

using testing::Contains;
using testing::Each;
using testing::HasSubstr;
using testing::SizeIs;
using testing::ThrowsMessage;

// Quantiles of Exp(mean_ms), cut off where 1 in 2000 is later.
std::vector<double> exponential_table(double mean_ms) {
  std::vector<double> table;
  for (int i = 0; i <= 200; ++i) {
    table.push_back(-mean_ms * std::log1p(-std::min(i / 200.0, 1 - 1 / 2000.0)));
  }
  return table;
}

// Three cameras with known rates, delays, correlation and losses; 1500 frames each.
scenarios::Scenario known_world() {
  scenarios::Scenario world = scenarios::load_scenario("3cam_1host_30fps");
  world.timeline.frames = 1500;
  world.timeline.warm_up_ms = 500;
  world.hosts.clock.oscillator.skew_sigma_ppm = 0;
  world.cameras.skew_of_camera_ppm = {-40, 3, 215};
  world.cameras.drop_probability = 0.05;
  world.cameras.sensor_stamp_jitter_sigma_us = 0;
  world.usb.delivery_quantiles_ms = exponential_table(0.3);
  world.usb.delivery_correlation = 0.4;
  return world;
}

FitInput recorded_world(const scenarios::Scenario& world, std::uint64_t seed) {
  FitInputSink sink({.warm_up_ms = world.timeline.warm_up_ms});
  sim::make_simulation(world)->record({.seed = seed, .pipeline = world.pipelines.front().name},
                                      sink);
  return sink.take();
}

FitBase base_of(const char* name) {
  return {.scenario = scenarios::load_scenario(name), .stated = name};
}

TEST(Fit, GivesBackWhatWasSimulated) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const scenarios::Scenario world = known_world();
    const RigFit fit = fit_rig(recorded_world(world, seed));
    ASSERT_THAT(fit.skew_ppm, SizeIs(3)) << "seed " << seed;
    for (std::size_t i = 0; i < 3; ++i) {
      // A register of whole microseconds, over 50 s.
      EXPECT_NEAR(fit.skew_ppm[i].value().value, world.cameras.skew_of_camera_ppm[i],
                  5 * fit.skew_ppm[i].value().error + 0.02)
          << "camera " << i << ", seed " << seed;
      EXPECT_LT(fit.skew_ppm[i].value().error, 0.5) << "seed " << seed;
    }
    ASSERT_TRUE(fit.correlation) << "seed " << seed;
    EXPECT_NEAR(fit.correlation->value, 0.4, 5 * fit.correlation->error) << "seed " << seed;
    // Clopper and Pearson's interval is of 95 %: 5 standard errors never fail.
    EXPECT_NEAR(fit.drops.value().share(), 0.05, 5 * std::sqrt(0.05 * 0.95 / 4500))
        << "seed " << seed;
    for (const double p : {0.1, 0.5, 0.9, 0.99}) {
      const double expected = -0.3 * std::log1p(-p);
      // The error of an order statistic: sqrt(p (1 - p) / n) / density, n reduced by the
      // correlation.
      const double error = std::sqrt(p * (1 - p) / (4275 * 0.6 / 1.4)) * 0.3 / (1 - p);
      EXPECT_NEAR(quantile(fit.excess_ms, p), expected, 5 * error + 0.001)
          << "quantile " << p << ", seed " << seed;
    }
  }
}

TEST(Fit, TheSimulatedModelAgreesWithItsRecording) {
  for (const std::uint64_t seed : {21U, 22U, 23U}) {
    const FitInput input = recorded_world(known_world(), seed);
    const FitStudy study =
        study_fit(input, base_of("3cam_1host_30fps"), "model.json", sim::make_simulation);
    EXPECT_LT(study.whole.ks, study.whole.ks_limit) << "seed " << seed;
    ASSERT_TRUE(study.hold_out) << "seed " << seed;
    EXPECT_LT(study.hold_out->ks, 1.5 * study.hold_out->ks_limit) << "seed " << seed;
    EXPECT_TRUE(study.trust.held_out);
    for (std::size_t i = 0; i < 3; ++i) {
      const FittedValue& found = study.whole.simulated.skew_ppm[i].value();
      EXPECT_NEAR(found.value, study.whole.recorded.skew_ppm[i].value().value,
                  5 * found.error + 0.02)
          << "camera " << i << ", seed " << seed;
    }
    EXPECT_NEAR(study.whole.simulated.drops.value().share(),
                study.whole.recorded.drops.value().share(), 5 * std::sqrt(2 * 0.05 * 0.95 / 4500))
        << "seed " << seed;
  }
}

// The check must notice a model that is wrong.
TEST(Fit, TheCheckSeesAnotherDistribution) {
  const RigFit fit = fit_rig(recorded_world(known_world(), 31));
  scenarios::Scenario other = known_world();
  other.usb.delivery_quantiles_ms = exponential_table(0.4);
  const FitCheck check = check_fit(fit, fit, other, {"a", "b", "c"}, sim::make_simulation);
  // The distance of Exp(0.3) and Exp(0.4) is (3/4)^3 - (3/4)^4 = 0.105.
  EXPECT_NEAR(check.ks, 0.105, 0.05);
  EXPECT_GT(check.ks, check.ks_limit);
  EXPECT_FALSE(check.verdicts.front().agrees);
}

TEST(Fit, AFitOfAFitIsTheSame) {
  const FitBase base = base_of("3cam_1host_30fps");
  const FitInput input = recorded_world(known_world(), 41);
  const RigFit first = fit_rig(input);
  RigFit last = first;
  for (int generation = 0; generation < 3; ++generation) {
    const FitModel model = fit_model(last, input, base, "model.json");
    last = simulate_fit(model.scenario, 1500, sim::make_simulation,
                        static_cast<std::uint64_t>(generation) + 50);
  }
  for (const double p : {0.1, 0.5, 0.9}) {
    const double error = std::sqrt(p * (1 - p) / (4275 * 0.6 / 1.4)) * 0.3 / (1 - p);
    EXPECT_NEAR(quantile(last.excess_ms, p), quantile(first.excess_ms, p), 5 * std::sqrt(3) * error)
        << "quantile " << p;
  }
  EXPECT_NEAR(last.correlation->value, first.correlation->value,
              5 * std::sqrt(3) * first.correlation->error);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(last.skew_ppm[i].value().value, first.skew_ppm[i].value().value, 0.5)
        << "camera " << i;
  }
}

TEST(Fit, SettingsOfTheSystemClockAreNoDelay) {
  scenarios::Scenario world = known_world();
  const RigFit plain = fit_rig(recorded_world(world, 3));
  world.faults = {scenarios::ClockStep{.host = 0, .at_ms = 20'000, .step_ms = 500}};
  const RigFit stepped = fit_rig(recorded_world(world, 3));
  EXPECT_EQ(plain.excess_ms, stepped.excess_ms);
}

TEST(FitInput, WarmUpIsLeftOut) {
  scenarios::Scenario world = known_world();
  world.cameras.drop_probability = 0;
  const FitInput input = recorded_world(world, 1);
  ASSERT_THAT(input.streams, SizeIs(3));
  for (const FitStream& stream : input.streams) {
    EXPECT_NEAR(static_cast<double>(stream.frames.size()), 1500, 2);
    EXPECT_GE(stream.frames.front().counter, 14U);  // 500 ms of 30 Hz
  }
}

TEST(FitInput, ACameraWithoutFramesIsNamed) {
  FitInputSink sink({.cameras = {"left", "right"}});
  sink.on_start({.hosts = 1, .cameras = {{0}, {0}}, .frame_rate_hz = 30});
  for (std::uint32_t i = 0; i < 200; ++i) {
    FrameRecord frame;
    frame.frame.us = 1000 + i * 33'333;
    frame.counter = i;
    frame.arrival_steady = SteadyTime(Nanoseconds(i * 33'333'000LL));
    sink.on_frame(frame, nullptr);
  }
  const FitInput input = sink.take();
  const RigFit fit = fit_rig(input);
  EXPECT_TRUE(fit.skew_ppm[0]);
  EXPECT_FALSE(fit.skew_ppm[1]);
  const FitModel model = fit_model(fit, input, base_of("3cam_1host_30fps"), "model.json");
  EXPECT_THAT(model.not_identified, Contains("the rate of camera right: the mean of the others"));
  EXPECT_EQ(model.scenario.cameras.skew_of_camera_ppm[0],
            model.scenario.cameras.skew_of_camera_ppm[1]);
}

TEST(FitInput, StampsOfAnotherClockAreRefused) {
  FitInputSink sink({.cameras = {"left"}});
  sink.on_start({.hosts = 1, .cameras = {{0}}, .frame_rate_hz = 30});
  FrameRecord frame;
  frame.domain = StampDomain::kSystemTime;
  EXPECT_THAT([&] { sink.on_frame(frame, nullptr); },
              ThrowsMessage<FitError>(HasSubstr("camera left: found stamps that are not of the "
                                                "camera's clock")));
}

TEST(FitInput, CamerasWithoutFrameStampsAreFittedByTheirOther) {
  FitInputSink sink({});
  sink.on_start({.hosts = 1, .cameras = {{0}}, .frame_rate_hz = 30});
  for (std::uint32_t i = 0; i < 3; ++i) {
    FrameRecord frame;
    frame.sensor.us = 7 + i * 100;
    sink.on_frame(frame, nullptr);
  }
  const FitInput input = sink.take();
  EXPECT_EQ(input.cameras[0].name, "camera0");
  EXPECT_EQ(input.streams[0].frames[2].sensor, Nanoseconds(207'000));
}

TEST(QuantileTable, IsAsLongAsThereIsSomethingToSay) {
  EXPECT_EQ(quantile_table({}), std::vector<double>());
  EXPECT_EQ(quantile_table({3}), std::vector<double>{3});
  EXPECT_EQ(quantile_table({1, 2, 4}), (std::vector<double>{1, 2, 4}));
  std::vector<double> many(20'001);
  for (std::size_t i = 0; i < many.size(); ++i) many[i] = static_cast<double>(i);
  const std::vector<double> table = quantile_table(many);
  ASSERT_THAT(table, SizeIs(kLongestTable));
  EXPECT_EQ(table[1], 20);
  EXPECT_EQ(table[999], 19'980);
}

}  // namespace
}  // namespace simbench::evaluation
