#include "watch/rig_watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "evaluation/diagnosis/diagnose.h"
#include "reports/text/time_text.h"

namespace simbench::watch {
namespace {

constexpr std::uint64_t kLargestGap = 1000;  // of a counter; more is another count
constexpr std::size_t kPeriodFrames = 64;
constexpr std::size_t kFewestFrames = 3;  // of a stretch

// The median interval of the last frames; NaN: too few.
double period_of(const std::deque<StampedFrame>& frames) {
  std::vector<double> intervals;
  const std::size_t first = frames.size() > kPeriodFrames ? frames.size() - kPeriodFrames : 0;
  for (std::size_t i = first + 1; i < frames.size(); ++i) {
    intervals.push_back(to_ms(frames[i].arrival - frames[i - 1].arrival));
  }
  return intervals.size() < kFewestFrames ? evaluation::kNan
                                          : evaluation::median(std::move(intervals));
}

// The frames of a camera that arrived from then on.
auto first_from(const std::deque<StampedFrame>& frames, double from_s) {
  return std::ranges::lower_bound(
      frames, from_s, {}, [](const StampedFrame& frame) { return to_seconds(frame.arrival); });
}

// Where most of the values are on a circle of a period.
double circular_mean(const std::vector<double>& values, double period_ms) {
  double sine = 0;
  double cosine = 0;
  for (const double value : values) {
    const double angle = 2 * std::numbers::pi * value / period_ms;
    sine += std::sin(angle);
    cosine += std::cos(angle);
  }
  return std::atan2(sine, cosine) * period_ms / (2 * std::numbers::pi);
}

// The median distance of a camera's arrivals of a stretch to the nearest of the reference's; NaN:
// too few. The median is about their circular mean, since a
// period more is the same phase.
double phase_in(const std::deque<StampedFrame>& frames, const std::deque<StampedFrame>& reference,
                double period_ms, double from_s, double to_s) {
  std::vector<double> distances;
  auto near = first_from(reference, from_s - period_ms / 1000);
  for (auto frame = first_from(frames, from_s);
       frame != frames.end() && to_seconds(frame->arrival) < to_s; ++frame) {
    const auto distance_ms = [&](const auto& of) { return to_ms(frame->arrival - of->arrival); };
    while (near != reference.end() && std::next(near) != reference.end() &&
           std::abs(distance_ms(std::next(near))) <= std::abs(distance_ms(near))) {
      ++near;
    }
    if (near == reference.end()) break;
    distances.push_back(distance_ms(near));
  }
  if (distances.size() < kFewestFrames) return evaluation::kNan;
  const double middle = circular_mean(distances, period_ms);
  for (double& distance : distances) distance = std::remainder(distance - middle, period_ms);
  return std::remainder(middle + evaluation::median(std::move(distances)), period_ms);
}

std::string subject_of(const WatchedCamera& camera) {
  return evaluation::called_camera(camera.camera);
}

}  // namespace

double WatchedCamera::last_s() const {
  return kept.empty() ? evaluation::kNan : to_seconds(kept.back().arrival);
}

std::optional<double> RigWatch::now_s() const {
  std::optional<double> last;
  for (const WatchedCamera& camera : cameras_) {
    if (!camera.kept.empty()) last = std::max(last.value_or(camera.last_s()), camera.last_s());
  }
  return last;
}

WatchedCamera& RigWatch::camera_of(const RecordedStream& stream) {
  const auto [place, is_new] =
      places_.try_emplace(stream.camera + '\n' + stream.stream, cameras_.size());
  if (is_new) {
    cameras_.push_back({.camera = stream.camera,
                        .host = stream.host,
                        .stream = stream.stream,
                        .counts = stream.counted});
    groups_[stream.stream].members.push_back(place->second);
  }
  return cameras_[place->second];
}

void RigWatch::add(const std::vector<RecordedStream>& streams) {
  for (const RecordedStream& stream : streams) {
    if (stream.frames.empty()) continue;
    WatchedCamera& camera = camera_of(stream);
    for (const StampedFrame& frame : stream.frames) add_frame(frame, camera);
  }
  forget_old();
}

void RigWatch::add_frame(const StampedFrame& frame, WatchedCamera& camera) {
  const double at_s = to_seconds(frame.arrival);
  if (!camera.kept.empty()) {
    // Its host's clock, or the recorder, began anew: what was before is another time.
    if (frame.arrival < camera.kept.back().arrival) {
      camera.kept.clear();
      camera.losses.clear();
      camera.missed = 0;
      camera.phase = {};
      groups_[camera.stream].from_s = evaluation::kNan;
    } else if (camera.counts) {
      const std::uint64_t before = camera.kept.back().counter;
      if (frame.counter <= before || frame.counter - before > kLargestGap) {
        tell({.kind = "restarted",
              .subject = subject_of(camera),
              .at_s = at_s,
              .text = fmt::format("{} counts its frames anew: {} after {}", subject_of(camera),
                                  frame.counter, before)});
      } else if (const auto lost = static_cast<std::int64_t>(frame.counter - before - 1);
                 lost > 0) {
        camera.lost += lost;
        camera.missed += lost;
        camera.losses.emplace_back(at_s, lost);
      }
    }
  }
  camera.kept.push_back(frame);
  ++camera.frames;
}

void RigWatch::forget_old() {
  const double now = now_s().value_or(0);
  for (WatchedCamera& camera : cameras_) {
    while (camera.kept.size() > 1 && to_seconds(camera.kept.front().arrival) < now - kKeptS) {
      camera.kept.pop_front();
    }
  }
}

std::vector<WatchEvent> RigWatch::look() {
  if (const std::optional<double> now = now_s()) {
    look_at_silence(*now);
    for (WatchedCamera& camera : cameras_) look_at_losses(camera, *now);
    for (auto& [stream, group] : groups_) {
      while (look_at_stretch(group)) {
      }
    }
  }
  return std::exchange(events_, {});
}

void RigWatch::look_at_losses(WatchedCamera& camera, double now_s) {
  while (!camera.losses.empty() && camera.losses.front().first < now_s - kLossS) {
    camera.missed -= camera.losses.front().second;
    camera.losses.pop_front();
  }
  const auto recent = camera.kept.end() - first_from(camera.kept, now_s - kLossS);
  const double due = static_cast<double>(camera.missed + recent);
  camera.lost_share = due > 0 ? static_cast<double>(camera.missed) / due : 0;
  const bool is_losing = camera.lost_share >= kLosingShare && camera.missed > 1;
  if (is_losing == camera.is_losing || (camera.is_losing && camera.missed > 0)) return;
  camera.is_losing = is_losing;
  const std::string subject = subject_of(camera);
  tell({.kind = "losing",
        .subject = subject,
        .at_s = now_s,
        .is_alarm = is_losing,
        .text = is_losing ? fmt::format("{} loses frames: {} of the last {:.0f}", subject,
                                        camera.missed, due)
                          : fmt::format("{} loses no more frames", subject)});
}

void RigWatch::look_at_silence(double now_s) {
  for (WatchedCamera& camera : cameras_) {
    if (camera.kept.empty()) continue;
    const double period_ms = period_of(camera.kept);
    if (!std::isnan(period_ms)) camera.period_ms = period_ms;
    if (std::isnan(camera.period_ms)) continue;
    const double patience_s = std::max(kStretchS, kSilentPeriods * camera.period_ms / 1000);
    const bool is_silent = now_s - camera.last_s() > patience_s;
    if (is_silent == camera.is_silent) continue;
    camera.is_silent = is_silent;
    const std::string subject = subject_of(camera);
    tell({.kind = "silent",
          .subject = subject,
          .at_s = is_silent ? camera.last_s() : now_s,
          .is_alarm = is_silent,
          .text = subject + (is_silent ? " sends no frames" : " sends frames again")});
  }
}

void RigWatch::choose_reference(Group& group, double from_s, double to_s) {
  const auto frames_in = [&](std::size_t member) {
    const std::deque<StampedFrame>& kept = cameras_[member].kept;
    return first_from(kept, to_s) - first_from(kept, from_s);
  };
  if (group.reference && frames_in(*group.reference) > 0) return;
  const std::size_t most = *std::ranges::max_element(group.members, {}, frames_in);
  if (frames_in(most) == 0) return;
  if (group.reference) {
    const double place_ms = cameras_[most].phase.phase_ms();
    for (const std::size_t member : group.members) {
      if (!std::isnan(place_ms)) cameras_[member].phase.shift(place_ms, cameras_[most].period_ms);
    }
  }
  group.reference = most;
}

// Whether a stretch was looked at; not before all cameras that go on have passed it.
bool RigWatch::look_at_stretch(Group& group) {
  double passed_s = evaluation::kNan;
  double longest_ms = 0;
  for (const std::size_t member : group.members) {
    const WatchedCamera& camera = cameras_[member];
    if (camera.is_silent || camera.kept.empty() || std::isnan(camera.period_ms)) continue;
    passed_s = std::isnan(passed_s) ? camera.last_s() : std::min(passed_s, camera.last_s());
    longest_ms = std::max(longest_ms, camera.period_ms);
    if (std::isnan(group.from_s)) group.from_s = to_seconds(camera.kept.front().arrival);
  }
  const double length_s = std::max(kStretchS, kStretchFrames * longest_ms / 1000);
  const double to_s = group.from_s + length_s;
  if (!(passed_s > to_s + longest_ms / 1000)) return false;
  // After a pause, and at the start of a long file, what is no longer kept is passed over.
  if (passed_s - group.from_s > kKeptS) {
    group.from_s = passed_s - kKeptS / 2;
    return true;
  }
  choose_reference(group, group.from_s, to_s);
  if (group.reference && group.members.size() > 1) {
    const WatchedCamera& reference = cameras_[*group.reference];
    std::map<std::size_t, double> phases;
    for (const std::size_t member : group.members) {
      const double phase_ms =
          phase_in(cameras_[member].kept, reference.kept, reference.period_ms, group.from_s, to_s);
      if (!std::isnan(phase_ms)) phases[member] = phase_ms;
    }
    judge(group, phases, to_s);
  }
  group.from_s = to_s;
  return true;
}

void RigWatch::judge(Group& group, const std::map<std::size_t, double>& phases, double to_s) {
  const double period_ms = cameras_[*group.reference].period_ms;
  std::vector<double> changes;
  for (const auto& [member, phase_ms] : phases) {
    const PhaseTrack& track = cameras_[member].phase;
    if (track.is_known()) changes.push_back(track.change_ms(phase_ms, period_ms));
  }
  // Two have no majority.
  const double common_ms = changes.size() > 2 ? evaluation::median(changes) : 0;
  for (const auto& [member, phase_ms] : phases) {
    WatchedCamera& camera = cameras_[member];
    const auto move = camera.phase.add(phase_ms, common_ms, period_ms);
    if (move) {
      tell_move(group, member, *move, to_s);
    } else if (camera.drifts && to_s - camera.drifts_since_s > kDriftEndsS) {
      camera.drifts = false;
      tell({.kind = "drifts",
            .subject = subject_of(camera),
            .at_s = to_s,
            .is_alarm = false,
            .text = subject_of(camera) + " keeps its phase again"});
    }
  }
}

void RigWatch::tell_move(const Group& group, std::size_t member, const PhaseMove& move,
                         double at_s) {
  WatchedCamera& camera = cameras_[member];
  std::string subject = subject_of(camera);
  if (group.members.size() == 2) {
    subject = fmt::format("cameras {} and {}", cameras_[group.members[0]].camera,
                          cameras_[group.members[1]].camera);
  }
  const std::string size = reports::time_text(std::abs(move.by_ms));
  const char* const way = move.by_ms > 0 ? "later" : "earlier";
  if (move.is_slip) {
    ++camera.slips;
    tell({.kind = "slipped",
          .subject = subject,
          .at_s = at_s,
          .text =
              fmt::format("{} slipped: {} is {} {} against the others, of a period of {}", subject,
                          camera.camera, size, way, reports::time_text(camera.period_ms))});
    return;
  }
  const bool is_new = !camera.drifts;
  camera.drifts = true;
  camera.drifts_since_s = at_s;
  if (!is_new) return;
  tell({.kind = "drifts",
        .subject = subject,
        .at_s = at_s,
        .text = fmt::format("{} drifts: {} is {} {} against the others by now; it follows a clock "
                            "of its own, or its host's clock does",
                            subject, camera.camera, size, way)});
}

std::vector<RecordedStream> RigWatch::kept() const {
  std::vector<RecordedStream> streams;
  for (const WatchedCamera& camera : cameras_) {
    streams.push_back({.camera = camera.camera,
                       .host = camera.host,
                       .stream = camera.stream,
                       .frames = {camera.kept.begin(), camera.kept.end()},
                       .counted = camera.counts});
  }
  return streams;
}

}  // namespace simbench::watch
