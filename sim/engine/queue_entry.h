// What the event queue stores: an event and its place in the order of insertion.
#ifndef SIMBENCH_SIM_ENGINE_QUEUE_ENTRY_H_
#define SIMBENCH_SIM_ENGINE_QUEUE_ENTRY_H_

#include <cstdint>

#include "sim/engine/event.h"

namespace simbench::sim {

struct QueueEntry {
  Event event;
  std::uint64_t sequence = 0;
};

// (time, sequence) as one number: two words compare without a branch that would be mispredicted.
__extension__ typedef __int128 QueueKey;

inline QueueKey key_of(const QueueEntry& entry) {
  return (static_cast<QueueKey>(entry.event.time.time_since_epoch().count()) << 64) |
         static_cast<QueueKey>(entry.sequence);
}

inline bool earlier(const QueueEntry& a, const QueueEntry& b) { return key_of(a) < key_of(b); }

}  // namespace simbench::sim

#endif  // SIMBENCH_SIM_ENGINE_QUEUE_ENTRY_H_
