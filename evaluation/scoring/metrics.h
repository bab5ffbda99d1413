// The metrics: what each is, where a score keeps it, and where results show it.
//
// There is a list for each kind of result, captures of cameras and runs of the hosts' clocks alone,
// and there are no others: rows, sweeps, comparisons, gates, baselines, JSON, CSV, the archive
// reader, tables and figures go through metrics(). A new metric is a member of MetricValues and an
// entry of kMetricTable (both here), kAlignmentMetricTable (alignment_metrics.h; captures whose
// exposures are steered) or kClockMetricTable (clock_metrics.h), the line that computes it
// (pulse_scores.cc, set_counter.cc, ...), and its tests. Definitions: docs/design.md section 8.
//
// A metric has one of three forms: a value for each seed, of which a row has the median and the
// 5-95 % band (a Series); a number over all seeds together; a count, summed over the seeds.
//
//   for (const Metric& metric : metrics()) {
//     if (metric.is_series()) use(metric.id, metric.series(row).median);
//   }
#ifndef SIMBENCH_EVALUATION_SCORING_METRICS_H_
#define SIMBENCH_EVALUATION_SCORING_METRICS_H_

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
  // Of captures only whose exposures are steered (alignment_scores.h).
  Value exposure_spread_median_ms = no_value<Value>();
  Value exposure_spread_p95_ms = no_value<Value>();
  Value aligned_1_ms_s = no_value<Value>();  // after this time the spread stays below 1 ms
  Value aligned_0_1_ms_s = no_value<Value>();
  Value aligned_0_01_ms_s = no_value<Value>();
  Value disturbed_frames = no_value<Value>();    // a camera
  Value exposure_drift_ppm = no_value<Value>();  // of the worst camera
  Value wrong_locks = no_value<Value>();         // cameras
  // Of clock runs only (evaluation/clock_run/clock_score.h).
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
  std::int64_t expected = 0;  // evaluated pulses x sources; unverified: by the cameras' counters
  std::int64_t delivered = 0;
  std::int64_t dropped = 0;
};

// Sets count if one of their members is among the evaluated pulses.
struct SetCounts {
  std::int64_t emitted = 0;          // complete sets
  std::int64_t pure = 0;             // of those, all members from one pulse
  std::int64_t complete_pulses = 0;  // evaluated pulses that all sources delivered
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
enum class CsvColumns : std::uint8_t {
  kNone,
  kBand,        // ID, ID_p05, ID_p95
  kValue,       // a series: its median
  kValueAtEnd,  // likewise, behind the published values
};

// The metric's place, from 1, among the columns or panels of each report; 0: it is not shown.
struct TablePlaces {
  int summary = 0;         // the few of the first table
  int paper = 0;           // the paper's metrics
  int truth = 0;           // metrics that need true time
  int time_errors = 0;     // the hosts' time errors
  int alignment = 0;       // exposures that are steered
  int sets = 0;            // gathered sets
  int clocks = 0;          // runs of the hosts' clocks
  int response = 0;        // the table of a sweep
  int response_panel = 0;  // the figure of a sweep
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
  const char* unit = "";   // "ms", "s", "1/s", "ppm", "share", or "" of a count
  Better better = Better::kLower;
  Needs needs = Needs::kNothing;
  Place place;

  // In tables: "\n" breaks a heading. Without a heading for the band, the median stands alone.
  TablePlaces tables{};
  const char* heading = "";
  const char* band_heading = nullptr;
  const char* legend = "";
  bool legend_continues = false;  // on the line of the metric before it

