// The operating system's clock as a node's clock, over a made-up kernel. No test sets a real clock.
#include "hardware/clock/os_clock.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cerrno>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/hardware/await.h"
#include "tests/hardware/clock/fake_kernel.h"

namespace simbench::hardware {
namespace {

using std::chrono::seconds;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class OsClockTest : public testing::Test {
 protected:
  std::unique_ptr<NodeClock> make(Nanoseconds max_step = seconds(1), bool dry_run = false) {
    auto clock = make_os_clock(context, kernel,
                               {.host = 4, .max_step = max_step, .dry_run = dry_run, .log = log});
    clock->observe([this](const ClockAdjustment& adjustment) { notices.push_back(adjustment); });
    return clock;
  }
  void run(Task<void> task) { await(context, std::move(task)); }
  std::string error_of(Task<void> task) {
    try {
      run(std::move(task));
    } catch (const ClockError& error) {
      return error.what();
    }
    return "";
  }
  double kernel_ppm() const {
    return static_cast<double>(kernel.frequency) / FakeKernel::kUnitsPerPpm;
  }
  // What the node's clock says now, against what the kernel's clock and the oscillator say.
  Nanoseconds system_error(const NodeClock& clock) const {
    return clock.system_at(kernel.monotonic_now_reads()) - kernel.system_now_reads();
  }

  boost::asio::io_context context{1};
  FakeKernel kernel;
  std::vector<std::string> lines;
  std::vector<ClockAdjustment> notices;
  std::function<void(const std::string&)> log = [this](const std::string& line) {
    lines.push_back(line);
  };
};

TEST_F(OsClockTest, ReadsTheSystemClockAndChangesNothingByItself) {
  kernel.frequency = 1'000'000;
  const auto clock = make();
  kernel.advance(seconds(10));
  EXPECT_LE(std::abs(system_error(*clock).count()), 30);
  EXPECT_EQ(kernel.frequency, 1'000'000);
  EXPECT_EQ(clock->present(kernel.monotonic_now_reads()).rate_ppb, 0);
  EXPECT_EQ(clock->present(kernel.monotonic_now_reads()).host, 4u);
  clock->restart();
  EXPECT_THAT(lines, IsEmpty());
  EXPECT_THAT(notices, IsEmpty());
}

TEST_F(OsClockTest, StepsWithinItsLimit) {
  const auto clock = make();
  const HostTime before = kernel.system_now_reads();
  run(clock->set(before + from_ms(250)));
  EXPECT_NEAR(to_ms(kernel.system_now_reads() - before), 250, 0.01);
  EXPECT_LE(std::abs(system_error(*clock).count()), 30);
  ASSERT_EQ(notices.size(), 1u);
  EXPECT_NEAR(to_ms(notices[0].after - notices[0].before), 250, 0.01);
  EXPECT_EQ(notices[0].host, 4u);
  EXPECT_THAT(lines, ElementsAre(HasSubstr("system clock: stepped by +0.25")));
}

TEST_F(OsClockTest, RefusesAStepBeyondItsLimit) {
  const auto clock = make();
  const Nanoseconds ahead = kernel.ahead;
  EXPECT_THAT(
      error_of(clock->set(kernel.system_now_reads() - seconds(12))),
      testing::MatchesRegex("system clock: found a step of -12\\.00000[01] s, allowed at most "
                            "1\\.000000 s \\(--max-step-ms\\); set the clock roughly "
                            "by hand, or allow more"));
  EXPECT_THAT(error_of(clock->set(HostTime::max())), HasSubstr("found a step of +"));
  EXPECT_THAT(error_of(clock->set(HostTime::min())), HasSubstr("found a step of -"));
  EXPECT_EQ(kernel.ahead, ahead);
  EXPECT_THAT(notices, IsEmpty());
}

TEST_F(OsClockTest, ThePastIsReadUnderThePast) {
  const auto clock = make();
  kernel.advance(seconds(1));
  const MonotonicTime stamp = kernel.monotonic_now_reads();
  const HostTime then = kernel.system_now_reads();
  run(clock->set(then + from_ms(500)));
  EXPECT_LE(std::abs((clock->system_at(stamp) - then).count()), 30);
}

TEST_F(OsClockTest, ARateIsTheKernelsFrequencyRelativeToWhatWasFound) {
  kernel.frequency = static_cast<long>(100 * FakeKernel::kUnitsPerPpm);
  const auto clock = make();
  run(clock->adjust_frequency(20'000));
  EXPECT_NEAR(kernel_ppm(), 120.002, 1e-4);  // 20 ppm of 1.0001
  ASSERT_EQ(notices.size(), 1u);
  EXPECT_NEAR(notices[0].rate_ppb, 20'000, 0.02);
  EXPECT_EQ(notices[0].before, notices[0].after);
}

TEST_F(OsClockTest, TheSteadyClockIsTheOscillatorWhateverTheKernelsFrequency) {
  kernel.frequency = static_cast<long>(-30 * FakeKernel::kUnitsPerPpm);
  const auto clock = make();
  const long double original = 1 - 30e-6L;
  const SteadyTime begin = clock->steady_at(kernel.monotonic_now_reads());
  const long double raw_begin = kernel.raw_ns();
  for (const double ppb : {400'000.0, -400'000.0, 17.0, 0.0}) {
    run(clock->adjust_frequency(ppb));
    kernel.advance(seconds(100));
    const auto counted =
        static_cast<double>((clock->steady_at(kernel.monotonic_now_reads()) - begin).count());
    EXPECT_NEAR(counted, static_cast<double>((kernel.raw_ns() - raw_begin) * original), 10) << ppb;
  }
  EXPECT_LE(std::abs(system_error(*clock).count()), 30);
}

TEST_F(OsClockTest, WhatIsToldReproducesTheClockFromItsSteadyClock) {
  const auto clock = make();
  run(clock->adjust_frequency(123'456));
  kernel.advance(seconds(50));
  run(clock->set(kernel.system_now_reads() - from_ms(3)));
  kernel.advance(seconds(50));
  const MonotonicTime now = kernel.monotonic_now_reads();
  const ClockAdjustment last = notices.back();
  const double elapsed_ns = static_cast<double>((clock->steady_at(now) - last.at).count());
  const HostTime expected =
      last.after + Nanoseconds(std::llround(elapsed_ns * (1 + last.rate_ppb * 1e-9)));
  EXPECT_LE(std::abs((clock->system_at(now) - expected).count()), 3);
}

TEST_F(OsClockTest, RefusesARateBeyondTheKernels) {
  kernel.frequency = static_cast<long>(100 * FakeKernel::kUnitsPerPpm);
  const auto clock = make();
  EXPECT_EQ(error_of(clock->adjust_frequency(450'000)),
            "system clock: found a rate of +450.000 ppm, allowed -600.000 to +400.000 ppm: the "
            "kernel has 500 ppm in either direction, and was found at +100.000 ppm");
  EXPECT_THAT(error_of(clock->adjust_frequency(std::numeric_limits<double>::quiet_NaN())),
              HasSubstr("found a rate of"));
  EXPECT_EQ(error_of(clock->adjust_frequency(-450'000)), "");
  EXPECT_NEAR(kernel_ppm(), -350, 0.1);
  // What it says beforehand is taken in either direction.
  EXPECT_NEAR(clock->max_frequency_ppb(), 400'000, 100);
  EXPECT_EQ(error_of(clock->adjust_frequency(clock->max_frequency_ppb())), "");
  EXPECT_EQ(error_of(clock->adjust_frequency(-clock->max_frequency_ppb())), "");
}

TEST_F(OsClockTest, ASlewIsAFrequencyThatEndsByItself) {
  const auto clock = make();
  run(clock->adjust_frequency(1000));
  const auto offset_from_raw = [&] {
    return static_cast<double>(
        static_cast<long double>((kernel.system_now_reads() - HostTime{}).count() -
                                 1'700'000'000'000'000'000) -
        kernel.raw_ns());
  };
  const double before = offset_from_raw();
  run(clock->slew(Nanoseconds(-10'000), 400'000));  // 25 ms
  EXPECT_NEAR(kernel_ppm(), 1 - 400, 1e-3);
  kernel.advance(from_ms(25));
  run_until(context, [this] { return notices.size() == 3; });
  EXPECT_NEAR(kernel_ppm(), 1, 1e-3);
  // The offset, and 1 ppm of 25 ms.
  EXPECT_NEAR(offset_from_raw() - before, -10'000 + 25, 5);
  EXPECT_NEAR(notices[1].rate_ppb, -399'000, 0.02);
  EXPECT_NEAR(notices[2].rate_ppb, 1000, 0.02);
}

TEST_F(OsClockTest, ASlewTakesWhatTheKernelHasLeft) {
  const auto clock = make();
  run(clock->adjust_frequency(400'000));
  run(clock->slew(seconds(1), 1e6));
  EXPECT_NEAR(kernel_ppm(), 500, 1e-3);
  run(clock->slew(-seconds(1), 1e6));
  EXPECT_NEAR(kernel_ppm(), -500, 1e-3);
  run(clock->slew(Nanoseconds(0), 0));
  EXPECT_NEAR(kernel_ppm(), 400, 1e-3);
  run(clock->adjust_frequency(500'000));
  EXPECT_EQ(error_of(clock->slew(seconds(1), 1e6)),
            "system clock: found a slew of +1.000000 s at a rate of +500.000 ppm, which leaves "
            "nothing of the kernel's 500 ppm to slew with");
  EXPECT_THAT(error_of(clock->slew(seconds(1), 0)), HasSubstr("allowed a rate above 0"));
}

TEST_F(OsClockTest, AChangeOfRateLeavesASlewItsOffsetAndAStepEndsIt) {
  const auto clock = make();
  run(clock->slew(seconds(1), 100'000));
  run(clock->adjust_frequency(50'000));
  EXPECT_NEAR(kernel_ppm(), 150, 1e-3);
  run(clock->set(kernel.system_now_reads()));
  EXPECT_NEAR(kernel_ppm(), 50, 1e-3);
}

TEST_F(OsClockTest, ASlewEndsWithItsObserver) {
  const auto clock = make();
  run(clock->slew(seconds(1), 100'000));
  clock->observe(nullptr);
  EXPECT_EQ(kernel.frequency, 0);
}

TEST_F(OsClockTest, TheFrequencyFoundIsPutBack) {
  kernel.frequency = 777;
  {
    const auto clock = make();
    run(clock->adjust_frequency(5000));
    EXPECT_NE(kernel.frequency, 777);
  }
  EXPECT_EQ(kernel.frequency, 777);
}

TEST_F(OsClockTest, WithoutThePrivilegeItSaysHowToGetIt) {
  kernel.error = EPERM;
  try {
    make();
    ADD_FAILURE() << "not refused";
  } catch (const ClockError& error) {
    EXPECT_STREQ(error.what(),
                 "system clock: its rate cannot be set: not permitted; --set-system-clock needs "
                 "CAP_SYS_TIME: AmbientCapabilities=CAP_SYS_TIME in the systemd unit, or setcap "
                 "cap_sys_time+ep on the program");
  }
}

TEST_F(OsClockTest, AnErrorOfTheKernelIsToldAndChangesNothing) {
  const auto clock = make();
  kernel.error = EINVAL;
  EXPECT_EQ(error_of(clock->set(kernel.system_now_reads())),
            "system clock: cannot be set: Invalid argument");
  EXPECT_EQ(error_of(clock->adjust_frequency(5)),
            "system clock: its rate cannot be set: Invalid argument");
  EXPECT_THAT(notices, IsEmpty());
}

TEST_F(OsClockTest, WarnsOfAnotherKeeper) {
  kernel.status = STA_PLL;
  make();
  kernel.status = 0;
  make();
  kernel.status = STA_UNSYNC;
  make();
  EXPECT_THAT(lines, ElementsAre(HasSubstr("another program seems to keep it (the kernel's own "
                                           "control loop is on)"),
                                 HasSubstr("another program seems to keep it (it is marked as "
                                           "synchronised)")));
}

TEST_F(OsClockTest, NoticesWhatAnotherProgramDid) {
  const auto clock = make();
  kernel.ahead += from_ms(5);
  kernel.frequency = 4711;
  run(clock->adjust_frequency(10));
  run(clock->adjust_frequency(20));
  EXPECT_THAT(lines, ElementsAre(HasSubstr("another program has changed its rate"),
                                 HasSubstr("another program has stepped it by +0.005000 s")));
  ASSERT_EQ(notices.size(), 3u);
  EXPECT_NEAR(to_ms(notices[0].after - notices[0].before), 5, 1e-3);
  EXPECT_LE(std::abs(system_error(*clock).count()), 60);
}

TEST_F(OsClockTest, WhenIsTheInstantOfAReading) {
  const auto clock = make();
  run(clock->adjust_frequency(300'000));
  const MonotonicTime now = kernel.monotonic_now_reads();
  const HostTime reads = clock->system_at(now);
  EXPECT_EQ(clock->when(reads + from_ms(7), now), now + from_ms(7));
  EXPECT_EQ(clock->when(reads - from_ms(7), now), now);
  EXPECT_EQ(clock->when(HostTime::min(), now), now);
  EXPECT_GT(clock->when(HostTime::max(), now), now + std::chrono::hours(1));
}

TEST_F(OsClockTest, ADryRunSetsNothingAndSaysWhatItWould) {
  kernel.error = EPERM;
  const auto clock = make(seconds(1), true);
  const HostTime before = clock->system_at(monotonic_now());
  run(clock->set(before + from_ms(250)));
  run(clock->adjust_frequency(1500));
  run(clock->slew(from_ms(-2), 1e6));
  run(clock->slew(Nanoseconds(0), 0));
  clock->restart();
  EXPECT_EQ(kernel.setter_calls, 0);
  EXPECT_THAT(lines,
              ElementsAre(HasSubstr("dry run: would step the system clock by +0.2"),
                          "dry run: would run the system clock at +1.500 ppm",
                          "dry run: would slew the system clock by -0.002000 s at 501.500 ppm"));
  EXPECT_EQ(notices.size(), 4u);
  EXPECT_GE(clock->system_at(monotonic_now()), before + from_ms(240));
  EXPECT_THAT(error_of(clock->set(HostTime{})), HasSubstr("found a step of -"));
  EXPECT_THAT(error_of(clock->adjust_frequency(600'000)),
              HasSubstr("found a rate of +600.000 ppm"));
  EXPECT_EQ(notices.size(), 4u);
}

TEST(KernelClockCallsTest, ReadWhatTheSystemReads) {
  ClockCalls& calls = kernel_clock_calls();
  const HostTime before(std::chrono::system_clock::now().time_since_epoch());
  EXPECT_LT(calls.system() - before, std::chrono::hours(1));
  const MonotonicTime earlier = monotonic_now();
  EXPECT_LE(earlier, calls.monotonic());
  EXPECT_NO_THROW(read_kernel_clock(calls));
}

}  // namespace
}  // namespace simbench::hardware
