#include "algorithms/host_sync/ntp/ntp_kernel_loop.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

namespace simbench {
namespace {

TEST(KernelLoop, EachSecondTakesAWholePart) {
  KernelLoop kernel;
  kernel.set_constant(4);
  kernel.update(-64e-3, 0);
  EXPECT_EQ(kernel.next_part_s(), -1e-3);
  EXPECT_EQ(kernel.next_second(), -1e-3);
  EXPECT_EQ(kernel.offset_s(), -63e-3);
  int seconds = 1;
  for (; kernel.next_second() != 0; ++seconds) ASSERT_LT(seconds, 10'000);
  EXPECT_NEAR(kernel.offset_s(), 0, 64.1e-9 / 4294967296.0) << "what the kernel cannot divide";
  EXPECT_NEAR(seconds, std::log(1e6 * 4294967296.0) * 63.5, 2);
}

TEST(KernelLoop, TheFllsFlagBeginsItAt256Seconds) {
  for (const auto& [mu_s, fll] : {std::pair{255.0, 0.0}, std::pair{256.0, 1e-3 / 4 / 256}}) {
    KernelLoop kernel;
    kernel.set_constant(10);
    const KernelLoop::Mode mode = kernel.update(1e-3, mu_s, true);
    EXPECT_EQ(mode, fll > 0 ? KernelLoop::Mode::kFll : KernelLoop::Mode::kPll);
    EXPECT_NEAR(kernel.frequency(), fll + 1e-3 * mu_s / (16384.0 * 16384), 1e-18) << mu_s;
  }
}

TEST(NtpKernelLoop, EachSecondTakesItsPartOfTheOffset) {
  for (const int constant : {0, 3, 6, 10}) {
    NtpKernelLoop kernel(0);
    kernel.update(10e-3, constant, 0);
    double left_s = 10e-3;
    for (int second = 0; second < 100; ++second) {
      EXPECT_NEAR(kernel.residual_s(second), left_s, 1e-14) << constant;
      left_s -= left_s / (4 << constant);
    }
  }
}

TEST(NtpKernelLoop, TheFrequencyFollowsThePll) {
  NtpKernelLoop kernel(0);
  kernel.update(1e-3, 6, 64);
  EXPECT_NEAR(kernel.frequency(), 1e-3 * 64 / (1024.0 * 1024), 1e-18);
  EXPECT_EQ(kernel.residual_s(64), 1e-3);
  kernel.update(-1e-3, 6, 128);
  EXPECT_NEAR(kernel.frequency(), 0, 1e-18);
}

TEST(NtpKernelLoop, TheIntervalCountsUpToEightPolls) {
  NtpKernelLoop kernel(0);
  kernel.update(1e-3, 6, 2000);
  EXPECT_NEAR(kernel.frequency(), 1e-3 * 512 / (1024.0 * 1024), 1e-18);
}

TEST(NtpKernelLoop, TheFllIsAddedAfterMoreThan2048Seconds) {
  const double loop_s = 16 * 1024;
  for (const auto& [mu_s, fll] : {std::pair{2048.0, 0.0}, std::pair{2049.0, 1e-3 / 4 / 2049}}) {
    NtpKernelLoop kernel(100);
    kernel.update(1e-3, 10, 100 + mu_s);
    EXPECT_NEAR(kernel.frequency(), fll + 1e-3 * mu_s / (loop_s * loop_s), 1e-18) << mu_s;
  }
}

TEST(NtpKernelLoop, WholeSecondsCount) {
  NtpKernelLoop kernel(0.9);
  kernel.update(1e-3, 6, 2.1);
  EXPECT_NEAR(kernel.frequency(), 1e-3 * 2 / (1024.0 * 1024), 1e-18);
}

TEST(NtpKernelLoop, HasTheKernelsLimits) {
  NtpKernelLoop kernel(0);
  kernel.update(2, 12, 0);
  EXPECT_EQ(kernel.residual_s(0), 0.5);
  EXPECT_NEAR(kernel.time_constant_s(), 4095.5, 0.001);
  kernel.set_frequency(-1);
  EXPECT_EQ(kernel.frequency(), -500e-6);
  kernel.update(0.5, 0, 8);
  EXPECT_NEAR(kernel.frequency(), 500e-6, 1e-18);
}

// The loop in continuous time: with tau = 4 * 2^constant, offset x and lacking frequency f,
// x' = f - x/tau and f' = -x/(4 tau)^2, as for the daemon's loop with its longer tau.
TEST(NtpKernelLoop, AFrequencyErrorOvershootsByWhatThePolesSay) {
  const double tau = 255.5;
  const double lacking = 5e-6;
  const double p = (-1 + std::sqrt(0.75)) / (2 * tau);
  const double q = (-1 - std::sqrt(0.75)) / (2 * tau);
  NtpKernelLoop kernel(0);
  double offset = 0;
  for (int poll = 1; poll <= 1600; ++poll) {
    const double at_s = poll * 16;
    kernel.update(offset, 6, at_s);
    offset += (lacking - kernel.frequency()) * 16 - (offset - kernel.residual_s(at_s + 16));
    const double expected = lacking / (p - q) * (std::exp(p * at_s) - std::exp(q * at_s));
    EXPECT_NEAR(offset, expected, 0.08 * lacking * tau) << at_s;
  }
  EXPECT_NEAR(kernel.frequency(), lacking, 0.1 * lacking);
}

}  // namespace
}  // namespace simbench
