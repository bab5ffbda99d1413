#include "algorithms/device_time/offset_filters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "algorithms/device_time/estimator_bank.h"
#include "algorithms/device_time/offset_stream.h"
#include "algorithms/ports/assert.h"
#include "algorithms/registry.h"
#include "laws/lower_hull.h"
#include "laws/median.h"

namespace simbench {
namespace {

class Olson final : public Banked<Olson> {
 public:
  explicit Olson(OlsonSettings settings)
      : leak_({.touches = {}, .slope = settings.alpha_ppm * 1e-3}) {}

  GlobalTime stamp(const DeviceSample& sample) override {
    const OffsetStream::Sample kind = stream_.push(sample);
    const LinePoint point = stream_.point();
    if (kind == OffsetStream::Sample::kFirst ||
        (kind == OffsetStream::Sample::kNext &&
         leak_.at(point.x) >= static_cast<double>(point.y))) {
      leak_.touches = point;
    }
    return stream_.stamp(leak_.at(point.x));
  }

 private:
  OffsetStream stream_;
  SupportLine leak_;  // from (p, q) on
};

}  // namespace

std::unique_ptr<DeviceTimeEstimator> make_olson(OlsonSettings settings) {
  return std::make_unique<Olson>(settings);
}

namespace {

constexpr std::size_t kMaxQueued = 4096;

class SlidingMinimum final : public Banked<SlidingMinimum> {
 public:
  explicit SlidingMinimum(SlidingMinimumSettings settings)
      : window_us_(saturate_round(settings.window_s * 1e6)) {}

  GlobalTime stamp(const DeviceSample& sample) override {
    const OffsetStream::Sample kind = stream_.push(sample);
    if (kind == OffsetStream::Sample::kFirst) queue_.clear();
    if (kind != OffsetStream::Sample::kLate) add(stream_.point());
    return stream_.stamp(static_cast<double>(queue_.front().y));
  }

 private:
  void add(LinePoint point) {
    while (!queue_.empty() && queue_.back().y >= point.y) queue_.pop_back();
    if (queue_.size() == kMaxQueued) queue_.pop_back();
    queue_.push_back(point);
    while (queue_.front().x <= point.x - window_us_) queue_.pop_front();
  }

  std::int64_t window_us_;
  OffsetStream stream_;
  std::deque<LinePoint> queue_;  // x and y increase
};

}  // namespace

std::unique_ptr<DeviceTimeEstimator> make_sliding_minimum(SlidingMinimumSettings settings) {
  return std::make_unique<SlidingMinimum>(settings);
}

namespace {

// The median of many values of which some change at a time: counts them in bins over their middle
// range, and selects only in the bin of the median. The result is that of median_in_place().
class ChangingMedian {
 public:
  void reserve(std::size_t count) {
    values_.reserve(count);
    bins_.reserve(count);
  }
  void clear() {
    values_.clear();
    bins_.clear();
    counts_.fill(0);
  }

  void push_back(double value) {
    values_.push_back(value);
    bins_.push_back(bin_of(value));
    ++counts_[bins_.back()];
  }
  void replace(std::size_t index, double value) {
    values_[index] = value;
    --counts_[bins_[index]];
    bins_[index] = bin_of(value);
    ++counts_[bins_[index]];
  }

  // At least one value.
  double median() {
    const std::size_t middle = values_.size() / 2;
    const std::size_t first = middle - (values_.size() % 2 == 0 ? 1 : 0);
    if (++since_spread_ >= kLeastBetween && selected_.size() > values_.size() / kFewParts) spread();
    std::size_t low = 0;
    std::size_t below = 0;  // values in bins before `low`
    while (below + counts_[low] <= first) below += counts_[low++];
    std::size_t high = low;
    for (std::size_t up_to = below + counts_[low]; up_to <= middle;) up_to += counts_[++high];
    select(static_cast<std::uint16_t>(low), static_cast<std::uint16_t>(high - low));
    const auto at = selected_.begin() + static_cast<std::ptrdiff_t>(middle - below);
    std::nth_element(selected_.begin(), at, selected_.end());
    return first == middle ? *at : (*std::max_element(selected_.begin(), at) + *at) / 2;
  }

