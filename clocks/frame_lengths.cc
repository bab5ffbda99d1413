#include "clocks/frame_lengths.h"

#include <iterator>
#include <limits>
#include <string>
#include <utility>

namespace simbench::clocks {

FrameControlReply FrameRequests::reply(FrameControlKind kind, Nanoseconds value) {
  const Nanoseconds length = kind == FrameControlKind::kAdjustFrame ? usual_ + value : value;
  std::string refused = refusal_of(limits_, kind, length);
  if (!refused.empty()) return {.refused = std::move(refused)};
  if (kind == FrameControlKind::kStartAt) return {};
  const Nanoseconds made = limits_.nearest(length);
  if (kind == FrameControlKind::kFrameLength) usual_ = made;
  return {.length = made};
}

FrameLengths::FrameLengths(const FrameControlLimits& limits, std::int64_t insert_stretches)
    : limits_(limits), insert_stretches_(insert_stretches) {
  usual_[std::numeric_limits<std::int64_t>::min()] = limits_.nearest(limits_.frame_length);
}

Nanoseconds FrameLengths::usual(std::int64_t frame) const {
  return std::prev(usual_.upper_bound(frame))->second;
}

Nanoseconds FrameLengths::of(std::int64_t frame) const {
  const auto single = single_.find(frame);
  return single != single_.end() ? single->second : usual(frame);
}

std::optional<Nanoseconds> FrameLengths::exposure(std::int64_t frame) const {
  const auto changed = exposures_.find(frame);
  return changed != exposures_.end() ? std::optional(changed->second) : std::nullopt;
}

Nanoseconds FrameLengths::wanted(FrameControlKind kind, Nanoseconds value,
                                 std::int64_t frame) const {
  const bool is_relative = kind == FrameControlKind::kAdjustFrame;
  return limits_.nearest(is_relative ? usual(frame) + value : value);
}

void FrameLengths::set(FrameControlKind kind, Nanoseconds wanted, std::int64_t frame) {
  if (kind == FrameControlKind::kFrameLength) {
    usual_.erase(usual_.upper_bound(frame), usual_.end());
    usual_[frame] = wanted;
    return;
  }
  single_[frame] = wanted;
  if (kind != FrameControlKind::kInsertFrame) return;
  exposures_[frame + 1] = wanted - limits_.granularity;
  for (std::int64_t i = 0; i < insert_stretches_; ++i) single_[frame + i] = wanted;
}

void FrameLengths::forget_before(std::int64_t frame) {
  usual_.erase(usual_.begin(), std::prev(usual_.upper_bound(frame)));
  single_.erase(single_.begin(), single_.lower_bound(frame));
  exposures_.erase(exposures_.begin(), exposures_.lower_bound(frame));
}

}  // namespace simbench::clocks
