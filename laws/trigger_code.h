// A trigger's pulses with names: each is moved a little, or left out, such that the pattern of a
// few consecutive ones stands at one place of the code only.
//
// Pulse i is due at i * period + shift(i). The symbols are a binary de Bruijn sequence of 2^order
// bits, in which every run of `order` bits stands once; half of them are ones, so that the mean
// shift is zero and the mean rate that of the even grid. The code then begins anew.
//
//   position   a symbol is a pulse, late by the shift (1) or early by it (0)
//   missing    a symbol is `pulses` pulses, of which the last is left out (1) or sent (0)
//   frequency  a symbol is `pulses` intervals, of which the first half is longer by the shift and
//              the second shorter (1), or the other way round (0): its last pulse is on the grid
//
// The sequence is that of a shift register of maximal length with the run of zeros made one longer,
// whose shifted copies are nearly uncorrelated: two places of the code soon look different.
//
// Units: nanoseconds. Complexity: O(length) to make, O(1) to ask. Memory: 5 bytes a pulse.
// Source: docs/coded_trigger.md section 2; de Bruijn, "A combinatorial problem", 1946; taps of the
// registers: Xilinx XAPP052, table 3.
//
//   const TriggerCode code = TriggerCode::position(from_ms(1000.0 / 90), 12, from_us(50));
//   const Nanoseconds late = code.shift(100'000);   // of pulse 100,000
//   const double span_s = to_seconds(code.span());  // until pulses have the same names again
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "algorithms/ports/time.h"

namespace simbench {

class TriggerCode {
 public:
  static constexpr int kLowestOrder = 4;
  static constexpr int kHighestOrder = 16;

  // The period is positive, the order from 4 to 16; the shift less than a quarter of a period.
  static TriggerCode position(Nanoseconds period, int order, Nanoseconds shift);
  // At least 2 pulses a symbol.
  static TriggerCode missing(Nanoseconds period, int order, std::size_t pulses);
  // An even number of pulses; an interval stays above half a period.
  static TriggerCode frequency(Nanoseconds period, int order, std::size_t pulses,
                               Nanoseconds shift);

  Nanoseconds period() const { return period_; }
  // Pulses after which the code begins anew, those left out too.
  std::int64_t length() const { return static_cast<std::int64_t>(shifts_ns_.size()); }
  Nanoseconds span() const { return period_ * length(); }

  // Takes any pulse; one from 0 to length() - 1 is its own place.
  std::size_t place(std::int64_t pulse) const {
    const std::int64_t place = pulse % length();
    return static_cast<std::size_t>(place < 0 ? place + length() : place);
  }
  Nanoseconds shift(std::int64_t pulse) const { return Nanoseconds(shifts_ns_[place(pulse)]); }
  bool is_sent(std::int64_t pulse) const { return is_sent_[place(pulse)] != 0; }
  bool leaves_out() const { return leaves_out_; }

  // By place.
  std::span<const std::int32_t> shifts_ns() const { return shifts_ns_; }
  std::span<const std::uint8_t> sent() const { return is_sent_; }

  // Between two pulses that are sent one after the other.
  Nanoseconds shortest_interval() const { return shortest_; }
  Nanoseconds longest_interval() const { return longest_; }
  // The largest difference of two shifts.
  Nanoseconds range() const { return range_; }
  // The share of the pulses that is sent.
  double sent_share() const { return sent_share_; }

 private:
  TriggerCode(Nanoseconds period, std::vector<std::int32_t> shifts_ns,
              std::vector<std::uint8_t> is_sent);

  Nanoseconds period_;
  std::vector<std::int32_t> shifts_ns_;
  std::vector<std::uint8_t> is_sent_;
  bool leaves_out_ = false;
  Nanoseconds shortest_{};
  Nanoseconds longest_{};
  Nanoseconds range_{};
  double sent_share_ = 1;
};

// The binary de Bruijn sequence of 2^order symbols, each 0 or 1.
std::vector<std::uint8_t> de_bruijn_sequence(int order);

}  // namespace simbench
