#include "sim/programs/program_sync.h"

#include <fmt/format.h>

#include <boost/algorithm/string/replace.hpp>
#include <deque>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <utility>

#include "algorithms/host_sync/join.h"
#include "sim/host/sim_host.h"
#include "sim/programs/process.h"

namespace simbench::sim {
namespace {

std::string dotted(std::uint32_t address) {
  return fmt::format("{}.{}.{}.{}", address >> 24, address >> 16 & 255, address >> 8 & 255,
                     address & 255);
}

// The programs of one host.
class HostPrograms {
 public:
  HostPrograms(SimHost& host, const ProgramSettings& settings,
               const std::vector<ProgramSettings::Command>& commands)
      : host_(host),
        settings_(settings),
        folder_(std::filesystem::path(settings.folder) / fmt::format("host{}", host.id())),
        network_(host, settings.hosts),
        kernel_(host),
        card_(host) {
    std::filesystem::create_directories(folder_);
    for (const auto& [name, content] : settings.files) {
      std::ofstream(folder_ / name) << filled(content);
    }
    for (const ProgramSettings::Command& command : commands) start(command);
  }

  Task<void> run() {
    std::vector<Task<void>> tasks;
    for (PeerId peer = 0; peer < settings_.hosts; ++peer) {
      if (peer == host_.id()) continue;
      tasks.push_back(network_.pump(peer));
      tasks.push_back(network_.streams().pump(peer));
    }
    tasks.push_back(network_.stamp_departures());
    for (Process& process : processes_) tasks.push_back(serve(process));
    co_await join_all(std::move(tasks));
  }

 private:
  std::string filled(std::string text) const {
    const std::pair<const char*, std::string> places[] = {
        {"{master}", dotted(HostNetwork::address_of(0))},
        {"{address}", dotted(network_.address())},
        {"{host}", std::to_string(host_.id())},
        {"{files}", "."}};
    for (const auto& [place, value] : places) boost::replace_all(text, place, value);
    return text;
  }

  void start(const ProgramSettings::Command& command) {
    Child::Settings child{.command = {},
                          .environment = {},
                          .folder = folder_.string(),
                          .log_name = fmt::format("program{}.log", processes_.size()),
                          .shim = settings_.shim};
    for (const std::string& word : command) child.command.push_back(filled(word));
    for (const auto& [name, value] : settings_.environment) {
      child.environment[name] = filled(value);
    }
    const auto number = static_cast<std::uint32_t>(processes_.size());
    processes_.emplace_back(host_, network_, kernel_, card_, child, number);
  }

  Task<void> serve(Process& process) {
    co_await process.serve();
    if (std::exchange(has_failed_, true)) co_return;
    host_.report_outcome({.slave = host_.id(),
                          .synchronised = false,
                          .passes = 0,
                          .message = fmt::format("host {}: {}", host_.id(), process.ending())});
  }

  SimHost& host_;
  const ProgramSettings& settings_;
  std::filesystem::path folder_;
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

Task<void> ProgramSync::run_master(Host& host, std::vector<PeerId> /*slaves*/) {
  HostPrograms programs(simulated(host), settings_, settings_.master);
  co_await programs.run();
}

Task<void> ProgramSync::run_slave(Host& host, PeerId /*master*/) {
  HostPrograms programs(simulated(host), settings_, settings_.slave);
  co_await programs.run();
}

}  // namespace simbench::sim
