#include "sim/programs/kernel_clock.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <cmath>
#include <cstdint>
#include <utility>

#include "tests/sim/host/sim_world.h"

namespace simbench::sim {
namespace {

constexpr long kPpm = 65'536;
constexpr std::int64_t kEpochS = kEpochNs / kSecondNs;

// A host without errors, whose calls take no time; its clock reads the epoch at true zero.
class KernelClockTest : public testing::Test {
 protected:
  KernelClockTest() { world_.spawn(kernel_.run()); }

  KernelClock::Answer adjust(timex request) {
    KernelClock::Answer answer{.error = -1};
    world_.spawn(adjust_into(answer, request));
    world_.engine.run_until(world_.now() + Nanoseconds(1));
    return answer;
  }
  KernelClock::Answer read() { return adjust({}); }
  KernelClock::Answer set_status(int status) {
    timex request{};
    request.modes = ADJ_STATUS | ADJ_MAXERROR;
    request.status = status;
    return adjust(request);
  }
  KernelClock::Answer set_frequency(long frequency) {
    timex request{};
    request.modes = ADJ_FREQUENCY;
    request.freq = frequency;
    return adjust(request);
  }
  KernelClock::Answer set_offset(long offset_ns, long constant, int status = STA_PLL) {
    timex request{};
    request.modes = ADJ_OFFSET | ADJ_TIMECONST | ADJ_NANO | ADJ_STATUS;
    request.offset = offset_ns;
    request.constant = constant;
    request.status = status;
    return adjust(request);
  }
  KernelClock::Answer single_shot(long offset_us) {
    timex request{};
    request.modes = ADJ_OFFSET_SINGLESHOT;
    request.offset = offset_us;
    return adjust(request);
  }
  long single_shot_left_us() {
    timex request{};
    request.modes = ADJ_OFFSET_SS_READ;
    return adjust(request).now.offset;
  }
  void set_clock(std::int64_t second) {
    world_.spawn(kernel_.set(from_epoch_ns(second * kSecondNs)));
    world_.engine.run_until(world_.now() + Nanoseconds(1));
  }

  void run_until(double at_s) { world_.engine.run_until(TrueTime(from_ms(at_s * 1e3))); }
  double ahead_ns() { return world_.hosts.clock(0).ahead_ns(world_.now()); }
  std::int64_t second() {
    return floor_div(epoch_ns(world_.hosts.clock(0).read(world_.now())), kSecondNs);
  }

  SimWorld world_{ideal_hosts(1)};
  KernelClock kernel_{world_.host(0)};

