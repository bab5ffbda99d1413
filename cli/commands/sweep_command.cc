#include <fmt/format.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/interrupt.h"
#include "app/results.h"
#include "app/sweep_workers.h"
#include "cli/command.h"
#include "cli/command_line.h"
#include "cli/commands/commands.h"
#include "cli/progress.h"
#include "evaluation/clock_run/clock_evaluation.h"
#include "evaluation/run/ad_hoc_pipelines.h"
#include "evaluation/sweep/sweep_plan.h"
#include "evaluation/sweep/task_farm.h"
#include "recording/collected.h"
#include "recording/counted.h"
#include "reports/sweep/sweep_folder.h"
#include "reports/sweep/sweep_report.h"
#include "scenarios/study.h"

namespace simbench::cli {
namespace {

using evaluation::SweepPlan;
using scenarios::Study;

constexpr const char* kSweepExamples = R"(
Examples:
  simbench sweep --scenario 18cam_6host_45fps --sweep /usb/delivery_jitter_transfers=0:1:0.1
                 --pipelines yoon2021_both,oracle -o results/jitter
  simbench sweep --scenario 3cam_1host_30fps --sweep /trigger/rate_hz=15,30
                 --sweep /cameras/sync_mode=slave,full_slave --seeds 16 -o results/modes
  simbench sweep --scenario 18cam_6host_45fps
                 --sweep /hosts/count=2:6:2+/cameras/count=6:18:6 -o results/hosts
  simbench sweep --study scalability -o results/scalability
  mpirun -n 64 simbench sweep --study seeds_needed --seeds 100000 -o results/seeds
  simbench sweep --clocks --scenario 6host_star --pipelines chrony,ntp --duration-s 7200
                 --sweep /network/latency_exponential_ms=0.02,0.06,0.2 -o results/clocks

A sweep that was interrupted, killed or ran out of disk space goes on when the same command is given
again: no finished run is lost or repeated, and the results are the same.

In the folder: sweep.csv has a line for each point, pipeline and seed, hosts.csv one for each host
of these, sweep.txt the answer and the tables, sweep.html the same as a page with its figures,
sweep.svg the plot (drawn by gnuplot), runs.log the finished runs.

Exit status: 0 ok, 1 internal error, 2 bad usage or input, 5 a program failed in every seed,
130 interrupted.)";

// Checking fewer takes no time to speak of.
constexpr std::size_t kManyPoints = 1000;

struct SweepOptions {
  std::string study;
  bool clocks = false;
  std::optional<std::uint64_t> duration_s;
  std::optional<std::uint64_t> from_s;
  evaluation::SweepRequest request;
  std::vector<std::string> sets;
  std::string rank_by;
  std::optional<std::uint64_t> seeds;
  unsigned jobs = 0;
  std::string output;
  bool restart = false;
};

// Adds the study's parts that the command line does not override.
void add_study(const Study& study, SweepOptions& options) {
  evaluation::SweepRequest& request = options.request;
  if (!request.axes.empty()) {
    throw scenarios::InputError("--sweep: a study has its own axes; leave out --study or --sweep");
  }
  if (request.scenario.empty()) request.scenario = study.scenario;
  if (request.pipelines.empty()) request.pipelines = study.pipelines;
  if (!options.seeds) options.seeds = study.seeds;
  request.axes = study.sweep;
  if (study.clocks) {
    options.clocks = true;
    if (!options.duration_s) options.duration_s = study.duration_s;
    if (!options.from_s) options.from_s = study.from_s;
  }
  options.sets.insert(options.sets.begin(), study.set.begin(), study.set.end());
}

const Study* study_of(SweepOptions& options) {
  if (options.study.empty()) {
    if (!options.request.scenario.empty() && !options.request.axes.empty()) return nullptr;
    throw scenarios::InputError(
        "sweep: found neither --study nor both --scenario and --sweep; `simbench sweep --study "
        "list` lists the studies");
  }
  const Study* study = scenarios::find_study(options.study);
  if (study == nullptr) {
    const std::vector<std::string> known = collected(scenarios::studies(), &Study::name);
    throw scenarios::InputError(fmt::format("--study: found '{}', allowed: list, {}", options.study,
                                            fmt::join(known, ", ")));
  }
  add_study(*study, options);
  return study;
}

// What the runs are: captures, or with --clocks clock runs.
void set_kind(const SweepOptions& options, const Study* study, evaluation::SweepRequest& request) {
  if (!options.clocks) {
    if (!options.duration_s && !options.from_s) return;
    throw scenarios::InputError(
        fmt::format("{}: found without --clocks; captures are as long as the scenario's /timeline",
                    options.duration_s ? "--duration-s" : "--from-s"));
  }
  if (study != nullptr && !study->clocks &&
      study->tables != std::vector{scenarios::StudyTable::kResponse}) {
    throw scenarios::InputError(
        fmt::format("--clocks: the study {} shows what only captures have; leave out --clocks, or "
                    "name --scenario and --sweep in place of --study",
                    study->name));
  }
  const evaluation::ClockOptions defaults;
  request.kind = evaluation::ResultKind::kClockRuns;
  request.clock_period = {.from_s = options.from_s.value_or(defaults.from_s),
                          .duration_s = options.duration_s.value_or(defaults.duration_s)};
}

// Runs what the log lacks. False if it was interrupted.
bool finish_runs(const SweepPlan& plan, reports::SweepLog& log, const std::string& folder,
                 unsigned jobs, evaluation::TaskFarm& farm) {
  std::vector<std::size_t> missing;
  for (std::size_t run = 0; run < plan.runs(); ++run) {
    if (log.text(run).empty()) missing.push_back(run);
  }
  if (log.damaged() > 0) {
    print_warnings(
        {counted(log.damaged(), "damaged record") + " in runs.log; their runs are done again"});
  }
  if (log.finished() > 0) {
    print_note(
        fmt::format("{} of {} finished already", log.finished(), counted(plan.runs(), "run")));
  }
  if (missing.empty()) return true;
  const auto work = [&](const evaluation::Progress& progress) {
    const evaluation::SweepTasks sweep_tasks(plan, missing);
    evaluation::Tasks tasks = sweep_tasks.tasks();
    tasks.threads = jobs;
    std::size_t finished = 0;
    farm.run(tasks, [&](std::size_t task, const std::string& answer) {
      sweep_tasks.each_run(task, answer, [&](std::size_t run, const std::string& text) {
        log.append(run, text);
        progress(++finished, missing.size());
      });
    });
    return std::optional(true);
  };
  return watched<bool>(work, {.kept = "the finished runs are kept in " + folder +
                                      ", and the same command goes on from there"})
      .has_value();
}

int sweep(SweepOptions options, evaluation::TaskFarm* farm) {
  if (options.study == "list") {
    print_result(study_list());
    return kOk;
  }
  const Study* study = study_of(options);
  if (options.output.empty()) {
    throw scenarios::InputError("sweep: found no --output; name a folder for its results");
  }
  options.request.overrides = evaluation::with_ad_hoc_pipelines(
      options.request.scenario, overrides_of(options.sets), options.request.pipelines,
      options.clocks ? evaluation::AdHoc::kHostSyncToo : evaluation::AdHoc::kAllStages);
  if (options.seeds) options.request.seeds = *options.seeds;
  set_kind(options, study, options.request);
  options.request.ranked_by = evaluation::ranked_by_named(options.rank_by);
  if (options.request.ranked_by && options.request.kind == evaluation::ResultKind::kClockRuns) {
    throw scenarios::InputError(
        "--rank-by: allowed without --clocks, whose runs are ranked by the spread of the clocks");
  }
  const SweepPlan plan = evaluation::make_plan(options.request);
  if (plan.points() >= kManyPoints) {
    print_note("checking " + counted(plan.points(), "point"));
  }
  print_warnings(plan.left_out);
  print_warnings(evaluation::check_points(plan, options.request, options.jobs));

  reports::SweepFolder folder(options.output, reports::sweep_manifest(plan, options.study),
                              plan.runs(), options.restart);
  evaluation::ThreadFarm threads(app::simulated_sweep_workers());
  if (!finish_runs(plan, folder.log(), options.output, options.jobs,
                   farm != nullptr ? *farm : threads)) {
    return kInterrupted;
  }
  const std::vector<scenarios::StudyTable> tables =
      study != nullptr ? study->tables : std::vector{scenarios::StudyTable::kResponse};
  const app::SweepText text = app::write_sweep_results(plan, tables, folder);
  if (!text.not_drawn.empty()) print_warnings({text.not_drawn});
  print_result_in("table", [&text](const std::string& format) {
    return reports::drawn_as(format, text.document);
  });
  return text.has_failed ? kProgramFailed : kOk;
}

}  // namespace

