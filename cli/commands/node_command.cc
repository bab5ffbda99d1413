#include <fmt/chrono.h>
#include <fmt/format.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <iostream>
#include <memory>
#include <utility>

#include "algorithms/ports/capture_alignment.h"
#include "algorithms/ports/host_sync.h"
#include "app/program_pipelines.h"
#include "cli/command.h"
#include "cli/commands/commands.h"
#include "cli/rig_backend.h"
#include "evaluation/run/pipeline_choice.h"
#include "hardware/camera/drivers.h"
#include "hardware/clock/os_clock.h"
#include "hardware/clock/software_clock.h"
#include "hardware/net/secure_stream.h"
#include "hardware/node/journal.h"
#include "hardware/node/node.h"
#include "hardware/rig/rig.h"
#include "recording/counted.h"

namespace simbench::cli {
namespace {

constexpr const char* kNodeExamples = R"(
Runs until SIGINT or SIGTERM and logs each event as a line on standard error. The rig's conductor
(simbench run --backend hardware) sends it requests. A systemd unit comes with simbench:
simbench-node.service.

The node synchronises a software clock of its own; it changes the system's clock only with
--set-system-clock.

Examples:
  simbench node --rig rig.json --name host3 --key-file rig.key
  simbench node --rig rig.json --name host3                   without a key: on one machine only
  simbench node --rig rig.json --name host3 --key-file rig.key --set-system-clock --dry-run

Exit status: 0 stopped by a signal, 1 internal error, 2 bad usage or input.)";

struct NodeOptions {
  std::string rig;
  std::string name;
  std::string key_file;
  std::string journal;
  bool set_system_clock = false;
  double max_step_ms = 1000;
  bool dry_run = false;
  std::string programs_on;
  std::string program_log;
  double clock_offset_ms = 0;
  double clock_skew_ppm = 0;
  hardware::SoftwareClock::SetCost clock_set;
};

void log_line(const std::string& line) {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  const auto ms = std::chrono::duration_cast<std::chrono::milliseconds>(now).count();
  const auto second = static_cast<std::time_t>(ms / 1000);
  std::tm local = {};
  localtime_r(&second, &local);
  std::cerr << fmt::format("{:%Y-%m-%d %H:%M:%S}.{:03} {}\n", local, ms % 1000, line) << std::flush;
}

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr ? value : "";
}

// A folder for each node, since several of a rig may run on one machine.
std::string default_journal_folder(std::string name) {
  for (char& c : name) {
    if (c == '/' || c == '.') c = '_';
  }
  const std::string service = environment("STATE_DIRECTORY");  // of systemd
  if (!service.empty()) return fmt::format("{}/{}", service, name);
  const std::string state = environment("XDG_STATE_HOME");
  if (!state.empty()) return fmt::format("{}/simbench/{}", state, name);
  const std::string home = environment("HOME");
  if (!home.empty()) return fmt::format("{}/.local/state/simbench/{}", home, name);
  throw scenarios::InputError("--journal: found none, and no HOME; allowed: a folder");
}

// What an algorithm needs and no real host has; null if hosts have it.
const char* lacking(Need need) {
  switch (need) {
    case Need::kHardwareStamps:
      return "hardware stamps of the network card";
    case Need::kPps:
    case Need::kGnss:
      return "a GNSS receiver's pulses";
    case Need::kTriggerLine:
      return "the trigger line wired into the host";
    case Need::kTsf:
    case Need::kFtm:
      return "a Wi-Fi radio whose time a program can use";
    case Need::kTruth:
      return "the truth";
    case Need::kPolls:
    case Need::kHostStamps:
    case Need::kLedClock:
    case Need::kTriggerCode:
    case Need::kFrames:
    case Need::kFrameControl:  // cameras say so themselves
      break;
  }
  return nullptr;
}

// Throws if hosts lack what the algorithm of this stage needs.
void check_has(const std::string& pipeline, const char* stage, const AlgorithmInfo& info) {
  for (const Need need : info.needs) {
    if (const char* what = lacking(need)) {
      throw scenarios::InputError(
          fmt::format("pipeline '{}': its {} '{}' needs {}, which nodes do not have", pipeline,
                      stage, info.name, what));
    }
  }
}

std::unique_ptr<HostSync> make_host_sync(const evaluation::PipelineChoice& choice,
                                         const std::string& pipeline, const NodeOptions& options) {
  if (choice.pipeline.programs && !options.programs_on.empty()) {
    return app::make_node_programs(choice.pipeline, options.programs_on,
                                   {.log_folder = options.program_log});
  }
  if (choice.pipeline.programs) {
    throw scenarios::InputError(fmt::format(
        "pipeline '{}': its programs run on simulated hosts and in validate-model only; "
        "on real hosts start them yourself, with host_sync \"free_running\"",
        pipeline));
  }
  check_has(pipeline, "host_sync", choice.host_sync.info());
  return choice.host_sync.make();
}

hardware::NodePipeline make_pipeline(const scenarios::Scenario& scenario,
                                     const std::string& pipeline, const NodeOptions& options) {
  const evaluation::PipelineChoice choice =
      evaluation::choose_pipelines(scenario, {pipeline}).front();
  hardware::NodePipeline made{.host_sync = make_host_sync(choice, pipeline, options)};
  if (choice.is_steered()) {
    check_has(pipeline, "capture_alignment", choice.capture_alignment.info());
    made.capture_alignment = choice.capture_alignment.make();
  }
  return made;
}

