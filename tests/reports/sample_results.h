// Small hand-made results for the tests of reports/.
#pragma once

#include <limits>
#include <vector>

#include "evaluation/scoring/published_figures.h"
#include "evaluation/scoring/results.h"

namespace simbench::reports {

inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

inline evaluation::Series series(double first, double second) {
  return {.values = {first, second}, .median = (first + second) / 2, .p05 = first, .p95 = second};
}

inline evaluation::Series no_series() {
  return {.values = {kNaN, kNaN}, .median = kNaN, .p05 = kNaN, .p95 = kNaN};
}

inline evaluation::SeedScore seed_score(std::uint64_t seed) {
  evaluation::SeedScore score;
  score.seed = seed;
  score.pulses = {{.pulse = 225, .spread_ms = 1.5, .deviation_ms = 0.25},
                  {.pulse = 226, .spread_ms = 2, .deviation_ms = 0.5}};
  score.host_errors_ms = {0, -0.125};
  if (seed == 2) score.failures = {{.slave = 1, .synchronised = false, .message = "timeout"}};
  return score;
}

// Makes it the row of a capture whose exposures nobody steers.
inline void set_unsteered(evaluation::Row& row) {
  row.exposure_spread_median_ms = row.exposure_spread_p95_ms = no_series();
  row.aligned_1_ms_s = row.aligned_0_1_ms_s = row.aligned_0_01_ms_s = no_series();
  row.disturbed_frames = row.exposure_drift_ppm = row.wrong_locks = no_series();
}

// Makes it the row of a rig of depth alone.
inline void set_without_colour(evaluation::Row& row) {
  row.colour_offset_ms = row.colour_offset_spread_ms = no_series();
}

// Makes it the row of captures that were not certified.
inline void set_uncertified(evaluation::Row& row) { row.certified_ms = no_series(); }

// Makes it the row of a host synchronisation without sessions that have delays.
inline void set_without_sessions(evaluation::Row& row) {
  row.t_l_ms = row.t_t_ms = row.t_d_ms = row.session_passes = no_series();
  row.get_time_ms = row.set_time_ms = row.message_time_ms = no_series();
}

// What a row of Algorithms 1 and 2 has beside the others.
inline void set_sessions(evaluation::Row& row) {
  row.t_l_ms = series(3, 4);
  row.t_t_ms = series(2, 2.5);
  row.t_d_ms = series(5, 6.5);
  row.session_passes = series(1, 2);
  row.get_time_ms = series(0.001, 0.001);
  row.set_time_ms = series(4, 5);
  row.message_time_ms = series(3.5, 4.5);
  for (evaluation::SeedScore& seed : row.seeds) {
    seed.sessions = {{.slave = 1,
                      .pass = 2,
                      .t_l = from_ms(3.5),
                      .t_t = from_ms(2.25),
                      .t_d = from_ms(5.75),
                      .get = from_ms(0.001),
                      .set = from_ms(4.499)}};
  }
}

// What a row of steered exposures has beside the others.
inline void set_steered(evaluation::Row& row) {
  row.capture_alignment = "nudge";
  row.exposure_spread_median_ms = series(0.25, 0.75);
  row.exposure_spread_p95_ms = series(1, 3);
  row.aligned_1_ms_s = series(2, 4);
  row.aligned_0_1_ms_s = series(6, 10);
  row.aligned_0_01_ms_s = no_series();
  row.disturbed_frames = series(10, 15);
  row.exposure_drift_ppm = series(4, 6);
  row.wrong_locks = series(0, 1);
}

// A pipeline with a published value and everything there is.
inline evaluation::Row full_row() {
  evaluation::Row both;
  both.pipeline = "yoon2021_both";
  both.host_sync = "yoon2021_both";
  both.device_time = "regression_30";
  both.gathering = "yoon2021";
  both.amd_ms = series(1.5, 2.5);
  both.rmdv_ms = series(0.5, 1);
  both.rmdv_printed_sqrt_ms = series(0.25, 0.75);
  both.rmdv_printed_share = series(0, 0.5);
  both.absolute_error_ms = series(28, 30);
  both.bias_ms = series(-28, -30);
  both.host_error_ms = series(0.25, 0.75);
  both.max_te_ms = series(1, 2);
  both.rms_te_ms = series(0.5, 0.75);
  both.constant_te_ms = series(0.25, 0.5);
  both.dynamic_te_ms = series(1.5, 2.5);
  both.packets_per_s = series(20, 40);
  both.exposure_spread_ms = series(0, 0.125);
  both.precision = 1;
  both.recall = 0.75;
  both.margin_ms = 8.5;
  both.sets = {.emitted = 720,
               .pure = 720,
               .complete_pulses = 960,
               .discarded_frames = 21,
               .partial = 4,
               .index_errors = 0};
  both.seed_precision = series(1, 1);
  both.seed_recall = series(0.5, 1);
  both.set_amd_ms = series(1.25, 2.25);
  both.set_absolute_error_ms = series(27, 29);
  both.emission_latency_ms = series(0, 0.5);
  both.emission_latency_max_ms = 6;
  both.frames = {.expected = 34560, .delivered = 34557, .dropped = 3};
  both.evaluated_pulses = 960;
  both.unsynchronised_hosts = 1;
  both.published = evaluation::PublishedComparison{.amd_ms = 2.438,
                                                   .rmdv_ms = 1.8044,
                                                   .rmdv_attainable = false,
                                                   .amd_percentile = {50, 32.25, 67.75},
                                                   .rmdv_percentile = {100, 95.25, 100}};
  set_unsteered(both);
  set_uncertified(both);
  set_without_colour(both);
  set_without_sessions(both);
  both.seeds = {seed_score(1), seed_score(2)};
  return both;
}

// A pipeline that is not synchronised and gathers nothing.
inline evaluation::Row bare_row() {
  evaluation::Row none;
  none.pipeline = "free_running";
  none.host_sync = "free_running";
  none.device_time = "raw_arrival";
  none.gathering = "yoon2021";
  none.amd_ms = series(500, 1500000);
  none.rmdv_ms = series(200, 300);
  none.rmdv_printed_sqrt_ms = none.rmdv_printed_share = no_series();
  none.absolute_error_ms = no_series();
  none.bias_ms = no_series();
  none.host_error_ms = no_series();
  none.max_te_ms = none.rms_te_ms = no_series();
  none.constant_te_ms = none.dynamic_te_ms = none.packets_per_s = no_series();
  none.exposure_spread_ms = no_series();
  none.precision = kNaN;
  none.recall = 0;
  none.margin_ms = kNaN;
  none.seed_precision = no_series();
  none.seed_recall = series(0, 0);
  none.set_amd_ms = no_series();
  none.set_absolute_error_ms = no_series();
  none.emission_latency_ms = no_series();
  set_unsteered(none);
  set_uncertified(none);
  set_without_colour(none);
  set_without_sessions(none);
  return none;
}

// Both over two seeds.
inline evaluation::Results sample_results() {
  evaluation::Results results;
  results.scenario = "sample";
  results.first_seed = 1;
  results.seed_count = 2;
  results.rows = {full_row(), bare_row()};
  results.claims = {
      {.id = "C1", .text = "none is worst", .holds_fraction = 0.5, .needs = "", .decided_seeds = 2},
      {.id = "C4",
       .text = "lower at 45 than at 15 FPS",
       .holds_fraction = std::nullopt,
       .needs = "18cam_6host_15fps",
       .decided_seeds = 0}};
  results.warnings = {"a host was not synchronised"};
  results.performance = {.events = 1234567,
                         .simulated_seconds = 64,
                         .cpu_seconds = 0.5,
                         .wall_seconds = 0.25,
                         .events_per_second = 4938268,
                         .simulated_seconds_per_second = 256};
  return results;
}

// Bounds and a value of yoon2021_both: of its two seeds one keeps the first and none the second.
inline evaluation::Results sample_figure_results() {
  evaluation::Results results = sample_results();
  const scenarios::PublishedFigure at_most{.pipeline = "yoon2021_both",
                                           .metric = "amd_ms",
                                           .at_most = 2.44,
                                           .conditions = "a rig in a hall",
                                           .source = "a paper"};
  scenarios::PublishedFigure at_least = at_most;
  at_least.at_most.reset();
  at_least.at_least = 3;
  scenarios::PublishedFigure value = at_most;
  value.at_most.reset();
  value.metric = "seed_recall";
  value.value = 0.75;
  results.published_figures =
      evaluation::compare_figures(std::vector{at_most, at_least, value}, results.rows);
  return results;
}

// A slave capture and, of the other pipeline, none that could be made.
inline evaluation::Results sample_rig_results() {
  evaluation::Results results = sample_results();
  results.performance.simulated_seconds = 0;
  evaluation::Row& both = results.rows[0];
  both.ground_truth = evaluation::GroundTruth::kNone;
  both.absolute_error_ms = both.bias_ms = both.host_error_ms = no_series();
  both.precision = both.recall = both.margin_ms = kNaN;
  both.published.reset();
  both.evaluated_pulses = both.sets.emitted;
  both.sets.pure = both.sets.complete_pulses = 0;
  both.notes = {"repetition 2: camera 7 was unplugged"};
  evaluation::Row& none = results.rows[1];
  none.ground_truth = evaluation::GroundTruth::kNone;
  none.amd_ms = none.rmdv_ms = no_series();
  none.frames = {};
  none.notes = {"repetition 1: host2 could not be reached", "repetition 2: host2 is \"lost\", too"};
  return results;
}

inline evaluation::Results sample_genlock_results() {
  evaluation::Results results = sample_results();
  for (evaluation::Row& row : results.rows)
    row.ground_truth = evaluation::GroundTruth::kGenlockOrder;
  return results;
}

}  // namespace simbench::reports
