#include "evaluation/stability/masks.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "scenarios/loader.h"
#include "tests/nonempty.h"

namespace simbench::evaluation {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

// In nanoseconds.
double limit_ns(const std::string& mask, std::size_t limit, double tau_s = 0) {
  return 1e6 * limit_at(mask_named(mask).limits.at(limit), tau_s);
}

TEST(Masks, HaveTheFiguresOfTheRecommendations) {
  // G.8272: max|TE|, MTIE, TDEV.
  EXPECT_NEAR(limit_ns("prtc_a", 0), 100, 1e-9);
  EXPECT_NEAR(limit_ns("prtc_a", 1, 0.1), 25.0275, 1e-9);
  EXPECT_NEAR(limit_ns("prtc_a", 1, 100), 52.5, 1e-9);
  EXPECT_NEAR(limit_ns("prtc_a", 1, 274), 100, 1e-9);
  EXPECT_NEAR(limit_ns("prtc_a", 2, 50), 3, 1e-9);
  EXPECT_NEAR(limit_ns("prtc_a", 2, 500), 15, 1e-9);
  EXPECT_NEAR(limit_ns("prtc_a", 2, 5000), 30, 1e-9);
  EXPECT_NEAR(limit_ns("prtc_b", 0), 40, 1e-9);
  EXPECT_NEAR(limit_ns("prtc_b", 1, 40), 36, 1e-9);
  EXPECT_NEAR(limit_ns("prtc_b", 1, 60), 40, 1e-9);
  EXPECT_NEAR(limit_ns("prtc_b", 2, 300), 3, 1e-9);
  EXPECT_NEAR(limit_ns("prtc_b", 2, 1000), 5, 1e-9);
  // G.8273.2: max|TE|, cTE, dTE_L MTIE and TDEV, dTE_H.
  const std::vector<std::pair<std::string, std::vector<double>>> classes = {
      {"class_a", {100, 50, 40, 4, 70}},
      {"class_b", {70, 20, 40, 4, 70}},
      {"class_c", {30, 10, 10, 2, 30}},
      {"class_d", {5}}};
  for (const auto& [mask, ns] : classes) {
    ASSERT_EQ(mask_named(mask).limits.size(), ns.size());
    for (std::size_t i = 0; i < ns.size(); ++i)
      EXPECT_NEAR(limit_ns(mask, i, 100), ns[i], 1e-9) << mask;
  }
  // G.813 option 1: MTIE, TDEV.
  EXPECT_NEAR(limit_ns("sec", 0, 0.5), 40, 1e-9);
  EXPECT_NEAR(limit_ns("sec", 0, 10), 40 * std::pow(10, 0.1), 1e-9);
  EXPECT_NEAR(limit_ns("sec", 0, 1000), 25.25 * std::pow(1000, 0.2), 1e-9);
  EXPECT_NEAR(limit_ns("sec", 1, 25), 3.2, 1e-9);
  EXPECT_NEAR(limit_ns("sec", 1, 49), 0.64 * 7, 1e-9);
  EXPECT_NEAR(limit_ns("sec", 1, 1000), 6.4, 1e-9);
}

TEST(Masks, AreContinuousOverTau) {
  for (const ClockMask& mask : masks()) {
    for (const MaskLimit& limit : nonempty(mask.limits)) {
      EXPECT_EQ(facts_of(limit.quantity).has_tau(), limit.segments.back().to_s > 0) << mask.id;
      for (std::size_t i = 0; i + 1 < limit.segments.size(); ++i) {
        const double bend_s = limit.segments[i].to_s;
        EXPECT_EQ(limit.segments[i + 1].from_s, bend_s);
        const double before = limit_at(limit, bend_s);
        EXPECT_NEAR(limit_at(limit, bend_s * (1 + 1e-12)), before, 0.002 * before)
            << mask.id << " " << limit.label << " at " << bend_s;
      }
    }
  }
}

TEST(Masks, OfAnotherNameAreRefused) {
  try {
    mask_named("prtc");
    FAIL();
  } catch (const scenarios::InputError& error) {
    EXPECT_THAT(error.what(), AllOf(StartsWith("--mask: found 'prtc', allowed: prtc_a, prtc_b"),
                                    HasSubstr("class_d, sec")));
  }
}

TEST(LimitsMask, ReadsEveryQuantity) {
  const ClockMask mask = limits_mask(
      {"max_te=100ns", "cte=0.05us", "te_p2p=2ms", "p50=1s", "p95=1ns", "p99=200ns", "p99.9=1us",
       "adev@1s=1e-9", "mdev@0.5s=2e-9", "hdev@100ms=3", "tdev@10s=5ns", "mtie@1000s=50ns"});
  std::vector<std::string> ids;
  std::vector<double> values;
  std::vector<double> taus_s;
  for (const MaskLimit& limit : mask.limits) {
    ids.emplace_back(facts_of(limit.quantity).id);
    values.push_back(limit.segments.at(0).base);
    taus_s.push_back(limit.segments.at(0).from_s);
    EXPECT_EQ(limit.segments[0].to_s, limit.segments[0].from_s);
  }
  EXPECT_THAT(
      ids, ElementsAre("max_te_ms", "constant_te_ms", "dynamic_te_p2p_ms", "p50_te_ms", "p95_te_ms",
                       "p99_te_ms", "p99_9_te_ms", "adev", "mdev", "hdev", "tdev_ms", "mtie_ms"));
  const std::vector<double> expected = {1e-4, 5e-5, 2,    1e3, 1e-6, 2e-4,
                                        1e-3, 1e-9, 2e-9, 3,   5e-6, 5e-5};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_NEAR(values[i], expected[i], 1e-12 * expected[i]) << ids[i];
  }
  EXPECT_THAT(taus_s, ElementsAre(0, 0, 0, 0, 0, 0, 0, 1, 0.5, 0.1, 10, 1000));
}

std::string limit_problem(const std::string& limit) {
  try {
    limits_mask({limit});
  } catch (const scenarios::InputError& error) {
    return error.what();
  }
  ADD_FAILURE() << "accepted: " << limit;
  return {};
}

TEST(LimitsMask, RefusesWhatIsNoLimit) {
  EXPECT_THAT(limit_problem("max=1ns"),
              AllOf(StartsWith("--limit max=1ns: name: found 'max', allowed: max_te, cte"),
                    HasSubstr("mtie@TAU")));
  EXPECT_THAT(limit_problem("max_te"), HasSubstr("limit: found 'max_te', allowed: max_te=VALUE"));
  EXPECT_THAT(limit_problem("mtie=5ns"),
              HasSubstr("found 'mtie', allowed: mtie@TAU, as in mtie@10s"));
  EXPECT_THAT(limit_problem("max_te@1s=5ns"), HasSubstr("found 'max_te@1s', allowed: max_te"));
  for (const char* value : {"5", "ns", "-5ns", "0ns", "nanns", "infs", "5 ns", "1e300s", ""}) {
    EXPECT_THAT(limit_problem(std::string("max_te=") + value),
                HasSubstr("allowed: a time above 0 with its unit (s, ms, us, ns), as in 100ns"))
        << value;
  }
  EXPECT_THAT(limit_problem("tdev@x=5ns"), HasSubstr("tau: found 'x', allowed: a time above 0"));
  for (const char* value : {"5ns", "0", "-1", "nan", "inf"}) {
    EXPECT_THAT(limit_problem(std::string("adev@1s=") + value),
                HasSubstr("allowed: a number above 0, as in 1e-9"))
        << value;
  }
}

}  // namespace
}  // namespace simbench::evaluation
