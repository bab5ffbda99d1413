#include "algorithms/device_time/theil_sen.h"

#include <algorithm>
#include <vector>

#include "algorithms/device_time/offset_stream.h"
#include "algorithms/ports/assert.h"

namespace simbench {
namespace {

// Reorders the values, of which there is one at least; the mean of the middle two if even.
double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return (*std::max_element(values.begin(), middle) + *middle) / 2;
}

class TheilSen final : public DeviceTimeEstimator {
 public:
  explicit TheilSen(TheilSenWindow window) : frames_(window.frames) {
    points_.reserve(frames_);
    values_.reserve(frames_ * (frames_ + 1) / 2);
  }

  GlobalTime stamp(const DeviceSample& sample) override {
    const OffsetStream::Sample kind = stream_.push(sample);
    if (kind == OffsetStream::Sample::kFirst) {
      points_.clear();
      oldest_ = 0;
    }
    if (kind != OffsetStream::Sample::kLate) add(stream_.point());
    return stream_.stamp(level_ + slope_ * from_origin(stream_.point().x));
  }

 private:
  void add(LinePoint point) {
    if (points_.size() < frames_) {
      points_.push_back(point);
    } else {
      points_[oldest_] = point;
      oldest_ = (oldest_ + 1) % frames_;
    }
    if (points_.size() == 1 || ++since_refit_ >= points_.size() / 20) refit(point.x);
  }

  // The line through the points, with its level at `origin`.
  void refit(std::int64_t origin) {
    since_refit_ = 0;
    origin_ = origin;
    slope_ = 0;
    if (points_.size() > 1) {
      values_.clear();
      for (std::size_t i = 1; i < points_.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
          values_.push_back(static_cast<double>(points_[i].y - points_[j].y) /
                            static_cast<double>(points_[i].x - points_[j].x));
        }
      }
      slope_ = median(values_);
    }
    values_.clear();
    for (const LinePoint& point : points_) {
      values_.push_back(static_cast<double>(point.y) - slope_ * from_origin(point.x));
    }
    level_ = median(values_);
  }

  double from_origin(std::int64_t x) const { return static_cast<double>(x - origin_); }

  std::size_t frames_;
  OffsetStream stream_;
  std::vector<LinePoint> points_;  // a ring once it is full; all x differ
  std::size_t oldest_ = 0;
  std::size_t since_refit_ = 0;
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

}  // namespace simbench
