#include "evaluation/clock_run/program_duration.h"

#include <gmock/gmock.h>

#include "scenarios/loader.h"

namespace simbench::evaluation {
namespace {

using scenarios::Scenario;
using testing::SizeIs;

// Six hosts, with one program each that needs so long until a capture.
Scenario star(double run_before_capture_s, std::int64_t hosts = 6,
              std::vector<scenarios::Fault> faults = {}) {
  Scenario scenario = scenarios::load_scenario("6host_star");
  scenario.hosts.count = hosts;
  scenario.faults = std::move(faults);
  scenarios::Pipeline& pipeline = scenario.pipelines.emplace_back(scenario.pipelines.front());
  pipeline.name = "mine";
  pipeline.programs = {
      .master = {{"server"}}, .slave = {{"client"}}, .run_before_capture_s = run_before_capture_s};
  return scenario;
}

std::uint64_t duration_s(const Scenario& scenario, std::uint64_t from_s = 300) {
  return program_duration_s(scenario, {}, from_s);
}

TEST(ProgramDuration, TenMinutesUnlessTheProgramsNeedMore) {
  EXPECT_EQ(duration_s(star(0)), 600U);
  EXPECT_EQ(duration_s(star(60)), 600U);
  EXPECT_EQ(duration_s(star(1000)), 1320U) << "1300 in whole minutes";
}

TEST(ProgramDuration, AnHourOfSixHostsIsTheMost) { EXPECT_EQ(duration_s(star(14'400)), 3600U); }

TEST(ProgramDuration, ManyHostsRunShorter) {
  EXPECT_EQ(duration_s(star(1000, 24)), 900U) << "21600 / 24";
  EXPECT_EQ(duration_s(star(0, 1000)), 360U) << "but six minutes at least";
}

TEST(ProgramDuration, FaultsAreSeen) {
  const scenarios::LinkStops fault{.host = 1, .at_ms = 700e3, .duration_ms = 100e3};
  EXPECT_EQ(duration_s(star(0, 6, {fault})), 1140U) << "1100 in whole minutes";
}

TEST(ProgramDuration, SomethingIsMeasured) {
  EXPECT_EQ(duration_s(star(0), 1000), 1320U);
  EXPECT_EQ(duration_s(star(0, 1000), 1000), 1080U) << "a minute of it, however dear";
}

TEST(ProgramDuration, ChosenPipelinesCount) {
  const Scenario scenario = star(1000);
  EXPECT_THAT(program_pipelines(scenario, {}), SizeIs(1));
  EXPECT_THAT(program_pipelines(scenario, {"chrony"}), SizeIs(0));
  EXPECT_THAT(program_pipelines(scenario, {"chrony", "mine"}), SizeIs(1));
}

TEST(ProgramDuration, LongRunsLoseTheirMaster) {
  EXPECT_FALSE(loss_is_worth_it(4199));
  EXPECT_TRUE(loss_is_worth_it(4200));
}

}  // namespace
}  // namespace simbench::evaluation
