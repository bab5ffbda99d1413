// In simulation the truth lies within every certificate, of all pipelines of all built-in worlds
// and of worlds at random, and no facts contradict each other: the assumptions that follow from a
// scenario hold in it.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
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
    for (const ContradictedCapture& proof : row.contradicted) {
      ADD_FAILURE() << fmt::format("{}: {}: contradicted by {} ms:\n{}", name, row.pipeline,
                                   proof.before_ms, fmt::join(proof.chain, "\n"));
    }
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

std::string whole(sim::RandomStream& draw, int least, int most) {
  return fmt::format("{}", least + static_cast<int>((most - least + 1) * draw.uniform()));
}

// What goes wrong in a world, one of each kind or none.
std::string faults_at_random(sim::RandomStream& draw) {
  std::vector<std::string> faults;
  const auto maybe = [&](const std::string& fault) {
    if (draw.uniform() < 0.5) faults.push_back(fault);
  };
  maybe(fmt::format(R"({{"kind": "clock_step", "host": {}, "at_ms": {}, "step_ms": {}}})",
                    whole(draw, 0, 5), between(draw, 0, 2000), between(draw, -500, 500)));
  maybe(
      fmt::format(R"({{"kind": "camera_vanishes", "camera": {}, "at_ms": {}, "duration_ms": {}}})",
                  whole(draw, 0, 17), between(draw, 0, 2000), between(draw, 50, 2000)));
  maybe(fmt::format(R"({{"kind": "host_stops", "host": {}, "at_ms": {}, "duration_ms": {}}})",
                    whole(draw, 1, 5), between(draw, 0, 2000), between(draw, 50, 2000)));
  maybe(fmt::format(R"({{"kind": "link_stops", "host": {}, "at_ms": {}, "duration_ms": {}}})",
                    whole(draw, 1, 5), between(draw, 0, 2000), between(draw, 50, 2000)));
  maybe(fmt::format(R"({{"kind": "late_first_frame", "camera": {}, "duration_ms": {}}})",
                    whole(draw, 0, 17), between(draw, 0, 500)));
  maybe(fmt::format(R"({{"kind": "leap_second", "at_ms": {}, "smear_ms": 0, "inserted": {}}})",
                    between(draw, 0, 2000), draw.uniform() < 0.5));
  return fmt::format("[{}]", fmt::join(faults, ", "));
}

std::vector<scenarios::Override> world_at_random(sim::RandomStream& draw,
                                                 const std::string& frames) {
  return {{"/timeline/frames", frames},
          {"/timeline/warm_up_ms", "1000"},
          {"/network/latency_fixed_ms", between(draw, 0.02, 20)},
          {"/network/loss_probability", between(draw, 0, 0.3)},
          {"/network/duplicate_probability", between(draw, 0, 0.1)},
          {"/network/reorder_probability", between(draw, 0, 0.1)},
          {"/network/asymmetry_sigma_ms", between(draw, 0, 5)},
          {"/network/spike_probability", between(draw, 0, 0.1)},
          {"/network/spike_max_ms", between(draw, 0, 200)},
          {"/usb/spike_probability", between(draw, 0, 0.3)},
          {"/hosts/clock/oscillator/skew_sigma_ppm", between(draw, 1, 60)},
          {"/hosts/clock/oscillator/ramp_ppm_per_hour", between(draw, -1, 1)},
          {"/hosts/clock/oscillator/random_walk_ppb_per_sqrt_s", between(draw, 0, 2)},
          {"/hosts/clock/oscillator/flicker_floor_ppb", between(draw, 0, 20)},
          {"/hosts/clock/initial_offset_sigma_ms", between(draw, 0, 1e5)},
          {"/hosts/clock/tick_ms", draw.uniform() < 0.3 ? "15.625" : "0"},
          {"/hosts/clock/arrival_quantum_ms", draw.uniform() < 0.3 ? "1" : "0"},
          {"/hosts/load_burst/rate_hz", between(draw, 0, 3)},
          {"/hosts/load_burst/duration_exponential_ms", "100"},
          {"/hosts/load_burst/latency_ms", between(draw, 0, 20)},
          {"/trigger/missed_pulse_probability", between(draw, 0, 0.05)},
          {"/cameras/oscillator/skew_sigma_ppm", between(draw, 1, 60)},
          {"/cameras/oscillator/self_heating_ppm", between(draw, -5, 5)},
          {"/cameras/drop_probability", between(draw, 0, 0.2)},
          {"/cameras/clock_epoch_max_ms", between(draw, 0, 4294967)},
          {"/cameras/sensor_stamp_jitter_sigma_us", between(draw, 0, 50)},
          {"/cameras/clock_poll/tail_probability", between(draw, 0, 0.2)},
          {"/cameras/clock_poll/tail_max_ms", between(draw, 1, 100)},
          {"/faults", faults_at_random(draw)}};
}

std::uint64_t number_from(const char* variable, std::uint64_t otherwise) {
  const char* const given = std::getenv(variable);
  return given == nullptr ? otherwise : std::strtoull(given, nullptr, 10);
}

// Faults and noise of all kinds at once. For hours of worlds: CERTIFIED_WORLDS, from
// CERTIFIED_FIRST_WORLD on, each of CERTIFIED_FRAMES pulses.
TEST(CertifiedWorlds, TheTruthLiesWithinInWorldsAtRandom) {
  const std::uint64_t first = number_from("CERTIFIED_FIRST_WORLD", 0);
  const std::uint64_t worlds = number_from("CERTIFIED_WORLDS", 24);
  const std::uint64_t pulses = number_from("CERTIFIED_FRAMES", 90);
  constexpr sim::ComponentKey kKey("test: worlds to certify");
  std::size_t frames = 0;
  for (std::uint64_t world = first; world < first + worlds; ++world) {
    sim::RandomStream draw(1, kKey, world, 0);
    const auto changes = world_at_random(draw, fmt::format("{}", pulses));
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
    if (worlds > 100) fmt::print("{} frames up to world {}\n", frames, world);
  }
  EXPECT_GT(frames, worlds * pulses);
}

}  // namespace
}  // namespace simbench::evaluation
