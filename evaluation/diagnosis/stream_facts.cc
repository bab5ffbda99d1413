#include "evaluation/diagnosis/stream_facts.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "evaluation/frames/camera_statistics.h"

namespace simbench::evaluation {
namespace {

constexpr std::ptrdiff_t kJumpWindow = 15;  // frames on either side
constexpr std::ptrdiff_t kLeastJumpWindow = 5;
// How far from a whole number of periods a slip may be: within what two medians of a window
// scatter, three standard deviations of their difference, and these bounds.
constexpr double kLeastWhole = 0.03;
constexpr double kMostWhole = 0.15;
constexpr double kWindowScatters = 1.4;
constexpr double kMostPeriods = 1000;
constexpr std::size_t kFewJumps = 3;
constexpr std::size_t kFramesPerJump = 100;
constexpr double kPassingS = 5;  // a step that is undone sooner is lateness
constexpr double kLeastFutureMs = 5;
constexpr double kLeastBurstMs = 10;
constexpr double kBurstSpreads = 5;  // of the upper tenth's distance from the median
constexpr std::int64_t kLeastBurstFrames = 5;
constexpr double kBurstPauseS = 0.5;  // a longer one ends a burst
constexpr double kMostLate = 0.05;    // more late frames are how the camera is
constexpr std::size_t kLeastBatchFrames = 5;
constexpr std::size_t kFewBatches = 8;
constexpr std::size_t kBatches = 16;
constexpr std::size_t kManyFrames = 160;

std::int64_t count_wraps(std::span<const StampedFrame> frames) {
  constexpr Nanoseconds kRegister = Microseconds(std::int64_t{1} << 32);
  std::int64_t wraps = 0;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    const bool in_register = frames[i].sensor < kRegister && frames[i - 1].sensor < kRegister;
    if (in_register && frames[i - 1].sensor - frames[i].sensor > kRegister / 2) ++wraps;
  }
  return wraps;
}

// After the stream's first arrival, also where the first frames are left out.
double arrival_s(std::span<const StampedFrame> frames, std::size_t i, const StreamFacts& facts) {
  return to_seconds(frames[i].arrival) - facts.first_arrival_s;
}

double interval_ms(std::span<const StampedFrame> frames, std::size_t i) {
  return difference_ms(frames[i].sensor.count(), frames[i - 1].sensor.count());
}

void note_arrivals(std::span<const StampedFrame> frames, StreamFacts& facts) {
  const std::int64_t first = frames.front().arrival.count();
  facts.first_arrival_s = to_seconds(frames.front().arrival);
  facts.last_arrival_s = to_seconds(frames.back().arrival);
  for (std::size_t i = 1; i < frames.size(); ++i) {
    const double gap_ms = difference_ms(frames[i].arrival.count(), frames[i - 1].arrival.count());
    if (gap_ms < 0) ++facts.backward_arrivals;
    if (i == 1 || gap_ms * 1e-3 > facts.longest_gap_s) {
      facts.longest_gap_s = gap_ms * 1e-3;
      facts.gap_at_s = difference_ms(frames[i - 1].arrival.count(), first) * 1e-3;
    }
  }
}

// From the ends, which are enough to find stamps of another unit; without jumps.
void note_drift(std::span<const StampedFrame> frames, StreamFacts& facts) {
  constexpr std::size_t kFramesForDrift = 30;
  const StampedFrame& first = frames.front();
  const StampedFrame& last = frames.back();
  const double device_ms = difference_ms(last.sensor.count(), first.sensor.count());
  if (frames.size() < kFramesForDrift || !(device_ms > 0)) return;
  const double host_ms = facts.arrivals_ms.back() - facts.arrivals_ms.front();
  facts.drift_ppm = (host_ms / device_ms - 1) * 1e6;
}

void note_grid(std::span<const StampedFrame> frames, const StampGrid& grid, StreamFacts& facts) {
  facts.period_ms = grid.period_ms;
  facts.interval_jitter_ms = grid.interval_jitter_ms;
  facts.scatter_ms = grid.scatter_ms;
  facts.on_grid_share = grid.on_grid_share;
  facts.has_grid = grid.exists;
  facts.periods = grid.points;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    if (interval_ms(frames, i) < 0) ++facts.backward_stamps;
    if (frames[i].sensor == frames[i - 1].sensor) ++facts.repeated_stamps;
  }
  facts.first_stamp = frames.front().sensor;
  facts.stamps_ms.reserve(frames.size());
  for (const StampedFrame& frame : frames) {
    facts.stamps_ms.push_back(difference_ms(frame.sensor.count(), facts.first_stamp.count()));
  }
}

