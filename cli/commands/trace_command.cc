#include <fmt/format.h>

#include <cerrno>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/interrupt.h"
#include "cli/command.h"
#include "cli/commands/commands.h"
#include "cli/program_options.h"
#include "cli/progress.h"
#include "evaluation/run/leaderboard.h"
#include "evaluation/run/pipeline_choice.h"
#include "recording/collected.h"
#include "recording/program_failure.h"
#include "reports/text/output_file.h"
#include "reports/timeline/trace.h"
#include "reports/timeline/trace_recorder.h"

namespace simbench::cli {
namespace {

// Hours of true time.
constexpr double kFarthestMs = 1e9;

constexpr const char* kTraceExamples = R"(
Open the file at ui.perfetto.dev ("Open trace file"; nothing is uploaded) or in chrome://tracing.
Everything is in true time, which the simulated hosts cannot read: a process for the trigger and for
each host, arrows from pulse to exposure to delivery to gathered set and along the messages between
hosts, each host's clock error as a counter.

Examples:
  simbench trace --scenario 18cam_6host_45fps --seed 3 -o trace.json
  simbench trace --scenario 6cam_2host_30fps --from-ms 0 --to-ms 2000 -o sync.json
  simbench trace --scenario 18cam_6host_45fps --pipeline ntp_w32time --format csv -o ntp.csv

Exit status: 0 ok, 1 internal error, 2 bad usage or input, 5 a program failed, 130 interrupted.)";

struct TraceCommandOptions {
  std::string scenario;
  std::string pipeline;
  std::uint64_t seed = 1;
  std::vector<std::string> sets;
  ProgramOptions programs;
  std::string format = "chrome";
  std::string output = "-";
  std::optional<double> from_ms;
  std::optional<double> to_ms;
  bool certify = false;
  std::uint64_t max_events = reports::TraceOptions{}.max_events;
};

reports::TraceOptions trace_options(const TraceCommandOptions& options) {
  reports::TraceOptions trace;
  if (options.from_ms) trace.from = TrueTime(from_ms(*options.from_ms));
  if (options.to_ms) trace.to = TrueTime(from_ms(*options.to_ms));
  if (trace.from >= trace.to) {
    throw scenarios::InputError(fmt::format("--to-ms: found {}, allowed: more than --from-ms, {}",
                                            *options.to_ms, *options.from_ms));
  }
  trace.max_events = options.max_events;
  return trace;
}

evaluation::PipelineChoice choose(const scenarios::Scenario& scenario, std::string name) {
  if (name.empty()) {
    const std::vector<std::string> names =
        collected(scenario.pipelines, &scenarios::Pipeline::name);
    name = evaluation::usual_pipeline(names);
  }
  return evaluation::choose_pipelines(scenario, {name}).front();
}

void write(const reports::Trace& trace, const std::string& format, std::ostream& out) {
  if (format == "csv") {
    reports::write_trace_csv(trace, out);
  } else {
    reports::write_chrome_trace(trace, out);
  }
  out.flush();
}

// The destination of the result; throws before the work if it cannot be written.
class Output {
 public:
  explicit Output(const std::string& name) : name_(name) {
    if (name == "-") return;
    file_.emplace(name);
    errno = 0;
    stream_.open(file_->path(), std::ios::binary);
    if (!stream_) fail();
  }

  void write(const reports::Trace& trace, const std::string& format) {
    std::ostream& out = file_ ? stream_ : result_stream();
    errno = 0;
    cli::write(trace, format, out);
    if (!out.flush()) fail();
    if (!file_) return;
    stream_.close();
    if (!stream_) fail();
    file_->publish();
  }

 private:
  [[noreturn]] void fail() const {
    throw reports::OutputError(fmt::format("--output {}: {}", name_, reports::system_reason()));
  }

  std::string name_;
  std::optional<reports::OutputFile> file_;
  std::ofstream stream_;
};

int run_trace(const TraceCommandOptions& options) {
  reports::TraceOptions wanted = trace_options(options);
  std::vector<std::string> pipelines;
  if (!options.pipeline.empty()) pipelines.push_back(options.pipeline);
  const scenarios::Scenario scenario =
      load_with_programs(options.scenario, options.sets, options.programs, pipelines);
  const bool is_of_program = options.pipeline.empty() && !options.programs.programs.empty();
  const evaluation::PipelineChoice choice =
      choose(scenario, is_of_program ? scenario.pipelines.back().name : options.pipeline);
  print_warnings(scenarios::warnings(scenario));
  if (options.certify) wanted.certify = evaluation::assumptions_of(scenario);
  Output output(options.output);
  const auto trace = watched<reports::Trace>([&](const evaluation::Progress&) {
    const auto source = app::simulated_world(scenario);
    return reports::record_trace(scenario, choice, options.seed, *source, wanted);
  });
  if (!trace) return kInterrupted;
  output.write(*trace, options.format);
  for (const std::string& note : reports::left_out_notes(*trace)) print_note(note);
  if (options.format == "csv") {
    for (const std::string& note : reports::trace_csv_notes(*trace)) print_note(note);
  }
  print_warnings(failure_lines(trace->program_failures));
  return trace->program_failures.empty() ? kOk : kProgramFailed;
}

void add_window_options(Command& command, TraceCommandOptions& options) {
  command.number("--from-ms", "MS", options.from_ms, -kFarthestMs, kFarthestMs,
                 "Only events that begin then or later, in true time: 0 is the start of host\n"
                 "synchronisation. Default: from the start of the simulation");
  command.number("--to-ms", "MS", options.to_ms, -kFarthestMs, kFarthestMs,
                 "Only events that begin before that. Default: to the end");
  command.whole_number(
      "--max-events", "N", options.max_events, 1, 10'000'000,
      "The most events in the file, apart from names; a note reports how many later\n"
      "ones are left out. Default: 200000");
}

}  // namespace

void add_trace_command(CommandLine& line) {
  auto options = std::make_shared<TraceCommandOptions>();
  Command command(line, "trace", "Write one run as a timeline, for the Perfetto UI or PlotJuggler");
  command.scenario(options->scenario);
  command.seed("--seed", options->seed, "The seed of the run. Default: 1");
  command.text("--pipeline", "PIPELINE", options->pipeline,
               "The pipeline to run. Default: yoon2021_both, else the scenario's first");
  add_program_options(command, options->programs);
  command.sets(options->sets);
  command.python();
  command.format(options->format, {"chrome", "csv"});
  command.json_messages();
  command.flag("--certify", options->certify,
               "With each set how far its frames were exposed apart at most, for sure\n"
               "(`simbench certify`)");
  add_window_options(command, *options);
  command.output("-o,--output", "FILE", options->output,
                 "The file, written as a whole or not at all. Default: -, standard output");
  command.footer(kTraceExamples);
  command.runs([options] { return run_trace(*options); });
}

}  // namespace simbench::cli
