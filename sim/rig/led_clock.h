// A clock of LEDs in view of all cameras: what their images show of it (RocSync).
//
// A ring of 100 LEDs of which exactly one is lit, for one step each, and a counter of the turns. In
// an image those are lit whose steps the exposure touched: an arc that tells begin and end of the
// exposure in whole steps. The counter changes as the ring turns, so an image cannot be read whose
// arc passes the ring's end or comes within one step of it. With exposures of e steps (e + 3)
// images of 100 are lost so, about; exposures of 97 steps and more are never read.
//
// The clock has an oscillator and a zero of its own: it was switched on one to two turns before the
// cameras, and its rate error is one draw a seed, so it is the same for all cameras.
//
// An image is looked at if the clock is in view and the camera's last look is `interval_ms` ago, on
// a grid of such intervals from the capture's start. A look may find nothing, and what it reads may
// be a turn wrong; draws are keyed by camera and frame counter, so that neither the pipeline nor
// how frames are reported changes them. Only images of the scored stream are looked at.
//
// A rolling shutter exposes the rows one after the other. The board is a point here, in one row of
// each camera's own, and the arc is that row's exposure: it lies up to half of the readout beside
// the middle of the frame, which the camera's stamp means. Nothing corrects that, as in RocSync.
//
// Left out: brightness of the arc's ends, the latch of the counter, motion, boards that are too
// small or blurred (they are missed), the counter's wrap after 65 536 turns (109 min).
//
// Times count from the capture's start. Cost: some 20 ns a frame.
// Source: docs/reference/capture_alignment.md section 5.
//
//   LedClock leds(scenario, seed, camera_world.last_exposure());
//   if (const auto lit = leds.read(frame, kReadout)) use(lit->start, lit->end);
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "recording/true_time.h"
#include "scenarios/scenario.h"
#include "sim/engine/random.h"
#include "sim/rig/camera_world.h"

namespace simbench::sim {

// From the begin of the first lit LED's step to the end of the last one's, on the LED clock.
struct LitArc {
  Nanoseconds start{};
  Nanoseconds end{};
};

class LedClock {
 public:
  static constexpr std::int64_t kRing = 100;  // LEDs

  // `scenario`, which has such a clock, must outlive this. No exposure begins after
  // `last_exposure`.
  LedClock(const scenarios::Scenario& scenario, std::uint64_t seed, TrueTime last_exposure);

  // What is read from the frame, if anything. Frames of a camera come in the order of their
  // exposures, each once. `readout`: of its rolling shutter.
  std::optional<LitArc> read(const SimFrame& frame, Nanoseconds readout);

  // The clock's own time.
  Nanoseconds at(TrueTime time) const;

 private:
  bool is_in_view(TrueTime time) const;
  // Whether the camera's image of that time is looked at.
  bool looks(std::uint32_t camera, TrueTime time);

  const scenarios::LedClockModel& model_;
  scenarios::StreamKind scored_;
  Nanoseconds step_;
  Nanoseconds interval_;
  TrueTime first_end_;
  TrueTime last_begin_;
  KeyedStreams readings_;
  double skew_;
  Nanoseconds zero_{};               // its time at the start of the capture
  std::vector<double> rows_;         // of the board, by camera, from 0 to 1
  std::vector<TrueTime> next_look_;  // by camera
};

}  // namespace simbench::sim