double median_of(const std::vector<double>& values, std::ptrdiff_t begin, std::ptrdiff_t end) {
  return median(std::vector<double>(values.begin() + begin, values.begin() + end));
}

// The scatter of one value, by the differences of neighbours, to which no drift and no jump
// matters.
double scatter_of(const std::vector<double>& values) {
  std::vector<double> differences;
  for (std::size_t i = 1; i < values.size(); ++i) differences.push_back(values[i] - values[i - 1]);
  return differences.empty() ? 0 : robust_deviation(std::move(differences)) / std::numbers::sqrt2;
}

// Steps of `offsets` (arrival - sensor stamp) that hold on for some frames.
std::vector<StampJump> find_jumps(std::span<const StampedFrame> frames,
                                  const std::vector<double>& offsets, const StreamFacts& facts) {
  const double period_ms = facts.period_ms;
  const auto size = static_cast<std::ptrdiff_t>(offsets.size());
  const double tolerance =
      std::clamp(kWindowScatters * scatter_of(offsets) / period_ms, kLeastWhole, kMostWhole);
  std::vector<StampJump> jumps;
  std::ptrdiff_t settled = 0;  // no jump before this frame
  for (std::ptrdiff_t i = 0; i < size; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const std::ptrdiff_t before = std::min(kJumpWindow, i - settled);
    const std::ptrdiff_t after = std::min(kJumpWindow, size - i);
    const bool candidate = before >= kLeastJumpWindow && after >= kLeastJumpWindow &&
                           std::abs(offsets[at] - offsets[at - 1]) > period_ms / 2;
    if (!candidate) continue;
    const double step = median_of(offsets, i, i + after) - median_of(offsets, i - before, i);
    if (std::abs(step) <= period_ms / 2) continue;
    const double periods = step / period_ms;
    const bool whole = std::abs(periods - std::round(periods)) < tolerance;
    const bool few = std::abs(periods) < kMostPeriods;
    jumps.push_back({.frame = at,
                     .at_s = arrival_s(frames, at, facts),
                     .step_ms = step,
                     .periods = whole && few ? static_cast<int>(std::round(periods)) : 0});
    settled = i;
  }
  return jumps;
}

// Frames that come late for a while and then in time again: a busy host, not two jumps.
void drop_passing(std::vector<StampJump>& jumps, double period_ms) {
  for (std::size_t i = 0; i + 1 < jumps.size();) {
    const StampJump& up = jumps[i];
    const StampJump& down = jumps[i + 1];
    const bool passes = up.step_ms > 0 && down.at_s - up.at_s < kPassingS &&
                        std::abs(up.step_ms + down.step_ms) < period_ms / 2;
    const auto begin = jumps.begin() + static_cast<std::ptrdiff_t>(i);
    if (passes) {
      jumps.erase(begin, begin + 2);
    } else {
      ++i;
    }
  }
}

