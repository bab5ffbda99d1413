#include "sim/host/departures.h"

#include <algorithm>

#include "sim/host/host_clocks.h"
#include "sim/host/sim_host.h"

namespace simbench::sim {
namespace {

constexpr ComponentKey kHardwareTransmission("host: hardware transmit stamp");
constexpr std::size_t kStampsKept = 4096;

}  // namespace

Departures::Departures(SimHost& host, const std::string& to)
    : host_(host),
      stamps_in_kernel_(host.world().network_parameters.stamp_point ==
                        scenarios::StampPoint::kKernel),
      left_(host.world().context, host.name("transmit stamp to " + to)),
      passed_(host.world().context, host.name("hardware transmit stamp to " + to)) {}

Nanoseconds Departures::to_card(MessageId first) {
  return host_.stack().to_card(host_.true_now(), key_of_sent(first));
}

void Departures::on_left(MessageId first, std::size_t count, const HostDeparture& departure) {
  if (!stamps_in_kernel_ && host_.nic() == nullptr) return;
  while (first_sent_ + sent_.size() < first) sent_.emplace_back();
  for (; count > 0; --count) sent_.push_back({.has_left = true, .departure = departure});
  while (sent_.size() > kStampsKept) {
    sent_.pop_front();
    ++first_sent_;
  }
  left_.notify();
  passed_.notify();
}

Task<std::optional<TrueTime>> Departures::reached(MessageId id, SteadyTime deadline,
                                                  TrueTime HostDeparture::*part,
                                                  WaitPoint& changed) {
  while (!has_left(id)) {
    if (host_.is_past(deadline)) co_return std::nullopt;
    co_await changed.wait(host_.next_look(deadline));
  }
  const Sent* message = sent(id);
  if (message == nullptr) co_return std::nullopt;
  const TrueTime at = message->departure.*part;
  while (at > host_.true_now()) {
    if (host_.is_past(deadline)) co_return std::nullopt;
    const std::optional<TrueTime> look = host_.next_look(deadline);
    co_await changed.wait(look ? std::min(*look, at) : at);
  }
  co_return at;
}

Task<std::optional<HostTime>> Departures::stamp(MessageId id, SteadyTime deadline) {
  if (!stamps_in_kernel_) co_return std::nullopt;
  const std::optional<TrueTime> at = co_await reached(id, deadline, &HostDeparture::stamped, left_);
  if (!at) co_return std::nullopt;
  co_return host_.clock_interface().tick_of(host_.system_clock().read(*at));
}

Task<std::optional<HardwareTime>> Departures::hardware_stamp(MessageId id, SteadyTime deadline) {
  const NicClock* nic = host_.nic();
  if (nic == nullptr) co_return std::nullopt;
  const std::optional<TrueTime> passed =
      co_await reached(id, deadline, &HostDeparture::passed, passed_);
  if (!passed) co_return std::nullopt;
  const MessageKey key = key_of_sent(id);
  RandomStream draw(host_.world().run_seed, kHardwareTransmission, key.direction, key.message);
  co_return nic->stamp(*passed, draw);
}

const Departures::Sent* Departures::sent(MessageId id) const {
  if (id < first_sent_) return nullptr;
  const Sent& message = sent_[static_cast<std::size_t>(id - first_sent_)];
  return message.has_left ? &message : nullptr;
}

}  // namespace simbench::sim
