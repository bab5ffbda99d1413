#include "evaluation/budget/host_clock_budget.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstring>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "algorithms/ports/host_sync.h"
#include "algorithms/registry.h"
#include "recording/recording.h"
#include "scenarios/loader.h"
#include "sim/rig/simulation.h"
#include "tests/nonempty.h"

namespace simbench::evaluation {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

// A question, an answer, one step: nothing of its own is wrong. `one_way` takes the answer's time
// for the time at its arrival.
class StepOnce final : public HostSync {
 public:
  explicit StepOnce(bool one_way) : one_way_(one_way) {}

  Task<void> run_master(Host& host, std::vector<PeerId> slaves) override {
    for (const PeerId slave : slaves) {
      MessageChannel& channel = host.open_channel(slave, Transport::kStream);
      co_await channel.receive(host.steady_clock().now() + kIdle);
      const HostTime now = co_await host.clock().now();
      Bytes answer(sizeof now);
      std::memcpy(answer.data(), &now, sizeof now);
      co_await channel.send(std::move(answer));
    }
  }

  Task<void> run_slave(Host& host, PeerId master) override {
    MessageChannel& channel = host.open_channel(master, Transport::kStream);
    const HostTime asked = co_await host.clock().now();
    Bytes question(sizeof asked);
    co_await channel.send(std::move(question));
    const auto answer = co_await channel.receive(host.steady_clock().now() + kIdle);
    HostTime of_master;
    std::memcpy(&of_master, answer->bytes.data(), sizeof of_master);
    const Nanoseconds way = one_way_ ? Nanoseconds(0) : (answer->received - asked) / 2;
    const Nanoseconds behind = of_master + way - answer->received;
    const HostTime now = co_await host.clock().now();
    co_await host.clock().set(now + behind);
  }

