#include "evaluation/scoring/set_counter.h"

#include <algorithm>
#include <cmath>

namespace simbench::evaluation {

bool SetCounter::counts(std::span<const GatherFrame> set) const {
  return std::any_of(set.begin(), set.end(),
                     [this](const GatherFrame& frame) { return table_.holds(frame.tag); });
}

void SetCounter::on_partial_set(std::span<const GatherFrame> set) {
  if (!counts(set)) return;
  ++partial_;
  if (observer_ != nullptr) observer_->on_set(set, /*complete=*/false, now());
}

void SetCounter::on_set(std::span<const GatherFrame> set) {
  if (!counts(set)) return;
  GlobalTime latest_arrival = set.front().arrival;
  GlobalTime first = set.front().stamp;
  GlobalTime last = first;
  bool is_pure = true;
  for (const GatherFrame& frame : set) {
    is_pure = is_pure && frame.tag == set.front().tag;
    latest_arrival = std::max(latest_arrival, frame.arrival);
    first = std::min(first, frame.stamp);
    last = std::max(last, frame.stamp);
  }
  if (is_pure) {
    ++pure_;
  } else {
    index_errors_ += index_errors(set);
  }
  range_sum_ms_ += to_ms(last - first);
  const double latency_ms = to_ms(now() - latest_arrival);
  latency_sum_ms_ += latency_ms;
  latency_max_ms_ = emitted_ == 0 ? latency_ms : std::max(latency_max_ms_, latency_ms);
  ++emitted_;
  if (table_.has_truth()) add_errors(set);
  if (observer_ != nullptr) observer_->on_set(set, /*complete=*/true, now());
}

// Members of another pulse than most members, which are not all of one.
std::int64_t SetCounter::index_errors(std::span<const GatherFrame> set) {
  const auto size = static_cast<std::int64_t>(set.size());
  tags_.clear();
  for (const GatherFrame& frame : set) {
    if (frame.tag >= 0) tags_.push_back(frame.tag);  // "no pulse" cannot be that of most
  }
  std::sort(tags_.begin(), tags_.end());
  std::int64_t most = 0;
  for (auto begin = tags_.begin(); begin != tags_.end();) {
    const auto end = std::upper_bound(begin, tags_.end(), *begin);
    most = std::max<std::int64_t>(most, end - begin);
    begin = end;
  }
  return size - most;
}

void SetCounter::add_errors(std::span<const GatherFrame> set) {
  std::int64_t tag = -1;
  std::span<const std::int64_t> reference_ns;  // of that pulse's row; empty: it is not evaluated
  for (const GatherFrame& frame : set) {
    if (frame.tag != tag) {
      tag = frame.tag;
      reference_ns = {};
      if (table_.holds(tag)) reference_ns = table_.reference_ns(table_.row_of(tag));
    }
    if (reference_ns.empty()) continue;
    const GlobalTime reference{Nanoseconds(reference_ns[frame.source])};
    error_sum_ms_ += std::abs(to_ms(frame.stamp + shift_ - reference));
    ++errors_;
  }
}

void SetCounter::score(SeedScore& score) const {
  score.sets.emitted = emitted_;
  score.sets.pure = pure_;
  score.sets.partial = partial_;
  score.sets.index_errors = index_errors_;
  if (emitted_ == 0) return;  // they stay NaN
  const auto sets = static_cast<double>(emitted_);
  if (table_.sources() > 1) score.set_amd_ms = range_sum_ms_ / sets;
  score.emission_latency_ms = latency_sum_ms_ / sets;
  score.emission_latency_max_ms = latency_max_ms_;
  if (errors_ > 0) score.set_absolute_error_ms = error_sum_ms_ / static_cast<double>(errors_);
}

}  // namespace simbench::evaluation
