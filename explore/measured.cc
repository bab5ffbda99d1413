#include "explore/measured.h"

#include <fmt/format.h>

#include <utility>

#include "app/fit_task.h"
#include "app/interrupt.h"
#include "app/recorded_streams.h"
#include "app/recordings.h"
#include "evaluation/diagnosis/diagnose.h"
#include "evaluation/fit/fit_check.h"
#include "recording/collected.h"
#include "reports/page/html_page.h"
#include "reports/page/overview.h"
#include "reports/recordings/diagnose_answer.h"
#include "reports/recordings/diagnose_figure.h"
#include "reports/recordings/diagnose_report.h"
#include "reports/recordings/fit_report.h"
#include "reports/results/results_document.h"
#include "reports/text/answer_json.h"

namespace simbench::explore {
namespace {

using reports::Json;

// Simulated beside a recording, at most: minutes of it say no more, and the page would wait.
constexpr std::int64_t kMostBeside = 2000;

Json panel_of(const std::vector<std::string>& inputs, const evaluation::FitStudy& study,
              const bags::FileOptions& options) {
  const RecordedStreams recorded = app::recorded_streams(inputs, options);
  const evaluation::Diagnosis diagnosis = evaluation::diagnose(recorded.streams, {});
  const app::RecordedRun run = app::recorded_run(inputs, options, {});
  const evaluation::Results results = run.evaluate(run.chosen({}), {}, nullptr);
  return {{"inputs", inputs},
          {"answer", reports::answer_json(reports::diagnose_answer(diagnosis))},
          {"trust", study.trust.text},
          {"overview", reports::overview_html(results)},
          {"tables", reports::html(reports::diagnose_document(diagnosis).blocks) +
                         reports::html(reports::results_document(results, "").blocks)},
          {"data", Json::parse(reports::figures_json({reports::diagnose_figure(diagnosis)}))}};
}

}  // namespace

Measured measured(const std::vector<std::string>& inputs, const std::string& model,
                  const bags::FileOptions& options, const ReadProgress& progress) {
  const app::FitTask task = app::fit_task(inputs, {}, options, progress);
  const evaluation::FitStudy study =
      evaluation::study_fit(task.input, task.base, model, app::simulated_world);
  return {.inputs = inputs,
          .cameras = collected(task.input.cameras, &evaluation::FitCamera::name),
          .fit = evaluation::fit_rig(task.input),
          .model = study.model.text,
          .panel = panel_of(inputs, study, options)};
}

Json beside_json(const Measured& rig, const scenarios::Scenario& world) {
  if (static_cast<std::size_t>(world.cameras.count) != rig.cameras.size()) {
    return {{"text", fmt::format("The recording is of {} cameras, this world of {}.",
                                 rig.cameras.size(), world.cameras.count)}};
  }
  const evaluation::FitCheck check = evaluation::check_fit(rig.fit, rig.fit, world, rig.cameras,
                                                           app::simulated_world, kMostBeside);
  return {{"table", reports::html(reports::fit_check_block("Measured beside simulated", check,
                                                           rig.cameras))}};
}

}  // namespace simbench::explore
