#include "reports/results/metric_columns.h"

#include <algorithm>
#include <iterator>
#include <string_view>

namespace simbench::reports {
namespace {

using evaluation::Metric;
using evaluation::ResultKind;

constexpr MetricColumn kCaptureColumns[] = {
    {.id = "amd_ms",
     .tables = {.summary = 1, .paper = 1, .response = 1, .response_panel = 1},
     .heading = "AMD\nmedian",
     .band_heading = "AMD\n5-95 %",
     .legend = "AMD: mean range of the global stamps of a pulse over all cameras;"},
    {.id = "rmdv_ms",
     .tables = {.paper = 2},
     .heading = "RMDV\nmedian",
     .band_heading = "RMDV\n5-95 %",
     .legend = "RMDV: mean RMS deviation of these from their median.",
     .legend_continues = true},
    {.id = "absolute_error_ms",
     .tables = {.summary = 2, .truth = 1, .response = 2, .response_panel = 2},
     .heading = "absolute error\nmedian",
     .band_heading = "absolute error\n5-95 %",
     .legend = "absolute error: mean |global stamp - true mid-exposure on the master's clock|;"},
    {.id = "bias_ms",
     .tables = {.truth = 2},
     .heading = "bias",
     .legend = "bias: the signed mean, which AMD cannot show.",
     .legend_continues = true},
    {.id = "host_error_ms",
     .tables = {.summary = 3, .truth = 3, .response = 3},
     .heading = "host clock error\nmedian",
     .band_heading = "host clock error\n5-95 %",
     .legend = "host clock error: mean |slave - master|."},
    {.id = "max_te_ms",
     .tables = {.time_errors = 1},
     .heading = "max |TE|",
     .legend = "TE: a host's clock minus the master's, over all slaves;"},
    {.id = "rms_te_ms",
     .tables = {.time_errors = 2},
     .heading = "RMS TE",
     .legend_continues = true},
    {.id = "constant_te_ms",
     .tables = {.time_errors = 3},
     .heading = "constant\nTE",
     .legend = "constant: largest mean of a host;",
     .legend_continues = true},
    {.id = "dynamic_te_ms",
     .tables = {.time_errors = 4},
     .heading = "dynamic\nTE",
     .legend = "dynamic: largest range of a host.",
     .legend_continues = true},
    {.id = "packets_per_s",
     .tables = {.time_errors = 5, .response = 7},
     .heading = "packets\nper s",
     .legend = "packets: messages that all hosts sent, the lost ones too, from the start of host "
               "synchronisation to the end of the capture."},
    {.id = "exposure_spread_ms",
     .tables = {.truth = 4},
     .heading = "exposure\nspread",
     .legend = "exposure spread: how far apart the exposures really were, a limit for AMD.",
     .legend_continues = true},
    {.id = "precision",
     .tables = {.summary = 4, .truth = 5, .sets = 2, .response = 4},
     .heading = "sets:\nprecision",
     .legend = "precision: gathered sets that hold one pulse only;"},
    {.id = "recall",
     .tables = {.summary = 5, .truth = 6, .sets = 3, .response = 5, .response_panel = 3},
     .heading = "sets:\nrecall",
     .legend = "recall: complete pulses found whole;",
     .legend_continues = true},
    {.id = "margin_ms",
     .tables = {.truth = 7, .response = 6, .response_panel = 4},
     .heading = "margin",
     .legend = "margin: limit less 99.9 % quantile of the range.",
     .legend_continues = true},
    {.id = "sets", .tables = {.sets = 1}, .heading = "complete\nsets"},
    {.id = "partial_sets", .tables = {.sets = 5}, .heading = "partial\nsets"},
    {.id = "index_errors",
     .tables = {.sets = 4},
     .heading = "index\nerrors",
     .legend = "index errors: members of complete sets of another pulse than most members."},
    {.id = "discarded_frames", .tables = {.sets = 6}, .heading = "frames\ndiscarded"},
    {.id = "set_amd_ms", .tables = {.sets = 7}, .heading = "AMD of\nsets"},
    {.id = "set_absolute_error_ms", .tables = {.sets = 8}, .heading = "abs. error\nof sets"},
    {.id = "emission_latency_ms",
     .tables = {.sets = 9},
     .heading = "emitted after\nmean",
     .legend = "emitted after: since the last member's arrival. AMD of sets is small where "
               "gathering gave sets up: see recall.",
     .legend_continues = true},
    {.id = "emission_latency_max_ms", .tables = {.sets = 10}, .heading = "emitted after\nlargest"},
    {.id = "frames_dropped", .tables = {.truth = 8}, .heading = "frames\ndropped"},
    {.id = "evaluated_pulses", .tables = {.truth = 9}, .heading = "pulses\nscored"},
    {.id = "exposure_spread_median_ms",
     .tables = {.alignment = 1},
     .heading = "exposure spread\nmedian",
     .legend = "exposure spread: range of the true mid-exposures of all cameras that "
               "belong together, its median and 95 % quantile over the evaluated pulses."},
    {.id = "exposure_spread_p95_ms", .tables = {.alignment = 2}, .heading = "exposure spread\np95"},
    {.id = "aligned_1_ms_s",
     .tables = {.alignment = 3},
     .heading = "aligned\nto 1 ms",
     .legend =
         "aligned: when, since the capture's start, the median spread of a second is below for "
         "good;"},
    {.id = "aligned_0_1_ms_s", .tables = {.alignment = 4}, .heading = "aligned\nto 0.1 ms"},
    {.id = "aligned_0_01_ms_s", .tables = {.alignment = 5}, .heading = "aligned\nto 0.01 ms"},
    {.id = "disturbed_frames",
     .tables = {.alignment = 6},
     .heading = "frames\ndisturbed",
     .legend =
         "disturbed: frames a camera of the whole capture, but for the cameras' unsteady start, "
         "whose length or exposure differs by more than 1 % from the camera's median (1 % of a "
         "frame is what nobody sees).",
     .legend_continues = true},
    {.id = "exposure_drift_ppm",
     .tables = {.alignment = 7},
     .heading = "drift",
     .legend = "drift: how fast the exposures of the worst camera part from the reference camera's "
               "between corrections;"},
    {.id = "wrong_locks",
     .tables = {.alignment = 8},
     .heading = "wrong\nlocks",
     .legend = "wrong locks: cameras reported as aligned that expose more than a tenth of a period "
               "beside the reference camera.",
     .legend_continues = true},
    {.id = "colour_offset_ms",
     .tables = {.colour = 1},
     .heading = "colour offset\nmedian",
     .band_heading = "colour offset\n5-95 %",
     .legend =
         "colour offset: mean |colour's true mid-exposure less depth's| of a camera at a pulse, "
         "of the nearest colour frame;"},
    {.id = "colour_offset_spread_ms",
     .tables = {.colour = 2},
     .heading = "its spread\nmedian",
     .band_heading = "its spread\n5-95 %",
     .legend = "its spread: mean range of the signed offsets over all cameras.",
     .legend_continues = true},
    {.id = "certified_ms",
     .tables = {.certificates = 1},
     .heading = "certified\nmedian",
     .band_heading = "certified\n5-95 %",
     .legend = "certified: no two frames of 95 % of the sets were exposed further apart, whatever "
               "the delays were, if what `simbench certify` assumes holds (docs/certificates.md); "
               "- where nothing bounds it."},
    {.id = "t_l_ms",
     .tables = {.sessions = 1},
     .heading = "t_l\nmedian",
     .band_heading = "t_l\n5-95 %",
     .legend =
         "t_l, t_t: network and time delay as the slaves measured them in the last pass of "
         "their sessions (t_t: half of a get and a set of the clock), means over the slaves;"},
    {.id = "t_t_ms",
     .tables = {.sessions = 2},
     .heading = "t_t\nmedian",
     .band_heading = "t_t\n5-95 %"},
    {.id = "t_d_ms",
     .tables = {.sessions = 3},
     .heading = "t_d\nmedian",
     .legend = "t_d: what they added of the two.",
     .legend_continues = true},
    {.id = "get_time_ms",
     .tables = {.sessions = 4},
     .heading = "get",
     .legend = "get, set: a call of the slave that reads, that sets its clock."},
    {.id = "set_time_ms", .tables = {.sessions = 5}, .heading = "set"},
    {.id = "message_time_ms",
     .tables = {.sessions = 6},
     .heading = "message",
     .legend = "message: sending and receiving one, half of what the last exchange's round trip "
               "took beside a get and a set.",
     .legend_continues = true},
    {.id = "session_passes",
     .tables = {.sessions = 7},
     .heading = "passes",
     .legend = "passes: of the loop of T_th.",
     .legend_continues = true},
};

constexpr MetricColumn kClockColumns[] = {
    {.id = "clock_spread_ms",
     .tables = {.clocks = 1, .response = 1, .response_panel = 1},
     .heading = "spread\nmean",
     .band_heading = "spread\n5-95 %",
     .legend = "spread: largest minus smallest clock of all hosts, its mean in time;"},
    {.id = "clock_spread_p95_ms", .tables = {.clocks = 2, .response = 2}, .heading = "spread\np95"},
    {.id = "max_te_ms",
     .tables = {.clocks = 3, .response = 3, .response_panel = 2},
     .heading = "max |TE|",
     .legend = "TE: a host's clock minus the master's, over all slaves;",
     .legend_continues = true},
    {.id = "rms_te_ms", .tables = {.clocks = 4, .response = 4}, .heading = "RMS TE"},
    {.id = "constant_te_ms",
     .tables = {.clocks = 5, .response = 5},
     .heading = "constant\nTE",
     .legend = "constant: largest mean of a host;",
     .legend_continues = true},
    {.id = "dynamic_te_ms",
     .tables = {.clocks = 6, .response = 6},
     .heading = "dynamic\nTE",
     .legend = "dynamic: largest range of a host.",
     .legend_continues = true},
    {.id = "below_1_ms_s",
     .tables = {.clocks = 7},
     .heading = "below\n1 ms",
     .legend = "below: when the spread is below for good."},
    {.id = "below_0_1_ms_s", .tables = {.clocks = 8}, .heading = "below\n0.1 ms"},
    {.id = "below_0_01_ms_s", .tables = {.clocks = 9}, .heading = "below\n0.01 ms"},
    {.id = "holdover_60_ms", .tables = {.clocks = 10}, .heading = "holdover\n60 s"},
    {.id = "holdover_600_ms",
     .tables = {.clocks = 11, .response = 7, .response_panel = 3},
     .heading = "holdover\n600 s",
     .legend = "holdover: largest |TE| so long after the master was lost;"},
    {.id = "recovery_s",
     .tables = {.clocks = 12},
     .heading = "recovery",
     .legend = "recovery: from its return until the spread stays within the largest before.",
     .legend_continues = true},
    {.id = "packets_per_s", .tables = {.clocks = 13, .response = 8}, .heading = "packets\nper s"},
};

std::vector<MetricColumn>& columns(ResultKind kind) {
  static std::vector<MetricColumn> captures(std::begin(kCaptureColumns), std::end(kCaptureColumns));
  static std::vector<MetricColumn> clocks(std::begin(kClockColumns), std::end(kClockColumns));
  return kind == ResultKind::kCaptures ? captures : clocks;
}

}  // namespace

MetricColumn column_of(const Metric& metric, ResultKind kind) {
  const std::vector<MetricColumn>& all = columns(kind);
  const auto found =
      std::ranges::find(all, std::string_view(metric.id),
                        [](const MetricColumn& each) { return std::string_view(each.id); });
  return found == all.end() ? MetricColumn{.id = metric.id, .heading = metric.title} : *found;
}

std::vector<const Metric*> table_metrics(int TablePlaces::*table, ResultKind kind) {
  std::vector<const Metric*> shown;
  for (const Metric& each : evaluation::metrics(kind)) {
    if (column_of(each, kind).tables.*table > 0) shown.push_back(&each);
  }
  std::ranges::stable_sort(
      shown, {}, [&](const Metric* each) { return column_of(*each, kind).tables.*table; });
  return shown;
}

ScopedMetricColumn::ScopedMetricColumn(const MetricColumn& column) {
  columns(ResultKind::kCaptures).push_back(column);
}
ScopedMetricColumn::~ScopedMetricColumn() { columns(ResultKind::kCaptures).pop_back(); }

}  // namespace simbench::reports
