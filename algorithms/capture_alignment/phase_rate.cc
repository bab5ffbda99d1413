// phase_rate: every camera on a grid of the common time, by its own estimate of phase and rate.
//
// Each host steers its own cameras towards the multiples of the frame length on the common clock,
// so hosts need no message but those of host_sync. A camera's exposures are followed by a line
// (phase_line.h) that knows all moves, so stamps are averaged over seconds and a frame to come is
// corrected before it is late:
//
//   - once the phase is known, one frame takes up all of its error: the only disturbed one;
//   - from then on one frame is longer or shorter by a granule or a few, whenever the error that
//   the
//     line foretells exceeds the dead band, for as long as the rates differ;
//   - a camera that can do no more than insert frames is put ahead of the grid by half of what it
//     will drift within the horizon, and moved again when it has left the insert band; how far an
//     inserted frame moves the next ones is learned from the first.
//
// A control that was lost or did something else shows in the stamps (PhaseLine::is_surprised) and
// starts the line anew.
//
// Source: simbench's own.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "algorithms/capture_alignment/phase_line.h"
#include "algorithms/capture_alignment/steered_camera.h"
#include "algorithms/registry.h"

namespace simbench {
namespace {

struct PhaseRateSettings {
  std::size_t window = 60;  // frames of the line
  std::uint32_t learn_frames = 20;
  double dead_band_granules = 0.5;
  double insert_gain = 2;
  Nanoseconds insert_band = from_us(150);
  Nanoseconds horizon = from_seconds(30);
  Nanoseconds tolerance = from_ms(1);  // "aligned", of what is reported
};

// The steering of one camera.
class PhaseRateCamera {
 public:
  PhaseRateCamera(Host& host, FrameControl& control, const PhaseRateSettings& settings)
      : camera_(host, control),
        settings_(settings),
        limits_(control.limits()),
        line_(limits_.frame_length, settings.window),
        insert_gain_(settings.insert_gain) {}

  Task<void> run();

 private:
  // A correction of the error at a frame to come, as a control makes it.
  struct Correction {
    Nanoseconds by{};          // later by this
    std::int64_t periods = 0;  // of the grid that are skipped
  };

  bool is_usable(const ExposedFrame& frame) const;
  bool add(const ExposedFrame& frame);
  std::uint32_t next_effect(const ExposedFrame& frame) const;
  bool only_inserts() const;
  double band_ns() const;
  // Moves below this, a hundredth of a frame, are part of the camera's course.
  double large_ns() const {
    return std::max(to_ns(limits_.frame_length) / 100, 20 * to_ns(limits_.granularity));
  }
  Correction exact(double error_ns) const;
  Correction inserted(double error_ns) const;
  Task<bool> correct(std::uint32_t from, double error_ns);
  Task<bool> move(Nanoseconds by);
  void learn_gain();
  void report();

