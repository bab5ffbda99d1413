#include "evaluation/advice/rig_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>
#include <optional>
#include <set>

#include "evaluation/run/ad_hoc_pipelines.h"
#include "recording/collected.h"
#include "scenarios/camera_profile.h"
#include "scenarios/document.h"
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

bool steers(const Part& camera) { return !camera.capture_alignment.empty(); }

// A sync mode and a mode of the camera that give the rate.
struct FrameMode {
  double mode_rate_hz = 0;
  bool is_genlock = false;
};

std::vector<double> mode_rates_hz(const Part& camera) {
  const scenarios::Scenario base = scenarios::load_scenario(camera.world);
  const scenarios::Stream& stream = *base.scored_stream();
  return scenarios::find_camera_profile(base.cameras.model)
      ->stream(stream.kind)
      ->find_size(stream.width, stream.height)
      ->rates_hz;
}

std::vector<double> rates_of(const Part& camera) {
  std::set<double> rates;
  for (const double mode_hz : mode_rates_hz(camera)) {
    rates.insert(mode_hz);
    if (!steers(camera)) rates.insert(mode_hz / 2);
  }
  return {rates.begin(), rates.end()};
}

std::optional<FrameMode> frame_mode(const Part& camera, double rate_hz) {
  const std::vector<double> rates = mode_rates_hz(camera);
  const auto has = [&](double mode_hz) { return std::ranges::count(rates, mode_hz) > 0; };
  if (has(2 * rate_hz)) return FrameMode{.mode_rate_hz = 2 * rate_hz, .is_genlock = true};
  if (has(rate_hz)) return FrameMode{.mode_rate_hz = rate_hz, .is_genlock = false};
  return std::nullopt;
}

[[noreturn]] void refuse_rate(const Part& camera, double rate_hz) {
  throw InputError(fmt::format("--rate: found {:g}, allowed {} (modes of the camera of {}{})",
                               rate_hz, fmt::join(rates_of(camera), ", "), camera.world,
                               steers(camera) ? "" : ", and halves of them in genlock"));
}

std::vector<Override> frame_mode_sets(const Part& camera, double rate_hz) {
  if (steers(camera)) {
    if (std::ranges::count(rates_of(camera), rate_hz) == 0) refuse_rate(camera, rate_hz);
    return {{"/cameras/streams/0/mode_rate_hz", fmt::format("{}", rate_hz)},
            {"/trigger/rate_hz", fmt::format("{}", rate_hz)}};
  }
  const std::optional<FrameMode> mode = frame_mode(camera, rate_hz);
  if (!mode) refuse_rate(camera, rate_hz);
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

// `clock`: the part by which the hosts are synchronised.
bool fits(const Part& network_switch, const Part& clock, std::int64_t hosts) {
  const std::vector<std::string>& with = network_switch.with;
  return network_switch.hosts >= hosts &&
         (with.empty() || std::ranges::count(with, clock.part) > 0);
}

// Cameras that are hosts, with the cheapest computers besides.
RigOption with_camera_hosts(const Part& camera, const RigRequest& request) {
  RigOption option{.camera = camera, .hosts = request.cameras + camera.computers};
  option.price = price_of(camera, {.hosts = option.hosts, .pieces = request.cameras});
  if (camera.computers == 0) return option;
  const std::vector<Part> hosts = parts_of(PartKind::kHost, request);
  const scenarios::PartCount count{.hosts = option.hosts, .pieces = camera.computers};
  option.host = *std::ranges::min_element(
      hosts, {}, [count](const Part& part) { return price_of(part, count).middle_eur(); });
  option.price += price_of(option.host, count);
  return option;
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
  const std::vector<Part> clocks =
      hosts.camera.is_host ? std::vector<Part>{hosts.camera} : parts_of(PartKind::kClock, request);
  for (const Part& clock : clocks) {
    std::set<std::string> effects;
    for (const Part& each : switches) {
      std::string effect;
      for (const Override& set : each.sets) effect += set.pointer + "=" + set.value + " ";
      if (!fits(each, clock, hosts.hosts) || !effects.insert(effect).second) continue;
      RigOption option = hosts;
      option.network_switch = each;
      option.price += price_of(each, count);
      if (!hosts.camera.is_host) {
        option.clock = clock;
        option.price += price_of(clock, {.hosts = hosts.hosts, .pieces = hosts.hosts});
      }
      options.push_back(std::move(option));
    }
  }
}

std::string pipelines_json(const std::vector<scenarios::Pipeline>& pipelines) {
  return fmt::format("[{}]", fmt::join(collected(pipelines, pipeline_json), ", "));
}

}  // namespace

