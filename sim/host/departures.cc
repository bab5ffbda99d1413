#include "sim/host/departures.h"

#include <algorithm>

#include "sim/host/host_clocks.h"
#include "sim/host/sim_host.h"

namespace simbench::sim {
namespace {

constexpr ComponentKey kHardwareTransmission("host: hardware transmit stamp");
constexpr std::size_t kStampsKept = 4096;
// SimHost::next_look() looks no earlier at a deadline that is far off.
constexpr Nanoseconds kSoon = std::chrono::seconds(5);

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

void Departures::look(Search& search) const {
  if (!search.at && has_left(search.id)) {
    const Sent* message = sent(search.id);
    if (message == nullptr) {
      search.is_over = true;
      return;
    }
    search.at = message->departure.*search.part;
  }
  search.is_over = search.at && *search.at <= host_.true_now();
  if (search.is_over) return;
  if (host_.is_past(search.deadline)) {
    search.at.reset();
    search.is_over = true;
    return;
  }
  search.look =
      search.at ? next_look(search.deadline, *search.at) : host_.next_look(search.deadline);
}

TrueTime Departures::next_look(SteadyTime deadline, TrueTime at) const {
  // Nearly always: then nobody needs to know when the steady clock reads the deadline.
  const bool is_soon = at - host_.true_now() < kSoon;
  if (is_soon && host_.system_clock().steady(at) < deadline) return at;
  const std::optional<TrueTime> look = host_.next_look(deadline);
  return look ? std::min(*look, at) : at;
}

Task<std::optional<HostTime>> Departures::stamp(MessageId id, SteadyTime deadline) {
  if (!stamps_in_kernel_) co_return std::nullopt;
  Search search{.id = id, .deadline = deadline, .part = &HostDeparture::stamped};
  for (look(search); !search.is_over; look(search)) co_await left_.wait(search.look);
  if (!search.at) co_return std::nullopt;
  co_return host_.clock_interface().tick_of(host_.system_clock().read(*search.at));
}

Task<std::optional<HardwareTime>> Departures::hardware_stamp(MessageId id, SteadyTime deadline) {
  const NicClock* nic = host_.nic();
  if (nic == nullptr) co_return std::nullopt;
  Search search{.id = id, .deadline = deadline, .part = &HostDeparture::passed};
  for (look(search); !search.is_over; look(search)) co_await passed_.wait(search.look);
  if (!search.at) co_return std::nullopt;
  const MessageKey key = key_of_sent(id);
  RandomStream draw(host_.world().run_seed, kHardwareTransmission, key.direction, key.message);
  co_return nic->stamp(*search.at, draw);
}

const Departures::Sent* Departures::sent(MessageId id) const {
  if (id < first_sent_) return nullptr;
  const Sent& message = sent_[static_cast<std::size_t>(id - first_sent_)];
  return message.has_left ? &message : nullptr;
}

}  // namespace simbench::sim
