#include "sim/programs/pulse_devices.h"

#include <algorithm>
#include <cerrno>
#include <limits>

#include "sim/engine/random.h"
#include "sim/programs/kernel_clock.h"

namespace simbench::sim {
namespace {

constexpr ComponentKey kStampNoise("host: network card's stamps of pulses");
constexpr SteadyTime kNoEnd = SteadyTime::max();

// As the kernel adds them: the nanoseconds of a program's offset may be any.
pps_ktime with_offset(std::int64_t stamp_ns, const pps_ktime& offset) {
  const std::int64_t second = floor_div(stamp_ns, kSecondNs);
  const std::int64_t ns = stamp_ns - second * kSecondNs + offset.nsec;
  const std::int64_t carried = second + floor_div(ns, kSecondNs);
  pps_ktime sum{};
  sum.sec = static_cast<std::int64_t>(static_cast<std::uint64_t>(carried) +
                                      static_cast<std::uint64_t>(offset.sec));
  sum.nsec = static_cast<std::int32_t>(ns - floor_div(ns, kSecondNs) * kSecondNs);
  return sum;
}

}  // namespace

bool DeviceFile::is_ready() const { return devices->is_ready(*this); }

PulseDevices::PulseDevices(SimHost& host) : host_(host), line_(host.pulse_line(PulseLine::kPps)) {
  parameters_.api_version = PPS_API_VERS;
  parameters_.mode = PPS_CAPTUREASSERT | PPS_OFFSETASSERT | PPS_CANWAIT | PPS_TSFMT_TSPEC;
}

Task<void> PulseDevices::run() {
  if (line_ == nullptr) co_return;
  for (;;) {
    const std::optional<SimPulseInput::Pulse> pulse = co_await line_->next_pulse(kNoEnd);
    if (!pulse) continue;
    assert_pulse(*pulse);
    if (does_stamp_) stamp_by_card(*pulse);
  }
}

void PulseDevices::assert_pulse(const SimPulseInput::Pulse& pulse) {
  const bool shifts = (parameters_.mode & PPS_OFFSETASSERT) != 0;
  last_.current_mode = parameters_.mode;
  last_.assert_tu =
      with_offset(epoch_ns(pulse.stamp.system), shifts ? parameters_.assert_off_tu : pps_ktime{});
  ++last_.assert_sequence;
  tell(shim::HostDevice::kPulses);
}

void PulseDevices::stamp_by_card(const SimPulseInput::Pulse& pulse) {
  RandomStream noise(host_.world().run_seed, kStampNoise, host_.id(),
                     static_cast<std::uint64_t>(pulse.number));
  if (stamps_.size() == kMostStamps) stamps_.pop_front();
  stamps_.push_back(nanoseconds_of(host_.nic()->stamp(pulse.at, noise)) + kEpochNs);
  tell(shim::HostDevice::kCard);
}

void PulseDevices::tell(shim::HostDevice device) {
  std::erase_if(files_, [](const auto& each) { return each.expired(); });
  for (const auto& each : std::vector(files_)) {
    const std::shared_ptr<DeviceFile> file = each.lock();
    if (file != nullptr && file->device == device) file->on_event();
  }
}

std::shared_ptr<DeviceFile> PulseDevices::open(shim::HostDevice device) {
  const bool is_there = device == shim::HostDevice::kCard ? host_.nic() != nullptr : has_line();
  if (!is_there) return nullptr;
  auto file = std::make_shared<DeviceFile>();
  file->devices = this;
  file->device = device;
  file->fetched = last_.assert_sequence;
  files_.push_back(file);
  return file;
}

bool PulseDevices::is_ready(const DeviceFile& file) const {
  if (file.device == shim::HostDevice::kCard) return !stamps_.empty();
  return file.fetched != last_.assert_sequence;
}

int PulseDevices::set_parameters(const pps_kparams& wanted) {
  if ((wanted.mode & (PPS_CAPTUREASSERT | PPS_CAPTURECLEAR)) == 0) return EINVAL;
  if ((wanted.mode & ~kAbilities) != 0) return EINVAL;
  parameters_ = wanted;
  parameters_.mode |= PPS_TSFMT_TSPEC | PPS_CANWAIT;
  parameters_.api_version = PPS_API_VERS;
  parameters_.assert_off_tu.flags = 0;
  parameters_.clear_off_tu.flags = 0;
  return 0;
}

pps_kinfo PulseDevices::fetch(DeviceFile& file) const {
  file.fetched = last_.assert_sequence;
  return last_;
}

int PulseDevices::set_pin(std::int64_t function, std::int64_t channel) {
  if (!has_pin()) return EINVAL;
  if (function == pin_ && channel == 0) return 0;
  switch (function) {
    case PTP_PF_NONE:
      break;
    case PTP_PF_EXTTS:
      if (channel != 0) return EINVAL;
      break;
    case PTP_PF_PHYSYNC:
      return channel != 0 ? EINVAL : EOPNOTSUPP;
    default:
      return EINVAL;
  }
  does_stamp_ = false;
  pin_ = static_cast<unsigned>(function);
  return 0;
}

int PulseDevices::stamp_pulses(bool does) {
  if (does && pin_ != PTP_PF_EXTTS) return EBUSY;
  does_stamp_ = does;
  return 0;
}

std::vector<std::int64_t> PulseDevices::take_stamps(std::size_t most) {
  const auto end = stamps_.begin() + static_cast<std::ptrdiff_t>(std::min(most, stamps_.size()));
  std::vector<std::int64_t> taken(stamps_.begin(), end);
  stamps_.erase(stamps_.begin(), end);
  return taken;
}

}  // namespace simbench::sim
