#include "cli/commands/record_command.h"

#include <fmt/format.h>

#include <limits>
#include <memory>

#include "app/interrupt.h"
#include "cli/record_captures.h"
#include "cli/rig_backend.h"
#include "evaluation/run/pipeline_choice.h"
#include "hardware/node/protocol.h"
#include "recording/recording_folder.h"
#include "sim/rig/simulation.h"

namespace simbench::cli {
namespace {

constexpr const char* kRecordExamples = R"(
One capture for each pipeline, under its host_sync: manifest.json, and for each capture frames.csv
(a line a frame: all stamps and the truth) and events.csv (pulses, clock adjustments, polls,
exchanges, outcomes). What is recorded outlives the program at any moment: a folder whose recording
was cut off can be replayed up to there.

Examples:
  simbench record --scenario 18cam_6host_45fps --seed 7 -o monday
  simbench record --scenario 3cam_1host_30fps --pipelines genlock,oracle -o short
  simbench record --scenario my_rig.json --backend hardware --rig rig.json --repeats 3 -o tuesday
  simbench record ... --pipelines yoon2021_both --collect 6c6ef4237b75c240 -o rest
  simbench replay monday                           the table that `simbench run` prints

--collect fetches what the nodes of a rig still have of a session whose conductor was killed.

Exit status: 0 ok, 1 internal error, 2 bad usage or input, 130 interrupted.)";

struct RecordOptions {
  std::string scenario;
  std::uint64_t seed = 1;
  std::vector<std::string> pipelines;
  std::vector<std::string> sets;
  std::uint64_t repeats = 1;
  BackendOptions backend;
  std::string output;
};

// Who is who, as the rig file names them.
RecordingDescription description_of(const scenarios::Scenario& scenario,
                                    const std::string& rig_file) {
  RecordingDescription description = {.backend = "sim", .scenario_json = scenario.resolved_json};
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
        "--collect: found '{}', allowed: 16 hexadecimal digits, as the capture told", session));
  }
  if (pipelines != 1 || options.repeats != 1) {
    throw scenarios::InputError("--collect: a session is one capture; name its one --pipelines");
  }
}

int record(const RecordOptions& options) {
  const scenarios::Scenario scenario =
      scenarios::load_scenario(options.scenario, overrides_of(options.sets));
  const std::vector<evaluation::PipelineChoice> choices =
      evaluation::choose_pipelines(scenario, options.pipelines);
  print_warnings(scenarios::warnings(scenario));
  check_collect_options(options, choices.size());
  const auto source = app::interruptible(source_of(options, scenario));
  RecordingWriter writer(options.output, description_of(scenario, options.backend.rig));
  return record_captures(
      choices, *source,
      {.folder = options.output, .first_seed = options.seed, .seeds = options.repeats}, writer);
}

}  // namespace

void add_record_command(CLI::App& app, Action& action) {
  CLI::App* command =
      app.add_subcommand("record", "Record captures of a scenario, to be replayed and studied");
  auto options = std::make_shared<RecordOptions>();
  command
      ->add_option("--scenario", options->scenario,
                   "Name of a scenario (see `simbench list`) or path of a scenario file")
      ->type_name("SCENARIO")
      ->required();
  command->add_option("--seed", options->seed, "Default: 1")
      ->type_name("K")
      ->check(whole_number(0, std::numeric_limits<std::uint32_t>::max()));
  command
      ->add_option("--pipelines", options->pipelines,
                   "Only these pipelines of the scenario, in this order")
      ->type_name("NAME,NAME")
      ->delimiter(',')
      ->allow_extra_args(false);
  command->add_option("--repeats", options->repeats, "Captures of each pipeline. Default: 1")
      ->type_name("N")
      ->check(whole_number(1, 1'000'000));
  add_set_option(*command, options->sets);
  add_backend_options(*command, options->backend);
  command
      ->add_option("--collect", options->backend.collect_session,
                   "On a rig: no new capture, but what the nodes have of this session")
      ->type_name("SESSION");
  add_json_messages_option(*command);
  command->add_option("-o,--output", options->output, "The folder, which must be new or empty")
      ->type_name("DIR")
      ->required();
  command->footer(kRecordExamples);
  command->callback([options, &action] { action = [options] { return record(*options); }; });
}

}  // namespace simbench::cli
