// When a camera exposes: one image stream's answer to trigger pulses and to their absence.
//
// Behaviour by sync mode (docs/reference/d455.md section 2, docs/design.md section 7):
//  - genlock (depth only): waits without limit; a pulse starts an exposure. Pulses are then ignored
//    for two mode periods less a guard (the camera's own periods, an assumption about the guard),
//    and while the exposure lasts. A trigger at the full mode rate thus yields every second pulse,
//    and a slow camera without a guard yields every second pulse of a half-rate trigger too.
//  - slave (depth; colour too in full slave): the exposure *ends* one mode period after the pulse,
//    so a longer exposure starts earlier and arrives no later. Pulses closer together than a mode
//    period less the guard, or than the exposure lasts, are ignored: no two exposures of a row
//    overlap. Without pulses the stream runs free after a while, at its
//    own mode rate; the next pulse takes over again.
//  - triggered (a slave whose profile says that exposures begin at the pulse): as genlock, but
//    pulses are ignored for one mode period less the guard, and while the exposure lasts.
//  - free-running (default and master mode, and streams the mode does not synchronise): exposures
//    end at a fixed phase of the camera's own mode period; one that is longer takes several.
//
// A rolling shutter exposes its rows one after the other, each for the exposure time; the last row
// begins `readout` after the first. An Exposure then lasts from the first row's start to the last
// row's end ("start" and "end" above), so that its middle is that of the middle row. Genlock
// ignores pulses during all of it; a slave still does so for its mode period. A global shutter has
// readout 0.
//
// A frame of a free-running exposure belongs to no pulse (kNoPulse).
//
//   Shutter shutter(settings, camera_start);
//   if (auto exposure = shutter.on_pulse(at, slot)) expose(*exposure);
//   // and, unless next_timer() is never: call on_timer(t) at each t = next_timer().
#pragma once

#include <cstdint>
#include <optional>

#include "recording/true_time.h"

namespace simbench::sim {

inline constexpr std::int64_t kNoPulse = -1;

enum class ShutterMode : std::uint8_t { kFreeRunning, kSlave, kTriggered, kGenlock };

struct ShutterSettings {
  ShutterMode mode = ShutterMode::kFreeRunning;
  double mode_period_ns = 0;  // of true time: the camera's oscillator makes its periods
  Nanoseconds exposure{};
  Nanoseconds readout{};
  Nanoseconds trigger_to_exposure{};  // what lies between a pulse and what it starts
  double guard_fraction = 0;          // of a mode period, by which pulses may come early
  double free_run_after_periods = 0;  // a slave without pulses waits so many periods
};

struct Exposure {
  std::int64_t pulse = kNoPulse;  // the slot of the pulse that began it
  TrueTime start{};               // of the first row
  TrueTime end{};                 // of the last row
};

class Shutter {
 public:
  // The stream starts at `start` and ignores pulses before that.
  Shutter(const ShutterSettings& settings, TrueTime start);

  ShutterMode mode() const { return settings_.mode; }

  // The exposure time from the next exposure on, as auto-exposure changes it.
  void set_exposure(Nanoseconds exposure) { settings_.exposure = exposure; }

  // A pulse reaches the camera at `at`: the exposure it causes, if any.
  std::optional<Exposure> on_pulse(TrueTime at, std::int64_t pulse);

  // When to call on_timer next; TrueTime::max() means never.
  TrueTime next_timer() const { return next_timer_; }
  // At next_timer(): the free-running exposure that begins, if any.
  std::optional<Exposure> on_timer(TrueTime now);

 private:
  Nanoseconds periods(double count) const;
  // Mode periods that an exposure takes, at least 1.
  std::int64_t periods_of_exposure() const;
  Exposure end_aligned(TrueTime period_start, std::int64_t pulse) const;

  ShutterSettings settings_;
  TrueTime start_;
  TrueTime last_pulse_;
  TrueTime ignore_until_;
  TrueTime next_timer_ = TrueTime::max();
  TrueTime free_run_origin_{};
  std::int64_t free_run_frames_ = 0;
};

}  // namespace simbench::sim
