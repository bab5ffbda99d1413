#include "sim/camera/auto_exposure.h"

#include <algorithm>
#include <iterator>

namespace simbench::sim {

AutoExposureLoop::AutoExposureLoop(const scenarios::AutoExposure& settings, Nanoseconds initial,
                                   std::uint64_t run_seed, std::size_t camera,
                                   TrueTime camera_start)
    : settings_(settings),
      stream_(run_seed, "camera/auto_exposure", camera),
      steps_{{camera_start, initial}} {
  if (settings_.is_on()) {
    next_step_ =
        camera_start + from_ms(stream_.exponential(settings_.step_interval_exponential_ms));
  }
}

Nanoseconds AutoExposureLoop::stepped(TrueTime t) {
  while (next_step_ <= t) {
    steps_.push_back({next_step_, from_ms(stream_.uniform(settings_.min_ms, settings_.max_ms))});
    next_step_ += from_ms(stream_.exponential(settings_.step_interval_exponential_ms));
  }
  const auto later =
      std::upper_bound(steps_.begin(), steps_.end(), t,
                       [](TrueTime time, const Step& step) { return time < step.at; });
  return later == steps_.begin() ? later->exposure : std::prev(later)->exposure;
}

}  // namespace simbench::sim
