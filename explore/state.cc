#include "explore/state.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

#include "evaluation/run/ad_hoc_pipelines.h"
#include "evaluation/run/pipeline_choice.h"
#include "recording/collected.h"
#include "reports/archive/archive.h"
#include "scenarios/document.h"
#include "scenarios/scenario_json.h"

namespace simbench::explore {
namespace {

using reports::Json;
using scenarios::Override;
using scenarios::Scenario;

constexpr std::size_t kMostSets = 500;
constexpr std::size_t kMostPipelines = 64;
constexpr std::size_t kLongestName = 300;

// What of a scenario is no value of its world.
constexpr std::array kFixed = {"/pipelines", "/name", "/summary",   "/schema_version",
                               "/$schema",   "/base", "/published", "/published_figures",
                               "/fitted_to"};

[[noreturn]] void refuse_form(const std::string& what) {
  throw StateRefused("", "the page sent " + what);
}

std::string name_in(const Json& value, const char* what) {
  if (!value.is_string() || value.get_ref<const std::string&>().size() > kLongestName) {
    refuse_form(fmt::format("no short text as {}", what));
  }
  return value.get<std::string>();
}

bool is_below(const std::string& pointer, const std::string& parent) {
  return pointer == parent || pointer.starts_with(parent + '/');
}

Override set_in(const Json& json) {
  if (!json.is_object() || !json.contains("pointer") || !json.contains("value")) {
    refuse_form("a change without pointer and value");
  }
  Override change{.pointer = name_in(json.at("pointer"), "a pointer"),
                  .value = json.at("value").dump()};
  if (!is_of_a_world(change.pointer)) {
    throw StateRefused(change.pointer, "is no parameter of a world");
  }
  change.label = change.pointer;
  return change;
}

const Json& list_in(const Json& json, const char* member, std::size_t most) {
  static const Json none = Json::array();
  const auto found = json.find(member);
  if (found == json.end()) return none;
  if (!found->is_array() || found->size() > most) {
    refuse_form(fmt::format("no list of at most {} as {}", most, member));
  }
  return *found;
}

// The changes of the command line come first: they belong to what the user named.
std::vector<Override> all_sets(const State& state, const PageSubject& subject) {
  std::vector<Override> sets;
  if (state.scenario == subject.name) sets = subject.sets;
  sets.insert(sets.end(), state.sets.begin(), state.sets.end());
  return sets;
}

// The parameter that a message is about: the longest pointer of a change that it names.
std::string blamed(const std::string& message, const std::vector<Override>& sets) {
  std::string pointer;
  for (const Override& set : sets) {
    if (set.pointer.size() > pointer.size() && message.find(set.pointer) != std::string::npos) {
      pointer = set.pointer;
    }
  }
  return pointer;
}

// "/trigger/rate_hz: found ..." beside the parameter itself is "found ...".
std::string without_place(const std::string& message, const std::string& pointer) {
  const std::string place = pointer + ": ";
  if (pointer.empty() || !message.starts_with(place)) return message;
  return message.substr(place.size());
}

double frames_of_a_run(const Scenario& scenario) {
  double frames = 0;
  for (const scenarios::Stream& stream : scenario.cameras.streams) {
    const double rate_hz = scenario.frame_rate_hz(stream);
    frames += static_cast<double>(scenario.cameras.count) *
              (rate_hz * scenario.timeline.warm_up_ms / 1000 +
               static_cast<double>(scenario.timeline.frames));
  }
  return frames;
}

void check_size(const Scenario& scenario) {
  const double frames = frames_of_a_run(scenario);
  if (frames > kMostFrames || static_cast<std::int64_t>(scenario.hosts.count) > kMostHosts) {
    throw StateRefused(
        "", fmt::format("{:.3g} frames of all cameras and {} hosts a run: found too much to play "
                        "with, allowed {:.0f} frames and {} hosts; simbench run takes any",
                        frames, scenario.hosts.count, kMostFrames, kMostHosts));
  }
}

Scenario loaded(const State& state, const PageSubject& subject) {
  const std::vector<Override> sets =
      evaluation::with_ad_hoc_pipelines(state.scenario, all_sets(state, subject), state.pipelines);
  const bool is_subject = state.scenario == subject.name;
  if (is_subject && subject.text) {
    return scenarios::load_scenario_text(*subject.text, subject.name, sets);
  }
  return scenarios::load_scenario(state.scenario, sets);
}

// Keeps the pipelines of the state; a state without any has all but those of real programs, which
// take minutes.
void keep_pipelines(const State& state, Scenario& scenario) {
  if (state.pipelines.empty()) {
    std::erase_if(scenario.pipelines, [](const auto& each) { return each.programs.has_value(); });
    return;
  }
  std::vector<scenarios::Pipeline> chosen;
  for (const evaluation::PipelineChoice& choice :
       evaluation::choose_pipelines(scenario, state.pipelines)) {
    if (choice.pipeline.programs) {
      throw StateRefused(
          "/pipelines", choice.pipeline.name + " is of real programs, which a page does not start");
    }
    chosen.push_back(choice.pipeline);
  }
  scenario.pipelines = std::move(chosen);
}

// A value as a shell and --set take it: text without quotes.
std::string set_word(const Override& set) {
  const Json value = Json::parse(set.value);
  return set.pointer + '=' + (value.is_string() ? value.get<std::string>() : set.value);
}

// Members of lists are no differences that a file could state by themselves.
bool is_in_list(const Override& set) {
  for (Json::json_pointer at(set.pointer); !at.empty(); at.pop_back()) {
    if (at.back().find_first_not_of("0123456789") == std::string::npos) return true;
  }
  return false;
}

// All of a world, with its pipelines alone.
std::string whole_file(const Scenario& scenario) {
  Json file = Json::parse(scenario.resolved_json());
  Json pipelines = Json::array();
  for (const scenarios::Pipeline& pipeline : scenario.pipelines) {
    for (const Json& each : file["pipelines"]) {
      if (each.at("name") == pipeline.name) pipelines.push_back(each);
    }
  }
  file["pipelines"] = std::move(pipelines);
  return reports::file_text(file);
}

}  // namespace

bool is_of_a_world(const std::string& pointer) {
  return std::ranges::none_of(kFixed, [&](const char* fixed) { return is_below(pointer, fixed); });
}

bool is_builtin_scenario(const std::string& name) {
  const std::vector<scenarios::BuiltinScenario> all = scenarios::builtin_scenarios();
  return std::ranges::count(all, name, &scenarios::BuiltinScenario::name) > 0;
}

State state_of(const Json& json, const PageSubject& subject) {
  if (!json.is_object() || !json.contains("scenario")) refuse_form("a state without a scenario");
  State state{.scenario = name_in(json.at("scenario"), "a scenario")};
  if (state.scenario != subject.name && !is_builtin_scenario(state.scenario)) {
    throw StateRefused("", fmt::format("'{}' is neither a scenario of the distribution nor what "
                                       "this page was started with",
                                       scenarios::shown_text(state.scenario)));
  }
  for (const Json& set : list_in(json, "sets", kMostSets)) state.sets.push_back(set_in(set));
  for (const Json& name : list_in(json, "pipelines", kMostPipelines)) {
    state.pipelines.push_back(name_in(name, "a pipeline"));
  }
  if (json.contains("first_seed")) {
    const Json& seed = json.at("first_seed");
    if (!seed.is_number_unsigned()) refuse_form("no whole number as first_seed");
    state.first_seed = seed.get<std::uint64_t>();
    if (state.first_seed > std::numeric_limits<std::uint64_t>::max() - kMostSeeds) {
      refuse_form("too large a first_seed");
    }
  }
  return state;
}

Scenario world_of(const State& state, const PageSubject& subject) {
  try {
    Scenario scenario = loaded(state, subject);
    check_size(scenario);
    keep_pipelines(state, scenario);
    evaluation::check_pipelines(scenario);
    return scenario;
  } catch (const scenarios::InputError& error) {
    const std::string pointer = blamed(error.what(), state.sets);
    throw StateRefused(pointer, without_place(error.what(), pointer));
  }
}

std::vector<std::string> command_of(const State& state, const PageSubject& subject,
                                    std::uint64_t seeds) {
  std::vector<std::string> words = {"simbench", "run", "--scenario", state.scenario};
  for (const Override& set : all_sets(state, subject)) {
    words.insert(words.end(), {"--set", set_word(set)});
  }
  if (!state.pipelines.empty()) {
    words.insert(words.end(), {"--pipelines", fmt::format("{}", fmt::join(state.pipelines, ","))});
  }
  words.insert(words.end(), {"--seeds", std::to_string(seeds)});
  if (state.first_seed != 1) {
    words.insert(words.end(), {"--first-seed", std::to_string(state.first_seed)});
  }
  return words;
}

std::string python_of(const State& state, const PageSubject& subject, std::uint64_t seeds) {
  const auto quoted = [](const std::string& text) { return Json(text).dump(); };
  std::string text =
      fmt::format("import simbench\n\nresult = simbench.run(\n    {},\n", quoted(state.scenario));
  if (!state.pipelines.empty())
    text += fmt::format("    pipelines={},\n", Json(state.pipelines).dump());
  text += fmt::format("    seeds={},\n", seeds);
  if (state.first_seed != 1) text += fmt::format("    first_seed={},\n", state.first_seed);
  const std::vector<Override> sets = all_sets(state, subject);
  if (!sets.empty()) {
    text += "    set={\n";
    for (const Override& set : sets) {
      const Json value = Json::parse(set.value);
      const std::string shown = value.is_null()      ? "None"
                                : value.is_boolean() ? (value.get<bool>() ? "True" : "False")
                                                     : set.value;
      text += fmt::format("        {}: {},\n", quoted(set.pointer), shown);
    }
    text += "    },\n";
  }
  return text + ")\nprint(result)\n";
}

std::string file_of(const State& state, const PageSubject& subject) {
  const bool is_subject = state.scenario == subject.name;
  const std::vector<Override> sets = all_sets(state, subject);
  const bool has_lists = std::ranges::any_of(sets, is_in_list);
  if (has_lists || !state.pipelines.empty() || (is_subject && subject.text)) {
    return whole_file(world_of(state, subject));
  }
  Json file = {{"schema_version", 1},
               {"name", state.scenario + (sets.empty() ? "" : "_explored")},
               {"summary", "Made by hand in simbench explore, from " + state.scenario + "."},
               {"base", state.scenario}};
  for (const Override& set : sets) {
    file[Json::json_pointer(set.pointer)] = Json::parse(set.value);
  }
  return reports::file_text(file);
}

}  // namespace simbench::explore
