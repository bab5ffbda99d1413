#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <set>
#include <string>

#include "reconstruction/experiment.h"
#include "scenarios/loader.h"
#include "sim/rig/simulation.h"

namespace simbench::reconstruction {
namespace {

using testing::HasSubstr;

constexpr const char* kStudio = "18cam_6host_30fps_studio";

// Six small cameras on two hosts, at one height.
scenarios::Scenario small_rig(std::vector<scenarios::Override> more = {}) {
  std::vector<scenarios::Override> overrides = {
      {"/hosts/count", "2"},
      {"/cameras/count", "6"},
      {"/cameras/streams/0/width", "424"},
      {"/cameras/streams/0/height", "240"},
      {"/studio/heights_m", "[1.0]"},
      {"/studio/point_spacing_mm", "20"},
      {"/studio/visibility_spread_px", "2"},
      {"/timeline/frames", "60"},
  };
  overrides.insert(overrides.end(), more.begin(), more.end());
  scenarios::Scenario scenario = scenarios::load_scenario(kStudio, overrides);
  // They hold in the whole world only; here it is tried how a row is compared with them.
  scenario.studio->published = scenarios::load_scenario(kStudio).studio->published;
  return scenario;
}

ReconstructionResults run(const scenarios::Scenario& scenario, ReconstructionOptions options,
                          const MeshKeeper& on_mesh = nullptr) {
  return run_reconstruction(
      scenario, [&] { return sim::make_simulation(scenario); }, options, on_mesh, nullptr);
}

ReconstructionOptions two_seeds() {
  ReconstructionOptions options;
  options.seeds = 2;
  options.frames = 2;
  options.pipelines = {"ntp_last_set", "yoon2021_both"};
  return options;
}

TEST(Experiment, ThatIsUnsynchronisedIsWorseAndThreadsChangeNothing) {
  const scenarios::Scenario scenario = small_rig();
  ReconstructionOptions options = two_seeds();
  options.jobs = 2;
  std::set<std::string> shown;
  const ReconstructionResults results = run(scenario, options, [&](const ShownMesh& mesh) {
    shown.insert(mesh.pipeline);
    EXPECT_EQ(mesh.mesh.colours.size(), mesh.mesh.vertices.size());
    EXPECT_THAT(mesh.ply, testing::StartsWith("ply"));
    EXPECT_GT(mesh.png.size(), 1000U);
  });
  ASSERT_EQ(results.rows.size(), 2U);
  EXPECT_EQ(shown, (std::set<std::string>{"ntp_last_set", "yoon2021_both"}));
  const ReprojectionRow& ntp = results.rows[0];
  const ReprojectionRow& proposed = results.rows[1];
  EXPECT_GT(ntp.mean_cm().median, 1.5 * proposed.mean_cm().median);
  EXPECT_GT(ntp.desync_ms().median, 30);
  EXPECT_LT(proposed.desync_ms().median, 6);
  ASSERT_TRUE(proposed.published.has_value());
  EXPECT_EQ(proposed.published->mean_cm, 2.3942);

  options.jobs = 1;
  const ReconstructionResults again = run(scenario, options);
  for (std::size_t row = 0; row < 2; ++row) {
    EXPECT_EQ(results.rows[row].mean_cm().values, again.rows[row].mean_cm().values);
    EXPECT_EQ(results.rows[row].std_cm().values, again.rows[row].std_cm().values);
    EXPECT_EQ(results.rows[row].p95_cm().values, again.rows[row].p95_cm().values);
  }
}

TEST(Experiment, CurveAndSearchHaveAPointForEachSpeed) {
  const scenarios::Scenario scenario = small_rig();
  ReconstructionOptions options = two_seeds();
  options.seeds = 1;
  options.frames = 1;
  options.curve_speed_factors = {0.5, 1};
  options.curve_desync_ms = {0, 300};
  options.search_speed_factors = {1.5, 0.01, 4};
  const ReconstructionResults results = run(scenario, options);
  ASSERT_EQ(results.curve.size(), 4U);
  EXPECT_EQ(results.curve[1].speed_factor, 0.5);
  EXPECT_EQ(results.curve[1].desync_ms, 300);
  EXPECT_NEAR(results.curve[2].speed_m_per_s, 1.2, 1e-12);
  // Nothing that exposes together is worse than what does not.
  EXPECT_LT(results.curve[0].mean_cm[0], results.curve[1].mean_cm[0]);
  EXPECT_LT(results.curve[2].mean_cm[0], results.curve[3].mean_cm[0]);
  ASSERT_TRUE(results.speed_needed.has_value());
  EXPECT_EQ(results.speed_needed->pipeline, "ntp_last_set");
  // Outward from the row itself, on one side of it, until the published error is passed.
  const SpeedNeeded& needed = *results.speed_needed;
  const double row_cm = results.rows[0].seeds[0].errors.mean_cm;
  const bool faster = row_cm < needed.published_mean_cm;
  ASSERT_GE(needed.points.size(), 2U);
  const CurvePoint& itself = faster ? needed.points.front() : needed.points.back();
  EXPECT_EQ(itself.speed_factor, 1);
  EXPECT_EQ(itself.mean_cm[0], row_cm);
  EXPECT_EQ(needed.points[1].speed_factor, faster ? 1.5 : 1);
  EXPECT_NE(needed.points[0].mean_cm[0], needed.points[1].mean_cm[0]);
}

TEST(Experiment, AVanishedCameraIsCountedAndDoneWithout) {
  const scenarios::Scenario scenario =
      small_rig({{"/faults", R"([{"kind": "camera_vanishes", "camera": 4, "at_ms": 100,
                        "duration_ms": 100000}])"}});
  ReconstructionOptions options = two_seeds();
  options.pipelines = {"yoon2021_both"};
  options.seeds = 1;
  const ReconstructionResults results = run(scenario, options);
  const SeedReprojection& seed = results.rows[0].seeds.at(0);
  EXPECT_EQ(seed.sets, 2);
  EXPECT_EQ(seed.missing_frames, 2);
  EXPECT_GT(seed.errors.count, 1000);
}

TEST(Experiment, RefusesASubjectThatNoCameraSees) {
  const scenarios::Scenario scenario =
      small_rig({{"/studio/look_at_height_m", "40"}, {"/studio/subject/motion", "\"stand\""}});
  try {
    run(scenario, two_seeds());
    FAIL() << "nothing was refused";
  } catch (const scenarios::InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("/studio/subject"));
    EXPECT_THAT(error.what(), HasSubstr("no camera sees"));
  }
}

TEST(Experiment, RefusesAScenarioWithoutAStudioAndUnknownPipelines) {
  EXPECT_THROW(run(scenarios::load_scenario("6cam_2host_30fps"), {}), scenarios::InputError);
  ReconstructionOptions options;
  options.pipelines = {"nobody"};
  EXPECT_THROW(run(small_rig(), options), scenarios::InputError);
}

TEST(Experiment, RefusesAMeshThatIsNotThere) {
  const scenarios::Scenario scenario =
      small_rig({{"/studio/subject/kind", "\"mesh\""},
                 {"/studio/subject/mesh_file", "\"/nowhere/at/all.ply\""}});
  EXPECT_THROW(run(scenario, two_seeds()), scenarios::InputError);
}

TEST(Experiment, ThatIsCancelledHasNoResult) {
  const scenarios::Scenario scenario = small_rig();
  std::atomic<bool> cancel = true;
  ReconstructionOptions options = two_seeds();
  options.cancel = &cancel;
  EXPECT_THROW(run(scenario, options), ReconstructionCancelled);
}

}  // namespace
}  // namespace simbench::reconstruction
