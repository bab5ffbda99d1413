#include "evaluation/diagnosis/clock_explanation.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <utility>
#include <vector>

namespace simbench::evaluation {
namespace {

constexpr std::size_t kFewestBins = 12;
constexpr double kFramesOfBin = 10;
constexpr std::size_t kJackknifeBlocks = 10;
constexpr double kCoefficientTail = 0.025;   // of a 95 % interval
constexpr double kMedianDeviation = 1.2533;  // of a median of many, times the root of their number

struct SlowPart {
  std::vector<double> time_s;
  std::vector<double> delay_ms;
  std::vector<double> error_ms;
  double frames_of_bin = 0;
};

SlowPart slow_part(const CameraDelays& delays, double interval_s, const ErrorOfClock& error_s) {
  struct Bin {
    std::vector<double> time_s;
    std::vector<double> delay_ms;
    std::vector<double> error_ms;
  };
  const double width_s = std::max(interval_s, kFramesOfBin * 1e-3 * delays.period_ms);
  std::map<double, Bin> bins;
  for (std::size_t i = 0; i < delays.arrival_s.size(); ++i) {
    const double error_ms = 1e3 * error_s(delays.arrival_s[i]);
    if (std::isnan(error_ms)) continue;
    const double since_s = delays.arrival_s[i] - delays.first_s();
    Bin& bin = bins[std::floor(since_s / width_s)];
    bin.time_s.push_back(since_s);
    bin.delay_ms.push_back(delays.delay_ms[i]);
    bin.error_ms.push_back(error_ms);
  }
  SlowPart slow;
  std::vector<double> sizes;
  for (auto& [number, bin] : bins) {
    if (static_cast<double>(bin.time_s.size()) < kFramesOfBin / 2) continue;
    sizes.push_back(static_cast<double>(bin.time_s.size()));
    slow.time_s.push_back(mean_of(bin.time_s));
    slow.delay_ms.push_back(median(std::move(bin.delay_ms)));
    slow.error_ms.push_back(median(std::move(bin.error_ms)));
  }
  slow.frames_of_bin = median(std::move(sizes));
  return slow;
}

std::vector<double> without_its_line(std::span<const double> x, std::span<const double> y) {
  const FittedLine line = fit_line(x, y);
  std::vector<double> rest;
  for (std::size_t i = 0; i < x.size(); ++i) rest.push_back(y[i] - line.at(x[i]));
  return rest;
}

double coefficient_of(const SlowPart& slow) {
  const std::vector<double> delay_ms = without_its_line(slow.time_s, slow.delay_ms);
  const std::vector<double> error_ms = without_its_line(slow.time_s, slow.error_ms);
  double product = 0;
  double square = 0;
  for (std::size_t i = 0; i < delay_ms.size(); ++i) {
    product += delay_ms[i] * error_ms[i];
    square += error_ms[i] * error_ms[i];
  }
  return square > 0 ? product / square : kNan;
}

SlowPart without_bins(const SlowPart& slow, std::size_t begin, std::size_t end) {
  SlowPart rest;
  for (std::size_t i = 0; i < slow.time_s.size(); ++i) {
    if (i >= begin && i < end) continue;
    rest.time_s.push_back(slow.time_s[i]);
    rest.delay_ms.push_back(slow.delay_ms[i]);
    rest.error_ms.push_back(slow.error_ms[i]);
  }
  return rest;
}

void note_coefficient(const SlowPart& slow, ClockExplanation& found) {
  found.coefficient = coefficient_of(slow);
  std::vector<double> left_out;
  for (std::size_t block = 0; block < kJackknifeBlocks; ++block) {
    const std::size_t begin = block * slow.time_s.size() / kJackknifeBlocks;
    const std::size_t end = (block + 1) * slow.time_s.size() / kJackknifeBlocks;
    left_out.push_back(coefficient_of(without_bins(slow, begin, end)));
  }
  const auto blocks = static_cast<double>(kJackknifeBlocks);
  const double deviation = standard_deviation(left_out) * (blocks - 1) / std::sqrt(blocks);
  const double half = student_t_exceeded(kCoefficientTail, blocks - 1) * deviation;
  found.coefficient_low = found.coefficient - half;
  found.coefficient_high = found.coefficient + half;
}

}  // namespace

ClockExplanation explained_by(const CameraDelays& delays, double interval_s,
                              const ErrorOfClock& error_s) {
  const SlowPart slow = slow_part(delays, interval_s, error_s);
  ClockExplanation found{.camera = delays.camera,
                         .host = delays.host,
                         .stream = delays.stream,
                         .bins = slow.time_s.size()};
  if (found.bins < kFewestBins) return found;
  std::vector<double> rest_ms;
  for (std::size_t i = 0; i < found.bins; ++i) {
    rest_ms.push_back(slow.delay_ms[i] - slow.error_ms[i]);
  }
  found.before_ms = standard_deviation(without_its_line(slow.time_s, slow.delay_ms));
  found.after_ms = standard_deviation(without_its_line(slow.time_s, rest_ms));
  found.noise_ms = kMedianDeviation * delays.noise_ms / std::sqrt(slow.frames_of_bin);
  const double ratio = found.after_ms / found.before_ms;
  if (found.before_ms > 0) found.share = 1 - ratio * ratio;
  note_coefficient(slow, found);
  return found;
}

}  // namespace simbench::evaluation
