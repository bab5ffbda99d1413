#include "scenarios/reality.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

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
                         .load = in.at("load"),
                         .recorded_ratio = in.at("recorded_ratio"),
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
                          .pairs_with = in.at("pairs_with"),
                          .settings = {},
                          .unknown = {}};
  for (const json& setting : in.at("settings")) recording.settings.push_back(setting_of(setting));
  for (const json& unknown : in.at("unknown")) recording.unknown.push_back(unknown_of(unknown));
  return recording;
}

bool has_traffic(const Scenario& scenario, TrafficKind kind) {
  return std::ranges::any_of(scenario.network.traffic,
                             [kind](const Traffic& traffic) { return traffic.kind == kind; });
}

bool has_load(const Scenario& scenario, RealityLoad load) {
  switch (load) {
    case RealityLoad::kNone:
      return false;
    case RealityLoad::kTcp:
      return has_traffic(scenario, TrafficKind::kTcp);
    case RealityLoad::kPaced:
      return has_traffic(scenario, TrafficKind::kPaced);
    case RealityLoad::kRandom:
      return has_traffic(scenario, TrafficKind::kRandom);
    case RealityLoad::kCpu:
      return scenario.hosts.cpu_load.has_value();
    case RealityLoad::kDisk:
      return scenario.hosts.io_load.has_value();
    case RealityLoad::kSteal:
      return scenario.hosts.steal.has_value();
  }
  return false;
}

const char* load_name(RealityLoad load) {
  switch (load) {
    case RealityLoad::kNone:
      return "no load";
    case RealityLoad::kTcp:
      return "saturating TCP";
    case RealityLoad::kPaced:
      return "paced traffic";
    case RealityLoad::kRandom:
      return "random traffic";
    case RealityLoad::kCpu:
      return "busy processors";
    case RealityLoad::kDisk:
      return "disk I/O";
    case RealityLoad::kSteal:
      return "stolen processors";
  }
  return "";
}

// How many steps a host is from the master.
std::size_t hops_of(const Hosts& hosts, std::size_t host) {
  std::size_t hops = 0;
  for (auto at = static_cast<std::uint32_t>(host); at != 0; at = followed_host(hosts, at)) ++hops;
  return hops;
}

std::size_t most_hops(const Hosts& hosts) {
  std::size_t most = 0;
  for (std::int64_t host = 1; host < hosts.count; ++host) {
    most = std::max(most, hops_of(hosts, static_cast<std::size_t>(host)));
  }
  return most;
}

// A recorded ratio under load.
struct LoadedRatio {
  RealityLoad load{};
  std::size_t hops = 0;
  double factor = 1;  // by which it is off, either way
  std::string recording;
  bool is_known = false;
};

// Made once: it loads their scenarios.
const std::vector<LoadedRatio>& loaded_ratios() {
  static const std::vector<LoadedRatio> all = [] {
    std::vector<LoadedRatio> ratios;
    for (const RealRecording& recording : real_recordings()) {
      for (const RealitySetting& setting : recording.settings) {
        if (setting.load == RealityLoad::kNone) continue;
        ratios.push_back(
            {.load = setting.load,
             .hops = hops_of(load_scenario(setting.scenario, setting.set).hosts, setting.host),
             .factor = std::max(setting.recorded_ratio, 1 / setting.recorded_ratio),
             .recording = recording.name,
             .is_known = !setting.used_for.empty()});
      }
    }
    return ratios;
  }();
  return all;
}

// The furthest off of the recorded ratios of a kind of load.
struct FurthestOff {
  std::map<std::size_t, double> factors;  // by hops from the master
  std::set<std::string> recordings;
  bool is_known = false;  // one of them at least
};

FurthestOff furthest_off(RealityLoad load, std::size_t hops) {
  FurthestOff furthest;
  for (const LoadedRatio& ratio : loaded_ratios()) {
    if (ratio.load != load || ratio.hops > hops) continue;
    double& factor = furthest.factors.try_emplace(ratio.hops, 1).first->second;
    factor = std::max(factor, ratio.factor);
    furthest.recordings.insert(ratio.recording);
    furthest.is_known |= ratio.is_known;
  }
  return furthest;
}

// "within a factor of 1.2", or "within a factor of 1.2 (1 hop), 101 (2 hops)".
std::string factors_text(const std::map<std::size_t, double>& factors) {
  std::vector<std::string> texts;
  for (const auto& [hops, factor] : factors) {
    // Up, so that what is said holds.
    std::string text = factor < 10 ? fmt::format("{:.1f}", std::ceil(factor * 10) / 10)
                                   : fmt::format("{:.0f}", std::ceil(factor));
    if (factors.size() > 1) text += fmt::format(" ({} hop{})", hops, hops == 1 ? "" : "s");
    texts.push_back(std::move(text));
  }
  return fmt::format("within a factor of {}", fmt::join(texts, ", "));
}

}  // namespace

std::vector<std::string> load_reality(const Scenario& scenario) {
  using enum RealityLoad;
  std::vector<std::string> lines;
  for (const RealityLoad load : {kTcp, kPaced, kRandom, kCpu, kDisk, kSteal}) {
    if (!has_load(scenario, load)) continue;
    const FurthestOff off = furthest_off(load, most_hops(scenario.hosts));
    lines.push_back(
        off.factors.empty()
            ? fmt::format("no real rig was measured under {}", load_name(load))
            : fmt::format("{} of real rigs under {} ({}{})", factors_text(off.factors),
                          load_name(load), fmt::join(off.recordings, ", "),
                          off.is_known ? "; figures that were known when the model was made" : ""));
  }
  return lines;
}

const std::vector<RealRecording>& real_recordings() {
  static const std::vector<RealRecording> all = [] {
    std::vector<RealRecording> recordings;
    for (const BuiltinFile& file : recording_files()) recordings.push_back(recording_of(file));
    return recordings;
  }();
  return all;
}

}  // namespace simbench::scenarios