 private:
  Task<void> adjust_into(KernelClock::Answer& answer, timex request) {
    answer = co_await kernel_.adjust(request);
  }
};

TEST_F(KernelClockTest, BeginsUnsynchronised) {
  const KernelClock::Answer at_first = read();
  EXPECT_EQ(at_first.error, 0);
  EXPECT_EQ(at_first.state, TIME_ERROR);
  EXPECT_EQ(at_first.now.status, STA_UNSYNC);
  EXPECT_EQ(at_first.now.maxerror, 16'000'000);
  EXPECT_EQ(at_first.now.constant, 2);
  EXPECT_EQ(at_first.now.tick, 10'000);
  EXPECT_EQ(at_first.now.tolerance, 500 * kPpm);
  EXPECT_EQ(at_first.now.time.tv_sec, kEpochS);
}

// Nothing until the next second begins; each second then adds its part evenly.
TEST_F(KernelClockTest, ThePhaseFollowsTheKernelsRecurrence) {
  run_until(0.25);
  set_offset(1'000'000, 3);
  double left_ns = 1e6;
  double added_ns = 0;
  run_until(0.75);
  EXPECT_EQ(ahead_ns(), 0);
  for (int second = 1; second <= 200; ++second) {
    const double part_ns = left_ns / 32;  // 1 / 2^(2 + 3)
    left_ns -= part_ns;
    run_until(second + 0.5);
    // The system clock's seconds, by which the kernel counts, begin earlier by what was added.
    EXPECT_NEAR(ahead_ns(), added_ns + part_ns / 2, 25) << second;
    added_ns += part_ns;
    EXPECT_NEAR(static_cast<double>(read().now.offset), left_ns, 1) << second;
  }
  EXPECT_NEAR(ahead_ns(), 1e6, 2000);
}

TEST_F(KernelClockTest, OffsetsOfMicrosecondsHaveConstantsOfFourMore) {
  timex request{};
  request.modes = ADJ_OFFSET | ADJ_TIMECONST | ADJ_STATUS;
  request.offset = -640;
  request.constant = 2;
  request.status = STA_PLL;
  const KernelClock::Answer answer = adjust(request);
  EXPECT_EQ(answer.now.constant, 6);
  EXPECT_EQ(answer.now.offset, -640);
  EXPECT_EQ(answer.state, TIME_OK);
  run_until(1.5);
  EXPECT_NEAR(ahead_ns(), -640e3 / 256 / 2, 1);
  EXPECT_EQ(read().now.offset, -637) << "rounded as the kernel does";
}

TEST_F(KernelClockTest, TheFrequencyFollowsThePll) {
  set_offset(0, 6);
  run_until(64);
  set_offset(1'000'000, 6);
  const double expected = 1e-3 * 64 / (1024.0 * 1024) * 1e6 * kPpm;
  EXPECT_EQ(read().now.freq, static_cast<long>(expected));
  EXPECT_EQ(read().now.status & STA_MODE, 0);
  run_until(64 + 5000);
  set_offset(-1'000'000, 6);
  EXPECT_NEAR(static_cast<double>(read().now.freq),
              expected - expected / 64 * 512 - 1e-3 / 4 / 5000 * 1e6 * kPpm, 1)
      << "8 * 2^6 s count, and the FLL";
  EXPECT_EQ(read().now.status & STA_MODE, STA_MODE);
}

TEST_F(KernelClockTest, TheFllBeginsWhereItsFlagSays) {
  const int fll = STA_PLL | STA_FLL;
  double frequency = 0;
  double at_s = 0;
  set_offset(0, 10, fll);
  for (const auto& [interval_s, status] :
       {std::pair{255, fll}, std::pair{256, fll}, std::pair{2048, STA_PLL + 0},
        std::pair{2049, STA_PLL + 0}}) {
    at_s += interval_s;
    run_until(at_s);
    set_offset(100'000, 10, status);
    const bool is_fll = interval_s == 256 || interval_s == 2049;
    const double loop_s = 16 * 1024;
    frequency += 100e-6 * interval_s / (loop_s * loop_s);
    if (is_fll) frequency += 100e-6 / 4 / interval_s;
    const timex now = read().now;
    EXPECT_NEAR(static_cast<double>(now.freq), frequency * 1e6 * kPpm, 1) << interval_s;
    EXPECT_EQ((now.status & STA_MODE) != 0, is_fll) << interval_s;
    EXPECT_EQ(now.status & STA_FLL, status & STA_FLL);
  }
}

TEST_F(KernelClockTest, AHeldFrequencyStays) {
  set_frequency(7 * kPpm);
  set_offset(0, 3);
  run_until(600);
  set_offset(100'000, 3, STA_PLL | STA_FREQHOLD);
  EXPECT_EQ(read().now.freq, 7 * kPpm);
  run_until(601.5);
  EXPECT_LT(read().now.offset, 100'000) << "the phase goes on";
}

TEST_F(KernelClockTest, OffsetsNeedTheLoop) {
  set_offset(1'000'000, 3, 0);
  EXPECT_EQ(read().now.offset, 0);
  run_until(10);
  EXPECT_EQ(ahead_ns(), 0);
}

TEST_F(KernelClockTest, HasTheKernelsLimits) {
  EXPECT_EQ(set_frequency(501 * kPpm).now.freq, 500 * kPpm);
  EXPECT_EQ(set_frequency(-501 * kPpm).now.freq, -500 * kPpm);
  EXPECT_EQ(set_offset(600'000'000, 12).now.offset, 500'000'000);
  EXPECT_EQ(read().now.constant, 10);
  timex tick{};
  tick.modes = ADJ_TICK;
  tick.tick = 11'001;
  EXPECT_EQ(adjust(tick).error, EINVAL);
  timex both{};
  both.modes = ADJ_OFFSET_SINGLESHOT | ADJ_STATUS;
  EXPECT_EQ(adjust(both).error, EINVAL) << "adjtime() is alone";
}

TEST_F(KernelClockTest, FrequencyAndTickCountAtOnce) {
  timex request{};
  request.modes = ADJ_FREQUENCY | ADJ_TICK;
  request.freq = -20 * kPpm;
  request.tick = 10'001;
  run_until(0.5);
  adjust(request);
  run_until(1);
  EXPECT_NEAR(ahead_ns(), 0.5 * 80e3, 1);
}

TEST_F(KernelClockTest, TheErrorGrowsBy500PpmUpTo16Seconds) {
  timex request{};
  request.modes = ADJ_MAXERROR | ADJ_ESTERROR | ADJ_STATUS;
  request.maxerror = 1'000;
  request.esterror = 300;
  EXPECT_EQ(adjust(request).state, TIME_OK);
  run_until(10.5);
  EXPECT_EQ(read().now.maxerror, 6'000);
  EXPECT_EQ(read().now.esterror, 300);
  run_until(31'998.5);
  EXPECT_EQ(read().now.maxerror, 16'000'000);
  EXPECT_EQ(read().state, TIME_OK);
  run_until(31'999.5);
  EXPECT_EQ(read().now.maxerror, 16'000'000);
  EXPECT_EQ(read().state, TIME_ERROR);
  EXPECT_EQ(read().now.status, STA_UNSYNC);
}

TEST_F(KernelClockTest, AdjtimeGoesBesideTheLoop) {
  set_offset(1'000'000, 3);
  EXPECT_EQ(single_shot(1'700).now.offset, 0);
  run_until(1.5);
  EXPECT_EQ(single_shot_left_us(), 1'200);
  EXPECT_NEAR(ahead_ns(), 250e3 + 1e6 / 32 / 2, 300);
  run_until(4.5);
  EXPECT_EQ(single_shot_left_us(), 0);
  run_until(5.5);
  double loop_ns = 1e6 * (1 - std::pow(1 - 1.0 / 32, 4));
  loop_ns += (1e6 - loop_ns) / 64;
  EXPECT_NEAR(ahead_ns(), 1'700e3 + loop_ns, 1'000) << "its seconds are 500 ppm shorter";
  EXPECT_EQ(single_shot(-100).now.offset, 0);
  EXPECT_EQ(single_shot(50).now.offset, -100) << "what was left before";
}

TEST_F(KernelClockTest, AStepEndsWhatIsUnderWay) {
  set_offset(1'000'000, 3);
  single_shot(10'000);
  run_until(2.5);
  const double before_ns = ahead_ns();
  timex step{};
  step.modes = ADJ_SETOFFSET | ADJ_NANO;
  step.time = {.tv_sec = -1, .tv_usec = 250'000'000};
  const KernelClock::Answer stepped = adjust(step);
  EXPECT_EQ(stepped.state, TIME_ERROR);
  EXPECT_EQ(stepped.now.maxerror, 16'000'000);
  EXPECT_EQ(stepped.now.offset, 0);
  EXPECT_EQ(single_shot_left_us(), 0);
  EXPECT_NEAR(ahead_ns() - before_ns, -0.75e9, 1);
  run_until(20);
  EXPECT_NEAR(ahead_ns() - before_ns, -0.75e9, 100) << "but for the frequency that it has found";
  timex bad = step;
  bad.time.tv_usec = 1'000'000'000;
  EXPECT_EQ(adjust(bad).error, EINVAL);
}

TEST_F(KernelClockTest, AnInsertedSecondIsRead) {
  set_clock(kEpochS + 86'400 - 3);
  timex tai{};
  tai.modes = ADJ_TAI;
  tai.constant = 37;
  adjust(tai);
  set_status(STA_INS);
  run_until(1.5);
  EXPECT_EQ(read().state, TIME_INS);
  run_until(2.5);
  EXPECT_EQ(second(), kEpochS + 86'400 - 1);
  run_until(3.5);
  EXPECT_EQ(second(), kEpochS + 86'400 - 1) << "the leap second";
  EXPECT_EQ(read().state, TIME_OOP);
  EXPECT_EQ(read().now.tai, 38);
  run_until(4.5);
  EXPECT_EQ(second(), kEpochS + 86'400);
  EXPECT_EQ(read().state, TIME_WAIT);
  set_status(0);
  run_until(5.5);
  EXPECT_EQ(read().state, TIME_OK);
}

TEST_F(KernelClockTest, ADeletedSecondIsNotRead) {
  set_clock(kEpochS + 86'400 - 3);
  set_status(STA_DEL);
  run_until(1.5);
  EXPECT_EQ(read().state, TIME_DEL);
  run_until(2.5);
  EXPECT_EQ(second(), kEpochS + 86'400);
  EXPECT_EQ(read().state, TIME_WAIT);
}

TEST_F(KernelClockTest, TheLoopsEndForgetsTheLeapAndTheUnit) {
  set_offset(1'000, 3);
  set_status(STA_PLL | STA_INS);
  run_until(1.5);
  EXPECT_EQ(read().state, TIME_INS);
  EXPECT_EQ(read().now.status, STA_PLL | STA_INS | STA_NANO);
  const KernelClock::Answer off = set_status(STA_NANO | STA_INS);
  EXPECT_EQ(off.state, TIME_OK);
  EXPECT_EQ(off.now.status, STA_INS) << "STA_NANO can only be read";
}

TEST_F(KernelClockTest, CostsNothingWhileThereIsNothingToDo) {
  set_frequency(10 * kPpm);
  run_until(1);
  const std::uint64_t before = world_.engine.events();
  run_until(100'000);
  EXPECT_EQ(world_.engine.events(), before);
  single_shot(1'000);
  run_until(100'100);
  EXPECT_LT(world_.engine.events() - before, 20U);
}

// A system clock that lags by 20 ppm is told its offset every 16 s: the loop finds the frequency.
TEST_F(KernelClockTest, TheLoopFindsAFrequency) {
  timex slow{};
  slow.modes = ADJ_TICK;
  slow.tick = 9'999;  // -100 ppm
  adjust(slow);
  set_frequency(80 * kPpm);
  for (int poll = 1; poll <= 400; ++poll) {
    run_until(poll * 16);
    set_offset(static_cast<long>(-ahead_ns()), 4);
  }
  EXPECT_NEAR(static_cast<double>(read().now.freq), 100.0 * kPpm, 0.05 * kPpm);
  EXPECT_NEAR(ahead_ns(), 0, 1000);
}

}  // namespace
}  // namespace simbench::sim
