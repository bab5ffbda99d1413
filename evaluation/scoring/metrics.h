// The metrics: what each is, and where a score and the results' files keep it. What tables show of
// them: reports/results/metric_columns.h.
//
// There is a list for each kind of result, captures of cameras and runs of the hosts' clocks alone,
// and there are no others: rows, sweeps, comparisons, gates, baselines, JSON, CSV, the archive
// reader, tables and figures go through metrics(). A new metric is a member of MetricValues (here),
// an entry of the table in metric_table.cc, the line that computes it (pulse_scores.cc,
// set_counter.cc, ...), and its tests. Definitions: docs/design.md section 8.
//
// A metric has one of three forms: a value for each seed, of which a row has the median and the
// 5-95 % band (a Series); a number over all seeds together; a count, summed over the seeds.
//
//   for (const Metric& metric : metrics()) {
//     if (metric.is_series()) use(metric.id, metric.series(row).median);
//   }
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "evaluation/statistics/statistics.h"

namespace simbench::evaluation {

struct Row;

enum class ResultKind : std::uint8_t {
  kCaptures,
  kClockRuns,  // evaluation/clock_run
};

// The initial value: NaN for a seed, an empty series for a row.
template <class Value>
constexpr Value no_value() {
  if constexpr (std::is_same_v<Value, double>) {
    return kNan;
  } else {
    return {};
  }
}

// Values measured once per seed: of one seed (double) or over the seeds (Series).
template <class Value>
struct MetricValues {
  Value amd_ms = no_value<Value>();
  Value rmdv_ms = no_value<Value>();
  // Eq. (4) as printed, without the square (pulse_spread.h): no table shows these.
  Value rmdv_printed_sqrt_ms = no_value<Value>();
  Value rmdv_printed_share = no_value<Value>();  // of pulses: with a real root
  Value absolute_error_ms = no_value<Value>();
  Value bias_ms = no_value<Value>();
  Value host_error_ms = no_value<Value>();
  Value exposure_spread_ms = no_value<Value>();
  Value seed_precision = no_value<Value>();  // of the seed's own sets
  Value seed_recall = no_value<Value>();
  // Over the complete sets that gathering emitted; NaN without such sets (or without truth).
  Value set_amd_ms = no_value<Value>();  // mean range of a set's stamps
  Value set_absolute_error_ms = no_value<Value>();
  // From the arrival of the last member to that of the frame on which the gatherer emitted.
  Value emission_latency_ms = no_value<Value>();  // mean over these sets
  // Time error (TE) of the hosts: system clock minus the master's. Over the evaluated pulses of a
  // capture, or the seconds of a clock run.
  Value max_te_ms = no_value<Value>();       // largest |TE| of any host
  Value rms_te_ms = no_value<Value>();       // over all slaves
  Value constant_te_ms = no_value<Value>();  // largest |mean TE| of any host
  Value dynamic_te_ms = no_value<Value>();   // largest range (peak to peak) of any host's TE
  // Messages that all hosts sent, the lost ones too, over the time of the whole run.
  Value packets_per_s = no_value<Value>();
  // Only captures whose exposures are steered have these (alignment_scores.h).
  Value exposure_spread_median_ms = no_value<Value>();
  Value exposure_spread_p95_ms = no_value<Value>();
  Value aligned_1_ms_s = no_value<Value>();  // after this time the spread stays below 1 ms
  Value aligned_0_1_ms_s = no_value<Value>();
  Value aligned_0_01_ms_s = no_value<Value>();
  Value disturbed_frames = no_value<Value>();    // a camera
  Value exposure_drift_ppm = no_value<Value>();  // of the worst camera
  Value wrong_locks = no_value<Value>();         // cameras
  // Only rigs of depth and colour have these (colour_offset.h).
  Value colour_offset_ms = no_value<Value>();
  Value colour_offset_spread_ms = no_value<Value>();  // over the cameras
  // Only evaluations that certify have it (EvaluationOptions::certify): no two frames of 95 % of
  // the sets are further apart (certificates/certify.h); NaN where nothing bounds it.
  Value certified_ms = no_value<Value>();
  // Only rows of Algorithms 1 and 2 have these (session_scores.h): means over the slaves.
  Value t_l_ms = no_value<Value>();           // network synchronisation delay, as measured
  Value t_t_ms = no_value<Value>();           // time synchronisation delay, as measured
  Value t_d_ms = no_value<Value>();           // what the slaves added of them
  Value session_passes = no_value<Value>();   // of the loop of T_th
  Value get_time_ms = no_value<Value>();      // a call that reads the slave's clock
  Value set_time_ms = no_value<Value>();      // a call that sets it
  Value message_time_ms = no_value<Value>();  // sending and receiving a message
  // Only clock runs have these (evaluation/clock_run/clock_score.h).
  Value clock_spread_ms = no_value<Value>();  // mean in time: largest minus smallest clock
  Value clock_spread_median_ms = no_value<Value>();
  Value clock_spread_p95_ms = no_value<Value>();
  Value clock_spread_max_ms = no_value<Value>();
  Value below_1_ms_s = no_value<Value>();  // after this time the spread stays below 1 ms
  Value below_0_1_ms_s = no_value<Value>();
  Value below_0_01_ms_s = no_value<Value>();
  Value holdover_60_ms = no_value<Value>();  // largest |TE| 60 s after the master was lost
  Value holdover_600_ms = no_value<Value>();
  Value recovery_s = no_value<Value>();  // from its return until the spread is as before
  // Without an entry below: only the claims of the paper use these.
  Value offline_amd_ms = no_value<Value>();     // AMD of regression_offline over the same recording
  Value spread_in_host_ms = no_value<Value>();  // mean over pulses and hosts of the range in a host
  Value spread_between_hosts_ms = no_value<Value>();  // mean over pulses: range of hosts' means
  Value trend_ms = no_value<Value>();  // change of the spread over the recording, by least squares
  Value share_below_half_period = no_value<Value>();  // of pulses: spread under half a period
};

// Numbers over all seeds together; rows.cc computes them.
struct PooledValues {
  double precision = 0;
  double recall = 0;
  double margin_ms = 0;
  double emission_latency_max_ms = kNan;
};

struct FrameCounts {
  // The evaluated pulses of each source, or what it exposes of them where its mode is too slow for
  // all (PulseScoring::pulses_per_frame); unverified: by the cameras' counters.
  std::int64_t expected = 0;
  std::int64_t delivered = 0;
  std::int64_t dropped = 0;
};

// Sets count if one of their members is among the evaluated pulses.
struct SetCounts {
  std::int64_t emitted = 0;          // complete sets
  std::int64_t pure = 0;             // of those, all members from one pulse
  std::int64_t complete_pulses = 0;  // evaluated pulses that all sources delivered
  // What became of the pulses (pulse_account.h); 0 due: it is not known.
  std::int64_t due_pulses = 0;
  std::int64_t exposed_pulses = 0;  // by all cameras
  std::int64_t discarded_frames = 0;
  std::int64_t partial = 0;       // sets that lack a source
  std::int64_t index_errors = 0;  // members of emitted sets of another pulse than most members
};

struct RunCounts {
  std::int64_t evaluated_pulses = 0;      // behind the scores; unverified: sets
  std::int64_t unsynchronised_hosts = 0;  // over all seeds
};

enum class Better : std::uint8_t { kLower, kHigher, kNearestZero, kNeither };

// What a metric depends on; without it the metric is NaN, null in JSON, empty in CSV, "-" in
// tables.
enum class Needs : std::uint8_t {
  kNothing,
  kVerifiedSets,  // it is known which frames belong together
  kTruth,         // only a simulation (or an experiment that shares a clock) knows it
};

// The columns of a metric in results.csv.
enum class CsvForm : std::uint8_t {
  kNone,
  kBand,        // ID, ID_p05, ID_p95
  kValue,       // a series: its median
  kValueAtEnd,  // likewise, behind the published values
};

// How much worse a metric may become: the larger of a share of the old value and a step.
struct GateMargin {
  double relative = 0;
  double absolute = 0;  // in the metric's unit
};

// For a metric that comparisons and gates judge.
struct Judged {
  double smallest_step = 0;  // a smaller change is insignificant, whatever its share
  GateMargin margin;         // unless a baseline states another
};

// Where a seed and a row keep the values.
struct SeriesPlace {
  double MetricValues<double>::*seed = nullptr;
  Series MetricValues<Series>::*row = nullptr;
};
using Place = std::variant<SeriesPlace, double PooledValues::*, std::int64_t SetCounts::*,
                           std::int64_t FrameCounts::*, std::int64_t RunCounts::*>;

struct Metric {
  const char* id = "";     // its name in JSON and CSV, with the unit last
  const char* title = "";  // in a sentence
  const char* unit = "";   // "ms", "sqrt(ms)", "s", "1/s", "ppm", "share", or "" of a count
  Better better = Better::kLower;
  Needs needs = Needs::kNothing;
  Place place;

