// A scenario as JSON: what the structs that are made from scenarios/schema.json are read with, and
// the sections that they do not have.
//
//   const nlohmann::json document = scenario;
//   const auto again = document.get<Scenario>();
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <variant>

#include "scenarios/scenario.h"

template <>
struct nlohmann::adl_serializer<simbench::scenarios::ParameterValue> {
  static void to_json(json& out, const simbench::scenarios::ParameterValue& value) {
    std::visit([&out](const auto& alternative) { out = alternative; }, value);
  }
  static void from_json(const json& in, simbench::scenarios::ParameterValue& value) {
    if (in.is_boolean()) {
      value = in.get<bool>();
    } else if (in.is_number()) {
      value = in.get<double>();
    } else {
      value = in.get<std::string>();
    }
  }
};

// A choice is its word; the schema allows no other.
template <simbench::scenarios::Choice Enum>
struct nlohmann::adl_serializer<Enum, void> {
  static void to_json(json& out, Enum value) {
    out = std::string(simbench::scenarios::to_text(value));
  }
  static void from_json(const json& in, Enum& value) {
    value = simbench::scenarios::from_text<Enum>(in.get_ref<const std::string&>()).value();
  }
};

// A fault is its kind and the members of this kind.
template <>
struct nlohmann::adl_serializer<simbench::scenarios::Fault> {
  static void to_json(json& out, const simbench::scenarios::Fault& fault) {
    std::visit(
        [&out](const auto& stated) {
          out = stated;
          out["kind"] = stated.kKind;
        },
        fault);
  }
  static void from_json(const json& in, simbench::scenarios::Fault& fault) { read(in, fault); }

 private:
  template <class... Kinds>
  static void read(const json& in, std::variant<Kinds...>& fault) {
    const auto& kind = in.at("kind").get_ref<const std::string&>();
    ((kind == Kinds::kKind ? void(fault = in.get<Kinds>()) : void()), ...);
  }
};

// What a scenario does without has null, or no member.
template <class T>
struct nlohmann::adl_serializer<std::optional<T>> {
  static void to_json(json& out, const std::optional<T>& value) {
    out = value ? json(*value) : json();
  }
  static void from_json(const json& in, std::optional<T>& value) {
    if (in.is_null()) {
      value.reset();
    } else {
      value = in.get<T>();
    }
  }
};

namespace simbench::scenarios {

// The schema requires this member.
template <class Member>
void read_member(const nlohmann::json& in, const char* key, Member& member) {
  in.at(key).get_to(member);
}

// Leaves the member as it is if it is not there.
template <class Member>
void read_if_there(const nlohmann::json& in, const char* key, Member& member) {
  const auto found = in.find(key);
  if (found != in.end()) found->get_to(member);
}

// A host_sync is the name of an algorithm, or an object with programs.
void to_json(nlohmann::json& out, const Pipeline& pipeline);
void from_json(const nlohmann::json& in, Pipeline& pipeline);

// Without what loading adds (derivation, resolved_json, origin).
void to_json(nlohmann::json& out, const Scenario& scenario);
void from_json(const nlohmann::json& in, Scenario& scenario);

}  // namespace simbench::scenarios
