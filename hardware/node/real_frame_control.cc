#include "hardware/node/real_frame_control.h"

#include <string>
#include <utility>

namespace simbench::hardware {
namespace {

constexpr Nanoseconds kBeforeStart = std::chrono::milliseconds(10);

}  // namespace

RealFrameControl::RealFrameControl(const Place& place, std::uint32_t camera,
                                   std::shared_ptr<CameraSteering> steering)
    : clock_(place.clock),
      host_(place.host),
      camera_(camera),
      steering_(std::move(steering)),
      frames_(place.context, place.clock) {}

Task<std::optional<FrameArrival>> RealFrameControl::next_frame(SteadyTime deadline) {
  return frames_.next(deadline);
}

Task<FrameControlReply> RealFrameControl::change(FrameControlKind kind, Nanoseconds length) {
  co_return steering_->control(kind, length);
}

Task<FrameControlReply> RealFrameControl::start_at(HostTime at) {
  const HostTime now = clock_.system_at(monotonic_now());
  std::string refused = refusal_of_start(limits(), at, now);
  if (!refused.empty()) co_return FrameControlReply{.refused = std::move(refused)};
  if (at > now + kBeforeStart) co_await host_.sleep_until(at - kBeforeStart);
  FrameControlReply reply = steering_->start_at(clock_.when(at, monotonic_now()));
  if (reply.is_accepted()) co_await host_.sleep_until(at);
  co_return reply;
}

}  // namespace simbench::hardware
