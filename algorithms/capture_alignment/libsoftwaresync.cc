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
// What a phone does by an exposure alone is a frame of that length here; so the overhead counts
// only where the least exposure does. The configurations' periods and least exposures are those of
// one phone model and rate: here the camera's own nominal period, and how far the least exposure
// lies above that. The latest frame's phase counts, unfiltered. The start is the leader's button,
// pressed `start_s` after the cameras began.

#include <algorithm>
#include <memory>
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
  Nanoseconds start;
  Nanoseconds period;  // 0: the camera's own
  Nanoseconds goal;
  Nanoseconds threshold;
  Nanoseconds overhead;
  Nanoseconds least_exposure_over_period;
  double share_of_shift;
  int iterations;
  Nanoseconds settle;
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

PhaseAlignSettings phase_align_settings(const Parameters& parameters) {
  return {.start = from_seconds(parameters.number("start_s")),
          .period = from_ms(parameters.number("period_ms")),
          .goal = from_ms(parameters.number("goal_phase_ms")),
          .threshold = from_ms(parameters.number("threshold_ms")),
          .overhead = from_ms(parameters.number("overhead_ms")),
          .least_exposure_over_period = from_us(parameters.number("least_exposure_over_period_us")),
          .share_of_shift = parameters.number("share_of_shift"),
          .iterations = static_cast<int>(parameters.number("iterations")),
          .settle = from_ms(parameters.number("settle_ms"))};
}

}  // namespace

std::vector<CaptureAlignmentEntry> capture_alignment_libsoftwaresync() {
  CaptureAlignmentEntry entry;
  entry.info.name = "libsoftwaresync";
  entry.info.family = "libsoftwaresync";
  entry.info.summary = "single longer frames move each camera to a goal phase, once, then free run";
  entry.info.source = kPhaseAligner;
  entry.info.parameters = {
      number_parameter("start_s", 2, 0, 1e6, "from the cameras' start to the leader's button",
                       kAssumption),
      number_parameter("period_ms", 0, 0, 1e5,
                       "of the phases; 0: the camera's nominal frame length",
                       "assumption: a configuration is of a phone model, pixel3: 33.32"),
      number_parameter("goal_phase_ms", 15, 0, 1e5, "the phase that all cameras move to",
                       kPhaseConfig),
      number_parameter("threshold_ms", 0.1, 0, 1e5, "a phase nearer to the goal is aligned",
                       kPhaseConfig),
      number_parameter("overhead_ms", 0.2, 0, 1e5, "of a frame beyond its exposure", kPhaseConfig),
      number_parameter("least_exposure_over_period_us", 50, -1e5, 1e5,
                       "the least exposure of an inserted frame, less the period", kPhaseConfig),
      number_parameter("share_of_shift", 0.5, 0.01, 1, "by which the inserted frame is longer",
                       kPhaseAligner),
      number_parameter("iterations", 5, 1, 1e4, "most frames to insert", kPhaseAligner),
      number_parameter("settle_ms", 400, 1, 1e6, "from one look at the phase to the next",
                       kPhaseAligner),
  };
  entry.info.needs = {Need::kFrameControl};
  entry.make = [](const Parameters& parameters) {
    const PhaseAlignSettings settings = phase_align_settings(parameters);
    return std::make_unique<EachCamera>([settings](Host& host, FrameControl& camera) {
      return align_phase(host, camera, settings);
    });
  };
  return {entry};
}

}  // namespace simbench
