// A clock that is watched: its time error as its daemon's log states it, and whether it stepped.
//
// A step is a difference of neighbouring errors that is farther from the median of the last ones
// than kStepFactor times their scatter (the larger of a median and of a trimmed mean distance), and
// that the next error does not take back: it is known with its second sample. That is the rule of
// steps_of() (evaluation/stability/time_error.h), which looks at whole series. A clock is off while
// its error exceeds the limit, if there is one, until kBackSamples in order are within it.
//
// Memory: the last kKeptErrors. Time is the log's own.
//
//   ClockWatch clock("clock of hostA", 0.5);
//   for (const WatchEvent& event : clock.add(points)) print(event.text);
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/stability/clock_log.h"
#include "evaluation/stability/stability.h"
#include "watch/watch_event.h"

namespace simbench::watch {

inline constexpr std::size_t kKeptErrors = 4096;
inline constexpr std::size_t kBackSamples = 3;

class ClockWatch {
 public:
  // `limit_ms`: of the error; nothing: none.
  ClockWatch(std::string subject, std::optional<double> limit_ms);

  const std::string& subject() const { return subject_; }
  std::vector<WatchEvent> add(const std::vector<evaluation::ClockLogPoint>& points);
  // The log goes on in another file, or from its beginning: no step is seen across that.
  void begin_anew();

  std::int64_t samples() const { return samples_; }
  std::int64_t steps() const { return steps_; }
  // The last error and its time; NaN before the first.
  double error_ms() const;
  double last_s() const;
  bool is_off() const { return is_off_; }
  // What `stability` says of what is kept; nothing before there are kFewestDifferences.
  std::optional<evaluation::Stability> stability() const;
  // The size of it alone; nothing before the first error.
  std::optional<evaluation::TimeErrorSummary> time_error() const;

 private:
  void add_point(const evaluation::ClockLogPoint& point);
  void look_for_step();
  void look_at_limit();

  std::string subject_;
  std::optional<double> limit_ms_;
  std::deque<evaluation::ClockLogPoint> kept_;
  std::size_t fresh_ = 0;  // of the kept ones: since the log began anew
  std::int64_t samples_ = 0;
  std::int64_t steps_ = 0;
  bool is_off_ = false;
  std::size_t within_ = 0;  // samples in order within the limit
  std::vector<WatchEvent> events_;
};

}  // namespace simbench::watch
