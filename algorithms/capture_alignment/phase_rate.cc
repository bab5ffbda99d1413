// phase_rate: every camera on one grid of the common time, by its own estimate of phase and rate.
//
// The grid is where one of the master's cameras happens to expose, the first that knows its phase:
// it need not move. The master tells the other hosts one instant of the grid, again and again, and
// nothing else. Each host steers its own cameras. A line that knows all moves (phase_line.h)
// follows a camera's exposures, so stamps are averaged over seconds and a frame to come is
// corrected before it is late:
//
//   - once the phase is known, one frame takes up all of its error: the only disturbed one;
//   - from then on one frame is longer or shorter by a granule or a few, whenever the error that
//     the line foretells exceeds the dead band, for as long as the rates differ;
//   - a camera that can do no more than insert frames is put where it will be on the grid in the
//     middle of the horizon. If the inserted frame's noise has left it more than the insert band
//     beside that, another is inserted; once it is there it stays until it has drifted out of twice
//     the band. How far an inserted frame moves the next ones is learned from the first.
//
// A control that was lost or did something else shows in the stamps (PhaseLine::is_surprised) and
// starts the line anew.
//
// The master's message is 8 bytes: the instant in nanoseconds of the common time, little-endian.
// Where the master has no camera, or none that delivers, it is 0.
//
// Source: simbench's own; that a leader should tell its phase is an idea of libsoftwaresync's
// README.

#include <algorithm>
#include <boost/endian/conversion.hpp>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "algorithms/capture_alignment/phase_line.h"
#include "algorithms/capture_alignment/steered_camera.h"
#include "algorithms/host_sync/join.h"
#include "algorithms/registry.h"

namespace simbench {
namespace {

struct PhaseRateSettings {
  std::size_t window = 60;  // frames of the line
  std::uint32_t learn_frames = 20;
  double dead_band_granules = 0.5;
  double insert_gain = 2;
  Nanoseconds insert_band = from_us(85);
  Nanoseconds horizon = from_seconds(10);

  void bind(ParameterBinder& parameters) {
    parameters.number("window_frames", window, 2, 1e5, "frames of the line", "ours: 2 s at 30 fps");
    parameters.number("learn_frames", learn_frames, 6, 1e5, "frames before a correction", "ours");
    parameters.number("dead_band_granules", dead_band_granules, 0.5, 1e6,
                      "errors below this are left, where a frame can be longer or shorter",
                      "ours: what rounding leaves");
    parameters.number("insert_band_ms", insert_band, 0.001, 1e3,
                      "as near an inserted frame has to come to its goal, where there is no other "
                      "control; what drifts out of twice this is moved again",
                      "ours: near libsoftwaresync's threshold; the disturbed frames that a camera "
                      "saves which stays");
    parameters.number("insert_gain", insert_gain, 0.5, 3,
                      "how often an inserted frame moves by its excess, until that is learned",
                      "libsoftwaresync's PhaseAligner, which lengthens by half of the shift");
    parameters.number("horizon_s", horizon, 0, 1e5, "time for which an inserted frame should last",
                      "ours: a take");
  }
};

// Errors below it are reported as aligned, if no step of the camera is larger.
constexpr Nanoseconds kReportedTolerance = from_ms(1);
// A goal may be wrong by this share of the insert band.
constexpr double kUnknownShare = 0.125;

// An instant of the grid, as the cameras of a host know it.
struct SharedGrid {
  bool is_mine = false;  // the host's first camera that knows its phase sets it
  std::optional<HostTime> due{};
};

// The steering of one camera.
class PhaseRateCamera {
 public:
  PhaseRateCamera(Host& host, FrameControl& control, const PhaseRateSettings& settings,
                  std::shared_ptr<SharedGrid> grid)
      : camera_(host, control),
        settings_(settings),
        grid_(std::move(grid)),
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
  bool take_grid(std::uint32_t from);
  std::uint32_t next_effect(const ExposedFrame& frame) const;
  bool only_inserts() const;
  bool knows_enough() const;
  double insert_goal_ns() const;
  bool is_good(double error_ns);
  // Moves below this, a hundredth of a frame, are part of the camera's course.
  double large_ns() const {
    return std::max(to_ns(limits_.frame_length) / 100, 20 * to_ns(limits_.granularity));
  }
  Correction exact(double error_ns) const;
  Correction inserted(double error_ns) const;
  Task<bool> correct(std::uint32_t from, double error_ns);
  Task<bool> move(Nanoseconds by);
  void learn_gain();
  void report(std::uint32_t counter);