 private:
  static constexpr std::size_t kBins = 1024;
  static constexpr std::size_t kFewParts = 64;     // so small a part of the values is few
  static constexpr std::size_t kLeastBetween = 8;  // medians between two spreads: ties stay many

  std::uint16_t bin_of(double value) const {
    return static_cast<std::uint16_t>(
        std::clamp((value - begin_) * bins_per_unit_, 0.0, static_cast<double>(kBins - 1)));
  }

  // Selects the values in bins from `low` to `low` + `further`: few, so most blocks have none.
  void select(std::uint16_t low, std::uint16_t further) {
    constexpr std::size_t kBlock = 64;
    const auto is_wanted = [low, further](std::uint16_t bin) {
      return static_cast<std::uint16_t>(bin - low) <= further;
    };
    selected_.clear();
    std::size_t begin = 0;
    for (; begin + kBlock <= bins_.size(); begin += kBlock) {
      std::uint16_t any = 0;
      for (std::size_t i = 0; i < kBlock; ++i) {
        any = static_cast<std::uint16_t>(any | (is_wanted(bins_[begin + i]) ? 1 : 0));
      }
      if (any == 0) continue;
      for (std::size_t i = begin; i < begin + kBlock; ++i) {
        if (is_wanted(bins_[i])) selected_.push_back(values_[i]);
      }
    }
    for (; begin < bins_.size(); ++begin) {
      if (is_wanted(bins_[begin])) selected_.push_back(values_[begin]);
    }
  }

  // Spreads the bins from the lowest to the highest eighth of the values.
  void spread() {
    since_spread_ = 0;
    selected_ = values_;
    const auto eighth = static_cast<std::ptrdiff_t>(selected_.size() / 8);
    const auto low = selected_.begin() + eighth;
    const auto high = selected_.end() - 1 - eighth;
    std::nth_element(selected_.begin(), low, selected_.end());
    std::nth_element(low, high, selected_.end());
    begin_ = *low;
    bins_per_unit_ = static_cast<double>(kBins) / (*high - *low);
    if (!std::isfinite(bins_per_unit_)) bins_per_unit_ = 0;
    counts_.fill(0);
    for (std::size_t i = 0; i < values_.size(); ++i) {
      bins_[i] = bin_of(values_[i]);
      ++counts_[bins_[i]];
    }
  }

  std::vector<double> values_;
  std::vector<std::uint16_t> bins_;  // of each value
  std::array<std::uint32_t, kBins> counts_{};
  std::vector<double> selected_;
  std::size_t since_spread_ = 0;
  double begin_ = 0;
  double bins_per_unit_ = 0;  // 0: all in the first bin
};

class TheilSen final : public DeviceTimeEstimator {
 public:
  explicit TheilSen(TheilSenWindow window) : frames_(window.frames) {
    points_.reserve(frames_);
    values_.reserve(frames_);
    slopes_.reserve(frames_ * (frames_ - 1) / 2);
  }

  GlobalTime stamp(const DeviceSample& sample) override {
    const OffsetStream::Sample kind = stream_.push(sample);
    if (kind == OffsetStream::Sample::kFirst) {
      points_.clear();
      slopes_.clear();
      oldest_ = 0;
      replaced_ = 0;
    }
    if (kind != OffsetStream::Sample::kLate) add(stream_.point());
    return stream_.stamp(level_ + slope_ * from_origin(stream_.point().x));
  }

 private:
  void add(LinePoint point) {
    if (points_.size() < frames_) {
      for (const LinePoint& other : points_) slopes_.push_back(slope_between(other, point));
      points_.push_back(point);
    } else {
      points_[oldest_] = point;
      oldest_ = (oldest_ + 1) % frames_;
      ++replaced_;
    }
    if (points_.size() == 1 || ++since_refit_ >= points_.size() / 20) refit(point.x);
  }

