// Runs, archives and comparisons for the package.

#include "app/results.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "app/answer.h"
#include "app/interrupt.h"
#include "app/results_text.h"
#include "evaluation/run/ad_hoc_pipelines.h"
#include "evaluation/run/evaluate.h"
#include "evaluation/run/run_detail.h"
#include "python/src/binding.h"
#include "python/src/bindings.h"
#include "python/src/rows.h"
#include "python/src/run.h"
#include "python/src/work.h"
#include "reports/clocks/clock_report.h"
#include "reports/comparison/comparison.h"
#include "reports/page/compare_page.h"
#include "reports/page/overview.h"
#include "reports/results/csv.h"
#include "reports/results/json.h"
#include "reports/results/results_answer.h"
#include "reports/results/summary_document.h"
#include "scenarios/loader.h"

namespace simbench::python {
namespace {

using evaluation::Progress;
using evaluation::Results;
using scenarios::InputError;
using scenarios::Scenario;

std::shared_ptr<Run> simulate(const RunRequest& request, const Object& on_progress) {
  auto run = std::make_shared<Run>();
  run->provenance.emplace();
  run->provenance->command = request.command;
  run->provenance->started = std::chrono::system_clock::now();
  run->scenario = load_scenario(request);
  const Scenario& scenario = *run->scenario;
  evaluation::check_pipelines(scenario);
  std::optional<evaluation::Assumptions> certify;
  if (request.certify) certify = evaluation::assumptions_of(scenario);
  run->archive.results = watched<Results>(on_progress, [&](const Progress& progress) {
    return evaluation::evaluate(
        scenario, [&] { return app::simulated_world(scenario); },
        {.first_seed = request.first_seed,
         .seeds = request.seeds,
         .jobs = request.jobs,
         .pipelines = request.pipelines,
         .keep_pulses = request.keep_pulses,
         .share_captures = true,
         .certify = certify},
        progress);
  });
  run->provenance->finished = std::chrono::system_clock::now();
  app::rank_by(request.rank_by, run->archive.results);
  run->no_levers = request.no_levers;
  run->archive.path = scenario.name;
  run->archive.scenario_json = scenario.resolved_json();
  run->notes = scenarios::warnings(scenario);
  const std::vector<std::string>& more = run->results().warnings;
  run->notes.insert(run->notes.end(), more.begin(), more.end());
  if (!request.keep_pulses) run->provenance.reset();
  return run;
}

std::shared_ptr<Run> load_archive(const std::string& path) {
  auto run = std::make_shared<Run>();
  run->archive = reports::read_archive(path);
  if (!run->archive.scenario_json.empty() && !reports::is_of_files(run->archive)) {
    run->scenario =
        scenarios::load_scenario_text(run->archive.scenario_json, path + "/manifest.json");
  }
  run->notes = run->results().warnings;
  return run;
}

std::shared_ptr<Run> score_recording(const RecordingToScore& wanted, const Object& on_progress) {
  if (wanted.certify) app::check_evidence(wanted.inputs);
  auto run = std::make_shared<Run>();
  run->provenance.emplace();
  run->provenance->command = wanted.command;
  run->provenance->started = std::chrono::system_clock::now();
  const bags::FileOptions options =
      cli::file_options({.topics = wanted.topics, .columns = wanted.columns});
  const app::StreamScoring scoring{wanted.pipelines, wanted.stream, wanted.genlock};
  run->recorded =
      watched<std::shared_ptr<app::RecordedRun>>(on_progress, [&](const Progress& progress) {
        return std::make_shared<app::RecordedRun>(
            app::recorded_run(wanted.inputs, options, scoring, cli::read_progress(progress)));
      });
  const app::RecordedRun& recorded = *run->recorded;
  run->scenario = recorded.scenario();
  run->notes = recorded.missing();
  const std::vector<std::string> chosen = recorded.chosen(wanted.pipelines);
  run->archive.results = watched<Results>(on_progress, [&](const Progress& progress) {
    return recorded.evaluate(chosen, {.keep_pulses = true, .certify = wanted.certify}, progress);
  });
  app::rank_by(wanted.rank_by, run->archive.results);
  run->provenance->finished = std::chrono::system_clock::now();
  run->archive.path = recorded.path();
  run->archive.scenario_json = recorded.scenario().resolved_json();
  for (const auto& more : {run->results().warnings, app::capture_notes(run->results())}) {
    run->notes.insert(run->notes.end(), more.begin(), more.end());
  }
  return run;
}

// As the commands have it: a recorded run's has no levers, which need other worlds.
const reports::ResultsAnswer& known_answer(Run& run, const Object& on_progress) {
  if (!run.answer && (run.recorded || !run.scenario)) {
    run.answer = reports::results_answer(run.results());
  }
  if (!run.answer) {
    run.answer = watched<reports::ResultsAnswer>(on_progress, [&](const Progress& progress) {
      return app::run_answer(run.results(), *run.scenario, {.levers = !run.no_levers}, progress);
    });
  }
  return *run.answer;
}

// The text of `simbench run`, as long as `detail` says: "answer", "screen" or "all".
std::string run_text(Run& run, const std::string& format, const std::string& detail,
                     const Object& on_progress) {
  const reports::ResultsAnswer& answer = known_answer(run, on_progress);
  const app::Detail shown = detail == "answer" ? app::Detail::kAnswer
                            : detail == "all"  ? app::Detail::kAll
                                               : app::Detail::kScreen;
  static const Scenario kUnknown;
  return app::results_text(run.results(), run.scenario ? *run.scenario : kUnknown, format, shown,
                           answer);
}

std::string html_of(Run& run, const Object& on_progress) {
  const scenarios::TableKind table =
      run.scenario ? run.scenario->evaluation.table : scenarios::TableKind::kPipelines;
  return reports::html(known_answer(run, on_progress).text) +
         reports::html(reports::summary_blocks(run.results(), table));
}

std::vector<Object> overview_of(const Run& run) {
  std::vector<Object> rows;
  for (const auto& row : reports::overview_rows(run.results())) {
    rows.push_back(dict({{"pipeline", row.row->pipeline},
                         {"word", row.word},
                         {"median_ms", row.series->median},
                         {"p05_ms", row.series->p05},
                         {"p95_ms", row.series->p95},
                         {"published_ms", row.published_ms}}));
  }
  return rows;
}

std::string ranked_name(const Run& run) {
  return evaluation::ranked_metric(evaluation::ranking_of(run.results())).title;
}

void save(const Run& run, const std::string& folder) {
  if (!run.provenance) {
    throw reports::OutputError(
        fmt::format("{}: found results without their pulses, allowed: those of simbench.run(..., "
                    "keep_pulses=True)",
                    folder));
  }
  reports::OutputFolder output(folder, reports::clock_archive_files());
  reports::write_archive(output, run.results(), *run.scenario, *run.provenance);
}

// Where the frames of a run come from: the recording, or the run repeated.
std::unique_ptr<RecordingSource> source_of(const Run& run,
                                           const std::vector<evaluation::PipelineChoice>& choices) {
  if (run.recorded) return run.recorded->source(choices);
  return app::simulated_world(*run.scenario);
}

void check_frames(const Run& run, const std::string& pipeline, std::uint64_t seed) {
  const Results& results = run.results();
  if (!run.scenario) {
    throw InputError(fmt::format(
        "{}: found no manifest, which names the scenario; allowed: the folder of an archive",
        run.archive.path));
  }
  const evaluation::Row* const row = evaluation::find_row(results.rows, pipeline);
  if (row == nullptr) {
    std::vector<std::string> names;
    for (const auto& each : results.rows) names.push_back(each.pipeline);
    throw InputError(fmt::format("{}: found no pipeline '{}', allowed: {}", run.archive.path,
                                 pipeline, fmt::join(names, ", ")));
  }
  if (seed < results.first_seed || seed - results.first_seed >= results.seed_count) {
    throw InputError(fmt::format("{}: found no seed {}, allowed: {} to {}", run.archive.path, seed,
                                 results.first_seed, results.first_seed + results.seed_count - 1));
  }
  if (!run.recorded && row->ground_truth != evaluation::GroundTruth::kSimulation) {
    throw InputError(
        fmt::format("{}: found captures of a rig, allowed: a simulated run, which can "
                    "be repeated, or the rig's recording folder",
                    run.archive.path));
  }
}

// A repeated run is the one that was scored, unless another version of simbench scored it.
void check_same(const Run& run, const evaluation::RunDetail& detail) {
  const evaluation::Row& row = *evaluation::find_row(run.results().rows, detail.pipeline);
  const double was = row.amd_ms.values.at(detail.seed - run.results().first_seed);
  const double is = detail.score.amd_ms;
  constexpr double kSame = 1e-9;
  if (std::isnan(was) && std::isnan(is)) return;
  if (std::abs(was - is) <= kSame * std::max(std::abs(was), std::abs(is))) return;
  throw InputError(fmt::format(
      "{}, {}, seed {}: its AMD is {} ms, but this version of simbench finds {} ms (it is of "
      "version {}, commit {})",
      run.archive.path, detail.pipeline, detail.seed, was, is, run.archive.version,
      run.archive.commit));
}

// Every frame of a run as a row: stamps, truth, errors.
struct FrameRow {
  std::int64_t pulse = -1;
  std::uint32_t camera = 0;
  std::uint32_t host = 0;
  std::uint32_t counter = 0;
  bool evaluated = false;
  bool in_warm_up = false;
  double sensor_ms = 0;
  double frame_ms = 0;
  double backend_ms = 0;
  double arrival_ms = 0;
  double global_ms = 0;
  double reference_ms = 0;
  double error_ms = 0;
  double exposure_start_ms = 0;
  double exposure_end_ms = 0;
};

std::vector<RowField> frame_fields() {
  return {{"camera", "<u4", offsetof(FrameRow, camera)},
          {"host", "<u4", offsetof(FrameRow, host)},
          {"counter", "<u4", offsetof(FrameRow, counter)},
          {"pulse", "<i8", offsetof(FrameRow, pulse)},
          {"evaluated", "?", offsetof(FrameRow, evaluated)},
          {"in_warm_up", "?", offsetof(FrameRow, in_warm_up)},
          {"sensor_ms", "<f8", offsetof(FrameRow, sensor_ms)},
          {"frame_ms", "<f8", offsetof(FrameRow, frame_ms)},
          {"backend_ms", "<f8", offsetof(FrameRow, backend_ms)},
          {"arrival_ms", "<f8", offsetof(FrameRow, arrival_ms)},
          {"global_ms", "<f8", offsetof(FrameRow, global_ms)},
          {"reference_ms", "<f8", offsetof(FrameRow, reference_ms)},
          {"error_ms", "<f8", offsetof(FrameRow, error_ms)},
          {"exposure_start_ms", "<f8", offsetof(FrameRow, exposure_start_ms)},
          {"exposure_end_ms", "<f8", offsetof(FrameRow, exposure_end_ms)}};
}

FrameRow row_of(const evaluation::FrameDetail& frame, std::uint32_t camera, std::uint32_t host) {
  return {.pulse = frame.pulse,
          .camera = camera,
          .host = host,
          .counter = frame.counter,
          .evaluated = frame.evaluated,
          .in_warm_up = frame.in_warm_up,
          .sensor_ms = frame.sensor_ms,
          .frame_ms = frame.frame_ms,
          .backend_ms = frame.backend_ms,
          .arrival_ms = frame.arrival_ms,
          .global_ms = frame.global_ms,
          .reference_ms = frame.reference_ms,
          .error_ms = frame.global_ms - frame.reference_ms,
          .exposure_start_ms = frame.exposure_start_ms,
          .exposure_end_ms = frame.exposure_end_ms};
}

// Takes the frames of the detail, camera by camera: at no time is all of it there twice.
Rows frame_rows(evaluation::RunDetail detail) {
  std::size_t count = 0;
  for (const auto& camera : detail.cameras) count += camera.frames.size();
  std::vector<FrameRow> rows;
  rows.reserve(count);
  for (std::uint32_t camera = 0; camera < detail.cameras.size(); ++camera) {
    const std::vector<evaluation::FrameDetail> frames =
        std::exchange(detail.cameras[camera].frames, {});
    for (const auto& frame : frames) {
      rows.push_back(row_of(frame, camera, detail.cameras[camera].host));
    }
  }
  return Rows(std::move(rows), frame_fields());
}

// With the number of the rig's cameras, of which the first are there.
Object frames(const Run& run, const std::string& pipeline, std::uint64_t seed,
              const Object& on_progress) {
  check_frames(run, pipeline, seed);
  evaluation::RunDetail detail = watched<evaluation::RunDetail>(on_progress, [&](const Progress&) {
    const auto choices = evaluation::choose_pipelines(*run.scenario, {pipeline});
    const auto source = source_of(run, choices);
    return evaluation::run_detail(*run.scenario, choices.front(), seed, *source);
  });
  check_same(run, detail);
  const std::size_t cameras = detail.camera_count;
  const std::size_t kept = detail.cameras.size();
  return python_tuple({made_instance(std::make_shared<Rows>(frame_rows(std::move(detail)))),
                       to_python(kept), to_python(cameras)});
}

using Compared = std::shared_ptr<reports::Comparison>;

Compared compare_runs(const Run& a, const Run& b, const reports::ComparisonOptions& options) {
  return std::make_shared<reports::Comparison>(
      reports::compare_archives(a.archive, b.archive, options));
}

Compared compare_baseline(const Run& run, const std::string& baseline,
                          const reports::ComparisonOptions& options) {
  return std::make_shared<reports::Comparison>(
      reports::compare_with_baseline(run.archive, baseline, options));
}

Compared compare_two(const Run& run, const std::string& a, const std::string& b,
                     const reports::ComparisonOptions& options) {
  return std::make_shared<reports::Comparison>(
      reports::compare_pipelines(run.archive, a, b, options));
}

void bind_run(const Object& module) {
  add_class<RunRequest>(
      module, "simbench._simbench.RunRequest",
      {.properties =
           {field<&RunRequest::scenario>("scenario"), field<&RunRequest::pipelines>("pipelines"),
            field<&RunRequest::sets>("sets"), field<&RunRequest::seeds>("seeds"),
            field<&RunRequest::first_seed>("first_seed"), field<&RunRequest::jobs>("jobs"),
            field<&RunRequest::keep_pulses>("keep_pulses"), field<&RunRequest::rank_by>("rank_by"),
            field<&RunRequest::no_levers>("no_levers"), field<&RunRequest::certify>("certify"),
            field<&RunRequest::command>("command")},
       .make = maker("RunRequest", [] { return RunRequest{}; })});
  add_class<RecordingToScore>(
      module, "simbench._simbench.RecordingToScore",
      {.properties = {field<&RecordingToScore::inputs>("inputs"),
                      field<&RecordingToScore::topics>("topics"),
                      field<&RecordingToScore::columns>("columns"),
                      field<&RecordingToScore::pipelines>("pipelines"),
                      field<&RecordingToScore::stream>("stream"),
                      field<&RecordingToScore::genlock>("genlock"),
                      field<&RecordingToScore::certify>("certify"),
                      field<&RecordingToScore::rank_by>("rank_by"),
                      field<&RecordingToScore::command>("command")},
       .make = maker("RecordingToScore", [] { return RecordingToScore{}; })});
  add_class<Run>(
      module, "simbench._simbench.Run",
      {.properties =
           {property("scenario", [](const Run& run) { return run.results().scenario; }),
            property("path", [](const Run& run) { return run.archive.path; }),
            property("first_seed", [](const Run& run) { return run.results().first_seed; }),
            property("seed_count", [](const Run& run) { return run.results().seed_count; }),
            property("is_clock_run",
                     [](const Run& run) {
                       return run.results().kind == evaluation::ResultKind::kClockRuns;
                     }),
            property("notes", [](const Run& run) { return run.notes; }),
            property("ranked_name", callable<&ranked_name>),
            property("scenario_json", [](const Run& run) { return run.archive.scenario_json; })},
       .methods = {
           method("csv", [](const Run& run) { return reports::csv(run.results()); }),
           method("tidy_csv", [](const Run& run) { return reports::tidy_csv(run.results()); }),
           method("json", [](const Run& run) { return reports::json(run.results()); }),
           method("text", callable<&run_text>), method("html", callable<&html_of>),
           method("overview", callable<&overview_of>), method("save", callable<&save>),
           method("frames", callable<&frames>)}});
  add_functions(module, {function("simulate", callable<&simulate>),
                         function("load_archive", callable<&load_archive>),
                         function("score_recording", callable<&score_recording>)});
}

void bind_comparison(const Object& module) {
  using reports::Comparison;
  using Options = reports::ComparisonOptions;
  add_class<Options>(module, "simbench._simbench.ComparisonOptions",
                     {.properties = {field<&Options::smallest_effect>("smallest_effect"),
                                     field<&Options::by_index>("by_index"),
                                     field<&Options::different_scenarios>("different_scenarios"),
                                     field<&Options::pipelines>("pipelines")},
                      .make = maker("ComparisonOptions", [] { return Options{}; })});
  add_class<Comparison>(
      module, "simbench._simbench.Comparison",
      {.methods = {
           method("csv", [](const Comparison& of) { return reports::comparison_csv(of); }),
           method("json", [](const Comparison& of) { return reports::comparison_json(of); }),
           method("text",
                  [](const Comparison& of) { return plain(reports::comparison_document(of)); }),
           method(
               "html",
               [](const Comparison& of) { return html(reports::comparison_document(of).blocks); }),
           method("page", callable<&reports::compare_html>)}});
  add_functions(module, {function("compare_runs", callable<&compare_runs>),
                         function("compare_baseline", callable<&compare_baseline>),
                         function("compare_two", callable<&compare_two>)});
}

}  // namespace

Scenario load_scenario(const RunRequest& request) {
  std::vector<scenarios::Override> overrides;
  for (const auto& [pointer, value] : request.sets) overrides.push_back({pointer, value});
  return scenarios::load_scenario(
      request.scenario,
      evaluation::with_ad_hoc_pipelines(request.scenario, std::move(overrides), request.pipelines,
                                        evaluation::AdHoc::kHostSyncToo));
}

void bind_results(const Object& module) {
  bind_run(module);
  bind_comparison(module);
}

}  // namespace simbench::python
