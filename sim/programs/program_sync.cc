#include "sim/programs/program_sync.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <deque>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "algorithms/host_sync/join.h"
#include "processes/placeholders.h"
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
  RunningPrograms(SimHost& host, std::size_t hosts)
      : host_(host), hosts_(hosts), network_(host, hosts), kernel_(host), card_(host) {}

  void start(const HostPrograms::Command& command, const ProgramSettings& settings,
             const std::string& folder) {
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
    processes_.emplace_back(host_, network_, kernel_, card_, child,
                            static_cast<std::uint32_t>(number));
  }

  // `on_end` gets the last words of the first program that ends by itself.
  Task<void> run(std::optional<Nanoseconds> duration,
                 std::function<void(const std::string&)> on_end) {
    std::vector<Task<void>> tasks;
    for (PeerId peer = 0; peer < hosts_; ++peer) {
      if (peer == host_.id()) continue;
      tasks.push_back(network_.pump(peer));
      tasks.push_back(network_.streams().pump(peer));
    }
    tasks.push_back(network_.stamp_departures());
    tasks.push_back(network_.answer_refused());
    tasks.push_back(kernel_.run());
    for (Process& process : processes_) tasks.push_back(serve(process, on_end));
    if (duration) tasks.push_back(stop_after(*duration));
    co_await join_all(std::move(tasks));
  }

 private:
  Task<void> serve(Process& process, std::function<void(const std::string&)> on_end) {
    const TrueTime begin = host_.true_now();
    co_await process.serve();
    if (process.ending().empty() || std::exchange(has_failed_, true)) co_return;
    const double after_s = to_seconds(host_.true_now() - begin);
    on_end(after_s < 1 ? process.ending()
                       : fmt::format("after {:.0f} s {}", after_s, process.ending()));
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
  bool has_failed_ = false;
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
  std::vector<std::string> notes;
  for (const auto& [ending, hosts] : endings_) {
    notes.push_back(fmt::format("{} {}: {}", hosts.size() == 1 ? "host" : "hosts",
                                fmt::join(hosts, ", "), ending));
  }
  return notes;
}

std::string ProgramSync::make_folder(SimHost& host) {
  std::filesystem::path folder;
  if (settings_.log_folder.empty()) {
    if (temporary_ == nullptr) temporary_ = std::make_unique<TemporaryFolder>();
    folder = temporary_->path();
  } else {
    folder = std::filesystem::absolute(settings_.log_folder) / settings_.pipeline /
             fmt::format("seed{}", host.world().run_seed);
  }
  folder /= fmt::format("host{}", host.id());
  return processes::make_folder(folder, settings_.programs, places_of(host));
}

void ProgramSync::fail(Host& host, const std::string& ending) {
  endings_[ending].insert(host.id());
  host.report_outcome({.slave = host.id(),
                       .synchronised = false,
                       .passes = 0,
                       .message = fmt::format("host {}: {}", host.id(), ending)});
}

Task<void> ProgramSync::run(Host& host, std::vector<HostPrograms::Command> commands) {
  SimHost& own = simulated(host);
  RunningPrograms programs(own, settings_.hosts);
  const std::string folder = make_folder(own);
  for (const HostPrograms::Command& command : commands) {
    programs.start(command, settings_, folder);
  }
  std::optional<Nanoseconds> duration;
  if (!settings_.programs.run_during_capture) duration = warm_up();
  co_await programs.run(duration, [this, &host](const std::string& ending) { fail(host, ending); });
}

Task<void> ProgramSync::run_master(Host& host, std::vector<PeerId> /*slaves*/) {
  return run(host, settings_.programs.master);
}

Task<void> ProgramSync::run_slave(Host& host, PeerId /*master*/) {
  return run(host, settings_.programs.slave);
}

}  // namespace simbench::sim
