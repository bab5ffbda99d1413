#include "hardware/net/transmit_log.h"

#include <algorithm>

namespace simbench::hardware {
namespace {

// What converting a stamp may be wrong by (kernel_stamps.h).
constexpr Nanoseconds kStampError = std::chrono::milliseconds(1);

}  // namespace

void TransmitLog::sent(MessageId id, std::uint32_t number, MonotonicTime called) {
  if (entries_.size() == kKept) entries_.pop_front();
  entries_.push_back({.id = id, .number = number, .called = called, .left = std::nullopt});
}

void TransmitLog::stamped(std::uint32_t number, MonotonicTime at) {
  // The newest first: stamps are of what was sent just now, and numbers wrap.
  const auto entry = std::find_if(entries_.rbegin(), entries_.rend(),
                                  [number](const Entry& e) { return e.number == number; });
  if (entry == entries_.rend() || entry->left || at < entry->called - kStampError) return;
  entry->left = std::max(at, entry->called);
}

void TransmitLog::forget_numbers() {
  for (Entry& entry : entries_) entry.number.reset();
}

const TransmitLog::Entry* TransmitLog::find(MessageId id) const {
  const auto entry =
      std::lower_bound(entries_.begin(), entries_.end(), id,
                       [](const Entry& e, MessageId wanted) { return e.id < wanted; });
  return entry == entries_.end() || entry->id != id ? nullptr : &*entry;
}

}  // namespace simbench::hardware
