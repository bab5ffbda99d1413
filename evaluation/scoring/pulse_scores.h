// The global stamps of the evaluated pulses, and the scores that are means over them.
//
// PulseTable has a row per pulse and a column per source, which is one stream of one camera. Rows
// fill in any order; a row is complete, and counts, when all sources have delivered. With truth a
// row also holds the correct stamps and the true exposures. 16 bytes a cell: 1.6 million cells for
// 18,000 cameras and 90 pulses, 26 MB. Nothing is allocated after construction.
//
// A score that does not exist is NaN: all without a complete pulse, the errors without truth, the
// spread inside a host where no host has two sources, the spread between hosts where there is one
// host, the trend of a single pulse.
//
//   PulseTable table(/*first_pulse=*/225, /*pulses=*/480, /*sources=*/18);
//   table.store(225, 3, global);
//   table.store_truth(225, 3, truth);
//   if (table.complete(0)) table.global_ns(0);   // 18 stamps of pulse 225
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "algorithms/ports/time.h"
#include "evaluation/scoring/pulse_spread.h"
#include "evaluation/scoring/results.h"
#include "evaluation/scoring/time_errors.h"
#include "recording/recording.h"

namespace simbench::evaluation {

class PulseTable {
 public:
  PulseTable(std::int64_t first_pulse, std::int64_t pulses, std::size_t sources);

  // Whether the pulse is evaluated.
  bool holds(std::int64_t pulse) const { return row_of(pulse) < rows_.size(); }

  // Stores the stamp of the source's frame of this pulse. A second frame of the same pulse is
  // ignored, and one of a pulse that is not held.
  void store(std::int64_t pulse, std::size_t source, GlobalTime global) {
    const std::size_t row = row_of(pulse);
    if (row >= rows_.size()) return;
    std::int64_t& cell = global_ns_[row * sources_ + source];
    if (cell != kNothing) return;
    cell = clamped_ns(global);
    ++rows_[row].delivered;
  }

  // Stores the truth about that frame; likewise.
  void store_truth(std::int64_t pulse, std::size_t source, const FrameTruth& truth) {
    const std::size_t row = row_of(pulse);
    if (row >= rows_.size()) return;
    std::int64_t& cell = reference_ns_[row * sources_ + source];
    if (cell != kNoReference) return;
    cell = nanoseconds_of(truth.reference);
    const TrueTime exposed = truth.mid_exposure();
    if (exposed < rows_[row].earliest) rows_[row].earliest = exposed;
    if (exposed > rows_[row].latest) rows_[row].latest = exposed;
    has_truth_ = true;
  }

  // Moves every stamp stored so far.
  void shift(Nanoseconds by);

  std::size_t rows() const { return rows_.size(); }
  std::size_t sources() const { return sources_; }
  std::int64_t pulse_of(std::size_t row) const {
    return first_pulse_ + static_cast<std::int64_t>(row);
  }
  // Beyond the rows for a pulse that is not held.
  std::size_t row_of(std::int64_t pulse) const {
    return static_cast<std::size_t>(pulse) - static_cast<std::size_t>(first_pulse_);
  }
  bool has(std::size_t row, std::size_t source) const {
    return global_ns_[row * sources_ + source] != kNothing;
  }
  bool complete(std::size_t row) const { return rows_[row].delivered == sources_; }
  std::size_t delivered(std::size_t row) const { return rows_[row].delivered; }
  bool has_truth() const { return has_truth_; }

  // Stamps by source, valid in a complete row.
  std::span<const std::int64_t> global_ns(std::size_t row) const {
    return {global_ns_.data() + row * sources_, sources_};
  }
  // With truth: the correct stamp of each source that delivered.
  std::span<const std::int64_t> reference_ns(std::size_t row) const {
    return {reference_ns_.data() + row * sources_, sources_};
  }
  Nanoseconds exposure_spread(std::size_t row) const {
    return rows_[row].latest - rows_[row].earliest;
  }

  // Limits a stamp to 146 years from zero, so that the difference of two does not overflow.
  static std::int64_t clamped_ns(GlobalTime global) {
    return std::clamp(nanoseconds_of(global), -kFarthest, kFarthest);
  }