  // In files. JSON: a member of the row's object `json_in` ("": of the row), named `json_name`
  // (null: id). Sweeps: the name of its column in sweep.csv (null: none).
  const char* json_in = "";
  const char* json_name = nullptr;
  CsvForm csv = CsvForm::kNone;
  const char* sweep = nullptr;
  bool is_new = false;  // archives of simbench 0.1 lack it

  std::optional<Judged> judged{};

  bool is_series() const { return std::holds_alternative<SeriesPlace>(place); }
  bool is_count() const {
    return !is_series() && !std::holds_alternative<double PooledValues::*>(place);
  }
  bool higher_is_better() const { return better == Better::kHigher; }
  bool is_share() const { return std::string_view(unit) == "share"; }
  // How long until something is so; NaN: it never was.
  bool is_time_until() const { return std::string_view(unit) == "s"; }
  const char* member() const { return json_name != nullptr ? json_name : id; }  // in JSON

  // Whether a value can be the metric's: a share is from 0 to 1, what is judged is not below 0. NaN
  // (no value) can. allowed(): that in words.
  bool can_be(double value) const;
  const char* allowed() const;

  // Access to the value in the metric's form; another form is a programming error.
  double of_seed(const MetricValues<double>& seed) const;
  double& of_seed(MetricValues<double>& seed) const;
  const Series& series(const Row& row) const;
  Series& series(Row& row) const;
  double number(const Row& row) const;
  double& number(Row& row) const;
  std::int64_t count(const Row& row) const;
  std::int64_t& count(Row& row) const;

