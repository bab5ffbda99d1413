#include "sim/programs/program_sync.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <deque>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "algorithms/host_sync/join.h"
#include "processes/lesser_user.h"
#include "processes/placeholders.h"
#include "processes/program_endings.h"
#include "recording/program_failure.h"
#include "sim/host/sim_host.h"
#include "sim/programs/host_files.h"
#include "sim/programs/program.h"

namespace simbench::sim {
namespace {

using processes::fill;
using processes::HostPlaces;
using scenarios::HostPrograms;

constexpr PeerId kMaster = 0;
// What programs have at least until a clock that nobody has set is one that they failed to set.
constexpr Nanoseconds kLeastNeeded = std::chrono::minutes(1);

// For its commands, environment and files alike.
HostPlaces places_of(SimHost& host) {
  return {.host = host.id(),
          .follows = scenarios::followed_host(host.world().hosts, host.id()),
          .drift = host.stored_frequency()};
}

// What the programs of one host tell of it.
struct Told {
  std::function<void(const ProgramFailure&)> failed;
  // When the run is over: with notes, and whether nobody set a slave's clock, which nothing says.
  std::function<void(const std::vector<std::string>& notes, bool is_unset)> gone;
};

// Where the files of a host are.
struct Folder {
  std::string path;
  std::string kept;  // as the user has named it; empty: it is not kept
};

// The programs of one host.
class RunningPrograms {
 public:
  RunningPrograms(SimHost& host, std::size_t hosts, std::size_t programs, Folder folder, Told told)
      : host_(host),
        hosts_(hosts),
        folder_(std::move(folder)),
        network_(host, hosts),
        kernel_(host),
        card_(host),
        pulses_(host),
        files_(host, folder_.path),
        endings_(host, programs),
        told_(std::move(told)) {}
  RunningPrograms(const RunningPrograms&) = delete;
  RunningPrograms& operator=(const RunningPrograms&) = delete;
  ~RunningPrograms() {
    programs_.clear();
    files_.stamp_all();
    const bool is_said = is_reported_unset_ || endings_.failure();
    told_.gone(endings_.notes(), host_.id() != kMaster && !kernel_.was_steered() && !is_said);
  }

  void start(const std::vector<HostPrograms::Command>& commands, const ProgramSettings& settings,
             const std::shared_ptr<processes::RunUse>& run) {
    std::vector<Child::Settings> children;
    for (const HostPrograms::Command& command : commands) {
      children.push_back(child_settings(command, settings));
      children.back().log_name =
          fmt::format("{}_{}.log", logs_.size(), scenarios::program_name(command));
      children.back().run = run;
      logs_.push_back(
          folder_.kept.empty() ? "" : fmt::format("{}/{}", folder_.kept, children.back().log_name));
    }
    processes::agree_on_user(children);
    for (const Child::Settings& each : children) {
      programs_.emplace_back(
          Program::Surroundings{host_, network_, kernel_, card_, pulses_, processes_, files_},
          each);
    }
  }

  // `needed`: how long the programs take to synchronise the host. `duration`: nothing, for ever.
  Task<void> run(Nanoseconds needed, std::optional<Nanoseconds> duration) {
    std::vector<Task<void>> tasks;
    for (PeerId peer = 0; peer < hosts_; ++peer) {
      if (peer == host_.id()) continue;
      tasks.push_back(network_.pump(peer));
      tasks.push_back(network_.streams().pump(peer));
    }
    tasks.push_back(network_.stamp_departures());
    tasks.push_back(network_.answer_refused());
    tasks.push_back(kernel_.run());
    tasks.push_back(pulses_.run());
    for (std::size_t i = 0; i < programs_.size(); ++i) tasks.push_back(serve(i));
    if (host_.id() != kMaster) tasks.push_back(watch_clock(needed));
    if (duration) tasks.push_back(stop_after(*duration));
    co_await join_all(std::move(tasks));
  }

 private:
  Child::Settings child_settings(const HostPrograms::Command& command,
                                 const ProgramSettings& settings) const {
    const HostPlaces places = places_of(host_);
    const auto path = settings.paths.find(command.front());
    Child::Settings child{.command = fill(command, places),
                          .program = path == settings.paths.end() ? "" : path->second,
                          .environment = fill(settings.programs.environment, places),
                          .folder = folder_.path,
                          .shim = settings.shim,
                          .readable = fill(settings.programs.readable, places)};
    if (settings.patience) child.patience = *settings.patience;
    return child;
  }

