#include "evaluation/clock_run/clock_causes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <utility>

#include "algorithms/registry.h"

namespace simbench::evaluation {
namespace {

using nlohmann::json;
using scenarios::Override;
using scenarios::Scenario;

// Parameters that say how often an algorithm asks, and by what to multiply them to ask twice as
// often: seconds are halved, logarithms to base 2 lowered by 1.
struct PollParameter {
  std::string_view name;
  bool is_log2 = false;
};
constexpr PollParameter kPollParameters[] = {
    {"interval_ms"}, {"probe_interval_ms"}, {"poll_interval_s"}, {"max_poll", true}};

class Causes {
 public:
  explicit Causes(const Scenario& scenario)
      : scenario_(scenario), document_(json::parse(scenario.resolved_json())) {}

  std::vector<ClockCause> of(const scenarios::Pipeline& pipeline) {
    add_faults();
    add("the temperature of the hosts", scenario_.hosts.temperature
                                            ? std::vector<Override>{{"/hosts/temperature", "null"}}
                                            : std::vector<Override>{});
    add("paths that are unequal there and back", asymmetries());
    add("the traffic between hosts", scenario_.network.traffic.empty()
                                         ? std::vector<Override>{}
                                         : std::vector<Override>{{"/network/traffic", "[]"}});
    add("disk I/O", scenario_.hosts.io_load ? std::vector<Override>{{"/hosts/io_load", "null"}}
                                            : std::vector<Override>{});
    add("the processors taken from virtual machines",
        scenario_.hosts.steal ? std::vector<Override>{{"/hosts/steal", "null"}}
                              : std::vector<Override>{});
    add("the load of the processors", scenario_.hosts.cpu_load
                                          ? std::vector<Override>{{"/hosts/cpu_load", "null"}}
                                          : std::vector<Override>{});
    add("queues and bursts of the network",
        zeros({"/network/latency_exponential_ms", "/network/latency_session_exponential_ms",
               "/network/spike_probability", "/network/burst/rate_hz",
               "/network/cross_traffic_share", "/network/capture_traffic_share",
               "/hosts/load_burst/rate_hz"}));
    add("the oscillators' skew and wander",
        zeros({"/hosts/clock/oscillator/skew_sigma_ppm",
               "/hosts/clock/oscillator/white_frequency_ppb",
               "/hosts/clock/oscillator/random_walk_ppb_per_sqrt_s", "/hosts/nic/skew_sigma_ppm"}));
    add("noise of the stamps",
        zeros({"/hosts/send_cost_ms", "/hosts/send_cost_exponential_ms",
               "/hosts/send_cost_session_exponential_ms", "/hosts/receive_wake_up_ms",
               "/hosts/nic/stamp_jitter_sigma_ns", "/hosts/nic/stamp_resolution_ns",
               "/hosts/pulse_lines/pps_jitter_sigma_us", "/hosts/pulse_lines/interrupt_latency_us",
               "/hosts/pulse_lines/interrupt_latency_exponential_us"}));
    add("the time between two questions (asked twice as often)", twice_as_often(pipeline));
    return std::move(causes_);
  }

 private:
  void add(std::string what, std::vector<Override> sets) {
    if (!sets.empty()) causes_.push_back({.what = std::move(what), .sets = std::move(sets)});
  }

  // The members that are more than 0, set to 0.
  std::vector<Override> zeros(const std::vector<std::string>& pointers) const {
    std::vector<Override> sets;
    for (const std::string& pointer : pointers) {
      const json::json_pointer at(pointer);
      if (!document_.contains(at) || !document_[at].is_number()) continue;
      if (document_[at].get<double>() != 0) sets.push_back({pointer, "0"});
    }
    return sets;
  }

  std::vector<Override> asymmetries() const {
    std::vector<Override> sets =
        zeros({"/network/asymmetry_sigma_ms", "/network/port_asymmetry_sigma_ms"});
    json links = document_.value(json::json_pointer("/network/links"), json::array());
    bool is_stated = false;
    for (json& link : links) is_stated |= link.erase("asymmetry_ms") > 0;
    std::erase_if(links.get_ref<json::array_t&>(),
                  [](const json& link) { return link.size() < 2; });  // a host alone states nothing
    if (is_stated) sets.push_back({"/network/links", links.dump()});
    return sets;
  }

