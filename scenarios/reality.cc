#include "scenarios/reality.h"

#include <nlohmann/json.hpp>

#include "scenarios/builtin_files.h"
#include "scenarios/scenario_json.h"

namespace simbench::scenarios {
namespace {

using nlohmann::json;

std::string json_text(const json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

RealitySetting setting_of(const json& in) {
  RealitySetting setting{.name = in.at("name"),
                         .scenario = in.at("scenario"),
                         .set = {},
                         .pipeline = in.at("pipeline"),
                         .host = in.at("host"),
                         .quantity = in.at("quantity"),
                         .measured_us = in.at("measured_us"),
                         .factor = in.at("factor"),
                         .used_for = in.at("used_for")};
  for (const auto& [pointer, value] : in.at("set").items()) {
    setting.set.push_back({.pointer = pointer, .value = json_text(value)});
  }
  return setting;
}

UnknownParameter unknown_of(const json& in) {
  UnknownParameter unknown{.what = in.at("what"),
                           .pointer = in.at("pointer"),
                           .nominal = json_text(in.at("nominal")),
                           .values = {},
                           .source = in.at("source")};
  for (const json& value : in.at("values")) unknown.values.push_back(json_text(value));
  return unknown;
}

RealRecording recording_of(const BuiltinFile& file) {
  const json in = json::parse(file.text);
  RealRecording recording{.name = std::string(file.name),
                          .title = in.at("title"),
                          .source = in.at("source"),
                          .instrument = in.at("instrument"),
                          .duration_s = in.at("duration_s"),
                          .from_s = in.at("from_s"),
                          .seeds = in.at("seeds"),
                          .settings = {},
                          .unknown = {}};
  for (const json& setting : in.at("settings")) recording.settings.push_back(setting_of(setting));
  for (const json& unknown : in.at("unknown")) recording.unknown.push_back(unknown_of(unknown));
  return recording;
}

}  // namespace

const std::vector<RealRecording>& real_recordings() {
  static const std::vector<RealRecording> all = [] {
    std::vector<RealRecording> recordings;
    for (const BuiltinFile& file : recording_files()) recordings.push_back(recording_of(file));
    return recordings;
  }();
  return all;
}

}  // namespace simbench::scenarios
