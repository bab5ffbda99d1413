#include "evaluation/diagnosis/clock_account.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <optional>
#include <utility>

namespace simbench::evaluation {
namespace {

constexpr double kAtOnceS = 1;
constexpr double kAlikeJumps = 0.2;

using AllDelays = std::vector<std::optional<CameraDelays>>;  // by stream

std::vector<std::string> hosts_with_cameras(const std::vector<RecordedStream>& streams) {
  std::vector<std::string> hosts;
  for (const RecordedStream& stream : streams) {
    if (std::ranges::find(hosts, stream.host) == hosts.end()) hosts.push_back(stream.host);
  }
  return hosts;
}

TimeRange range_of_stream(const RecordedStream& stream) {
  if (stream.frames.empty()) return {};
  const auto [first, last] = std::ranges::minmax(stream.frames, {}, &StampedFrame::arrival);
  return {to_seconds(first.arrival), to_seconds(last.arrival)};
}

TimeRange range_on(const std::string& host, const std::vector<ClockedCamera>& cameras) {
  TimeRange all;
  for (const ClockedCamera& camera : cameras) {
    if (camera.host != host || std::isnan(camera.arrivals.first_s)) continue;
    all.first_s = std::fmin(all.first_s, camera.arrivals.first_s);
    all.last_s = std::fmax(all.last_s, camera.arrivals.last_s);
  }
  return all;
}

bool is_word_letter(char c) {
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

// As a whole word: "pc1" is not in "pc10.log".
bool has_word(const std::string& text, const std::string& word) {
  if (word.empty()) return false;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
    const std::size_t end = at + word.size();
    const bool begins = at == 0 || !is_word_letter(text[at - 1]);
    if (begins && (end == text.size() || !is_word_letter(text[end]))) return true;
  }
  return false;
}

// Nothing for a log of no host, or of which one cannot be told.
std::optional<std::string> host_of_log(const HostLog& log, const std::vector<std::string>& hosts) {
  if (!log.host.empty()) {
    const bool is_known = std::ranges::find(hosts, log.host) != hosts.end();
    return is_known ? std::optional(log.host) : std::nullopt;
  }
  if (hosts.size() == 1) return hosts.front();
  std::optional<std::string> found;
  for (const std::string& host : hosts) {
    if (!has_word(log.log.series, host) && !has_word(log.log.path, host)) continue;
    if (found) return std::nullopt;
    found = host;
  }
  return found;
}

void add_jump(const CameraDelays& delays, const DelayJump& jump, std::vector<HostJump>& jumps) {
  const auto is_same = [&](const HostJump& known) {
    return known.host == delays.host && std::abs(known.jump.at_s - jump.at_s) <= kAtOnceS &&
           std::abs(known.jump.step_ms - jump.step_ms) <= kAlikeJumps * std::abs(jump.step_ms);
  };
  const auto known = std::ranges::find_if(jumps, is_same);
  if (known == jumps.end()) {
    jumps.push_back({.host = delays.host, .jump = jump, .cameras = {delays.camera}, .streams = 1});
    return;
  }
  // A running mean: all are within the noise of one another.
  known->jump.step_ms +=
      (jump.step_ms - known->jump.step_ms) / static_cast<double>(++known->streams);
  known->jump.at_s = std::min(known->jump.at_s, jump.at_s);
  if (std::ranges::find(known->cameras, delays.camera) == known->cameras.end()) {
    known->cameras.push_back(delays.camera);
  }
}

std::vector<HostJump> jumps_of_hosts(const AllDelays& delays) {
  std::vector<HostJump> jumps;
  for (const auto& camera : delays) {
    if (!camera || camera->stamped_by_host) continue;
    for (const DelayJump& jump : delay_jumps(*camera)) add_jump(*camera, jump, jumps);
  }
  for (HostJump& jump : jumps) {
    jump.all_streams = static_cast<std::size_t>(std::ranges::count_if(delays, [&](const auto& one) {
      return one && !one->stamped_by_host && one->host == jump.host;
    }));
  }
  std::ranges::stable_sort(jumps, {}, [](const HostJump& jump) { return jump.jump.at_s; });
  return jumps;
}

std::vector<ClockedCamera> clocked_cameras(const std::vector<RecordedStream>& streams,
                                           const AllDelays& delays) {
  std::vector<ClockedCamera> cameras;
  for (std::size_t i = 0; i < streams.size(); ++i) {
    cameras.push_back({.camera = streams[i].camera,
                       .host = streams[i].host,
                       .stream = streams[i].stream,
                       .arrivals = range_of_stream(streams[i]),
                       .is_usable = delays[i].has_value(),
                       .shows_clock = delays[i] && !delays[i]->stamped_by_host});
    if (!delays[i]) continue;
    cameras.back().smallest_jump_ms = smallest_jump_ms(*delays[i]);
    cameras.back().steady = {delays[i]->first_s(), delays[i]->last_s()};
  }
  return cameras;
}

void place_logs(std::span<const HostLog> logs, const std::vector<std::string>& hosts,
                ClockAccount& account) {
  for (const HostLog& log : logs) {
    if (log.log.points.empty()) continue;
    const std::optional<std::string> host = host_of_log(log, hosts);
    const TimeRange arrivals = host ? range_on(*host, account.cameras) : TimeRange{};
    LoggedClock clock = logged_clock(log, arrivals);
    if (host) {
      clock.host = *host;
      clock.has_host = true;
      std::vector<DelayJump> jumps;
      for (const HostJump& jump : account.jumps) {
        if (jump.host == *host) jumps.push_back(jump.jump);
      }
      if (!std::isnan(arrivals.first_s)) place(clock, arrivals, jumps);
    }
    account.logs.push_back(std::move(clock));
  }
  for (ClockedCamera& camera : account.cameras) {
    camera.shares_time = std::ranges::any_of(account.logs, [&camera](const LoggedClock& clock) {
      return clock.has_host && clock.host == camera.host && clock.is_placed() &&
             clock.first_s() <= camera.arrivals.last_s + clock.interval_s &&
             clock.last_s() >= camera.arrivals.first_s - clock.interval_s;
    });
  }
}

// Each change is that of the nearest jump, and the other way around.
void match_steps(ClockAccount& account) {
  std::vector<bool> taken(account.jumps.size(), false);
  for (std::size_t log = 0; log < account.logs.size(); ++log) {
    LoggedClock& clock = account.logs[log];
    if (!clock.is_placed()) continue;
    for (std::size_t change = 0; change < clock.changes.size(); ++change) {
      std::optional<std::size_t> nearest;
      const auto distance_s = [&](std::size_t jump) {
        return std::abs(account.jumps[jump].jump.at_s - clock.changes[change].at_s);
      };
      for (std::size_t jump = 0; jump < account.jumps.size(); ++jump) {
        const bool fits = !taken[jump] && account.jumps[jump].host == clock.host &&
                          may_be_one(clock, clock.changes[change], account.jumps[jump].jump);
        if (fits && (!nearest || distance_s(jump) < distance_s(*nearest))) nearest = jump;
      }
      if (!nearest) continue;
      taken[*nearest] = true;
      account.matches.push_back({log, change, *nearest});
      clock.seen.push_back({change, account.jumps[*nearest].jump.at_s});
    }
  }
}

std::size_t points_during(const LoggedClock& clock, const TimeRange& range) {
  return static_cast<std::size_t>(std::ranges::count_if(
      clock.time_s, [&](double at_s) { return at_s >= range.first_s && at_s <= range.last_s; }));
}

// The logs whose sum is the error of a host's clock; those with and without signs if `summaries`.
std::vector<const LoggedClock*> chain_of(const ClockAccount& account, const std::string& host,
                                         bool summaries) {
  const TimeRange range = range_on(host, account.cameras);
  const LoggedClock* card = nullptr;
  const LoggedClock* system = nullptr;
  const LoggedClock* most = nullptr;
  const auto take_better = [&](const LoggedClock& clock, const LoggedClock*& best) {
    const auto rank = [&](const LoggedClock& one) {
      return std::pair(one.is_placed(), points_during(one, range));
    };
    if (best == nullptr || rank(clock) > rank(*best)) best = &clock;
  };
  for (const LoggedClock& clock : account.logs) {
    const bool is_used = summaries || (clock.is_placed() && !clock.are_summaries);
    if (!clock.has_host || clock.host != host || !is_used) continue;
    take_better(clock, most);
    if (clock.format == "ptp4l") take_better(clock, card);
    if (clock.format == "phc2sys") take_better(clock, system);
  }
  if (card != nullptr && system != nullptr) return {card, system};
  if (most == nullptr) return {};
  return {most};
}

double longest_interval_s(const std::vector<const LoggedClock*>& chain) {
  double longest_s = 0;
  for (const LoggedClock* clock : chain) longest_s = std::max(longest_s, clock->interval_s);
  return longest_s;
}

// Empty without a log of the host.
ErrorOfClock error_of_chain(const std::vector<const LoggedClock*>& chain) {
  if (chain.empty()) return {};
  return [chain](double at_s) {
    double sum_s = 0;
    for (const LoggedClock* clock : chain) sum_s += clock->error_at(at_s);
    return sum_s;
  };
}

void note_explanations(const AllDelays& delays, ClockAccount& account) {
  for (const auto& camera : delays) {
    if (!camera || camera->stamped_by_host) continue;
    const auto chain = chain_of(account, camera->host, false);
    if (chain.empty()) continue;
    account.explanations.push_back(
        explained_by(*camera, longest_interval_s(chain), error_of_chain(chain)));
  }
}

// With the hosts' logs, or where those cover too little, without.
std::optional<SpreadBudget> budget_with_logs(const ClockAccount& account, SpreadSide one,
                                             SpreadSide other) {
  if (one.delays.host != other.delays.host) {
    one.error_s = error_of_chain(chain_of(account, one.delays.host, false));
    other.error_s = error_of_chain(chain_of(account, other.delays.host, false));
    if (one.error_s && other.error_s) {
      if (auto budget = spread_budget(one, other)) return budget;
    }
    one.error_s = {};
    other.error_s = {};
  }
  return spread_budget(one, other);
}

void note_budgets(const AllDelays& delays, const ClockAccountOptions& options,
                  ClockAccount& account) {
  const auto side = [&](std::size_t i) {
    const bool has = i < options.exposures_ms.size();
    return SpreadSide{.delays = *delays[i],
                      .exposures_ms = has ? std::span<const double>(options.exposures_ms[i])
                                          : std::span<const double>()};
  };
  for (std::size_t i = 0; i < delays.size(); ++i) {
    if (!delays[i]) continue;
    const auto is_like = [&](const std::optional<CameraDelays>& one) {
      return one && one->stream == delays[i]->stream;
    };
    const auto first =
        static_cast<std::size_t>(std::ranges::find_if(delays, is_like) - delays.begin());
    if (first == i) continue;
    if (auto budget = budget_with_logs(account, side(i), side(first))) {
      account.budgets.push_back(std::move(*budget));
    }
  }
}

}  // namespace

double host_within_s(const ClockAccount& account, const std::string& host, double begin_s,
                     double end_s) {
  const auto chain = chain_of(account, host, true);
  if (chain.empty()) return kNan;
  double sum_s = 0;
  for (const LoggedClock* clock : chain) sum_s += clock->within_s(begin_s, end_s);
  return sum_s;
}

std::string clock_time_text(double time_s) {
  if (!is_from_1970(time_s)) return fmt::format("{:.1f} s", time_s);
  return fmt::format("{:%Y-%m-%d %H:%M:%S} UTC",
                     fmt::gmtime(static_cast<std::time_t>(std::floor(time_s))));
}

ClockAccount clock_account(const std::vector<RecordedStream>& streams,
                           std::span<const HostLog> logs, const ClockAccountOptions& options) {
  AllDelays delays;
  for (const RecordedStream& stream : streams) delays.push_back(camera_delays(stream));
  ClockAccount account{.cameras = clocked_cameras(streams, delays),
                       .jumps = jumps_of_hosts(delays)};
  for (const ClockedCamera& camera : account.cameras) {
    account.zero_s = std::fmin(account.zero_s, camera.arrivals.first_s);
  }
  place_logs(logs, hosts_with_cameras(streams), account);
  match_steps(account);
  note_explanations(delays, account);
  note_budgets(delays, options, account);
  account.findings = clock_findings(account);
  return account;
}

}  // namespace simbench::evaluation
