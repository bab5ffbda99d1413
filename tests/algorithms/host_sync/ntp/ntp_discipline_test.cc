#include "algorithms/host_sync/ntp/ntp_discipline.h"

#include <gtest/gtest.h>

#include <boost/random/mersenne_twister.hpp>
#include <boost/random/uniform_01.hpp>
#include <cmath>

namespace simbench {
namespace {

// ntpd's own loop; that of the kernel has a test of its own, and a section below.
NtpDisciplineSettings daemon() {
  NtpDisciplineSettings settings;
  settings.loop = NtpLoop::kDaemon;
  return settings;
}

NtpDisciplineSettings fixed_poll(int poll) {
  NtpDisciplineSettings settings = daemon();
  settings.poll_min = poll;
  settings.poll_max = poll;
  return settings;
}

// In SYNC, with no offset and no frequency, at time 0; the start-up clamp is over.
NtpDiscipline locked(NtpDisciplineSettings settings) {
  settings.frequency = 0;
  NtpDiscipline discipline(settings);
  EXPECT_EQ(discipline.update(0, -settings.step_out_s), NtpAction::kAdjust);
  EXPECT_EQ(discipline.update(0, 0), NtpAction::kAdjust);
  EXPECT_EQ(discipline.state(), NtpState::kSync);
  return discipline;
}

TEST(NtpDiscipline, ALargeFirstOffsetStepsAndThenTheFrequencyIsMeasured) {
  NtpDiscipline discipline(daemon());
  EXPECT_EQ(discipline.update(0.3, 10), NtpAction::kStep);
  EXPECT_EQ(discipline.state(), NtpState::kFreq);
  EXPECT_EQ(discipline.residual_s(10), 0);
  EXPECT_EQ(discipline.update(20e-6 * 64, 74), NtpAction::kIgnore);
  EXPECT_EQ(discipline.update(20e-6 * 299, 309), NtpAction::kIgnore);
  EXPECT_EQ(discipline.update(20e-6 * 320, 330), NtpAction::kAdjust);
  EXPECT_EQ(discipline.state(), NtpState::kSync);
  EXPECT_NEAR(discipline.frequency(), 20e-6, 1e-15);
  EXPECT_NEAR(discipline.residual_s(330), 20e-6 * 320, 1e-15);
}

TEST(NtpDiscipline, ASmallFirstOffsetIsSlewedAndThenTheFrequencyIsMeasured) {
  NtpDiscipline discipline(daemon());
  EXPECT_EQ(discipline.update(0.05, 0), NtpAction::kSlew);
  EXPECT_EQ(discipline.state(), NtpState::kFreq);
  EXPECT_EQ(discipline.phase_rate(100), 0);
  EXPECT_EQ(discipline.update(-30e-6 * 400, 400), NtpAction::kAdjust);
  EXPECT_NEAR(discipline.frequency(), -30e-6, 1e-15);
}

TEST(NtpDiscipline, TheStartUpClampRemovesTheTransientAndNothingElse) {
  NtpDiscipline discipline(daemon());
  discipline.update(0.3, 0);
  discipline.update(10e-6 * 300, 300);  // 10 ppm, and 3 ms of phase
  EXPECT_NEAR(discipline.residual_s(332), 3e-3 * std::exp(-1), 1e-15);
  EXPECT_NEAR(discipline.phase_rate(300) * 64, 3e-3 * (1 - std::exp(-2)), 1e-15);
  for (double at_s = 364; at_s < 600; at_s += 64) discipline.update(0.6e-3, at_s);
  EXPECT_EQ(discipline.frequency(), 10e-6) << "untouched";
  EXPECT_EQ(discipline.poll(), 6);
  discipline.update(1e-3, 600);
  EXPECT_GT(discipline.frequency(), 10e-6) << "over";
  EXPECT_NEAR(discipline.residual_s(600 + 1024), 1e-3 * std::exp(-1), 1e-15);
}

TEST(NtpDiscipline, AnOffsetBelowTheFloorEndsTheClamp) {
  NtpDiscipline discipline(daemon());
  discipline.update(0.3, 0);
  discipline.update(10e-6 * 300, 300);
  EXPECT_TRUE(discipline.is_starting(363));
  discipline.update(0.4e-3, 364);
  EXPECT_FALSE(discipline.is_starting(364));
  EXPECT_EQ(discipline.frequency(), 10e-6) << "this update still leaves the frequency alone";
  EXPECT_NEAR(discipline.residual_s(364 + 1024), 0.4e-3 * std::exp(-1), 1e-15);
}

TEST(NtpDiscipline, TheSlewIsNeverAbove500Ppm) {
  NtpDisciplineSettings settings = daemon();
  settings.frequency = -100e-6;
  NtpDiscipline discipline(settings);
  discipline.update(0.12, 0);
  EXPECT_NEAR(discipline.phase_rate(0), 400e-6, 1e-15);
}

TEST(NtpDiscipline, StartsLockedWithAKnownFrequency) {
  NtpDisciplineSettings settings = daemon();
  settings.frequency = 12e-6;
  NtpDiscipline discipline(settings);
  EXPECT_EQ(discipline.update(1e-3, 0), NtpAction::kAdjust);
  EXPECT_EQ(discipline.frequency(), 12e-6);
  NtpDiscipline stepping(settings);
  EXPECT_EQ(stepping.update(1, 0), NtpAction::kStep);
  EXPECT_EQ(stepping.state(), NtpState::kSync);
}

TEST(NtpDiscipline, TheResidualDecaysWithSixteenPollIntervals) {
  NtpDiscipline discipline = locked(fixed_poll(6));
  discipline.update(10e-3, 64);
  EXPECT_NEAR(discipline.residual_s(64 + 1024), 10e-3 * std::exp(-1), 1e-15);
  // The rate of an interval removes just what decays in it.
  EXPECT_NEAR(discipline.phase_rate(64) * 64, 10e-3 - discipline.residual_s(128), 1e-15);
}

// The loop in continuous time: with tau = 16 * 2^poll, offset x and lacking frequency f,
// x' = f - x/tau and f' = -x/(4 tau)^2. Its poles are (-1 +- sqrt(3)/2) / (2 tau).
struct LoopResponse {
  double offset;
  double frequency;
};
LoopResponse loop_response(double x0, double f0, double t, double tau) {
  const double p = (-1 + std::sqrt(0.75)) / (2 * tau);
  const double q = (-1 - std::sqrt(0.75)) / (2 * tau);
  const double x0_slope = f0 - x0 / tau;
  const double a = (x0_slope - q * x0) / (p - q);
  const double b = x0 - a;
  const double x = a * std::exp(p * t) + b * std::exp(q * t);
  const double slope = a * p * std::exp(p * t) + b * q * std::exp(q * t);
  return {x, slope + x / tau};
}

TEST(NtpDiscipline, TheLoopAnswersAStepAsItsPolesSay) {
  const double tau = 1024;
  for (const auto& [x0, f0] : {std::pair{10e-3, 0.0}, std::pair{0.0, 5e-6}}) {
    NtpDiscipline discipline = locked(fixed_poll(6));
    double offset = x0;
    for (int poll = 1; poll <= 1600; ++poll) {
      const double at_s = poll * 64;
      discipline.update(offset, at_s);
      const double removed = discipline.phase_rate(at_s) * 64;
      offset += (f0 - discipline.frequency()) * 64 - removed;
      const LoopResponse expected = loop_response(x0, f0, at_s, tau);
      // The discrete loop lags by up to one interval of the 16 in tau.
      EXPECT_NEAR(offset, expected.offset, 0.06 * (x0 + f0 * tau)) << at_s;
      EXPECT_NEAR(f0 - discipline.frequency(), expected.frequency, 0.06 * (x0 / tau + f0)) << at_s;
    }
    EXPECT_NEAR(discipline.frequency(), f0, 0.05 * (x0 / tau + f0));
  }
}

TEST(NtpDiscipline, TheFllTakesOverAtLongPolls) {
  const double offset = 4e-3;
  NtpDiscipline fll = locked(fixed_poll(12));
  fll.update(offset, 4096);
  const double loop = 4 * 16 * 4096.0;
  EXPECT_NEAR(fll.frequency(), offset * 0.25 / 4096 + offset * 2048 / (loop * loop), 1e-18);
  NtpDiscipline pll = locked(fixed_poll(10));
  pll.update(offset, 1024);
  EXPECT_NEAR(pll.frequency(), offset * 1024 / (64 * 1024.0 * 64 * 1024.0), 1e-18);
}

TEST(NtpDiscipline, ALargeOffsetIsASpikeUntilTheStepOut) {
  NtpDiscipline discipline = locked(daemon());
  EXPECT_EQ(discipline.update(0.2, 64), NtpAction::kIgnore);
  EXPECT_EQ(discipline.state(), NtpState::kSpik);
  EXPECT_EQ(discipline.update(1e-3, 128), NtpAction::kAdjust);
  EXPECT_EQ(discipline.state(), NtpState::kSync);
  EXPECT_EQ(discipline.update(0.2, 192), NtpAction::kIgnore);
  EXPECT_EQ(discipline.update(0.2, 427), NtpAction::kIgnore);
  EXPECT_EQ(discipline.update(0.2, 428), NtpAction::kStep) << "300 s after the last good one";
  EXPECT_EQ(discipline.state(), NtpState::kSync);
  EXPECT_EQ(discipline.poll(), 6);
}

TEST(NtpDiscipline, StepAndPanicLimits) {
  NtpDisciplineSettings settings = daemon();
  NtpDiscipline at_limit = locked(settings);
  EXPECT_EQ(at_limit.update(0.128, 64), NtpAction::kAdjust);
  EXPECT_EQ(NtpDiscipline(settings).update(1000, 0), NtpAction::kStep);
  EXPECT_EQ(NtpDiscipline(settings).update(-1000.1, 0), NtpAction::kPanic);
  settings.panic_s = 0;
  EXPECT_EQ(NtpDiscipline(settings).update(1e6, 0), NtpAction::kStep);
  settings.step_s = 0;
  NtpDiscipline never = locked(settings);
  EXPECT_EQ(never.update(-5, 64), NtpAction::kAdjust);
}

TEST(NtpDiscipline, ThePollGrowsWhileOffsetsAreWithinTheJitter) {
  NtpDiscipline discipline = locked(daemon());
  int updates = 0;
  double at_s = 0;
  while (discipline.poll() == 6) {
    at_s += 64;
    discipline.update(updates % 2 == 0 ? 50e-6 : -50e-6, at_s);
    ASSERT_LT(++updates, 100);
  }
  // 6 a time beyond 30, the first two of them when it was locked.
  EXPECT_EQ(updates, 4);
  for (int i = 0; i < 100; ++i) {
    at_s += discipline.poll_interval_s();
    discipline.update(i % 2 == 0 ? 50e-6 : -50e-6, at_s);
  }
  EXPECT_EQ(discipline.poll(), 10);
}

TEST(NtpDiscipline, ThePollShrinksWhenOffsetsStayAboveTheJitter) {
  NtpDiscipline discipline = locked(daemon());
  double at_s = 0;
  for (int i = 0; i < 100; ++i) {
    at_s += discipline.poll_interval_s();
    discipline.update(i % 2 == 0 ? 50e-6 : -50e-6, at_s);
  }
  ASSERT_EQ(discipline.poll(), 10);
  int updates = 0;
  while (discipline.poll() > 6 && updates < 100) {
    at_s += discipline.poll_interval_s();
    discipline.update(5e-3 + 1e-9 * updates, at_s);
    ++updates;
  }
  EXPECT_EQ(discipline.poll(), 6);
}

TEST(NtpDiscipline, TheFrequencyIsCapped) {
  NtpDiscipline discipline(daemon());
  discipline.update(0, 0);
  discipline.update(0.12, 300);  // 400 ppm
  EXPECT_NEAR(discipline.frequency(), 400e-6, 1e-12);
  NtpDiscipline fast(daemon());
  fast.update(0, 0);
  fast.update(0.27, 300);  // 900 ppm, and a step
  EXPECT_EQ(fast.frequency(), NtpDiscipline::kMaxFrequency);
}

TEST(NtpDiscipline, TheKernelIsToldWhatTheDaemonMeasuresAndThenDecides) {
  NtpDiscipline discipline({});
  discipline.update(0.3, 0);
  discipline.update(10e-6 * 300, 300);
  EXPECT_NEAR(discipline.frequency(), 10e-6, 1e-15);
  EXPECT_NEAR(discipline.residual_s(332), 3e-3 * std::exp(-1), 1e-15) << "the daemon's clamp";
  discipline.update(0.4e-3, 364);
  NtpKernelLoop kernel(0);
  kernel.set_frequency(10e-6);
  kernel.update(0.4e-3, 6, 364);
  EXPECT_EQ(discipline.frequency(), kernel.frequency());
  EXPECT_EQ(discipline.residual_s(500), kernel.residual_s(500));
  EXPECT_NEAR(discipline.phase_rate(364) * 64, 0.4e-3 - kernel.residual_s(364 + 64), 1e-15);
  // A spike is the daemon's affair: the kernel goes on.
  EXPECT_EQ(discipline.update(0.2, 428), NtpAction::kIgnore);
  EXPECT_EQ(discipline.residual_s(428), kernel.residual_s(428));
  EXPECT_EQ(discipline.update(0.2, 700), NtpAction::kStep);
  EXPECT_EQ(discipline.residual_s(700), 0);
  EXPECT_EQ(discipline.frequency(), kernel.frequency());
}

TEST(NtpDiscipline, AClampThatRunsOutLeavesTheKernelWithoutAnOffset) {
  NtpDiscipline discipline({});
  discipline.update(0.3, 0);
  discipline.update(100e-3, 300);
  EXPECT_GT(discipline.phase_rate(590), 0);
  EXPECT_EQ(discipline.phase_rate(600), 0);
  discipline.update(1e-3, 660);
  EXPECT_NEAR(discipline.residual_s(660), 1e-3, 1e-15);
}

TEST(NtpDiscipline, ALimitForStepsThatIsTooHighForTheKernelLeavesTheDaemonsLoop) {
  for (const auto& [step_s, tau_s] :
       {std::pair{0.5, 255.5}, std::pair{0.0, 1024.0}, std::pair{0.6, 1024.0}}) {
    NtpDisciplineSettings settings = fixed_poll(6);
    settings.loop = NtpLoop::kKernel;
    settings.step_s = step_s;
    NtpDiscipline discipline = locked(settings);
    discipline.update(1e-3, 64);
    EXPECT_NEAR(discipline.time_constant_s(), tau_s, 0.001) << step_s;
  }
}

TEST(NtpDiscipline, IsFiniteForAnyOffsets) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    boost::random::mt19937 engine(seed);
    boost::random::uniform_01<double> uniform;
    NtpDisciplineSettings settings;
    settings.loop = seed % 2 == 0 ? NtpLoop::kKernel : NtpLoop::kDaemon;
    settings.poll_max = 17;
    NtpDiscipline discipline(settings);
    double at_s = 0;
    for (int i = 0; i < 1000; ++i) {
      at_s += uniform(engine) < 0.1 ? 0 : std::exp(20 * uniform(engine) - 10);
      discipline.update((uniform(engine) - 0.5) * std::exp(30 * uniform(engine) - 20), at_s);
      ASSERT_TRUE(std::isfinite(discipline.phase_rate(at_s + 1))) << "seed " << seed;
      ASSERT_LE(std::abs(discipline.frequency()), NtpDiscipline::kMaxFrequency) << "seed " << seed;
      ASSERT_GE(discipline.poll(), 6) << "seed " << seed;
      ASSERT_LE(discipline.poll(), 17) << "seed " << seed;
    }
  }
}

}  // namespace
}  // namespace simbench
