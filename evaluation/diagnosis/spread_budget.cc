#include "evaluation/diagnosis/spread_budget.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstdint>
#include <numbers>
#include <vector>

namespace simbench::evaluation {
namespace {

constexpr std::size_t kFewestPairs = 160;
constexpr std::size_t kFramesOfBlock = 20;
constexpr std::size_t kMostBlocks = 20;
constexpr double kSpreadTail = 0.025;  // of a 95 % interval

// Frames of both cameras at one pulse, in order of time: what the parts are made of.
struct PairRow {
  std::vector<double> time_s;
  std::vector<double> difference_ms;  // of the arrivals
  std::vector<double> clock_ms;
  std::vector<double> exposure_ms;
  std::vector<double> stamp_ms;
  std::vector<double> delivery_ms;  // arrival minus sensor stamp
};

// A camera's arrivals with its host's clock put right.
struct TrueArrival {
  double at_s = 0;
  double error_s = 0;
  std::size_t frame = 0;
};

std::vector<TrueArrival> true_arrivals(const SpreadSide& side) {
  std::vector<TrueArrival> all;
  for (std::size_t i = 0; i < side.delays.arrival_s.size(); ++i) {
    const double arrival_s = side.delays.arrival_s[i];
    const double error_s = side.error_s ? side.error_s(arrival_s) : 0;
    if (!std::isnan(error_s)) all.push_back({arrival_s - error_s, error_s, i});
  }
  std::ranges::stable_sort(all, {}, &TrueArrival::at_s);
  return all;
}

std::size_t nearest_to(double at_s, const std::vector<TrueArrival>& all) {
  const auto next = std::ranges::lower_bound(all, at_s, {}, &TrueArrival::at_s);
  const auto i = static_cast<std::size_t>(next - all.begin());
  if (i == all.size()) return i - 1;
  return i > 0 && at_s - all[i - 1].at_s < all[i].at_s - at_s ? i - 1 : i;
}

// How much later the camera is than the nearest frame of the other, as most frames have it: the
// mean direction on the circle of a period.
double common_phase_s(const std::vector<TrueArrival>& camera,
                      const std::vector<TrueArrival>& against, double period_s) {
  std::complex<double> sum;
  for (const TrueArrival& frame : camera) {
    const double later_s = frame.at_s - against[nearest_to(frame.at_s, against)].at_s;
    if (std::abs(later_s) < period_s) {
      sum += std::polar(1.0, 2 * std::numbers::pi * later_s / period_s);
    }
  }
  return std::arg(sum) / (2 * std::numbers::pi) * period_s;
}

double exposure_of(const SpreadSide& side, std::size_t frame) {
  const std::size_t recorded = side.delays.left_out + frame;
  return recorded < side.exposures_ms.size() ? side.exposures_ms[recorded] : 0;
}

PairRow paired_frames(const SpreadSide& camera, const SpreadSide& against, double period_ms) {
  PairRow row;
  const std::vector<TrueArrival> ones = true_arrivals(camera);
  const std::vector<TrueArrival> others = true_arrivals(against);
  if (ones.empty() || others.empty()) return row;
  const double period_s = 1e-3 * period_ms;
  const double phase_s = common_phase_s(ones, others, period_s);
  const bool has_exposures = !camera.exposures_ms.empty() && !against.exposures_ms.empty();
  for (const TrueArrival& one : ones) {
    const TrueArrival& other = others[nearest_to(one.at_s - phase_s, others)];
    if (std::abs(one.at_s - phase_s - other.at_s) > period_s / 2) continue;
    const double exposure_ms =
        has_exposures ? exposure_of(camera, one.frame) - exposure_of(against, other.frame) : 0;
    const double clock_ms = 1e3 * (one.error_s - other.error_s);
    const double delivery_ms =
        camera.delays.delay_ms[one.frame] - against.delays.delay_ms[other.frame];
    const double stamp_ms =
        camera.delays.sensor_ms[one.frame] - against.delays.sensor_ms[other.frame];
    // A host that stamps its frames has its clock in the stamps, not in the delay behind them.
    const double in_stamp_ms = (camera.delays.stamped_by_host ? 1e3 * one.error_s : 0) -
                               (against.delays.stamped_by_host ? 1e3 * other.error_s : 0);
    row.time_s.push_back(other.at_s - others.front().at_s);
    row.difference_ms.push_back(1e3 * (one.at_s - other.at_s) + clock_ms);
    row.clock_ms.push_back(clock_ms);
    row.exposure_ms.push_back(exposure_ms);
    row.stamp_ms.push_back(stamp_ms - in_stamp_ms);
    row.delivery_ms.push_back(delivery_ms - (clock_ms - in_stamp_ms) - exposure_ms);
  }
  return row;
}

// Mean squares of a part by block, and its mean product with the difference.
struct PartSums {
  std::vector<double> squares;
  double product = 0;

  SpreadPart part(double total_square) const {
    const auto blocks = static_cast<double>(squares.size());
    const double mean = mean_of(squares);
    const double half = student_t_exceeded(kSpreadTail, blocks - 1) * standard_deviation(squares) /
                        std::sqrt(blocks);
    return {.rms_ms = std::sqrt(std::max(0.0, mean)),
            .low_ms = std::sqrt(std::max(0.0, mean - half)),
            .high_ms = std::sqrt(std::max(0.0, mean + half)),
            .share = product / blocks / total_square};
  }
};

double mean_product(std::span<const double> a, std::span<const double> b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum / static_cast<double>(a.size());
}

std::vector<double> about_its_line(std::span<const double> x, std::span<const double> y) {
  const FittedLine line = fit_line(x, y);
  std::vector<double> rest;
  for (std::size_t i = 0; i < x.size(); ++i) rest.push_back(y[i] - line.at(x[i]));
  return rest;
}

class PairAccount {
 public:
  explicit PairAccount(const PairRow& row) : row_(row) {
    blocks_ = std::min(kMostBlocks, row.time_s.size() / kFramesOfBlock);
    for (std::size_t block = 0; block < blocks_; ++block) take(block);
  }