  // In files. JSON: a member of the row's object `json_in` ("": of the row), named `json_name`
  // (null: id). Sweeps: the name of its column in sweep.csv (null: none).
  const char* json_in = "";
  const char* json_name = nullptr;
  CsvColumns csv = CsvColumns::kNone;
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
// Those that the rows are judged by: without metrics that archives may lack (is_new) and of which
// no row has a value.
std::vector<const Metric*> judged_metrics(ResultKind kind, std::span<const Row* const> rows);
// The columns of a sweep, in their order: series and numbers, then counts.
std::vector<const Metric*> sweep_metrics(ResultKind kind = ResultKind::kCaptures);
// The columns of a table, in their order: table_metrics(&TablePlaces::truth).
std::vector<const Metric*> table_metrics(int TablePlaces::*table,
                                         ResultKind kind = ResultKind::kCaptures);

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
inline constexpr const char* kInFrames = "frames";
inline constexpr Judged kJudgedMs = {.smallest_step = 0.001,  // the last digit of the tables
                                     .margin = {.relative = 0.02, .absolute = 0.001}};
inline constexpr Judged kJudgedShare = {.smallest_step = 0.001,
                                        .margin = {.relative = 0.01, .absolute = 0.005}};

// Time errors are metrics of both kinds; only clock runs, which are long, are judged by them.
constexpr Metric time_error(const char* id, const char* title, SeriesPlace kept, int place,
                            const char* heading, const char* legend) {
  Metric metric;
  metric.id = id;
  metric.title = title;
  metric.unit = "ms";
  metric.needs = Needs::kTruth;
  metric.place = kept;
  metric.tables.time_errors = place;
  metric.heading = heading;
  metric.legend = legend;
  metric.legend_continues = place > 1;
  metric.sweep = id;
  metric.is_new = true;
  return metric;
}
inline constexpr Metric kMaxTe =
    time_error("max_te_ms", "largest time error",
               {&MetricValues<double>::max_te_ms, &MetricValues<Series>::max_te_ms}, 1, "max |TE|",
               "TE: a host's clock minus the master's, over all slaves;");
inline constexpr Metric kRmsTe = time_error(
    "rms_te_ms", "RMS time error",
    {&MetricValues<double>::rms_te_ms, &MetricValues<Series>::rms_te_ms}, 2, "RMS TE", "");
inline constexpr Metric kConstantTe =
    time_error("constant_te_ms", "constant time error",
               {&MetricValues<double>::constant_te_ms, &MetricValues<Series>::constant_te_ms}, 3,
               "constant\nTE", "constant: largest mean of a host;");
inline constexpr Metric kDynamicTe =
    time_error("dynamic_te_ms", "dynamic time error",
               {&MetricValues<double>::dynamic_te_ms, &MetricValues<Series>::dynamic_te_ms}, 4,
               "dynamic\nTE", "dynamic: largest range of a host.");
// Of both kinds of runs; in tables of captures beside the hosts' time errors.
constexpr Metric packets_metric() {
  Metric metric;
  metric.id = "packets_per_s";
  metric.title = "packets per second";
  metric.unit = "1/s";
  metric.better = Better::kNeither;
  metric.place =
      SeriesPlace{&MetricValues<double>::packets_per_s, &MetricValues<Series>::packets_per_s};
  metric.heading = "packets\nper s";
  metric.sweep = "packets_per_s";
  return metric;
}
constexpr Metric packets_of_captures() {
  Metric metric = packets_metric();
  metric.tables = {.time_errors = 5, .response = 7};
  metric.legend =
      "packets: messages that all hosts sent, the lost ones too, from the start of host "
      "synchronisation to the end of the capture.";
  metric.csv = CsvColumns::kValueAtEnd;
  metric.is_new = true;
  return metric;
}
inline constexpr Metric kMetricTable[] = {
    {.id = "amd_ms",
     .title = "AMD",
     .unit = "ms",
     .place = SeriesPlace{&MetricValues<double>::amd_ms, &MetricValues<Series>::amd_ms},
     .tables = {.summary = 1, .paper = 1, .response = 1, .response_panel = 1},
     .heading = "AMD\nmedian",
     .band_heading = "AMD\n5-95 %",
     .legend = "AMD: mean range of the global stamps of a pulse over all cameras;",
     .csv = CsvColumns::kBand,
     .sweep = "amd_ms",
     .judged = kJudgedMs},
    {.id = "rmdv_ms",
     .title = "RMDV",
     .unit = "ms",
     .place = SeriesPlace{&MetricValues<double>::rmdv_ms, &MetricValues<Series>::rmdv_ms},
     .tables = {.paper = 2},
     .heading = "RMDV\nmedian",
     .band_heading = "RMDV\n5-95 %",
     .legend = "RMDV: mean RMS deviation of these from their median.",
     .legend_continues = true,
     .csv = CsvColumns::kBand,
     .sweep = "rmdv_ms",
     .judged = kJudgedMs},
    {.id = "absolute_error_ms",
     .title = "absolute error",
     .unit = "ms",
     .needs = Needs::kTruth,
     .place = SeriesPlace{&MetricValues<double>::absolute_error_ms,
                          &MetricValues<Series>::absolute_error_ms},
     .tables = {.summary = 2, .truth = 1, .response = 2, .response_panel = 2},
     .heading = "absolute error\nmedian",
     .band_heading = "absolute error\n5-95 %",
     .legend = "absolute error: mean |global stamp - true mid-exposure on the master's clock|;",
     .csv = CsvColumns::kBand,
     .sweep = "absolute_error_ms",
     .judged = kJudgedMs},
    {.id = "bias_ms",
     .title = "bias",
     .unit = "ms",
     .better = Better::kNearestZero,
     .needs = Needs::kTruth,
     .place = SeriesPlace{&MetricValues<double>::bias_ms, &MetricValues<Series>::bias_ms},
     .tables = {.truth = 2},
     .heading = "bias",
     .legend = "bias: the signed mean, which AMD cannot show.",
     .legend_continues = true,
     .csv = CsvColumns::kBand,
     .sweep = "bias_ms"},
    {.id = "host_error_ms",
     .title = "host clock error",
     .unit = "ms",
     .needs = Needs::kTruth,
     .place =
         SeriesPlace{&MetricValues<double>::host_error_ms, &MetricValues<Series>::host_error_ms},
     .tables = {.summary = 3, .truth = 3, .response = 3},
     .heading = "host clock error\nmedian",
     .band_heading = "host clock error\n5-95 %",
     .legend = "host clock error: mean |slave - master|.",
     .csv = CsvColumns::kBand,
     .sweep = "host_error_ms"},
    kMaxTe,
    kRmsTe,
    kConstantTe,
    kDynamicTe,
    packets_of_captures(),
    {.id = "exposure_spread_ms",
     .title = "exposure spread",
     .unit = "ms",
     .better = Better::kNeither,
     .needs = Needs::kTruth,
     .place = SeriesPlace{&MetricValues<double>::exposure_spread_ms,
                          &MetricValues<Series>::exposure_spread_ms},
     .tables = {.truth = 4},
     .heading = "exposure\nspread",
     .legend = "exposure spread: how far apart the exposures really were, a limit for AMD.",
     .legend_continues = true,
     .csv = CsvColumns::kBand,
     .sweep = "exposure_spread_ms"},
    {.id = "precision",
     .title = "precision",
     .unit = "share",
     .better = Better::kHigher,
     .needs = Needs::kVerifiedSets,
     .place = &PooledValues::precision,
     .tables = {.summary = 4, .truth = 5, .sets = 2, .response = 4},
     .heading = "sets:\nprecision",
     .legend = "precision: gathered sets that hold one pulse only;",
     .json_in = kInGathering,
     .csv = CsvColumns::kValue,
     .sweep = "precision"},
    {.id = "recall",
     .title = "recall",
     .unit = "share",
     .better = Better::kHigher,
     .needs = Needs::kVerifiedSets,
     .place = &PooledValues::recall,
     .tables = {.summary = 5, .truth = 6, .sets = 3, .response = 5, .response_panel = 3},
     .heading = "sets:\nrecall",
     .legend = "recall: complete pulses found whole;",
     .legend_continues = true,
     .json_in = kInGathering,
     .csv = CsvColumns::kValue,
     .sweep = "recall"},
    {.id = "margin_ms",
     .title = "margin",
     .unit = "ms",
     .better = Better::kHigher,
     .needs = Needs::kVerifiedSets,
     .place = &PooledValues::margin_ms,
     .tables = {.truth = 7, .response = 6, .response_panel = 4},
     .heading = "margin",
     .legend = "margin: limit less 99.9 % quantile of the range.",
     .legend_continues = true,
     .json_in = kInGathering,
     .csv = CsvColumns::kValue,
     .sweep = "margin_ms"},
    {.id = "seed_precision",
     .title = "precision",
     .unit = "share",
     .better = Better::kHigher,
     .needs = Needs::kVerifiedSets,
     .place =
         SeriesPlace{&MetricValues<double>::seed_precision, &MetricValues<Series>::seed_precision},
     .json_in = kInGathering},
    {.id = "seed_recall",
     .title = "recall",
     .unit = "share",
     .better = Better::kHigher,
     .needs = Needs::kVerifiedSets,
     .place = SeriesPlace{&MetricValues<double>::seed_recall, &MetricValues<Series>::seed_recall},
     .json_in = kInGathering,
     .judged = kJudgedShare},
    {.id = "sets",
     .title = "complete sets",
     .better = Better::kHigher,
     .place = &SetCounts::emitted,
     .tables = {.sets = 1},
     .heading = "complete\nsets",
     .json_in = kInGathering,
     .csv = CsvColumns::kValueAtEnd,
     .sweep = "sets"},
    {.id = "pure_sets",
     .title = "pure sets",
     .better = Better::kHigher,
     .needs = Needs::kVerifiedSets,
     .place = &SetCounts::pure,
     .json_in = kInGathering,
     .csv = CsvColumns::kValueAtEnd,
     .sweep = "pure_sets"},
    {.id = "complete_pulses",
     .title = "complete pulses",
     .better = Better::kNeither,
     .needs = Needs::kVerifiedSets,
     .place = &SetCounts::complete_pulses,
     .json_in = kInGathering,
     .sweep = "complete_pulses"},
    {.id = "partial_sets",
     .title = "partial sets",
     .place = &SetCounts::partial,
     .tables = {.sets = 5},
     .heading = "partial\nsets",
     .json_in = kInGathering,
     .csv = CsvColumns::kValueAtEnd},
    {.id = "index_errors",
     .title = "index errors",
     .needs = Needs::kVerifiedSets,
     .place = &SetCounts::index_errors,
     .tables = {.sets = 4},
     .heading = "index\nerrors",
     .legend = "index errors: members of complete sets of another pulse than most members.",
     .json_in = kInGathering,
     .csv = CsvColumns::kValueAtEnd},
    {.id = "discarded_frames",
     .title = "discarded frames",
     .place = &SetCounts::discarded_frames,
     .tables = {.sets = 6},
     .heading = "frames\ndiscarded",
     .json_in = kInGathering,
     .csv = CsvColumns::kValueAtEnd},
    {.id = "set_amd_ms",
     .title = "AMD of sets",
     .unit = "ms",
     .place = SeriesPlace{&MetricValues<double>::set_amd_ms, &MetricValues<Series>::set_amd_ms},
     .tables = {.sets = 7},
     .heading = "AMD of\nsets",
     .json_in = kInGathering,
     .csv = CsvColumns::kValueAtEnd,
     .sweep = "set_amd_ms"},
    {.id = "set_absolute_error_ms",
     .title = "absolute error of sets",
     .unit = "ms",
     .needs = Needs::kTruth,
     .place = SeriesPlace{&MetricValues<double>::set_absolute_error_ms,
                          &MetricValues<Series>::set_absolute_error_ms},
     .tables = {.sets = 8},
     .heading = "abs. error\nof sets",
     .json_in = kInGathering,
     .csv = CsvColumns::kValueAtEnd,
     .sweep = "set_absolute_error_ms"},
    {.id = "emission_latency_ms",
     .title = "emission latency",
     .unit = "ms",
     .place = SeriesPlace{&MetricValues<double>::emission_latency_ms,
                          &MetricValues<Series>::emission_latency_ms},
     .tables = {.sets = 9},
     .heading = "emitted after\nmean",
     .legend = "emitted after: since the last member's arrival. AMD of sets is small where "
               "gathering gave sets up: see recall.",
     .legend_continues = true,
     .json_in = kInGathering,
     .csv = CsvColumns::kValueAtEnd,
     .sweep = "emission_latency_ms"},
    {.id = "emission_latency_max_ms",
     .title = "largest emission latency",
     .unit = "ms",
     .place = &PooledValues::emission_latency_max_ms,
     .tables = {.sets = 10},
     .heading = "emitted after\nlargest",
     .json_in = kInGathering,
     .csv = CsvColumns::kValueAtEnd},
    {.id = "frames_expected",
     .title = "frames expected",
     .better = Better::kNeither,
     .place = &FrameCounts::expected,
     .json_in = kInFrames,
     .json_name = "expected",
     .csv = CsvColumns::kValue},
    {.id = "frames_delivered",
     .title = "frames delivered",
     .better = Better::kHigher,
     .place = &FrameCounts::delivered,
     .json_in = kInFrames,
     .json_name = "delivered",
     .csv = CsvColumns::kValue},
    {.id = "frames_dropped",
     .title = "frames dropped",
     .place = &FrameCounts::dropped,
     .tables = {.truth = 8},
     .heading = "frames\ndropped",
     .json_in = kInFrames,
     .json_name = "dropped",
     .csv = CsvColumns::kValue,
     .sweep = "frames_dropped"},
    {.id = "evaluated_pulses",
     .title = "pulses scored",
     .better = Better::kNeither,
     .place = &RunCounts::evaluated_pulses,
     .tables = {.truth = 9},
     .heading = "pulses\nscored",
     .csv = CsvColumns::kValue},
    {.id = "unsynchronised_hosts",
     .title = "unsynchronised hosts",
     .place = &RunCounts::unsynchronised_hosts,
     .csv = CsvColumns::kValue,
     .sweep = "unsynchronised_hosts"},
};

}  // namespace simbench::evaluation

#endif  // SIMBENCH_EVALUATION_SCORING_METRICS_H_
