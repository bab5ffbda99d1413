#include "hardware/camera/played_steering.h"

#include <algorithm>

namespace simbench::hardware {
namespace {

// A counter that moves on by more has begun anew.
constexpr std::uint32_t kMostMissing = 1000;

}  // namespace

PlayedSteering::PlayedSteering(const FrameSteering& settings)
    : requests_(settings.limits),
      lengths_(settings.limits, settings.insert_stretches),
      usual_(settings.limits.nearest(settings.limits.frame_length)) {}

std::int64_t PlayedSteering::number_of(std::uint32_t counter) const {
  const std::uint32_t steps = counter_ ? counter - *counter_ : 1;
  return frame_ + (steps > kMostMissing ? 1 : std::max(steps, 1U));
}

Nanoseconds PlayedSteering::shift(std::uint32_t counter) const {
  Nanoseconds shift = shift_;
  const std::int64_t number = number_of(counter);
  for (std::int64_t frame = frame_; frame < number; ++frame) shift += lengths_.of(frame) - usual_;
  return shift;
}

std::optional<Nanoseconds> PlayedSteering::exposure(std::uint32_t counter) const {
  return lengths_.exposure(number_of(counter));
}

void PlayedSteering::pass(std::uint32_t counter) {
  shift_ = shift(counter);
  frame_ = number_of(counter);
  counter_ = counter;
  lengths_.forget_before(frame_);
}

FrameControlReply PlayedSteering::control(FrameControlKind kind, Nanoseconds value) {
  FrameControlReply reply = requests_.reply(kind, value);
  if (!reply.is_accepted()) return reply;
  const std::int64_t frame = frame_ + std::max(requests_.limits().latency_frames, 1U);
  lengths_.set(kind, lengths_.wanted(kind, value, frame), frame);
  return reply;
}

FrameControlReply PlayedSteering::restart(std::uint32_t counter, Nanoseconds shift) {
  FrameControlReply reply = requests_.reply(FrameControlKind::kStartAt, {});
  if (reply.is_accepted()) shift_ += shift - this->shift(counter);
  return reply;
}

}  // namespace simbench::hardware
