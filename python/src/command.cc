// Command lines within Python: what the package does by the command of the same name.
//
// run_command() runs a command line in this process (cli/embedding.h) as other long work is run
// (work.h): on a thread of its own, without the interpreter's lock, with progress, until Ctrl-C.
// Commands run one after the other; one that waits for its turn holds no lock of the interpreter.
// What the command refuses is raised (errors.cc).
#include <cstddef>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/program_pipelines.h"
#include "cli/embedding.h"
#include "cli/program_options.h"
#include "evaluation/run/ad_hoc_pipelines.h"
#include "python/src/binding.h"
#include "python/src/bindings.h"
#include "python/src/run.h"
#include "python/src/work.h"
#include "scenarios/loader.h"

namespace simbench::python {
namespace {

using scenarios::Override;
std::mutex one_command;  // messages and pages are those of the process

struct Ended {
  int status = 0;
  std::map<std::string, std::string> results{};
  std::string output{};
  std::vector<cli::EmbeddedMessage> messages{};
};

Ended run_within(const std::vector<std::string>& arguments, std::vector<std::string> formats,
                 std::optional<std::size_t> columns, const evaluation::Progress& progress) {
  const std::lock_guard lock(one_command);
  cli::Embedding within{.formats = std::move(formats), .columns = columns, .progress = progress};
  Ended ended;
  ended.status = cli::run_embedded(arguments, within);
  ended.results = std::move(within.results);
  ended.output = within.output.str();
  ended.messages = std::move(within.messages);
  return ended;
}

// (status, {format: text}, output, [(kind, text)])
Object run_command(const std::vector<std::string>& arguments,
                   const std::vector<std::string>& formats, std::optional<std::size_t> columns,
                   const Object& on_progress) {
  const Ended ended = watched<Ended>(on_progress, [&](const evaluation::Progress& progress) {
    return run_within(arguments, formats, columns, progress);
  });
  Object results = dict();
  for (const auto& [format, text] : ended.results) results.set(format.c_str(), text);
  std::vector<std::pair<std::string, std::string>> messages;
  messages.reserve(ended.messages.size());
  for (const cli::EmbeddedMessage& each : ended.messages) {
    messages.emplace_back(each.kind, each.text);
  }
  return python_tuple(
      {to_python(ended.status), results, to_python(ended.output), to_python(messages)});
}

// The changes that add these programs to a scenario with `sets`, the pipelines to choose, and what
// is to be known of them: ([(pointer, value)], [name], [note]).
Object program_pipelines(const std::string& scenario, const Sets& sets,
                         const std::vector<std::string>& programs,
                         std::vector<std::string> pipelines) {
  std::vector<Override> overrides;
  for (const auto& [pointer, value] : sets) overrides.push_back({pointer, value});
  overrides = evaluation::with_ad_hoc_pipelines(scenario, std::move(overrides), pipelines,
                                                evaluation::AdHoc::kHostSyncToo);
  const auto first = scenarios::load_scenario(scenario, overrides).pipelines.front();
  const std::vector<Override> added = cli::program_pipelines(programs, first, pipelines);
  overrides.insert(overrides.end(), added.begin(), added.end());
  const scenarios::Scenario loaded = scenarios::load_scenario(scenario, overrides);
  Sets changes;
  changes.reserve(added.size());
  for (const Override& each : added) changes.emplace_back(each.pointer, each.value);
  return python_tuple({to_python(changes), to_python(pipelines),
                       to_python(cli::program_remarks(loaded, pipelines))});
}

void keep_program_files(const std::string& folder) { app::use_programs({.log_folder = folder}); }

}  // namespace

void bind_command(const Object& module) {
  add_functions(module, {function("run_command", callable<&run_command>),
                         function("program_pipelines", callable<&program_pipelines>),
                         function("keep_program_files", callable<&keep_program_files>)});
}

}  // namespace simbench::python