  Task<void> serve(std::size_t number) {
    Program& program = programs_[number];
    const TrueTime begin = host_.true_now();
    co_await program.serve();
    if (program.ending().empty()) co_return;  // it was stopped
    const bool had_failed = endings_.failure().has_value();
    endings_.add(program.end(), {.at = host_.true_now() - begin, .log = logs_[number]},
                 kernel_.was_steered());
    if (!had_failed && endings_.failure()) told_.failed(*endings_.failure());
  }

  // A slave is not synchronised while nobody has set its clock.
  Task<void> watch_clock(Nanoseconds needed) {
    co_await kernel_.until_steered(host_.true_now() + needed);
    if (kernel_.was_steered() || endings_.failure()) co_return;
    is_reported_unset_ = true;
    host_.report_outcome({.slave = host_.id(),
                          .synchronised = false,
                          .passes = 0,
                          .message = fmt::format("host {}: no program has set its clock in {:g} s",
                                                 host_.id(), to_seconds(needed))});
    co_await kernel_.until_steered(std::nullopt);
    if (endings_.failure()) co_return;
    host_.report_outcome({.slave = host_.id(), .synchronised = true, .passes = 0, .message = ""});
  }

  Task<void> stop_after(Nanoseconds duration) {
    co_await host_.sleep_for(duration);
    for (Program& program : programs_) program.stop();
  }

  SimHost& host_;
  std::size_t hosts_;
  Folder folder_;
  HostNetwork network_;
  KernelClock kernel_;
  CardClock card_;
  PulseDevices pulses_;
  HostProcesses processes_;
  HostFiles files_;
  std::deque<Program> programs_;
  std::vector<std::string> logs_;  // by program
  processes::ProgramEndings endings_;
  bool is_reported_unset_ = false;
  Told told_;
};

SimHost& simulated(Host& host) {
  auto* found = dynamic_cast<SimHost*>(&host);
  if (found == nullptr) throw std::logic_error("programs run in the simulated world only");
  return *found;
}

}  // namespace

ProgramSync::ProgramSync(ProgramSettings settings) : settings_(std::move(settings)) {}

std::optional<Nanoseconds> ProgramSync::warm_up() const {
  return from_ms(1e3 * settings_.programs.run_before_capture_s);
}

std::vector<std::string> ProgramSync::notes() const {
  std::vector<std::string> notes = failure_lines(failures_);
  notes.insert(notes.end(), notes_.begin(), notes_.end());
  if (!unset_.empty()) {
    notes.push_back(fmt::format("{} {}: no program has set the clock, which ran free",
                                unset_.size() == 1 ? "host" : "hosts", fmt::join(unset_, ", ")));
  }
  return notes;
}

std::string ProgramSync::kept_folder(const SimHost& host) const {
  if (settings_.log_folder.empty()) return "";
  return fmt::format("{}/{}/seed{}/host{}", settings_.log_folder, settings_.pipeline,
                     host.world().run_seed, host.id());
}

std::string ProgramSync::make_folder(SimHost& host) {
  std::filesystem::path folder;
  if (settings_.log_folder.empty()) {
    if (temporary_ == nullptr) temporary_ = std::make_unique<TemporaryFolder>();
    processes::let_pass(temporary_->path());
    folder = temporary_->path();
    folder /= fmt::format("host{}", host.id());
  } else {
    folder = std::filesystem::absolute(kept_folder(host));
  }
  return processes::make_folder(folder, settings_.programs, places_of(host));
}

Task<void> ProgramSync::run(Host& host, std::vector<HostPrograms::Command> commands) {
  SimHost& own = simulated(host);
  RunningPrograms programs(
      own, settings_.hosts, commands.size(), {.path = make_folder(own), .kept = kept_folder(own)},
      {.failed = [this](const ProgramFailure& failure) { failures_.push_back(failure); },
       .gone =
           [this, id = host.id()](const std::vector<std::string>& notes, bool is_unset) {
             notes_.insert(notes_.end(), notes.begin(), notes.end());
             if (is_unset) unset_.insert(id);
           }});
  programs.start(commands, settings_, run_);
  std::optional<Nanoseconds> duration;
  if (!settings_.programs.run_during_capture) duration = warm_up();
  co_await programs.run(std::max(*warm_up(), kLeastNeeded), duration);
}

Task<void> ProgramSync::run_master(Host& host, std::vector<PeerId> /*slaves*/) {
  return run(host, settings_.programs.master);
}

Task<void> ProgramSync::run_slave(Host& host, PeerId /*master*/) {
  return run(host, settings_.programs.slave);
}

}  // namespace simbench::sim
