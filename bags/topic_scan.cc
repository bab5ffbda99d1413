#include "bags/topic_scan.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <string_view>
#include <tuple>
#include <utility>

namespace simbench::bags {
namespace {

// A larger step of header.seq is no loss: the publisher counts otherwise.
constexpr std::uint32_t kMostMissing = 1U << 20;

// Beyond all time, so that differences cannot overflow.
constexpr std::int64_t kMostLogNs = std::numeric_limits<std::int64_t>::max() / 4;

std::uint32_t content_of(const BagMessage& message) {
  const std::string_view start = message.head.substr(0, TopicArrivals::kCompared);
  const std::uint64_t hash =
      std::hash<std::string_view>()(start) ^ message.size * 0x9e3779b97f4a7c15U;
  return static_cast<std::uint32_t>(hash ^ hash >> 32);
}

}  // namespace

double TopicScan::rate_hz() const {
  const double span_s = to_seconds(last - first);
  return messages < 2 || !(span_s > 0) ? 0 : static_cast<double>(messages - 1) / span_s;
}

void TopicScan::append(const TopicScan& next) {
  const auto take_gap = [this](Nanoseconds gap, Nanoseconds at) {
    if (gap <= longest_gap) return;
    longest_gap = gap;
    gap_at = at;
  };
  if (messages > 0 && next.messages > 0) {
    take_gap(next.first - last, last);
    take_gap(first - next.last, next.last);
    first = std::min(first, next.first);
    last = std::max(last, next.last);
  } else if (messages == 0) {
    first = next.first;
    last = next.last;
  }
  take_gap(next.longest_gap, next.gap_at);
  messages += next.messages;
  bytes += next.bytes;
  out_of_order += next.out_of_order;
  copies += next.copies;
  missing_numbers += next.missing_numbers;
}

void TopicArrivals::add(const BagMessage& message) {
  const std::int64_t log_ns = std::clamp(message.log_time.count(), -kMostLogNs, kMostLogNs);
  const std::uint32_t before = entries_.empty() ? 0 : entries_.back().sequence;
  if (entries_.empty()) {
    latest_ns_ = log_ns;
  } else {
    rises_ = rises_ && log_ns > latest_ns_;
    out_of_order_ += log_ns < latest_ns_ ? 1 : 0;
    latest_ns_ = std::max(latest_ns_, log_ns);
  }
  entries_.push_back({log_ns, before, content_of(message)});
}

void TopicArrivals::set_sequence(std::uint32_t sequence) { entries_.back().sequence = sequence; }

void TopicArrivals::conclude(TopicScan& scan) {
  if (!rises_) sort();
  scan.out_of_order = out_of_order_;
  scan.copies = copies_;
  scan.messages = entries_.size();
  measure(scan);
  entries_ = {};
}

// Sorts by log time and takes the copies out.
void TopicArrivals::sort() {
  struct Numbered {
    Entry entry;
    std::uint64_t number;
    auto key() const { return std::tuple(entry.log_ns, entry.sequence, entry.content); }
  };
  std::vector<Numbered> sorted;
  sorted.reserve(entries_.size());
  for (const Entry& entry : entries_) sorted.push_back({entry, sorted.size()});
  std::sort(sorted.begin(), sorted.end(), [](const Numbered& a, const Numbered& b) {
    return std::pair(a.key(), a.number) < std::pair(b.key(), b.number);
  });
  const bool is_timed = sorted.front().entry.log_ns < sorted.back().entry.log_ns;
  entries_.clear();
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    if (is_timed && i > 0 && sorted[i].key() == sorted[i - 1].key()) {
      is_copy_.resize(sorted.size());
      is_copy_[static_cast<std::size_t>(sorted[i].number)] = true;
      ++copies_;
    } else {
      entries_.push_back(sorted[i].entry);
    }
  }
}

void TopicArrivals::measure(TopicScan& scan) const {
  if (entries_.empty()) return;
  scan.first = Nanoseconds(entries_.front().log_ns);
  scan.last = Nanoseconds(entries_.back().log_ns);
  for (std::size_t i = 1; i < entries_.size(); ++i) {
    const Entry& a = entries_[i - 1];
    const Entry& b = entries_[i];
    if (const Nanoseconds gap(b.log_ns - a.log_ns); gap > scan.longest_gap) {
      scan.longest_gap = gap;
      scan.gap_at = Nanoseconds(a.log_ns);
    }
    const std::uint32_t step = b.sequence - a.sequence;
    if (step > 1 && step <= kMostMissing) scan.missing_numbers += step - 1;
  }
}

}  // namespace simbench::bags
