#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <utility>
#include <vector>

#include "evaluation/diagnosis/diagnose.h"
#include "evaluation/frames/camera_statistics.h"
#include "evaluation/frames/frame_account.h"
#include "evaluation/statistics/statistics.h"

namespace simbench::evaluation {
namespace {

constexpr Nanoseconds kWarmUp = std::chrono::seconds(5);
constexpr Nanoseconds kLongRecording = std::chrono::seconds(20);
constexpr double kOnGrid = 0.1;             // of a period
constexpr std::ptrdiff_t kJumpWindow = 15;  // frames on either side
constexpr std::ptrdiff_t kLeastJumpWindow = 5;
constexpr double kWholePeriod = 0.15;  // how far from a whole number of periods a slip may be
constexpr double kMostPeriods = 1000;
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

std::span<const StampedFrame> without_warm_up(std::span<const StampedFrame> frames) {
  if (frames.back().arrival - frames.front().arrival < kLongRecording) return frames;
  const Nanoseconds begin = frames.front().arrival + kWarmUp;
  const auto first = std::find_if(frames.begin(), frames.end(),
                                  [begin](const StampedFrame& f) { return f.arrival >= begin; });
  return frames.subspan(static_cast<std::size_t>(first - frames.begin()));
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

// The period of each frame, and the deviations of the intervals from whole periods.
void note_intervals(std::span<const StampedFrame> frames, StreamFacts& facts) {
  facts.periods.assign(1, 0);
  std::vector<double> deviations;
  std::int64_t on_grid = 0;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    const double interval = interval_ms(frames, i);
    const double whole = std::round(interval / facts.period_ms);
    const double deviation = interval - whole * facts.period_ms;
    facts.periods.push_back(facts.periods.back() + std::llround(whole));
    deviations.push_back(deviation);
    if (interval < 0) ++facts.backward_stamps;
    if (frames[i].sensor == frames[i - 1].sensor) ++facts.repeated_stamps;
    if (whole > 0 && std::abs(deviation) < kOnGrid * facts.period_ms) ++on_grid;
  }
  facts.interval_jitter_ms = standard_deviation(deviations);
  facts.on_grid_share = static_cast<double>(on_grid) / static_cast<double>(deviations.size());
}

double median_of(const std::vector<double>& values, std::ptrdiff_t begin, std::ptrdiff_t end) {
  return median(std::vector<double>(values.begin() + begin, values.begin() + end));
}

// Steps of `offsets` (arrival - sensor stamp) that hold on for some frames.
std::vector<StampJump> find_jumps(std::span<const StampedFrame> frames,
                                  const std::vector<double>& offsets, double period_ms) {
  const auto size = static_cast<std::ptrdiff_t>(offsets.size());
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
    const bool whole = std::abs(periods - std::round(periods)) < kWholePeriod;
    const bool few = std::abs(periods) < kMostPeriods;
    jumps.push_back(
        {.frame = at,
         .at_s = difference_ms(frames[at].arrival.count(), frames.front().arrival.count()) * 1e-3,
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
  facts.jumps = find_jumps(frames, offsets, facts.period_ms);
  drop_passing(facts.jumps, facts.period_ms);
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
  const auto since_start_s = [&frames](std::size_t i) {
    return difference_ms(frames[i].arrival.count(), frames.front().arrival.count()) * 1e-3;
  };
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
    const double at_s = since_start_s(i);
    if (burst.late > 0 && at_s - (burst.at_s + burst.for_s) > kBurstPauseS) end_burst();
    if (burst.late++ == 0) burst.at_s = at_s;
    burst.for_s = at_s - burst.at_s;
    burst.most_ms = std::max(burst.most_ms, offsets[i] - usual);
  }
  end_burst();
  const bool rare = static_cast<double>(all_late) < kMostLate * static_cast<double>(offsets.size());
  if (rare) facts.bursts = std::move(bursts);
}

// Offsets of arrivals from stamps, less their drift: those that lie below nearly all others are
// stamps of the future, those far above are late frames.
void note_delays(std::span<const StampedFrame> frames, StreamFacts& facts) {
  const auto size = static_cast<std::ptrdiff_t>(frames.size());
  if (size < 2 * kJumpWindow) return;
  std::vector<double> offsets(frames.size());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    offsets[i] = facts.arrivals_ms[i] -
                 difference_ms(frames[i].sensor.count(), frames.front().sensor.count());
  }
  const std::ptrdiff_t tenth = std::max(kLeastJumpWindow, size / 10);
  const double change = median_of(offsets, size - tenth, size) - median_of(offsets, 0, tenth);
  const double per_frame = change / static_cast<double>(size - tenth);
  for (std::ptrdiff_t i = 0; i < size; ++i) {
    offsets[static_cast<std::size_t>(i)] -= per_frame * static_cast<double>(i);
  }
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
  facts.least_delay_ms = quantile(std::move(delays), 0.01);
}

// Medians of batches of frames, which a late frame hardly moves, between jumps. Each stretch
// between two jumps has its own zero, since a jump is known no better than the arrivals.
struct Batches {
  std::vector<double> x;  // periods, about the stretch's mean
  std::vector<double> y;  // arrival less the camera's periods, about its mean
  std::size_t stretches = 0;
};

void add_stretch(const StreamFacts& facts, std::size_t begin, std::size_t end, Batches& batches) {
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
      periods.push_back(static_cast<double>(facts.periods[i]));
      offsets.push_back(facts.arrivals_ms[i] - periods.back() * facts.period_ms);
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

// The period in host time: a line through the batches. Their scatter about it gives its
// uncertainty, also where lateness lasts for many frames.
void note_host_period(StreamFacts& facts) {
  Batches batches;
  std::size_t begin = 0;
  for (const StampJump& jump : facts.jumps) {
    add_stretch(facts, begin, jump.frame, batches);
    begin = jump.frame;
  }
  add_stretch(facts, begin, facts.periods.size(), batches);
  if (batches.x.size() < kFewBatches || batches.x.size() < 2 * batches.stretches + 2) return;
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
  if (!(period_ms > 0) || !std::isfinite(sd_ppm)) return;
  facts.host_period_ms = period_ms;
  facts.host_period_sd_ppm = sd_ppm;
}

constexpr double kMovesShare = 0.25;    // of a period; more is no jitter
constexpr double kMovesDeviations = 4;  // of the offsets

// The first stream's register may have wrapped before the second stream began.
std::int64_t register_difference(const StampedFrame& a, const StampedFrame& b) {
  const std::int64_t difference = (a.sensor - b.sensor).count();
  const double wraps =
      std::round(static_cast<double>(difference) / static_cast<double>(kDeviceRegisterNs));
  return difference - static_cast<std::int64_t>(wraps) * kDeviceRegisterNs;
}

}  // namespace

StreamFacts stream_facts(const RecordedStream& stream) {
  const std::span<const StampedFrame> recorded = stream.frames;
  StreamFacts facts;
  facts.counted = stream.counted;
  facts.stamped_by_host = stream.stamped_by_host;
  if (recorded.empty()) return facts;
  facts.wraps = count_wraps(recorded);
  facts.global_time = counts_from_1970(recorded);
  facts.one_clock = has_one_clock(recorded);
  note_arrivals(recorded, facts);
  const std::vector<StampedFrame> all = unwrapped(recorded);
  facts.account = frame_account(all, stream.counted);
  const std::span<const StampedFrame> frames = without_warm_up(all);
  const std::optional<double> period_ms = stream_period_ms(frames);
  if (!period_ms) return facts;
  facts.period_ms = *period_ms;
  note_intervals(frames, facts);

  std::vector<double> offsets;
  for (const StampedFrame& frame : frames) {
    facts.arrivals_ms.push_back(difference_ms(frame.arrival.count(), 0));
    offsets.push_back(difference_ms(frame.arrival.count(), frames.front().arrival.count()) -
                      difference_ms(frame.sensor.count(), frames.front().sensor.count()));
  }
  note_jumps(frames, offsets, facts);
  note_drift(frames, facts);
  note_delays(frames, facts);
  if (facts.stamped_by_host) note_least_delay(frames, facts);
  note_host_period(facts);
  return facts;
}

PairDiagnosis compare_streams(std::span<const StampedFrame> recorded,
                              std::span<const StampedFrame> recorded_against) {
  PairDiagnosis pair;
  if (recorded.size() < 2 || recorded_against.size() < 2) return pair;
  const std::vector<StampedFrame> frames = unwrapped(recorded);
  const std::vector<StampedFrame> against = unwrapped(recorded_against);
  const double period_ms = to_ms(median_period(against));
  if (!(period_ms > 0)) return pair;

  std::vector<double> minutes;
  std::vector<double> offsets;
  std::size_t nearest = 0;
  for (const StampedFrame& frame : frames) {
    const auto distance = [&](std::size_t i) {
      return std::abs(register_difference(frame, against[i]));
    };
    while (nearest + 1 < against.size() && distance(nearest + 1) <= distance(nearest)) ++nearest;
    double offset = static_cast<double>(register_difference(frame, against[nearest])) * 1e-6;
    if (std::abs(offset) > period_ms) continue;  // lost frames
    if (!offsets.empty()) {
      offset = offsets.back() + std::remainder(offset - offsets.back(), period_ms);
    }
    offsets.push_back(offset);
    minutes.push_back(difference_ms(frame.sensor.count(), frames.front().sensor.count()) / 60'000);
  }
  if (offsets.size() < 2) return pair;
  const FittedLine line = fit_line(minutes, offsets);
  std::vector<double> deviations;
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    deviations.push_back(offsets[i] - line.at(minutes[i]));
  }
  const double moved_ms = std::abs(line.slope) * (minutes.back() - minutes.front());
  pair.offset_ms = std::remainder(mean_of(offsets), period_ms);
  pair.spread_ms = standard_deviation(deviations);
  pair.moves_ms_per_minute = line.slope;
  pair.runs_free =
      moved_ms > kMovesShare * period_ms && moved_ms > kMovesDeviations * pair.spread_ms;
  return pair;
}

}  // namespace simbench::evaluation