// Notes lasting jumps and removes them from the arrivals.
void note_jumps(std::span<const StampedFrame> frames, const std::vector<double>& offsets,
                StreamFacts& facts) {
  facts.jumps = find_jumps(frames, offsets, facts);
  drop_passing(facts.jumps, facts.period_ms);
  // What jumps that often does not last: arrivals in batches, a delay that swings.
  if (facts.jumps.size() > kFewJumps + frames.size() / kFramesPerJump) facts.jumps.clear();
  double taken_out = 0;
  std::size_t next = 0;
  for (std::size_t i = 0; i < facts.arrivals_ms.size(); ++i) {
    while (next < facts.jumps.size() && facts.jumps[next].frame == i) {
      taken_out += facts.jumps[next++].step_ms;
    }
    facts.arrivals_ms[i] -= taken_out;
  }
}

// Frames that came later than usual, close together, where few others did.
void note_bursts(std::span<const StampedFrame> frames, const std::vector<double>& offsets,
                 StreamFacts& facts) {
  const double usual = quantile(offsets, 0.5);
  const double high = quantile(offsets, 0.9);
  const double limit =
      usual + std::max({kLeastBurstMs, facts.period_ms / 4, kBurstSpreads * (high - usual)});
  DelayBurst burst;
  std::int64_t all_late = 0;
  std::vector<DelayBurst> bursts;
  const auto end_burst = [&] {
    if (burst.late >= kLeastBurstFrames) bursts.push_back(burst);
    burst = {};
  };
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    if (offsets[i] <= limit) continue;
    ++all_late;
    const double at_s = arrival_s(frames, i, facts);
    if (burst.late > 0 && at_s - (burst.at_s + burst.for_s) > kBurstPauseS) end_burst();
    if (burst.late++ == 0) burst.at_s = at_s;
    burst.for_s = at_s - burst.at_s;
    burst.most_ms = std::max(burst.most_ms, offsets[i] - usual);
  }
  end_burst();
  const bool rare = static_cast<double>(all_late) < kMostLate * static_cast<double>(offsets.size());
  if (rare) facts.bursts = std::move(bursts);
}

// Arrivals less stamps, jumps and drift taken out.
std::vector<double> level_offsets(const StreamFacts& facts) {
  const auto size = static_cast<std::ptrdiff_t>(facts.arrivals_ms.size());
  std::vector<double> offsets(facts.arrivals_ms.size());
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    offsets[i] = facts.arrivals_ms[i] - facts.stamps_ms[i];
  }
  if (size < 2 * kJumpWindow) return offsets;
  const std::ptrdiff_t tenth = std::max(kLeastJumpWindow, size / 10);
  const double change = median_of(offsets, size - tenth, size) - median_of(offsets, 0, tenth);
  const double per_frame = change / static_cast<double>(size - tenth);
  for (std::ptrdiff_t i = 0; i < size; ++i) {
    offsets[static_cast<std::size_t>(i)] -= per_frame * static_cast<double>(i);
  }
  return offsets;
}

// Offsets far below nearly all others are stamps of the future, those far above are late frames.
void note_delays(std::span<const StampedFrame> frames, const std::vector<double>& offsets,
                 StreamFacts& facts) {
  if (offsets.size() < 2 * kJumpWindow) return;
  facts.delay.scatter_ms = (quantile(offsets, 0.84) - quantile(offsets, 0.16)) / 2;
  const double lowest = quantile(offsets, 0.01);
  const double limit = lowest - std::max(kLeastFutureMs, facts.period_ms / 4);
  for (const double offset : offsets) {
    if (offset >= limit) continue;
    ++facts.future_stamps;
    facts.future_ms = std::max(facts.future_ms, lowest - offset);
  }
  note_bursts(frames, offsets, facts);
}

void note_least_delay(std::span<const StampedFrame> frames, StreamFacts& facts) {
  std::vector<double> delays;
  delays.reserve(frames.size());
  for (const StampedFrame& frame : frames) {
    delays.push_back(difference_ms(frame.arrival.count(), frame.sensor.count()));
  }
  facts.delay.median_ms = median(delays);
  facts.delay.least_ms = quantile(std::move(delays), 0.01);
}

