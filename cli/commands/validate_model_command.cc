#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/utsname.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "app/experiment_source.h"
#include "app/interrupt.h"
#include "cli/command.h"
#include "cli/commands/commands.h"
#include "cli/program_options.h"
#include "cli/program_runs.h"
#include "cli/progress.h"
#include "evaluation/run/evaluate.h"
#include "evaluation/statistics/statistics.h"
#include "hardware/experiment/network_sandbox.h"
#include "hardware/experiment/stack_delays.h"
#include "reports/recordings/measured_study.h"
#include "reports/recordings/model_gap_report.h"
#include "reports/recordings/stack_study.h"

namespace simbench::cli {
namespace {

constexpr const char* kValidateModelExamples = R"(
Measures the simulator's own error. The scenario's hosts run as processes on this machine, with real
sockets, clocks and timers, a relay as the scenario's network, and cameras that play a recording.
All processes share one monotonic clock, so the true errors of their clocks are known. Then the same
scenario is simulated, and both distributions are printed side by side.

It validates transport, protocols and the costs of hosts, not cameras: see the matrix of evidence.
Nodes get network namespaces of their own if permitted, else ports of loopback. A repetition of the
paper's algorithms takes some 8 s, of ntp and two_way_hull as long as their service runs before the
capture. The machine should do nothing else meanwhile.

With --stack it measures, for some two minutes, what a message costs between the calls of a program
and the kernel's stamps, over sockets in two network namespaces: idle, then with a busy thread on
every core. A scenario's /hosts/stack takes these laws.

Examples:
  simbench validate-model --scenario 6node_relay
  simbench validate-model --scenario 6node_relay --repeats 20 --save study.json
  simbench validate-model --scenario 6node_relay --measured study.json --format json
  simbench validate-model --scenario 6node_relay --stack network_stack.json

Exit status: 0 ok, 1 internal error, 2 bad usage or input, 5 a program failed in every seed,
130 interrupted.)";

struct ValidateModelOptions {
  std::string scenario;
  std::vector<std::string> sets;
  std::vector<std::string> pipelines;
  ProgramOptions programs;
  std::uint64_t first_seed = 1;
  std::uint64_t repeats = 5;
  std::uint64_t seeds = 200;
  std::string measured;
  std::string save;
  std::string stack;
  std::string format;
};

std::string processor() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);) {
    const std::size_t colon = line.find(':');
    if (line.starts_with("model name") && colon != std::string::npos) {
      return line.substr(std::min(colon + 2, line.size()));
    }
  }
  return "unknown processor";
}

std::string machine(const std::string& network) {
  utsname system{};
  uname(&system);
  return fmt::format("{}, {} cores, {} {}, {}", processor(), std::thread::hardware_concurrency(),
                     system.sysname, system.release, network);
}

std::string today() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm utc = {};
  gmtime_r(&now, &utc);
  return fmt::format("{:%Y-%m-%d}", utc);
}

// Puts the nodes into namespaces if this process may make one; returns the kind of network.
std::string choose_network(app::ExperimentOptions& options) {
  const std::optional<std::string> refusal = hardware::NetworkSandbox::enter();
  options.namespaces = !refusal;
  if (!refusal) return "namespaces";
  print_note(*refusal + "; the nodes share the loopback interface");
  return "loopback";
}

// The relay's lateness beyond the scenario's latencies, over all repetitions.
class RelayLateness {
 public:
  void add(const std::string& statistics) {
    const auto relay = nlohmann::json::parse(statistics, nullptr, false);
    if (!relay.is_object()) return;
    const auto p50 = relay.find("late_p50_us");
    const auto p95 = relay.find("late_p95_us");
    if (p50 == relay.end() || !p50->is_number() || p95 == relay.end() || !p95->is_number()) return;
    p50_us_.push_back(p50->get<double>());
    p95_us_.push_back(p95->get<double>());
  }
  void print() const {
    if (p50_us_.empty()) return;
    print_note(fmt::format(
        "beyond the scenario's latencies, messages left the relay {:.0f} us late (95 %: {:.0f} us)",
        evaluation::median(p50_us_), evaluation::median(p95_us_)));
  }

 private:
  std::vector<double> p50_us_;
  std::vector<double> p95_us_;
};

// Nothing if interrupted.
std::optional<reports::MeasuredStudy> measure_network(const ValidateModelOptions& options,
                                                      const scenarios::Scenario& scenario) {
  app::ExperimentOptions experiment;
  const std::string network = choose_network(experiment);
  experiment.program_log = options.programs.log_folder;
  experiment.cancelled = [] { return app::InterruptHandler::raised(); };
  RelayLateness lateness;
  experiment.relay_statistics = [&lateness](const std::string& each) { lateness.add(each); };
  const auto results = watched<evaluation::Results>(
      [&](const evaluation::Progress& progress) {
        return evaluation::evaluate(
            scenario,
            [&] {
              return app::interruptible(
                  std::make_unique<app::ExperimentSource>(scenario, experiment));
            },
            {.first_seed = options.first_seed,
             .seeds = options.repeats,
             .jobs = 1,
             .pipelines = options.pipelines},
            progress);
      },
      {.unit = "repetition", .waits_for_end = true});
  if (!results) return std::nullopt;
  print_warnings(results->warnings);
  lateness.print();
  return reports::measured_study(*results, today(), machine(network));
}