  void add_faults() {
    struct Group {
      const char* what;
      std::vector<std::string> kinds;
    };
    const std::vector<Group> groups = {
        {"the step of a clock", {"clock_step"}},
        {"the leap second", {"leap_second"}},
        {"hosts and links that stopped", {"host_stops", "link_stops"}}};
    const json faults = document_.value("faults", json::array());
    for (const Group& group : groups) {
      json left = json::array();
      for (const json& fault : faults) {
        if (std::ranges::count(group.kinds, fault.value("kind", "")) == 0) left.push_back(fault);
      }
      if (left.size() < faults.size()) add(group.what, {{"/faults", left.dump()}});
    }
  }

  std::vector<Override> twice_as_often(const scenarios::Pipeline& pipeline) const {
    const HostSyncEntry* const entry = find_algorithm<HostSyncEntry>(pipeline.host_sync);
    if (entry == nullptr) return {};
    const auto value_of = [&](const ParameterSpec& spec) -> std::optional<double> {
      std::optional<double> value;
      if (const auto* number = std::get_if<double>(&spec.fallback)) value = *number;
      for (const std::string& key : {entry->info.family, entry->info.name}) {
        const auto given = scenario_.algorithms.find(key);
        if (given == scenario_.algorithms.end() || !given->second.contains(spec.name)) continue;
        if (const auto* number = std::get_if<double>(&given->second.at(spec.name))) value = *number;
      }
      return value;
    };
    for (const ParameterSpec& spec : entry->info.parameters) {
      const auto* const known = std::ranges::find(kPollParameters, spec.name, &PollParameter::name);
      if (known == std::end(kPollParameters)) continue;
      if (const std::optional<double> value = value_of(spec)) {
        constexpr double kHalf = 0.5;
        return {{fmt::format("/algorithms/{}/{}", entry->info.name, spec.name),
                 fmt::format("{}", known->is_log2 ? *value - 1 : kHalf * *value)}};
      }
    }
    return {};
  }

  const Scenario& scenario_;
  json document_;
  std::vector<ClockCause> causes_;
};

struct Errors {
  double spread_ms = kNan;
  double largest_ms = kNan;
};

Errors errors_of(const Scenario& scenario, const ClockWorldFactory& make_world,
                 const ClockOptions& options) {
  const ClockResults results = evaluate_clocks(
      scenario, [&] { return make_world(scenario); }, options, nullptr);
  const Row& row = results.results.rows.front();
  return {mean_of(row.clock_spread_ms.values), mean_of(row.max_te_ms.values)};
}

}  // namespace

ClockCauses clock_causes(const Scenario& scenario, const std::string& pipeline,
                         const ClockWorldFactory& make_world, const ClockOptions& options,
                         const Progress& progress) {
  const auto named = std::ranges::find(scenario.pipelines, pipeline, &scenarios::Pipeline::name);
  if (named == scenario.pipelines.end() || named->programs) return {};
  ClockOptions few = options;
  few.seeds = std::min(options.seeds, kCauseSeeds);
  few.pipelines = {pipeline};
  const double readings =
      static_cast<double>(few.seeds * few.duration_s) * static_cast<double>(scenario.hosts.count);
  if (readings > kMostClockReadings) return {};
  ClockCauses asked{.seeds = few.seeds};
  std::vector<ClockCause> causes = Causes(scenario).of(*named);
  const Errors with = errors_of(scenario, make_world, few);
  std::uint64_t done = 0;
  for (ClockCause& cause : causes) {
    if (progress) progress(done++, causes.size());
    try {
      const Scenario world =
          scenarios::load_scenario_text(scenario.resolved_json(), scenario.name, cause.sets);
      const Errors without = errors_of(world, make_world, few);
      asked.tried.push_back(cause.what);
      cause.spread_from_ms = with.spread_ms;
      cause.spread_to_ms = without.spread_ms;
      cause.largest_from_ms = with.largest_ms;
      cause.largest_to_ms = without.largest_ms;
    } catch (const scenarios::InputError& error) {
      asked.refused.push_back(fmt::format("{}: {}", cause.what, error.what()));
    }
  }
  std::erase_if(causes, [](const ClockCause& cause) { return !(cause.effect() >= kLeastEffect); });
  std::ranges::stable_sort(causes, std::ranges::greater{}, &ClockCause::effect);
  asked.found = std::move(causes);
  return asked;
}

}  // namespace simbench::evaluation
