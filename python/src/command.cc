#include "python/src/command.h"

#include <pybind11/stl.h>

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
#include "python/src/run.h"
#include "python/src/work.h"
#include "scenarios/loader.h"

namespace py = pybind11;

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

// A text may name a file, whose name may be any bytes.
py::str text_of(const std::string& text) {
  return py::reinterpret_steal<py::str>(
      PyUnicode_DecodeUTF8(text.data(), static_cast<Py_ssize_t>(text.size()), "replace"));
}

// (status, {format: text}, output, [(kind, text)])
py::tuple run_command(const std::vector<std::string>& arguments,
                      const std::vector<std::string>& formats, std::optional<std::size_t> columns,
                      const py::object& on_progress) {
  const Ended ended = watched<Ended>(on_progress, [&](const evaluation::Progress& progress) {
    return run_within(arguments, formats, columns, progress);
  });
  py::dict results;
  for (const auto& [format, text] : ended.results) results[text_of(format)] = text_of(text);
  py::list messages;
  for (const cli::EmbeddedMessage& message : ended.messages) {
    messages.append(py::make_tuple(message.kind, text_of(message.text)));
  }
  return py::make_tuple(ended.status, results, text_of(ended.output), messages);
}

// The changes that add these programs to a scenario with `sets`, the pipelines to choose, and what
// is to be known of them: ([(pointer, value)], [name], [note]).
py::tuple program_pipelines(const std::string& scenario, const Sets& sets,
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
  return py::make_tuple(changes, pipelines, cli::program_remarks(loaded, pipelines));
}

}  // namespace
}  // namespace simbench::python

void bind_command(pybind11::module_& module) {
  using namespace simbench::python;
  module.def("run_command", &run_command);
  module.def("program_pipelines", &program_pipelines);
  module.def("keep_program_files", &simbench::app::keep_program_files);
}
