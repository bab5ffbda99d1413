#include "evaluation/fit/fit_model.h"

#include <gmock/gmock.h>

#include "evaluation/frames/frame_account.h"
#include "scenarios/loader.h"
#include "tests/scratch_folder.h"

namespace simbench::evaluation {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

// Cameras on these hosts, frames every `period_ms`, each third 0.1 ms late.
FitInput rig_of(const std::vector<std::uint32_t>& hosts, double period_ms = 1e3 / 30) {
  FitInput input;
  for (const std::uint32_t host : hosts) {
    while (input.hosts.size() <= host) input.hosts.emplace_back("h");
    input.cameras.push_back({"camera", host});
    FitStream stream{.camera = input.cameras.size() - 1, .kind = "depth", .frames = {}};
    for (int i = 0; i < 200; ++i) {
      stream.frames.push_back({.counter = static_cast<std::uint64_t>(i),
                               .sensor = from_ms(i * period_ms),
                               .arrival = from_ms(i * period_ms + (i % 3 == 0 ? 0.1 : 0))});
    }
    stream.account = frame_account(stream.frames, /*counted=*/true);
    input.streams.push_back(std::move(stream));
  }
  return input;
}

FitModel model_of(const FitInput& input, const FitBase& base,
                  const std::string& path = "model.json") {
  return fit_model(fit_rig(input), input, base, path);
}

TEST(FitModel, StatesItsBaseAndWhatWasFitted) {
  const FitInput input = rig_of({0, 0});
  const FitModel model = model_of(input, default_base(input), "my rig.json");
  EXPECT_EQ(model.scenario.name, "my_rig");
  EXPECT_THAT(model.text, HasSubstr("\"base\": \"3cam_1host_30fps\""));
  EXPECT_EQ(model.scenario.cameras.count, 2);
  EXPECT_EQ(model.scenario.cameras.cameras_per_host, 2);
  EXPECT_EQ(model.scenario.cameras.skew_of_camera_ppm.size(), 2U);
  EXPECT_EQ(model.scenario.usb.delivery_quantiles_ms.size(), 400U);
  EXPECT_NEAR(model.scenario.usb.delivery_quantiles_ms.back(), 0.1, 0.001);
  EXPECT_EQ(model.scenario.cameras.drop_probability, 0);
  EXPECT_THAT(model.scenario.summary, HasSubstr("400 frames"));
  EXPECT_THAT(model.scenario.summary, HasSubstr("the constant part of the delivery delay"));
}

TEST(FitModel, WhatTheTablesContainIsSwitchedOff) {
  FitBase base{.scenario = scenarios::load_scenario("18cam_6host_45fps_lan"),
               .stated = "18cam_6host_45fps_lan"};
  const FitModel model = model_of(rig_of({0, 0}), base);
  EXPECT_EQ(model.scenario.usb.host_jitter_transfers, 0);
  EXPECT_EQ(model.scenario.hosts.load_burst.rate_hz, 0);
  EXPECT_EQ(model.scenario.cameras.sensor_stamp_jitter_sigma_us, 0);
  EXPECT_LE(model.scenario.hosts.clock.arrival_quantum_ms, 1e-6);
  EXPECT_EQ(model.scenario.hosts.send_cost_ms, base.scenario.hosts.send_cost_ms);
  EXPECT_THAT(model.not_identified, Contains(HasSubstr("how cameras share a bus")));
}

TEST(FitModel, UnevenRigsNameAHostForEachCamera) {
  const FitInput input = rig_of({0, 0, 0, 1});
  const FitModel model = model_of(input, default_base(input));
  EXPECT_THAT(model.text, HasSubstr("\"base\": \"6cam_2host_30fps\""));
  EXPECT_EQ(model.scenario.cameras.host_of_camera, (std::vector<std::int64_t>{0, 0, 0, 1}));
  EXPECT_EQ(model.scenario.hosts.count, 2);
  const FitInput even = rig_of({0, 0, 1, 1});
  EXPECT_TRUE(model_of(even, default_base(even)).scenario.cameras.host_of_camera.empty());
}

TEST(FitModel, AWholeScenarioNeedsNoBase) {
  const FitBase base{.scenario = scenarios::load_scenario("3cam_1host_30fps")};
  const FitModel model = model_of(rig_of({0}), base);
  EXPECT_THAT(model.text, Not(HasSubstr("\"base\"")));
  EXPECT_EQ(model.scenario.trigger.rate_hz, base.scenario.trigger.rate_hz);
  EXPECT_EQ(model.scenario.pipelines.size(), base.scenario.pipelines.size());
}

TEST(FitModel, ABaseThatIsAFileIsStatedFromTheModelsFolder) {
  const ScratchFolder folder;
  const std::string file = folder.write("mine.json",
                                        R"({"base": "3cam_1host_30fps", "name": "mine",
                                            "summary": "s", "cameras": {"exposure_ms": 3}})");
  const FitBase base{.scenario = scenarios::load_scenario(file), .stated = file};
  const FitModel model = model_of(rig_of({0}), base, folder / "out/model.json");
  EXPECT_THAT(model.text, HasSubstr("\"base\": \"../mine.json\""));
  EXPECT_EQ(model.scenario.cameras.exposure_ms, 3);
}