bool is_stamped_on_arrival(const StreamFacts& facts) {
  return !facts.one_clock && facts.scatter_ms > kSteadyShare * facts.period_ms &&
         facts.delay.scatter_ms < kFollowsShare * facts.scatter_ms && facts.has_grid;
}

// Frames of one batch arrive together, though their stamps are a period apart.
double batched_share(const StreamFacts& facts) {
  constexpr double kTogether = 0.1;  // of a period
  if (facts.arrivals_ms.size() < 2 || facts.one_clock) return kNan;
  std::size_t together = 0;
  for (std::size_t i = 1; i < facts.arrivals_ms.size(); ++i) {
    const double apart = facts.arrivals_ms[i] - facts.arrivals_ms[i - 1];
    if (facts.periods[i] > facts.periods[i - 1] && apart < kTogether * facts.period_ms) ++together;
  }
  return static_cast<double>(together) / static_cast<double>(facts.arrivals_ms.size() - 1);
}

// A move of the stamps alone is a jump.
void note_steps(std::span<const StampedFrame> frames, const StampGrid& grid, StreamFacts& facts) {
  constexpr std::size_t kNear = 2;  // frames
  for (const GridStep& step : grid.steps) {
    const bool is_jump = std::ranges::any_of(facts.jumps, [&step](const StampJump& jump) {
      return jump.frame <= step.frame + kNear && step.frame <= jump.frame + kNear;
    });
    if (is_jump) continue;
    facts.steps.push_back({.frame = step.frame,
                           .at_s = arrival_s(frames, step.frame, facts),
                           .step_ms = step.step_ms});
  }
}

// Medians of batches of frames, which a late frame hardly moves, between jumps. Each stretch
// between two jumps has its own zero, since a jump is known no better than the arrivals.
struct Batches {
  std::vector<double> x;  // periods, about the stretch's mean
  std::vector<double> y;  // arrival less the camera's periods, about its mean
  std::size_t stretches = 0;
};

void add_stretch(const StreamFacts& facts, const std::vector<double>& times_ms, std::size_t begin,
                 std::size_t end, Batches& batches) {
  const std::size_t all = facts.periods.size() >= kManyFrames ? kBatches : kFewBatches;
  const std::size_t share = std::max<std::size_t>(2, all * (end - begin) / facts.periods.size());
  const std::size_t count = std::min(share, (end - begin) / kLeastBatchFrames);
  if (count < 2) return;
  std::vector<double> x;
  std::vector<double> y;
  for (std::size_t batch = 0; batch < count; ++batch) {
    const std::size_t first = begin + batch * (end - begin) / count;
    const std::size_t last = begin + (batch + 1) * (end - begin) / count;
    std::vector<double> periods;
    std::vector<double> offsets;
    for (std::size_t i = first; i < last; ++i) {
      periods.push_back(static_cast<double>(facts.periods[i] - facts.periods[begin]));
      offsets.push_back(times_ms[i] - times_ms[begin] - periods.back() * facts.period_ms);
    }
    x.push_back(mean_of(periods));
    y.push_back(median(std::move(offsets)));
  }
  const double mean_x = mean_of(x);
  const double mean_y = mean_of(y);
  for (std::size_t i = 0; i < count; ++i) {
    batches.x.push_back(x[i] - mean_x);
    batches.y.push_back(y[i] - mean_y);
  }
  ++batches.stretches;
}

// The first frames of the stretches between jumps and steps, and the end.
std::vector<std::size_t> stretches_of(const StreamFacts& facts) {
  std::vector<std::size_t> begins = {0, facts.periods.size()};
  for (const StampJump& jump : facts.jumps) begins.push_back(jump.frame);
  for (const PhaseStep& step : facts.steps) begins.push_back(step.frame);
  std::ranges::sort(begins);
  return begins;
}

