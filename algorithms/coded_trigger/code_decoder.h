// Which pulse of a coded trigger exposed a frame, from the sensor stamps of its camera alone.
//
// No host's clock, no arrival and no other camera is asked. A camera's frames are held until they
// name their place in the code (code_search.h); then all of them have their index, and each later
// frame has its own at once: the number of periods since the last one, counted at the rate that the
// frames so far have shown, if the stamp is where the code has that pulse. Frames that are not are
// held again: those of a camera that runs free, of a trigger that was restarted, of a pulse that
// was left out. After three of them in a row the place is given up and looked for again, and the
// frames since then get their indices when it is found; if the next frame fits, they are given up.
// Nothing is guessed: a frame has the index that the code says, or none.
//
// An index counts from pulse 0 of the code's first cycle. What comes a whole cycle later looks
// alike, so the place of the frame with which a camera's search ends is within that cycle, and
// those before it may be negative; from then on the camera's own clock counts the cycles, also
// through losses. Who knows better moves the camera by whole cycles.
//
// The stamp of a frame is of the middle of its exposure. Half of the exposure is taken off or
// added, whichever gives the instant that follows the pulse by a constant time (coded_pulses.h), so
// that auto-exposure does not look like a code.
//
// Bears: losses, drops, late starts, wraps (stamps come unwrapped), rates of a few hundred ppm,
// gaps of kLongestGapPeriods, noise of a sixth of the smallest step between shifts.
//
// Complexity: O(1) a frame once the place is known, else the search's. Memory: the search's. No
// allocation once made. Source: docs/coded_trigger.md section 4.
//
//   CodeDecoder decoder(pulses, settings);     // one per camera
//   const Decoded decoded = decoder.push(frame.sensor, frame.exposure_us);
//   if (decoded.indexed > 0) use(decoder.newest_index());
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

#include "algorithms/coded_trigger/code_search.h"
#include "algorithms/coded_trigger/coded_pulses.h"
#include "algorithms/ports/time.h"

namespace simbench {

// What became of the frames that are held, from the oldest on and with the new one as the last: so
// many get no index, then so many have one, and the rest is still held.
struct Decoded {
  std::uint32_t given_up = 0;
  std::uint32_t indexed = 0;
  bool is_refused = false;       // the new one gets no index and is not held
  bool has_found_place = false;  // with this frame
  bool is_cycle_known = false;   // of a place that was found: the camera's clock has counted it
};

// How the place was found.
struct CodeLock {
  std::uint32_t times = 0;         // so far; the rest is of the last time
  std::uint32_t frames = 0;        // that it took
  double seconds = 0;              // that these took, on the camera's clock
  double since_first_frame_s = 0;  // from the camera's first frame
  double error_probability = 0;    // of the place
  double noise_us = 0;             // of the stamps, at least what was stated
};

class CodeDecoder {
 public:
  static constexpr std::int64_t kLongestGapPeriods = 100'000;

  CodeDecoder(std::shared_ptr<const CodedPulses> pulses, const CodeDecoderSettings& settings);

  // The camera's next frame, its stamp unwrapped.
  Decoded push(DeviceTime sensor, std::uint32_t exposure_us) {
    const std::int64_t at_ns = pulse_side_ns(sensor, exposure_us);
    if (is_locked_ && search_.held() == 0) {
      // Written out, since nearly all frames come here.
      const double grid_ns = static_cast<double>(at_ns - at_ns_) - grid_offset_ns_;
      const double slots = grid_ns / step_ns_;
      const std::int64_t whole = std::llround(slots);
      if (whole >= 1 && whole <= kLongestGapPeriods && follows(at_ns, grid_ns, whole))
        return {0, 1};
    }
    return push_any(at_ns);
  }

  bool is_locked() const { return is_locked_; }
  // The index of the newest frame that has one; any frame must have had one.
  std::int64_t newest_index() const { return index_; }
  // The index of the i-th frame that got its own in the last push(), which found the place.
  std::int64_t found_index(std::size_t i) const { return first_index_ + search_.slot(i); }
  const CodeLock& lock() const { return lock_; }

  // Counts all indices so many cycles of the code later.
  void move_by_cycles(std::int64_t cycles);

 private:
  static constexpr double kFollow = 1.0 / 16;       // of a residual, by the level
  static constexpr double kFollowRate = 1.0 / 512;  // by the rate

  std::int64_t pulse_side_ns(DeviceTime sensor, std::uint32_t exposure_us) const {
    constexpr std::int64_t kFarthestUs = std::int64_t{1} << 52;  // 142 years
    const std::int64_t us =
        std::clamp(sensor.time_since_epoch().count(), -kFarthestUs, kFarthestUs);
    return 1000 * us + half_exposure_ns_ * exposure_us;
  }

  // Takes the frame, so many slots later, if it is where the code has its pulse.
  bool follows(std::int64_t at_ns, double grid_ns, std::int64_t slots) {
    std::int64_t place = place_ + slots;
    if (place >= length_) place %= length_;
    if (sent_[place] == 0) return false;
    const auto count = static_cast<double>(slots);
    const double shift_ns = shifts_ns_[place];
    const double residual_ns = grid_ns - count * step_ns_ - shift_ns;
    if (residual_ns > gate_ns_ || residual_ns < -gate_ns_) return false;
    at_ns_ = at_ns;
    index_ += slots;
    place_ = place;
    // The grid, without the shift, against the newest stamp.
    grid_offset_ns_ = kFollow * residual_ns - residual_ns - shift_ns;
    step_ns_ += kFollowRate * residual_ns / count;
    if (strikes_ > 0) --strikes_;
    return true;
  }

  Decoded push_any(std::int64_t at_ns);
  Decoded look_for_place(std::int64_t at_ns, std::uint32_t given_up);
  void take_place();
  std::uint32_t forget_held();

  std::shared_ptr<const CodedPulses> pulses_;
  const std::int32_t* shifts_ns_;
  const std::uint8_t* sent_;
  std::int64_t length_;
  std::int64_t half_exposure_ns_;  // of a microsecond: 500 or -500
  double noise_us_;
  double most_gate_us_;

  bool is_locked_ = false;
  bool is_released_ = false;  // what the search holds has its indices
  std::uint32_t strikes_ = 0;
  double gate_ns_ = 0;
  std::int64_t at_ns_ = 0;        // of the newest frame with an index
  std::int64_t index_ = 0;        // of it
  std::int64_t place_ = 0;        // of it
  double grid_offset_ns_ = 0;     // from it to the even grid
  double step_ns_ = 0;            // a slot, on the camera's clock
  bool has_index_ = false;        // ever had
  std::int64_t first_index_ = 0;  // of slot 0 of the search
  std::int64_t last_at_ns_ = 0;   // of the newest frame
  std::optional<std::int64_t> first_at_ns_;
  CodeSearch search_;
  CodeLock lock_;
};

}  // namespace simbench
