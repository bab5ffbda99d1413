// Simulated captures with their truth taken away, as a real rig would have recorded them.
#include <gmock/gmock.h>

#include <cmath>
#include <memory>
#include <span>
#include <variant>

#include "evaluation/run/evaluate.h"
#include "recording/forwarding_sink.h"
#include "scenarios/loader.h"
#include "sim/rig/simulation.h"
#include "tests/nonempty.h"

namespace simbench::evaluation {
namespace {

using ::testing::Each;
using ::testing::IsNan;

class WithoutTruth final : public ForwardingSink {
 public:
  using ForwardingSink::ForwardingSink;
  void on_frames(std::span<const FrameRecord> frames, std::span<const FrameTruth>) override {
    sink().on_frames(frames, {});
  }
  void on_event(const RecordingEvent& event) override {
    if (!std::holds_alternative<PulseTruth>(event)) sink().on_event(event);
  }
};

class StrippedSource final : public RecordingSource {
 public:
  explicit StrippedSource(const scenarios::Scenario& scenario)
      : source_(sim::make_simulation(scenario)) {}
  RecordingCost record(const RecordingRequest& request, RecordingSink& sink) override {
    WithoutTruth stripped(sink);
    return source_->record(request, stripped);
  }

 private:
  std::unique_ptr<RecordingSource> source_;
};

const EvaluationOptions kOptions = {
    .first_seed = 1, .seeds = 3, .jobs = 1, .pipelines = {"yoon2021_both", "genlock"}};

Results simulated(const scenarios::Scenario& scenario, const EvaluationOptions& options) {
  return evaluate(
      scenario, [&] { return sim::make_simulation(scenario); }, options, nullptr);
}

Results stripped(const scenarios::Scenario& scenario, const EvaluationOptions& options) {
  return evaluate(
      scenario, [&] { return std::make_unique<StrippedSource>(scenario); }, options, nullptr);
}

TEST(StrippedTruth, GenlockOrderGivesTheSameAmdAndRmdv) {
  const scenarios::Scenario scenario =
      scenarios::load_scenario("18cam_6host_45fps", {{"/timeline/frames", "60"}});
  const Results with = simulated(scenario, kOptions);
  const Results without = stripped(scenario, kOptions);
  ASSERT_EQ(with.rows.size(), 2);
  for (std::size_t i = 0; i < with.rows.size(); ++i) {
    const Row& truth = with.rows[i];
    const Row& order = without.rows[i];
    ASSERT_EQ(truth.frames.dropped, 0);
    EXPECT_EQ(truth.ground_truth, GroundTruth::kSimulation);
    EXPECT_EQ(order.ground_truth, GroundTruth::kGenlockOrder);
    EXPECT_TRUE(order.verified());
    EXPECT_EQ(order.amd_ms.values, truth.amd_ms.values) << truth.pipeline;
    EXPECT_EQ(order.rmdv_ms.values, truth.rmdv_ms.values) << truth.pipeline;
    EXPECT_EQ(order.frames.delivered, truth.frames.delivered);
    EXPECT_EQ(order.evaluated_pulses, truth.evaluated_pulses);
    EXPECT_THAT(order.absolute_error_ms.values, Each(IsNan()));
    EXPECT_THAT(order.host_error_ms.values, Each(IsNan()));
    EXPECT_GT(truth.absolute_error_ms.median, 0);
  }
}

TEST(StrippedTruth, SlaveCapturesAreScoredOverSetsAndUnverified) {
  // Slave mode: the trigger has to run at a rate of the mode.
  const scenarios::Scenario scenario =
      scenarios::load_scenario("18cam_6host_45fps_lan", {{"/timeline/frames", "60"},
                                                         {"/cameras/sync_mode", "\"slave\""},
                                                         {"/trigger/rate_hz", "90"}});
  const EvaluationOptions options = {
      .first_seed = 1, .seeds = 2, .jobs = 1, .pipelines = {"yoon2021_both"}};
  const Row truth = simulated(scenario, options).rows.front();
  const Row row = stripped(scenario, options).rows.front();
  EXPECT_EQ(row.ground_truth, GroundTruth::kNone);
  EXPECT_FALSE(row.verified());
  EXPECT_TRUE(std::isnan(row.precision));
  EXPECT_TRUE(std::isnan(row.recall));
  EXPECT_TRUE(std::isnan(row.margin_ms));
  EXPECT_THAT(row.absolute_error_ms.values, Each(IsNan()));
  EXPECT_EQ(row.amd_ms.values, row.set_amd_ms.values);
  EXPECT_EQ(row.evaluated_pulses, row.sets.emitted);
  // The same sets are gathered, but for those at the two ends of what is evaluated.
  EXPECT_NEAR(static_cast<double>(row.sets.emitted), static_cast<double>(truth.sets.emitted), 8);
  EXPECT_GT(row.sets.emitted, 50);
  for (std::size_t seed = 0; seed < 2; ++seed) {
    // A late frame in one of those is some percent of the mean.
    EXPECT_NEAR(row.set_amd_ms.values[seed] / truth.set_amd_ms.values[seed], 1, 0.1);
  }
}

TEST(StrippedTruth, ClaimsRestOnVerifiedRowsOnly) {
  const scenarios::Scenario scenario =
      scenarios::load_scenario("18cam_6host_45fps_lan", {{"/timeline/frames", "60"},
                                                         {"/cameras/sync_mode", "\"slave\""},
                                                         {"/trigger/rate_hz", "90"}});
  const Results results =
      stripped(scenario, {.first_seed = 1, .seeds = 1, .jobs = 1, .pipelines = {"yoon2021_both"}});
  for (const Claim& claim : nonempty(results.claims)) {
    // What the sessions took is known without truth.
    const bool is_of_sessions = claim.id.starts_with("C11");
    EXPECT_EQ(claim.holds_fraction.has_value(), is_of_sessions) << claim.id;
    EXPECT_EQ(claim.needs.empty(), is_of_sessions) << claim.id;
  }
}

TEST(StrippedTruth, AnOracleIsARowThatSaysWhatItNeeds) {
  const scenarios::Scenario scenario =
      scenarios::load_scenario("18cam_1host_pcie", {{"/timeline/frames", "30"}});
  const Results results = stripped(
      scenario, {.first_seed = 1, .seeds = 1, .jobs = 1, .pipelines = {"oracle_device_time"}});
  const Row& row = results.rows.front();
  ASSERT_EQ(row.notes.size(), 1);
  EXPECT_THAT(row.notes.front(), testing::StartsWith("repetition 1: device_time \"oracle\""));
  EXPECT_THAT(row.amd_ms.values, Each(IsNan()));
}

}  // namespace
}  // namespace simbench::evaluation
