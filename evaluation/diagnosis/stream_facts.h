// What one recorded stream shows by itself: its grid, the rate of its camera against its host,
// where stamps or exposures moved, how its frames were delivered and which are missing.
//
// Two kinds of lasting moves are told apart. A *jump* changes (arrival - stamp): the stamps slipped
// by whole periods, or a clock was set. A *phase step* moves the stamps against their own grid
// (evaluation/frames/stamp_grid.h) while arrivals follow: the exposures moved. Both end a stretch;
// rates are fitted within stretches only.
//
// A stream is *stamped on arrival* if its stamps scatter about their grid by more than kSteadyShare
// of a period, as no sensor does, and (arrival - stamp) scatters by less than kFollowsShare of
// that: what delays a frame then delays its stamp, so that the stamp was made after the delay.
//
// The first 5 s of recordings of 20 s and more are discarded, since cameras are unsteady there; the
// account of frames alone covers them too (frame_account.h).
//
// What too few frames leave undefined is NaN. Complexity: O(n log n) in the frames.
//
//   const StreamFacts facts = stream_facts(recorded.streams[0]);
//   print(facts.period_ms, facts.account.lost);
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "evaluation/diagnosis/column_facts.h"
#include "evaluation/diagnosis/loss_pattern.h"
#include "evaluation/diagnosis/rate_changes.h"
#include "evaluation/frames/frame_account.h"
#include "evaluation/statistics/statistics.h"
#include "recording/recorded_streams.h"

namespace simbench::evaluation {

inline constexpr double kSteadyShare = 0.02;
inline constexpr double kFollowsShare = 0.25;

// A lasting change of (arrival - sensor stamp).
struct StampJump {
  std::size_t frame = 0;  // the first one after it; of StreamFacts::arrivals_ms
  double at_s = 0;        // after the stream's first arrival
  double step_ms = 0;     // positive: stamps fell behind the arrivals
  int periods = 0;        // 0: no whole number of them
};

// A lasting move of the exposures, by their stamps; within half a period.
struct PhaseStep {
  std::size_t frame = 0;
  double at_s = 0;
  double step_ms = 0;
};

// A time in which many frames came late.
struct DelayBurst {
  double at_s = 0;  // after the stream's first arrival
  double for_s = 0;
  std::int64_t late = 0;  // frames
  double most_ms = 0;     // later than usual
};

// A period by a clock, with its standard deviation.
struct PeriodEstimate {
  double period_ms = kNan;
  double sd_ppm = kNan;
  double freedom = 0;  // degrees of freedom of that
};

// Arrivals after their stamps; where both are of one clock, delays.
struct StampDelay {
  double median_ms = kNan;   // of all frames, exact: NaN without any
  double least_ms = kNan;    // 1 % are below
  double scatter_ms = kNan;  // drift and jumps taken out; from 16 to 84 %, halved
};

struct StreamFacts {
  double first_arrival_s = kNan;
  double last_arrival_s = kNan;
  double longest_gap_s = kNan;  // between two arrivals
  double gap_at_s = kNan;       // its begin, after the first arrival
  // On the camera's clock.
  double period_ms = kNan;           // of its grid
  double interval_jitter_ms = kNan;  // standard deviation from whole periods
  double scatter_ms = kNan;          // of a stamp about the grid, robust
  double on_grid_share = kNan;       // of intervals within a tenth of whole periods
  bool has_grid = false;             // else intervals vary by themselves
  double drift_ppm = kNan;           // (host rate / device rate - 1) 1e6, from first to last frame
  PeriodEstimate stamp_period;       // by the stamps, steps taken out
  PeriodEstimate host_period;        // by the arrivals, jumps and steps taken out
  // Events.
  FrameAccount account;  // of all frames, the first seconds too
  LossPlaces losses;
  std::int64_t out_of_order = 0;     // frames that arrived after later ones
  std::int64_t repeated_stamps = 0;  // frames with the stamp of the frame before
  std::int64_t backward_stamps = 0;
  std::int64_t backward_arrivals = 0;
  std::int64_t future_stamps = 0;  // frames that arrived earlier than their stamp allows
  double future_ms = 0;            // by how much, at most
  std::int64_t wraps = 0;          // of the 32-bit microsecond register
  bool global_time = false;        // stamps count from 1970
  bool one_clock = false;          // arrivals are the stamps (camera_statistics.h)
  // The recording says these: RecordedStream has what they mean.
  bool counted = true;
  bool stamped_by_host = false;
  bool realsense = false;
  bool stamped_on_arrival = false;
  StampDelay delay;
  std::vector<StampJump> jumps;
  std::vector<PhaseStep> steps;
  std::vector<DelayBurst> bursts;
  std::vector<RateChange> rate_changes;
  double batched_share = kNan;  // of frames that arrived together with the one before them
  ColumnFacts columns;
  // Arrivals with jumps taken out, and the point of the grid that each frame is of.
  std::vector<double> arrivals_ms;
  std::vector<std::int64_t> periods;
  // Stamps since `first_stamp`, phase steps not taken out.
  Nanoseconds first_stamp{};
  std::vector<double> stamps_ms;

  double span_s() const { return last_arrival_s - first_arrival_s; }
  std::int64_t missing() const { return account.lost + account.never_exposed + account.unknown; }
  double missing_share() const {
    const auto all = static_cast<double>(missing() + account.delivered);
    return all > 0 ? static_cast<double>(missing()) / all : 0;
  }
};

// Frames as recorded, not unwrapped, in order of delivery. `other_period_ms`: the grid of other
// cameras (stamp_grid.h).
StreamFacts stream_facts(const RecordedStream& stream, std::optional<double> other_period_ms = {});

}  // namespace simbench::evaluation
