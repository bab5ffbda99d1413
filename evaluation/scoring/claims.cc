#include "evaluation/scoring/claims.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "algorithms/ports/assert.h"

namespace simbench::evaluation {
namespace {

constexpr const char* kNone = "ntp_last_set";
constexpr const char* kTime = "yoon2021_time";
constexpr const char* kNetwork = "yoon2021_network";
constexpr const char* kBoth = "yoon2021_both";

// Whether a claim holds in one seed; nothing if a quantity is missing.
using Holds = std::optional<bool>;

// The scores of one seed, in the order of Statement::pipelines.
using Scores = std::vector<const SeedScore*>;

using Pipelines = std::span<const char* const>;

struct Statement {
  const char* id;
  const char* text;
  Pipelines pipelines;
  double rate_hz;   // of the scenario; 0: any
  const char* rig;  // what the rig must have for the quantities to exist; "": nothing
  Holds (*holds)(const Scores&);
};

// The verdict, or nothing if one of its quantities does not exist.
Holds verdict(bool holds, std::initializer_list<double> quantities) {
  const bool exist =
      std::none_of(quantities.begin(), quantities.end(), [](double q) { return std::isnan(q); });
  return exist ? Holds(holds) : std::nullopt;
}

Holds none_is_worst(const Scores& seed) {
  const double none = seed[0]->amd_ms;
  const double time = seed[1]->amd_ms;
  const double network = seed[2]->amd_ms;
  const double both = seed[3]->amd_ms;
  return verdict(none > 5 * std::max({time, network, both}), {none, time, network, both});
}

Holds both_network_time(const Scores& seed) {
  const double both = seed[0]->amd_ms;
  const double network = seed[1]->amd_ms;
  const double time = seed[2]->amd_ms;
  return verdict(both < network && network < time, {both, network, time});
}

Holds hosts_apart(const Scores& seed) {
  const double in_host = seed[0]->spread_in_host_ms;
  const double between = seed[0]->spread_between_hosts_ms;
  return verdict(in_host < 0.2 * between, {in_host, between});
}

Holds no_trend(const Scores& seed) {
  const double trend = seed[0]->trend_ms;
  const double amd = seed[0]->amd_ms;
  return verdict(std::abs(trend) < 0.1 * amd, {trend, amd});
}

Holds online_is_offline(const Scores& seed) {
  const double online = seed[0]->amd_ms;
  const double offline = seed[0]->offline_amd_ms;
  return verdict(std::abs(online - offline) < 0.1 * online, {online, offline});
}

Holds below_half_period(const Scores& seed) {
  const double both = seed[0]->share_below_half_period;
  const double network = seed[1]->share_below_half_period;
  return verdict(both >= 0.99 && network >= 0.99, {both, network});
}

Holds gathers_nothing(const Scores& seed) {
  if (seed[0]->sets.complete_pulses == 0) return std::nullopt;
  return seed[0]->sets.emitted == 0;
}

Holds both_is_best(const Scores& seed) {
  const double both = seed[0]->amd_ms;
  const double network = seed[1]->amd_ms;
  const double time = seed[2]->amd_ms;
  return verdict(both < network && both < time, {both, network, time});
}

constexpr std::array kEveryPipeline = {kNone, kTime, kNetwork, kBoth};
constexpr std::array kBothNetworkTime = {kBoth, kNetwork, kTime};
constexpr std::array kBothNetwork = {kBoth, kNetwork};
constexpr std::array kBothAlone = {kBoth};
constexpr std::array kNoneAlone = {kNone};

constexpr Statement kStatements[] = {
    {"C1",
     "no synchronisation is worst by far: its AMD exceeds 5 times the largest of time, network and "
     "both",
     kEveryPipeline, 0, "", none_is_worst},
    {"C2", "at 15 fps, AMD both < network < time", kBothNetworkTime, 15, "", both_network_time},
    {"C3", "at 45 fps, AMD both < network < time", kBothNetworkTime, 45, "", both_network_time},
    {"C4",
     "time, network and both have a lower AMD at 45 than at 15 fps",
     {},
     0,
     "a comparison of the scenarios at 15 and at 45 fps",
     nullptr},
    {"C5", "with both, the spread inside a host is under 0.2 of that between hosts", kBothAlone, 0,
     "at least two hosts, one of them with two cameras", hosts_apart},
    {"C6", "with both, the spread has no trend: its change over the recording is under 10 % of AMD",
     kBothAlone, 0, "", no_trend},
    {"C7", "with both, AMD of online and offline regression differ by less than 10 %", kBothAlone,
     0, "a capture small enough to be kept for the offline regression", online_is_offline},
    {"C8", "with both and with network, at least 99 % of pulses have a spread below half a period",
     kBothNetwork, 0, "", below_half_period},
    {"C9", "without synchronisation, gathering finds no set at all", kNoneAlone, 0, "",
     gathers_nothing},
    {"C10", "adding both delays helps: AMD both < network and both < time", kBothNetworkTime, 0, "",
     both_is_best}};

// What the statement needs and the scenario or its rows lack; empty if nothing.
std::string missing(const Statement& statement, const std::vector<Row>& rows,
                    double trigger_rate_hz) {
  if (statement.holds == nullptr) return statement.rig;
  // Rates of the trigger's own oscillator are off by ppm, advised ones by 500 of them.
  if (statement.rate_hz > 0 && std::abs(trigger_rate_hz / statement.rate_hz - 1) > 0.01) {
    return fmt::format("a scenario at {:.0f} fps", statement.rate_hz);
  }
  std::vector<std::string> absent;
  for (const char* pipeline : statement.pipelines) {
    if (find_row(rows, pipeline) == nullptr) absent.emplace_back(pipeline);
  }
  if (absent.empty()) return "";
  return fmt::format("the pipeline{} {}", absent.size() > 1 ? "s" : "", fmt::join(absent, ", "));
}

Claim check(const Statement& statement, const std::vector<Row>& rows, double trigger_rate_hz) {
  Claim claim = {.id = statement.id,
                 .text = statement.text,
                 .holds_fraction = std::nullopt,
                 .needs = missing(statement, rows, trigger_rate_hz),
                 .decided_seeds = 0};
  if (!claim.needs.empty()) return claim;

  std::vector<const Row*> paired;
  for (const char* pipeline : statement.pipelines) paired.push_back(find_row(rows, pipeline));
  if (std::any_of(paired.begin(), paired.end(), [](const Row* row) { return !row->verified(); })) {
    claim.needs = "captures whose ground truth is known: simulated ones, or real ones in genlock";
    return claim;
  }
  std::int64_t holds = 0;
  std::int64_t decided = 0;
  for (std::size_t index = 0; index < paired.front()->seeds.size(); ++index) {
    Scores scores;
    for (const Row* row : paired) {
      scores.push_back(&row->seeds.at(index));
      SIMBENCH_ASSERT(scores.back()->seed == scores.front()->seed, "rows are paired by seed");
    }
    const Holds found = statement.holds(scores);
    if (!found) continue;
    ++decided;
    if (*found) ++holds;
  }
  claim.decided_seeds = static_cast<std::uint64_t>(decided);
  if (decided > 0) {
    claim.holds_fraction = static_cast<double>(holds) / static_cast<double>(decided);
  } else {
    claim.needs = *statement.rig != '\0' ? statement.rig : "pulses that all cameras delivered";
  }
  return claim;
}

}  // namespace

std::vector<Claim> check_claims(const std::vector<Row>& rows, double trigger_rate_hz) {
  std::vector<Claim> claims;
  for (const Statement& statement : kStatements) {
    claims.push_back(check(statement, rows, trigger_rate_hz));
  }
  return claims;
}

bool needs_offline_amd(std::string_view pipeline) { return pipeline == kBoth; }

}  // namespace simbench::evaluation
