#include "algorithms/host_sync/clock_steering.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/io_context.hpp>
#include <cmath>
#include <exception>
#include <stdexcept>

namespace simbench {
namespace {

// A host that is only clocks: time passes when the test says so, and while a call lasts.
class ClockHost : public Host, private HostClock, private SteadyClock {
 public:
  explicit ClockHost(Nanoseconds granularity = Nanoseconds(1), Nanoseconds call = {})
      : granularity_(granularity), call_(call) {}

  double offset_ns = 0;  // system minus steady clock
  int steps = 0;
  int slews = 0;

  void pass(Nanoseconds time) {
    const auto ns = static_cast<double>(time.count());
    const double slewed = std::min(std::abs(slew_left_), slew_rate_ * ns);
    offset_ns += rate_ * ns + std::copysign(slewed, slew_left_);
    slew_left_ -= std::copysign(slewed, slew_left_);
    steady_ += time;
  }
  HostTime reading() const {
    const auto exact = static_cast<std::int64_t>(std::floor(offset_ns));
    const std::int64_t ns = steady_.time_since_epoch().count() + exact;
    return HostTime(Nanoseconds(ns - ns % granularity_.count()));
  }
  void run(Task<void> task) {
    boost::asio::co_spawn(context_, std::move(task), [](std::exception_ptr error) {
      if (error) std::rethrow_exception(error);
    });
    context_.restart();
    context_.run();
  }

  PeerId id() const override { return 1; }
  HostClock& clock() override { return *this; }
  const SteadyClock& steady_clock() const override { return *this; }
  MessageChannel& open_channel(PeerId, Transport) override { throw std::logic_error("no network"); }
  Task<void> sleep_for(Nanoseconds interval) override {
    pass(interval);
    co_return;
  }
  Task<void> sleep_until(HostTime) override { co_return; }
  double random_uniform() override { return 0.5; }
  void report_exchange(const Exchange&) override {}
  void report_outcome(const SyncOutcome&) override {}

 private:
  SteadyTime now() const override { return steady_; }
  Task<HostTime> now() override { co_return reading(); }
  Task<void> set(HostTime value) override {
    ++steps;
    pass(call_ / 2);
    slew_left_ = 0;
    const std::int64_t ns = value.time_since_epoch().count();
    offset_ns =
        static_cast<double>(ns - ns % granularity_.count() - steady_.time_since_epoch().count());
    pass(call_ - call_ / 2);
    co_return;
  }
  Task<void> adjust_frequency(double ppb) override {
    pass(call_ / 2);
    rate_ = ppb * 1e-9;
    pass(call_ - call_ / 2);
    co_return;
  }
  Task<void> slew(Nanoseconds offset, double max_rate_ppb) override {
    ++slews;
    pass(call_ / 2);
    slew_left_ = static_cast<double>(offset.count());
    slew_rate_ = max_rate_ppb * 1e-9;
    pass(call_ - call_ / 2);
    co_return;
  }

