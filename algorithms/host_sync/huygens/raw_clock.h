// A host's raw clock, which nobody steers, and its way to the system clock.
//
// Huygens compares raw clocks: software stamps are turned into the steady clock's, with the card's
// stamps it is the network card's own clock, left to itself. Lines between raw clocks are thus
// straight, whatever is done to the system clocks meanwhile.
//
// The card's clock is compared with the steady clock once per second (narrowest cross stamp) and
// taken as the least-squares line of the last kCrossStamps comparisons.
//
//   RawClock raw(host, StampSource::kKernel, {});
//   std::optional<std::int64_t> arrived = raw.arrival(message);
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "algorithms/host_sync/clock_steering.h"
#include "algorithms/host_sync/stamps.h"
#include "algorithms/ports/host.h"
#include "laws/line_fit.h"

namespace simbench {

class RawClock {
 public:
  static constexpr std::size_t kCrossStamps = 8;
  static constexpr Nanoseconds kInterval{1'000'000'000};

  // The host must outlive this.
  RawClock(Host& host, StampSource source, SteeringSettings steering)
      : host_(host), stamps_(host, source), system_(host, steering) {}

  // What the host lacks (stamps.h); empty if nothing is known.
  std::string lacking() const { return stamps_.lacking(); }
  // Keeps the card's clock in view, for ever; returns at once if that is not the raw clock.
  Task<void> watch();

  // When the message left that send(), called at `begin`, has just returned from: never outside of
  // the call, however coarse or uncertain the stamp is. Nothing if it was not stamped, or if the
  // system clock was stepped meanwhile.
  Task<std::optional<std::int64_t>> departure(MessageChannel& channel, MessageId id,
                                              SteadyTime begin);
  std::optional<std::int64_t> arrival(const ReceivedMessage& message);

  // Nothing before the card's clock was seen.
  std::optional<SteadyTime> steady_at(std::int64_t raw_ns) const;
  SteeredClock& system() { return system_; }

 private:
  Task<std::optional<std::int64_t>> departure_by_system(MessageChannel& channel, MessageId id,
                                                        SteadyTime begin);
  bool is_card() const { return stamps_.source() == StampSource::kCard; }
  void add(std::int64_t raw_ns, SteadyTime at);

  Host& host_;
  MessageStamps stamps_;
  SteeredClock system_;
  std::deque<LinePoint> seen_;  // x: raw, y: steady less raw
};

}  // namespace simbench
