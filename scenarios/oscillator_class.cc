#include "scenarios/oscillator_class.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "scenarios/builtin_files.h"
#include "scenarios/schema_walk.h"

namespace simbench::scenarios {
namespace {

using nlohmann::json;

OscillatorClass class_of(const nlohmann::ordered_json& in) {
  OscillatorClass result;
  in.at("class").get_to(result.class_name);
  in.at("name").get_to(result.name);
  for (const auto& [member, stated] : in.at("values").items()) {
    result.values.push_back({member, stated.at("value"), stated.at("source")});
  }
  return result;
}

const OscillatorClass& class_at(const Places& places, const std::string& pointer,
                                const std::string& class_name) {
  if (const OscillatorClass* found = find_oscillator_class(class_name)) return *found;
  std::vector<std::string> known;
  for (const OscillatorClass& each : oscillator_classes()) known.push_back(each.class_name);
  throw InputError(fmt::format("{}: found \"{}\", allowed {} (simbench list oscillators)",
                               places.describe(pointer), shown_text(class_name),
                               fmt::join(known, ", ")));
}

// Whole numbers are integers, as in a file (scenarios/document.h).
json number(double value) {
  const auto whole = static_cast<std::int64_t>(value);
  return static_cast<double>(whole) == value ? json(whole) : json(value);
}

// Whether a value stands against a class: it comes from the class's own source or a later one, or
// from a --set.
bool stands(const Place& value, const Place& its_class) {
  return value.is_set || value.level >= its_class.level;
}

}  // namespace

const OscillatorValue* OscillatorClass::find(std::string_view member) const {
  const auto found = std::ranges::find(values, member, &OscillatorValue::member);
  return found == values.end() ? nullptr : &*found;
}

const std::vector<OscillatorClass>& oscillator_classes() {
  static const std::vector<OscillatorClass> classes = [] {
    std::vector<OscillatorClass> all;
    for (const BuiltinFile& file : oscillator_files()) {
      all.push_back(class_of(nlohmann::ordered_json::parse(file.text)));
    }
    return all;
  }();
  return classes;
}

const OscillatorClass* find_oscillator_class(std::string_view class_name) {
  const std::vector<OscillatorClass>& all = oscillator_classes();
  const auto found = std::ranges::find(all, class_name, &OscillatorClass::class_name);
  return found == all.end() ? nullptr : &*found;
}

void apply_oscillator_classes(json& scenario, Places& places) {
  static const std::vector<std::string> oscillators = pointers_that_say("x-type", "Oscillator");
  for (const std::string& oscillator : oscillators) {
    const std::string class_pointer = oscillator + "/class";
    const json::json_pointer at(class_pointer);
    if (!scenario.contains(at) || !scenario[at].is_string()) continue;
    const Place stated = places.nearest(class_pointer);
    const auto& profile = class_at(places, class_pointer, scenario[at].get<std::string>());
    for (const OscillatorValue& value : profile.values) {
      const std::string pointer = child_pointer(oscillator, value.member);
      const json::json_pointer member(pointer);
      if (scenario.contains(member) && stands(places.nearest(pointer), stated)) continue;
      scenario[member] = number(value.value);
      Place place = stated;
      place.profile_source = fmt::format("class {}: {}", profile.class_name, value.source);
      places.set(pointer, std::move(place));
    }
  }
}

}  // namespace simbench::scenarios
