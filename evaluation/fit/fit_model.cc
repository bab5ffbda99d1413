#include "evaluation/fit/fit_model.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>

#include "evaluation/frames/camera_statistics.h"
#include "evaluation/statistics/statistics.h"
#include "recording/collected.h"
#include "recording/counted.h"
#include "recording/text_fields.h"
#include "recording/version.h"
#include "scenarios/loader.h"

namespace simbench::evaluation {
namespace {

using Lines = std::vector<std::string>;

constexpr std::size_t kCamerasByName = 6;

constexpr const char* kFastCamera = "d435";
constexpr std::int64_t kFastWidth = 848;
constexpr std::int64_t kFastHeight = 100;
constexpr double kFastModeHz = 300;

// "2.1 +- 0.4 [1.2, 3.0]"
std::string skew_text(const std::optional<FittedValue>& skew_ppm) {
  if (!skew_ppm) return "not found";
  const Interval interval = interval_of(*skew_ppm);
  return fmt::format("{:.3f} +- {:.3f} [{:.3f}, {:.3f}]", skew_ppm->value, skew_ppm->error,
                     interval.low, interval.high);
}

std::vector<FittedValue> found_skews(const RigFit& fit) {
  std::vector<FittedValue> found;
  for (const std::optional<FittedValue>& skew : fit.skew_ppm) {
    if (skew) found.push_back(*skew);
  }
  return found;
}

std::string skew_line(const RigFit& fit, const FitInput& input) {
  std::string values;
  if (fit.skew_ppm.size() <= kCamerasByName) {
    Lines each;
    for (std::size_t i = 0; i < fit.skew_ppm.size(); ++i) {
      each.push_back(fmt::format("{} {}", input.cameras[i].name, skew_text(fit.skew_ppm[i])));
    }
    values = fmt::format("{}", fmt::join(each, ", "));
  } else {
    const std::vector<FittedValue> found = found_skews(fit);
    const auto [low, high] = std::ranges::minmax(found, {}, &FittedValue::value);
    const FittedValue worst = std::ranges::max(found, {}, &FittedValue::error);
    values = fmt::format("{} cameras from {:.3f} to {:.3f}, +- {:.3f} at most", fit.skew_ppm.size(),
                         low.value, high.value, worst.error);
  }
  return fmt::format(
      "/cameras/skew_of_camera_ppm: {} ppm (standard error, 95 % interval), each against its "
      "host's clock, by the line under its arrivals",
      values);
}

std::string delivery_line(const RigFit& fit) {
  return fmt::format(
      "/usb/delivery_quantiles_ms: {} quantiles of the excess of {} frames over the quickest "
      "of their streams; median {:.4f}, 99 % {:.4f}, largest {:.4f} ms",
      fit.delivery_quantiles_ms.size(), fit.frames, quantile(fit.excess_ms, 0.5),
      quantile(fit.excess_ms, 0.99), fit.excess_ms.back());
}

std::string correlation_line(const RigFit& fit) {
  if (!fit.correlation) return "/usb/delivery_correlation: 0, not identified";
  return fmt::format(
      "/usb/delivery_correlation: {:.3f} +- {:.3f} (standard error), from Spearman's rank "
      "correlation of successive frames",
      fit.correlation->value, fit.correlation->error);
}

std::string drop_line(const RigFit& fit) {
  if (!fit.drops) return "/cameras/drop_probability: that of the base, not identified";
  return fmt::format(
      "/cameras/drop_probability: {} of {} frames lost by the counters, 95 % interval {:.3g} to "
      "{:.3g}",
      fit.drops->lost, fit.drops->counted, fit.drops->interval.low, fit.drops->interval.high);
}

// The root mean square of the existing values.
std::optional<double> root_mean_square(const NetworkFit& network,
                                       std::optional<FittedValue> HostClockFit::*member) {
  double sum = 0;
  double count = 0;
  for (const HostClockFit& host : network.hosts) {
    if (!(host.*member)) continue;
    sum += (host.*member)->value * (host.*member)->value;
    ++count;
  }
  if (count == 0) return std::nullopt;
  return std::sqrt(sum / count);
}

// The standard deviation of the rates of the hosts' oscillators, from the rates relative to the
// master's, which is one of them; nothing if no host has one.
std::optional<double> host_skew_sigma_ppm(const NetworkFit& network) {
  const auto relative = root_mean_square(network, &HostClockFit::skew_ppm);
  if (!relative) return std::nullopt;
  return *relative / std::numbers::sqrt2;
}

std::optional<double> initial_offset_sigma_ms(const NetworkFit& network) {
  return root_mean_square(network, &HostClockFit::initial_offset_ms);
}

void add_network_lines(const NetworkFit& network, Lines& lines) {
  if (!network.latency_quantiles_ms.empty()) {
    lines.push_back(fmt::format(
        "/network/latency_quantiles_ms: one way of {} round trips (median {:.4f}, 99 % {:.4f} ms), "
        "assuming that both ways are alike and independent",
        network.round_trips_ms.size(), quantile(network.round_trips_ms, 0.5),
        quantile(network.round_trips_ms, 0.99)));
  }
  Lines skews;
  Lines offsets;
  for (const HostClockFit& host : network.hosts) {
    if (host.skew_ppm) {
      skews.push_back(fmt::format("host {} {:.3f} +- {:.3f}", host.host, host.skew_ppm->value,
                                  host.skew_ppm->error));
    }
    if (host.initial_offset_ms) {
      offsets.push_back(fmt::format("host {} {:.4f} +- {:.4f}", host.host,
                                    host.initial_offset_ms->value, host.initial_offset_ms->error));
    }
  }
  if (!skews.empty()) {
    lines.push_back(fmt::format(
        "/hosts/clock/oscillator/skew_sigma_ppm: {:.3f}, from the rates against the master's: {} "
        "ppm (standard error)",
        *host_skew_sigma_ppm(network), fmt::join(skews, ", ")));
  }
  if (!offsets.empty()) {
    lines.push_back(fmt::format(
        "/hosts/clock/initial_offset_sigma_ms: {:.4f}, from the offsets before any setting: {} ms "
        "(half a round trip)",
        *initial_offset_sigma_ms(network), fmt::join(offsets, ", ")));
  }
}

// Adds streams whose rate or delays changed too much for a line.
void add_rise_lines(const RigFit& fit, const FitInput& input, Lines& lines) {
  constexpr double kNoticed = 0.5;  // of the median excess
  for (const StreamFit& stream : fit.streams) {
    if (stream.rise_ms <= kNoticed * quantile(stream.excess_ms, 0.5)) continue;
    lines.push_back(fmt::format(
        "camera {}: its rate or its delays were not constant, for a tenth of the recording the "
        "lower quartile of the arrivals is {:.4f} ms off the line; the model's oscillators wander "
        "as the base has it",
        input.cameras[stream.camera].name, stream.rise_ms));
  }
}

using Json = nlohmann::ordered_json;

constexpr std::size_t kLongestSummary = 3900;

double rounded(double value, double step) { return std::round(value / step) * step; }

// Tables of numbers: each has a mark in the document, in whose place it is written with many
// numbers to a line.
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
    std::string text =
        printable_json(document.dump(2, ' ', false, Json::error_handler_t::replace)) + "\n";
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

// A path as the file at `path` states it.
std::string seen_from(const std::string& path, const std::string& other) {
  const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
  return std::filesystem::proximate(std::filesystem::absolute(other), folder).string();
}

std::string stated_base(const FitBase& base, const std::string& path) {
  return base.stated.ends_with(".json") ? seen_from(path, base.stated) : base.stated;
}

// The host of each camera.
Json places_of(const FitInput& input) {
  std::vector<std::uint32_t> hosts = collected(input.cameras, &FitCamera::host);
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

// By camera; the mean of the others for those without.
std::vector<double> modelled_skews_ppm(const RigFit& fit) {
  const double mean = mean_of(collected(found_skews(fit), &FittedValue::value));
  std::vector<double> skews;
  for (const std::optional<FittedValue>& skew : fit.skew_ppm) {
    skews.push_back(skew ? skew->value : mean);
  }
  return skews;
}

// The base's streams in another mode.
Json streams_json(const FitBase& base) {
  Json streams = Json::parse(base.scenario.resolved_json())["cameras"]["streams"];
  for (Json& stream : streams) {
    stream["mode_rate_hz"] = *base.mode_rate_hz;
    if (!base.fast_camera) continue;
    stream["width"] = kFastWidth;
    stream["height"] = kFastHeight;
  }
  return streams;
}

Json cameras_json(const RigFit& fit, const FitInput& input, const FitBase& base, Tables& tables) {
  Json cameras = places_of(input);
  cameras["skew_of_camera_ppm"] = tables.mark(modelled_skews_ppm(fit), 4);
  if (fit.drops) cameras["drop_probability"] = rounded(fit.drops->share(), 1e-9);
  cameras["sensor_stamp_jitter_sigma_us"] = 0;
  if (base.mode_rate_hz) cameras["streams"] = streams_json(base);
  if (base.fast_camera) cameras["model"] = kFastCamera;
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
    hosts["stack"] = nullptr;
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
                         {"switch_residence_ms", 0},
                         {"cross_traffic_share", 0},
                         {"burst", {{"rate_hz", 0}}}};
  }
  if (base.rate_hz) result["trigger"] = {{"rate_hz", rounded(*base.rate_hz, 1e-6)}};
  return result;
}

Lines fit_evidence(const RigFit& fit, const FitInput& input) {
  Lines lines = {skew_line(fit, input), delivery_line(fit), correlation_line(fit), drop_line(fit)};
  add_network_lines(fit.network, lines);
  add_rise_lines(fit, input, lines);
  return lines;
}

// Cameras with stamps of a clock that is set.
std::vector<std::string> cameras_from_1970(const FitInput& input) {
  std::vector<std::string> names;
  for (const FitStream& stream : input.streams) {
    const std::string& name = input.cameras[stream.camera].name;
    if (counts_from_1970(stream.frames) && std::ranges::find(names, name) == names.end()) {
      names.push_back(name);
    }
  }
  return names;
}

std::vector<std::string> not_identified(const RigFit& fit, const FitInput& input,
                                        const scenarios::Scenario& base) {
  Lines lines = {
      "the constant part of the delivery delay: pipeline, transfer and the least of the rest are "
      "those of the base",
      "jitter that cameras have in common: all are simulated as independent",
      "noise of the oscillators: that of the base"};
  if (input.hosts.size() > 1) {
    if (fit.network.latency_quantiles_ms.empty()) {
      lines.push_back(fmt::format(
          "the network: {} with four stamps, {} are needed; latencies are those of the base",
          counted(fit.network.round_trips_ms.size(), "exchange"), kFewestExchanges));
    } else {
      lines.emplace_back("asymmetry of the links: that of the base");
    }
    if (!host_skew_sigma_ppm(fit.network)) {
      lines.emplace_back("rates of the hosts' clocks: those of the base");
    }
    if (!initial_offset_sigma_ms(fit.network)) {
      lines.emplace_back("offsets of the hosts before synchronisation: those of the base");
    }
  } else {
    lines.emplace_back("the rate of the host's own clock: that of the base");
  }
  if (base.usb.sharing != scenarios::UsbSharing::kDedicated &&
      input.cameras.size() > input.hosts.size()) {
    lines.push_back(fmt::format(
        "how cameras share a bus: the base has it \"{}\"; where that delays frames unequally, it "
        "is in the measured delays as well and counts twice",
        to_text(base.usb.sharing)));
  }
  for (std::size_t i = 0; i < fit.skew_ppm.size(); ++i) {
    if (fit.skew_ppm[i]) continue;
    lines.push_back(
        fmt::format("the rate of camera {}: the mean of the others", input.cameras[i].name));
  }
  if (!fit.drops) lines.emplace_back("lost frames: these cameras do not count their frames");
  if (const std::vector<std::string> names = cameras_from_1970(input); !names.empty()) {
    lines.push_back(fmt::format(
        "the oscillator of {}: stamps that count from 1970 are of a clock that is set (of a "
        "computer, of a camera under PTP, or librealsense's global time), whose rate stands for it",
        fmt::join(names, ", ")));
  }
  return lines;
}

std::string summary_of(const FitModel& model, const RigFit& fit, const FitBase& base) {
  const std::string summary = fmt::format(
      "A fit of {} to a recording, by simbench {}. {}. Not identified: {}. Left out: {}. Contained "
      "in the tables, and therefore switched off: jitter common to a host, load bursts, noise and "
      "steps of the stamps{}.",
      base.scenario.name, version(), fmt::join(model.evidence, "; "),
      fmt::join(model.not_identified, "; "),
      model.left_out.empty() ? "nothing" : fmt::format("{}", fmt::join(model.left_out, "; ")),
      fit.network.latency_quantiles_ms.empty() ? "" : ", what messages cost the hosts");
  return summary.substr(0, kLongestSummary);
}

// The rate of the slowest stream that a fit can use.
double slowest_rate_hz(const FitInput& input) {
  Nanoseconds longest{};
  for (const FitStream& stream : input.streams) {
    if (stream.frames.size() < kFewestFrames) continue;
    longest = std::max(longest, median_period(stream.frames));
  }
  if (longest.count() > 0) return 1e9 / static_cast<double>(longest.count());
  fit_rig(input);  // says what it lacks
  throw FitError("the recording has no frame period");
}

}  // namespace

