// The stamps of a protocol's messages: where they are taken, and what a host lacks that takes none.
//
// A protocol is asked for stamps of one kind and never takes another in their place. lacking() says
// by name what the host has not: at once where it has no card's clock, after kPatience departures
// where none of them was stamped. The protocol reports that as its outcome and ends.
//
// A stamp is a count of nanoseconds of the clock that stamps. A single one that does not come
// within kStampTimeout costs its measurement only.
// Source: Linux SO_TIMESTAMPING (Documentation/networking/timestamping.rst); linuxptp's
// time_stamping, which refuses an interface without the stamps asked for.
//
//   MessageStamps stamps(host, StampSource::kKernel);
//   const MessageId id = co_await channel.send(Bytes(44));
//   const auto departure = co_await stamps.departure(channel, id);
//   if (const std::string what = stamps.lacking(); !what.empty()) outcome.failed(0, what);
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "algorithms/parameter_binder.h"
#include "algorithms/ports/host.h"
#include "algorithms/registry.h"

namespace simbench {

enum class StampSource : std::uint8_t {
  kCard,     // the network card, on its own clock
  kKernel,   // the host's stack, on the system clock
  kProgram,  // the program, on the system clock: departure read after the send call has returned
};

class MessageStamps {
 public:
  // Departures without a stamp from which the host is said to take none.
  static constexpr int kPatience = 4;

  // The host must outlive this.
  MessageStamps(Host& host, StampSource source) : host_(host), source_(source) {}

  StampSource source() const { return source_; }
  // What the host has not that the stamps need, and what would help; empty if nothing is known.
  std::string lacking() const;
  // When the message left that send() has just returned from; nothing if it was not stamped.
  Task<std::optional<std::int64_t>> departure(MessageChannel& channel, MessageId id);
  std::optional<std::int64_t> arrival(const ReceivedMessage& message) const;

 private:
  Host& host_;
  StampSource source_;
  int unstamped_ = 0;  // departures since the beginning; negative once one was stamped
};

// The parameter "stamps" of a protocol with software stamps: those of the kernel, or the program's
// where that is asked for. One with the card's has no choice.
void bind_software_stamps(ParameterBinder& parameters, StampSource& source);
// What an algorithm with such stamps needs of the world.
std::vector<Need> needs_of(StampSource source);

}  // namespace simbench
