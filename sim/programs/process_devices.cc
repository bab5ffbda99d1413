// The requests that concern devices.
#include <poll.h>

#include <algorithm>
#include <cerrno>
#include <span>
#include <utility>
#include <vector>

#include "sim/programs/process.h"

namespace simbench::sim {

using shim::Call;
using shim::HostDevice;

bool Process::is_about_devices(Call call) {
  return call >= Call::kOpenDevice && call <= Call::kTakeStamps;
}

Process::Answer Process::open_device(int fd, std::int64_t which) {
  if (open_.size() >= kMostOpen) return {.error = EMFILE};
  const auto device = static_cast<HostDevice>(which);
  if (device != HostDevice::kCard && device != HostDevice::kPulses) return {.error = ENOENT};
  const std::shared_ptr<DeviceFile> file = around_.pulses.open(device);
  if (file == nullptr) return {.error = ENOENT};
  file->on_event = [wake = around_.wake, object = std::weak_ptr(open(fd, file))] {
    if (const std::shared_ptr<OpenObject> known = object.lock()) known->changed(POLLIN);
    wake();
  };
  return {};
}

Process::Answer Process::of_device(const ChildRequest& request) {
  if (request.head.call == Call::kOpenDevice) return open_device(request.head.fd, request.head.a);
  const std::shared_ptr<OpenObject> object = object_of(request.head.fd);
  DeviceFile* const file = object != nullptr ? object->device() : nullptr;
  const bool is_of_line =
      request.head.call == Call::kPulseParameters || request.head.call == Call::kFetchPulse;
  const HostDevice device = is_of_line ? HostDevice::kPulses : HostDevice::kCard;
  if (file == nullptr || file->device != device) {
    throw BadRequest("used a device that it never opened");
  }
  if (!is_of_line) return of_card(*file, request);
  PulseDevices& pulses = around_.pulses;
  if (request.head.call == Call::kFetchPulse) return {.data = bytes_of(pulses.fetch(*file))};
  Answer answer{.value = PulseDevices::kAbilities};
  if (!request.data.empty()) {
    answer.error = pulses.set_parameters(read_head<pps_kparams>(request.data));
  }
  answer.data = bytes_of(pulses.parameters());
  return answer;
}

Process::Answer Process::of_card(const DeviceFile& file, const ChildRequest& request) {
  PulseDevices& pulses = around_.pulses;
  switch (request.head.call) {
    case Call::kPin: {
      const int error = request.head.a >= 0 ? pulses.set_pin(request.head.a, request.head.b) : 0;
      return {.value = pulses.pin(), .error = error};
    }
    case Call::kStampPulses:
      return {.error = pulses.stamp_pulses(request.head.a != 0)};
    default: {
      if (!file.is_ready()) return {.error = EAGAIN};
      const auto most = std::clamp<std::int64_t>(request.head.a, 0, PulseDevices::kMostStamps);
      const std::vector<std::int64_t> taken = pulses.take_stamps(static_cast<std::size_t>(most));
      const auto bytes = std::as_bytes(std::span(taken));
      return {.data = {bytes.begin(), bytes.end()}};
    }
  }
}

}  // namespace simbench::sim
