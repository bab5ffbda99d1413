// The phase alignment of phones (libsoftwaresync): single longer frames move each phone's frames to
// the same phase of the common clock, later only, within about two seconds; nothing holds them
// there afterwards.
//
//     phase = exposed mod period, diff = goal - phase, aligned where |diff| < threshold
//     d = diff, a period more if negative;  frame = period + share * d
//     inserted: max(least exposure, frame - overhead) + overhead
//
// The share, a half, is the publication's: its phones stretch about two frames for one that is
// inserted. Where only the inserted one is longer, each iteration halves what is left; a share of 1
// suits such cameras.
//
// A phone inserts a frame by its exposure alone; here it is a frame of that length, so the overhead
// counts only where the least exposure does. The configurations have periods and least exposures of
// one phone model and rate; here they are the camera's own nominal period, and how far the least
// exposure lies above that. The latest frame's phase counts, unfiltered. The start is the leader's
// button, pressed `start_s` after the cameras began.

#include <algorithm>
#include <string>
#include <vector>

#include "algorithms/capture_alignment/steered_camera.h"
#include "algorithms/registry.h"

namespace simbench {
namespace {

const char* const kPhaseConfig =
    "google-research/libsoftwaresync, res/raw/pixel3_phaseconfig.json; Ansari et al. 2019";
const char* const kPhaseAligner =
    "google-research/libsoftwaresync, PhaseAlignController.java; Ansari et al. 2019";

struct PhaseAlignSettings {
  Nanoseconds start = from_seconds(2);
  Nanoseconds period{0};  // 0: the camera's own
  Nanoseconds goal = from_ms(15);
  Nanoseconds threshold = from_us(100);
  Nanoseconds overhead = from_us(200);
  Nanoseconds least_exposure_over_period = from_us(50);
  double share_of_shift = 0.5;
  int iterations = 5;
  Nanoseconds settle = from_ms(400);

  void bind(ParameterBinder& parameters) {
    parameters.number("start_s", start, 0, 1e6, "from the cameras' start to the leader's button",
                      kAssumption);
    parameters.number("period_ms", period, 0, 1e5,
                      "of the phases; 0: the camera's nominal frame length",
                      "assumption: a configuration is of a phone model, pixel3: 33.32");
    parameters.number("goal_phase_ms", goal, 0, 1e5, "the phase that all cameras move to",
                      kPhaseConfig);
    parameters.number("threshold_ms", threshold, 0, 1e5, "a phase nearer to the goal is aligned",
                      kPhaseConfig);
    parameters.number("overhead_ms", overhead, 0, 1e5, "of a frame beyond its exposure",
                      kPhaseConfig);
    parameters.number("least_exposure_over_period_us", least_exposure_over_period, -1e5, 1e5,
                      "the least exposure of an inserted frame, less the period", kPhaseConfig);
    parameters.number("share_of_shift", share_of_shift, 0.01, 1,
                      "by which the inserted frame is longer", kPhaseAligner);
    parameters.number("iterations", iterations, 1, 1e4, "most frames to insert", kPhaseAligner);
    parameters.number("settle_ms", settle, 1, 1e6, "from one look at the phase to the next",
                      kPhaseAligner);
  }
};

Nanoseconds inserted_length(const PhaseAlignSettings& settings, Nanoseconds period,
                            Nanoseconds difference) {
  const Nanoseconds later = difference.count() < 0 ? difference + period : difference;
  const Nanoseconds frame = period + from_ns(settings.share_of_shift * to_ns(later));
  const Nanoseconds least = period + settings.least_exposure_over_period;
  return std::max(least, frame - settings.overhead) + settings.overhead;
}

// Goal less phase, which is not wrapped.
Nanoseconds phase_difference(const PhaseAlignSettings& settings, Nanoseconds period,
                             const ExposedFrame& frame) {
  const Nanoseconds time = frame.exposed.time_since_epoch();
  const Nanoseconds phase = time - period * floor_div(time.count(), period.count());
  return settings.goal % period - phase;
}

Task<void> align_phase(Host& host, FrameControl& control, PhaseAlignSettings settings) {
  SteeredCamera camera(host, control);
  const bool has_own = settings.period.count() == 0;
  const Nanoseconds period = has_own ? camera.limits().frame_length : settings.period;
  SteadyTime due = host.steady_clock().now() + settings.start;
  int inserted = 0;
  while (true) {
    const ExposedFrame frame = co_await camera.next_frame();
    if (frame.arrival_steady < due) continue;
    const Nanoseconds difference = phase_difference(settings, period, frame);
    if (std::chrono::abs(difference) < settings.threshold) {
      camera.report(true);
      co_return;
    }
    if (inserted == settings.iterations) break;
    const bool is_taken =
        co_await camera.insert_frame(inserted_length(settings, period, difference));
    if (!is_taken) co_return;
    ++inserted;
    due = frame.arrival_steady + settings.settle;
  }
  camera.report(false, "not at the goal phase after " + std::to_string(inserted) +
                           " inserted frames; more iterations or a wider threshold would help");
}

}  // namespace

std::vector<CaptureAlignmentEntry> capture_alignment_libsoftwaresync() {
  return {with_settings<CaptureAlignmentEntry>(
      {.name = "libsoftwaresync",
       .family = "libsoftwaresync",
       .summary = "single longer frames move each camera to a goal phase, once, then free run",
       .source = kPhaseAligner,
       .needs = {Need::kFrameControl}},
      PhaseAlignSettings{}, each_camera(align_phase))};
}

}  // namespace simbench
