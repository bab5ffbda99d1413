#include "evaluation/advice/rig_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <set>

#include "evaluation/run/ad_hoc_pipelines.h"
#include "recording/collected.h"
#include "scenarios/camera_profile.h"
#include "scenarios/loader.h"

namespace simbench::evaluation {
namespace {

using scenarios::InputError;
using scenarios::Override;
using scenarios::Part;
using scenarios::PartKind;

std::int64_t divided_up(std::int64_t count, std::int64_t by) { return (count + by - 1) / by; }

// All parts of a kind, the user's last.
std::vector<Part> parts_of(PartKind kind, const RigRequest& request) {
  std::vector<Part> found;
  for (const std::vector<Part>* all : {&scenarios::parts(), &request.more_parts}) {
    std::ranges::copy_if(*all, std::back_inserter(found),
                         [kind](const Part& part) { return part.kind == kind; });
  }
  return found;
}

// A sync mode and a mode of the camera that give the rate.
struct FrameMode {
  double mode_rate_hz = 0;
  bool is_genlock = false;
};

const std::vector<double>& mode_rates_hz() {
  static const std::vector<double> rates = [] {
    const scenarios::Scenario base = scenarios::load_scenario(kAdviceScenario);
    const scenarios::Stream& stream = *base.scored_stream();
    return scenarios::find_camera_profile(base.cameras.model)
        ->stream(stream.kind)
        ->find_size(stream.width, stream.height)
        ->rates_hz;
  }();
  return rates;
}

std::optional<FrameMode> frame_mode(double rate_hz) {
  const auto has = [](double mode_hz) { return std::ranges::count(mode_rates_hz(), mode_hz) > 0; };
  if (has(2 * rate_hz)) return FrameMode{.mode_rate_hz = 2 * rate_hz, .is_genlock = true};
  if (has(rate_hz)) return FrameMode{.mode_rate_hz = rate_hz, .is_genlock = false};
  return std::nullopt;
}

std::vector<Override> frame_mode_sets(double rate_hz) {
  const std::optional<FrameMode> mode = frame_mode(rate_hz);
  if (!mode) {
    throw InputError(fmt::format(
        "--rate: found {:g}, allowed {} (modes of the camera of {}, and halves of them in genlock)",
        rate_hz, fmt::join(supported_rates_hz(), ", "), kAdviceScenario));
  }
  return {{"/cameras/sync_mode", mode->is_genlock ? "genlock" : "slave"},
          {"/cameras/streams/0/mode_rate_hz", fmt::format("{}", mode->mode_rate_hz)},
          {"/trigger/rate_hz", fmt::format("{}", rate_hz)},
          {"/trigger/rate_error_ppm", mode->is_genlock ? "0" : "500"}};
}

// Hosts and cards for an option without them; nothing if no host carries the cameras.
std::optional<RigOption> with_hosts(std::int64_t hosts, const RigRequest& request) {
  std::optional<RigOption> best;
  const std::int64_t fullest = divided_up(request.cameras, hosts);
  const auto offer = [&](const Part& host, const Part& card, std::int64_t carried) {
    RigOption option{.hosts = hosts, .cameras_per_host = fullest, .host = host};
    option.cards_per_host = carried == 0 ? 0 : divided_up(fullest - host.cameras, carried);
    if (option.cards_per_host > host.slots) return;
    // Hosts are filled one after the other.
    for (std::int64_t left = request.cameras; left > 0; left -= fullest) {
      const std::int64_t here = std::min(left, fullest);
      if (here > host.cameras) option.cards += divided_up(here - host.cameras, carried);
    }
    if (option.cards > 0) option.usb_card = card;
    option.price = price_of(host, {.hosts = hosts, .pieces = hosts});
    option.price += price_of(option.usb_card, {.hosts = hosts, .pieces = option.cards});
    if (!best || option.price.middle_eur() < best->price.middle_eur()) best = option;
  };
  for (const Part& host : parts_of(PartKind::kHost, request)) {
    if (host.cameras >= fullest) {
      offer(host, {}, 0);
      continue;
    }
    for (const Part& card : parts_of(PartKind::kUsbCard, request)) {
      offer(host, card, card.cameras);
    }
  }
  return best;
}

bool fits(const Part& network_switch, const Part& clock, std::int64_t hosts) {
  const std::vector<std::string>& with = network_switch.with;
  return network_switch.hosts >= hosts &&
         (with.empty() || std::ranges::count(with, clock.part) > 0);
}

// Adds the options of these hosts: every clock with the cheapest switch of each effect.
void add_networks(const RigOption& hosts, const RigRequest& request,
                  std::vector<RigOption>& options) {
  if (hosts.hosts == 1) {
    options.push_back(hosts);
    return;
  }
  std::vector<Part> switches = parts_of(PartKind::kSwitch, request);
  const scenarios::PartCount count{.hosts = hosts.hosts, .pieces = 1};
  std::ranges::stable_sort(
      switches, {}, [count](const Part& part) { return price_of(part, count).middle_eur(); });
  for (const Part& clock : parts_of(PartKind::kClock, request)) {
    std::set<std::string> effects;
    for (const Part& each : switches) {
      std::string effect;
      for (const Override& set : each.sets) effect += set.pointer + "=" + set.value + " ";
      if (!fits(each, clock, hosts.hosts) || !effects.insert(effect).second) continue;
      RigOption option = hosts;
      option.network_switch = each;
      option.clock = clock;
      option.price += price_of(each, count);
      option.price += price_of(clock, {.hosts = hosts.hosts, .pieces = hosts.hosts});
      options.push_back(std::move(option));
    }
  }
}

std::string pipelines_json(const std::vector<scenarios::Pipeline>& pipelines) {
  return fmt::format("[{}]", fmt::join(collected(pipelines, pipeline_json), ", "));
}

}  // namespace

std::string RigOption::name() const {
  std::string text = fmt::format("{} x {}", hosts, host.part);
  if (cards > 0) text += fmt::format(", {} x {}", cards, usb_card.part);
  if (hosts > 1) text += fmt::format(", {}, {}", network_switch.part, clock.part);
  return text;
}

std::vector<std::string> RigOption::host_sync() const {
  return hosts == 1 ? std::vector<std::string>{"free_running"} : clock.host_sync;
}

std::vector<double> supported_rates_hz() {
  std::set<double> rates;
  for (const double mode_hz : mode_rates_hz()) rates.insert({mode_hz, mode_hz / 2});
  return {rates.begin(), rates.end()};
}

std::vector<RigOption> rig_options(const RigRequest& request) {
  (void)frame_mode_sets(request.rate_hz);
  std::vector<RigOption> options;
  const std::int64_t most = std::min(request.most_hosts, request.cameras);
  if (request.fewest_hosts > most) {
    throw InputError(
        fmt::format("--hosts: found {}..{}, allowed at most a host for each of the {} "
                    "cameras",
                    request.fewest_hosts, request.most_hosts, request.cameras));
  }
  for (std::int64_t hosts = request.fewest_hosts; hosts <= most; ++hosts) {
    // With so many on each, the last hosts would have none.
    if (divided_up(request.cameras, divided_up(request.cameras, hosts)) != hosts) continue;
    if (const auto filled = with_hosts(hosts, request)) add_networks(*filled, request, options);
  }
  if (options.empty()) {
    throw InputError(fmt::format(
        "--cameras: found {} on {} to {} hosts, allowed what the USB controllers of a host carry "
        "(simbench list parts); allow more hosts",
        request.cameras, request.fewest_hosts, most));
  }
  std::ranges::stable_sort(options, {},
                           [](const RigOption& option) { return option.price.middle_eur(); });
  return options;
}

scenarios::Scenario scenario_of(const RigOption& option, const RigRequest& request,
                                const std::vector<scenarios::Pipeline>& pipelines) {
  std::vector<Override> sets = frame_mode_sets(request.rate_hz);
  sets.push_back({"/hosts/count", fmt::format("{}", option.hosts)});
  sets.push_back({"/cameras/count", fmt::format("{}", request.cameras)});
  sets.push_back({"/cameras/cameras_per_host", fmt::format("{}", option.cameras_per_host)});
  sets.push_back({"/pipelines", pipelines_json(pipelines)});
  for (const Part* part : {&option.host, &option.usb_card, &option.network_switch, &option.clock}) {
    sets.insert(sets.end(), part->sets.begin(), part->sets.end());
  }
  sets.insert(sets.end(), request.sets.begin(), request.sets.end());
  return scenarios::load_scenario(kAdviceScenario, sets);
}

}  // namespace simbench::evaluation
