#include "app/program_pipelines.h"

#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include "algorithms/ports/host_sync.h"
#include "app/own_program.h"
#include "evaluation/run/pipeline_choice.h"
#include "hardware/node/node_programs.h"
#include "processes/child.h"
#include "processes/placeholders.h"
#include "recording/number_in.h"
#include "scenarios/document.h"
#include "scenarios/loader.h"
#include "sim/programs/find_program.h"
#include "sim/programs/program_file.h"
#include "sim/programs/program_sync.h"

namespace simbench::app {
namespace {

using scenarios::HostPrograms;

std::filesystem::path own_folder() {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path();
}

// Where the last use_programs() keeps the hosts' folders.
std::string& log_folder_in_use() {
  static std::string folder;
  return folder;
}

// The library lies where it was built, was installed, or where the program says.
std::string find_shim() {
  const std::string& folder = own_program().library_folder;
  if (!folder.empty()) return folder + "/libsimbench_shim.so";
  for (const char* place : {"../lib/libsimbench_shim.so", "../lib/simbench/libsimbench_shim.so"}) {
    const std::filesystem::path path = (own_folder() / place).lexically_normal();
    if (std::filesystem::exists(path)) return path.string();
  }
  throw sim::ProgramError(
      fmt::format("no lib/simbench/libsimbench_shim.so beside {}; is simbench "
                  "installed in full?",
                  own_folder().string()));
}

// The packages that tools/setup has unpacked, of a program that lies in a build folder.
std::string unpacked_packages() {
  const std::filesystem::path packages = (own_folder() / "../../deps").lexically_normal();
  return std::filesystem::is_directory(packages) ? packages.string() : "";
}

// Adds where the programs are and what their libraries need. A bare name stays what a program is
// called, so that its log is the same wherever it lies.
void find(HostPrograms& programs, std::map<std::string, std::string>& paths) {
  if (const auto unknown = processes::unknown_placeholder(programs)) {
    throw sim::ProgramError(
        fmt::format("found the placeholder {}, allowed: {}", *unknown, processes::kPlaceholders));
  }
  for (auto* role : {&programs.master, &programs.slave}) {
    for (HostPrograms::Command& command : *role) {
      const std::string name = command.front();
      const sim::FoundProgram program = sim::find_program(name, unpacked_packages());
      if (program.words.size() == 1) {
        paths[name] = program.words.front();
      } else {  // a script and its interpreter
        command.erase(command.begin());
        command.insert(command.begin(), program.words.begin(), program.words.end());
      }
      if (!program.library_path.empty()) {
        programs.environment["LD_LIBRARY_PATH"] = program.library_path;
      }
    }
  }
}

// How long a program may compute, for those who stop it in a debugger; nothing: as usual.
std::optional<std::chrono::milliseconds> patience() {
  constexpr int kLongest = 86'400;
  const char* const text = std::getenv(kPatienceVariable);
  if (text == nullptr) return std::nullopt;
  const std::optional<int> seconds = number_in<int>(text);
  if (!seconds || *seconds < 1 || *seconds > kLongest) {
    throw scenarios::InputError(
        fmt::format("{}: found '{}', allowed: a whole number of seconds from 1 to {}",
                    kPatienceVariable, scenarios::shown_text(text), kLongest));
  }
  return std::chrono::seconds(*seconds);
}

evaluation::ProgramEntry entry_of(const scenarios::Scenario& scenario,
                                  const scenarios::Pipeline& pipeline,
                                  const ProgramFolders& options) {
  sim::ProgramSettings settings{.pipeline = pipeline.name,
                                .programs = *pipeline.programs,
                                .shim = "",
                                .log_folder = options.log_folder,
                                .patience = patience(),
                                .hosts = static_cast<std::size_t>(scenario.hosts.count)};
  std::string problem;
  try {
    settings.shim = find_shim();
    find(settings.programs, settings.paths);
  } catch (const sim::ProgramError& missing) {
    problem = missing.what();
  }
  HostSyncEntry entry;
  entry.info = {.name = pipeline.host_sync,
                .family = pipeline.host_sync,
                .summary = "real programs",
                .source = "the programs"};
  entry.make = [settings = std::move(settings)](const Parameters&) {
    return std::make_unique<sim::ProgramSync>(settings);
  };
  return {.entry = std::move(entry), .problem = std::move(problem)};
}

}  // namespace

std::unique_ptr<HostSync> make_node_programs(const scenarios::Pipeline& pipeline,
                                             const std::string& interface,
                                             const ProgramFolders& options) {
  const std::string& logs = options.log_folder;
  hardware::NodeProgramSettings settings{
      .programs = pipeline.programs.value(),
      .shim = "",
      .log_folder = logs.empty() ? "" : logs + "/" + pipeline.name,
      .interface = interface};
  try {
    settings.shim = find_shim();
    find(settings.programs, settings.paths);
    return std::make_unique<hardware::NodePrograms>(std::move(settings));
  } catch (const sim::ProgramError& missing) {
    throw scenarios::InputError(fmt::format("pipeline '{}': {}", pipeline.name, missing.what()));
  }
}

std::vector<std::string> program_remarks(const scenarios::Pipeline& pipeline) {
  if (!pipeline.programs) return {};
  HostPrograms programs = *pipeline.programs;
  std::map<std::string, std::string> paths;
  std::set<std::string> remarks;
  try {
    const std::string shim = find_shim();
    find(programs, paths);
    for (const auto* role : {&programs.master, &programs.slave}) {
      for (const HostPrograms::Command& command : *role) {
        const auto path = paths.find(command.front());
        const processes::Child::Settings settings{
            .command = command,
            .program = path == paths.end() ? "" : path->second,
            .environment = programs.environment,
            .folder = log_folder_in_use(),
            .shim = shim,
            .readable = programs.readable};
        remarks.insert(processes::why_root(settings));
      }
    }
  } catch (const sim::ProgramError&) {
    return {};
  }
  remarks.erase("");
  return {remarks.begin(), remarks.end()};
}

void use_programs(const ProgramFolders& options) {
  log_folder_in_use() = options.log_folder;
  evaluation::set_program_maker(
      [options](const scenarios::Scenario& scenario, const scenarios::Pipeline& pipeline) {
        return entry_of(scenario, pipeline, options);
      });
}

}  // namespace simbench::app
