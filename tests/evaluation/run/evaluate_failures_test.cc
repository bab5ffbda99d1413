// Captures that could not be made: rows with holes and notes, never an evaluation that fails.
#include <gmock/gmock.h>

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "evaluation/run/evaluate.h"
#include "scenarios/loader.h"
#include "tests/evaluation/test_scenario.h"
#include "tests/nonempty.h"

namespace simbench::evaluation {
namespace {

using ::testing::DoubleEq;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::IsNan;

// Cannot capture "smooth" at seed 3, and has something to say about "arrival" at seed 2.
class FlakySource final : public RecordingSource {
 public:
  RecordingCost record(const RecordingRequest& request, RecordingSink& sink) override {
    calls.emplace_back(request.pipeline, request.seed);
    if (all_fail || (request.seed == 3 && request.pipeline == "smooth")) {
      throw RecordingFailed("host2 could not be reached");
    }
    RecordingCost cost = TestSource().record(request, sink);
    if (request.seed == 2 && request.pipeline == "arrival") cost.notes = {"camera 7 was unplugged"};
    return cost;
  }

  inline static std::vector<std::pair<std::string, std::uint64_t>> calls;
  bool all_fail = false;
};

Results evaluated(bool all_fail) {
  FlakySource::calls.clear();
  return evaluate(
      test_scenario(),
      [all_fail] {
        auto source = std::make_unique<FlakySource>();
        source->all_fail = all_fail;
        return source;
      },
      {.first_seed = 2, .seeds = 3, .jobs = 1}, nullptr);
}

class Wandering final : public RecordingSource {
 public:
  RecordingCost record(const RecordingRequest& request, RecordingSink& sink) override {
    RecordingCost cost = TestSource().record(request, sink);
    if (request.seed != 3) cost.notes = {"a clock wandered"};
    return cost;
  }
};

TEST(EvaluateFailures, ANoteOfManySeedsIsOneLine) {
  const Results results = evaluate(
      test_scenario(), [] { return std::make_unique<Wandering>(); },
      {.first_seed = 2, .seeds = 4, .jobs = 1}, nullptr);
  EXPECT_THAT(results.rows[0].notes, ElementsAre("repetition 2 and 2 more: a clock wandered"));
}

class TooLarge final : public RecordingSource {
 public:
  RecordingCost record(const RecordingRequest& /*request*/, RecordingSink& /*sink*/) override {
    throw scenarios::InputError("found a world that is too large");
  }
};

TEST(EvaluateFailures, AWorldThatItsBackendRefusesIsBadInput) {
  EXPECT_THAT(
      [] {
        evaluate(
            test_scenario(), [] { return std::make_unique<TooLarge>(); },
            {.first_seed = 2, .seeds = 3, .jobs = 1}, nullptr);
      },
      testing::ThrowsMessage<scenarios::InputError>(testing::AllOf(
          testing::HasSubstr(", pipeline arrival, seed 2: found a world that is too large"),
          testing::Not(testing::HasSubstr("commit")))));
}

TEST(EvaluateFailures, AFailedCaptureIsAHoleAndANote) {
  const Results results = evaluated(false);
  EXPECT_EQ(results.seed_count, 3);
  const Row& arrival = results.rows[0];
  EXPECT_THAT(arrival.amd_ms.values, ElementsAre(DoubleEq(2), DoubleEq(3), DoubleEq(4)));
  EXPECT_THAT(arrival.notes, ElementsAre("repetition 2: camera 7 was unplugged"));
  const Row& smooth = results.rows[1];
  EXPECT_THAT(smooth.notes, ElementsAre("repetition 3: host2 could not be reached"));
  ASSERT_EQ(smooth.amd_ms.values.size(), 3);
  EXPECT_THAT(smooth.amd_ms.values[1], IsNan());
  EXPECT_NEAR(smooth.amd_ms.median, 3.5, 1e-6);  // of 2.5 and 4.5
  EXPECT_THAT(smooth.seed_recall.values[1], IsNan());
  EXPECT_EQ(smooth.frames.expected, 80);
  EXPECT_EQ(smooth.ground_truth, GroundTruth::kSimulation);
  EXPECT_FALSE(smooth.seeds[1].recorded);
}

TEST(EvaluateFailures, TheSourceIsCalledInOrderAndGoesOn) {
  evaluated(false);
  using Call = std::pair<std::string, std::uint64_t>;
  EXPECT_THAT(FlakySource::calls,
              ElementsAre(Call("arrival", 2), Call("smooth", 2), Call("arrival", 3),
                          Call("smooth", 3), Call("arrival", 4), Call("smooth", 4)));
}

TEST(EvaluateFailures, ARowMayHaveNoCaptureAtAll) {
  const Results results = evaluated(true);
  for (const Row& row : nonempty(results.rows)) {
    EXPECT_EQ(row.notes.size(), 3);
    EXPECT_THAT(row.amd_ms.values, Each(IsNan()));
    EXPECT_TRUE(std::isnan(row.amd_ms.median));
    EXPECT_TRUE(std::isnan(row.precision));
    EXPECT_EQ(row.evaluated_pulses, 0);
    EXPECT_FALSE(row.verified());
  }
  for (const Claim& claim : results.claims) EXPECT_FALSE(claim.holds_fraction) << claim.id;
}

TEST(EvaluateFailures, AnyOtherErrorStillEndsIt) {
  class Broken final : public RecordingSource {
   public:
    RecordingCost record(const RecordingRequest&, RecordingSink&) override {
      throw std::runtime_error("a defect");
    }
  };
  EXPECT_THROW(
      evaluate(
          test_scenario(), [] { return std::make_unique<Broken>(); }, {.seeds = 1}, nullptr),
      EvaluationFailed);
}

}  // namespace
}  // namespace simbench::evaluation
