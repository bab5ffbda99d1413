#include "algorithms/device_time/coded.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "algorithms/registry.h"
#include "tests/algorithms/coded_trigger/coded_frames.h"

namespace simbench {
namespace {

std::vector<double> stamps_us(const std::shared_ptr<const CodedPulses>& pulses,
                              const std::vector<CodedFrame>& frames,
                              const CodedTimeSettings& settings = {}) {
  const auto estimator = make_coded(settings);
  estimator->on_coded_pulses(pulses);
  std::vector<double> stamps;
  for (const CodedFrame& frame : frames) {
    const GlobalTime stamp =
        estimator->stamp({.sensor = frame.sensor, .exposure_us = frame.exposure_us});
    stamps.push_back(static_cast<double>(nanoseconds_of(stamp)) * 1e-3);
  }
  return stamps;
}

double due_us(const CodedPulses& pulses, std::int64_t pulse) {
  return to_ns(pulse * pulses.code.period() + pulses.code.shift(pulse)) * 1e-3;
}

TEST(CodedTime, StampsAreOnTheTriggersTime) {
  const auto pulses = usual_pulses();
  for (const double rate_ppm : {-80.0, 0.0, 45.0}) {
    const CodedCamera camera{.first = 321, .rate_ppm = rate_ppm, .offset_us = 7e8};
    const auto frames = coded_frames(*pulses, camera, 900, 1);
    const auto stamps = stamps_us(pulses, frames);
    for (std::size_t i = 100; i < frames.size(); ++i) {
      // The middle of the exposure, which ends at the pulse here.
      const double expected = due_us(*pulses, frames[i].pulse) - 4000;
      EXPECT_NEAR(stamps[i], expected, 1) << "of whole microseconds, " << frames[i].pulse;
    }
  }
}

TEST(CodedTime, TwoCamerasAgreeToTheNoiseOfAStamp) {
  const auto pulses = usual_pulses();
  const CodedCamera one{.first = 10, .rate_ppm = 30, .offset_us = 1e8, .noise_us = 2};
  const CodedCamera two{.first = 40, .rate_ppm = -60, .offset_us = 9e8, .noise_us = 2};
  const auto frames_one = coded_frames(*pulses, one, 2030, 1);
  const auto frames_two = coded_frames(*pulses, two, 2000, 2);
  const auto stamps_one = stamps_us(pulses, frames_one);
  const auto stamps_two = stamps_us(pulses, frames_two);
  double sum = 0;
  int count = 0;
  for (std::size_t i = 500; i < frames_two.size(); ++i) {
    ASSERT_EQ(frames_one[i + 30].pulse, frames_two[i].pulse);
    const double difference = stamps_one[i + 30] - stamps_two[i];
    sum += difference * difference;
    ++count;
  }
  // Each has 2 us and the microsecond's 0.29 us; the line adds sqrt(4 / 300) of it.
  const double expected = std::sqrt(2 * (4 + 1.0 / 12) * (1 + 4.0 / 300));
  EXPECT_NEAR(std::sqrt(sum / count), expected, 0.1 * expected);
}

TEST(CodedTime, UnequalExposuresDoNotMatter) {
  for (const bool begin_at_pulse : {false, true}) {
    const auto pulses = pulses_of(usual_pulses()->code, begin_at_pulse);
    std::vector<CodedFrame> frames;
    for (std::int64_t pulse = 0; pulse < 600; ++pulse) {
      const auto exposure_us = static_cast<std::uint32_t>(1000 + 614 * (pulse % 9));
      frames.push_back({.pulse = pulse,
                        .sensor = coded_stamp(*pulses, {.exposure_us = exposure_us}, pulse, 0),
                        .exposure_us = exposure_us});
    }
    const auto stamps = stamps_us(pulses, frames);
    for (std::size_t i = 100; i < frames.size(); ++i) {
      const double half = frames[i].exposure_us / 2.0 * (begin_at_pulse ? 1 : -1);
      EXPECT_NEAR(stamps[i], due_us(*pulses, frames[i].pulse) + half, 1);
    }
  }
}

TEST(CodedTime, OutliersAreNoPointsOfTheLine) {
  const auto pulses = usual_pulses();
  auto frames = coded_frames(*pulses, {}, 600, 1);
  for (std::size_t i = 50; i < frames.size(); i += 10) frames[i].sensor += Microseconds(3000);
  const auto stamps = stamps_us(pulses, frames);
  for (std::size_t i = 101; i < frames.size(); ++i) {
    if (i % 10 == 0) continue;
    EXPECT_NEAR(stamps[i], due_us(*pulses, frames[i].pulse) - 4000, 1);
  }
}

TEST(CodedTime, BeforeThePlaceIsKnownItCountsFromTheFirstFrame) {
  const auto pulses = usual_pulses();
  const auto frames = coded_frames(*pulses, {.first = 100, .offset_us = 5e8}, 50, 1);
  const auto stamps = stamps_us(pulses, frames);
  EXPECT_EQ(stamps[0], 0);
  const auto since_first = [&](std::size_t i) {
    return static_cast<double>((frames[i].sensor - frames[0].sensor).count());
  };
  EXPECT_EQ(stamps[10], since_first(10));
  EXPECT_NEAR(stamps[49], due_us(*pulses, 149) - 4000, 1);
}

TEST(CodedTime, NeedsACodeAndIsRelative) {
  const DeviceTimeEntry* entry = find_algorithm<DeviceTimeEntry>("coded");
  ASSERT_NE(entry, nullptr);
  EXPECT_EQ(entry->info.needs, std::vector<Need>{Need::kTriggerCode});
  const auto estimator = entry->make(check_parameters(entry->info.parameters, {}));
  EXPECT_TRUE(estimator->relative());
  EXPECT_FALSE(estimator->offline());
  EXPECT_DEATH(estimator->stamp({}), "a coded trigger has a code");
}

}  // namespace
}  // namespace simbench