 private:
  bool one_way_;
};

void register_once(const std::string& name, bool one_way) {
  if (find_algorithm<HostSyncEntry>(name) != nullptr) return;
  register_algorithm<HostSyncEntry>(
      {.info = {.name = name,
                .family = "test_" + name,
                .summary = "one exchange, one step",
                .source = "this test"},
       .make = [one_way](const Parameters&) { return std::make_unique<StepOnce>(one_way); }});
}

scenarios::Pipeline step_once() {
  register_once("step_once", false);
  return {"step", "step_once", "raw_arrival", "yoon2021"};
}

scenarios::Pipeline one_way() {
  register_once("one_way_step", true);
  return {"one_way", "one_way_step", "raw_arrival", "yoon2021"};
}

const scenarios::Pipeline kPaper = {"both", "yoon2021_both", "raw_arrival", "yoon2021"};

scenarios::Scenario small_rig(const std::string& name,
                              const std::vector<scenarios::Override>& more = {}) {
  std::vector<scenarios::Override> overrides = {{"/hosts/count", "3"},
                                                {"/cameras/count", "3"},
                                                {"/cameras/cameras_per_host", "1"},
                                                {"/timeline/frames", "20"},
                                                {"/timeline/warm_up_ms", "200"},
                                                {"/timeline/wait_before_capture_ms", "1000"}};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return scenarios::load_scenario(name, overrides);
}

HostClockBudget divided(const scenarios::Scenario& scenario, const scenarios::Pipeline& pipeline) {
  return host_clock_budgets(
             scenario, {pipeline},
             [](const scenarios::Scenario& world) { return sim::make_simulation(world); },
             {.seeds = 3, .jobs = 1}, nullptr)
      .front();
}

const BudgetPart& part_of(const HostClockBudget& budget, HostClockCause cause) {
  return budget.parts[static_cast<std::size_t>(cause)];
}

std::size_t bit(HostClockCause cause) { return std::size_t{1} << static_cast<std::size_t>(cause); }

constexpr double kNanosecondMs = 1e-6;

// What is the same in all worlds of a cause gives exactly nothing, whatever the algorithm.
void expect_nothing(const HostClockBudget& budget, HostClockCause cause) {
  ASSERT_TRUE(budget.is_divided) << budget.note;
  for (const double value : nonempty(part_of(budget, cause).values)) EXPECT_EQ(value, 0);
}

TEST(HostClockBudget, PartsAddUpAndTheTotalIsTheMetric) {
  const scenarios::Scenario scenario = small_rig("18cam_6host_45fps");
  const HostClockBudget budget = divided(scenario, kPaper);
  EXPECT_THAT(budget.note, IsEmpty());
  scenarios::Scenario alone = scenario;
  alone.pipelines = {kPaper};
  alone.published.clear();
  const Results results = evaluate(
      alone, [&] { return sim::make_simulation(alone); }, {.seeds = 3, .jobs = 1}, nullptr);
  EXPECT_EQ(budget.total.values, results.rows.front().host_error_ms.values);
  for (std::size_t seed = 0; seed < nonempty(budget.total.values).size(); ++seed) {
    double sum = budget.algorithm.values[seed];
    for (const BudgetPart& part : budget.parts) sum += part.values[seed];
    EXPECT_NEAR(sum, budget.total.values[seed], 1e-12) << "seed " << seed + 1;
  }
  EXPECT_GT(budget.total.mean, 0.1);
}

TEST(HostClockBudget, PerfectOscillatorsHaveNoStaleness) {
  const std::size_t ideal = bit(HostClockCause::kOscillators);
  expect_nothing(divided(without_causes(small_rig("18cam_6host_45fps_lan"), ideal), kPaper),
                 HostClockCause::kOscillators);
}

TEST(HostClockBudget, IdealMessagesLeaveNothingToEstimate) {
  const std::size_t ideal = bit(HostClockCause::kMessages);
  expect_nothing(divided(without_causes(small_rig("18cam_6host_45fps"), ideal), kPaper),
                 HostClockCause::kMessages);
}

TEST(HostClockBudget, ExactClockCallsLeaveNothingToSteer) {
  const std::size_t ideal = bit(HostClockCause::kClockCalls);
  expect_nothing(divided(without_causes(small_rig("18cam_6host_45fps"), ideal), kPaper),
                 HostClockCause::kClockCalls);
}

TEST(HostClockBudget, WithNothingWrongAllIsTheAlgorithms) {
  const scenarios::Scenario ideal =
      without_causes(small_rig("18cam_6host_45fps"), kHostClockWorlds - 1);
  const HostClockBudget budget = divided(ideal, one_way());
  for (const HostClockCause cause :
       {HostClockCause::kMessages, HostClockCause::kOscillators, HostClockCause::kClockCalls}) {
    expect_nothing(budget, cause);
  }
  EXPECT_EQ(budget.algorithm.values, budget.total.values);
  // The constant latency, which a one-way method cannot know.
  EXPECT_NEAR(budget.total.mean, ideal.network.latency_fixed_ms, 2 * kNanosecondMs);
}

TEST(HostClockBudget, AStepAfterASymmetricExchangeHasNoErrorOfItsOwn) {
  for (const char* const name : {"18cam_6host_45fps", "18cam_6host_45fps_lan"}) {
    SCOPED_TRACE(name);
    const HostClockBudget budget = divided(small_rig(name), step_once());
    ASSERT_TRUE(budget.is_divided) << budget.note;
    EXPECT_GT(budget.total.mean, 0.01);
    for (const double value : nonempty(budget.algorithm.values)) {
      EXPECT_NEAR(value, 0, 2 * kNanosecondMs);
    }
  }
}

// Slaves 10 and 20 ppm fast of an exact master, set once: between the step and the pulses the clock
// drifts, and nothing else is wrong.
TEST(HostClockBudget, DriftSinceTheStepIsStaleness) {
  scenarios::Scenario scenario =
      without_causes(small_rig("18cam_6host_45fps"),
                     bit(HostClockCause::kMessages) | bit(HostClockCause::kClockCalls));
  scenario.hosts.clock.skew_of_host_ppm = {0, 10, 20};
  const HostClockBudget budget = divided(scenario, step_once());
  const BudgetPart& staleness = part_of(budget, HostClockCause::kOscillators);
  for (std::size_t seed = 0; seed < nonempty(budget.total.values).size(); ++seed) {
    EXPECT_NEAR(staleness.values[seed], budget.total.values[seed], 2 * kNanosecondMs);
  }
  // 15 ppm on average, over a second's wait, the warm-up and the middle of 20 pulses at 45 Hz; the
  // master waits no longer than its answer takes.
  EXPECT_NEAR(staleness.mean, 15e-6 * (1000 + 200 + 9.5e3 / 45), 15e-6 * 0.2);
}

// Each direction is off by half of the stated asymmetry, and so is the clock.
TEST(HostClockBudget, AnAsymmetryIsEstimation) {
  scenarios::Scenario scenario =
      without_causes(small_rig("18cam_6host_45fps"), kHostClockWorlds - 1);
  scenario.network.links = {{.host = 1, .asymmetry_ms = 0.1}, {.host = 2, .asymmetry_ms = -0.1}};
  const HostClockBudget budget = divided(scenario, step_once());
  for (const double value : nonempty(part_of(budget, HostClockCause::kMessages).values)) {
    EXPECT_NEAR(value, 0.05, 2 * kNanosecondMs);
  }
  EXPECT_NEAR(budget.algorithm.mean, 0, 2 * kNanosecondMs);
}

TEST(HostClockBudget, FaultsOfLinksAndClocksAreTheWorlds) {
  scenarios::Scenario scenario = small_rig("18cam_6host_45fps");
  scenario.faults = {scenarios::ClockStep{}, scenarios::LinkStops{}, scenarios::LeapSecond{},
                     scenarios::HostStops{}, scenarios::CameraVanishes{}};
  EXPECT_EQ(without_causes(scenario, bit(HostClockCause::kMessages)).faults.size(), 3U);
  EXPECT_EQ(without_causes(scenario, bit(HostClockCause::kOscillators)).faults.size(), 3U);
  EXPECT_EQ(without_causes(scenario, kHostClockWorlds - 1).faults.size(), 1U);
}

TEST(HostClockBudget, SaysWhatItCannotDivide) {
  const scenarios::Scenario scenario = small_rig("18cam_6host_45fps_lan_hardware_clocks");
  const auto note_of = [&](const char* host_sync) {
    const HostClockBudget budget =
        divided(scenario, {"mine", host_sync, "raw_arrival", "yoon2021"});
    EXPECT_FALSE(budget.is_divided);
    return budget.note;
  };
  EXPECT_THAT(note_of("oracle"), HasSubstr("oracle sends nothing"));
  EXPECT_THAT(note_of("free_running"), HasSubstr("free_running sends nothing"));
  EXPECT_THAT(note_of("common_view"), HasSubstr("looks at frames"));
  const scenarios::Scenario one_host =
      small_rig("18cam_6host_45fps", {{"/hosts/count", "1"}, {"/cameras/cameras_per_host", "3"}});
  EXPECT_THAT(divided(one_host, kPaper).note, HasSubstr("one host"));
}

// A simulation that fails at seed 2 where messages are ideal.
class FailsOnce final : public RecordingSource {
 public:
  explicit FailsOnce(const scenarios::Scenario& world)
      : has_ideal_messages_(world.network.spike_probability == 0),
        simulation_(sim::make_simulation(world)) {}
  RecordingCost record(const RecordingRequest& request, RecordingSink& sink) override {
    if (has_ideal_messages_ && request.seed == 2) throw RecordingFailed("the daemon ended");
    return simulation_->record(request, sink);
  }