  std::size_t blocks() const { return blocks_; }

  void note(SpreadBudget& budget) {
    const double constant_ms = mean_of(slow_means_);
    for (std::size_t block = 0; block < blocks_; ++block) {
      const double moves_ms = slow_means_[block] - constant_ms;
      const double square = slow_squares_[block] + moves_ms * moves_ms - noise_squares_[block];
      rest_.squares.push_back(square);
      rest_.product += slow_products_[block] - constant_ms * difference_means_[block];
    }
    const double total_square = mean_of(total_.squares);
    const auto blocks = static_cast<double>(blocks_);
    const double half = student_t_exceeded(kSpreadTail, blocks - 1) *
                        standard_deviation(slow_means_) / std::sqrt(blocks);
    const double size_ms = std::abs(constant_ms);
    budget.constant_ms = constant_ms;
    budget.constant = {.rms_ms = size_ms,
                       .low_ms = std::max(0.0, size_ms - half),
                       .high_ms = size_ms + half,
                       .share = constant_ms * mean_of(difference_means_) / total_square};
    budget.total = total_.part(total_square);
    budget.exposure = exposure_.part(total_square);
    budget.stamp = stamp_.part(total_square);
    budget.delivery = delivery_.part(total_square);
    budget.host_clock = clock_.part(total_square);
    budget.unexplained = rest_.part(total_square);
  }

 private:
  void add(PartSums& part, std::span<const double> values, std::span<const double> difference,
           double lost_freedom = 0) {
    const auto size = static_cast<double>(values.size());
    part.squares.push_back(mean_product(values, values) * size / (size - lost_freedom));
    part.product += mean_product(values, difference);
  }

  void take(std::size_t block) {
    const std::size_t begin = block * row_.time_s.size() / blocks_;
    const std::size_t end = (block + 1) * row_.time_s.size() / blocks_;
    const auto of = [&](const std::vector<double>& values) {
      return std::span(values).subspan(begin, end - begin);
    };
    const std::span<const double> time_s = of(row_.time_s);
    const std::span<const double> difference = of(row_.difference_ms);
    const std::vector<double> stamp = about_its_line(time_s, of(row_.stamp_ms));
    const std::vector<double> delivery = about_its_line(time_s, of(row_.delivery_ms));
    add(total_, difference, difference);
    add(exposure_, of(row_.exposure_ms), difference);
    add(clock_, of(row_.clock_ms), difference);
    // A line takes two degrees of freedom from them.
    add(stamp_, stamp, difference, 2);
    add(delivery_, delivery, difference, 2);
    std::vector<double> slow;
    std::vector<double> fast;
    for (std::size_t i = 0; i < time_s.size(); ++i) {
      fast.push_back(stamp[i] + delivery[i]);
      slow.push_back(difference[i] - row_.clock_ms[begin + i] - row_.exposure_ms[begin + i] -
                     fast[i]);
    }
    note_slow(slow, fast, difference);
  }

  // What is left in a block is a line. The noise of the others has a part in that, too.
  void note_slow(std::span<const double> slow, std::span<const double> fast,
                 std::span<const double> difference) {
    const auto size = static_cast<double>(slow.size());
    const double mean_ms = mean_of(slow);
    slow_means_.push_back(mean_ms);
    slow_squares_.push_back(mean_product(slow, slow) - mean_ms * mean_ms);
    noise_squares_.push_back(2 * mean_product(fast, fast) / (size - 2));
    slow_products_.push_back(mean_product(slow, difference));
    difference_means_.push_back(mean_of(difference));
  }

  const PairRow& row_;
  std::size_t blocks_ = 0;
  PartSums total_, exposure_, clock_, stamp_, delivery_, rest_;
  std::vector<double> slow_means_, slow_squares_, slow_products_;
  std::vector<double> noise_squares_, difference_means_;
};

}  // namespace

std::optional<SpreadBudget> spread_budget(const SpreadSide& camera, const SpreadSide& against) {
  const CameraDelays& one = camera.delays;
  const CameraDelays& other = against.delays;
  // The one of half the rate has every second pulse.
  const double period_ms = std::min(one.period_ms, other.period_ms);
  const PairRow row = paired_frames(camera, against, period_ms);
  const std::size_t fewer = std::min(one.arrival_s.size(), other.arrival_s.size());
  if (row.time_s.size() < std::max(kFewestPairs, fewer / 2)) return std::nullopt;
  SpreadBudget budget{.camera = one.camera,
                      .host = one.host,
                      .against = other.camera,
                      .host_against = other.host,
                      .stream = one.stream,
                      .pairs = row.time_s.size(),
                      .period_ms = period_ms};
  PairAccount account(row);
  account.note(budget);
  budget.block_s = (row.time_s.back() - row.time_s.front()) / static_cast<double>(account.blocks());
  const bool by_cameras = !one.stamped_by_host && !other.stamped_by_host;
  if (by_cameras && one.stamp_ms && other.stamp_ms) {
    budget.stamps_apart_ms = mean_of(row.stamp_ms) + (*one.stamp_ms - *other.stamp_ms);
  }
  const bool same_host = one.host == other.host;
  if (!same_host && (!camera.error_s || !against.error_s)) budget.host_clock = {};
  if (camera.exposures_ms.empty() || against.exposures_ms.empty()) budget.exposure = {};
  return budget;
}

}  // namespace simbench::evaluation
