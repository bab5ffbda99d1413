#include "evaluation/fit/fit_model.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "evaluation/fit/fit_evidence.h"
#include "evaluation/replay/replay_camera.h"
#include "scenarios/loader.h"

namespace simbench::evaluation {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kLongestSummary = 3900;

double rounded(double value, double step) { return std::round(value / step) * step; }

// Tables of numbers stand in the document under a mark each, and are written in lines of their own
// width: a number per line is for nobody.
class Tables {
 public:
  Json mark(const std::vector<double>& values, int decimals) {
    std::string text = "[";
    std::size_t line = 0;
    for (const double value : values) {
      std::string number = fmt::format("{:.{}f}", value, decimals);
      number.erase(number.find_last_not_of('0') + 1);
      if (number.ends_with('.')) number.pop_back();
      if (number == "-0") number = "0";
      if (text.size() > 1) text += ", ";
      if (text.size() - line > kWidth) {
        text.back() = '\n';
        line = text.size();
      }
      text += number;
    }
    tables_.push_back(text + "]");
    return fmt::format("@table {}@", tables_.size() - 1);
  }

  std::string write(const Json& document) const {
    std::string text = document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
    for (std::size_t i = 0; i < tables_.size(); ++i) {
      const std::string mark = fmt::format("\"@table {}@\"", i);
      const std::size_t at = text.find(mark);
      if (at != std::string::npos) text.replace(at, mark.size(), tables_[i]);
    }
    return text;
  }

 private:
  static constexpr std::size_t kWidth = 90;
  std::vector<std::string> tables_;
};

std::string name_from(const std::string& path) {
  std::string name = std::filesystem::path(path).stem().string();
  for (char& c : name) {
    const bool is_allowed =
        std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-' || c == '.';
    if (!is_allowed) c = '_';
  }
  constexpr std::size_t kLongestName = 100;
  if (name.empty() || name.front() == '-') name.insert(0, "fit");
  return name.substr(0, kLongestName);
}

std::string stated_base(const FitBase& base, const std::string& path) {
  if (!base.stated.ends_with(".json")) return base.stated;
  const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
  return std::filesystem::proximate(std::filesystem::absolute(base.stated), folder).string();
}

// Where each camera is.
Json places_of(const FitInput& input) {
  std::vector<std::uint32_t> hosts;
  for (const FitCamera& camera : input.cameras) hosts.push_back(camera.host);
  const std::size_t cameras = hosts.size();
  const std::size_t per_host = (cameras + input.hosts.size() - 1) / input.hosts.size();
  bool is_even = true;
  for (std::size_t j = 0; j < cameras; ++j) is_even = is_even && hosts[j] == j / per_host;
  Json places = {{"count", cameras}, {"host_of_camera", Json::array()}};
  if (is_even) {
    places["cameras_per_host"] = per_host;
  } else {
    places["host_of_camera"] = hosts;
  }
  return places;
}

Json cameras_json(const RigFit& fit, const FitInput& input, const FitBase& base, Tables& tables) {
  Json cameras = places_of(input);
  std::vector<double> skews;
  for (const FittedValue& skew : fit.skew_ppm) skews.push_back(skew.value);
  cameras["skew_of_camera_ppm"] = tables.mark(skews, 4);
  cameras["drop_probability"] = rounded(fit.drop_share(), 1e-9);
  cameras["sensor_stamp_jitter_sigma_us"] = 0;
  if (base.mode_rate_hz) {
    Json streams = Json::parse(base.scenario.resolved_json)["cameras"]["streams"];
    for (Json& stream : streams) stream["mode_rate_hz"] = *base.mode_rate_hz;
    cameras["streams"] = streams;
  }
  return cameras;
}

Json hosts_json(const RigFit& fit, const FitInput& input) {
  constexpr double kExactMs = 1e-6;
  Json hosts = {{"count", input.hosts.size()},
                {"clock", {{"arrival_quantum_ms", kExactMs}}},
                {"load_burst", {{"rate_hz", 0}}}};
  if (const auto sigma_ppm = host_skew_sigma_ppm(fit.network)) {
    hosts["clock"]["oscillator"]["skew_sigma_ppm"] = rounded(*sigma_ppm, 1e-4);
  }
  if (const auto sigma_ms = initial_offset_sigma_ms(fit.network)) {
    hosts["clock"]["initial_offset_sigma_ms"] = rounded(*sigma_ms, 1e-6);
  }
  if (!fit.network.latency_quantiles_ms.empty()) {
    for (const char* const cost : {"send_cost_ms", "send_cost_exponential_ms",
                                   "send_cost_session_exponential_ms", "receive_wake_up_ms"}) {
      hosts[cost] = 0;
    }
  }
  return hosts;
}

Json members(const RigFit& fit, const FitInput& input, const FitBase& base, Tables& tables) {
  Json result = {{"hosts", hosts_json(fit, input)},
                 {"cameras", cameras_json(fit, input, base, tables)},
                 {"faults", Json::array()}};
  result["usb"] = {
      {"delivery_quantiles_ms", tables.mark(fit.delivery_quantiles_ms, 6)},
      {"delivery_correlation", fit.correlation ? rounded(fit.correlation->value, 1e-4) : 0.0},
      {"host_jitter_transfers", 0}};
  if (!fit.network.latency_quantiles_ms.empty()) {
    result["network"] = {{"latency_quantiles_ms", tables.mark(fit.network.latency_quantiles_ms, 6)},
                         {"latency_session_exponential_ms", 0},
                         {"burst", {{"rate_hz", 0}}}};
  }
  if (base.rate_hz) result["trigger"] = {{"rate_hz", rounded(*base.rate_hz, 1e-6)}};
  return result;
}

std::string summary_of(const FitModel& model, const RigFit& fit, const FitBase& base) {
  const std::string summary = fmt::format(
      "A fit of {} to a recording. {}. Not identified: {}. Contained in the tables, and therefore "
      "switched off: jitter common to a host, load bursts, noise and steps of the stamps{}.",
      base.scenario.name, fmt::join(model.evidence, "; "), fmt::join(model.not_identified, "; "),
      fit.network.latency_quantiles_ms.empty() ? "" : ", what messages cost the hosts");
  return summary.substr(0, kLongestSummary);
}

}  // namespace

