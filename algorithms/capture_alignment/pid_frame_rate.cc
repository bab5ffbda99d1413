// Frames on slots of the common clock by a PID regulator of the frame rate, as Luxonis describes it
// for its RVC4 cameras: slot k begins k periods after the zero of the master's clock, and the
// regulator makes all frames a little longer or shorter until they lock, and goes on.
//
//     error e = the frame's distance to the nearest slot, of each frame that is delivered
//     change of the length = -(kp e + ki sum(e) + kd (e - previous e)), within +-limit_percent
//
// Nobody documents gains, limits or the residual. The gains here are classical ones for a frame's
// phase, which is the integral of its length: kp is that of a published controller of frame
// durations, ki = kp^2 / 4 is critical damping, kd is small against kp, whose loop is slow against
// the latency of the controls. The sum stands still while the change is at its limit (anti-windup).
//
// A camera rounds lengths to its granularity. The controller carries the rest on to the next frame,
// so that the mean length is the wanted one; what a real one does is not known. A length that is
// the same as the one that was last sent is sent again only if the frames that should show it are
// still away from their slots: it may have been lost.

#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

#include "algorithms/capture_alignment/steered_camera.h"
#include "algorithms/registry.h"

namespace simbench {
namespace {

const char* const kPtpSlots = "docs.luxonis.com, PTP synchronization (RVC4)";

struct PidSettings {
  double kp = 0.05;
  double ki = 0.000625;
  double kd = 0.01;
  double limit_percent = 1;  // of the period
  Nanoseconds tolerance = from_us(100);

  void bind(ParameterBinder& parameters) {
    parameters.number("kp", kp, 0, 1, "change of the length for an error",
                      "picamera2 issue 1050, a controller of frame durations");
    parameters.number("ki", ki, 0, 1, "for the sum of the errors",
                      "assumption: kp^2 / 4, critical damping");
    parameters.number("kd", kd, 0, 1, "for the change of the error from frame to frame",
                      kAssumption);
    parameters.number("limit_percent", limit_percent, 0.001, 50,
                      "largest change of the length of a frame", kAssumption);
    parameters.number("tolerance_us", tolerance, 0, 1e6, "a frame nearer to its slot is aligned",
                      kAssumption);
  }
};

// The lengths of a camera's frames, in nanoseconds.
class FramePid {
 public:
  FramePid(const PidSettings& settings, Nanoseconds period, Nanoseconds shortest,
           Nanoseconds longest)
      : settings_(settings),
        period_ns_(to_ns(period)),
        low_ns_(std::max(-settings.limit_percent / 100 * period_ns_, to_ns(shortest - period))),
        high_ns_(std::min(settings.limit_percent / 100 * period_ns_, to_ns(longest - period))) {}

  double length_ns(double error_ns) {
    const double step_ns = is_first_ ? 0 : error_ns - previous_ns_;
    is_first_ = false;
    previous_ns_ = error_ns;
    const double sum_ns = sum_ns_ + error_ns;
    const double change_ns =
        -(settings_.kp * error_ns + settings_.ki * sum_ns + settings_.kd * step_ns);
    const double limited_ns = std::clamp(change_ns, low_ns_, high_ns_);
    if (limited_ns == change_ns) sum_ns_ = sum_ns;
    return period_ns_ + limited_ns;
  }

 private:
  PidSettings settings_;
  double period_ns_;
  double low_ns_;
  double high_ns_;
  double sum_ns_ = 0;
  double previous_ns_ = 0;
  bool is_first_ = true;
};

Task<void> regulate_rate(Host& host, FrameControl& control, PidSettings settings) {
  SteeredCamera camera(host, control);
  const Nanoseconds period = camera.limits().frame_length;
  if (period <= camera.shortest() || period >= camera.longest()) {
    const auto in_ms = [](Nanoseconds time) { return std::to_string(to_ms(time)) + " ms"; };
    camera.report(false, "found slots of " + in_ms(period) + ", allowed: between " +
                             in_ms(camera.shortest()) + " and " + in_ms(camera.longest()) +
                             "; choose another rate or exposure");
    co_return;
  }
  FramePid pid(settings, period, camera.shortest(), camera.longest());
  Nanoseconds sent = camera.length();
  double carried_ns = 0;
  while (true) {
    const ExposedFrame frame = co_await camera.next_frame();
    const Nanoseconds error = phase_error(frame.exposed.time_since_epoch(), period);
    const bool is_aligned = std::chrono::abs(error) <= settings.tolerance;
    camera.report(is_aligned, is_aligned ? "" : "on its way to its slots");
    const double wanted_ns = pid.length_ns(to_ns(error)) + carried_ns;
    const Nanoseconds length = camera.limits().nearest(from_ns(wanted_ns));
    const double granule_ns = to_ns(camera.limits().granularity);
    carried_ns = std::clamp(wanted_ns - to_ns(length), -granule_ns, granule_ns);
    if (length == sent && (is_aligned || !camera.is_settled(frame))) continue;
    const bool is_taken = co_await camera.set_frame_length(length);
    if (!is_taken) co_return;
    sent = length;
  }
}

}  // namespace

std::vector<CaptureAlignmentEntry> capture_alignment_pid_frame_rate() {
  return {with_settings<CaptureAlignmentEntry>(
      {.name = "pid_frame_rate",
       .family = "pid_frame_rate",
       .summary = "a PID regulator of the frame rate locks the frames to slots of the clock",
       .source = kPtpSlots,
       .needs = {Need::kFrameControl}},
      PidSettings{}, each_camera(regulate_rate))};
}

}  // namespace simbench
