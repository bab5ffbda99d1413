#include "evaluation/sweep/sweep_plan.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <string>

#include "scenarios/loader.h"
#include "scenarios/study.h"

namespace simbench::evaluation {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

SweepRequest two_axes() {
  return {.scenario = "18cam_6host_45fps",
          .axes = {"/trigger/rate_hz=15,45", "/hosts/count=6:8:1"},
          .pipelines = {"oracle", "genlock"},
          .first_seed = 10,
          .seeds = 4};
}

std::string problem_of(const SweepRequest& request) {
  try {
    check_points(make_plan(request), request, 2);
  } catch (const scenarios::InputError& error) {
    return error.what();
  }
  return "none";
}

std::string problem_of_axis(const std::string& axis) {
  return problem_of({.scenario = "18cam_6host_45fps", .axes = {axis}, .seeds = 1});
}

TEST(SweepPlan, EveryCombinationTheFirstAxisSlowest) {
  const SweepPlan plan = make_plan(two_axes());
  EXPECT_EQ(plan.points(), 6U);
  EXPECT_EQ(plan.runs(), 6U * 2 * 4);
  EXPECT_THAT(plan.pointers(), ElementsAre("/trigger/rate_hz", "/hosts/count"));
  EXPECT_THAT(plan.values(0), ElementsAre("15", "6"));
  EXPECT_THAT(plan.values(2), ElementsAre("15", "8"));
  EXPECT_THAT(plan.values(3), ElementsAre("45", "6"));
  EXPECT_EQ(plan.point_text(5), "/trigger/rate_hz=45, /hosts/count=8");
}

TEST(SweepPlan, RunsGoPointByPointPipelineByPipelineSeedBySeed) {
  const SweepPlan plan = make_plan(two_axes());
  std::size_t index = 0;
  for (std::size_t point = 0; point < 6; ++point) {
    for (std::size_t pipeline = 0; pipeline < 2; ++pipeline) {
      for (std::uint64_t seed = 10; seed < 14; ++seed, ++index) {
        const SweepRun run = plan.run(index);
        EXPECT_EQ(run.point, point);
        EXPECT_EQ(run.pipeline, pipeline);
        EXPECT_EQ(run.seed, seed);
      }
    }
  }
  EXPECT_EQ(index, plan.runs());
}

TEST(SweepPlan, WithoutAxesThereIsOnePoint) {
  const SweepPlan plan = make_plan({.scenario = "3cam_1host_30fps", .seeds = 3});
  EXPECT_EQ(plan.points(), 1U);
  EXPECT_EQ(plan.runs(), plan.pipelines.size() * 3);
  EXPECT_EQ(plan.point_text(0), "as it is");
}

TEST(SweepPlan, NamesThePointThatIsRefused) {
  EXPECT_THAT(problem_of_axis("/timline/frames=100"), HasSubstr("did you mean timeline?"));
  EXPECT_THAT(problem_of_axis("/hosts/count=6,0"),
              HasSubstr("point 2 of 2 of the sweep (/hosts/count=0) is refused: --sweep "
                        "/hosts/count=0: found 0, allowed"));
  EXPECT_THAT(problem_of_axis("/trigger/rate_hz=45,fast"), HasSubstr("found \"fast\""));
  EXPECT_THAT(problem_of_axis("/algorithms/yoon2021/stmps=1"), HasSubstr("did you mean stamps?"));
  // One alone makes no valid scenario; in lockstep they do.
  EXPECT_THAT(problem_of_axis("/hosts/count=6,4"), HasSubstr("/hosts/count is 4"));
  EXPECT_EQ(problem_of_axis("/hosts/count=6,4+/cameras/count=18,12"), "none");
}

TEST(SweepPlan, TheFirstRefusedPointIsNamedWhateverTheThreads) {
  SweepRequest request = {.scenario = "18cam_6host_45fps", .axes = {"/hosts/count=6:0:-1"}};
  request.seeds = 1;
  for (int round = 0; round < 10; ++round)
    EXPECT_THAT(problem_of(request), HasSubstr("point 2 of"));
}

TEST(SweepPlan, RefusesWhatMakesNoSweep) {
  SweepRequest twice = two_axes();
  twice.axes.emplace_back("/hosts/count=6");
  EXPECT_THAT(problem_of(twice), HasSubstr("/hosts/count: the pointer is swept twice"));
  SweepRequest large = two_axes();
  large.seeds = 1'000'000'000;
  EXPECT_THAT(problem_of(large), HasSubstr("runs in all, allowed: at most"));
  SweepRequest unknown = two_axes();
  unknown.pipelines = {"genlok"};
  EXPECT_THAT(problem_of(unknown), HasSubstr("did you mean genlock"));
}

TEST(SweepPlan, ClockRunsAreOfPipelinesThatNeedNoCameras) {
  SweepRequest request = {.scenario = "18cam_6host_45fps", .seeds = 2};
  const std::size_t of_captures = make_plan(request).pipelines.size();
  request.kind = ResultKind::kClockRuns;
  request.clock_period = {.from_s = 10, .duration_s = 100};
  const SweepPlan plan = make_plan(request);
  EXPECT_EQ(plan.kind, ResultKind::kClockRuns);
  EXPECT_EQ(plan.clock_period, request.clock_period);
  EXPECT_GT(plan.pipelines.size(), 0U);
  EXPECT_LT(plan.pipelines.size(), of_captures);  // one for each host_sync
  EXPECT_TRUE(plan.left_out.empty());
  SweepRequest some_need_more = request;
  some_need_more.scenario = "leaderboard_lan";
  EXPECT_THAT(
      make_plan(some_need_more).left_out,
      testing::Contains(HasSubstr("host.trigger_wired: host_sync \"trigger_wired\" needs")));
  request.clock_period.from_s = 100;
  EXPECT_THAT(problem_of(request), HasSubstr("--from-s: found 100, allowed: less than"));
  request.clock_period.from_s = 98;
  EXPECT_THAT(problem_of(request), HasSubstr("--duration-s: found 100, allowed: at least 102"));
  request.clock_period.from_s = 10;
  request.axes = {"/hosts/count=6,1+/cameras/cameras_per_host=3,18"};
  EXPECT_THAT(problem_of(request), HasSubstr("point 2 of 2"));
  EXPECT_THAT(problem_of(request), HasSubstr("a master and a slave"));
}

TEST(SweepPlan, OverridesHoldAtEveryPoint) {
  SweepRequest request = two_axes();
  request.overrides = {{"/timeline/frames", "77"}};
  EXPECT_THAT(make_plan(request).scenario_json, HasSubstr("\"frames\": 77"));
}

TEST(SweepPlan, KnowsWhetherALoadIsDrawnForEachPipeline) {
  EXPECT_TRUE(make_plan({.scenario = "18cam_6host_45fps", .axes = {}, .seeds = 1}).draws_load);
  EXPECT_FALSE(make_plan({.scenario = "18cam_6host_45fps_lan", .axes = {}, .seeds = 1}).draws_load);
  for (const char* const member : scenarios::Scenario::kLoadMembers) {
    EXPECT_TRUE(scenarios::load_scenario("18cam_6host_45fps_lan", {{member, "0.1"}}).draws_load())
        << member;
    EXPECT_TRUE(make_plan({.scenario = "18cam_6host_45fps_lan",
                           .axes = {fmt::format("{}=0,0.1", member)},
                           .seeds = 1})
                    .draws_load)
        << member;
  }
}

TEST(SweepPlan, EveryStudyIsASweepThatCanRun) {
  ASSERT_FALSE(scenarios::studies().empty());
  for (const scenarios::Study& study : scenarios::studies()) {
    SweepRequest request = {.scenario = study.scenario,
                            .axes = study.sweep,
                            .pipelines = study.pipelines,
                            .seeds = study.seeds};
    if (study.clocks) {
      request.kind = ResultKind::kClockRuns;
      request.clock_period = {.from_s = study.from_s.value_or(300),
                              .duration_s = study.duration_s.value_or(36'000)};
    }
    for (const std::string& set : study.set) {
      const std::size_t equals = set.find('=');
      request.overrides.push_back({set.substr(0, equals), set.substr(equals + 1)});
    }
    EXPECT_EQ(problem_of(request), "none") << study.name;
  }
}

}  // namespace
}  // namespace simbench::evaluation
