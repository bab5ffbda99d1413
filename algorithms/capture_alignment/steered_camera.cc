#include "algorithms/capture_alignment/steered_camera.h"

#include <algorithm>
#include <utility>

#include "algorithms/host_sync/join.h"

namespace simbench {
namespace {

// Frames beyond the latency: the one that is in progress, and one for the way to the camera.
constexpr std::uint32_t kSettleFrames = 2;

}  // namespace

SteeredCamera::SteeredCamera(Host& host, FrameControl& camera) : host_(host), camera_(camera) {}

Nanoseconds SteeredCamera::length() const { return limits().nearest(limits().frame_length); }

// A sensor needs a granule beyond the exposure.
Nanoseconds SteeredCamera::shortest() const {
  const Nanoseconds least = std::max(limits().shortest, limits().exposure + limits().granularity);
  const std::int64_t step = limits().granularity.count();
  return Nanoseconds(step * -floor_div(-least.count(), step));
}

Nanoseconds SteeredCamera::longest() const {
  const std::int64_t step = limits().granularity.count();
  return Nanoseconds(step * floor_div(limits().longest.count(), step));
}

std::string SteeredCamera::unreachable(Nanoseconds period) const {
  if (period >= shortest() && period <= longest() && shortest() < longest()) return "";
  const auto in_ms = [](Nanoseconds time) { return std::to_string(to_ms(time)) + " ms"; };
  return "found a period of " + in_ms(period) + ", allowed: from " + in_ms(shortest()) + " to " +
         in_ms(longest()) + "; choose another rate or exposure";
}

Task<ExposedFrame> SteeredCamera::next_frame() {
  while (true) {
    const std::optional<FrameArrival> frame =
        co_await camera_.next_frame(host_.steady_clock().now() + kPatience);
    if (frame) {
      newest_ = frame->counter;
      co_return clock_.at(*frame);
    }
    report(false, "no frame came for " + std::to_string(to_seconds(kPatience)) +
                      " s; does the camera run?");
  }
}

bool SteeredCamera::is_settled(const ExposedFrame& frame) const {
  if (!sent_) return true;
  const std::uint32_t frames = limits().latency_frames + kSettleFrames;
  const auto later = static_cast<std::int32_t>(frame.counter - newest_when_sent_);
  return later > static_cast<std::int32_t>(frames) &&
         frame.exposed_steady - *sent_ > frames * length();
}

bool SteeredCamera::sent(const FrameControlReply& reply) {
  if (!reply.is_accepted()) {
    report(false, reply.refused);
    return false;
  }
  ++controls_;
  sent_ = host_.steady_clock().now();
  newest_when_sent_ = newest_;
  return true;
}

Task<bool> SteeredCamera::adjust_frame(Nanoseconds by) {
  const FrameControlReply reply = co_await camera_.adjust_frame(by);
  co_return sent(reply);
}

Task<bool> SteeredCamera::insert_frame(Nanoseconds length) {
  const FrameControlReply reply = co_await camera_.insert_frame(length);
  co_return sent(reply);
}

Task<bool> SteeredCamera::set_frame_length(Nanoseconds length) {
  const FrameControlReply reply = co_await camera_.set_frame_length(length);
  co_return sent(reply);
}

Task<bool> SteeredCamera::start_at(HostTime at) {
  const FrameControlReply reply = co_await camera_.start_at(at);
  co_return sent(reply);
}

void SteeredCamera::report(bool aligned, std::string message) {
  const SteadyTime now = host_.steady_clock().now();
  AlignmentReport report{.camera = camera_.camera(),
                         .aligned = aligned,
                         .controls = controls_,
                         .message = std::move(message)};
  if (reported_ && reported_->aligned == aligned && reported_->message == report.message) {
    const bool is_new = reported_->controls != controls_ && now >= reported_at_ + kReportInterval;
    if (!is_new) return;
  }
  host_.report_alignment(report);
  reported_ = std::move(report);
  reported_at_ = now;
}

Nanoseconds phase_error(Nanoseconds time, Nanoseconds period) {
  const std::int64_t half = period.count() / 2;
  return time - period * floor_div(time.count() + half, period.count());
}

namespace {

Task<void> steer_each(Host& host, EachCamera::Steer steer) {
  std::vector<Task<void>> cameras;
  cameras.reserve(host.frame_controls().size());
  for (FrameControl* const camera : host.frame_controls()) {
    cameras.push_back(steer(host, *camera));
  }
  co_await join_all(std::move(cameras));
}

}  // namespace

Task<void> EachCamera::run_master(Host& host, std::vector<PeerId> /*slaves*/) {
  return steer_each(host, steer_);
}

Task<void> EachCamera::run_slave(Host& host, PeerId /*master*/) { return steer_each(host, steer_); }

}  // namespace simbench
