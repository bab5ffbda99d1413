// Series of noise of known kind and level: slopes and levels of the deviations against theory
// (power-law noise in NIST SP 1065 and IEEE Std 1139), over many seeds.
#include <gmock/gmock.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <vector>

#include "evaluation/stability/stability.h"
#include "tests/evaluation/stability/noises.h"

namespace simbench::evaluation {
namespace {

constexpr int kSeeds = 200;
constexpr std::size_t kPoints = 1024;
constexpr double kSigma = 1e-9;

std::vector<double> white(std::uint32_t seed) { return white_noise(seed, kPoints, kSigma); }

// The deviation at m = 8, 16, 32 and 64: root of the mean variance over the seeds.
std::vector<double> mean_deviation(
    const std::function<std::vector<double>(std::uint32_t seed)>& noise, Deviation deviation) {
  std::vector<double> variances(4);
  for (std::uint32_t seed = 1; seed <= kSeeds; ++seed) {
    const TimeErrorSeries series{.interval_s = 1, .pieces = {{.start_s = 0, .x_s = noise(seed)}}};
    for (std::size_t i = 0; i < variances.size(); ++i) {
      const double value = deviation_at(series, deviation, std::int64_t{8} << i)->value;
      variances[i] += value * value / kSeeds;
    }
  }
  for (double& value : variances) value = std::sqrt(value);
  return variances;
}

// Slope over the three octaves, and level: value = level tau^slope.
void expect_power_law(const std::vector<double>& values, double slope, double level) {
  const double found = std::log(values[3] / values[0]) / std::log(8);
  EXPECT_NEAR(found, slope, slope == 0 ? 0.05 : 0.05 * std::abs(slope));
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double expected = level * std::pow(8.0 * static_cast<double>(1U << i), slope);
    EXPECT_NEAR(values[i], expected, 0.03 * expected) << "octave " << i;
  }
}

TEST(StabilityOfNoise, WhitePhase) {
  expect_power_law(mean_deviation(white, Deviation::kAdev), -1, std::sqrt(3) * kSigma);
  expect_power_law(mean_deviation(white, Deviation::kAdevPlain), -1, std::sqrt(3) * kSigma);
  expect_power_law(mean_deviation(white, Deviation::kMdev), -1.5, std::sqrt(3) * kSigma);
  expect_power_law(mean_deviation(white, Deviation::kTdev), -0.5, kSigma);
  expect_power_law(mean_deviation(white, Deviation::kHdev), -1, std::sqrt(10.0 / 3) * kSigma);
}

TEST(StabilityOfNoise, FlickerPhase) {
  const auto noise = [](std::uint32_t seed) { return flicker(white(seed)); };
  // h_1 = 4 pi sigma^2; the filter's sharp end at half the rate stands in the ADEV alone.
  const double h1 = 4 * std::numbers::pi * kSigma * kSigma;
  const double modified = 3 * std::log(256.0 / 27) * h1 / (8 * std::numbers::pi * std::numbers::pi);
  expect_power_law(mean_deviation(noise, Deviation::kMdev), -1, std::sqrt(modified));
  expect_power_law(mean_deviation(noise, Deviation::kTdev), 0, std::sqrt(modified / 3));
}

TEST(StabilityOfNoise, WhiteFrequency) {
  const auto noise = [](std::uint32_t seed) { return sums(white(seed)); };
  expect_power_law(mean_deviation(noise, Deviation::kAdev), -0.5, kSigma);
  expect_power_law(mean_deviation(noise, Deviation::kHdev), -0.5, kSigma);
  expect_power_law(mean_deviation(noise, Deviation::kMdev), -0.5, kSigma * std::sqrt(0.5));
  expect_power_law(mean_deviation(noise, Deviation::kTdev), 0.5, kSigma * std::sqrt(0.5 / 3));
}

TEST(StabilityOfNoise, FlickerFrequency) {
  // h_-1 = sigma^2 / pi.
  const double h = kSigma * kSigma / std::numbers::pi;
  const auto noise = [](std::uint32_t seed) { return sums(flicker(white(seed))); };
  expect_power_law(mean_deviation(noise, Deviation::kAdev), 0, std::sqrt(2 * std::log(2) * h));
  expect_power_law(mean_deviation(noise, Deviation::kMdev), 0,
                   std::sqrt(h * (27 * std::log(3) - 32 * std::log(2)) / 8));
  expect_power_law(mean_deviation(noise, Deviation::kHdev), 0,
                   std::sqrt(h * std::log(256.0 / 27) / 2));
}

TEST(StabilityOfNoise, RandomWalkFrequency) {
  const auto noise = [](std::uint32_t seed) { return sums(sums(white(seed))); };
  expect_power_law(mean_deviation(noise, Deviation::kAdev), 0.5, kSigma / std::sqrt(3));
  expect_power_law(mean_deviation(noise, Deviation::kMdev), 0.5, kSigma * std::sqrt(11.0 / 40));
  expect_power_law(mean_deviation(noise, Deviation::kHdev), 0.5, kSigma / std::sqrt(6));
}

}  // namespace
}  // namespace simbench::evaluation