  // The slopes of the points that were replaced since the last refit: row after row, a point's with
  // those before it in the ring.
  void renew_slopes() {
    const auto is_new = [this](std::size_t place) {
      return (oldest_ + frames_ - 1 - place) % frames_ < replaced_;
    };
    renewed_.clear();
    for (std::size_t place = 0; place < points_.size(); ++place) {
      if (is_new(place)) renewed_.push_back(place);
    }
    std::size_t row = 0;  // of a place: the number of its slope with the first
    for (std::size_t place = 1; place < points_.size(); row += place++) {
      const auto renew = [&](std::size_t before) {
        slopes_.replace(row + before, slope_between(points_[before], points_[place]));
      };
      if (is_new(place)) {
        for (std::size_t before = 0; before < place; ++before) renew(before);
      } else {
        for (const std::size_t before : renewed_) {
          if (before < place) renew(before);
        }
      }
    }
    replaced_ = 0;
  }

  // The line through the points, with its level at `origin`.
  void refit(std::int64_t origin) {
    since_refit_ = 0;
    if (replaced_ > 0) renew_slopes();
    origin_ = origin;
    slope_ = points_.size() > 1 ? slopes_.median() : 0;
    values_.clear();
    for (const LinePoint& point : points_) {
      values_.push_back(static_cast<double>(point.y) - slope_ * from_origin(point.x));
    }
    level_ = median_in_place(values_);
  }

  double from_origin(std::int64_t x) const { return static_cast<double>(x - origin_); }

