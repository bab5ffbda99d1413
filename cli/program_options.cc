#include "cli/program_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <boost/algorithm/string/replace.hpp>
#include <cstddef>
#include <filesystem>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "app/program_pipelines.h"
#include "cli/messages.h"
#include "scenarios/document.h"
#include "scenarios/input_file.h"
#include "scenarios/loader.h"
#include "scenarios/scenario_json.h"

namespace simbench::cli {
namespace {

using nlohmann::json;
using scenarios::InputError;

constexpr const char* kBuiltin = "leaderboard_programs";  // the scenario with the built-in rows
constexpr std::size_t kMostBytes = std::size_t{4} << 20;

struct NamedProgram {
  std::string name;
  json pipeline;
};

NamedProgram builtin(const std::string& name, const std::string& label) {
  std::vector<std::string> known;
  for (const scenarios::Pipeline& pipeline : scenarios::load_scenario(kBuiltin).pipelines) {
    if (!pipeline.programs) continue;
    if (pipeline.name == name) {
      return {name, {{"host_sync", {{"program", *pipeline.programs}}}}};
    }
    known.push_back(pipeline.name);
  }
  throw InputError(fmt::format("{}: found no file, allowed: NAME=FILE.json, or one of {}", label,
                               fmt::join(known, ", ")));
}

// {here} in the file is its folder.
NamedProgram from_file(const std::string& name, const std::string& path, const std::string& label) {
  try {
    const std::filesystem::path here = std::filesystem::absolute(path).parent_path();
    const std::string quoted = json(here.lexically_normal().string()).dump();
    std::string text = file_content(path, kMostBytes);
    boost::replace_all(text, "{here}", quoted.substr(1, quoted.size() - 2));
    json pipeline = scenarios::parse_document(text).root;
    if (!pipeline.is_object() || !pipeline.contains("host_sync")) {
      throw InputError(label +
                       ": found no \"host_sync\", allowed: {\"host_sync\": {\"program\": ...}}");
    }
    return {name, std::move(pipeline)};
  } catch (const FileError& error) {
    throw InputError(fmt::format("{}: {}", label, error.what()));
  } catch (const scenarios::DocumentError& error) {
    throw InputError(fmt::format("{}: {}", label, error.what()));
  }
}

NamedProgram read_program(const std::string& text, const std::string& label) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) return builtin(text, label);
  return from_file(text.substr(0, equals), text.substr(equals + 1), label);
}

}  // namespace

std::vector<std::string> program_remarks(const scenarios::Scenario& scenario,
                                         const std::vector<std::string>& pipelines) {
  std::set<std::string> remarks;
  for (const scenarios::Pipeline& pipeline : scenario.pipelines) {
    if (!pipelines.empty() && std::ranges::find(pipelines, pipeline.name) == pipelines.end())
      continue;
    for (std::string& remark : app::program_remarks(pipeline)) {
      remarks.insert(std::move(remark));
    }
  }
  return {remarks.begin(), remarks.end()};
}

std::vector<scenarios::Override> program_pipelines(const std::vector<std::string>& programs,
                                                   const scenarios::Pipeline& first,
                                                   std::vector<std::string>& pipelines) {
  std::vector<scenarios::Override> overrides;
  for (const std::string& text : programs) {
    const std::string label = "--program " + scenarios::shown_text(text);
    NamedProgram program = read_program(text, label);
    program.pipeline["name"] = program.name;
    program.pipeline.emplace("device_time", first.device_time);
    program.pipeline.emplace("gathering", first.gathering);
    overrides.push_back({"/pipelines/-", program.pipeline.dump(), label});
    if (!pipelines.empty() && std::ranges::find(pipelines, program.name) == pipelines.end()) {
      pipelines.push_back(program.name);
    }
  }
  return overrides;
}

void add_program_options(Command& command, ProgramOptions& options) {
  command.texts("--program", "NAME=FILE.json", options.programs,
                "Also run this pipeline, whose hosts are synchronised by real programs,\n"
                "repeatable (docs/your_program.md); a name alone is a built-in one");
  command.output("--program-log", "DIR", options.log_folder,
                 "Keep what programs print, and their files, in DIR/PIPELINE/seed1/host0");
}

scenarios::Scenario load_with_programs(const std::string& scenario,
                                       const std::vector<std::string>& sets,
                                       const ProgramOptions& options,
                                       std::vector<std::string>& pipelines,
                                       evaluation::AdHoc ad_hoc) {
  if (!options.log_folder.empty()) app::use_programs({.log_folder = options.log_folder});
  std::vector<scenarios::Override> overrides =
      evaluation::with_ad_hoc_pipelines(scenario, overrides_of(sets), pipelines, ad_hoc);
  scenarios::Scenario loaded = scenarios::load_scenario(scenario, overrides);
  if (!options.programs.empty()) {
    std::ranges::move(program_pipelines(options.programs, loaded.pipelines.front(), pipelines),
                      std::back_inserter(overrides));
    loaded = scenarios::load_scenario(scenario, overrides);
  }
  for (const std::string& remark : program_remarks(loaded, pipelines)) print_note(remark);
  return loaded;
}

}  // namespace simbench::cli