void add_sweep_command(CommandLine& line) {
  auto options = std::make_shared<SweepOptions>();
  evaluation::SweepRequest& request = options->request;
  Command command(line, "sweep",
                  "Vary parameters of a scenario, and print how each pipeline responds");
  command.text("--scenario", "SCENARIO", request.scenario,
               "Name of a scenario (see `simbench list`) or path of a scenario file");
  command.texts("--sweep", "/POINTER=VALUES", request.axes,
                "What to vary, repeatable: every combination is a point. Values are\n"
                "start:stop:step (stop included) or value,value,...; parameters that vary\n"
                "together are joined: /hosts/count=2:6:2+/cameras/count=6:18:6");
  command.text("--study", "STUDY", options->study,
               "A ready-made sweep in place of --scenario and --sweep; `list` lists them");
  command.flag("--clocks", options->clocks,
               "The hosts' clocks alone, as `simbench clocks` runs them, in place of captures");
  command.whole_number("--duration-s", "S", options->duration_s, 1, evaluation::kLongestClockRunS,
                       "With --clocks: seconds from the cold start to the loss of the master.\n"
                       "Default: 36000");
  command.whole_number("--from-s", "S", options->from_s, 0, evaluation::kLongestClockRunS,
                       "With --clocks: the second from which spread, errors and stability count.\n"
                       "Default: 300");
  command.count("--seeds", options->seeds, "How many seeds at each point. Default: 32");
  command.seed("--first-seed", request.first_seed, "The first seed. Default: 1");
  command.pipelines(request.pipelines);
  command.sets(options->sets);
  command.rank_by(options->rank_by);
  command.python();
  command.jobs(options->jobs, "Threads. Default: one for every core; under MPI one for every rank");
  command.output("-o,--output", "DIR", options->output,
                 "The folder of the sweep. An unfinished sweep in it is continued");
  command.flag("--restart", options->restart, "Remove the sweep in the folder, and start anew");
  command.json_messages();
  command.footer(kSweepExamples);
  command.runs([options, farm = line.extras.farm] { return sweep(*options, farm); });
}

}  // namespace simbench::cli
