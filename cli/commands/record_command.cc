#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>

#include "app/interrupt.h"
#include "app/recordings.h"
#include "cli/command.h"
#include "cli/commands/commands.h"
#include "cli/program_options.h"
#include "cli/progress.h"
#include "cli/rig_backend.h"
#include "evaluation/run/pipeline_choice.h"
#include "hardware/node/protocol.h"
#include "recording/counted.h"
#include "recording/recording_folder.h"
#include "sim/rig/simulation.h"

namespace simbench::cli {
namespace {

constexpr const char* kRecordExamples = R"(
Records one capture for each pipeline, under its host_sync: manifest.json, and for each capture
frames.csv (a line a frame: all stamps and the truth) and events.csv (pulses, clock adjustments,
polls, exchanges, outcomes). A recording that was cut off can be replayed up to that point.

Examples:
  simbench record --scenario 18cam_6host_45fps --seed 7 -o monday
  simbench record --scenario 3cam_1host_30fps --pipelines genlock,oracle -o short
  simbench record --scenario my_rig.json --backend hardware --rig rig.json --repeats 3 -o tuesday
  simbench record ... --pipelines yoon2021_both --collect 6c6ef4237b75c240 -o rest
  simbench replay monday                           the table that `simbench run` prints

--collect fetches what the nodes of a rig still have of a session whose conductor was killed.

Exit status: 0 ok, 1 internal error, 2 bad usage or input, 5 a program failed in every seed,
130 interrupted.)";

struct RecordOptions {
  std::string scenario;
  std::uint64_t seed = 1;
  std::vector<std::string> pipelines;
  std::vector<std::string> sets;
  ProgramOptions programs;
  std::uint64_t repeats = 1;
  BackendOptions backend;
  std::string output;
};

// Describes the recording, with the names of hosts and cameras in the rig file.
RecordingDescription description_of(const scenarios::Scenario& scenario,
                                    const PlannedCaptures& planned, const std::string& rig_file) {
  RecordingDescription description = {
      .backend = "sim", .scenario_json = scenario.resolved_json(), .planned = planned};
  if (rig_file.empty()) return description;
  description.backend = "hardware";
  for (const hardware::RigHost& host : hardware::load_rig(rig_file).hosts) {
    description.hosts.push_back(host.name);
    for (const hardware::RigCamera& camera : host.cameras) {
      description.cameras.push_back(camera.serial);
    }
  }
  return description;
}

std::unique_ptr<RecordingSource> source_of(const RecordOptions& options,
                                           const scenarios::Scenario& scenario) {
  if (is_hardware(options.backend)) return make_rig_source(options.backend, scenario);
  return sim::make_simulation(scenario);
}

void check_collect_options(const RecordOptions& options, std::size_t pipelines) {
  const std::string& session = options.backend.collect_session;
  if (session.empty()) return;
  if (!is_hardware(options.backend)) {
    throw scenarios::InputError("--collect: only with --backend hardware");
  }
  if (!hardware::is_session_id(session)) {
    throw scenarios::InputError(fmt::format(
        "--collect: found '{}', allowed: 16 hexadecimal digits, as the capture reported", session));
  }
  if (pipelines != 1 || options.repeats != 1) {
    throw scenarios::InputError(
        "--collect: a session is one capture; name its pipeline with --pipelines");
  }
}

int record(RecordOptions options) {
  const scenarios::Scenario scenario =
      load_with_programs(options.scenario, options.sets, options.programs, options.pipelines);
  const std::vector<evaluation::PipelineChoice> choices =
      evaluation::choose_pipelines(scenario, options.pipelines);
  print_warnings(scenarios::warnings(scenario));
  check_collect_options(options, choices.size());
  const auto source = app::interruptible(source_of(options, scenario));
  PlannedCaptures planned = {.first_seed = options.seed, .seeds = options.repeats};
  for (const evaluation::PipelineChoice& choice : choices) {
    planned.pipelines.push_back(choice.pipeline.name);
  }
  RecordingWriter writer(options.output, description_of(scenario, planned, options.backend.rig));
  app::CapturesMade made;
  const std::uint64_t wanted = choices.size() * options.repeats;
  const auto finished = watched<bool>(
      [&](const evaluation::Progress& progress) {
        app::record_captures(choices, *source,
                             {.first_seed = options.seed, .seeds = options.repeats}, writer, made,
                             progress);
        return std::optional(true);
      },
      {.unit = "capture",
       .total = wanted,
       .kept = options.output + " holds what was recorded",
       .waits_for_end = true});  // the manifest says how the recording ended
  print_warnings(made.warnings);
  if (!finished) return kInterrupted;
  if (made.recorded == 0) {
    print_error("no capture could be made");
    return kBadInput;
  }
  print_note(fmt::format("{} of {} recorded in {}", made.recorded, counted(wanted, "capture"),
                         options.output));
  const auto of_programs = std::ranges::count_if(
      choices, [](const auto& choice) { return choice.pipeline.programs.has_value(); });
  const std::uint64_t all_failed = static_cast<std::uint64_t>(of_programs) * options.repeats;
  return all_failed > 0 && made.programs_failed == all_failed ? kProgramFailed : kOk;
}

}  // namespace

void add_record_command(CommandLine& line) {
  auto options = std::make_shared<RecordOptions>();
  Command command(line, "record", "Record captures of a scenario, to replay and to study");
  command.scenario(options->scenario);
  command.seed("--seed", options->seed, "The first seed. Default: 1");
  command.pipelines(options->pipelines);
  command.count("--repeats", options->repeats, "Captures of each pipeline. Default: 1");
  add_program_options(command, options->programs);
  command.sets(options->sets);
  command.python();
  add_backend_options(command, options->backend);
  command.text("--collect", "SESSION", options->backend.collect_session,
               "On a rig: instead of a new capture, fetch what the nodes have of this session");
  command.json_messages();
  command.output("-o,--output", "DIR", options->output, "The folder, which must be new or empty")
      .required();
  command.footer(kRecordExamples);
  command.runs([options] { return record(*options); });
}

}  // namespace simbench::cli
