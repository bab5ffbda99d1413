// What adjtimex(2) documents, computed by hand, then seeds of arbitrary requests.
#include "clocks/kernel_discipline.h"

#include <gtest/gtest.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <random>

namespace simbench::clocks {
namespace {

constexpr std::int64_t kNoon = 1'700'000'000;  // s since 1970; not the last second of a day
constexpr std::int64_t kDay = 86'400;
constexpr std::int64_t kMidnight = (kNoon / kDay + 1) * kDay;

timex request_of(unsigned modes) {
  timex request{};
  request.modes = modes;
  return request;
}

// A perfect oscillator under a kernel that is moved on when it wants to be.
class Host : public AdjustedClock {
 public:
  explicit Host(std::int64_t begin_s) : begin_ns_(begin_s * kSecondNs), reading_ns_(begin_ns_) {}

  std::int64_t epoch_ns() const override { return reading_ns_; }
  void leap(Nanoseconds offset) override { reading_ns_ += offset.count(); }
  void adjust_frequency(double ppb) override { rate_ppb_ = ppb; }

  double rate_ppm() const { return rate_ppb_ * 1e-3; }
  // As its oscillator counts, second by second of the system clock.
  void pass(KernelDiscipline& kernel, int seconds) {
    for (int i = 0; i < seconds; ++i) {
      const std::int64_t left_ns = kernel.next_second_ns() - reading_ns_;
      passed_ns_ += static_cast<double>(left_ns) / (1 + rate_ppb_ * 1e-9);
      reading_ns_ += left_ns;
      kernel.move_on(*this);
    }
  }
  // By which it is ahead of its oscillator since its begin.
  double gained_us() const {
    return (static_cast<double>(reading_ns_ - begin_ns_) - passed_ns_) * 1e-3;
  }

 private:
  std::int64_t begin_ns_;
  std::int64_t reading_ns_;
  double passed_ns_ = 0;
  double rate_ppb_ = 0;
};

class KernelDisciplineTest : public testing::Test {
 protected:
  int apply(const timex& request) {
    adjtime_before_us_ = kernel_.adjtime_left_us();
    if (const int refused = KernelDiscipline::refusal(request); refused != 0) return refused;
    kernel_.apply(request, host_);
    state_ = kernel_.read(host_.epoch_ns(), request, adjtime_before_us_, now_);
    return 0;
  }
  const timex& read() {
    apply(timex{});
    return now_;
  }
  void set_status(int status) {
    timex request = request_of(ADJ_STATUS);
    request.status = status;
    ASSERT_EQ(apply(request), 0);
  }

