#include "app/program_pipelines.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <stdexcept>
#include <utility>

#include "evaluation/run/pipeline_choice.h"
#include "sim/programs/placeholders.h"
#include "sim/programs/program_sync.h"

namespace simbench::app {
namespace {

using scenarios::HostPrograms;

// Something that programs need and this machine lacks; one line.
class Missing : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// As built, and as installed.
std::string find_shim() {
  const std::filesystem::path own = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  for (const char* place : {"../lib/libsimbench_shim.so", "../lib/simbench/libsimbench_shim.so"}) {
    const std::filesystem::path path = (own / place).lexically_normal();
    if (std::filesystem::exists(path)) return path.string();
  }
  throw Missing(fmt::format("libsimbench_shim.so is not beside {}, where it is installed",
                            own.string()));
}

std::string find_program(const std::string& word) {
  if (word.starts_with("/")) return word;
  for (const char* folder : {"/usr/local/sbin", "/usr/local/bin", "/usr/sbin", "/usr/bin"}) {
    const std::filesystem::path path = std::filesystem::path(folder) / word;
    if (std::filesystem::exists(path)) return path.string();
  }
  throw Missing(fmt::format("{}: not found", word));
}

HostPrograms found(HostPrograms programs) {
  if (const auto unknown = sim::unknown_placeholder(programs)) {
    throw Missing(fmt::format("found the placeholder {}, allowed: {}", *unknown,
                              sim::kPlaceholders));
  }
  for (auto* role : {&programs.master, &programs.slave}) {
    for (HostPrograms::Command& command : *role) command.front() = find_program(command.front());
  }
  return programs;
}

evaluation::ProgramEntry entry_of(const scenarios::Scenario& scenario,
                                  const scenarios::Pipeline& pipeline,
                                  const ProgramOptions& options) {
  sim::ProgramSettings settings{.pipeline = pipeline.name,
                                .programs = *pipeline.programs,
                                .shim = "",
                                .log_folder = options.log_folder,
                                .hosts = static_cast<std::size_t>(scenario.hosts.count)};
  std::string problem;
  try {
    settings.shim = find_shim();
    settings.programs = found(std::move(settings.programs));
  } catch (const Missing& missing) {
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

void use_programs(const ProgramOptions& options) {
  evaluation::set_program_maker(
      [options](const scenarios::Scenario& scenario, const scenarios::Pipeline& pipeline) {
        return entry_of(scenario, pipeline, options);
      });
}

}  // namespace simbench::app
