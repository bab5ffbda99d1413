// What Yoon et al. 2021 say of global stamps, by calculation: Figs. 4 and 5, in the fitted world.
//
// There each arrival has an independent jitter Exp(m). A regression over n frames that are equally
// far apart has the leverage (4n-2)/(n(n+1)) at its end, so global stamps have the standard
// deviation m sqrt(118/930) with n = 30.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "evaluation/run/run_detail.h"
#include "scenarios/loader.h"
#include "sim/rig/simulation.h"
#include "tests/nonempty.h"

namespace simbench::evaluation {
namespace {

constexpr std::uint64_t kLastSeed = 20;

std::vector<RunDetail> captures_of(const scenarios::Scenario& scenario,
                                   const std::string& pipeline) {
  std::vector<RunDetail> runs;
  const auto source = sim::make_simulation(scenario);
  const PipelineChoice choice = choose_pipelines(scenario, {pipeline}).front();
  for (std::uint64_t seed = 1; seed <= kLastSeed; ++seed) {
    runs.push_back(run_detail(scenario, choice, seed, *source));
  }
  return runs;
}

double jitter_ms(const scenarios::Scenario& scenario) {
  return scenario.usb.delivery_jitter_transfers * scenario.scored_stream()->image_bytes() * 1e-3 /
         scenario.usb.bandwidth_mb_per_s;
}

// Fig. 5 a. The range of three normal numbers is 3/sqrt(pi) standard deviations on average.
TEST(GlobalStamps, OfThreeCamerasOfAHostLieTogether) {
  const scenarios::Scenario scenario = scenarios::load_scenario("3cam_1host_30fps");
  double mean_ms = 0;
  for (const RunDetail& run : nonempty(captures_of(scenario, "free_running"))) {
    mean_ms += run.score.amd_ms / kLastSeed;
  }
  const double expected_ms = jitter_ms(scenario) * std::sqrt(118.0 / 930) * 3 / std::sqrt(M_PI);
  EXPECT_NEAR(mean_ms, expected_ms, 0.15 * expected_ms) << "seeds 1-20";
  EXPECT_LT(mean_ms, 0.01 * scenario.trigger.period_ms());
}

// Section 4.5: with extension cards one host carries all cameras, and needs no other.
TEST(GlobalStamps, OfEighteenCamerasOfAHostLieTogether) {
  const scenarios::Scenario scenario = scenarios::load_scenario("18cam_1host_pcie");
  for (const RunDetail& run : nonempty(captures_of(scenario, "free_running"))) {
    EXPECT_LT(run.score.amd_ms, 0.1 * scenario.trigger.period_ms()) << "seed " << run.seed;
    EXPECT_EQ(run.score.sets.pure, run.score.sets.complete_pulses) << "seed " << run.seed;
  }
}

// Fig. 5 b and Fig. 8 a, before the hosts are synchronised: clocks that ran free for 6.8 hours with
// N(10 ppm) are apart by N(245 ms), and global stamps of a host by less than 0.1 ms.
TEST(GlobalStamps, OfTwoHostsFormTwoClusters) {
  const scenarios::Scenario scenario = scenarios::load_scenario("6cam_2host_30fps");
  for (const RunDetail& run : nonempty(captures_of(scenario, "ntp_last_set"))) {
    EXPECT_LT(run.score.spread_in_host_ms, 0.1) << "seed " << run.seed;
    EXPECT_GT(run.score.spread_between_hosts_ms, 10 * run.score.spread_in_host_ms)
        << "seed " << run.seed;
  }
}

// Fig. 4. Each line goes through all of its points, so an offline stamp has the leverage of its
// frame among all N, 2/N on average, and the difference has the variance of online less offline.
TEST(GlobalStamps, OnlineAndOfflineLookTheSame) {
  const scenarios::Scenario scenario = scenarios::load_scenario("3cam_1host_30fps");
  double squares = 0;
  double count = 0;
  for (const RunDetail& run : nonempty(captures_of(scenario, "free_running"))) {
    for (const CameraDetail& camera : run.cameras) {
      std::int64_t seen = 0;
      for (const FrameDetail& frame : camera.frames) {
        if (frame.in_warm_up || ++seen < 30) continue;
        squares += std::pow(frame.online_ms - frame.offline_ms, 2);
        ++count;
      }
    }
  }
  ASSERT_EQ(count, 20 * 3 * (480 - 29));
  const double expected_ms = jitter_ms(scenario) * std::sqrt(118.0 / 930 - 2.0 / 480);
  EXPECT_NEAR(std::sqrt(squares / count), expected_ms, 0.1 * expected_ms) << "seeds 1-20";
  EXPECT_LT(expected_ms, 0.002 * scenario.trigger.period_ms()) << "nothing that a figure shows";
}

scenarios::Scenario short_world(const std::string& name) {
  return scenarios::load_scenario(name, {{"/timeline/frames", "60"}});
}

// Section 4.5: the method mends Full Slave, by the criterion of section 4.2, an AMD below the
// interval of the frames.
TEST(GlobalStamps, TheMethodBringsFullSlaveBelowTheFrameInterval) {
  const scenarios::Scenario scenario = short_world("18cam_6host_90fps_full_slave");
  const double interval_ms = scenario.trigger.period_ms();
  for (const RunDetail& run : nonempty(captures_of(scenario, "ntp_last_set"))) {
    EXPECT_GT(run.score.amd_ms, interval_ms) << "seed " << run.seed;
  }
  for (const RunDetail& run : nonempty(captures_of(scenario, "yoon2021_both"))) {
    EXPECT_LT(run.score.amd_ms, interval_ms) << "seed " << run.seed;
  }
}

// Section 4.5: without a common start GenLock order counts from different pulses, up to 2 s apart
// (18 uniform numbers have a range of 17/19 of that); global stamps do not count.
TEST(GlobalStamps, AStaggeredStartFailsGenlockOrderAlone) {
  const scenarios::Scenario scenario = short_world("18cam_6host_45fps_staggered_start");
  double genlock_ms = 0;
  for (const RunDetail& run : nonempty(captures_of(scenario, "genlock"))) {
    genlock_ms += run.score.amd_ms / kLastSeed;
  }
  const double spread_ms = scenario.cameras.start_spread_ms;
  EXPECT_NEAR(genlock_ms, spread_ms * 17 / 19, 0.1 * spread_ms) << "seeds 1-20";
  for (const RunDetail& run : nonempty(captures_of(scenario, "yoon2021_both"))) {
    EXPECT_LT(run.score.amd_ms, scenario.trigger.period_ms()) << "seed " << run.seed;
  }
}

}  // namespace
}  // namespace simbench::evaluation
