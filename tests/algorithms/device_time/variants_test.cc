#include "algorithms/device_time/variants.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "algorithms/device_time/hull.h"
#include "algorithms/device_time/yoon2021.h"
#include "tests/algorithms/device_time/streams.h"

namespace simbench {
namespace {

// Notes what it is given.
struct Given {
  std::vector<DeviceSample> learned;
  std::vector<DeviceSample> stamped;
  std::vector<PollSample> polls;
  std::vector<ClockAdjustment> adjustments;
  std::vector<LedSample> sightings;
};

class Recorder final : public DeviceTimeEstimator {
 public:
  explicit Recorder(Given& given) : given_(given) {}
  GlobalTime stamp(const DeviceSample& sample) override {
    given_.stamped.push_back(sample);
    return GlobalTime(sample.arrival.time_since_epoch());
  }
  bool offline() const override { return true; }
  void learn(std::span<const DeviceSample> recording) override {
    given_.learned.assign(recording.begin(), recording.end());
  }
  bool from_first_frame() const override { return true; }
  void on_poll(const PollSample& poll) override { given_.polls.push_back(poll); }
  void on_adjustment(const ClockAdjustment& adjustment) override {
    given_.adjustments.push_back(adjustment);
  }
  void on_led_sighting(const LedSample& sighting) override { given_.sightings.push_back(sighting); }

