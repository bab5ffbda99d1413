#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <variant>

#include "algorithms/device_time/variants.h"
#include "algorithms/registry.h"
#include "cli/command.h"
#include "cli/commands/commands.h"
#include "cli/parameter_text.h"
#include "recording/collected.h"
#include "recording/text_fields.h"
#include "reports/text/block.h"
#include "reports/text/plain_text.h"
#include "scenarios/document.h"
#include "scenarios/units.h"

namespace simbench::cli {
namespace {

using nlohmann::ordered_json;
using reports::Align;
using scenarios::InputError;

constexpr const char* kDescribeExamples = R"(
Examples:
  simbench describe 18cam_6host_45fps
  simbench describe 18cam_6host_45fps /hosts/clock                   only what is below it
  simbench describe two_way_hull                                     an algorithm
  simbench describe my_rig.json --set /trigger/rate_hz=30
  simbench describe 18cam_6host_45fps --format json > my_rig.json    a start for your own)";

struct DescribeOptions {
  std::string what;
  std::string prefix;
  std::vector<std::string> sets;
  std::string format;
};

// Shortens a long text or list, which --format json has in full.
std::string shortened(const std::string& value) {
  constexpr std::size_t kLongest = 40;
  return value.size() <= kLongest ? value : value.substr(0, kLongest - 3) + "...";
}

// The lines whose pointers begin with the prefix. Throws InputError if there are none.
std::vector<scenarios::ParameterLine> lines_below(const scenarios::Scenario& scenario,
                                                  const std::string& prefix) {
  std::vector<scenarios::ParameterLine> lines = scenarios::describe(scenario);
  std::vector<std::string> known;
  for (const scenarios::ParameterLine& line : lines) {
    for (std::size_t end = line.pointer.find('/', 1); end != std::string::npos;
         end = line.pointer.find('/', end + 1)) {
      known.push_back(line.pointer.substr(0, end));
    }
    known.push_back(line.pointer);
  }
  std::erase_if(lines, [&](const auto& line) { return !line.pointer.starts_with(prefix); });
  if (!lines.empty()) return lines;
  std::ranges::sort(known);
  known.erase(std::unique(known.begin(), known.end()), known.end());
  const std::vector<std::string> similar = scenarios::nearest(prefix, known);
  throw InputError(fmt::format(
      "found no parameter whose pointer begins with '{}'{}; `simbench describe {}` lists all",
      scenarios::shown_text(prefix),
      similar.empty() ? "" : fmt::format(", did you mean {}", fmt::join(similar, " or ")),
      scenario.name));
}

std::string parameters_text(const scenarios::Scenario& scenario, const std::string& prefix) {
  reports::Table table({{"parameter", Align::kLeft},
                        {"value"},
                        {"unit", Align::kLeft},
                        {"meaning", Align::kLeft},
                        {"source", Align::kLeft}});
  for (const scenarios::ParameterLine& line : lines_below(scenario, prefix)) {
    table.add({line.pointer, shortened(line.value), line.unit, line.meaning, line.source});
  }
  std::string head = reports::wrapped(scenarios::named(scenario.name, scenario.derivation) + ": " +
                                      scenario.summary);
  for (const std::string& line : scenarios::derivation_lines(scenario.derivation)) {
    head += reports::wrapped(line);
  }
  return head + "\n" + plain(table);
}

std::string pointers_text(const scenarios::Scenario& scenario, const std::string& prefix) {
  std::string text;
  for (const scenarios::ParameterLine& line : lines_below(scenario, prefix)) {
    text += line.pointer + "\n";
  }
  return text;
}

// The part of the resolved scenario at a pointer. Throws InputError if there is none.
std::string scenario_json(const scenarios::Scenario& scenario, const std::string& pointer) {
  if (pointer.empty()) return printable_json(scenario.resolved_json()) + "\n";
  lines_below(scenario, pointer);
  try {
    return printable_json(ordered_json::parse(scenario.resolved_json())
                              .at(ordered_json::json_pointer(pointer))
                              .dump(2)) +
           "\n";
  } catch (const ordered_json::exception&) {
    throw InputError(
        fmt::format("found '{}', allowed with --format json: the whole pointer of a "
                    "member",
                    scenarios::shown_text(pointer)));
  }
}

int describe_scenario(const DescribeOptions& options) {
  const scenarios::Scenario scenario =
      scenarios::load_scenario(options.what, overrides_of(options.sets));
  const std::string text = options.format == "json"    ? scenario_json(scenario, options.prefix)
                           : options.format == "names" ? pointers_text(scenario, options.prefix)
                                                       : parameters_text(scenario, options.prefix);
  print_warnings(scenarios::warnings(scenario));
  print_result(text);
  return kOk;
}

// An algorithm, and the stage of a pipeline that it is.
struct Described {
  const char* stage;
  const AlgorithmInfo* info;
};

// Returns the algorithms of a name, in all stages; without any, those of a family. A device_time
// may have the suffixes of its variants.
std::vector<Described> algorithms_called(const std::string& name) {
  std::vector<Described> all;
  for (const StageInfo& stage : kPipelineStages) {
    for (const AlgorithmInfo* const info : algorithms_of(stage.id)) {
      all.push_back({stage.name, info});
    }
  }
  const auto chosen = [&all](const auto& is_meant) {
    std::vector<Described> found;
    std::ranges::copy_if(all, std::back_inserter(found), is_meant);
    return found;
  };
  std::vector<Described> found = chosen([&](const Described& d) { return d.info->name == name; });
  if (!found.empty()) return found;
  found = chosen([&](const Described& d) { return d.info->family == name; });
  if (!found.empty()) return found;
  const std::string base = parse_device_time_name(name).base;
  const AlgorithmInfo* const info = find_algorithm(PipelineStage::kDeviceTime, base);
  if (info == nullptr) return {};
  return {{name_of(PipelineStage::kDeviceTime), info}};
}

ordered_json value_json(const ParameterValue& value) {
  return std::visit([](const auto& held) { return ordered_json(held); }, value);
}

std::string described_text(const Described& described) {
  const AlgorithmInfo& info = *described.info;
  std::string text = reports::wrapped(fmt::format("{}: {}", info.name, info.summary));
  text += reports::wrapped(
      fmt::format("A {}, of the family {}. Source: {}", described.stage, info.family, info.source));
  if (info.parameters.empty()) return text + "It has no parameters.\n";
  const std::string alone =
      info.family == info.name
          ? ""
          : fmt::format(" (for all of the family) or /algorithms/{}", info.name);
  text += reports::wrapped(fmt::format(
              "Parameters, in a scenario below /algorithms/{}{}:", info.family, alone)) +
          "\n";
  reports::Table table({{"parameter", Align::kLeft},
                        {"default"},
                        {"allowed", Align::kLeft},
                        {"unit", Align::kLeft},
                        {"meaning", Align::kLeft},
                        {"source", Align::kLeft}});
  for (const ParameterSpec& spec : info.parameters) {
    table.add({spec.name, default_text(spec), range_text(spec), scenarios::unit_in_name(spec.name),
               spec.meaning, spec.source});
  }
  return text + plain(table);
}

ordered_json algorithm_json(const Described& described) {
  const AlgorithmInfo& info = *described.info;
  ordered_json json = {{"name", info.name},     {"stage", described.stage},
                       {"family", info.family}, {"summary", info.summary},
                       {"source", info.source}, {"parameters", ordered_json::array()}};
  for (const ParameterSpec& spec : info.parameters) {
    ordered_json parameter = {{"name", spec.name}, {"default", value_json(spec.fallback)}};
    if (std::holds_alternative<double>(spec.fallback)) {
      parameter.update({{"low", spec.low}, {"high", spec.high}});
    }
    if (!spec.choices.empty()) parameter["choices"] = spec.choices;
    if (!spec.not_below.empty()) parameter["not_below"] = spec.not_below;
    parameter.update({{"unit", scenarios::unit_in_name(spec.name)},
                      {"meaning", spec.meaning},
                      {"source", spec.source}});
    json["parameters"].push_back(std::move(parameter));
  }
  return json;
}

int describe_algorithms(const DescribeOptions& options, const std::vector<Described>& described) {
  if (!options.prefix.empty() || !options.sets.empty()) {
    throw InputError(fmt::format("{}: allowed with a scenario, but {} is an algorithm",
                                 options.prefix.empty() ? "--set" : options.prefix, options.what));
  }
  std::string text;
  ordered_json all = ordered_json::array();
  for (const Described& each : described) {
    if (options.format == "json") {
      all.push_back(algorithm_json(each));
    } else if (options.format == "names") {
      for (const ParameterSpec& spec : each.info->parameters) text += spec.name + "\n";
    } else {
      text += (text.empty() ? "" : "\n") + described_text(each);
    }
  }
  print_result(options.format == "json" ? all.dump(2) + "\n" : text);
  return kOk;
}

// A file counts before a scenario, and that before an algorithm.
int describe(const DescribeOptions& options) {
  const std::vector<scenarios::BuiltinScenario> builtin = scenarios::builtin_scenarios();
  const bool is_scenario =
      options.what.ends_with(".json") || std::filesystem::is_regular_file(options.what) ||
      std::ranges::count(builtin, options.what, &scenarios::BuiltinScenario::name) > 0;
  if (is_scenario) return describe_scenario(options);
  const std::vector<Described> described = algorithms_called(options.what);
  if (!described.empty()) return describe_algorithms(options, described);
  std::vector<std::string> known = collected(builtin, &scenarios::BuiltinScenario::name);
  for (const StageInfo& stage : kPipelineStages) {
    for (const AlgorithmInfo* const info : algorithms_of(stage.id)) known.push_back(info->name);
  }
  const std::vector<std::string> similar = scenarios::nearest(options.what, known);
  throw InputError(
      fmt::format("found \"{}\", {} (`simbench list` names scenarios and algorithms)",
                  scenarios::shown_text(options.what),
                  similar.empty() ? "allowed: a scenario, the path of a .json file, or an algorithm"
                                  : fmt::format("did you mean {}?", fmt::join(similar, " or "))));
}

}  // namespace

void add_describe_command(CommandLine& line) {
  auto options = std::make_shared<DescribeOptions>();
  Command command(line, "describe",
                  "Print every parameter of a scenario or an algorithm, with unit and source");
  command
      .text("scenario", "SCENARIO", options->what,
            "Name of a scenario, path of a scenario file, or name of an algorithm or family")
      .required();
  command.text("prefix", "/POINTER", options->prefix,
               "Only parameters of the scenario whose pointers begin so");
  command.sets(options->sets);
  command.python();
  command.format(options->format, {"table", "names", "json"});
  command.footer(kDescribeExamples);
  command.runs([options] { return describe(*options); });
}

}  // namespace simbench::cli