  SteeredCamera camera_;
  PhaseRateSettings settings_;
  std::shared_ptr<SharedGrid> grid_;
  FrameControlLimits limits_;
  PhaseLine line_;
  std::uint32_t quiet_until_ = 0;  // no control before this frame
  bool has_frames_ = false;
  bool has_grid_ = false;
  bool resets_length_ = false;
  bool holds_ = false;  // an inserted frame has put it where it should be
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

// A goal that lies some seconds ahead needs a rate that is known.
bool PhaseRateCamera::knows_enough() const {
  if (line_.frames() < settings_.learn_frames) return false;
  const double half_horizon = 0.5 * to_ns(settings_.horizon) / to_ns(limits_.frame_length);
  return !only_inserts() ||
         line_.slope_sigma_ns() * half_horizon < kUnknownShare * to_ns(settings_.insert_band);
}

// Ahead of the grid by half of what it will drift within the horizon.
double PhaseRateCamera::insert_goal_ns() const {
  const double drift_ns = line_.slope_ns() * to_ns(settings_.horizon) / to_ns(limits_.frame_length);
  const double most_ns = to_ns(settings_.insert_band);
  return -std::clamp(drift_ns / 2, -most_ns, most_ns);
}

// Whether the camera is left alone with this error.
bool PhaseRateCamera::is_good(double error_ns) {
  if (!only_inserts()) {
    return std::abs(error_ns) <= settings_.dead_band_granules * to_ns(limits_.granularity);
  }
  const double band_ns = to_ns(settings_.insert_band);
  holds_ =
      holds_ ? std::abs(error_ns) <= 2 * band_ns : std::abs(error_ns - insert_goal_ns()) <= band_ns;
  return holds_;
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
  const double goal_ns = insert_goal_ns();
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

// The first frames after an inserted one show the gain.
void PhaseRateCamera::learn_gain() {
  if (inserted_.count() == 0 || knows_gain_) return;
  const double moved_ns = line_.error_ns(quiet_until_) - before_insert_ns_;
  const double gain = moved_ns / to_ns(inserted_);
  // What an inserted frame moves is its own length's excess, or that of two.
  if (gain > 0.5 && gain < 3) insert_gain_ = gain;
  knows_gain_ = true;
}

void PhaseRateCamera::report(std::uint32_t counter) {
  const double error_ns = std::abs(line_.error_ns(counter));
  const double largest_step_ns =
      to_ns(only_inserts() ? settings_.insert_band : limits_.granularity);
  const bool is_aligned = error_ns < std::max(to_ns(kReportedTolerance), 2 * largest_step_ns);
  camera_.report(is_aligned, is_aligned ? "" : "on its way to the grid");
}

// Adds the frame to the line; false while too little is known for a control.
bool PhaseRateCamera::add(const ExposedFrame& frame) {
  if (!has_frames_) quiet_until_ = frame.counter + settings_.learn_frames;
  const bool is_after_move = has_frames_ && line_.frames() == 0;
  has_frames_ = true;
  if (is_after_move && frame.counter < quiet_until_) return false;
  if (frame.has_new_source) line_.forget();
  line_.add(frame.counter, frame.exposed);
  if (line_.is_surprised(large_ns())) line_.forget();
  return frame.counter >= quiet_until_ && knows_enough();
}

// False while no grid is known.
bool PhaseRateCamera::take_grid(std::uint32_t from) {
  if (has_grid_) return true;
  if (!grid_->due) {
    if (!grid_->is_mine) return false;
    const double goal_ns = only_inserts() ? insert_goal_ns() : 0;
    grid_->due = line_.due(from) + from_ns(line_.error_ns(from) - goal_ns);
  }
  line_.set_grid(*grid_->due, from);
  return has_grid_ = true;
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
    const std::uint32_t from = next_effect(frame);
    if (!take_grid(from)) continue;
    learn_gain();
    report(frame.counter);
    const double error_ns = line_.error_ns(from);
    if (is_good(error_ns)) continue;
    const bool is_taken = co_await correct(from, error_ns);
    if (!is_taken) co_return;
  }
}

Task<void> steer_by_line(Host& host, FrameControl& control, PhaseRateSettings settings,
                         std::shared_ptr<SharedGrid> grid) {
  PhaseRateCamera steering(host, control, settings, std::move(grid));
  co_await steering.run();
}

constexpr Nanoseconds kGridInterval = from_ms(500);
// Times this far from zero can still be subtracted.
constexpr std::int64_t kLastInstantNs = std::int64_t{1} << 62;

Task<void> tell_grid(Host& host, std::vector<PeerId> slaves, std::shared_ptr<SharedGrid> grid) {
  const SteadyTime latest = host.steady_clock().now() + SteeredCamera::kPatience;
  while (true) {
    const bool is_late = host.frame_controls().empty() || host.steady_clock().now() > latest;
    if (!grid->due && is_late) grid->due = HostTime{};
    if (grid->due) {
      Bytes message(sizeof(std::int64_t));
      boost::endian::store_little_s64(reinterpret_cast<unsigned char*>(message.data()),
                                      grid->due->time_since_epoch().count());
      for (const PeerId slave : slaves) {
        co_await host.open_channel(slave, Transport::kAlignment).send(message);
      }
    }
    co_await host.sleep_for(kGridInterval);
  }
}

Task<void> hear_grid(Host& host, PeerId master, std::shared_ptr<SharedGrid> grid) {
  MessageChannel& channel = host.open_channel(master, Transport::kAlignment);
  while (!grid->due) {
    const std::optional<ReceivedMessage> received =
        co_await channel.receive(host.steady_clock().now() + kIdle);
    if (!received || received->bytes.size() != sizeof(std::int64_t)) continue;
    const std::int64_t due_ns = boost::endian::load_little_s64(
        reinterpret_cast<const unsigned char*>(received->bytes.data()));
    if (due_ns > -kLastInstantNs && due_ns < kLastInstantNs)
      grid->due = HostTime(Nanoseconds(due_ns));
  }
}

class PhaseRate final : public CaptureAlignment {
 public:
  explicit PhaseRate(const PhaseRateSettings& settings) : settings_(settings) {}

