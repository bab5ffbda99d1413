// The trigger tree: one main trigger, sub-triggers in bypass mode, a cable to every camera.
//
// The main trigger (TG-16C) makes a pulse per period of its own oscillator; a sub-trigger (TG-4C)
// passes it on to its cameras. A pulse is named by its slot: slot i is due i periods after the
// first. Missed and paused pulses leave their slot empty, so that a slot number is the same for
// every camera and for the ground truth.
//
// A camera may have a delay of its own (delay_of_camera_us).
//
// The cameras of a sub-trigger are a star, or a daisy chain in which each camera passes the pulse
// on to the next one after daisy_chain_delay_us (Azure Kinect; one sub-trigger for all cameras then
// stands for the master, whose oscillator the trigger's rate is).
//
// A coded trigger (laws/trigger_code.h) moves the pulse of a slot by its shift, and leaves some
// out: due() is the even grid, without it, so that slots have the same numbers with and without a
// code.
//
// All randomness is drawn per slot or per branch from streams of its own, so pulses are the same
// for every pipeline of a seed.
//
// Source: section 4.1 of the paper, docs/reference/d455.md section 2. Unit: true time, nanoseconds.
//
//   TriggerTree tree(scenario.trigger, 18, seed);
//   tree.start(capture_start);
//   if (auto pulse = tree.pulse(0)) expose(*pulse + tree.delay_to(7));   // at camera 7
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "laws/trigger_code.h"
#include "recording/true_time.h"
#include "scenarios/scenario.h"

namespace simbench::sim {

class TriggerTree {
 public:
  TriggerTree(const scenarios::Trigger& settings, std::size_t cameras, std::uint64_t seed);

  // Sets the start of the cameras, true zero before this call; slot 0 is due start_delay_ms later.
  void start(TrueTime capture_start);

  // When slot `slot` is due, without jitter and shift. Slots are equally spaced to the nanosecond
  // over hours.
  TrueTime due(std::int64_t slot) const;
  // When the main trigger's pulse for `slot` leaves; nothing if it is missed, paused or left out.
  std::optional<TrueTime> pulse(std::int64_t slot) const;
  // Propagation from the main trigger to camera `camera`, through its branch, the cameras before
  // it in a daisy chain, and its cable.
  Nanoseconds delay_to(std::size_t camera) const { return delays_[camera]; }
  // Mean time between pulses, with the trigger's own rate error.
  double period_ns() const { return period_ns_; }
  // The first slot due at or after `at`.
  std::int64_t first_slot_from(TrueTime at) const;

 private:
  scenarios::Trigger settings_;
  std::uint64_t seed_;
  double period_ns_;
  TrueTime capture_start_;
  TrueTime first_due_;
  std::vector<Nanoseconds> delays_;
  std::shared_ptr<const TriggerCode> code_;  // null: none
};

}  // namespace simbench::sim