 private:
  bool has_ideal_messages_;
  std::unique_ptr<RecordingSource> simulation_;
};

TEST(HostClockBudget, ASeedThatFailsInOneWorldIsLeftOutOfAll) {
  const HostClockBudget budget =
      host_clock_budgets(
          small_rig("18cam_6host_45fps"), {kPaper},
          [](const scenarios::Scenario& world) { return std::make_unique<FailsOnce>(world); },
          {.seeds = 3, .jobs = 1}, nullptr)
          .front();
  ASSERT_TRUE(budget.is_divided);
  EXPECT_THAT(budget.note, HasSubstr("1 of 3 seeds have no host clock error"));
  EXPECT_THAT(budget.note, HasSubstr("the daemon ended"));
  double sum = budget.algorithm.mean;
  for (const BudgetPart& part : budget.parts) {
    sum += part.mean;
    EXPECT_TRUE(std::isnan(part.values[1]));
  }
  EXPECT_TRUE(std::isnan(budget.total.values[1]));
  EXPECT_NEAR(sum, budget.total.mean, 1e-12);
}

TEST(HostClockBudget, PipelinesTogetherHaveTheBudgetsOfEachAlone) {
  const scenarios::Scenario scenario = small_rig("18cam_6host_45fps");
  ASSERT_TRUE(scenario.draws_load());
  const scenarios::Pipeline oracle = {"oracle", "oracle", "raw_arrival", "yoon2021"};
  std::uint64_t last = 0;
  const std::vector<HostClockBudget> together = host_clock_budgets(
      scenario, {step_once(), oracle, kPaper},
      [](const scenarios::Scenario& world) { return sim::make_simulation(world); }, {.seeds = 3},
      [&](std::uint64_t done, std::uint64_t total) {
        EXPECT_EQ(total, 2 * 3 * kHostClockWorlds);
        last = done;
      });
  EXPECT_EQ(last, 2 * 3 * kHostClockWorlds);
  ASSERT_EQ(together.size(), 3U);
  EXPECT_FALSE(together[1].is_divided);
  const std::vector<HostClockBudget> alone = {
      divided(scenario, step_once()), {}, divided(scenario, kPaper)};
  for (const std::size_t i : {0U, 2U}) {
    EXPECT_EQ(together[i].total.values, alone[i].total.values);
    EXPECT_EQ(together[i].algorithm.values, alone[i].algorithm.values);
    for (std::size_t part = 0; part < kHostClockCauseCount; ++part) {
      EXPECT_EQ(together[i].parts[part].values, alone[i].parts[part].values);
    }
  }
}

}  // namespace
}  // namespace simbench::evaluation
