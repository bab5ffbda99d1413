#include "evaluation/budget/host_clock_budget.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "evaluation/budget/budget.h"
#include "evaluation/run/pipeline_choice.h"
#include "evaluation/scoring/results.h"
#include "evaluation/statistics/statistics.h"

namespace simbench::evaluation {
namespace {

using scenarios::Fault;
using scenarios::Pipeline;
using scenarios::Scenario;

constexpr bool is_ideal(std::size_t ideal, HostClockCause cause) {
  return (ideal >> static_cast<std::size_t>(cause) & 1U) != 0;
}

template <class... Kinds>
void remove_faults(std::vector<Fault>& faults) {
  std::erase_if(faults,
                [](const Fault& fault) { return (std::holds_alternative<Kinds>(fault) || ...); });
}

// The fixed latency, the residence in switches and what has no effect then stay.
void idealise_network(scenarios::Network& network) {
  if (!network.latency_quantiles_ms.empty()) {
    network.latency_fixed_ms = network.latency_quantiles_ms.front();
    network.latency_quantiles_ms.clear();
  }
  network.latency_exponential_ms = 0;
  network.latency_session_exponential_ms = 0;
  network.asymmetry_sigma_ms = 0;
  network.port_asymmetry_sigma_ms = 0;
  network.spike_probability = 0;
  network.burst.rate_hz = 0;
  network.bandwidth_mbit_per_s = 0;  // infinite
  network.loss_probability = 0;
  network.duplicate_probability = 0;
  network.reorder_probability = 0;
  network.nagle = false;
  network.delayed_ack_ms = 0;
  network.capture_traffic_share = 0;
  network.cross_traffic_share = 0;
  network.switch_clock_error_ns = 0;
  network.switch_clock_wander_ppb_per_sqrt_s = 0;
  network.wifi.reset();
  for (scenarios::Link& link : network.links) {
    link.latency_exponential_ms = 0;
    link.asymmetry_ms = 0;
  }
}

void idealise_messages(Scenario& world) {
  idealise_network(world.network);
  scenarios::Hosts& hosts = world.hosts;
  hosts.send_cost_ms = 0;
  hosts.send_cost_exponential_ms = 0;
  hosts.send_cost_session_exponential_ms = 0;
  hosts.receive_wake_up_ms = 0;
  hosts.load_burst.rate_hz = 0;
  hosts.stack.reset();
  hosts.nic.stamp_resolution_ns = 0;
  hosts.nic.stamp_jitter_sigma_ns = 0;
  hosts.pulse_lines.pps_jitter_sigma_us = 0;
  hosts.pulse_lines.interrupt_latency_us = 0;
  hosts.pulse_lines.interrupt_latency_exponential_us = 0;
  remove_faults<scenarios::HostStops, scenarios::LinkStops>(world.faults);
}

void idealise_oscillators(Scenario& world) {
  scenarios::Hosts& hosts = world.hosts;
  hosts.clock.oscillator = perfect_oscillator(hosts.clock.oscillator);
  hosts.clock.skew_of_host_ppm.clear();
  hosts.nic.skew_sigma_ppm = 0;
  hosts.temperature.reset();
  if (hosts.drift_file) hosts.drift_file = scenarios::DriftFile{};  // right, and of now
  remove_faults<scenarios::ClockStep, scenarios::LeapSecond>(world.faults);
}

void idealise_clock_calls(scenarios::Hosts& hosts) {
  hosts.clock.tick_ms = 0;
  hosts.clock.resolution_ms = 0;
  hosts.clock.read_cost_ms = 0;
  hosts.clock.set_cost_ms = 0;
  hosts.clock.set_cost_session_log_sigma = 0;
  hosts.clock.set_cost_call_log_sigma = 0;
  hosts.nic.cross_stamp_cost_ms = 0;
}

// Why the error of this pipeline's host clocks is not divided; empty if it can be.
std::string undivided(const Scenario& scenario, const PipelineChoice& choice) {
  if (!choice.problem.empty()) return choice.problem;
  if (scenario.hosts.count == 1) return "there is one host, whose clock is the reference";
  const std::string& name = choice.pipeline.host_sync;
  if (std::ranges::count(choice.host_sync.info.needs, Need::kFrames) > 0) {
    return fmt::format("{} looks at frames, whose way over USB is no message's", name);
  }
  if (choice.host_sync.make(choice.host_sync_parameters)->is_idle()) {
    return fmt::format("{} sends nothing and sets no clock", name);
  }
  return "";
}

// The host clocks do not depend on the stages behind them.
Pipeline with_cheap_stages(Pipeline pipeline) {
  pipeline.device_time = "raw_arrival";
  pipeline.gathering = "oracle";
  return pipeline;
}

// Of one pipeline.
struct ErrorsByWorld {
  std::vector<std::vector<double>> by_world;  // then by seed, ms
  std::string first_note;                     // of any world
};

void add_world(const Scenario& world, const WorldFactory& make_world,
               const EvaluationOptions& options, const Progress& progress,
               std::vector<ErrorsByWorld>& errors) {
  EvaluationOptions of_world = options;
  of_world.pipelines.clear();
  of_world.keep_pulses = false;
  of_world.share_captures = true;
  const Results results = evaluate(
      world, [&] { return make_world(world); }, of_world, progress);
  for (std::size_t i = 0; i < results.rows.size(); ++i) {
    const Row& row = results.rows[i];
    errors[i].by_world.push_back(row.host_error_ms.values);
    if (errors[i].first_note.empty() && !row.notes.empty()) {
      errors[i].first_note = row.notes.front();
    }
  }
}

// A seed without an error in one world has none in all. Returns how many those are.
std::size_t drop_incomplete_seeds(std::vector<std::vector<double>>& by_world) {
  std::size_t dropped = 0;
  for (std::size_t seed = 0; seed < by_world.front().size(); ++seed) {
    const bool is_complete = std::ranges::none_of(
        by_world, [seed](const std::vector<double>& world) { return std::isnan(world[seed]); });
    if (is_complete) continue;
    for (std::vector<double>& world : by_world) world[seed] = kNan;
    ++dropped;
  }
  return dropped;
}

void divide_host_clock(ErrorsByWorld& errors, HostClockBudget& budget) {
  const std::size_t seeds = errors.by_world.front().size();
  const std::size_t dropped = drop_incomplete_seeds(errors.by_world);
  if (dropped > 0) {
    budget.note =
        fmt::format("{} of {} seeds have no host clock error in one of the worlds{}{}", dropped,
                    seeds, errors.first_note.empty() ? "" : ": ", errors.first_note);
  }
  budget.is_divided = dropped < seeds;
  if (!budget.is_divided) return;
  DividedError divided = divide_error(errors.by_world);
  budget.total = std::move(divided.total);
  std::ranges::move(divided.players, budget.parts.begin());
  budget.algorithm = std::move(divided.remainder);
}

}  // namespace

Scenario without_causes(const Scenario& scenario, std::size_t ideal) {
  Scenario world = scenario;
  world.published.clear();
  if (is_ideal(ideal, HostClockCause::kMessages)) idealise_messages(world);
  if (is_ideal(ideal, HostClockCause::kOscillators)) idealise_oscillators(world);
  if (is_ideal(ideal, HostClockCause::kClockCalls)) idealise_clock_calls(world.hosts);
  return world;
}

std::vector<HostClockBudget> host_clock_budgets(const Scenario& scenario,
                                                const std::vector<Pipeline>& pipelines,
                                                const WorldFactory& make_world,
                                                const EvaluationOptions& options,
                                                const Progress& progress) {
  Scenario divided = scenario;
  divided.pipelines = pipelines;
  const std::vector<PipelineChoice> choices = choose_pipelines(divided, {});
  std::vector<HostClockBudget> budgets;
  budgets.reserve(choices.size());
  std::vector<std::size_t> places;  // of those to divide
  divided.pipelines.clear();
  for (const PipelineChoice& choice : choices) {
    budgets.push_back({.pipeline = choice.pipeline.name, .note = undivided(scenario, choice)});
    if (!budgets.back().note.empty()) continue;
    places.push_back(budgets.size() - 1);
    divided.pipelines.push_back(with_cheap_stages(choice.pipeline));
  }
  if (places.empty()) return budgets;
  const std::uint64_t runs = places.size() * options.seeds;
  std::vector<ErrorsByWorld> errors(places.size());
  for (std::size_t ideal = 0; ideal < kHostClockWorlds; ++ideal) {
    add_world(
        without_causes(divided, ideal), make_world, options,
        [&](std::uint64_t done, std::uint64_t) {
          if (progress) progress(ideal * runs + done, kHostClockWorlds * runs);
        },
        errors);
  }
  for (std::size_t i = 0; i < places.size(); ++i) divide_host_clock(errors[i], budgets[places[i]]);
  return budgets;
}

}  // namespace simbench::evaluation
