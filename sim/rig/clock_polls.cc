#include "sim/rig/clock_polls.h"

#include <algorithm>

#include "sim/engine/random.h"
#include "sim/rig/cameras.h"

namespace simbench::sim {
namespace {

constexpr ComponentKey kPhase("camera: phase of the clock polls");
constexpr ComponentKey kDelays("camera: delays of a clock poll");
constexpr ComponentKey kAsymmetryError("calibration/poll_asymmetry");

}  // namespace

ClockPolls::ClockPolls(const scenarios::Scenario& scenario, std::uint64_t seed,
                       const CameraFaults& faults, TrueTime end)
    : scenario_(scenario),
      seed_(seed),
      faults_(faults),
      interval_(from_ms(scenario.cameras.clock_poll.interval_ms)),
      end_(end),
      asymmetry_error_ms_(RandomStream(seed, kAsymmetryError)
                              .normal(scenario.cameras.calibration.poll_asymmetry_error_sigma_ms)) {
  if (interval_.count() == 0) return;
  const auto cameras = static_cast<std::uint32_t>(scenario_.cameras.count);
  polls_.resize(cameras);
  for (std::uint32_t camera = 0; camera < cameras; ++camera) {
    RandomStream draw(seed_, kPhase, camera);
    polls_[camera].first = TrueTime{} + start_delay(scenario_, seed_, camera) +
                           from_ms(draw.uniform(0, scenario_.cameras.clock_poll.interval_ms));
    send(camera, 0);
  }
}

void ClockPolls::send(std::uint32_t camera, std::int64_t number) {
  const scenarios::ClockPoll& parameters = scenario_.cameras.clock_poll;
  Poll& poll = polls_[camera];
  poll.number = number;
  poll.begin = poll.first + number * interval_;
  if (poll.begin >= end_) return;
  RandomStream draw(seed_, kDelays, camera, static_cast<std::uint64_t>(number));
  double request_ms = parameters.request_ms + draw.exponential(parameters.request_exponential_ms);
  const double reply_ms = parameters.reply_ms + draw.exponential(parameters.reply_exponential_ms);
  if (draw.chance(parameters.tail_probability))
    request_ms += draw.uniform(0, parameters.tail_max_ms);
  poll.read = poll.begin + from_ms(std::max(0.0, request_ms + asymmetry_error_ms_ / 2));
  ends_.push(poll.read + from_ms(std::max(0.0, reply_ms - asymmetry_error_ms_ / 2)), camera);
}

void ClockPolls::hand_out(TrueTime then, std::vector<CameraPoll>& polls) {
  polls.clear();
  QueueEntry entry;
  while (ends_.pop_through(then - Nanoseconds(1), entry)) {
    const auto camera = static_cast<std::uint32_t>(entry.payload);
    const TrueTime end{Nanoseconds(entry.time_ns)};
    const Poll& poll = polls_[camera];
    if (!faults_.vanished(camera, poll.read)) {
      polls.push_back({.camera = camera, .begin = poll.begin, .read = poll.read, .end = end});
    }
    // The first that begins now or later.
    const std::int64_t due = (end - poll.first + interval_ - Nanoseconds(1)) / interval_;
    send(camera, std::max(poll.number + 1, due));
  }
}

}  // namespace simbench::sim