  // Whether the row knows the value. An unknown series or number is NaN; a count cannot be.
  bool is_known(const Row& row) const;
  // The value over all seeds: median (of a time until: median_time()), number or count; NaN if the
  // row does not know it.
  double value(const Row& row) const;

  // Reduces a series for comparisons and gates: to its median, a share to the mean of the values
  // that exist. (Gathering mostly finds all sets of a seed or none, so a median would stay at 100 %
  // until half of the seeds are lost.) NaN: no seed has a value.
  double table_value(const std::vector<double>& values) const;
};

// All metrics of a kind, in the order of the results' files.
std::span<const Metric> metrics(ResultKind kind = ResultKind::kCaptures);
// One of them, which must exist.
const Metric& metric(std::string_view id, ResultKind kind = ResultKind::kCaptures);

// The metrics with `judged`, in order: those of comparisons and gates.
std::vector<const Metric*> judged_metrics(ResultKind kind = ResultKind::kCaptures);
// Returns the metrics that the rows are judged by: without those that archives may lack (is_new)
// and of which no row has a value.
std::vector<const Metric*> judged_metrics(ResultKind kind, std::span<const Row* const> rows);
// The columns of a sweep, in their order: series and numbers, then counts.
std::vector<const Metric*> sweep_metrics(ResultKind kind = ResultKind::kCaptures);

// Adds a metric of captures at the end during its lifetime. For tests; not while others use
// metrics(), whose addresses change.
class ScopedMetric {
 public:
  explicit ScopedMetric(const Metric& metric);
  ~ScopedMetric();
  ScopedMetric(const ScopedMetric&) = delete;
  ScopedMetric& operator=(const ScopedMetric&) = delete;
};

inline constexpr const char* kInGathering = "gathering_score";
inline constexpr Judged kJudgedMs = {.smallest_step = 0.001,  // the last digit of the tables
                                     .margin = {.relative = 0.02, .absolute = 0.001}};

}  // namespace simbench::evaluation