 private:
  Given& given_;
};

DeviceSample sample_on(std::int64_t system_ns, std::int64_t steady_ns, std::uint32_t exposure_us) {
  return {.sensor = DeviceTime(Microseconds(1)),
          .arrival = HostTime(Nanoseconds(system_ns)),
          .arrival_steady = SteadyTime(Nanoseconds(steady_ns)),
          .exposure_us = exposure_us};
}

ClockAdjustment step(std::int64_t at_ns, std::int64_t before_ns, std::int64_t after_ns) {
  return {.host = 0,
          .at = SteadyTime(Nanoseconds(at_ns)),
          .before = HostTime(Nanoseconds(before_ns)),
          .after = HostTime(Nanoseconds(after_ns)),
          .rate_ppb = 0};
}

TEST(Variants, PassEverythingOn) {
  Given given;
  const auto wrapped =
      on_steady_clock(exposure_corrected(delay_corrected(std::make_unique<Recorder>(given), {})));
  EXPECT_TRUE(wrapped->offline());
  EXPECT_TRUE(wrapped->from_first_frame());
  EXPECT_FALSE(wrapped->relative());
  wrapped->on_poll({});
  wrapped->on_adjustment(step(1, 2, 3));
  wrapped->on_led_sighting({});
  const std::vector<DeviceSample> two(2);
  wrapped->learn(two);
  wrapped->stamp({});
  EXPECT_EQ(given.polls.size(), 1U);
  EXPECT_EQ(given.adjustments.size(), 1U);
  EXPECT_EQ(given.sightings.size(), 1U);
  EXPECT_EQ(given.learned.size(), 2U);
  EXPECT_EQ(given.stamped.size(), 1U);

  const auto online = on_steady_clock(exposure_corrected(make_raw_arrival()));
  EXPECT_FALSE(online->offline());
  EXPECT_FALSE(online->from_first_frame());
  EXPECT_TRUE(on_steady_clock(make_sensor_normalised())->relative());
}

TEST(Variants, CorrectionsMoveBothArrivals) {
  Given given;
  const auto wrapped =
      delay_corrected(std::make_unique<Recorder>(given),
                      CalibratedDelays{.arrival = Nanoseconds(1000), .poll_asymmetry = {}});
  wrapped->stamp(sample_on(10'000'000, 20'000'000, 5001));
  EXPECT_EQ(nanoseconds_of(given.stamped[0].arrival), 10'000'000 - 2'500'500 - 1000);
  EXPECT_EQ(nanoseconds_of(given.stamped[0].arrival_steady), 20'000'000 - 2'500'500 - 1000);
  EXPECT_EQ(given.stamped[0].exposure_us, 5001U);
  wrapped->learn(std::vector<DeviceSample>{sample_on(10'000'000, 20'000'000, 2)});
  EXPECT_EQ(nanoseconds_of(given.learned[0].arrival), 10'000'000 - 1000 - 1000);
}

TEST(Variants, ExposureStepsLeaveNoTrace) {
  // Delivery a fixed time after the exposure's end, the sensor stamp at its middle.
  std::vector<DeviceSample> samples = line(200, 20'000, 50, 28'000'000);
  std::vector<std::int64_t> expected;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    expected.push_back(nanoseconds_of(samples[i].arrival));
    samples[i].exposure_us = i < 100 ? 2000 : 12'000;
    samples[i].arrival += Microseconds(samples[i].exposure_us / 2);
  }
  const auto corrected = exposure_corrected(make_regression(RegressionWindow{30}));
  const auto plain = make_regression(RegressionWindow{30});
  for (std::size_t i = 0; i < samples.size(); ++i) {
    EXPECT_EQ(nanoseconds_of(corrected->stamp(samples[i])), expected[i]) << i;
    const double error_us = 1e-3 * error_ns(plain->stamp(samples[i]), expected[i]);
    if (i == 199) {
      EXPECT_NEAR(error_us, 6000, 1e-3);
    }
  }
}

TEST(Variants, SteadyClockUsesItsArrivalsAndPolls) {
  Given given;
  const auto wrapped = on_steady_clock(std::make_unique<Recorder>(given));
  wrapped->stamp(sample_on(5000, 700, 0));
  EXPECT_EQ(nanoseconds_of(given.stamped[0].arrival), 700);
  PollSample poll;
  poll.t0 = HostTime(Nanoseconds(1));
  poll.t1 = HostTime(Nanoseconds(2));
  poll.t0_steady = SteadyTime(Nanoseconds(3));
  poll.t1_steady = SteadyTime(Nanoseconds(4));
  wrapped->on_poll(poll);
  EXPECT_EQ(nanoseconds_of(given.polls[0].t0), 3);
  EXPECT_EQ(nanoseconds_of(given.polls[0].t1), 4);
}

TEST(Variants, SteadyClockFallsBackToTheFramesOwnOffset) {
  const auto wrapped = on_steady_clock(make_raw_arrival());
  EXPECT_EQ(nanoseconds_of(wrapped->stamp(sample_on(5000, 700, 0))), 5000);
  wrapped->on_adjustment(step(0, 4000, 4000));
  EXPECT_EQ(nanoseconds_of(wrapped->stamp(sample_on(9999, 800, 0))), 4800);
}

TEST(Variants, AStepOfTheSystemClockEntersNoFit) {
  // The host steps by 5 ms between frames 99 and 100; the steady clock counts on.
  constexpr std::int64_t kSteadyToSystemNs = 1'000'000'000'000;
  std::vector<DeviceSample> samples = line(200, 20'000, 50, 28'000'000);
  const auto system = make_window_hull({});
  const auto steady = on_steady_clock(make_window_hull({}));
  steady->on_adjustment(step(0, kSteadyToSystemNs, kSteadyToSystemNs));
  for (std::size_t i = 0; i < samples.size(); ++i) {
    DeviceSample& sample = samples[i];
    sample.arrival_steady =
        SteadyTime(sample.arrival.time_since_epoch() - Nanoseconds(kSteadyToSystemNs));
    if (i >= 100) sample.arrival += from_ms(5);
    if (i == 100) {
      // Between this frame's exposure and its arrival.
      const std::int64_t at_ns = nanoseconds_of(sample.arrival_steady) - 24'000'000;
      steady->on_adjustment(
          step(at_ns, at_ns + kSteadyToSystemNs, at_ns + kSteadyToSystemNs + 5'000'000));
    }
    EXPECT_EQ(nanoseconds_of(steady->stamp(sample)), nanoseconds_of(sample.arrival)) << i;
    const double error_ms = 1e-6 * error_ns(system->stamp(sample), nanoseconds_of(sample.arrival));
    if (i == 110) {
      EXPECT_NEAR(error_ms, -5, 0.1);
    }
  }
}

TEST(Variants, AStampBeforeTheStepIsReadBeforeTheStep) {
  // Known latency of 30 ms, so the stamp lies before the step that the arrival lies after.
  const auto steady = on_steady_clock(
      delay_corrected(make_raw_arrival(), {.arrival = from_ms(30), .poll_asymmetry = {}}));
  steady->on_adjustment(step(0, 0, 0));
  steady->on_adjustment(step(100'000'000, 100'000'000, 600'000'000));
  EXPECT_EQ(nanoseconds_of(steady->stamp(sample_on(620'000'000, 120'000'000, 0))), 90'000'000);
  EXPECT_EQ(nanoseconds_of(steady->stamp(sample_on(640'000'000, 140'000'000, 0))), 610'000'000);
}

TEST(Variants, RelativeStampsStayAsTheyAre) {
  const auto wrapped = on_steady_clock(make_sensor_normalised());
  wrapped->on_adjustment(step(0, kHostZeroNs, kHostZeroNs));
  EXPECT_EQ(nanoseconds_of(wrapped->stamp(sample_on(5000, 700, 0))), 0);
}

TEST(DeviceTimeName, TakesSuffixesInAnyOrder) {
  const DeviceTimeName plain = {"hull_300"};
  EXPECT_EQ(parse_device_time_name("hull_300"), plain);
  EXPECT_EQ(parse_device_time_name("hull_300_steady"), (DeviceTimeName{"hull_300", true}));
  EXPECT_EQ(parse_device_time_name("kalman_exposure_corrected"),
            (DeviceTimeName{"kalman", false, true}));
  const DeviceTimeName all = {"minimum_1s", true, true, true};
  EXPECT_EQ(parse_device_time_name("minimum_1s_steady_calibrated"), all);
  EXPECT_EQ(parse_device_time_name("minimum_1s_calibrated_steady"), all);
  EXPECT_EQ(parse_device_time_name("minimum_1s_calibrated_steady_exposure_corrected"), all);
  EXPECT_EQ(parse_device_time_name("minimum_1s_exposure_corrected_calibrated_steady"), all);
}

TEST(DeviceTimeName, SdkAndSteadyExcludeEachOther) {
  const DeviceTimeName sdk = parse_device_time_name("hull_300_sdk_calibrated");
  EXPECT_EQ(sdk.base, "hull_300");
  EXPECT_TRUE(sdk.sdk && sdk.calibrated && !sdk.steady);
  EXPECT_EQ(parse_device_time_name("hull_300_calibrated_sdk"), sdk);
  EXPECT_EQ(parse_device_time_name("hull_300_sdk_steady").base, "hull_300_sdk");
  EXPECT_EQ(parse_device_time_name("hull_300_steady_sdk").base, "hull_300_steady");
}

TEST(Variants, SdkStampsAreWholeMillisecondsOfTheSystemClock) {
  Given given;
  const auto wrapped = on_sdk_stamps(std::make_unique<Recorder>(given));
  wrapped->stamp(sample_on(12'999'999, 20'000'001, 5000));
  wrapped->stamp(sample_on(13'000'000, 20'000'002, 5000));
  wrapped->stamp(sample_on(-1, 20'000'003, 5000));
  wrapped->stamp(sample_on(std::numeric_limits<std::int64_t>::min(), 0, 0));
  std::vector<std::int64_t> arrivals;
  for (const DeviceSample& sample : given.stamped) {
    arrivals.push_back(nanoseconds_of(sample.arrival));
  }
  EXPECT_EQ(arrivals, (std::vector<std::int64_t>{12'000'000, 13'000'000, -1'000'000,
                                                 std::numeric_limits<std::int64_t>::min()}));
  EXPECT_EQ(nanoseconds_of(given.stamped[0].arrival_steady), 20'000'001);
  // Polls are the user's own.
  wrapped->on_poll({.t0 = HostTime(Nanoseconds(1)), .t1 = HostTime(Nanoseconds(2))});
  EXPECT_EQ(nanoseconds_of(given.polls[0].t1), 2);
}

TEST(DeviceTimeName, LeavesTheRestInTheBase) {
  EXPECT_EQ(parse_device_time_name("x_steady_steady").base, "x_steady");
  EXPECT_EQ(parse_device_time_name("steady").base, "steady");
  EXPECT_EQ(parse_device_time_name("_steady").base, "");
  EXPECT_EQ(parse_device_time_name("x_steady_y").base, "x_steady_y");
  EXPECT_EQ(parse_device_time_name("").base, "");
}

TEST(DeviceTimeName, MakesTheVariant) {
  const DeviceSample sample = sample_on(100'000'000, 40'000'000, 2000);
  const auto stamped = [&](const char* suffixes) {
    const DeviceTimeName name = parse_device_time_name(std::string("raw_arrival") + suffixes);
    const auto estimator =
        make_variant(name, make_raw_arrival(), {.arrival = from_ms(7), .poll_asymmetry = {}});
    estimator->on_adjustment(step(0, 1000, 1000));
    return nanoseconds_of(estimator->stamp(sample));
  };
  EXPECT_EQ(stamped(""), 100'000'000);
  EXPECT_EQ(stamped("_exposure_corrected"), 99'000'000);
  EXPECT_EQ(stamped("_calibrated"), 92'000'000);
  EXPECT_EQ(stamped("_sdk"), 100'000'000);
  EXPECT_EQ(stamped("_sdk_calibrated"), 92'000'000);
  EXPECT_EQ(stamped("_steady"), 40'001'000);
  EXPECT_EQ(stamped("_steady_exposure_corrected"), 39'001'000);
  EXPECT_EQ(stamped("_calibrated_steady"), 32'001'000);
}

}  // namespace
}  // namespace simbench