// The grid's period by another clock: a line through the batches. Their scatter about it gives its
// uncertainty, also where lateness lasts for many frames.
PeriodEstimate period_by(const StreamFacts& facts, const std::vector<double>& times_ms) {
  Batches batches;
  const std::vector<std::size_t> begins = stretches_of(facts);
  for (std::size_t i = 1; i < begins.size(); ++i) {
    if (begins[i] > begins[i - 1]) {
      add_stretch(facts, times_ms, begins[i - 1], begins[i], batches);
    }
  }
  if (batches.x.size() < kFewBatches || batches.x.size() < 2 * batches.stretches + 2) return {};
  const FittedLine line = fit_line(batches.x, batches.y);
  double scatter = 0;
  double width = 0;
  for (std::size_t i = 0; i < batches.x.size(); ++i) {
    const double residual = batches.y[i] - line.at(batches.x[i]);
    scatter += residual * residual;
    width += batches.x[i] * batches.x[i];
  }
  const auto freedom = static_cast<double>(batches.x.size() - batches.stretches - 1);
  const double period_ms = facts.period_ms + line.slope;
  const double sd_ppm = std::sqrt(scatter / freedom / width) / period_ms * 1e6;
  if (!(period_ms > 0) || !std::isfinite(sd_ppm)) return {};
  return {.period_ms = period_ms, .sd_ppm = sd_ppm, .freedom = freedom};
}

// The columns of the last frames.
FrameColumns columns_of(FrameColumns columns, std::size_t frames) {
  columns.for_each([frames](std::vector<double>& column) {
    if (column.empty()) return;
    column.erase(column.begin(), column.end() - static_cast<std::ptrdiff_t>(frames));
  });
  return columns;
}

}  // namespace

StreamFacts stream_facts(const RecordedStream& stream, std::optional<double> other_period_ms) {
  const std::span<const StampedFrame> recorded = stream.frames;
  StreamFacts facts;
  facts.counted = stream.counted;
  facts.stamped_by_host = stream.stamped_by_host;
  facts.realsense = stream.realsense;
  if (recorded.empty()) return facts;
  facts.wraps = count_wraps(recorded);
  facts.global_time = counts_from_1970(recorded);
  facts.one_clock = has_one_clock(recorded);
  note_arrivals(recorded, facts);
  note_least_delay(recorded, facts);
  std::vector<StampedFrame> all = unwrapped(recorded);
  facts.out_of_order = put_in_order_of_exposure(all);
  facts.account = {.delivered = static_cast<std::int64_t>(all.size())};
  if (const auto grid = stamp_grid(all, other_period_ms)) {
    facts.account = frame_account(all, stream.counted, *grid);
    facts.losses = loss_places(all, frame_gaps(all, stream.counted, *grid));
  }
  const std::span<const StampedFrame> frames = without_unsteady_start(all);
  const std::optional<StampGrid> grid = stamp_grid(frames, other_period_ms);
  if (!grid) return facts;
  note_grid(frames, *grid, facts);
  facts.rate_changes = rate_changes(frames, *grid);
  const double left_out_s = to_seconds(frames.front().arrival) - facts.first_arrival_s;
  for (RateChange& change : facts.rate_changes) change.at_s += left_out_s;

  std::vector<double> offsets;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    facts.arrivals_ms.push_back(difference_ms(frames[i].arrival.count(), 0));
    offsets.push_back(difference_ms(frames[i].arrival.count(), frames.front().arrival.count()) -
                      facts.stamps_ms[i]);
  }
  note_jumps(frames, offsets, facts);
  note_steps(frames, *grid, facts);
  note_drift(frames, facts);
  const std::vector<double> level = level_offsets(facts);
  note_delays(frames, level, facts);
  facts.stamped_on_arrival = is_stamped_on_arrival(facts);
  facts.batched_share = batched_share(facts);
  facts.stamp_period = period_by(facts, facts.stamps_ms);
  facts.host_period = period_by(facts, facts.arrivals_ms);
  facts.columns = column_facts(columns_of(stream.columns, frames.size()), frames, level);
  return facts;
}

}  // namespace simbench::evaluation
