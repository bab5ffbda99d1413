// Series of time errors: power-law noise with known deviations, and a published one.
#pragma once

#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "evaluation/stability/time_error.h"

namespace simbench::evaluation {

inline TimeErrorSeries series_of(std::vector<double> x_s, double interval_s = 1) {
  return {.interval_s = interval_s, .pieces = {{.start_s = 0, .x_s = std::move(x_s)}}};
}

inline std::vector<double> white_noise(std::uint32_t seed, std::size_t points, double sigma) {
  boost::random::mt19937 random(seed);
  boost::random::normal_distribution<double> normal(0, sigma);
  std::vector<double> noise(points);
  for (double& value : noise) value = normal(random);
  return noise;
}

inline std::vector<double> sums(std::vector<double> noise) {
  double sum = 0;
  for (double& value : noise) value = sum += value;
  return noise;
}

// Power over frequency: white noise behind the filter (1 - 1/z)^(-1/2). Source: Kasdin 1995,
// "Discrete simulation of colored noise", Proc. IEEE 83(5).
inline std::vector<double> flicker(const std::vector<double>& white) {
  std::vector<double> response = {1};
  for (std::size_t k = 1; k < white.size(); ++k) {
    const auto order = static_cast<double>(k);
    response.push_back(response.back() * (order - 0.5) / order);
  }
  std::vector<double> output(white.size());
  for (std::size_t i = 0; i < white.size(); ++i) {
    for (std::size_t k = 0; k <= i; ++k) output[i] += response[k] * white[i - k];
  }
  return output;
}

// The 1000 fractional frequencies of NIST SP 1065, section 12.4, as 1001 time errors.
inline std::vector<double> nist_series() {
  std::vector<double> x = {0};
  std::uint64_t n = 1'234'567'890;
  for (int i = 0; i < 1000; ++i) {
    x.push_back(x.back() + static_cast<double>(n) / 2'147'483'647);
    n = n * 16'807 % 2'147'483'647;
  }
  return x;
}

}  // namespace simbench::evaluation
