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

// The scores of one seed, in the order of a statement's pipelines.
struct Scores : std::vector<const SeedScore*> {
  double interval_ms = kNan;  // of frames
};

using Pipelines = std::span<const char* const>;

struct Statement {
  const char* id;
  const char* text;
  Pipelines pipelines;
  double rate_hz;   // of the scenario; 0: any
  const char* rig;  // what the rig must have for the quantities to exist; "": nothing
  Holds (*holds)(const Scores&);
  Needs needs = Needs::kVerifiedSets;
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

// As the hosts measured it: t_l has the defect of the latency estimate that was chosen.
Holds t_l_exceeds_t_t(const Scores& seed) {
  const double t_l = seed[0]->t_l_ms;
  const double t_t = seed[0]->t_t_ms;
  return verdict(t_l > t_t, {t_l, t_t});
}

Holds messages_exceed_calls(const Scores& seed) {
  const double messages = 2 * seed[0]->message_time_ms;
  const double calls = seed[0]->get_time_ms + seed[0]->set_time_ms;
  return verdict(messages > calls, {messages, calls});
}

constexpr const char* kSessionDelays = "a recording with the delays of the sessions";

// The paper's criterion of section 4.2: "the maximum error less than an interval between frames".
Holds below_interval(const Scores& seed) {
  const double none = seed[0]->amd_ms;
  const double worst = std::max({seed[1]->amd_ms, seed[2]->amd_ms, seed[3]->amd_ms});
  return verdict(worst < seed.interval_ms && none >= seed.interval_ms,
                 {none, seed[1]->amd_ms, seed[2]->amd_ms, seed[3]->amd_ms});
}

Holds all_lower(const Scores& slow, const Scores& fast) {
  bool holds = true;
  for (std::size_t i = 0; i < slow.size(); ++i) {
    if (std::isnan(slow[i]->amd_ms) || std::isnan(fast[i]->amd_ms)) return std::nullopt;
    holds = holds && fast[i]->amd_ms < slow[i]->amd_ms;
  }
  return holds;
}

Holds both_network_time_twice(const Scores& slow, const Scores& fast) {
  const Holds at_slow = both_network_time(slow);
  const Holds at_fast = both_network_time(fast);
  if (!at_slow || !at_fast) return std::nullopt;
  return *at_slow && *at_fast;
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
     "both rates: simbench paper",
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
     both_is_best},
    {"C11",
     "sending and receiving take longer than get-time and set-time: with both, the slaves' mean "
     "t_l exceeds their mean t_t",
     kBothAlone, 0, kSessionDelays, t_l_exceeds_t_t, Needs::kNothing},
    {"C11b",
     "the same without estimates: in the last exchange with both, the two messages take longer "
     "than the slave's get and set",
     kBothAlone, 0, kSessionDelays, messages_exceed_calls, Needs::kNothing},
    {"C12",
     "the paper's criterion of being synchronised, AMD below the interval between frames, is met "
     "with time, network and both, and not without synchronisation",
     kEveryPipeline, 0, "", below_interval}};

struct AcrossStatement {
  const char* id;
  const char* text;
  Pipelines pipelines;
  Holds (*holds)(const Scores& slow, const Scores& fast);
};

constexpr double kSlowHz = 15;
constexpr double kFastHz = 45;

constexpr AcrossStatement kAcross[] = {
    {"C4", "time, network and both have a lower AMD at 45 than at 15 fps", kBothNetworkTime,
     all_lower},
    {"C2 and C3", "at 15 and at 45 fps, AMD both < network < time", kBothNetworkTime,
     both_network_time_twice}};

// What a run must be or have and is not or has not; empty if nothing.
std::string missing(const ClaimedRun& run, Pipelines pipelines, double rate_hz) {
  // Rates of the trigger's own oscillator are off by ppm, advised ones by 500 of them.
  if (rate_hz > 0 && std::abs(run.trigger_rate_hz / rate_hz - 1) > 0.01) {
    return fmt::format("a scenario at {:.0f} fps", rate_hz);
  }
  std::vector<std::string> absent;
  for (const char* pipeline : pipelines) {
    if (find_row(run.rows, pipeline) == nullptr) absent.emplace_back(pipeline);
  }
  if (absent.empty()) return "";
  return fmt::format("the pipeline{} {}", absent.size() > 1 ? "s" : "", fmt::join(absent, ", "));
}

using PairedRows = std::vector<const Row*>;

PairedRows paired_rows(const ClaimedRun& run, Pipelines pipelines) {
  PairedRows rows;
  for (const char* pipeline : pipelines) rows.push_back(find_row(run.rows, pipeline));
  return rows;
}

bool are_verified(const PairedRows& rows) {
  return std::ranges::all_of(rows, [](const Row* row) { return row->verified(); });
}

Scores scores_of(const PairedRows& rows, std::size_t index, double trigger_rate_hz) {
  Scores scores;
  scores.interval_ms = 1000 / trigger_rate_hz;
  for (const Row* row : rows) {
    scores.push_back(&row->seeds.at(index));
    SIMBENCH_ASSERT(scores.back()->seed == scores.front()->seed, "rows are paired by seed");
  }
  return scores;
}

constexpr const char* kTruth =
    "captures whose ground truth is known: simulated ones, or real ones in genlock";

