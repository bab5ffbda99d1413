#include "hardware/relay/delay_queue.h"

#include <algorithm>
#include <utility>

namespace simbench::hardware {

bool DelayQueue::add(MonotonicTime at, Bytes& message, Action action) {
  if (stopped_ || heap_.size() >= kMaxWaiting || bytes_ + message.size() > kMaxBytes) return false;
  bytes_ += message.size();
  heap_.push_back({at, next_number_++, std::move(message), std::move(action)});
  std::push_heap(heap_.begin(), heap_.end(), later);
  if (!armed_for_ || heap_.front().at < *armed_for_) arm();
  return true;
}

void DelayQueue::stop() {
  stopped_ = true;
  heap_.clear();
  bytes_ = 0;
  timer_.cancel();
}

void DelayQueue::arm() {
  if (heap_.empty()) {
    armed_for_.reset();
    return;
  }
  armed_for_ = heap_.front().at;
  timer_.expires_at(for_timer(*armed_for_ - kSpin));
  timer_.async_wait([this](const boost::system::error_code& error) {
    if (!error) run_due();
  });
}

void DelayQueue::run_due() {
  // Actions may call add(), which must not arm the timer meanwhile: arm() below does.
  armed_for_ = MonotonicTime::min();
  MonotonicTime now = monotonic_now();
  while (!stopped_ && !heap_.empty() && heap_.front().at <= now + kSpin) {
    std::pop_heap(heap_.begin(), heap_.end(), later);
    Entry entry = std::move(heap_.back());
    heap_.pop_back();
    bytes_ -= entry.message.size();
    while (now < entry.at) now = monotonic_now();
    const Nanoseconds late = now - entry.at;
    if (lateness_.size() < kSamples) {
      lateness_.push_back(late);
    } else {
      lateness_[done_ % kSamples] = late;
    }
    ++done_;
    entry.action(std::move(entry.message));
    now = monotonic_now();
  }
  if (!stopped_) arm();
}

std::optional<Nanoseconds> DelayQueue::lateness(double q) const {
  if (lateness_.empty()) return std::nullopt;
  std::vector<Nanoseconds> sorted = lateness_;
  const auto place = static_cast<std::size_t>(q * static_cast<double>(sorted.size() - 1));
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(place),
                   sorted.end());
  return sorted[place];
}

}  // namespace simbench::hardware
