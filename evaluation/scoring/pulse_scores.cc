#include "evaluation/scoring/pulse_scores.h"

#include <algorithm>
#include <cmath>

#include "algorithms/ports/assert.h"
#include "evaluation/statistics/statistics.h"

namespace simbench::evaluation {
namespace {

constexpr double kNsInMs = 1e-6;

class Mean {
 public:
  void add(double value) {
    sum_ += value;
    ++count_;
  }
  double value() const { return count_ > 0 ? sum_ / static_cast<double>(count_) : kNan; }

 private:
  double sum_ = 0;
  std::int64_t count_ = 0;
};

// The spread of a pulse taken apart: inside its hosts, and between their means.
class HostSpreads {
 public:
  explicit HostSpreads(const PulseScoring& scoring)
      : host_of_source_(scoring.host_of_source), hosts_(scoring.hosts) {}

  void add_pulse(std::span<const std::int64_t> global_ns) {
    std::fill(hosts_.begin(), hosts_.end(), Host{});
    const std::int64_t base = global_ns.front();
    for (std::size_t source = 0; source < global_ns.size(); ++source) {
      hosts_[host_of_source_[source]].add(global_ns[source] - base);
    }
    double least = std::numeric_limits<double>::infinity();
    double greatest = -least;
    int hosts_with_sources = 0;
    for (const Host& host : hosts_) {
      if (host.count == 0) continue;
      if (host.count > 1) inside_.add(static_cast<double>(host.greatest - host.least) * kNsInMs);
      const double mean = host.sum / static_cast<double>(host.count);
      least = std::min(least, mean);
      greatest = std::max(greatest, mean);
      ++hosts_with_sources;
    }
    if (hosts_with_sources > 1) between_.add((greatest - least) * kNsInMs);
  }

  double inside_ms() const { return inside_.value(); }
  double between_ms() const { return between_.value(); }

 private:
  struct Host {
    std::int64_t least = std::numeric_limits<std::int64_t>::max();
    std::int64_t greatest = std::numeric_limits<std::int64_t>::min();
    double sum = 0;
    std::int64_t count = 0;

    void add(std::int64_t stamp) {
      least = std::min(least, stamp);
      greatest = std::max(greatest, stamp);
      sum += static_cast<double>(stamp);
      ++count;
    }
  };

