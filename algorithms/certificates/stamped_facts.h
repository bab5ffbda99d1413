// What the stamps of an exchange prove: which messages went between which hosts, and when at the
// outermost, on the hosts' steady clocks, which nobody sets.
//
// A message was received after it was sent, whatever protocol sent it. A stamp of a system clock
// stands for all readings within its error, and is mapped to the steady clock by the log of
// adjustments (steady_readings.h): to the first instant at which the message can have been sent,
// and to the last at which it can have been received. Between t1 and t4 the peer may have told but
// one of its two stamps, which then stands for both.
//
//   StampedFacts facts(2, Nanoseconds(101), std::nullopt);
//   facts.add(adjustment);   // in order
//   for (const auto& message : facts.messages_of(1, Exchange()).usable) use(message);
//
// Unit: nanoseconds. Complexity: that of SteadyReadings. Source: docs/design.md section 2;
// algorithms/ports/exchange.h.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "algorithms/certificates/steady_readings.h"
#include "algorithms/ports/exchange.h"
#include "algorithms/ports/time.h"

namespace simbench {

// A camera's register shows a count until a step later; a steady clock is read in whole steps.
inline constexpr Nanoseconds kRegisterStep{1000};
inline constexpr Nanoseconds kSteadyStep{1};

// A message, or a pulse that was seen: received after it was sent.
struct HostMessage {
  // Hosts of the rig; from their number on, clocks outside it.
  std::uint32_t from = 0;
  std::uint32_t to = 0;
  SteadyTime sent{};      // at the earliest, on the sender's clock
  SteadyTime received{};  // at the latest, on the receiver's
  Nanoseconds slack{0};   // by which it may have been sent later than received after all
  bool is_pulse = false;  // no message: no least delay is known of it
};

struct ExchangeMessages {
  std::array<std::optional<HostMessage>, 2> usable{};  // there, and back
  std::size_t unusable = 0;                            // with a stamp that maps to no instant
  bool is_left_out = false;                            // the stamps are estimates
};

class StampedFacts {
 public:
  // Stamps are within `stamp_error` of what their clocks read, those that are estimates
  // (Exchange::is_estimated) within `estimate_error` more; without it they prove nothing.
  StampedFacts(std::size_t hosts, Nanoseconds stamp_error,
               std::optional<Nanoseconds> estimate_error);

  void add(const ClockAdjustment& adjustment);
  // `host` has reported the exchange.
  ExchangeMessages messages_of(std::uint32_t host, const Exchange& exchange) const;
  // When a host's clock read what is within `error` of a stamp.
  std::optional<SteadyRange> when(std::uint32_t host, HostTime stamp, Nanoseconds error) const;

 private:
  std::vector<SteadyReadings> readings_;  // by host
  Nanoseconds stamp_error_;
  std::optional<Nanoseconds> estimate_error_;
};

}  // namespace simbench
