#include "algorithms/device_time/equation1.h"

#include <algorithm>
#include <optional>

#include "algorithms/device_time/line_fit.h"
#include "algorithms/device_time/saturate.h"

namespace simbench {
namespace {

constexpr double kLargestCorrectionNs = 1e17;

GlobalTime corrected(HostTime arrival, double correction_ns) {
  const double limited = std::clamp(correction_ns, -kLargestCorrectionNs, kLargestCorrectionNs);
  return GlobalTime(
      Nanoseconds(saturate(Int128{nanoseconds_of(arrival)} + saturate_round(limited))));
}

class Equation1 final : public DeviceTimeEstimator {
 public:
  Equation1(Equation1Reading reading, std::size_t intervals)
      : reading_(reading), window_(intervals) {}

  GlobalTime stamp(const DeviceSample& sample) override {
    if (!previous_) {
      previous_ = sample;
      return GlobalTime(sample.arrival.time_since_epoch());
    }
    const DeviceSample previous = *previous_;
    previous_ = sample;
    const Int128 dx_us = Int128{sample.sensor.time_since_epoch().count()} -
                         previous.sensor.time_since_epoch().count();
    const Int128 dy_ns = Int128{nanoseconds_of(sample.arrival)} - nanoseconds_of(previous.arrival);
    // Fitted is dy - dx over dx: the same line, less its slope of one.
    const std::int64_t x = saturate(dx_us);
    window_.push({.x = x, .y = saturate(dy_ns - 1000 * dx_us)});
    const Line line = window_.line();
    const double dx_ns = 1000 * static_cast<double>(x);
    switch (reading_) {
      case Equation1Reading::kPrinted:
        return corrected(sample.arrival, printed_correction_ns(line, dx_ns));
      case Equation1Reading::kIntervalPrevious:
        return corrected(previous.arrival, dx_ns + line.at(x));
      case Equation1Reading::kIntervalCurrent:
        break;
    }
    return corrected(sample.arrival, dx_ns + line.at(x));
  }

 private:
  // The product of two times plus a bare number: its value depends on the unit, which is the
  // milliseconds of the SDK's stamps.
  static double printed_correction_ns(const Line& line, double dx_ns) {
    const double intercept_ms = line.at(0) * 1e-6;
    const double slope = 1 + line.slope * 1e-3;  // ns per us, so per 1000
    return (intercept_ms * (dx_ns * 1e-6) + slope) * 1e6;
  }

  Equation1Reading reading_;
  LineWindow window_;
  std::optional<DeviceSample> previous_;
};

}  // namespace

std::unique_ptr<DeviceTimeEstimator> make_equation1(Equation1Reading reading,
                                                    std::size_t intervals) {
  return std::make_unique<Equation1>(reading, intervals);
}

}  // namespace simbench
