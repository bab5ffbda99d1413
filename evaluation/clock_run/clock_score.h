// The score of one run of the hosts' clocks: how far apart they are over hours, how fast they come
// together, how they hold over without their master, and how stable they are.
//
// From `from` to `duration` the run is measured: spread, time errors (evaluation/scoring/
// time_errors.h) and stability (evaluation/stability). The times until the spread is below a bound
// for good count from the start of the run to `duration`; they exist only if a tenth of it remains.
// Then the master is lost for kMasterLostFor, and the clocks are watched for kRecovery more:
//
//   spread      largest minus smallest clock of all hosts, the master included
//   holdover    largest |TE| of any slave 60 s and 600 s after the loss
//   recovery    from the master's return until the spread stays within its largest while measured
//   HostTe      quantiles in time of a host's error, against true time and against the clock of
//               another host, the master's unless the span says otherwise
//
// A value that does not exist (never below, never recovered) is NaN. Deviations are the RMS over
// the slaves, MTIE is the largest of any slave.
//
// Memory: a reading a second of each host up to kMostReadings; of longer runs every second, fourth
// ... reading, for stability and the quantiles of the spread, so that memory is constant in time.
//
//   ClockScorer scorer({.duration = from_seconds(3600), .from = from_seconds(300), .hosts = 6});
//   const ClockCost cost = clock_source.run(clock_request, scorer);
//   const ClockScore score = scorer.finish(cost.messages);
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "evaluation/scoring/metrics.h"
#include "evaluation/scoring/sync_failures.h"
#include "evaluation/scoring/time_errors.h"
#include "evaluation/stability/stability.h"
#include "recording/clock_source.h"

namespace simbench::evaluation {

inline constexpr Nanoseconds kReadingInterval = std::chrono::seconds(1);
inline constexpr Nanoseconds kMasterLostFor = std::chrono::seconds(600);
inline constexpr Nanoseconds kRecovery = std::chrono::seconds(3600);
inline constexpr std::size_t kMostReadings = std::size_t{1} << 17U;  // of each host: 36 hours

struct ClockSpan {
  Nanoseconds duration{};
  Nanoseconds from{};
  std::size_t hosts = 0;
  std::size_t pairs_with = 0;  // whose clock the pairs are compared with
};

// The curves of several clocks as one: deviations are the RMS over those that have the tau, MTIE
// the largest. Terms add up.
StabilityCurves pooled(std::span<const StabilityCurves> curves);

// Readings of all hosts, `interval_s` apart from `start_s` on.
struct ClockReadings {
  double start_s = 0;
  double interval_s = 1;
  std::vector<std::vector<double>> errors_s{};  // by host, the master's first
};

// The time errors of one clock while measured.
struct HostTe {
  double median_ms = kNan;  // signed
  double median_abs_ms = kNan;
  double p95_abs_ms = kNan;
  double sd_ms = kNan;  // about its mean
};

struct ClockScore {
  MetricValues<double> values{};
  std::vector<double> host_errors_ms{};  // mean TE while measured, by host
  // By host, the master's first: against true time, and against `pairs_with`.
  std::vector<HostTe> to_truth{};
  std::vector<HostTe> pairs{};
  std::vector<SyncOutcome> failures{};  // of host synchronisation
  // Real programs that ended: where there is one, no value, curve or reading of the run is here.
  std::vector<ProgramFailure> program_failures{};
  StabilityCurves curves{};
  ClockReadings readings{};
};

class ClockScorer final : public ClockSink {
 public:
  // The span measured holds at least two readings.
  explicit ClockScorer(const ClockSpan& span);

  void on_master(double error_s) override { master_error_s_ = error_s; }
  void on_errors(TrueTime at, std::span<const double> errors_s) override;
  void on_outcome(const SyncOutcome& outcome) override { failures_.add(outcome); }
  void on_program_failure(const ProgramFailure& failure) override {
    program_failures_.push_back(failure);
  }

  // After the run, once. `messages`: those sent in `duration`.
  ClockScore finish(std::uint64_t messages);

 private:
  ClockScore without_values();
  void measure(std::span<const double> errors_s, double spread_ms);
  void halve();
  void watch_loss(Nanoseconds since_loss, std::span<const double> errors_s, double spread_ms);

  ClockSpan span_;
  double master_error_s_ = 0;
  ClockReadings kept_;
  std::vector<double> master_s_;  // its error at each of these
  std::size_t stride_ = 1;
  std::size_t measured_ = 0;
  std::vector<double> spreads_ms_;  // while measured, up to kMostReadings, every stride_th
  double spread_sum_ms_ = 0;
  double spread_max_ms_ = 0;
  TimeErrors errors_;
  SyncFailures failures_;
  std::vector<ProgramFailure> program_failures_;
  std::array<std::optional<TrueTime>, 3> last_above_{};
  double holdover_60_ms_ = kNan;
  double holdover_600_ms_ = kNan;
  std::optional<Nanoseconds> last_apart_;  // since the master's return
};

}  // namespace simbench::evaluation
