#include "sim/clock/temperature.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "sim/clock/oscillator.h"

namespace simbench::sim {
namespace {

constexpr std::uint64_t kCourseSeed = 7;

scenarios::Temperature still() {
  return {.day_amplitude_k = 0,
          .day_period_h = 24,
          .load_amplitude_k = 0,
          .load_period_s = 1200,
          .load_time_constant_s = 180,
          .fan_amplitude_k = 0,
          .fan_period_s = 90};
}
scenarios::Temperature day_alone() {
  scenarios::Temperature temperature = still();
  temperature.day_amplitude_k = 3;
  return temperature;
}
scenarios::Temperature load_alone(double time_constant_s) {
  scenarios::Temperature temperature = still();
  temperature.load_amplitude_k = 5;
  temperature.load_time_constant_s = time_constant_s;
  return temperature;
}
scenarios::Temperature fan_alone() {
  scenarios::Temperature temperature = still();
  temperature.fan_amplitude_k = 0.5;
  return temperature;
}
scenarios::Temperature all_parts() {
  scenarios::Temperature temperature = load_alone(180);
  temperature.day_amplitude_k = 3;
  temperature.fan_amplitude_k = 0.5;
  return temperature;
}

TrueTime at_second(double s) { return TrueTime(from_seconds(s)); }

// By the midpoints of `steps` parts.
double numeric_integral_ks(const TemperatureCourse& course, double from_s, double to_s, int steps) {
  const double step_s = (to_s - from_s) / steps;
  double sum_ks = 0;
  for (int i = 0; i < steps; ++i) {
    sum_ks += course.kelvin(at_second(from_s + (i + 0.5) * step_s)) * step_s;
  }
  return sum_ks;
}

TEST(TemperatureCourse, IntegralIsThatOfTheTemperature) {
  for (const scenarios::Temperature& parameters :
       {day_alone(), load_alone(180), load_alone(0), load_alone(1e5), fan_alone(), all_parts()}) {
    const TemperatureCourse course(parameters, kCourseSeed, "host1");
    for (const auto& [from_s, to_s] :
         {std::pair(0.0, 700.0), {-500.0, 300.0}, {86400.0, 87000.0}, {-90000.0, -89500.0}}) {
      const double difference_ks =
          course.integral_ks(at_second(to_s)) - course.integral_ks(at_second(from_s));
      // A jump of 10 K may lie anywhere within a step.
      EXPECT_NEAR(difference_ks, numeric_integral_ks(course, from_s, to_s, 80'000), 0.12)
          << from_s << " to " << to_s;
    }
    EXPECT_EQ(course.integral_ks(TrueTime{}), 0);
  }
}

TEST(TemperatureCourse, MeanIsZero) {
  for (const auto& [parameters, period_s] : {std::pair(day_alone(), 86400.0),
                                             {load_alone(180), 1200.0},
                                             {load_alone(0), 1200.0},
                                             {fan_alone(), 90.0},
                                             {all_parts(), 7 * 86400.0}}) {
    const TemperatureCourse course(parameters, kCourseSeed, "host1");
    for (const double begin_s : {0.0, 17.3, -4000.0}) {
      const TrueTime begin = at_second(begin_s);
      EXPECT_NEAR(course.integral_ks(begin + from_seconds(period_s)), course.integral_ks(begin),
                  1e-6);
      EXPECT_NEAR(course.kelvin(begin + from_seconds(period_s)), course.kelvin(begin), 1e-6);
    }
  }
}

// The largest value of a part over a period, seen on a fine grid.
double largest_k(const scenarios::Temperature& parameters, double period_s) {
  const TemperatureCourse course(parameters, kCourseSeed, "host1");
  double largest = -1e9;
  for (int i = 0; i < 100'000; ++i) {
    largest = std::max(largest, course.kelvin(at_second(period_s * i / 100'000)));
  }
  return largest;
}

TEST(TemperatureCourse, PartsHaveTheirAmplitudes) {
  EXPECT_NEAR(largest_k(day_alone(), 86400), 3, 1e-6);
  EXPECT_NEAR(largest_k(fan_alone(), 90), 0.5, 1e-4);
  EXPECT_EQ(largest_k(load_alone(0), 1200), 5);
  // A first-order lag between -A and A for half a period h each ends at A tanh(h / (2 lag)).
  EXPECT_NEAR(largest_k(load_alone(180), 1200), 5 * std::tanh(600 / (2 * 180.0)), 1e-3);
}

TEST(TemperatureCourse, LoadFollowsItsFirstOrderLag) {
  const double lag_s = 180;
  const TemperatureCourse course(load_alone(lag_s), kCourseSeed, "host1");
  int busy = 0;
  for (double s = 0; s < 2400; s += 7) {
    const double slope =
        (course.kelvin(at_second(s + 0.01)) - course.kelvin(at_second(s - 0.01))) / 0.02;
    const double target_k = course.kelvin(at_second(s)) + lag_s * slope;
    EXPECT_NEAR(std::abs(target_k), 5, 1e-3) << s;
    if (target_k > 0) ++busy;
  }
  EXPECT_NEAR(busy / (2400.0 / 7), 0.5, 0.01);
}

TEST(TemperatureCourse, PhasesAreUniformAndOfEachHostItsOwn) {
  constexpr int kHosts = 4000;
  int above_half = 0;
  double squares = 0;
  for (int host = 0; host < kHosts; ++host) {
    const TemperatureCourse course(day_alone(), kCourseSeed, "host" + std::to_string(host));
    const double part = course.kelvin(TrueTime{}) / 3;
    squares += part * part;
    if (part > 0.5) ++above_half;
  }
  // A sine at a uniform phase has the mean square 1/2 and is above a half for a third of the turn.
  EXPECT_NEAR(squares / kHosts, 0.5, 5 * 0.354 / std::sqrt(kHosts)) << "seed " << kCourseSeed;
  EXPECT_NEAR(above_half / static_cast<double>(kHosts), 1.0 / 3, 5 * 0.471 / std::sqrt(kHosts));
}

TEST(TemperatureCourse, PhaseOfAnOscillatorIsExactOverDays) {
  constexpr double kCoefficient = 1000;
  OscillatorModel oscillator(2e-6);
  const TemperatureCourse course(day_alone(), kCourseSeed, "host1");
  oscillator.set_temperature(course, kCoefficient);
  for (const double days : {0.0, 0.3, 1.0, 10.0, 100.25, -5.5}) {
    const TrueTime t = at_second(days * 86400);
    // A sine from the phase p on: A P / (2 pi) (cos p - cos(p + 2 pi t / P)).
    const double begin = std::asin(course.kelvin(TrueTime{}) / 3);
    const double phase =
        course.kelvin(TrueTime{}) < course.kelvin(at_second(1)) ? begin : std::numbers::pi - begin;
    const double turn = 2 * std::numbers::pi;
    const double expected_ns = kCoefficient * 3 * 86400 / turn *
                               (std::cos(phase) - std::cos(phase + turn * std::fmod(days, 1)));
    EXPECT_NEAR(oscillator.deviation_ns(t) - 2e-6 * days * 8.64e13, expected_ns, 0.6) << days;
  }
}

TEST(TemperatureCourse, OscillatorTellsItsMeanFrequency) {
  OscillatorModel oscillator(2e-6);
  EXPECT_DOUBLE_EQ(oscillator.mean_frequency(at_second(-7), at_second(100)), 2e-6);
  EXPECT_EQ(oscillator.mean_frequency_by_temperature(at_second(-7), at_second(100)), 0);
  const TemperatureCourse course(load_alone(0), kCourseSeed, "host1");
  oscillator.set_temperature(course, 100);
  const double by_temperature = 100e-9 * course.kelvin(at_second(0.5));
  EXPECT_NEAR(oscillator.mean_frequency_by_temperature(at_second(0), at_second(1)), by_temperature,
              1e-15);
  EXPECT_NEAR(oscillator.mean_frequency(at_second(0), at_second(1)), 2e-6 + by_temperature, 1e-15);
}

}  // namespace
}  // namespace simbench::sim
