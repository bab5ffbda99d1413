#include "sim/programs/program_sync.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <deque>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "algorithms/host_sync/join.h"
#include "processes/placeholders.h"
#include "processes/program_endings.h"
#include "sim/host/sim_host.h"
#include "sim/programs/process.h"

namespace simbench::sim {
namespace {

using processes::fill;
using processes::HostPlaces;
using scenarios::HostPrograms;

// For its commands, environment and files alike.
HostPlaces places_of(SimHost& host) {
  return {.host = host.id(),
          .follows = scenarios::followed_host(host.world().hosts, host.id()),
          .drift = host.stored_frequency()};
}

// The programs of one host.
class RunningPrograms {
 public:
  // `on_gone` is called when the run is over.
  using OnGone = std::function<void(const processes::ProgramEndings&, bool clock_was_set)>;

  RunningPrograms(SimHost& host, std::size_t hosts, std::size_t programs, OnGone on_gone)
      : host_(host),
        hosts_(hosts),
        network_(host, hosts),
        kernel_(host),
        card_(host),
        endings_(host, programs),
        on_gone_(std::move(on_gone)) {}
  RunningPrograms(const RunningPrograms&) = delete;
  RunningPrograms& operator=(const RunningPrograms&) = delete;
  ~RunningPrograms() { on_gone_(endings_, kernel_.was_steered()); }

  // `kept`: the folder as the user has named it; empty: it is not kept.
  void start(const HostPrograms::Command& command, const ProgramSettings& settings,
             const std::string& folder, const std::string& kept) {
    const std::size_t number = processes_.size();
    const HostPlaces places = places_of(host_);
    const auto path = settings.paths.find(command.front());
    Child::Settings child{
        .command = fill(command, places),
        .program = path == settings.paths.end() ? "" : path->second,
        .environment = fill(settings.programs.environment, places),
        .folder = folder,
        .log_name = fmt::format("{}_{}.log", number, scenarios::program_name(command)),
        .shim = settings.shim};
    if (settings.patience) child.patience = *settings.patience;
    logs_.push_back(kept.empty() ? "" : fmt::format("{}/{}", kept, child.log_name));
    processes_.emplace_back(host_, network_, kernel_, card_, child,
                            static_cast<std::uint32_t>(number));
  }

  Task<void> run(std::optional<Nanoseconds> duration) {
    std::vector<Task<void>> tasks;
    for (PeerId peer = 0; peer < hosts_; ++peer) {
      if (peer == host_.id()) continue;
      tasks.push_back(network_.pump(peer));
      tasks.push_back(network_.streams().pump(peer));
    }
    tasks.push_back(network_.stamp_departures());
    tasks.push_back(kernel_.run());
    for (std::size_t i = 0; i < processes_.size(); ++i) tasks.push_back(serve(i));
    if (duration) tasks.push_back(stop_after(*duration));
    co_await join_all(std::move(tasks));
  }

 private:
  Task<void> serve(std::size_t number) {
    Process& process = processes_[number];
    const TrueTime begin = host_.true_now();
    co_await process.serve();
    if (process.ending().empty()) co_return;  // it was stopped
    endings_.add(process.end(), {.at = host_.true_now() - begin, .log = logs_[number]},
                 kernel_.was_steered());
  }

  Task<void> stop_after(Nanoseconds duration) {
    co_await host_.sleep_for(duration);
    for (Process& process : processes_) process.stop();
  }

  SimHost& host_;
  std::size_t hosts_;
  HostNetwork network_;
  KernelClock kernel_;
  CardClock card_;
  std::deque<Process> processes_;
  std::vector<std::string> logs_;  // by process
  processes::ProgramEndings endings_;
  OnGone on_gone_;
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
  std::vector<std::string> notes = notes_;
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
    folder = temporary_->path();
    folder /= fmt::format("host{}", host.id());
  } else {
    folder = std::filesystem::absolute(kept_folder(host));
  }
  return processes::make_folder(folder, settings_.programs, places_of(host));
}

Task<void> ProgramSync::run(Host& host, std::vector<HostPrograms::Command> commands) {
  SimHost& own = simulated(host);
  const auto on_gone = [this, id = host.id()](const processes::ProgramEndings& endings,
                                              bool clock_was_set) {
    notes_.insert(notes_.end(), endings.notes().begin(), endings.notes().end());
    if (id != 0 && !clock_was_set && !endings.has_failed()) unset_.insert(id);
  };
  RunningPrograms programs(own, settings_.hosts, commands.size(), on_gone);
  const std::string folder = make_folder(own);
  for (const HostPrograms::Command& command : commands) {
    programs.start(command, settings_, folder, kept_folder(own));
  }
  std::optional<Nanoseconds> duration;
  if (!settings_.programs.run_during_capture) duration = warm_up();
  co_await programs.run(duration);
}

Task<void> ProgramSync::run_master(Host& host, std::vector<PeerId> /*slaves*/) {
  return run(host, settings_.programs.master);
}

Task<void> ProgramSync::run_slave(Host& host, PeerId /*master*/) {
  return run(host, settings_.programs.slave);
}

}  // namespace simbench::sim
