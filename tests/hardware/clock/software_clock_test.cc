// The node's own clock through its port, in real time.
#include "hardware/clock/software_clock.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/hardware/await.h"

namespace simbench::hardware {
namespace {

// An operating system's clock that is an hour ahead of the monotonic clock.
HostTime hour_ahead() {
  return HostTime(monotonic_now().time_since_epoch() + std::chrono::hours(1));
}

HostTime hour_ahead_at(MonotonicTime at) {
  return HostTime(at.time_since_epoch() + std::chrono::hours(1));
}

class SoftwareClockTest : public testing::Test {
 protected:
  SoftwareClock::Settings settings() const {
    return {.host = 3, .oscillator = {}, .offset = {}, .system_clock = hour_ahead};
  }
  boost::asio::io_context context{1};
};

TEST_F(SoftwareClockTest, BeginsAtTheSystemClockPlusItsOffset) {
  SoftwareClock::Settings made_up = settings();
  made_up.offset = from_ms(-300);
  const SoftwareClock clock(context, made_up);
  const MonotonicTime now = monotonic_now();
  // Right to half of what reading the system's clock took; 5 ms even on a machine that stalls.
  EXPECT_NEAR(to_ms(clock.system_at(now) - hour_ahead_at(now)), -300, 5);
  EXPECT_EQ(clock.present(now).host, 3u);
  EXPECT_EQ(clock.present(now).rate_ppb, 0);
}

TEST_F(SoftwareClockTest, RunsAtTheSkewOfItsOscillator) {
  SoftwareClock::Settings made_up = settings();
  made_up.oscillator = {monotonic_now(), SteadyTime{}, 30};
  const SoftwareClock clock(context, made_up);
  const MonotonicTime now = monotonic_now();
  const MonotonicTime later = now + std::chrono::seconds(1000);
  EXPECT_NEAR(to_ms(clock.system_at(later) - clock.system_at(now)), 1'000'030, 2e-6);
  EXPECT_NEAR(to_ms(clock.steady_at(later) - clock.steady_at(now)), 1'000'030, 2e-6);
}

// The call lasts 20 ms and the value counts after a quarter of it, so at the call's end the clock
// is ahead by the rest.
TEST_F(SoftwareClockTest, AChangeTakesWhatItCosts) {
  SoftwareClock::Settings slow = settings();
  slow.set_cost = {.cost_ms = 20, .log_sigma = 0, .effective_fraction = 0.25};
  SoftwareClock clock(context, slow);
  const MonotonicTime begin = monotonic_now();
  await(context, clock.set(HostTime(from_ms(5000))));
  const MonotonicTime end = monotonic_now();
  EXPECT_GE(end - begin, from_ms(20));
  EXPECT_GE(clock.system_at(end), HostTime(from_ms(5000)));
  EXPECT_LE(clock.system_at(end), HostTime(from_ms(5000 - 5)) + (end - begin));
  // Readings of before the change are the old ones for a quarter of the call.
  EXPECT_GT(clock.system_at(begin + from_ms(4.9)), HostTime(std::chrono::hours(1)));
}

TEST_F(SoftwareClockTest, SetsAndReadsThePresent) {
  SoftwareClock clock(context, settings());
  const MonotonicTime before = monotonic_now();
  await(context, clock.set(HostTime(from_ms(5000))));
  const HostTime reads = await(context, clock.now());
  const Nanoseconds took = monotonic_now() - before;
  EXPECT_GE(reads, HostTime(from_ms(5000)));
  EXPECT_LE(reads, HostTime(from_ms(5000)) + took);
  EXPECT_EQ(clock.system_at(before), clock.system_at(before + Nanoseconds(1)) - Nanoseconds(1));
  EXPECT_GT(clock.system_at(before), HostTime(std::chrono::hours(1)));
}

TEST_F(SoftwareClockTest, TellsTheEndOfASlewWhenItComes) {
  SoftwareClock clock(context, settings());
  std::vector<ClockAdjustment> adjustments;
  clock.observe([&](const ClockAdjustment& adjustment) { adjustments.push_back(adjustment); });
  await(context, clock.slew(from_ms(1), 100'000'000));  // 10 ms
  ASSERT_EQ(adjustments.size(), 1u);
  run_until(context, [&] { return adjustments.size() == 2; });
  EXPECT_DOUBLE_EQ(adjustments[0].rate_ppb, 100'000'000);
  EXPECT_DOUBLE_EQ(adjustments[1].rate_ppb, 0);
  EXPECT_NEAR(to_ms(adjustments[1].at - adjustments[0].at), 10, 2e-6);
  EXPECT_NEAR(to_ms(adjustments[1].after - adjustments[0].after), 11, 2e-6);
}

TEST_F(SoftwareClockTest, LeavesTheContextWithoutWorkWhenNobodyObserves) {
  SoftwareClock clock(context, settings());
  clock.observe([](const ClockAdjustment&) {});
  await(context, clock.slew(from_ms(1), 1));  // twelve days
  context.restart();
  context.poll();
  EXPECT_FALSE(context.stopped()) << "it waits for the end of the slew";
  clock.observe(nullptr);
  context.restart();
  context.poll();
  EXPECT_TRUE(context.stopped());
}

TEST_F(SoftwareClockTest, RestartsAsItBegan) {
  SoftwareClock::Settings made_up = settings();
  made_up.offset = from_ms(40);
  SoftwareClock clock(context, made_up);
  std::vector<ClockAdjustment> adjustments;
  clock.observe([&](const ClockAdjustment& adjustment) { adjustments.push_back(adjustment); });
  await(context, clock.set(HostTime(from_ms(1))));
  await(context, clock.adjust_frequency(1e6));
  await(context, clock.slew(from_ms(10), 1000));
  clock.restart();
  const MonotonicTime now = monotonic_now();
  EXPECT_NEAR(to_ms(clock.system_at(now) - hour_ahead_at(now)), 40, 5);
  EXPECT_EQ(clock.present(now).rate_ppb, 0);
  ASSERT_EQ(adjustments.size(), 4u);
  EXPECT_EQ(adjustments[3].rate_ppb, 0);
}

TEST_F(SoftwareClockTest, RefusesWhatIsNoRate) {
  SoftwareClock clock(context, settings());
  EXPECT_THROW(await(context, clock.adjust_frequency(1e9)), ClockError);
}

TEST(PairedReadingTest, TheClosestPairCountsAndItsMiddle) {
  // Readings of the monotonic clock: pairs 100 ns apart, one of them 40 ns.
  std::int64_t now = 0;
  int pair = 0;
  bool opens = true;
  const auto monotonic = [&] {
    if (!opens) now += pair++ == 3 ? 40 : 100;
    opens = !opens;
    return MonotonicTime(Nanoseconds(now));
  };
  const auto clock = [&] { return HostTime(Nanoseconds(1000 + pair)); };
  const PairedReading reading = paired_reading(clock, monotonic);
  EXPECT_EQ(reading.reads, HostTime(Nanoseconds(1003)));
  EXPECT_EQ(reading.at, MonotonicTime(Nanoseconds(320)));
}

}  // namespace
}  // namespace simbench::hardware
