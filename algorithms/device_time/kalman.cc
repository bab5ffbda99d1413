#include "algorithms/device_time/kalman.h"

#include <algorithm>

#include "algorithms/device_time/offset_stream.h"

namespace simbench {
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

  // False, and nothing learned, if the gate rejects the measurement.
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

class Kalman final : public DeviceTimeEstimator {
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

}  // namespace simbench
