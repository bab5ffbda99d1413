#include "algorithms/device_time/sliding_minimum.h"

#include <deque>

#include "algorithms/device_time/offset_stream.h"

namespace simbench {
namespace {

constexpr std::size_t kMaxQueued = 4096;

class SlidingMinimum final : public DeviceTimeEstimator {
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

}  // namespace simbench
