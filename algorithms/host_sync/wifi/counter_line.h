// A counter as a straight line over another one, from readings of both: least squares over the
// readings of a window.
//
// Readings come in order. With n readings whose errors are independent, of deviation s, evenly over
// the window, the line is wrong by 2 s / sqrt(n) at its newer end, where it is used, and by half of
// that in its middle; what all readings share stays. A reading more than kJump from the line is of
// a counter that began anew: the line begins anew, too.
//
// Complexity: O(1) amortised for a reading, O(n) for a line. Source: any textbook on regression;
// laws/line_fit.h.
//
//   CounterLine line(from_ms(60e3));
//   line.add(Nanoseconds(0), Nanoseconds(5));   // the counter is 5 ns ahead
//   const std::optional<CounterLine::Fit> fit = line.fit();
//   const Nanoseconds ahead = fit->ahead(from_ms(1000));
#pragma once

#include <cstddef>
#include <deque>
#include <optional>

#include "algorithms/ports/time.h"
#include "laws/line_fit.h"

namespace simbench {

class CounterLine {
 public:
  static constexpr std::size_t kFewestReadings = 4;
  static constexpr Nanoseconds kJump{10'000'000};

  // How far the counter is ahead of the other at a reading of the other.
  struct Fit {
    Nanoseconds zero_at{};
    Nanoseconds zero_ahead{};
    Line line;  // over us since zero_at, in ns on top of zero_ahead

    Nanoseconds ahead(Nanoseconds at) const {
      return zero_ahead + from_ns(line.at(micros(at - zero_at)));
    }
    // Against the other counter.
    double rate() const { return line.slope * 1e-3; }
  };

  explicit CounterLine(Nanoseconds window) : window_(window) {}

  // The counter is `ahead` of the other where that reads `at`.
  void add(Nanoseconds at, Nanoseconds ahead);
  // Nothing before there are kFewestReadings that are not all of one instant.
  std::optional<Fit> fit() const;

 private:
  struct Reading {
    Nanoseconds at{};
    Nanoseconds ahead{};
  };
  static std::int64_t micros(Nanoseconds span) { return span.count() / 1000; }

  Nanoseconds window_;
  std::deque<Reading> readings_;
};

}  // namespace simbench
