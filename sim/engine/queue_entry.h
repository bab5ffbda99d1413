// What the event queue stores: an event and its place in the order of insertion, in three words.
//
// Handler, kind and subject travel as one number, the payload: an event is moved several times on
// its way through the queue and a word moves faster than its parts.
#pragma once

#include <cstdint>

#include "sim/engine/event.h"

namespace simbench::sim {

// (time, sequence) as one number: two words compare without a branch that would be mispredicted.
__extension__ typedef __int128 QueueKey;

struct QueueEntry {
  std::int64_t time_ns = 0;
  std::uint64_t payload = 0;
  std::uint64_t sequence = 0;

  QueueKey key() const {
    return (static_cast<QueueKey>(time_ns) << 64) | static_cast<QueueKey>(sequence);
  }

  Event event() const {
    return {.time = TrueTime(Nanoseconds(time_ns)),
            .handler = static_cast<HandlerId>(payload),
            .kind = static_cast<std::uint16_t>(payload >> 16),
            .subject = static_cast<std::uint32_t>(payload >> 32)};
  }
};

constexpr std::uint64_t payload_of(HandlerId handler, std::uint16_t kind, std::uint32_t subject) {
  return handler | (static_cast<std::uint64_t>(kind) << 16) |
         (static_cast<std::uint64_t>(subject) << 32);
}

inline bool earlier(const QueueEntry& a, const QueueEntry& b) { return a.key() < b.key(); }

}  // namespace simbench::sim
