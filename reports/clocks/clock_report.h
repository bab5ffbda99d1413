// Runs of the hosts' clocks for people and programs: the output of `simbench clocks`.
//
// JSON, schema_version 1; members are only ever added; null: the value does not exist.
//
//   {"schema_version": 1, "kind": "clocks", "version", "commit", "scenario",
//    "based_on", "changed", "published_left_out" (reports/results/json.h),
//    "seeds": {"first", "count"}, "duration_s", "from_s", "interval_s": of the readings,
//    "period_note": where somebody chose the duration or left out the loss of the master,
//    "rows": [{"pipeline", "host_sync", "device_time", "gathering",
//              "clock_spread_ms": {"mean", "median", "p95", "max": in time, of that the mean over
//              the
//                seeds and of "max" the largest; "values": the mean in time of each seed},
//              "adev", "mdev", "hdev": [{"tau_s", "value", "terms"}], RMS over slaves and seeds,
//              "tdev_ms" likewise, "mtie_ms": the largest of any slave and seed,
//              "unsynchronised_hosts": over all seeds,
//              "standing", "failed": as of a run, of rows that failed and of those of real programs
//                alone, which also have "program_failures" (reports/results/json.h),
//              "max_te_ms": the largest of all seeds, "rms_te_ms": over all,
//              "constant_te_ms", "dynamic_te_ms": the largest of all seeds,
//              "below_ms": {"1", "0.1", "0.01"}: seconds until the spread stays below, the median
//                over the seeds; null if half of them never do,
//              "holdover_ms": {"60", "600"}, "recovery_s", "packets_per_s": median over the seeds,
//              "hosts": [{"host", "median_te_ms": signed, "median_abs_te_ms", "p95_abs_te_ms",
//                "sd_te_ms": standard deviation}],
//                quantiles in time of each host's error against true time, medians over the seeds,
//              "pairs": [likewise, of each slave against the master],
//              "metrics": {each metric of a clock run by its id: {"median", "p05", "p95",
//                "values": [in seed order]}}}],
//    "warnings", "load_reality" (reports/results/json.h), "answer"
//    (reports/results/answer_fields.h), "performance"}
//
// What it means: evaluation/clock_run/clock_score.h, evaluation/stability/stability.h.
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "evaluation/answer/answer.h"
#include "evaluation/clock_run/clock_evaluation.h"
#include "reports/archive/archive.h"
#include "reports/figures/figure.h"
#include "reports/text/answer_text.h"
#include "reports/text/block.h"
#include "reports/text/output_file.h"
#include "scenarios/scenario.h"

namespace simbench::reports {

// What an archive holds: without the readings.
evaluation::ClockResults clock_results_of(const Archive& archive);

// Which host_sync keeps the hosts' clocks closest together and by how much, from when on they are
// in sync, what causes the rest (or, where nobody asked, whether it is constant or moves), what
// happens without the master, what it costs in
// packets, and what is uncertain. Ranked by the mean spread in time (evaluation/answer/answer.h).
// `results`: of ResultKind::kClockRuns.
AnswerText clock_answer(const evaluation::ClockResults& results);
AnswerText clock_answer(const evaluation::Results& results);
AnswerText clock_answer(const evaluation::Results& results, const evaluation::Answer& answer,
                        const evaluation::ClockCauses& causes);

// Its head begins with the answer.
Document clock_document(const evaluation::ClockResults& results, const std::string& summary);

// Its answer has "causes": [{"what", "sets", "spread_from_ms", "spread_to_ms", "largest_from_ms",
// "largest_to_ms"}], null if nobody asked.
std::string clock_json(const evaluation::ClockResults& results);

// pipeline,measure,tau_s,value: the metrics without a tau (medians over the seeds), then the
// curves; of a row that failed also the measures `standing` and `failed`, whose values are words.
std::string clock_csv(const evaluation::ClockResults& results);

// pipeline,seed,time_s,host,te_s: the time errors of the first seed's slaves.
void write_series_csv(const evaluation::ClockResults& results, std::ostream& out);

// ADEV, TDEV and MTIE of all pipelines over tau, with masks of ITU-T as lines for reference.
Figure clock_figure(const evaluation::ClockResults& results);

// manifest.json, results.json, curves.csv (clock_csv) and series.csv, which read_archive() reads
// for comparisons and gates. Publishes.
std::vector<std::string> clock_archive_files();  // besides those of any archive
void write_clock_archive(OutputFolder& output, const evaluation::ClockResults& results,
                         const scenarios::Scenario& scenario, const Provenance& provenance);

}  // namespace simbench::reports