  Nanoseconds granularity_;
  Nanoseconds call_;
  SteadyTime steady_{from_ms(5000)};
  double rate_ = 0;
  double slew_rate_ = 0;
  double slew_left_ = 0;
  boost::asio::io_context context_;
};

Nanoseconds true_lead(const ClockHost& host, const ClockLine& line) {
  return host.reading() - line.read(host.steady_clock().now());
}

void steer_once(ClockHost& host, SteeredClock& clock, const ClockLine& line) {
  host.run(clock.steer(line));
}

TEST(SteeredClockTest, StepsAndTakesTheRateOver) {
  ClockHost host;
  SteeredClock clock(host, {});
  const ClockLine line{.at = SteadyTime{}, .value = HostTime(from_ms(9e6)), .rate_ppb = 30'000};
  steer_once(host, clock, line);
  EXPECT_EQ(host.steps, 1);
  host.pass(from_ms(100e3));
  EXPECT_LE(std::abs(true_lead(host, line).count()), 20);
}

TEST(SteeredClockTest, SlewsWhatIsNearWithoutAStep) {
  ClockHost host;
  SteeredClock clock(host, {});
  const ClockLine line{.at = SteadyTime{}, .value = HostTime(from_ms(0.2)), .rate_ppb = -4'000};
  steer_once(host, clock, line);
  EXPECT_EQ(host.steps, 0);
  EXPECT_EQ(host.slews, 1);
  host.pass(from_ms(500));
  EXPECT_NEAR(to_ms(true_lead(host, line)), -0.09, 1e-3);
  EXPECT_NEAR(to_ms(clock.lead_over(line)), -0.09, 1e-3);
  host.pass(from_ms(600));
  EXPECT_LE(std::abs(true_lead(host, line).count()), 2);
}

TEST(SteeredClockTest, NoSlewIsFasterThanTheLimit) {
  ClockHost host;
  SteeredClock clock(host, {});
  const ClockLine line{.at = SteadyTime{}, .value = HostTime(from_ms(4)), .rate_ppb = 0};
  steer_once(host, clock, line);
  host.pass(from_ms(2000));
  EXPECT_NEAR(to_ms(true_lead(host, line)), -3, 1e-3);
  steer_once(host, clock, line);
  host.pass(from_ms(6001));
  EXPECT_LE(std::abs(true_lead(host, line).count()), 2);
}

TEST(SteeredClockTest, TheSecondStepAimsAtTheEndOfTheDelayThatTheFirstOneShowed) {
  ClockHost host(Nanoseconds(1), from_ms(4));
  SteeredClock clock(host, {});
  ClockLine line{.at = SteadyTime{}, .value = HostTime(from_ms(9e6)), .rate_ppb = 0};
  steer_once(host, clock, line);
  line.value += from_ms(5000);
  host.pass(from_ms(1000));
  steer_once(host, clock, line);
  EXPECT_EQ(host.steps, 2);
  EXPECT_EQ(host.slews, 1) << "what was left of the first step";
  EXPECT_LE(std::abs(true_lead(host, line).count()), 2);
}

TEST(SteeredClockTest, ManyReadingsFindACoarseClockBelowItsGranularity) {
  ClockHost host(from_ms(1));
  host.offset_ns = 123'456'789;
  SteeredClock clock(host, {});
  for (int i = 0; i < 2000; ++i) {
    clock.observe(host.reading(), host.steady_clock().now());
    host.pass(Nanoseconds(10'618'033));
  }
  const SteadyTime now = host.steady_clock().now();
  EXPECT_NEAR(static_cast<double>(offset_between(clock.at(now), now).count()), 123'456'789, 2'000);
  EXPECT_LE(std::abs((clock.when(clock.at(now)) - now).count()), 1);
}

TEST(SteeredClockTest, ACoarseClockIsSteeredBelowItsGranularity) {
  ClockHost host(from_ms(1));
  host.offset_ns = 123'456'789;
  SteeredClock clock(host, {});
  const ClockLine line{.at = SteadyTime{}, .value = HostTime(from_ms(700)), .rate_ppb = 12'000};
  for (int i = 0; i < 4000; ++i) {
    if (i % 100 == 0) steer_once(host, clock, line);
    clock.observe(host.reading(), host.steady_clock().now());
    host.pass(Nanoseconds(10'618'033));
  }
  const auto now = host.steady_clock().now();
  const auto line_offset = static_cast<double>(offset_between(line.read(now), now).count());
  EXPECT_NEAR(host.offset_ns, line_offset, 5'000);
  EXPECT_EQ(host.steps, 1);
}

TEST(SteeredClockTest, SomebodyElsesStepIsNoticedAtOnceInBothDirections) {
  ClockHost host(Nanoseconds(100));
  SteeredClock clock(host, {});
  for (const double step_ns : {7e6, -3e6, -50e3}) {
    for (int i = 0; i < 40; ++i) {
      clock.observe(host.reading(), host.steady_clock().now());
      host.pass(Nanoseconds(1'234'567));
    }
    host.offset_ns += step_ns;
    clock.observe(host.reading(), host.steady_clock().now());
    const SteadyTime now = host.steady_clock().now();
    EXPECT_NEAR(static_cast<double>(offset_between(clock.at(now), now).count()), host.offset_ns,
                200)
        << step_ns;
  }
}

}  // namespace
}  // namespace simbench