Part camera_of(const RigRequest& request) {
  std::vector<std::string> known;
  for (const Part& part : parts_of(PartKind::kCamera, request)) {
    if (part.part == request.camera) return part;
    known.push_back(part.part);
  }
  throw InputError(fmt::format("--camera: found '{}', allowed: {}",
                               scenarios::shown_text(request.camera), fmt::join(known, ", ")));
}

std::string RigOption::name() const {
  std::string text;
  const auto add = [&text](const std::string& each) { text += (text.empty() ? "" : ", ") + each; };
  if (camera.is_host) add(fmt::format("{} x {}", hosts - camera.computers, camera.part));
  const std::int64_t computers = camera.is_host ? camera.computers : hosts;
  if (!host.part.empty()) add(fmt::format("{} x {}", computers, host.part));
  if (cards > 0) add(fmt::format("{} x {}", cards, usb_card.part));
  if (!network_switch.part.empty()) add(network_switch.part);
  if (!clock.part.empty()) add(clock.part);
  return text;
}

std::vector<std::string> RigOption::host_sync() const {
  if (camera.is_host) return camera.host_sync;
  return hosts == 1 ? std::vector<std::string>{"free_running"} : clock.host_sync;
}

std::vector<double> supported_rates_hz(const std::string& camera) {
  return rates_of(camera_of({.camera = camera}));
}

namespace {

void sort_by_price(std::vector<RigOption>& options) {
  std::ranges::stable_sort(options, {},
                           [](const RigOption& option) { return option.price.middle_eur(); });
}

std::vector<RigOption> options_of_camera_hosts(const Part& camera, const RigRequest& request) {
  std::vector<RigOption> options;
  const RigOption option = with_camera_hosts(camera, request);
  add_networks(option, request, options);
  if (options.empty()) {
    throw InputError(fmt::format(
        "--cameras: found {}, which are {} hosts on one switch, allowed what a switch has ports "
        "for (simbench list parts; --parts adds yours)",
        request.cameras, option.hosts));
  }
  sort_by_price(options);
  return options;
}

}  // namespace

std::vector<RigOption> rig_options(const RigRequest& request) {
  const Part camera = camera_of(request);
  (void)frame_mode_sets(camera, request.rate_hz);
  if (camera.is_host) return options_of_camera_hosts(camera, request);
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
    if (auto filled = with_hosts(hosts, request)) {
      filled->camera = camera;
      add_networks(*filled, request, options);
    }
  }
  if (options.empty()) {
    throw InputError(fmt::format(
        "--cameras: found {} on {} to {} hosts, allowed what the USB controllers of a host carry "
        "(simbench list parts); allow more hosts",
        request.cameras, request.fewest_hosts, most));
  }
  sort_by_price(options);
  return options;
}

scenarios::Scenario scenario_of(const RigOption& option, const RigRequest& request,
                                const std::vector<scenarios::Pipeline>& pipelines) {
  std::vector<Override> sets = frame_mode_sets(option.camera, request.rate_hz);
  sets.push_back({"/hosts/count", fmt::format("{}", option.hosts)});
  sets.push_back({"/cameras/count", fmt::format("{}", request.cameras)});
  sets.push_back({"/cameras/cameras_per_host", fmt::format("{}", option.cameras_per_host)});
  if (option.camera.computers > 0) {  // the first hosts have no camera
    std::vector<std::int64_t> host_of_camera(static_cast<std::size_t>(request.cameras));
    std::iota(host_of_camera.begin(), host_of_camera.end(), option.camera.computers);
    sets.push_back(
        {"/cameras/host_of_camera", fmt::format("[{}]", fmt::join(host_of_camera, ", "))});
  }
  sets.push_back({"/pipelines", pipelines_json(pipelines)});
  for (const Part* part : {&option.host, &option.usb_card, &option.network_switch, &option.clock}) {
    sets.insert(sets.end(), part->sets.begin(), part->sets.end());
  }
  sets.insert(sets.end(), request.sets.begin(), request.sets.end());
  return scenarios::load_scenario(option.camera.world, sets);
}

}  // namespace simbench::evaluation
