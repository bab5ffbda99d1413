#include "scenarios/scenario.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "scenarios/camera_profile.h"

namespace simbench::scenarios {

std::uint32_t followed_host(const Hosts& hosts, std::uint32_t host) {
  return hosts.follows.empty() ? 0 : static_cast<std::uint32_t>(hosts.follows[host]);
}

std::string program_name(const HostPrograms::Command& command) {
  const std::string& program = command.front();
  return program.substr(program.rfind('/') + 1);
}

const Stream* Cameras::stream(StreamKind kind) const {
  const auto found = std::ranges::find(streams, kind, &Stream::kind);
  return found == streams.end() ? nullptr : &*found;
}

bool Cameras::follows_trigger(const Stream& stream) const {
  const CameraProfile* camera = find_camera_profile(model);
  if (camera == nullptr) {
    throw std::invalid_argument("no profile of camera model \"" + model + "\"");
  }
  return camera->triggers(sync_mode, stream.kind);
}

bool Cameras::begins_at_pulse() const {
  if (sync_mode == SyncMode::kGenlock) return true;
  const CameraProfile* camera = find_camera_profile(model);
  if (camera == nullptr) {
    throw std::invalid_argument("no profile of camera model \"" + model + "\"");
  }
  const SyncModeProfile* mode = camera->sync_mode(sync_mode);
  return mode != nullptr && mode->begins_at_pulse;
}

const char* PublishedFigure::number_name() const {
  if (value) return "value";
  return at_most ? "at_most" : "at_least";
}

double PublishedFigure::number() const {
  return at_most.value_or(value.value_or(at_least.value_or(0)));
}

std::vector<std::size_t> Scenario::cameras_by_host() const {
  std::vector<std::size_t> counts(static_cast<std::size_t>(hosts.count));
  for (std::int64_t camera = 0; camera < cameras.count; ++camera) {
    ++counts.at(static_cast<std::size_t>(host_of(camera)));
  }
  return counts;
}

double Scenario::fastest_pulses_hz(const Stream& stream) const {
  const double ignored_periods = cameras.sync_mode == SyncMode::kGenlock ? 2 : 1;
  return stream.mode_rate_hz / ignored_periods / (1 - cameras.genlock_guard_fraction);
}

std::int64_t Scenario::pulses_per_frame(const Stream& stream) const {
  constexpr double kRounding = 1e-9;
  if (!cameras.follows_trigger(stream)) return 1;
  const double pulses = trigger.pulse_rate_hz() / fastest_pulses_hz(stream);
  return std::max<std::int64_t>(1, std::llround(std::ceil(pulses * (1 - kRounding))));
}

std::int64_t Scenario::pulses_per_passed_frame(const Stream& stream) const {
  const std::int64_t passed_every = hosts.frame_reader ? hosts.frame_reader->passed_every : 1;
  return pulses_per_frame(stream) * passed_every;
}

double Scenario::frame_rate_hz(const Stream& stream) const {
  if (!cameras.follows_trigger(stream)) return stream.mode_rate_hz;
  return trigger.pulse_rate_hz() / static_cast<double>(pulses_per_frame(stream));
}

}  // namespace simbench::scenarios
