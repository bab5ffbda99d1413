// Cameras that are watched: whose frames come, whose are lost, whose phase has moved, since when.
//
// Problem: whether cameras still expose together is asked while they run, of arrivals that jitter
// by milliseconds, for weeks, in little memory.
//
// Naive attempt: run `diagnose` on the last minutes, again and again. It takes a tenth of a second
// for a minute of 18 cameras, and a camera that slipped a second ago is a sixtieth of what it sees.
//
// Key idea: only differences between cameras are looked at, in stretches of kStretchS (or
// kStretchFrames, if these take longer). A camera's phase is the median over a stretch of its
// arrivals less the nearest arrival of a reference camera, within half a period. What all cameras
// share (a host's clock that is stepped or slewed, a host that is busy) cancels. A phase has moved
// if it lies farther from where it was than phase_track.h allows, beyond what the median over all
// cameras has moved, in two stretches that agree.
//
//  - slipped: it moved from one stretch to the next: known within three stretches, 1.5 s;
//  - drifts: it left its place little by little: the camera follows a clock of its own;
//  - silent: no frame for kSilentPeriods periods or a stretch, whichever is longer, while others go
//    on;
//  - losing: kLosingShare of its frames or more were lost within kLossS, by its counter;
//  - restarted: its counter went back.
//
// With two cameras nobody can tell which of them moved: the subject is both.
//
// Time is that of the arrivals; nothing is asked of the machine's clock. The same frames give the
// same events, in whatever pieces they come.
//
// Memory: kKeptS seconds of each camera's frames; nothing grows with time. Cost: linear in the new
// frames and those of a stretch.
//
//   RigWatch rig;
//   rig.add(streams);                       // what has come
//   for (const WatchEvent& event : rig.look()) print(event.text);
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "evaluation/statistics/statistics.h"
#include "recording/recorded_streams.h"
#include "watch/phase_track.h"
#include "watch/watch_event.h"

namespace simbench::watch {

inline constexpr double kStretchS = 0.5;
inline constexpr double kStretchFrames = 8;
inline constexpr double kKeptS = 60;
inline constexpr double kSilentPeriods = 5;
inline constexpr double kLosingShare = 0.01;
inline constexpr double kLossS = 10;
inline constexpr double kDriftEndsS = 300;  // without a further move

// A stream of a camera that is watched.
struct WatchedCamera {
  std::string camera;
  std::string host;
  std::string stream;
  bool counts = true;       // it has a counter
  std::int64_t frames = 0;  // since the watch began
  std::int64_t lost = 0;    // likewise, by its counter
  double lost_share = 0;    // within kLossS
  double period_ms = evaluation::kNan;
  PhaseTrack phase{};  // against the reference camera
  std::int64_t slips = 0;
  bool is_silent = false;
  bool is_losing = false;
  bool drifts = false;
  double drifts_since_s = 0;  // its last move

  std::deque<StampedFrame> kept{};
  std::deque<std::pair<double, std::int64_t>> losses{};  // when, how many
  std::int64_t missed = 0;                               // the sum of these

  double last_s() const;
};

class RigWatch {
 public:
  // Frames in order of delivery, behind those that were added before.
  void add(const std::vector<RecordedStream>& streams);
  // What has happened until the last arrival that all cameras have passed.
  std::vector<WatchEvent> look();

  const std::vector<WatchedCamera>& cameras() const { return cameras_; }
  // The last arrival of any camera; nothing before the first.
  std::optional<double> now_s() const;
  // What is kept, for `diagnose`: the last kKeptS.
  std::vector<RecordedStream> kept() const;

 private:
  // The cameras of one kind of stream, which have phases against each other.
  struct Group {
    std::vector<std::size_t> members{};
    std::optional<std::size_t> reference{};
    double from_s = evaluation::kNan;  // of the next stretch
  };

  WatchedCamera& camera_of(const RecordedStream& stream);
  void add_frame(const StampedFrame& frame, WatchedCamera& camera);
  void forget_old();
  void look_at_losses(WatchedCamera& camera, double now_s);
  void look_at_silence(double now_s);
  bool look_at_stretch(Group& group);
  void choose_reference(Group& group, double from_s, double to_s);
  void judge(Group& group, const std::map<std::size_t, double>& phases, double to_s);
  void tell_move(const Group& group, std::size_t member, const PhaseMove& move, double at_s);
  void tell(WatchEvent event) { events_.push_back(std::move(event)); }

  std::vector<WatchedCamera> cameras_;
  std::map<std::string, std::size_t> places_;  // by camera and stream
  std::map<std::string, Group> groups_;        // by stream
  std::vector<WatchEvent> events_;
};

}  // namespace simbench::watch