  std::size_t frames_;
  OffsetStream stream_;
  std::vector<LinePoint> points_;  // a ring once it is full; all x differ
  std::size_t oldest_ = 0;
  std::size_t since_refit_ = 0;
  std::size_t replaced_ = 0;  // points whose slopes are not renewed, the newest ones
  ChangingMedian slopes_;     // between each two points
  std::vector<std::size_t> renewed_;
  std::vector<double> values_;
  std::int64_t origin_ = 0;
  double slope_ = 0;
  double level_ = 0;
};

}  // namespace

std::unique_ptr<DeviceTimeEstimator> make_theil_sen(TheilSenWindow window) {
  SIMBENCH_ASSERT(window.frames >= 1 && window.frames <= 10'000, "a window of a few frames");
  return std::make_unique<TheilSen>(window);
}

namespace {

double squared(double value) { return value * value; }

// Offset in us, time in s, so skew in ppm.
class Filter {
 public:
  explicit Filter(const KalmanSettings& settings) : settings_(settings) {}

  void start(double time_s, double offset_us) {
    time_s_ = time_s;
    offset_us_ = offset_us;
    skew_ppm_ = 0;
    offset_variance_ = squared(1e3 * settings_.initial_offset_sigma_ms);
    covariance_ = 0;
    skew_variance_ = squared(settings_.initial_skew_sigma_ppm);
  }

  double predicted_us(double time_s) const { return offset_us_ + skew_ppm_ * (time_s - time_s_); }

  void advance(double time_s) {
    const double dt = time_s - time_s_;
    offset_us_ = predicted_us(time_s);
    time_s_ = time_s;
    offset_variance_ += dt * (2 * covariance_ + dt * skew_variance_);
    covariance_ += dt * skew_variance_;
    skew_variance_ += dt * squared(settings_.skew_sigma_ppm);
  }

  // False, and no change, if the gate rejects the measurement.
  bool update(double offset_us) {
    const double noise = squared(1e3 * settings_.offset_sigma_ms);
    const double innovation = offset_variance_ + noise;
    const double residual = offset_us - offset_us_;
    if (squared(residual) > squared(settings_.gate) * innovation) return false;
    offset_us_ += offset_variance_ / innovation * residual;
    skew_ppm_ += covariance_ / innovation * residual;
    skew_variance_ = std::max(0.0, skew_variance_ - covariance_ / innovation * covariance_);
    covariance_ *= noise / innovation;
    offset_variance_ *= noise / innovation;
    return true;
  }

 private:
  KalmanSettings settings_;
  double time_s_ = 0;
  double offset_us_ = 0;
  double skew_ppm_ = 0;
  double offset_variance_ = 0;
  double covariance_ = 0;
  double skew_variance_ = 0;
};

class Kalman final : public Banked<Kalman> {
 public:
  explicit Kalman(const KalmanSettings& settings)
      : filter_(settings), rejections_to_restart_(settings.rejections_to_restart) {}

  GlobalTime stamp(const DeviceSample& sample) override {
    const OffsetStream::Sample kind = stream_.push(sample);
    const double time_s = static_cast<double>(stream_.point().x) * 1e-6;
    const double offset_us = static_cast<double>(stream_.point().y) * 1e-3;
    if (kind == OffsetStream::Sample::kFirst) {
      start(time_s, offset_us);
    } else if (kind == OffsetStream::Sample::kNext) {
      filter_.advance(time_s);
      if (filter_.update(offset_us)) {
        rejections_ = 0;
      } else if (++rejections_ >= rejections_to_restart_) {
        start(time_s, offset_us);
      }
    }
    return stream_.stamp(1e3 * filter_.predicted_us(time_s));
  }

 private:
  void start(double time_s, double offset_us) {
    filter_.start(time_s, offset_us);
    rejections_ = 0;
  }

  OffsetStream stream_;
  Filter filter_;
  int rejections_to_restart_;
  int rejections_ = 0;
};

}  // namespace

std::unique_ptr<DeviceTimeEstimator> make_kalman(KalmanSettings settings) {
  return std::make_unique<Kalman>(settings);
}

namespace {

constexpr const char* kSource = "docs/reference/device_time.md section 1";

}  // namespace

void OlsonSettings::bind(ParameterBinder& parameters) {
  parameters.number("alpha_ppm", alpha_ppm, 0, 100'000, "rate of forgetting; must exceed the skew",
                    kSource);
}

void KalmanSettings::bind(ParameterBinder& parameters) {
  parameters.number("initial_offset_sigma_ms", initial_offset_sigma_ms, 1e-3, 1e6,
                    "uncertainty of the first frame's offset", kSource);
  parameters.number("initial_skew_sigma_ppm", initial_skew_sigma_ppm, 1e-3, 1e5,
                    "initial uncertainty of the skew", kSource);
  parameters.number("offset_sigma_ms", offset_sigma_ms, 1e-4, 1e4,
                    "standard deviation of one arrival", kSource);
  parameters.number("skew_sigma_ppm", skew_sigma_ppm, 0, 1e4,
                    "random walk of the skew, per square root of a second", kSource);
  parameters.number("gate", gate, 0.1, 1e6,
                    "frames further off, in standard deviations, are rejected", kSource);
  parameters.number("rejections_to_restart", rejections_to_restart, 1, 1e6,
                    "rejections in a row after which the filter restarts", "ours");
}

std::vector<DeviceTimeEntry> device_time_offset_filters() {
  return {
      with_settings<DeviceTimeEntry>(
          {.name = "olson_50ppm",
           .family = "olson",
           .summary = "least delayed frame, forgotten at 50 ppm (passive synchronisation)",
           .source = "Olson, IROS 2010; docs/reference/device_time.md section 1"},
          OlsonSettings{}, make_olson),
      {.info = {.name = "minimum_1s",
                .family = "minimum",
                .summary = "least offset of the last second: the best of the simple ones",
                .source = kSource},
       .make = [](const Parameters&) { return make_sliding_minimum({.window_s = 1}); }},
      {.info = {.name = "theil_sen_300",
                .family = "theil_sen",
                .summary = "median of slopes over the last 300 frames, a refit every 15",
                .source = "Sen 1968; docs/reference/device_time.md section 1"},
       .make = [](const Parameters&) { return make_theil_sen({.frames = 300}); }},
      with_settings<DeviceTimeEntry>(
          {.name = "kalman",
           .family = "kalman",
           .summary = "Kalman filter of offset and skew; its gate cannot lock itself out",
           .source =
               "cuckoo_time_translator KalmanOwt, tuned; docs/reference/device_time.md section 1"},
          KalmanSettings{}, make_kalman),
  };
}

}  // namespace simbench
