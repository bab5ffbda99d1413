// Frames on a grid of the common clock, as cameras make them that trigger themselves from a PTP
// clock (Basler's Synchronous Free Run with a start time of 0, and its like).
//
// A camera's k-th instant is k periods after the zero of the master's clock, on every host. The
// error of a frame against the nearest instant is taken off the length of one frame, all of it, in
// the direction that needs fewer frames; then the algorithm waits until the stamps show what that
// did. The next control therefore corrects a control that was lost, and a camera's own rate. An
// error below half a granule stays.
//
// The period is the cameras' nominal one and not the granule nearest to it, so that cameras of
// different granularities keep the same grid: an ace has it from its clock of 1 ns.

#include <algorithm>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "algorithms/capture_alignment/steered_camera.h"
#include "algorithms/registry.h"

namespace simbench {
namespace {

const char* const kBasler = "docs.baslerweb.com, Synchronous Free Run";

struct GridSettings {
  Nanoseconds tolerance = from_us(100);

  void bind(ParameterBinder& parameters) {
    parameters.number("tolerance_us", tolerance, 0, 1e6, "a frame nearer to the grid is aligned",
                      kAssumption);
  }
};

// Frames until a move is done, of which each can make a part.
std::int64_t frames_for(Nanoseconds move, Nanoseconds room) {
  if (room.count() <= 0) return std::numeric_limits<std::int64_t>::max();
  return (move.count() + room.count() - 1) / room.count();
}

// By how much the next frame is to be longer for a frame that is late by `error`.
Nanoseconds grid_correction(const SteeredCamera& camera, Nanoseconds error, Nanoseconds period) {
  const Nanoseconds earlier = error.count() > 0 ? error : error + period;
  const Nanoseconds later = period - earlier;
  const Nanoseconds shorter = camera.length() - camera.shortest();
  const Nanoseconds longer = camera.longest() - camera.length();
  const std::int64_t frames_earlier = frames_for(earlier, shorter);
  const std::int64_t frames_later = frames_for(later, longer);
  const bool is_later =
      frames_later != frames_earlier ? frames_later < frames_earlier : later < earlier;
  return is_later ? std::min(later, longer) : -std::min(earlier, shorter);
}

Task<void> follow_grid(Host& host, FrameControl& control, GridSettings settings) {
  SteeredCamera camera(host, control);
  const Nanoseconds period = camera.limits().frame_length;
  if (std::string why = camera.unreachable(period); !why.empty()) {
    camera.report(false, std::move(why));
    co_return;
  }
  while (true) {
    const ExposedFrame frame = co_await camera.next_frame();
    if (!camera.is_settled(frame)) continue;
    const Nanoseconds error = phase_error(frame.exposed.time_since_epoch(), period);
    const bool is_aligned = std::chrono::abs(error) <= settings.tolerance;
    camera.report(is_aligned, is_aligned ? "" : "on its way to the grid");
    if (2 * std::chrono::abs(error) <= camera.limits().granularity) continue;
    const bool is_taken = co_await camera.adjust_frame(grid_correction(camera, error, period));
    if (!is_taken) co_return;
  }
}

}  // namespace

std::vector<CaptureAlignmentEntry> capture_alignment_periodic_ptp() {
  return {with_settings<CaptureAlignmentEntry>(
      {.name = "periodic_ptp",
       .family = "periodic_ptp",
       .summary = "frames on a grid of the common clock, each error taken off one frame",
       .source = kBasler,
       .needs = {Need::kFrameControl}},
      GridSettings{}, each_camera(follow_grid))};
}

}  // namespace simbench