 private:
  static constexpr std::int64_t kNothing = std::numeric_limits<std::int64_t>::min();
  static constexpr std::int64_t kFarthest = (std::int64_t{1} << 62) - 1;
  static constexpr std::int64_t kNoReference = -kFarthest;  // so that differences do not overflow

  struct alignas(32) Row {
    std::size_t delivered = 0;
    TrueTime earliest = TrueTime::max();  // mid-exposure
    TrueTime latest = TrueTime::min();
  };

  std::int64_t first_pulse_;
  std::size_t sources_;
  bool has_truth_ = false;
  std::vector<Row> rows_;
  std::vector<std::int64_t> global_ns_;
  std::vector<std::int64_t> reference_ns_;
};

// Mean errors of the host clocks over the evaluated pulses, from the truth.
//
// The error of a host is its system clock minus the master's at the instant of a pulse. The master
// (host 0) defines global time: its error is 0 and does not count in the mean. NaN: no slave, or no
// pulse with truth.
class HostErrors {
 public:
  explicit HostErrors(std::size_t hosts) : sum_ms_(hosts), errors_(hosts) {}

  // One value per host.
  void add(std::span<const Nanoseconds> errors);

  double mean_absolute_ms() const;              // over pulses and slaves
  std::vector<double> signed_means_ms() const;  // over pulses, by host
  const TimeErrors& time_errors() const { return errors_; }

 private:
  std::vector<double> sum_ms_;
  double absolute_sum_ms_ = 0;
  std::int64_t pulses_ = 0;
  TimeErrors errors_;
};

// The input of the scores besides the table.
struct PulseScoring {
  MedianKind median = MedianKind::kUpperMiddle;
  Nanoseconds period{};  // of the pulses
  // Each source exposes at one of so many pulses: the others are no lost frames.
  std::int64_t pulses_per_frame = 1;
  std::vector<std::int64_t>
      pulses_per_frame_of_source{};  // in place of it, by column; empty: alike
  std::uint32_t hosts = 0;
  std::vector<std::uint32_t> host_of_source;  // by column of the table
};

// Sets amd_ms, rmdv_ms, that as printed, absolute_error_ms, bias_ms, exposure_spread_ms, the two
// spreads by host, trend_ms, share_below_half_period, frames, sets.complete_pulses and pulses.
// O(pulses x sources).
void score_pulses(const PulseTable& table, const PulseScoring& scoring, SeedScore& score);

// AMD alone, of stamps that come source by source: no table, but the range of each pulse.
//
//   PulseRanges ranges(/*first_pulse=*/225, /*pulses=*/480);
//   ranges.add(/*source=*/0, 225, global);    // all of source 0, then all of source 1, ...
//   ranges.amd_ms(/*sources=*/18);
class PulseRanges {
 public:
  PulseRanges(std::int64_t first_pulse, std::int64_t pulses)
      : first_pulse_(first_pulse), rows_(static_cast<std::size_t>(pulses)) {}

  // Ignores pulses that are not evaluated, and a second frame of a source.
  void add(std::uint32_t source, std::int64_t pulse, GlobalTime global) {
    const std::uint64_t row =
        static_cast<std::uint64_t>(pulse) - static_cast<std::uint64_t>(first_pulse_);
    if (row >= rows_.size()) return;
    Row& of = rows_[row];
    if (of.sources > 0 && of.newest_source == source) return;
    ++of.sources;
    of.newest_source = source;
    const std::int64_t global_ns = PulseTable::clamped_ns(global);
    of.least = std::min(of.least, global_ns);
    of.greatest = std::max(of.greatest, global_ns);
  }

  double amd_ms(std::size_t sources) const;

 private:
  struct Row {
    std::uint32_t sources = 0;
    std::uint32_t newest_source = 0;
    std::int64_t least = std::numeric_limits<std::int64_t>::max();
    std::int64_t greatest = std::numeric_limits<std::int64_t>::min();
  };

  std::int64_t first_pulse_;
  std::vector<Row> rows_;
};

}  // namespace simbench::evaluation