  const std::vector<std::uint32_t>& host_of_source_;
  std::vector<Host> hosts_;
  Mean inside_;
  Mean between_;
};

// Change of the spread from the first complete pulse to the last, along the least-squares line.
double trend_ms(const std::vector<PulseScore>& pulses) {
  if (pulses.size() < 2) return kNan;
  const std::int64_t first = pulses.front().pulse;
  std::vector<double> since_first;
  std::vector<double> spreads;
  for (const PulseScore& pulse : pulses) {
    since_first.push_back(static_cast<double>(pulse.pulse - first));
    spreads.push_back(pulse.spread_ms);
  }
  return fit_line(since_first, spreads).slope * since_first.back();
}

void score_errors(const PulseTable& table, SeedScore& score) {
  Mean absolute;
  Mean bias;
  Mean exposure;
  for (std::size_t row = 0; row < table.rows() && table.has_truth(); ++row) {
    if (!table.complete(row)) continue;
    const auto global = table.global_ns(row);
    const auto reference = table.reference_ns(row);
    for (std::size_t source = 0; source < global.size(); ++source) {
      const double error = static_cast<double>(global[source] - reference[source]) * kNsInMs;
      absolute.add(std::abs(error));
      bias.add(error);
    }
    if (table.sources() > 1) exposure.add(to_ms(table.exposure_spread(row)));
  }
  score.absolute_error_ms = absolute.value();
  score.bias_ms = bias.value();
  score.exposure_spread_ms = exposure.value();
}

// The exposures of a source that answers one of `pulses_per_frame` pulses: those delivered, and as
// many as fit between them, before the first and after the last.
std::int64_t exposures_of(const PulseTable& table, std::size_t source,
                          std::int64_t pulses_per_frame) {
  const auto rows = static_cast<std::int64_t>(table.rows());
  std::int64_t exposures = 0;
  std::int64_t last = -1;
  for (std::int64_t row = 0; row < rows; ++row) {
    if (!table.has(static_cast<std::size_t>(row), source)) continue;
    exposures += last < 0 ? row / pulses_per_frame + 1
                          : std::max<std::int64_t>(1, (row - last) / pulses_per_frame);
    last = row;
  }
  return last < 0 ? rows / pulses_per_frame : exposures + (rows - 1 - last) / pulses_per_frame;
}

std::int64_t exposures_due(const PulseTable& table, const PulseScoring& scoring) {
  const std::vector<std::int64_t>& of_source = scoring.pulses_per_frame_of_source;
  std::int64_t expected = 0;
  for (std::size_t source = 0; source < table.sources(); ++source) {
    const std::int64_t pulses = of_source.empty() ? scoring.pulses_per_frame : of_source[source];
    expected +=
        pulses == 1 ? static_cast<std::int64_t>(table.rows()) : exposures_of(table, source, pulses);
  }
  return expected;
}

void count_frames(const PulseTable& table, const PulseScoring& scoring, FrameCounts& frames) {
  frames.expected = exposures_due(table, scoring);
  for (std::size_t row = 0; row < table.rows(); ++row) {
    frames.delivered += static_cast<std::int64_t>(table.delivered(row));
  }
  frames.dropped = frames.expected - frames.delivered;
}

}  // namespace

PulseTable::PulseTable(std::int64_t first_pulse, std::int64_t pulses, std::size_t sources)
    : first_pulse_(first_pulse),
      sources_(sources),
      rows_(static_cast<std::size_t>(pulses)),
      global_ns_(rows_.size() * sources, kNothing),
      reference_ns_(rows_.size() * sources, kNoReference) {}

void PulseTable::shift(Nanoseconds by) {
  for (std::int64_t& cell : global_ns_) {
    if (cell != kNothing) cell = clamped_ns(GlobalTime(Nanoseconds(cell) + by));
  }
}

void HostErrors::add(std::span<const Nanoseconds> errors) {
  SIMBENCH_ASSERT(errors.size() == sum_ms_.size(), "the truth of a pulse has an error per host");
  for (std::size_t host = 0; host < errors.size(); ++host) {
    const double error_ms = to_ms(errors[host]);
    sum_ms_[host] += error_ms;
    if (host > 0) errors_.add(host, error_ms);
    if (host > 0) absolute_sum_ms_ += std::abs(error_ms);
  }
  ++pulses_;
}

double HostErrors::mean_absolute_ms() const {
  if (pulses_ == 0 || sum_ms_.size() < 2) return kNan;
  return absolute_sum_ms_ /
         (static_cast<double>(pulses_) * static_cast<double>(sum_ms_.size() - 1));
}

std::vector<double> HostErrors::signed_means_ms() const {
  std::vector<double> means(sum_ms_.size(), kNan);
  for (std::size_t host = 0; host < means.size() && pulses_ > 0; ++host) {
    means[host] = sum_ms_[host] / static_cast<double>(pulses_);
  }
  return means;
}

void score_pulses(const PulseTable& table, const PulseScoring& scoring, SeedScore& score) {
  count_frames(table, scoring, score.frames);
  score_errors(table, score);

  HostSpreads hosts(scoring);
  Mean amd;
  Mean rmdv;
  PrintedRmdv printed;
  Mean below_half_period;
  std::vector<std::int64_t> workspace;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    if (!table.complete(row)) continue;
    const auto stamps = table.global_ns(row);
    PulseScore& pulse = score.pulses.emplace_back(PulseScore{.pulse = table.pulse_of(row)});
    if (table.sources() < 2) continue;  // the stamp of a single camera has no range
    pulse.spread_ms = spread_ms(stamps);
    const Differences differences = differences_from_median(stamps, scoring.median, workspace);
    pulse.deviation_ms = differences.deviation_ms;
    amd.add(pulse.spread_ms);
    rmdv.add(pulse.deviation_ms);
    printed.add(differences);
    below_half_period.add(pulse.spread_ms < to_ms(scoring.period) / 2 ? 1 : 0);
    hosts.add_pulse(stamps);
  }
  score.sets.complete_pulses = static_cast<std::int64_t>(score.pulses.size());
  if (table.sources() < 2) return;
  score.amd_ms = amd.value();
  score.rmdv_ms = rmdv.value();
  score.rmdv_printed_sqrt_ms = printed.mean_sqrt_ms();
  score.rmdv_printed_share = printed.real_share();
  score.share_below_half_period = below_half_period.value();
  score.spread_in_host_ms = hosts.inside_ms();
  score.spread_between_hosts_ms = hosts.between_ms();
  score.trend_ms = trend_ms(score.pulses);
}

double PulseRanges::amd_ms(std::size_t sources) const {
  if (sources < 2) return kNan;
  Mean amd;
  for (const Row& row : rows_) {
    if (row.sources == sources) amd.add(static_cast<double>(row.greatest - row.least) * kNsInMs);
  }
  return amd.value();
}

}  // namespace simbench::evaluation
