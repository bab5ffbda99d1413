// The course of one camera's exposures against a grid of the common time: phase and rate together.
//
// The exposure of frame n is due at an instant of the grid, at first a multiple of its period; its
// error is how late it is. Controls move exposures by known amounts. Without these moves the errors
// of successive frames lie on a line whose slope is the difference of the rates. It is fitted by
// least squares over the last frames, so that the error of a frame to come is known better than any
// one stamp tells it.
//
// Frames are numbered by the camera's counter, so lost ones do no harm. The first frame fixes which
// instant of the grid it is due at, the nearest; the errors of later ones may exceed a period. The
// grid may be moved at any time.
//
// A move that was less or more than was said (a control was lost, a frame is longer than it should
// be) shows as a surprise: the last stamps lie off the line together. forget() then begins a new
// line with the stamps to come. restart() does so after a move whose size is not sure, and keeps
// what is known of the rate: the slope is the mean of the old and the new line's, each weighted by
// its precision, and the old one is forgotten as the window fills.
//
// Units: nanoseconds. Cost: O(1) a frame. Source: least squares;
// docs/reference/capture_alignment.md section 10.
//
//   PhaseLine course(from_ms(33), 300);
//   course.add(7, HostTime(from_ms(231.2)));
//   const double late_ns = course.error_ns(12);
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>

#include "algorithms/ports/time.h"
#include "laws/line_fit.h"

namespace simbench {

class PhaseLine {
 public:
  // `window`: frames that are used, at least 2.
  PhaseLine(Nanoseconds period, std::size_t window);

  // That frame's exposure on the common time. Counters rise.
  void add(std::uint32_t counter, HostTime exposed);
  // Frames from this counter on are later by so much than they would have been.
  void move(std::uint32_t from_counter, Nanoseconds by);
  // Frames are due so many periods later: after a move by whole periods.
  void shift_grid(std::int64_t periods) { grid_ += periods * period_; }
  // Moves the grid so that `due` is one of its instants; that frame is then due at the nearest.
  void set_grid(HostTime due, std::uint32_t counter);
  // Begins a new line with the frames to come, on the same grid, at the rate known so far.
  void restart();
  // The same, and nothing is known of the rate.
  void forget();

  // How many frames the present line has.
  std::size_t frames() const { return frames_; }
  // When that frame is due.
  HostTime due(std::uint32_t counter) const;
  // How late the exposure of that frame is, by the line and the moves; 0 without frames.
  double error_ns(std::uint32_t counter) const;
  // Change of the error from frame to frame, without moves.
  double slope_ns() const;
  // Its standard deviation, by the stamps' noise; infinite with too few frames.
  double slope_sigma_ns() const;
  // Whether the last stamps lie off the line together, by more than `least_ns` and their noise.
  bool is_surprised(double least_ns) const;

 private:
  static constexpr std::size_t kRecent = 6;
  struct Move {
    std::uint32_t from = 0;
    std::int64_t by_ns = 0;
  };

  // How well the present line tells the rate: 1 / variance of its slope.
  double precision() const;
  double noise_for_slope_ns() const;
  double old_precision() const;
  double line_at(std::int64_t frame) const;
  std::int64_t frame_of(std::uint32_t counter) const {
    return static_cast<std::int64_t>(counter) - static_cast<std::int64_t>(zero_counter_);
  }
  std::int64_t moved_ns(std::uint32_t counter) const;

  Nanoseconds period_;
  std::size_t window_;
  bool has_zero_ = false;
  std::uint32_t zero_counter_ = 0;
  HostTime zero_{};     // when the first frame was due
  Nanoseconds grid_{};  // by which frames are due later than that
  LineWindow fit_;
  Line line_;
  double known_slope_ns_ = 0;  // by the frames before the present line
  double known_precision_ = 0;
  double known_noise_ns_ = 0;
  std::size_t frames_ = 0;
  double noise_ns_ = 0;  // mean absolute distance of the stamps from the line before each
  std::array<double, kRecent> recent_ns_{};  // last distances from the line, a ring
  std::deque<Move> moves_;
  std::int64_t old_moves_ns_ = 0;
};

}  // namespace simbench
