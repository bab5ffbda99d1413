#include <algorithm>
#include <cstdint>
#include <deque>
#include <optional>

#include "algorithms/device_time/poll_estimators.h"
#include "algorithms/registry.h"
#include "laws/line_fit.h"

namespace simbench {
namespace {

constexpr std::size_t kWindow = 16;
constexpr std::size_t kFullFor = 15;  // polls at the slow cadence from this many on
constexpr std::int64_t kFastNs = 95'000'000;
constexpr std::int64_t kSlowNs = 950'000'000;
constexpr std::int64_t kFirstHalfRoundTripNs = 1'000'000'000;
constexpr double kBlendUs = 1'000'000;

// The line in use: offset in ns over device time in us, blended from one line to the next.
class BlendedLine {
 public:
  void start(double level_ns) { from_ = to_ = {.slope = 0, .level_ns = level_ns}; }

  // The change begins at `x`, from what is in use there.
  void move_to(double slope, double level_ns, std::int64_t x) {
    from_ = in_use(x);
    to_ = {.slope = slope, .level_ns = level_ns};
    since_ = x;
  }

  double at(std::int64_t x) const {
    const Coefficients line = in_use(x);
    return line.level_ns + line.slope * static_cast<double>(x);
  }

 private:
  struct Coefficients {
    double slope = 0;
    double level_ns = 0;
  };

  Coefficients in_use(std::int64_t x) const {
    const double part = std::clamp(static_cast<double>(x - since_) / kBlendUs, 0.0, 1.0);
    return {.slope = part * to_.slope + (1 - part) * from_.slope,
            .level_ns = part * to_.level_ns + (1 - part) * from_.level_ns};
  }

  Coefficients from_;
  Coefficients to_;
  std::int64_t since_ = 0;
};

class LibrealsenseGlobal final : public DeviceTimeEstimator {
 public:
  bool from_first_frame() const override { return true; }

  void on_poll(const PollSample& poll) override {
    if (!is_due(poll.t0)) return;
    const PollStream::Poll kind = polls_.push(poll);
    if (kind == PollStream::Poll::kLeftOut) return;
    polled_ = poll.t0;
    if (kind == PollStream::Poll::kFirst) samples_.clear();
    note_round_trip(polls_.round_trip_ns() / 2);
    if (samples_.size() == kWindow) samples_.pop_front();
    const LinePoint end = polls_.end();
    samples_.push_back({.x = end.x, .y = end.y - half_round_trip_ns_});
    fit();
  }

  GlobalTime stamp(const DeviceSample& sample) override {
    return polls_.stamp(sample, [this](std::int64_t x) {
      last_frame_ = x;
      return line_.at(x);
    });
  }

 private:
  // A poll is due at once after the host clock was set back.
  bool is_due(HostTime t0) const {
    if (!polled_) return true;
    const Int128 since_ns = Int128{nanoseconds_of(t0)} - nanoseconds_of(*polled_);
    return since_ns < 0 || since_ns >= (samples_.size() < kFullFor ? kFastNs : kSlowNs);
  }

  void note_round_trip(std::int64_t half_ns) {
    if (half_ns >= half_round_trip_ns_) return;
    for (LinePoint& sample : samples_) sample.y += half_ns - half_round_trip_ns_;
    half_round_trip_ns_ = half_ns;
  }

  void fit() {
    LineSums sums(kWindow);
    for (const LinePoint& sample : samples_) sums.add(sample);
    const Line line = sums.line();
    if (samples_.size() == 1) {
      last_frame_ = samples_.front().x;
      line_.start(line.at(0));
    }
    line_.move_to(line.slope, line.at(0), last_frame_);
  }

  PollStream polls_;
  std::optional<HostTime> polled_;
  std::int64_t half_round_trip_ns_ = kFirstHalfRoundTripNs;
  std::deque<LinePoint> samples_;
  BlendedLine line_;
  std::int64_t last_frame_ = 0;
};

}  // namespace

std::unique_ptr<DeviceTimeEstimator> make_librealsense_global() {
  return std::make_unique<LibrealsenseGlobal>();
}

std::vector<DeviceTimeEntry> device_time_librealsense_global() {
  return {
      {.info =
           {.name = "librealsense_global",
            .family = "librealsense_global",
            .summary = "librealsense's global time over polls of the camera's clock",
            .source =
                "librealsense src/global_timestamp_reader.cpp; docs/reference/d455.md section 5",
            .needs = {Need::kPolls}},
       .make = [](const Parameters&) { return make_librealsense_global(); }}};
}

}  // namespace simbench