FitBase default_base(const FitInput& input) {
  const char* const name = input.hosts.size() > 1 ? "6cam_2host_30fps" : "3cam_1host_30fps";
  FitBase base{.scenario = scenarios::load_scenario(name), .stated = name};
  Nanoseconds longest{};
  for (const FitStream& stream : input.streams) {
    longest = std::max(longest, median_period(stream.frames));
  }
  if (longest.count() <= 0) throw FitError("the recording has no frame period");
  const double rate_hz = 1e9 / static_cast<double>(longest.count());
  constexpr std::array<double, 4> kModesHz = {15, 30, 60, 90};  // of the base's image size
  const double guard = base.scenario.cameras.genlock_guard_fraction;
  const auto* const mode = std::find_if(kModesHz.begin(), kModesHz.end(), [&](double mode_hz) {
    return rate_hz <= mode_hz / 2 / (1 - guard);
  });
  if (mode == kModesHz.end()) {
    throw FitError(fmt::format(
        "the cameras run at {:.3f} Hz, allowed at most {:.3f} Hz without --base: state a scenario "
        "with such cameras",
        rate_hz, kModesHz.back() / 2 / (1 - guard)));
  }
  base.rate_hz = rate_hz;
  base.mode_rate_hz = *mode;
  return base;
}

FitModel fit_model(const RigFit& fit, const FitInput& input, const FitBase& base,
                   const std::string& path) {
  FitModel model;
  model.evidence = fit_evidence(fit, input);
  model.not_identified = not_identified(fit, input, base.scenario);
  Tables tables;
  Json document = base.stated.empty() ? Json::parse(base.scenario.resolved_json)
                                      : Json{{"base", stated_base(base, path)}};
  document["name"] = name_from(path);
  document["summary"] = summary_of(model, fit, base);
  document.merge_patch(members(fit, input, base, tables));
  model.text = tables.write(document);
  model.scenario = scenarios::load_scenario_text(model.text, path);
  return model;
}

}  // namespace simbench::evaluation