  Task<void> run_master(Host& host, std::vector<PeerId> slaves) override {
    auto grid = std::make_shared<SharedGrid>(SharedGrid{.is_mine = true});
    return run(host, tell_grid(host, std::move(slaves), grid), grid);
  }
  Task<void> run_slave(Host& host, PeerId master) override {
    auto grid = std::make_shared<SharedGrid>();
    return run(host, hear_grid(host, master, grid), grid);
  }

 private:
  Task<void> run(Host& host, Task<void> messages, std::shared_ptr<SharedGrid> grid) const {
    std::vector<Task<void>> tasks;
    tasks.reserve(host.frame_controls().size() + 1);
    tasks.push_back(std::move(messages));
    for (FrameControl* const camera : host.frame_controls()) {
      tasks.push_back(steer_by_line(host, *camera, settings_, grid));
    }
    return join_all(std::move(tasks));
  }

  PhaseRateSettings settings_;
};

}  // namespace

std::vector<CaptureAlignmentEntry> capture_alignment_phase_rate() {
  return {with_settings<CaptureAlignmentEntry>(
      {.name = "phase_rate",
       .family = "phase_rate",
       .summary =
           "phase and rate of each camera from one line over its stamps: one disturbed frame, "
           "then single granules",
       .source = "ours",
       .needs = {Need::kFrameControl}},
      PhaseRateSettings{}, kMake<PhaseRate>)};
}

}  // namespace simbench