TEST(FitModel, ADefaultBaseTakesTheRateOfTheCameras) {
  const FitBase slow = default_base(rig_of({0}, 1e3 / 7.4));
  EXPECT_NEAR(*slow.rate_hz, 7.4, 1e-6);
  EXPECT_EQ(*slow.mode_rate_hz, 15);
  EXPECT_EQ(*default_base(rig_of({0}, 1e3 / 45)).mode_rate_hz, 90);
  const FitInput input = rig_of({0}, 1e3 / 30.21);
  EXPECT_NEAR(model_of(input, default_base(input)).scenario.trigger.rate_hz, 30.21, 1e-4);
  const FitInput fast = rig_of({0}, 10);
  EXPECT_EQ(*default_base(fast).mode_rate_hz, 300);
  EXPECT_EQ(default_base(fast).left_out, "");
  EXPECT_NEAR(model_of(fast, default_base(fast)).scenario.trigger.rate_hz, 100, 1e-4);
}

TEST(FitModel, ARateBeyondAllCamerasIsModelledAtTheFastestAndSaid) {
  const FitInput input = rig_of({0}, 5);
  const FitModel model = model_of(input, default_base(input));
  EXPECT_NEAR(model.scenario.trigger.rate_hz, 153.061, 1e-3);
  EXPECT_THAT(model.left_out, Contains(HasSubstr("the cameras run at 200.000 Hz")));
}

TEST(FitModel, RoundTripsMakeATableAndTakeTheHostsCosts) {
  RigFit fit = fit_rig(rig_of({0, 1}));
  for (int i = 0; i < 100; ++i) fit.network.round_trips_ms.push_back(0.4 + 0.001 * i);
  fit.network.latency_quantiles_ms = one_way_table(fit.network.round_trips_ms);
  fit.network.hosts = {
      {.host = 1, .initial_offset_ms = FittedValue{-30, 0.2}, .skew_ppm = FittedValue{14, 0.1}}};
  const FitInput input = rig_of({0, 1});
  const FitModel model = fit_model(fit, input, default_base(input), "model.json");
  EXPECT_EQ(model.scenario.network.latency_quantiles_ms.size(), 101U);
  EXPECT_NEAR(model.scenario.network.latency_quantiles_ms.front(), 0.2, 1e-6);
  EXPECT_EQ(model.scenario.hosts.send_cost_ms, 0);
  EXPECT_EQ(model.scenario.hosts.receive_wake_up_ms, 0);
  EXPECT_NEAR(model.scenario.hosts.clock.oscillator.skew_sigma_ppm, 9.8995, 1e-4);  // 14/sqrt(2)
  EXPECT_EQ(model.scenario.hosts.clock.initial_offset_sigma_ms, 30);
  EXPECT_THAT(model.evidence, Contains(HasSubstr("host 1 14.000 +- 0.100")));
}

}  // namespace
}  // namespace simbench::evaluation