  SteeredCamera camera_;
  PhaseRateSettings settings_;
  FrameControlLimits limits_;
  PhaseLine line_;
  std::uint32_t quiet_until_ = 0;  // no control before this frame
  bool has_frames_ = false;
  bool resets_length_ = false;
  double insert_gain_;
  bool knows_gain_ = false;
  Nanoseconds inserted_{};       // by which the last inserted frame was longer
  double before_insert_ns_ = 0;  // the error without it
};

// Inserted frames have another exposure, and another middle.
bool PhaseRateCamera::is_usable(const ExposedFrame& frame) const {
  return frame.exposure < limits_.exposure + (limits_.frame_length - limits_.exposure) / 2;
}

// The first frame whose exposure a control that is sent now moves.
std::uint32_t PhaseRateCamera::next_effect(const ExposedFrame& frame) const {
  const std::int64_t since = (frame.arrival - frame.exposed - limits_.exposure / 2).count();
  const std::int64_t in_progress =
      std::max<std::int64_t>(0, floor_div(since, limits_.frame_length.count()));
  return frame.counter + static_cast<std::uint32_t>(in_progress) + limits_.latency_frames + 1;
}

bool PhaseRateCamera::only_inserts() const {
  return !limits_.allows(FrameControlKind::kAdjustFrame) &&
         !limits_.allows(FrameControlKind::kFrameLength);
}

// Errors below this are left.
double PhaseRateCamera::band_ns() const {
  return only_inserts() ? 2 * to_ns(settings_.insert_band)
                        : settings_.dead_band_granules * to_ns(limits_.granularity);
}

// One frame that is shorter if it can be, else one that is longer.
PhaseRateCamera::Correction PhaseRateCamera::exact(double error_ns) const {
  const Nanoseconds usual = camera_.length();
  const Nanoseconds wanted = usual - from_ns(error_ns);
  if (wanted >= camera_.shortest() && wanted <= camera_.longest()) {
    return {.by = limits_.nearest(wanted) - usual};
  }
  const std::int64_t periods = error_ns > 0 ? 1 : 0;
  const Nanoseconds later = from_ns(-error_ns) + periods * limits_.frame_length;
  return {.by = limits_.nearest(usual + later) - usual, .periods = periods};
}

// Later by at least what the shortest inserted frame moves.
PhaseRateCamera::Correction PhaseRateCamera::inserted(double error_ns) const {
  const double period_ns = to_ns(limits_.frame_length);
  const double drift_ns = line_.slope_ns() * to_ns(settings_.horizon) / period_ns;
  const double most_ns = to_ns(settings_.insert_band);
  const double goal_ns = -std::clamp(drift_ns / 2, -most_ns, most_ns);
  const double least_ns = std::max(0.0, to_ns(limits_.shortest - camera_.length())) * insert_gain_;
  const double missing_ns = least_ns - (goal_ns - error_ns);
  const double periods = std::max(0.0, std::ceil(missing_ns / period_ns));
  return {.by = from_ns(goal_ns - error_ns + periods * period_ns),
          .periods = static_cast<std::int64_t>(periods)};
}

Task<bool> PhaseRateCamera::move(Nanoseconds by) {
  if (limits_.allows(FrameControlKind::kAdjustFrame)) return camera_.adjust_frame(by);
  if (limits_.allows(FrameControlKind::kFrameLength)) {
    resets_length_ = true;
    return camera_.set_frame_length(camera_.length() + by);
  }
  inserted_ = from_ns(to_ns(by) / insert_gain_);
  return camera_.insert_frame(camera_.length() + inserted_);
}

// False if the camera refuses.
Task<bool> PhaseRateCamera::correct(std::uint32_t from, double error_ns) {
  const Correction correction = only_inserts() ? inserted(error_ns) : exact(error_ns);
  if (correction.by.count() == 0) co_return true;
  before_insert_ns_ =
      error_ns - static_cast<double>(correction.periods) * to_ns(limits_.frame_length);
  const bool is_taken = co_await move(correction.by);
  if (!is_taken) co_return false;
  line_.move(from, correction.by);
  line_.shift_grid(correction.periods);
  // A large move may come a frame earlier or later than foretold: those frames are of no use, and
  // nothing is known until they are over. A small one is in the line at once.
  if (std::abs(to_ns(correction.by)) <= large_ns()) co_return true;
  quiet_until_ = from + 3;
  line_.restart();
  co_return true;
}

// From the first frames after an inserted one.
void PhaseRateCamera::learn_gain() {
  if (inserted_.count() == 0 || knows_gain_) return;
  const double moved_ns = line_.error_ns(quiet_until_) - before_insert_ns_;
  const double gain = moved_ns / to_ns(inserted_);
  // What an inserted frame moves is its own length's excess, or that of two.
  if (gain > 0.5 && gain < 3) insert_gain_ = gain;
  knows_gain_ = true;
}

void PhaseRateCamera::report() {
  const double error_ns = std::abs(line_.error_ns(quiet_until_));
  const bool is_aligned = error_ns < std::max(to_ns(settings_.tolerance), 2 * band_ns());
  camera_.report(is_aligned, is_aligned ? "" : "on its way to the grid");
}

// Adds the frame to the line; false while too little is known for a control.
bool PhaseRateCamera::add(const ExposedFrame& frame) {
  if (!has_frames_) quiet_until_ = frame.counter + settings_.learn_frames;
  const bool is_after_move = has_frames_ && line_.frames() == 0;
  has_frames_ = true;
  if (is_after_move && frame.counter < quiet_until_) return false;
  line_.add(frame.counter, frame.exposed);
  if (line_.is_surprised(large_ns())) line_.restart();
  return frame.counter >= quiet_until_ && line_.frames() >= settings_.learn_frames;
}

Task<void> PhaseRateCamera::run() {
  std::string why = only_inserts() ? "" : camera_.unreachable(limits_.frame_length);
  if (!why.empty()) {
    camera_.report(false, std::move(why));
    co_return;
  }
  while (true) {
    const ExposedFrame frame = co_await camera_.next_frame();
    if (!is_usable(frame)) continue;
    if (resets_length_) {
      resets_length_ = false;
      co_await camera_.set_frame_length(camera_.length());
    }
    if (!add(frame)) continue;
    learn_gain();
    report();
    const std::uint32_t from = next_effect(frame);
    const double error_ns = line_.error_ns(from);
    if (std::abs(error_ns) <= band_ns()) continue;
    const bool is_taken = co_await correct(from, error_ns);
    if (!is_taken) co_return;
  }
}

Task<void> steer_by_line(Host& host, FrameControl& control, PhaseRateSettings settings) {
  PhaseRateCamera steering(host, control, settings);
  co_await steering.run();
}

CaptureAlignmentEntry phase_rate() {
  CaptureAlignmentEntry entry;
  entry.info.name = "phase_rate";
  entry.info.family = "phase_rate";
  entry.info.summary =
      "phase and rate of each camera from one line over its stamps: one disturbed frame, then "
      "single granules";
  entry.info.source = "ours";
  entry.info.needs = {Need::kFrameControl};
  entry.info.parameters = {
      number_parameter("window_frames", 60, 2, 1e5, "frames of the line", "ours: 2 s at 30 fps"),
      number_parameter("learn_frames", 20, 6, 1e5, "frames before a correction", "ours"),
      number_parameter("dead_band_granules", 0.5, 0.5, 1e6,
                       "errors below this are left, where a frame can be longer or shorter",
                       "ours: what rounding leaves"),
      number_parameter("insert_band_ms", 0.15, 0.001, 1e3,
                       "errors below twice this are left, where frames can be inserted only",
                       "ours"),
      number_parameter("insert_gain", 2, 0.5, 3,
                       "how often an inserted frame moves by its excess, until that is learned",
                       "libsoftwaresync's PhaseAligner, which lengthens by half of the shift"),
      number_parameter("horizon_s", 30, 0, 1e5, "time for which an inserted frame should last",
                       "ours"),
  };
  entry.make = [](const Parameters& parameters) {
    PhaseRateSettings settings;
    settings.window = static_cast<std::size_t>(parameters.number("window_frames"));
    settings.learn_frames = static_cast<std::uint32_t>(parameters.number("learn_frames"));
    settings.dead_band_granules = parameters.number("dead_band_granules");
    settings.insert_band = from_ms(parameters.number("insert_band_ms"));
    settings.insert_gain = parameters.number("insert_gain");
    settings.horizon = from_seconds(parameters.number("horizon_s"));
    return std::make_unique<EachCamera>([settings](Host& host, FrameControl& control) {
      return steer_by_line(host, control, settings);
    });
  };
  return entry;
}

}  // namespace

std::vector<CaptureAlignmentEntry> capture_alignment_phase_rate() { return {phase_rate()}; }

}  // namespace simbench
