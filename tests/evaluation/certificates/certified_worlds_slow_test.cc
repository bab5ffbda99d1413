// In simulation the truth lies within every certificate, of all pipelines of all built-in worlds
// and of worlds at random, and no facts contradict each other: the assumptions that follow from a
// scenario hold in it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "evaluation/certificates/assumptions.h"
#include "evaluation/run/ad_hoc_pipelines.h"
#include "evaluation/run/certificate_run.h"
#include "scenarios/loader.h"
#include "sim/engine/random.h"
#include "sim/rig/simulation.h"

namespace simbench::evaluation {
namespace {

// Frames with a bound.
std::size_t expect_truth_within(const scenarios::Scenario& scenario,
                                const CertificateOptions& options, const std::string& name) {
  const CertificateRun run = certify_pipelines(
      scenario, [&] { return sim::make_simulation(scenario); }, options, nullptr);
  std::size_t frames = 0;
  for (const CertificateRow& row : run.rows) {
    EXPECT_EQ(row.frames_outside, 0U) << name << ": " << row.pipeline;
    EXPECT_TRUE(row.contradicted.empty()) << name << ": " << row.pipeline;
    frames += row.frames;
  }
  return frames;
}

TEST(CertifiedWorlds, TheTruthLiesWithinInEveryBuiltInWorld) {
  std::size_t frames = 0;
  for (const scenarios::BuiltinScenario& builtin : scenarios::builtin_scenarios()) {
    const scenarios::Scenario scenario =
        scenarios::load_scenario(builtin.name, {{"/timeline/frames", "90"}});
    if (scenario.cameras.count > 1000) continue;  // too large to certify
    const bool needs_programs = std::ranges::any_of(
        scenario.pipelines, [](const auto& pipeline) { return pipeline.programs.has_value(); });
    if (needs_programs) continue;
    const CertificateOptions options{.assumptions = assumptions_of(scenario)};
    frames += expect_truth_within(scenario, options, builtin.name);
  }
  EXPECT_GT(frames, 500'000U);
}

std::string between(sim::RandomStream& draw, double least, double most) {
  return fmt::format("{:.4f}", least + (most - least) * draw.uniform());
}

// Faults and noise of all kinds at once.
TEST(CertifiedWorlds, TheTruthLiesWithinInWorldsAtRandom) {
  constexpr std::uint64_t kWorlds = 40;
  constexpr sim::ComponentKey kKey("test: worlds to certify");
  std::size_t frames = 0;
  for (std::uint64_t world = 0; world < kWorlds; ++world) {
    sim::RandomStream draw(1, kKey, world, 0);
    const std::vector<scenarios::Override> changes = {
        {"/timeline/frames", "90"},
        {"/timeline/warm_up_ms", "1000"},
        {"/network/latency_fixed_ms", between(draw, 0.02, 20)},
        {"/network/loss_probability", between(draw, 0, 0.3)},
        {"/network/asymmetry_sigma_ms", between(draw, 0, 5)},
        {"/usb/spike_probability", between(draw, 0, 0.3)},
        {"/hosts/clock/oscillator/skew_sigma_ppm", between(draw, 1, 60)},
        {"/hosts/clock/oscillator/ramp_ppm_per_hour", between(draw, -20, 20)},
        {"/hosts/clock/initial_offset_sigma_ms", between(draw, 0, 1e5)},
        {"/hosts/clock/tick_ms", draw.uniform() < 0.3 ? "15.625" : "0"},
        {"/cameras/oscillator/skew_sigma_ppm", between(draw, 1, 60)},
        {"/cameras/oscillator/self_heating_ppm", between(draw, -5, 5)},
        {"/cameras/drop_probability", between(draw, 0, 0.2)},
        {"/cameras/clock_epoch_max_ms", between(draw, 0, 4294967)},
        {"/cameras/sensor_stamp_jitter_sigma_us", between(draw, 0, 50)},
        {"/hosts/load_burst/rate_hz", between(draw, 0, 3)},
        {"/hosts/load_burst/duration_exponential_ms", "100"},
        {"/hosts/load_burst/latency_ms", between(draw, 0, 20)}};
    const std::string base = draw.uniform() < 0.5 ? "18cam_6host_45fps_lan" : "leaderboard_lan_tcp";
    const std::vector<std::string> pipelines = {
        "chrony_lan+two_way_poll_calibrated+yoon2021", "ntp_lan+two_way_poll+yoon2021",
        "ptp_p2p_software+two_way_poll+yoon2021", "ptp_e2e_software+two_way_poll+certified",
        "yoon2021_both+two_way_poll+yoon2021"};
    const scenarios::Scenario scenario =
        scenarios::load_scenario(base, with_ad_hoc_pipelines(base, changes, pipelines));
    CertificateOptions options{
        .pipelines = pipelines, .first_seed = world + 1, .assumptions = assumptions_of(scenario)};
    frames += expect_truth_within(scenario, options, fmt::format("{}, world {}", base, world));
  }
  EXPECT_GT(frames, 30'000U);
}

}  // namespace
}  // namespace simbench::evaluation
