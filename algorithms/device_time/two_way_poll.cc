#include "algorithms/device_time/hull.h"
#include "algorithms/device_time/poll_estimators.h"
#include "algorithms/ports/assert.h"
#include "algorithms/registry.h"
#include "laws/lower_hull.h"

namespace simbench {
namespace {

class TwoWayPoll final : public DeviceTimeEstimator {
 public:
  explicit TwoWayPoll(TwoWayPollSettings settings)
      : window_us_(saturate_round(settings.window_s * 1e6)),
        max_slope_(settings.max_skew_ppm * 1e-3),
        upper_bounds_(TwoWayPollSettings::kMaxPolls),
        negated_lower_bounds_(TwoWayPollSettings::kMaxPolls) {}

  bool from_first_frame() const override { return true; }

  void on_poll(const PollSample& poll) override {
    const PollStream::Poll kind = polls_.push(poll);
    if (kind == PollStream::Poll::kLeftOut) return;
    if (kind == PollStream::Poll::kFirst) {
      upper_bounds_.clear();
      negated_lower_bounds_.clear();
    }
    const LinePoint end = polls_.end();
    add(upper_bounds_, end);
    add(negated_lower_bounds_, {.x = end.x, .y = polls_.round_trip_ns() - end.y});
    from_above_ = middle_line(upper_bounds_.hull(), max_slope_);
    negated_from_below_ = middle_line(negated_lower_bounds_.hull(), max_slope_);
  }

  GlobalTime stamp(const DeviceSample& sample) override {
    return polls_.stamp(sample, [this](std::int64_t x) {
      return (from_above_.at(x) - negated_from_below_.at(x)) / 2;
    });
  }

 private:
  void add(WindowHull& window, LinePoint point) const {
    while (!window.empty() && (window.full() || window.oldest().x <= point.x - window_us_)) {
      window.pop();
    }
    window.push(point);
  }

  std::int64_t window_us_;
  double max_slope_;
  PollStream polls_;
  WindowHull upper_bounds_;
  WindowHull negated_lower_bounds_;  // so that their upper hull is a lower one
  SupportLine from_above_;
  SupportLine negated_from_below_;
};

}  // namespace

std::unique_ptr<DeviceTimeEstimator> make_two_way_poll(TwoWayPollSettings settings) {
  SIMBENCH_ASSERT(settings.window_s > 0, "a window is of some time");
  return std::make_unique<TwoWayPoll>(settings);
}

void TwoWayPollSettings::bind(ParameterBinder& parameters) {
  bind_max_skew(parameters, max_skew_ppm);
  parameters.number("window_s", window_s, 1, 3600, "span of the polls that are used",
                    "ours: short against wander");
}

std::vector<DeviceTimeEntry> device_time_two_way_poll() {
  return {with_settings<DeviceTimeEntry>(
      {.name = "two_way_poll",
       .family = "two_way_poll",
       .summary = "two-way convex hulls over polls of the camera's clock, no arrivals",
       .source = "docs/reference/host_sync.md section 1 (MOOS, TICSync)",
       .needs = {Need::kPolls}},
      TwoWayPollSettings{}, make_two_way_poll)};
}

}  // namespace simbench