std::unique_ptr<hardware::NodeClock> make_clock(boost::asio::io_context& context, PeerId me,
                                                const NodeOptions& options) {
  if (options.set_system_clock) {
    return hardware::make_os_clock(context, hardware::kernel_clock_calls(),
                                   {.host = me,
                                    .max_step = from_ms(options.max_step_ms),
                                    .dry_run = options.dry_run,
                                    .log = log_line});
  }
  hardware::SoftwareClock::Settings settings;
  settings.host = me;
  settings.offset = from_ms(options.clock_offset_ms);
  settings.set_cost = options.clock_set;
  if (options.clock_skew_ppm != 0) {
    const MonotonicTime zero = hardware::monotonic_now();
    settings.oscillator = {.monotonic_zero = zero,
                           .steady_zero = SteadyTime(zero.time_since_epoch()),
                           .skew_ppm = options.clock_skew_ppm};
  }
  return std::make_unique<hardware::SoftwareClock>(context, std::move(settings));
}

void serve(const NodeOptions& options) {
  const hardware::Rig rig = hardware::load_rig(options.rig);
  const PeerId me = hardware::host_named(rig, options.name);
  hardware::NodeSettings settings;
  settings.rig = rig;
  settings.me = me;
  settings.key = key_of(options.key_file);
  settings.journal_folder =
      options.journal.empty() ? default_journal_folder(options.name) : options.journal;

  if (options.set_system_clock) settings.clock_kind = options.dry_run ? "dry run" : "system";

  boost::asio::io_context context(1);
  const std::unique_ptr<hardware::CameraDriver> cameras = hardware::make_camera_driver(rig, me);
  const std::unique_ptr<hardware::NodeClock> clock = make_clock(context, me, options);
  hardware::Node node(
      context, settings, *clock, *cameras,
      [&options](const scenarios::Scenario& scenario, const std::string& pipeline) {
        return make_pipeline(scenario, pipeline, options);
      },
      log_line);
  boost::asio::signal_set signals(context, SIGINT, SIGTERM);
  signals.async_wait([&](const boost::system::error_code& error, int signal) {
    if (error) return;
    log_line(fmt::format("{}: stopping", signal == SIGINT ? "SIGINT" : "SIGTERM"));
    signals.clear();  // the next one ends the program at once
    node.stop();
  });
  node.start();
  print_result(fmt::format("node {}: listening on {}:{}\n", options.name, rig.hosts[me].address,
                           node.port()));
  log_line(fmt::format("{}: {}, journals in {}", options.name,
                       counted(rig.hosts[me].cameras.size(), "camera"), settings.journal_folder));
  context.run();
}

int run_node(const NodeOptions& options) {
  hardware::ask_for_exact_timers();
  // A closed log and a limit of file size must not end a capture.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  try {
    serve(options);
    return kOk;
  } catch (const hardware::ClockError& error) {
    print_error(error.what());
  } catch (const hardware::CameraError& error) {
    print_error(error.what());
  } catch (const hardware::JournalError& error) {
    print_error(error.what());
  } catch (const hardware::StreamError& error) {
    print_error(error.what());
  }
  return kBadInput;
}

// Options of a test's clock exclude --set-system-clock; options of setting need it.
void add_clock_options(Command& command, NodeOptions& options) {
  const Option set =
      command.flag("--set-system-clock", options.set_system_clock,
                   "Synchronise the operating system's clock instead of one in software;\n"
                   "needs the right to set it (CAP_SYS_TIME)");
  command
      .number("--max-step-ms", "MS", options.max_step_ms, 0, 1e9,
              "Refuse to step the system's clock by more. Default: 1000")
      .needs(set);
  command.flag("--dry-run", options.dry_run, "Log what would be set, and set nothing").needs(set);
  command
      .number("--clock-offset-ms", "MS", options.clock_offset_ms, -1e7, 1e7,
              "For tests: the node's clock starts ahead of the system's by this. Default: 0")
      .excludes(set);
  command
      .number("--clock-skew-ppm", "PPM", options.clock_skew_ppm, -1000, 1000,
              "For tests: the node's oscillator runs fast by this. Default: 0")
      .excludes(set);
  command
      .number("--clock-set-cost-ms", "MS", options.clock_set.cost_ms, 0, 1000,
              "For tests: a change of the node's clock takes so long. Default: 0")
      .excludes(set);
  command
      .number("--clock-set-log-sigma", "SIGMA", options.clock_set.log_sigma, 0, 2,
              "For tests: each time a factor exp(N(0, this)) longer or shorter. Default: 0")
      .excludes(set);
  command
      .number("--clock-set-effective", "SHARE", options.clock_set.effective_fraction, 0, 1,
              "For tests: the share of that time after which it counts. Default: 0")
      .excludes(set);
}

void add_node_program_options(Command& command, NodeOptions& options) {
  const Option on =
      command.text("--programs-on", "INTERFACE", options.programs_on,
                   "For tests: run the programs of a conductor's pipeline, confined, around the\n"
                   "node's software clock; their network is on this interface");
  command
      .output("--program-log", "DIR", options.program_log,
              "Keep what programs print, and their files, in DIR/PIPELINE/host0")
      .needs(on);
}

}  // namespace

void add_node_command(CommandLine& line) {
  auto options = std::make_shared<NodeOptions>();
  Command command(line, "node", "Serve one host of a real rig: its clock, network and cameras");
  command.text("--rig", "FILE", options->rig, "The rig file, the same on every host").required();
  command.text("--name", "HOST", options->name, "Which of the rig's hosts this is").required();
  command.text("--key-file", "FILE", options->key_file,
               "The rig's key (see simbench keygen). Without one the node speaks\n"
               "to its own machine only");
  command.output("--journal", "DIR", options->journal,
                 "Folder for the recordings of the newest 100 sessions.\n"
                 "Default: ~/.local/state/simbench/HOST");
  add_clock_options(command, *options);
  add_node_program_options(command, *options);
  command.footer(kNodeExamples);
  command.runs([options] { return run_node(*options); });
}

}  // namespace simbench::cli
