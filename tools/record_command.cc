#include "tools/record_command.h"

#include <limits>
#include <memory>

#include "evaluation/pipeline_choice.h"
#include "recording/recording_folder.h"
#include "sim/rig/simulation.h"
#include "tools/interrupt.h"
#include "tools/record_captures.h"

namespace simbench::tools {
namespace {

constexpr const char* kExamples = R"(
One capture for each pipeline, under its host_sync: manifest.json, and for each capture frames.csv
(a line a frame: all stamps and the truth) and events.csv (pulses, clock adjustments, polls,
exchanges, outcomes). What is recorded outlives the program at any moment: a folder whose recording
was cut off can be replayed up to there.

Examples:
  simbench record --scenario 18cam_6host_45fps --seed 7 -o monday
  simbench record --scenario 3cam_1host_30fps --pipelines genlock,oracle -o short
  simbench replay monday                           the table that `simbench run` prints

Exit status: 0 ok, 1 internal error, 2 bad usage or input, 130 interrupted.)";

struct RecordOptions {
  std::string scenario;
  std::uint64_t seed = 1;
  std::vector<std::string> pipelines;
  std::vector<std::string> sets;
  std::string output;
};

int record(const RecordOptions& options) {
  const scenarios::Scenario scenario =
      scenarios::load_scenario(options.scenario, overrides_of(options.sets));
  const std::vector<evaluation::PipelineChoice> choices =
      evaluation::choose_pipelines(scenario, options.pipelines);
  print_warnings(scenarios::warnings(scenario));
  RecordingWriter writer(options.output,
                         {.backend = "sim", .scenario_json = scenario.resolved_json});
  const auto source = interruptible(sim::make_simulation(scenario));
  return record_captures(choices, *source, {.folder = options.output, .first_seed = options.seed},
                         writer);
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
  add_set_option(*command, options->sets);
  add_json_messages_option(*command);
  command->add_option("-o,--output", options->output, "The folder, which must be new or empty")
      ->type_name("DIR")
      ->required();
  command->footer(kExamples);
  command->callback([options, &action] { action = [options] { return record(*options); }; });
}

}  // namespace simbench::tools
