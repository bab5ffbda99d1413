#include "evaluation/fit/fit_evidence.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "evaluation/statistics/statistics.h"

namespace simbench::evaluation {
namespace {

using Lines = std::vector<std::string>;

constexpr std::size_t kCamerasByName = 6;

std::string skew_line(const RigFit& fit, const FitInput& input) {
  std::string values;
  if (fit.skew_ppm.size() <= kCamerasByName) {
    Lines each;
    for (std::size_t i = 0; i < fit.skew_ppm.size(); ++i) {
      each.push_back(fmt::format("{} {:.3f} +- {:.3f}", input.cameras[i].name,
                                 fit.skew_ppm[i].value, fit.skew_ppm[i].error));
    }
    values = fmt::format("{}", fmt::join(each, ", "));
  } else {
    const auto by = [](double FittedValue::*member) {
      return [member](const FittedValue& a, const FittedValue& b) { return a.*member < b.*member; };
    };
    const auto [low, high] =
        std::minmax_element(fit.skew_ppm.begin(), fit.skew_ppm.end(), by(&FittedValue::value));
    const auto worst =
        std::max_element(fit.skew_ppm.begin(), fit.skew_ppm.end(), by(&FittedValue::error));
    values = fmt::format("{} cameras from {:.3f} to {:.3f}, +- {:.3f} at most", fit.skew_ppm.size(),
                         low->value, high->value, worst->error);
  }
  return fmt::format(
      "/cameras/skew_of_camera_ppm: {} ppm (standard error), each against its host's clock, by the "
      "lower hull of its arrivals",
      values);
}

std::string delivery_line(const RigFit& fit) {
  return fmt::format(
      "/usb/delivery_quantiles_ms: {} quantiles of the excess of {} frames over the lower hulls of "
      "their streams; median {:.4f}, 99 % {:.4f}, largest {:.4f} ms",
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
  return fmt::format(
      "/cameras/drop_probability: {} of {} frames missing by the counters, 95 % interval {:.3g} to "
      "{:.3g}",
      fit.missing, fit.frames + fit.missing, fit.drop_interval.low, fit.drop_interval.high);
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

// Cameras whose rate changed so much that a line cannot follow it.
void add_rise_lines(const RigFit& fit, const FitInput& input, Lines& lines) {
  constexpr double kNoticed = 0.5;  // of the median excess
  for (const StreamFit& stream : fit.streams) {
    if (stream.rise_ms <= kNoticed * quantile(stream.excess_ms, 0.5)) continue;
    lines.push_back(fmt::format(
        "camera {}: its rate was not constant, for a tenth of the recording no frame came within "
        "{:.4f} ms of the line; the model's oscillators wander as the base has it",
        input.cameras[stream.camera].name, stream.rise_ms));
  }
}

// The root of the mean square of what there is.
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

}  // namespace

std::optional<double> host_skew_sigma_ppm(const NetworkFit& network) {
  const auto relative = root_mean_square(network, &HostClockFit::skew_ppm);
  if (!relative) return std::nullopt;
  return *relative / std::numbers::sqrt2;
}

std::optional<double> initial_offset_sigma_ms(const NetworkFit& network) {
  return root_mean_square(network, &HostClockFit::initial_offset_ms);
}

std::vector<std::string> fit_evidence(const RigFit& fit, const FitInput& input) {
  Lines lines = {skew_line(fit, input), delivery_line(fit), correlation_line(fit), drop_line(fit)};
  add_network_lines(fit.network, lines);
  add_rise_lines(fit, input, lines);
  return lines;
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
          "the network: {} exchanges with four stamps, {} are needed; latencies are those of the "
          "base",
          fit.network.round_trips_ms.size(), kFewestExchanges));
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
  return lines;
}

}  // namespace simbench::evaluation