// Enters the fraction of the seeds that decide it; `needs`: what is missing where none does.
void enter(const std::vector<Holds>& seeds, const char* needs, Claim& claim) {
  const auto decided =
      std::ranges::count_if(seeds, [](const Holds& found) { return found.has_value(); });
  claim.decided_seeds = static_cast<std::uint64_t>(decided);
  if (decided == 0) {
    claim.needs = needs;
    return;
  }
  const auto holds = std::ranges::count(seeds, Holds(true));
  claim.holds_fraction = static_cast<double>(holds) / static_cast<double>(decided);
}

Claim new_claim(const char* id, const char* text) {
  return {.id = id, .text = text, .holds_fraction = std::nullopt, .needs = "", .decided_seeds = 0};
}

Claim check(const Statement& statement, const ClaimedRun& run) {
  Claim claim = new_claim(statement.id, statement.text);
  claim.needs = statement.holds == nullptr ? statement.rig
                                           : missing(run, statement.pipelines, statement.rate_hz);
  if (!claim.needs.empty()) return claim;
  const PairedRows rows = paired_rows(run, statement.pipelines);
  if (statement.needs == Needs::kVerifiedSets && !are_verified(rows)) {
    claim.needs = kTruth;
    return claim;
  }
  std::vector<Holds> seeds;
  for (std::size_t index = 0; index < rows.front()->seeds.size(); ++index) {
    seeds.push_back(statement.holds(scores_of(rows, index, run.trigger_rate_hz)));
  }
  enter(seeds, *statement.rig != '\0' ? statement.rig : "pulses that all cameras delivered", claim);
  return claim;
}

Claim check(const AcrossStatement& statement, const ClaimedRun& slow, const ClaimedRun& fast) {
  Claim claim = new_claim(statement.id, statement.text);
  claim.needs = missing(slow, statement.pipelines, kSlowHz);
  if (claim.needs.empty()) claim.needs = missing(fast, statement.pipelines, kFastHz);
  if (!claim.needs.empty()) return claim;
  const PairedRows of_slow = paired_rows(slow, statement.pipelines);
  const PairedRows of_fast = paired_rows(fast, statement.pipelines);
  if (!are_verified(of_slow) || !are_verified(of_fast)) {
    claim.needs = kTruth;
    return claim;
  }
  if (of_slow.front()->seeds.size() != of_fast.front()->seeds.size()) {
    claim.needs = "the same seeds at both rates";
    return claim;
  }
  std::vector<Holds> seeds;
  for (std::size_t index = 0; index < of_slow.front()->seeds.size(); ++index) {
    const Scores at_slow = scores_of(of_slow, index, slow.trigger_rate_hz);
    const Scores at_fast = scores_of(of_fast, index, fast.trigger_rate_hz);
    SIMBENCH_ASSERT(at_slow.front()->seed == at_fast.front()->seed, "runs are paired by seed");
    seeds.push_back(statement.holds(at_slow, at_fast));
  }
  enter(seeds, "pulses that all cameras delivered", claim);
  return claim;
}

// A row of one seed with the printed values of each row that has some, and nothing else.
std::vector<Row> printed_rows(const std::vector<Row>& rows) {
  std::vector<Row> printed;
  for (const Row& row : rows) {
    if (!row.published) continue;
    Row& added = printed.emplace_back();
    added.pipeline = row.pipeline;
    added.seeds.emplace_back().amd_ms = row.published->amd_ms;
    added.seeds.back().rmdv_ms = row.published->rmdv_ms;
  }
  return printed;
}

}  // namespace

std::vector<Claim> check_claims(const std::vector<Row>& rows, double trigger_rate_hz) {
  std::vector<Claim> claims;
  for (const Statement& statement : kStatements) {
    claims.push_back(check(statement, {rows, trigger_rate_hz}));
  }
  return claims;
}

std::vector<Claim> check_claims_across(const ClaimedRun& at_15_fps, const ClaimedRun& at_45_fps) {
  std::vector<Claim> claims;
  for (const AcrossStatement& statement : kAcross) {
    claims.push_back(check(statement, at_15_fps, at_45_fps));
  }
  return claims;
}

std::vector<Claim> check_printed_claims(const ClaimedRun& run) {
  return check_claims(printed_rows(run.rows), run.trigger_rate_hz);
}

std::vector<Claim> check_printed_claims_across(const ClaimedRun& at_15_fps,
                                               const ClaimedRun& at_45_fps) {
  const std::vector<Row> slow = printed_rows(at_15_fps.rows);
  const std::vector<Row> fast = printed_rows(at_45_fps.rows);
  return check_claims_across({slow, at_15_fps.trigger_rate_hz}, {fast, at_45_fps.trigger_rate_hz});
}

Percentile held_percent(const Claim& claim) {
  if (!claim.holds_fraction) return {kNan, kNan, kNan};
  const auto decided = static_cast<std::int64_t>(claim.decided_seeds);
  const auto [low, high] = binomial_interval(
      std::llround(*claim.holds_fraction * static_cast<double>(decided)), decided);
  return {100 * *claim.holds_fraction, 100 * low, 100 * high};
}

bool needs_offline_amd(std::string_view pipeline) { return pipeline == kBoth; }

}  // namespace simbench::evaluation
