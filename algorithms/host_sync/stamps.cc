#include "algorithms/host_sync/stamps.h"

namespace simbench {

std::string MessageStamps::lacking() const {
  if (source_ == StampSource::kCard && host_.hardware_clock() == nullptr) {
    return "the host has no hardware clock (Host::hardware_clock); use software stamps";
  }
  if (unstamped_ < kPatience) return "";
  if (source_ == StampSource::kCard) {
    return "the network card stamps no departures (MessageChannel::hardware_transmit_stamp); use "
           "software stamps";
  }
  return "the host's stack stamps no departures (MessageChannel::transmit_stamp; in a scenario: "
         "/network/stamp_point); let it stamp in the kernel, or ask for the program's stamps";
}

Task<std::optional<std::int64_t>> MessageStamps::departure(MessageChannel& channel, MessageId id) {
  std::optional<std::int64_t> stamp;
  if (source_ == StampSource::kProgram) {
    const HostTime now = co_await host_.clock().now();
    stamp = nanoseconds_of(now);
  } else {
    const SteadyTime deadline = host_.steady_clock().now() + kStampTimeout;
    if (source_ == StampSource::kCard) {
      const std::optional<HardwareTime> by_card =
          co_await channel.hardware_transmit_stamp(id, deadline);
      if (by_card) stamp = nanoseconds_of(*by_card);
    } else {
      const std::optional<HostTime> by_kernel = co_await channel.transmit_stamp(id, deadline);
      if (by_kernel) stamp = nanoseconds_of(*by_kernel);
    }
  }
  if (stamp) unstamped_ = -1;
  if (!stamp && unstamped_ >= 0) ++unstamped_;
  co_return stamp;
}

std::optional<std::int64_t> MessageStamps::arrival(const ReceivedMessage& message) const {
  if (source_ != StampSource::kCard) return nanoseconds_of(message.received);
  if (!message.received_hardware) return std::nullopt;
  return nanoseconds_of(*message.received_hardware);
}

void bind_software_stamps(ParameterBinder& parameters, StampSource& source) {
  if (source == StampSource::kCard) return;
  parameters.choice("stamps", source,
                    {{"kernel", StampSource::kKernel}, {"program", StampSource::kProgram}},
                    "who stamps: the kernel, or the program after its send call", "linuxptp");
}

std::vector<Need> needs_of(StampSource source) {
  if (source == StampSource::kCard) return {Need::kHardwareStamps};
  return {};
}

}  // namespace simbench