// The study's pipelines that the user wants.
std::vector<std::string> pipelines_of(const reports::MeasuredStudy& study,
                                      const ValidateModelOptions& options) {
  std::vector<std::string> names;
  for (const reports::MeasuredPipeline& row : study.rows) {
    const bool wanted =
        options.pipelines.empty() || std::find(options.pipelines.begin(), options.pipelines.end(),
                                               row.pipeline) != options.pipelines.end();
    if (wanted) names.push_back(row.pipeline);
  }
  if (names.empty()) {
    throw scenarios::InputError(options.measured +
                                ": none of the wanted pipelines is in the study");
  }
  return names;
}

std::string model_gap_text(const reports::ModelGapReport& report, const std::string& format) {
  if (format == "json") return reports::model_gap_json(report);
  const reports::Document document = reports::model_gap_document(report);
  return format == "markdown" ? markdown(document) : plain(document);
}

// Nothing if interrupted.
std::optional<reports::StackCondition> measure_stack(const std::string& name,
                                                     unsigned busy_threads) {
  const hardware::StackDelays delays = hardware::measure_stack_delays(
      {.busy_threads = busy_threads, .cancelled = [] { return app::InterruptHandler::raised(); }});
  if (app::InterruptHandler::raised()) return std::nullopt;
  return reports::StackCondition{.name = name,
                                 .busy_threads = busy_threads,
                                 .parts = {{"transmit", reports::stack_law(delays.transmit_us)},
                                           {"passage", reports::stack_law(delays.passage_us)},
                                           {"wake_up", reports::stack_law(delays.wake_up_us)}}};
}

int measure_stacks(const std::string& file) {
  if (const auto refusal = hardware::NetworkSandbox::enter()) {
    throw scenarios::InputError("--stack needs network namespaces: " + *refusal);
  }
  const auto study = watched<reports::StackStudy>(
      [](const evaluation::Progress& progress) -> std::optional<reports::StackStudy> {
        const auto idle = measure_stack("idle", 0);
        if (!idle) return std::nullopt;
        progress(1, 2);
        const auto loaded = measure_stack("beside_load", std::thread::hardware_concurrency());
        if (!loaded) return std::nullopt;
        progress(2, 2);
        return reports::StackStudy{.date = today(),
                                   .machine = machine("veth between namespaces"),
                                   .conditions = {*idle, *loaded}};
      },
      {.unit = "condition", .total = 2, .waits_for_end = true});
  if (!study) return kInterrupted;
  reports::write_stack_study(file, *study);
  print_note("delays of this machine's network stack written to " + file);
  return kOk;
}

int validate_model(ValidateModelOptions options) {
  if (!options.stack.empty()) return measure_stacks(options.stack);
  const scenarios::Scenario scenario =
      load_with_programs(options.scenario, options.sets, options.programs, options.pipelines);
  evaluation::check_pipelines(scenario);
  print_warnings(scenarios::warnings(scenario));
  const std::optional<reports::MeasuredStudy> study =
      options.measured.empty()
          ? measure_network(options, scenario)
          : std::optional(reports::read_measured_study(options.measured, scenario.name));
  if (!study) return kInterrupted;
  if (!options.save.empty()) {
    reports::write_measured_study(options.save, *study);
    print_note("measured study written to " + options.save);
  }
  const auto simulated = watched<evaluation::Results>([&](const evaluation::Progress& progress) {
    return evaluation::evaluate(
        scenario, [&] { return app::simulated_world(scenario); },
        {.seeds = options.seeds,
         .pipelines = pipelines_of(*study, options),
         .share_captures = true},
        progress);
  });
  if (!simulated) return kInterrupted;
  print_result(model_gap_text(reports::model_gap_report(*study, *simulated), options.format));
  return status_of(*simulated);
}

void add_measurement_options(Command& command, ValidateModelOptions& options) {
  command.whole_number("--repeats", "N", options.repeats, 1, 1000,
                       "Measured repetitions of each pipeline. Default: 5");
  command.seed("--first-seed", options.first_seed,
               "Seed of the first repetition's clocks, cameras and relay. Default: 1");
  command.text("--measured", "FILE", options.measured,
               "Instead of measuring now: a study that --save wrote");
  command.output("--save", "FILE", options.save,
                 "Write the measured study to this file, with date and machine");
  command.output("--stack", "FILE", options.stack,
                 "Instead of an experiment: measure this machine's network stack, into this file");
}

}  // namespace

void add_validate_model_command(CommandLine& line) {
  auto options = std::make_shared<ValidateModelOptions>();
  Command command(line, "validate-model",
                  "Measure a scenario with real processes and compare the simulation with it");
  command.scenario(options->scenario);
  command.sets(options->sets);
  command.list("--pipelines", "PIPELINE,...", options->pipelines,
               "Only these pipelines of the scenario");
  add_program_options(command, options->programs);
  add_measurement_options(command, *options);
  command.count("--seeds", options->seeds, "Simulated seeds of each pipeline. Default: 200");
  command.format(options->format, {"table", "markdown", "json"});
  command.footer(kValidateModelExamples);
  command.runs([options] { return validate_model(*options); });
}

}  // namespace simbench::cli