FitBase default_base(const FitInput& input) {
  const char* const name = input.hosts.size() > 1 ? "6cam_2host_30fps" : "3cam_1host_30fps";
  FitBase base{.scenario = scenarios::load_scenario(name), .stated = name};
  const double rate_hz = slowest_rate_hz(input);
  constexpr std::array<double, 4> kModesHz = {15, 30, 60, 90};  // of the base's image size
  const double guard = base.scenario.cameras.genlock_guard_fraction;
  const auto fastest_hz = [guard](double mode_hz) { return mode_hz / 2 / (1 - guard); };
  const auto* const mode = std::find_if(kModesHz.begin(), kModesHz.end(), [&](double mode_hz) {
    return rate_hz <= fastest_hz(mode_hz);
  });
  base.fast_camera = mode == kModesHz.end();
  base.mode_rate_hz = base.fast_camera ? kFastModeHz : *mode;
  base.rate_hz = std::min(rate_hz, fastest_hz(*base.mode_rate_hz));
  if (*base.rate_hz < rate_hz) {
    base.left_out = fmt::format(
        "the frame rate: the cameras run at {:.3f} Hz, no built-in camera follows a trigger faster "
        "than {:.3f} Hz, which the model has; a --base with such cameras takes the recording as it "
        "is",
        rate_hz, *base.rate_hz);
  }
  return base;
}

FitModel fit_model(const RigFit& fit, const FitInput& input, const FitBase& base,
                   const std::string& path) {
  FitModel model;
  model.evidence = fit_evidence(fit, input);
  model.not_identified = not_identified(fit, input, base.scenario);
  model.left_out = fit.left_out;
  if (!base.left_out.empty()) model.left_out.push_back(base.left_out);
  Tables tables;
  Json document = base.stated.empty() ? Json::parse(base.scenario.resolved_json())
                                      : Json{{"base", stated_base(base, path)}};
  document["name"] = name_from(path);
  document["summary"] = summary_of(model, fit, base);
  document.merge_patch(members(fit, input, base, tables));
  if (!base.recording.empty()) {
    document["fitted_to"] = collected(
        base.recording, [&](const std::string& recorded) { return seen_from(path, recorded); });
  }
  model.text = tables.write(document);
  model.scenario = scenarios::load_scenario_text(model.text, path);
  return model;
}

}  // namespace simbench::evaluation