  Host host_{kNoon};
  KernelDiscipline kernel_{host_.epoch_ns()};
  timex now_{};
  int state_ = -1;
  long adjtime_before_us_ = 0;
};

TEST_F(KernelDisciplineTest, BeginsUnsynchronised) {
  const timex& now = read();
  EXPECT_EQ(state_, TIME_ERROR);
  EXPECT_EQ(now.status, STA_UNSYNC);
  EXPECT_EQ(now.tick, 10'000);
  EXPECT_EQ(now.maxerror, 16'000'000);
  EXPECT_EQ(now.time.tv_sec, kNoon);
}

TEST_F(KernelDisciplineTest, FrequencyAndTickAddUpAtOnce) {
  timex request = request_of(ADJ_FREQUENCY | ADJ_TICK);
  request.freq = 65536 * 12 + 32768;
  request.tick = 10'001;
  ASSERT_EQ(apply(request), 0);
  EXPECT_DOUBLE_EQ(host_.rate_ppm(), 12.5 + 100);
  EXPECT_EQ(now_.freq, request.freq);
  EXPECT_EQ(now_.tick, 10'001);
  EXPECT_FALSE(kernel_.is_moving());  // the kernel has no work with a rate that stays
}

TEST_F(KernelDisciplineTest, FrequenciesAreCutAndTicksRefused) {
  timex request = request_of(ADJ_FREQUENCY);
  request.freq = 65536 * 700;
  ASSERT_EQ(apply(request), 0);
  EXPECT_DOUBLE_EQ(host_.rate_ppm(), 500);
  for (const long tick : {8'999L, 11'001L}) {
    request = request_of(ADJ_TICK);
    request.tick = tick;
    EXPECT_EQ(apply(request), EINVAL);
  }
}

TEST_F(KernelDisciplineTest, AdjtimeSlewsFiveHundredMicrosecondsASecond) {
  timex request = request_of(ADJ_OFFSET_SINGLESHOT);
  request.offset = -1'200;
  ASSERT_EQ(apply(request), 0);
  EXPECT_EQ(now_.offset, 0);              // what was left before
  EXPECT_DOUBLE_EQ(host_.rate_ppm(), 0);  // until the next second begins
  host_.pass(kernel_, 1);
  EXPECT_DOUBLE_EQ(host_.rate_ppm(), -500);
  ASSERT_EQ(apply(request_of(ADJ_OFFSET_SS_READ)), 0);
  EXPECT_EQ(now_.offset, -700);
  host_.pass(kernel_, 3);
  EXPECT_NEAR(host_.gained_us(), -1'200, 1);  // a slow clock's second takes longer
  EXPECT_FALSE(kernel_.is_moving());
}

// A second of the loop adds 1 / 2^(2 + constant) of what is left; the offset alone moves the rate
// by offset * min(mu, 8 * 2^constant) / (16 * 2^constant)^2 for good.
TEST_F(KernelDisciplineTest, TheLoopAddsItsPartOfTheOffsetInEachSecond) {
  set_status(STA_PLL);
  host_.pass(kernel_, 16);
  timex request = request_of(ADJ_OFFSET | ADJ_TIMECONST | ADJ_NANO);
  request.offset = 640'000;
  request.constant = 3;
  ASSERT_EQ(apply(request), 0);
  const double frequency_ppm = 640.0 * 16 / (128.0 * 128);
  EXPECT_NEAR(host_.rate_ppm(), frequency_ppm, 1e-9);
  EXPECT_NEAR(static_cast<double>(now_.freq) / 65536, frequency_ppm, 1.0 / 65536);
  double left_us = 640;
  for (int second = 0; second < 5; ++second) {
    host_.pass(kernel_, 1);
    EXPECT_NEAR(host_.rate_ppm(), frequency_ppm + left_us / 32, 1e-9);
    left_us -= left_us / 32;
    EXPECT_NEAR(static_cast<double>(read().offset), left_us * 1e3, 1);
  }
}

TEST_F(KernelDisciplineTest, ConstantsGetFourMoreInMicroseconds) {
  timex request = request_of(ADJ_TIMECONST);
  request.constant = 2;
  ASSERT_EQ(apply(request), 0);
  EXPECT_EQ(now_.constant, 6);
  request.modes |= ADJ_NANO;
  ASSERT_EQ(apply(request), 0);
  EXPECT_EQ(now_.constant, 2);
}

TEST_F(KernelDisciplineTest, OffsetsNeedTheLoopAndAHeldFrequencyStays) {
  timex request = request_of(ADJ_OFFSET);
  request.offset = 1'000;
  ASSERT_EQ(apply(request), 0);
  EXPECT_EQ(now_.offset, 0);
  set_status(STA_PLL | STA_FREQHOLD);
  host_.pass(kernel_, 64);
  ASSERT_EQ(apply(request), 0);
  EXPECT_EQ(now_.offset, 1'000);
  EXPECT_EQ(now_.freq, 0);
}

TEST_F(KernelDisciplineTest, LongIntervalsLockTheFrequency) {
  set_status(STA_PLL);
  host_.pass(kernel_, 4'096);
  timex request = request_of(ADJ_OFFSET | ADJ_NANO);
  request.offset = 409'600;
  ASSERT_EQ(apply(request), 0);
  EXPECT_NE(now_.status & STA_MODE, 0);
  // FLL: offset / 4 / mu; PLL with the kernel's first constant of 2: offset * 32 / 64^2.
  EXPECT_NEAR(host_.rate_ppm(), 409.6 / 4 / 4'096 + 409.6 * 32 / (64 * 64), 1e-6);
}

TEST_F(KernelDisciplineTest, AStepEndsWhatWasUnderWay) {
  set_status(STA_PLL);
  timex request = request_of(ADJ_OFFSET_SINGLESHOT);
  request.offset = 5'000;
  ASSERT_EQ(apply(request), 0);
  host_.pass(kernel_, 2);
  const std::int64_t before = host_.epoch_ns();
  request = request_of(ADJ_SETOFFSET);
  request.time = {.tv_sec = -1, .tv_usec = 250'000};
  ASSERT_EQ(apply(request), 0);
  EXPECT_EQ(host_.epoch_ns() - before, -750'000'000);
  EXPECT_EQ(kernel_.adjtime_left_us(), 0);
  EXPECT_DOUBLE_EQ(host_.rate_ppm(), 0);
  EXPECT_EQ(state_, TIME_ERROR);
  EXPECT_NE(now_.status & STA_UNSYNC, 0);
  request.time.tv_usec = 1'000'000;
  EXPECT_EQ(apply(request), EINVAL);
}

TEST_F(KernelDisciplineTest, ErrorBoundsGrowUntilNobodyTrustsTheClock) {
  timex request = request_of(ADJ_STATUS | ADJ_MAXERROR | ADJ_ESTERROR);
  request.maxerror = 15'999'000;
  request.esterror = 20;
  ASSERT_EQ(apply(request), 0);
  EXPECT_EQ(state_, TIME_OK);
  host_.pass(kernel_, 2);
  EXPECT_EQ(read().maxerror, 16'000'000);
  EXPECT_EQ(state_, TIME_OK);
  host_.pass(kernel_, 1);
  EXPECT_EQ(read().maxerror, 16'000'000);
  EXPECT_EQ(now_.esterror, 20);
  EXPECT_EQ(state_, TIME_ERROR);
}

class LeapSecondTest : public testing::TestWithParam<int> {};

// POSIX: the last second of the day is repeated, or is not there.
TEST_P(LeapSecondTest, ComesAtTheEndOfTheDay) {
  const bool inserts = GetParam() == STA_INS;
  Host host(kMidnight - 4);
  KernelDiscipline kernel(host.epoch_ns());
  timex request = request_of(ADJ_STATUS | ADJ_TAI | ADJ_MAXERROR);
  request.status = GetParam();
  request.constant = 37;
  kernel.apply(request, host);
  timex now{};
  host.pass(kernel, 1);
  EXPECT_EQ(kernel.read(host.epoch_ns(), timex{}, 0, now), inserts ? TIME_INS : TIME_DEL);
  EXPECT_EQ(now.tai, 37);
  host.pass(kernel, inserts ? 3 : 2);
  EXPECT_EQ(host.epoch_ns(), (inserts ? kMidnight - 1 : kMidnight) * kSecondNs);
  EXPECT_EQ(kernel.read(host.epoch_ns(), timex{}, 0, now), inserts ? TIME_OOP : TIME_WAIT);
  EXPECT_EQ(now.tai, inserts ? 38 : 36);
  EXPECT_NEAR(host.gained_us(), inserts ? -1e6 : 1e6, 1e-3);
  host.pass(kernel, 2);
  EXPECT_EQ(kernel.read(host.epoch_ns(), timex{}, 0, now), TIME_WAIT);  // until the bit is cleared
  kernel.apply(request_of(ADJ_STATUS), host);
  host.pass(kernel, 1);
  EXPECT_EQ(kernel.read(host.epoch_ns(), timex{}, 0, now), TIME_OK);
  EXPECT_FALSE(kernel.is_moving());
}

INSTANTIATE_TEST_SUITE_P(KernelDiscipline, LeapSecondTest, testing::Values(STA_INS, STA_DEL));

// Whatever a program asks: values stay in the ranges that adjtimex(2) gives, and who is not told
// that a request changes the clock finds it unchanged.
TEST(KernelDisciplineProperties, ArbitraryRequestsKeepTheRanges) {
  constexpr std::array<long, 9> kValues{0,       1,          -1,       500,        -500'000,
                                        900'000, 65536 * 90, 1L << 40, -(1L << 62)};
  for (unsigned seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    std::mt19937 random(seed);  // NOLINT(cert-msc32-c,cert-msc51-cpp): a seed repeats
    const auto any = [&] { return kValues.at(random() % kValues.size()); };
    Host host(kNoon);
    KernelDiscipline kernel(host.epoch_ns());
    for (int i = 0; i < 50; ++i) {
      timex request = request_of(random() & 0xFFFF);
      request.offset = any();
      request.freq = any();
      request.status = static_cast<int>(any());
      request.constant = any();
      request.maxerror = any();
      request.esterror = any();
      request.tick = 10'000 + any() % 1'200;
      request.time = {.tv_sec = any() % 1'000, .tv_usec = std::abs(any() % 1'000'000)};
      if (KernelDiscipline::refusal(request) == 0) {
        kernel.move_on(host);
        const bool changes = kernel.changes_clock(request);
        const double rate = host.rate_ppm();
        const std::int64_t reading = host.epoch_ns();
        kernel.apply(request, host);
        EXPECT_TRUE(changes || (rate == host.rate_ppm() && reading == host.epoch_ns()));
      }
      host.pass(kernel, static_cast<int>(random() % 5));
      timex now{};
      kernel.read(host.epoch_ns(), timex{}, 0, now);
      EXPECT_LE(std::abs(now.freq), 500L << 16);
      EXPECT_LE(std::abs(now.offset), 500'000'000);
      EXPECT_TRUE(now.maxerror >= 0 && now.maxerror <= 16'000'000);
      EXPECT_TRUE(now.constant >= 0 && now.constant <= 10);
      EXPECT_TRUE(now.tick >= 9'000 && now.tick <= 11'000);
      ASSERT_FALSE(testing::Test::HasFailure()) << "request " << i;
    }
  }
}

TEST(KernelDiscipline, KnowsWhetherAnybodySteeredIt) {
  const auto was_steered_by = [](unsigned modes, long number) {
    Host host(kNoon);
    KernelDiscipline kernel(host.epoch_ns());
    timex request = request_of(modes);
    request.offset = request.freq = number;
    kernel.apply(request, host);
    kernel.move_on(host);
    return kernel.was_steered();
  };
  EXPECT_FALSE(was_steered_by(0, 0)) << "it is read";
  EXPECT_FALSE(was_steered_by(ADJ_MAXERROR, 1));
  EXPECT_FALSE(was_steered_by(ADJ_FREQUENCY, 0)) << "it is what it was";
  EXPECT_FALSE(was_steered_by(ADJ_OFFSET_SINGLESHOT, 0)) << "adjtime() of nothing";
  EXPECT_FALSE(was_steered_by(ADJ_OFFSET_SS_READ, 5));
  EXPECT_TRUE(was_steered_by(ADJ_FREQUENCY, 65536));
  EXPECT_TRUE(was_steered_by(ADJ_OFFSET_SINGLESHOT, 5));
  EXPECT_TRUE(was_steered_by(ADJ_SETOFFSET, 0));
  Host host(kNoon);
  KernelDiscipline kernel(host.epoch_ns());
  kernel.forget(host);
  EXPECT_TRUE(kernel.was_steered()) << "clock_settime()";
}

}  // namespace
}  // namespace simbench::clocks
