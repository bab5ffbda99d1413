#include "scenarios/scenario.h"

#include <algorithm>
#include <stdexcept>

#include "scenarios/camera_profile.h"

namespace simbench::scenarios {

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

}  // namespace simbench::scenarios
