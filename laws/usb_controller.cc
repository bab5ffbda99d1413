#include "laws/usb_controller.h"

#include <algorithm>
#include <limits>

#include "algorithms/ports/assert.h"

namespace simbench {
namespace {

// Two transfers of the same size that start together end together: a thousandth of a byte is far
// below what a nanosecond carries, and far above the rounding of the sums.
constexpr double kByteTolerance = 1e-3;

}  // namespace

UsbController::UsbController(const UsbSettings& settings, std::size_t streams)
    : settings_(settings),
      pending_of_stream_(streams, 0),
      lane_free_at_ns_(streams / settings.streams_per_lane + 1,
                       std::numeric_limits<double>::lowest()) {
  SIMBENCH_ASSERT(settings.bytes_per_ns > 0, "a USB controller needs bandwidth");
}

bool UsbController::later(const Transfer& a, const Transfer& b) {
  return a.done_at != b.done_at ? a.done_at > b.done_at : a.order > b.order;
}

void UsbController::serve_until(Nanoseconds now) {
  if (!pending_.empty()) {
    served_bytes_ +=
        to_ns(now - served_until_) * settings_.bytes_per_ns / static_cast<double>(pending_.size());
  } else {
    served_bytes_ = 0;  // no pending transfer uses the sum: keep it small, and so exact
  }
  served_until_ = now;
}

bool UsbController::submit(Nanoseconds now, std::size_t stream, double bytes, std::uint32_t ticket,
                           Nanoseconds latest) {
  if (pending_of_stream_[stream] >= settings_.buffered_frames) return false;
  double& free_at = free_at_ns(stream);
  double done_at = queued_on(free_at, now, bytes / settings_.bytes_per_ns);
  if (whole(done_at) > latest) return false;
  free_at = done_at;
  if (settings_.is_fair) {
    serve_until(now);
    done_at = served_bytes_ + bytes;
  }
  ++pending_of_stream_[stream];
  pending_.push_back({done_at, submissions_++, ticket, static_cast<std::uint32_t>(stream)});
  std::push_heap(pending_.begin(), pending_.end(), later);
  wake_up_ = std::min(wake_up_, next_completion());
  return true;
}

Nanoseconds UsbController::next_completion() const {
  if (pending_.empty()) return Nanoseconds::max();
  const double done_at = pending_.front().done_at;
  if (!settings_.is_fair) return whole(done_at);
  const double remaining_ns =
      (done_at - served_bytes_) * static_cast<double>(pending_.size()) / settings_.bytes_per_ns;
  return served_until_ + from_ns_up(std::max(0.0, remaining_ns));
}

std::optional<std::uint32_t> UsbController::take_completed(Nanoseconds now) {
  double reached = to_ns(now);
  if (settings_.is_fair && !pending_.empty()) {
    serve_until(now);
    reached = served_bytes_ + kByteTolerance;
  }
  if (pending_.empty() || pending_.front().done_at > reached) {
    wake_up_ = next_completion();
    return std::nullopt;
  }
  std::pop_heap(pending_.begin(), pending_.end(), later);
  const Transfer done = pending_.back();
  pending_.pop_back();
  --pending_of_stream_[done.stream];
  return done.ticket;
}

}  // namespace simbench
