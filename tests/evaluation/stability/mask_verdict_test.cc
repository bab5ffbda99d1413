#include "evaluation/stability/mask_verdict.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <vector>

#include "tests/evaluation/stability/noises.h"
#include "tests/nonempty.h"

namespace simbench::evaluation {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kNanosecond = 1e-9;

// A sine of this amplitude and period, sampled so often.
TimeErrorSeries sine(double amplitude_ns, double period_s, std::size_t points, double interval_s) {
  std::vector<double> x;
  for (std::size_t i = 0; i < points; ++i) {
    const double t = static_cast<double>(i) * interval_s;
    x.push_back(amplitude_ns * kNanosecond * std::sin(2 * std::numbers::pi * t / period_s));
  }
  return series_of(std::move(x), interval_s);
}

TimeErrorSeries constant(double ns, std::size_t points, double interval_s) {
  return series_of(std::vector<double>(points, ns * kNanosecond), interval_s);
}

MaskVerdict judged(const TimeErrorSeries& series, const std::string& mask) {
  return judge(stability_of(series), mask_named(mask));
}

LimitVerdict judged_limit(const TimeErrorSeries& series, const std::string& limit) {
  return judge(stability_of(series), limits_mask({limit})).limits.at(0);
}

TEST(JudgedMask, ALongQuietSeriesPasses) {
  // 0.1 s apart over 12 times the longest tau of TDEV.
  const MaskVerdict verdict = judged(constant(30, 120'000, 0.1), "sec");
  EXPECT_EQ(verdict.judgement, Judgement::kPasses);
  EXPECT_EQ(verdict.mask, "sec");
  EXPECT_EQ(verdict.title, "ITU-T G.813 option 1");
  for (const LimitVerdict& limit : nonempty(verdict.limits)) {
    EXPECT_EQ(limit.judgement, Judgement::kPasses) << limit.limit.label;
    EXPECT_EQ(limit.value, 0);
    EXPECT_THAT(limit.reason, IsEmpty());
  }
  EXPECT_EQ(judged(constant(30, 90'000, 0.1), "sec").judgement, Judgement::kCannotTell);
}

TEST(JudgedMask, FailsAtTheFirstTauBeyondIt) {
  // The wander of a slow sine, 30 ns either way: its MTIE reaches 36 ns beyond the mask's 25 +
  // 0.275 tau within a quarter of the period.
  const MaskVerdict verdict = judged(sine(30, 128, 20'000, 1), "prtc_a");
  EXPECT_EQ(verdict.judgement, Judgement::kFails);
  const LimitVerdict& mtie = verdict.limits.at(1);
  EXPECT_EQ(mtie.judgement, Judgement::kFails);
  EXPECT_EQ(*mtie.tau_s, 32) << "at 16 s it moves by 23 ns, at 32 s by 42";
  EXPECT_NEAR(*mtie.value, 2 * 30e-6 * std::sin(std::numbers::pi * 32 / 128), 1e-9);
  EXPECT_NEAR(mtie.allowed, (25 + 0.275 * 32) * 1e-6, 1e-12);
  EXPECT_EQ(verdict.limits.at(0).judgement, Judgement::kPasses);
}

TEST(JudgedMask, SaysFromWhereToWhereItCouldJudge) {
  const MaskVerdict verdict = judged(constant(5, 600, 1), "sec");
  EXPECT_EQ(verdict.judgement, Judgement::kCannotTell);
  EXPECT_EQ(verdict.limits[0].reason,
            "judged at tau 1 to 512 s, of tau 0.1 to 1000 s: points 1 s apart over 600 s");
  EXPECT_THAT(verdict.limits[1].reason, HasSubstr("judged at tau 1 to 32 s")) << "a twelfth";
  const MaskVerdict coarse = judged(constant(5, 600, 2000), "sec");
  EXPECT_THAT(coarse.limits[0].reason, HasSubstr("judged nowhere, of tau 0.1 to 1000 s"));
  EXPECT_EQ(judge(stability_of({}), mask_named("prtc_a")).judgement, Judgement::kCannotTell);
}

TEST(JudgedMask, FailingWinsOverNotTelling) {
  EXPECT_EQ(judged(constant(101, 10, 1), "prtc_a").judgement, Judgement::kFails);
  EXPECT_EQ(judged(constant(99, 10, 1), "prtc_a").judgement, Judgement::kCannotTell);
}

TEST(JudgedMask, BandsAreJudgedBehindTheirFilters) {
  // A fast sine, 30 ns either way: the low-pass leaves a fifth of it, the high-pass nearly all.
  const double hertz = 0.55;
  const TimeErrorSeries fast = sine(30, 1 / hertz, 60'000, 0.25);
  const double gain = 1 / std::hypot(1, std::tan(std::numbers::pi * 0.25 * hertz) /
                                            std::tan(std::numbers::pi * 0.25 * 0.1));
  const MaskVerdict wide = judged(fast, "class_b");
  const LimitVerdict& mtie = wide.limits.at(2);
  EXPECT_NEAR(*mtie.value, 2 * 30e-6 * gain, 1e-7);
  EXPECT_EQ(mtie.judgement, Judgement::kPasses);
  const LimitVerdict& high = wide.limits.at(4);
  EXPECT_NEAR(*high.value, 2 * 30e-6 * std::sqrt(1 - gain * gain), 1e-7);
  EXPECT_EQ(high.allowed, 70e-6);
  EXPECT_EQ(wide.judgement, Judgement::kPasses);
  const MaskVerdict tight = judged(fast, "class_c");
  EXPECT_EQ(tight.limits.at(0).judgement, Judgement::kPasses) << "max|TE|";
  EXPECT_EQ(tight.limits.at(4).judgement, Judgement::kFails) << "dTE_H";
}

TEST(JudgedMask, CoarsePointsHaveNoBands) {
  const MaskVerdict verdict = judged(constant(5, 100'000, 3), "class_a");
  EXPECT_EQ(verdict.limits.at(0).judgement, Judgement::kPasses);
  EXPECT_EQ(verdict.limits.at(4).judgement, Judgement::kCannotTell);
  EXPECT_THAT(verdict.limits.at(4).reason,
              HasSubstr("points 3 s apart cannot be filtered at 0.1 Hz"));
}

TEST(JudgedMask, AClassWantsAThousandSeconds) {
  EXPECT_EQ(judged(constant(4, 1000, 1), "class_d").judgement, Judgement::kPasses);
  const MaskVerdict brief = judged(constant(4, 999, 1), "class_d");
  EXPECT_EQ(brief.judgement, Judgement::kCannotTell);
  EXPECT_EQ(brief.limits[0].reason, "measured over 999 s, of 1000 s at least");
  EXPECT_EQ(judged(constant(6, 999, 1), "class_d").judgement, Judgement::kFails);
}

TEST(JudgedLimit, OfASizeIsExact) {
  const TimeErrorSeries series = series_of({100e-9, -50e-9, 0, 0}, 1);
  EXPECT_EQ(judged_limit(series, "max_te=100ns").judgement, Judgement::kPasses) << "equal";
  const LimitVerdict tight = judged_limit(series, "max_te=60ns");
  EXPECT_EQ(tight.judgement, Judgement::kFails);
  EXPECT_EQ(tight.share_within, 0.75);
  EXPECT_NEAR(*judged_limit(series, "te_p2p=1us").value, 150e-6, 1e-15);
  EXPECT_NEAR(*judged_limit(series, "cte=1us").value, 12.5e-6, 1e-15);
  EXPECT_NEAR(*judged_limit(series_of({-3e-9, -3e-9}, 1), "cte=1us").value, 3e-6, 1e-15)
      << "a magnitude";
  EXPECT_NEAR(*judged_limit(series, "p50=1us").value, 25e-6, 1e-15);
}

TEST(JudgedLimit, OfOneTauIsThereWhereverOctavesAre) {
  const TimeErrorSeries noise = series_of(white_noise(1, 2000, 1e-9), 1);
  const LimitVerdict tdev = judged_limit(noise, "tdev@10s=1ms");
  EXPECT_EQ(tdev.judgement, Judgement::kPasses);
  EXPECT_EQ(*tdev.tau_s, 10);
  EXPECT_DOUBLE_EQ(*tdev.value, 1e3 * deviation_at(noise, Deviation::kTdev, 10)->value);
  const LimitVerdict adev = judged_limit(noise, "adev@3s=1e-15");
  EXPECT_EQ(adev.judgement, Judgement::kFails);
  EXPECT_DOUBLE_EQ(*adev.value, deviation_at(noise, Deviation::kAdev, 3)->value);
  EXPECT_DOUBLE_EQ(adev.allowed, 1e-15);
  // An interval that is nearly whole.
  EXPECT_EQ(*judged_limit(constant(0, 100, 0.99), "mtie@2s=1ns").tau_s, 1.98);
}

TEST(JudgedLimit, OfATauThatTheSeriesHasNotCannotBeTold) {
  for (const char* limit : {"mtie@0.5s=1ns", "mtie@1.5s=1ns", "mtie@200s=1ns", "tdev@10s=1ns",
                            "mtie@1000000000000s=1ns"}) {
    const LimitVerdict verdict = judged_limit(constant(0, 100, 1), limit);
    EXPECT_EQ(verdict.judgement, Judgement::kCannotTell) << limit;
    EXPECT_FALSE(verdict.value);
    EXPECT_THAT(verdict.reason, HasSubstr("judged nowhere, of tau")) << limit;
  }
  EXPECT_EQ(judged_limit(constant(0, 120, 1), "tdev@10s=1ns").judgement, Judgement::kPasses);
}

}  // namespace
}  // namespace simbench::evaluation
