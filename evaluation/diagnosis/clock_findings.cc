// The sentences of an account of clock logs (clock_account.h).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <optional>
#include <utility>

#include "evaluation/diagnosis/clock_account.h"
#include "recording/counted.h"

namespace simbench::evaluation {
namespace {

constexpr std::size_t kMostNamed = 4;
constexpr std::size_t kMostOfKind = 4;  // findings of one kind and host; the others are counted
constexpr double kEqualSteps = 0.1;     // of their median
constexpr std::size_t kFewestRepeats = 3;
constexpr std::size_t kFewestBrief = 5;  // of steps that do not last, which outliers are, too
constexpr double kSureTimes = 3;         // of what is large: a step that need not last
constexpr double kExplains = 0.5;        // of the variance
constexpr double kExplainsNot = 0.1;
constexpr double kLeastMoveMs = 0.05;  // of the slow part, to be worth a sentence
constexpr double kLeastApartMs = 1;
constexpr double kLeastApartPeriods = 0.02;
constexpr double kWithinApart = 0.1;  // clocks so much closer than the cameras are no cause
constexpr double kFullHarmMs = 10;    // and more
constexpr double kBesideEndS = 1;     // a jump so near an end of the recording does not show

// "-250.1 ms", "0.0123 ms".
std::string ms_of(double value_ms) {
  return std::abs(value_ms) >= 100 ? fmt::format("{:.1f} ms", value_ms)
                                   : fmt::format("{:.3g} ms", value_ms);
}

std::string signed_ms_of(double value_ms) { return (value_ms > 0 ? "+" : "") + ms_of(value_ms); }

// Only all of it is 100 %. Parts that work against each other may be more.
std::string percent_of_share(double share) {
  if (share < 1 && share >= 0.995) return "more than 99 %";
  return fmt::format("{:.0f} %", 100 * std::min(share, 1.0));
}

// "2 h", "5 h 30 min".
std::string hours_of(double size_s) {
  const auto minutes = static_cast<int>(std::lround(std::abs(size_s) / 60));
  if (minutes % 60 == 0) return fmt::format("{} h", minutes / 60);
  return fmt::format("{} h {} min", minutes / 60, minutes % 60);
}

// "a, b and 3 more", each once.
std::string some_names(const std::vector<std::string>& all) {
  std::vector<std::string> distinct;
  for (const std::string& name : all) {
    if (std::ranges::find(distinct, name) == distinct.end()) distinct.push_back(name);
  }
  const std::size_t shown = std::min(distinct.size(), kMostNamed);
  std::string text;
  for (std::size_t i = 0; i < shown; ++i) text += (i == 0 ? "" : ", ") + distinct[i];
  if (shown < distinct.size()) text += fmt::format(" and {} more", distinct.size() - shown);
  return text;
}

std::string cameras_named(const std::vector<std::string>& all) {
  const bool is_one = std::ranges::all_of(all, [&](const auto& name) { return name == all[0]; });
  return (is_one ? "camera " : "cameras ") + some_names(all);
}

std::string host_named(const std::string& host) {
  return host.empty() ? "the host" : "host " + host;
}

double harm_of_ms(double size_ms) { return std::clamp(std::abs(size_ms) / kFullHarmMs, 0.0, 1.0); }

std::string log_named(const LoggedClock& clock) {
  return clock.series.empty() ? clock.file : fmt::format("{} ({})", clock.file, clock.series);
}

std::string time_range_text(double first_s, double last_s) {
  return fmt::format("{} to {}", clock_time_text(first_s), clock_time_text(last_s));
}

class ClockTeller {
 public:
  explicit ClockTeller(const ClockAccount& account) : account_(account) {}

  std::vector<ClockFinding> tell() {
    for (const LoggedClock& clock : account_.logs) tell_place(clock);
    tell_hosts();
    tell_cameras();
    tell_steps();
    tell_slews();
    tell_jumps();
    for (const LoggedClock& clock : account_.logs) tell_another_program(clock);
    for (const std::string& host : hosts()) tell_explanations(host);
    tell_coarse_logs();
    tell_pairs();
    std::ranges::stable_sort(found_, std::ranges::greater{}, &ClockFinding::harm);
    return std::move(found_);
  }

 private:
  void say(std::string kind, const std::string& host, double harm, std::string text) {
    found_.push_back(
        {.kind = std::move(kind), .text = std::move(text), .host = host, .harm = harm});
  }

  // Seconds since the first arrival.
  std::string since_start(double at_s) const {
    return fmt::format("{:.1f} s", at_s - account_.zero_s);
  }

  std::vector<std::string> hosts() const {
    std::vector<std::string> all;
    for (const ClockedCamera& camera : account_.cameras) {
      if (std::ranges::find(all, camera.host) == all.end()) all.push_back(camera.host);
    }
    return all;
  }

  std::vector<std::string> cameras_of(const std::string& host) const {
    std::vector<std::string> all;
    for (const ClockedCamera& camera : account_.cameras) {
      if (camera.host == host) all.push_back(camera.camera);
    }
    return all;
  }

  TimeRange range_of(const std::string& host) const {
    TimeRange all;
    for (const ClockedCamera& camera : account_.cameras) {
      if (camera.host != host) continue;
      all.first_s = std::fmin(all.first_s, camera.arrivals.first_s);
      all.last_s = std::fmax(all.last_s, camera.arrivals.last_s);
    }
    return all;
  }

  // What a log that is nowhere on the time scale says all the same.
  static std::string still_shown(const LoggedClock& clock) {
    std::string text = fmt::format("; still shown: its errors are within {} over the whole log",
                                   ms_of(1e3 * clock.within_s(0, 0)));
    double largest_s = 0;
    std::uint64_t steps = 0;
    for (const LoggedChange& change : clock.changes) {
      if (change.is_slew || !change.lasts) continue;
      ++steps;
      if (std::abs(change.by_s) > std::abs(largest_s)) largest_s = change.by_s;
    }
    if (steps > 0) {
      text += fmt::format(", with {}, the largest of {}", counted(steps, "step"),
                          signed_ms_of(1e3 * largest_s));
    }
    return text;
  }

  void tell_place(const LoggedClock& clock) {
    if (!clock.has_host) return tell_no_host(clock);
    if (clock.are_summaries) {
      say("log_of_summaries", clock.host, 0.2,
          fmt::format("{} has summaries (rms, max), which have no sign: only the largest error is "
                      "used; a line for each update shows more (summary_interval of ptp4l, -u 0 "
                      "of phc2sys)",
                      log_named(clock)));
    }
    if (clock.daylight_saving) tell_daylight_saving(clock);
    if (clock.placing == LogPlacing::kByZone) {
      say("log_in_local_time", clock.host, 0.1,
          fmt::format("{} is {} {} the arrivals, as local time is{}: taken off{}", log_named(clock),
                      hours_of(clock.shift_s), clock.shift_s < 0 ? "ahead of" : "behind",
                      clock.daylight_saving ? " (before the change)" : "",
                      clock.other_zones_fit ? "; other zones would fit as well" : ""));
    }
    if (clock.placing == LogPlacing::kBySteps) {
      say("log_placed_by_steps", clock.host, 0.1,
          fmt::format("{} has another zero of time than the arrivals: it is placed by the steps "
                      "that both show, to within {:.3g} s",
                      log_named(clock), 1 + 2 * clock.interval_s));
    }
    if (!clock.is_placed()) tell_nowhere(clock);
  }

  void tell_no_host(const LoggedClock& clock) {
    const std::string known = some_names(hosts());
    say("log_of_no_host", clock.said_host, 0.3,
        clock.said_host.empty()
            ? fmt::format("{} names no host, and the recording has several ({}): say whose it is, "
                          "HOST={}{}",
                          log_named(clock), known, clock.file, still_shown(clock))
            : fmt::format("{} is of host {}, which has no camera here (hosts: {}){}",
                          log_named(clock), clock.said_host, known, still_shown(clock)));
  }

  void tell_daylight_saving(const LoggedClock& clock) {
    const DaylightSaving& change = *clock.daylight_saving;
    say("daylight_saving", clock.host, 0.1,
        fmt::format("the times of {} jump by an hour {} behind {}, as local time does where "
                    "daylight saving {}: the later ones are moved by an hour",
                    log_named(clock), change.by_s > 0 ? "forth" : "back",
                    fmt::format("{:.19}", clock_time_text(change.at_s)),
                    change.by_s > 0 ? "begins" : "ends"));
  }

  void tell_nowhere(const LoggedClock& clock) {
    const TimeRange range = range_of(clock.host);
    const bool arrivals_from_1970 = is_from_1970(range.first_s);
    const std::string both =
        fmt::format("it has {}, the arrivals {}", time_range_text(clock.first_s(), clock.last_s()),
                    time_range_text(range.first_s, range.last_s));
    if (clock.from_1970 && arrivals_from_1970) {
      say("log_of_another_day", clock.host, 0.5,
          fmt::format("{} is of another time: {}{}", log_named(clock), both, still_shown(clock)));
    } else if (!clock.from_1970 && arrivals_from_1970) {
      say("log_from_boot", clock.host, 0.4,
          fmt::format("{} counts from the boot of its host, the arrivals from 1970, and no step of "
                      "it is a jump of theirs: {}; take it with dates (journalctl -o short-iso){}",
                      log_named(clock), both, still_shown(clock)));
    } else {
      say("no_common_time", clock.host, 0.4,
          fmt::format("{} and the arrivals share no time: {}{}", log_named(clock), both,
                      still_shown(clock)));
    }
  }

  bool has_log(const std::string& host) const {
    return std::ranges::any_of(account_.logs, [&host](const LoggedClock& clock) {
      return clock.has_host && clock.host == host;
    });
  }

  bool has_placed_log(const std::string& host) const {
    return std::ranges::any_of(account_.logs, [&host](const LoggedClock& clock) {
      return clock.has_host && clock.host == host && clock.is_placed();
    });
  }

  void tell_hosts() {
    if (account_.logs.empty()) return;
    for (const std::string& host : hosts()) {
      if (has_log(host)) continue;
      say("host_without_log", host, 0.3,
          fmt::format("no log is of {} ({}): how far its clock is off is unknown; still shown: "
                      "jumps of its arrivals, and its stamps and delays",
                      host_named(host), cameras_named(cameras_of(host))));
    }
  }

  void tell_cameras() {
    std::vector<std::string> apart;
    for (const ClockedCamera& camera : account_.cameras) {
      if (std::isnan(camera.arrivals.first_s)) continue;
      if (!camera.is_usable) {
        say("unusable_stamps", camera.host, 0.2,
            fmt::format("camera {} ({}): fewer than 30 frames, stamps of another unit, or arrivals "
                        "that are the stamps: it shows nothing of a clock",
                        camera.camera, camera.stream));
      }
      if (has_placed_log(camera.host) && !camera.shares_time) apart.push_back(camera.camera);
    }
    if (apart.empty()) return;
    say("no_common_time", {}, 0.4,
        fmt::format("{} share{} no time with any log of the host: still shown are jumps, stamps "
                    "and delays",
                    cameras_named(apart), apart.size() == 1 ? "s" : ""));
  }

  bool is_matched(std::size_t log, std::size_t change) const {
    return std::ranges::any_of(account_.matches, [&](const MatchedStep& match) {
      return match.log == log && match.change == change;
    });
  }

  void tell_steps() {
    for (const MatchedStep& match : account_.matches) {
      const LoggedClock& clock = account_.logs[match.log];
      const LoggedChange& change = clock.changes[match.change];
      const HostJump& jump = account_.jumps[match.jump];
      say("host_clock_step", clock.host, harm_of_ms(jump.jump.step_ms),
          fmt::format("the clock of {} was set by {} at {}; the arrivals of {} jump by {} then: "
                      "the clock, not the cameras",
                      host_named(clock.host), signed_ms_of(1e3 * change.by_s),
                      since_start(change.at_s), cameras_named(jump.cameras),
                      signed_ms_of(jump.jump.step_ms)));
    }
    for (std::size_t log = 0; log < account_.logs.size(); ++log) tell_lone_steps(log);
  }

  // The smallest jump that a camera of the host would show; NaN if none shows its clock.
  double smallest_shown_ms(const std::string& host) const {
    double smallest_ms = kNan;
    for (const ClockedCamera& camera : account_.cameras) {
      if (camera.host != host || !camera.shows_clock) continue;
      smallest_ms = std::fmin(smallest_ms, camera.smallest_jump_ms);
    }
    return smallest_ms;
  }

  // When the cameras of a host would show a jump.
  TimeRange steady_range(const std::string& host) const {
    TimeRange all;
    for (const ClockedCamera& camera : account_.cameras) {
      if (camera.host != host || !camera.shows_clock) continue;
      all.first_s = std::fmin(all.first_s, camera.steady.first_s);
      all.last_s = std::fmax(all.last_s, camera.steady.last_s);
    }
    return all;
  }

  // Steps of a log during the recording that no arrival shows.
  void tell_lone_steps(std::size_t log) {
    const LoggedClock& clock = account_.logs[log];
    if (!clock.is_placed()) return;
    const TimeRange range = steady_range(clock.host);
    const double shown_ms = smallest_shown_ms(clock.host);
    std::uint64_t small = 0;
    double largest_ms = 0;
    for (std::size_t i = 0; i < clock.changes.size(); ++i) {
      const LoggedChange& change = clock.changes[i];
      const double by_ms = 1e3 * change.by_s;
      const bool is_inside =
          change.at_s > range.first_s + kBesideEndS && change.until_s < range.last_s - kBesideEndS;
      if (change.is_slew || !change.lasts || !is_inside || is_matched(log, i)) continue;
      if (std::abs(by_ms) > 2 * shown_ms) {
        say("unseen_step", clock.host, 0.3,
            fmt::format("{} has a step of {} at {}, but the arrivals of {} do not jump then: its "
                        "reference was set, or the log is of another clock",
                        log_named(clock), signed_ms_of(by_ms), since_start(change.at_s),
                        cameras_named(cameras_of(clock.host))));
      } else {
        ++small;
        if (std::abs(by_ms) > std::abs(largest_ms)) largest_ms = by_ms;
      }
    }
    if (small == 0) return;
    say("host_clock_step", clock.host, harm_of_ms(largest_ms),
        fmt::format("{} has {} during the recording of up to {}, which the arrivals do not show",
                    log_named(clock), counted(small, "step"), signed_ms_of(largest_ms)));
  }

  void tell_slews() {
    for (const LoggedClock& clock : account_.logs) {
      if (!clock.is_placed()) continue;
      const TimeRange range = range_of(clock.host);
      std::vector<const LoggedChange*> slews;
      for (const LoggedChange& change : clock.changes) {
        const bool is_inside = change.until_s > range.first_s && change.at_s < range.last_s;
        if (change.is_slew && is_inside) slews.push_back(&change);
      }
      if (slews.empty()) continue;
      const LoggedChange& most = **std::ranges::max_element(
          slews, {}, [](const LoggedChange* slew) { return std::abs(slew->by_s); });
      const std::string others =
          slews.size() > 1 ? fmt::format(", the largest of {}", counted(slews.size(), "slew")) : "";
      say("host_clock_slew", clock.host, harm_of_ms(1e3 * most.by_s),
          fmt::format("the clock of {} was slewed by {} from {} to {}, {:.0f} ppm, by its log{}",
                      host_named(clock.host), signed_ms_of(1e3 * most.by_s), since_start(most.at_s),
                      since_start(most.until_s), 1e6 * most.by_s / (most.until_s - most.at_s),
                      others));
    }
  }

  bool log_covers(const std::string& host, double at_s) const {
    return std::ranges::any_of(account_.logs, [&](const LoggedClock& clock) {
      return clock.has_host && clock.host == host && clock.is_placed() && !clock.are_summaries &&
             clock.first_s() <= at_s && clock.last_s() >= at_s;
    });
  }

  void tell_jumps() {
    for (std::size_t i = 0; i < account_.jumps.size(); ++i) {
      const bool is_known = std::ranges::any_of(
          account_.matches, [i](const MatchedStep& match) { return match.jump == i; });
      if (is_known || account_.logs.empty()) continue;
      const HostJump& jump = account_.jumps[i];
      const bool all = jump.streams == jump.all_streams && jump.cameras.size() > 1;
      std::string cause = all ? "all cameras of the host at once: its clock was set, it seems"
                              : "not all cameras of the host: not its clock";
      if (jump.all_streams == 1)
        cause = "one camera alone does not tell whether its host's clock was set";
      const std::string log = log_covers(jump.host, jump.jump.at_s)
                                  ? "the log has no such step then"
                                  : "no log covers that time";
      say("unexplained_jump", jump.host, harm_of_ms(jump.jump.step_ms),
          fmt::format("the arrivals of {} on {} jump by {} at {}; {}; {}",
                      cameras_named(jump.cameras), host_named(jump.host),
                      signed_ms_of(jump.jump.step_ms), since_start(jump.jump.at_s), log, cause));
    }
  }

  // Steps away from zero that are equal, if most are.
  static std::vector<LoggedChange> equal_steps(const LoggedClock& clock) {
    std::vector<LoggedChange> away;
    std::ranges::copy_if(clock.changes, std::back_inserter(away),
                         [](const LoggedChange& change) { return !change.is_slew && change.away; });
    std::vector<double> sizes;
    sizes.reserve(away.size());
    for (const LoggedChange& step : away) sizes.push_back(step.by_s);
    const double usual_s = median(std::move(sizes));
    std::vector<LoggedChange> equal;
    std::ranges::copy_if(away, std::back_inserter(equal), [&](const LoggedChange& step) {
      const bool is_sure = step.lasts || std::abs(step.by_s) > kSureTimes * clock.large_s;
      return is_sure && std::abs(step.by_s - usual_s) <= kEqualSteps * std::abs(usual_s);
    });
    return 3 * equal.size() >= 2 * away.size() ? equal : std::vector<LoggedChange>();
  }

  void tell_another_program(const LoggedClock& clock) {
    const std::vector<LoggedChange> steps = equal_steps(clock);
    std::vector<LoggedChange> slews;
    for (const LoggedChange& change : clock.changes) {
      if (change.is_slew && change.away) slews.push_back(change);
    }
    const std::string whose = clock.has_host ? "the clock of " + host_named(clock.host)
                                             : "the clock of " + log_named(clock);
    const auto lasting = std::ranges::count_if(steps, &LoggedChange::lasts);
    const bool repeats =
        lasting >= static_cast<std::ptrdiff_t>(kFewestRepeats) || steps.size() >= kFewestBrief;
    if (repeats) {
      const double span_s = steps.back().at_s - steps.front().at_s;
      say("another_program", clock.host, std::max(0.5, harm_of_ms(1e3 * steps.front().by_s)),
          fmt::format("another program sets {}: {} equal steps of {} away from its reference, one "
                      "in {:.3g} s, and the servo pulls back between them",
                      whose, steps.size(), signed_ms_of(1e3 * steps.front().by_s),
                      span_s / static_cast<double>(steps.size() - 1)));
    }
    if (slews.size() >= kFewestRepeats) {
      const LoggedChange& first = slews.front();
      say("another_program", clock.host, std::max(0.5, harm_of_ms(1e3 * first.by_s)),
          fmt::format("another program slews {}: {} away from its reference at more than a "
                      "crystal's rate, the first by {} at {:.0f} ppm",
                      whose, counted(slews.size(), "slew"), signed_ms_of(1e3 * first.by_s),
                      1e6 * first.by_s / (first.until_s - first.at_s)));
    }
  }

  void tell_explanations(const std::string& host) {
    std::vector<const ClockExplanation*> explained;
    std::vector<const ClockExplanation*> others;
    for (const ClockExplanation& one : account_.explanations) {
      if (one.host != host || !one.moves() || !(one.before_ms > kLeastMoveMs)) continue;
      if (one.share >= kExplains) explained.push_back(&one);
      if (one.share < kExplainsNot) others.push_back(&one);
    }
    const auto cameras = [](const std::vector<const ClockExplanation*>& all) {
      std::vector<std::string> found;
      found.reserve(all.size());
      for (const ClockExplanation* one : all) found.push_back(one->camera);
      return cameras_named(found);
    };
    const auto by_share = [](const ClockExplanation* one) { return one->share; };
    if (!explained.empty()) {
      const ClockExplanation& least = **std::ranges::min_element(explained, {}, by_share);
      say("clocks_explain", host, harm_of_ms(least.before_ms),
          fmt::format("the clock of {} explains {} of how the delays of {} move ({} "
                      "before, {} after it is subtracted)",
                      host_named(host), percent_of_share(least.share), cameras(explained),
                      ms_of(least.before_ms), ms_of(least.after_ms)));
    }
    if (!others.empty()) {
      const ClockExplanation& most = **std::ranges::max_element(others, {}, by_share);
      say("clocks_do_not_explain", host, harm_of_ms(most.before_ms),
          fmt::format("the delays of {} move by {}, which the log of {} does not explain ({}; the "
                      "factor that fits best is {:.2f} [{:.2f}, {:.2f}], a clock's is 1)",
                      cameras(others), ms_of(most.before_ms), host_named(host),
                      percent_of_share(most.share), most.coefficient, most.coefficient_low,
                      most.coefficient_high));
    }
  }

  void tell_coarse_logs() {
    for (const std::string& host : hosts()) {
      std::uint64_t all = 0;
      std::uint64_t coarse = 0;
      for (const ClockExplanation& one : account_.explanations) {
        if (one.host != host) continue;
        ++all;
        if (std::isnan(one.share)) ++coarse;
      }
      if (all == 0 || coarse < all) continue;
      say("log_too_coarse", host, 0.2,
          fmt::format("the log of {} has too few points beside the recording to tell what it "
                      "explains of the delays (12 are needed); still shown: how far the clock is "
                      "off, and its steps",
                      host_named(host)));
    }
  }

  // For each two hosts, the pair that is farthest apart.
  void tell_pairs() {
    std::vector<const SpreadBudget*> told;
    for (const SpreadBudget& budget : account_.budgets) {
      if (budget.host == budget.host_against) continue;
      const auto same_hosts = [&](const SpreadBudget* other) {
        return other->host == budget.host && other->host_against == budget.host_against;
      };
      const auto known = std::ranges::find_if(told, same_hosts);
      if (known == told.end()) {
        told.push_back(&budget);
      } else if (std::abs(budget.constant_ms) > std::abs((*known)->constant_ms)) {
        *known = &budget;
      }
    }
    for (const SpreadBudget* budget : told) {
      tell_locked_but_apart(*budget);
      tell_spread_by_clocks(*budget);
    }
  }

  void tell_locked_but_apart(const SpreadBudget& pair) {
    const TimeRange one = range_of(pair.host);
    const TimeRange other = range_of(pair.host_against);
    const double within_ms =
        1e3 * (host_within_s(account_, pair.host, one.first_s, one.last_s) +
               host_within_s(account_, pair.host_against, other.first_s, other.last_s));
    const bool by_stamps = std::abs(pair.stamps_apart_ms) < pair.period_ms;
    const double apart_ms = std::abs(by_stamps ? pair.stamps_apart_ms : pair.constant_ms);
    const bool is_apart = apart_ms > std::max(kLeastApartMs, kLeastApartPeriods * pair.period_ms);
    if (!is_apart || !(within_ms < kWithinApart * apart_ms)) return;
    const std::string cameras = fmt::format("{} and {}", pair.camera, pair.against);
    const std::string apart =
        by_stamps ? fmt::format("the exposures of {} are {} apart by their stamps", cameras,
                                ms_of(apart_ms))
                  : fmt::format("the frames of {} arrive {} apart", cameras, ms_of(apart_ms));
    // Exposures apart are what the question was about; arrivals may be.
    constexpr double kLeastOfExposures = 0.4;
    say("locked_but_apart", {},
        std::clamp(2 * apart_ms / pair.period_ms, by_stamps ? kLeastOfExposures : 0.0, 1.0),
        fmt::format("the clocks of hosts {} and {} are within {} by their logs, but {}: the clocks "
                    "are not the cause, {}",
                    pair.host, pair.host_against, ms_of(within_ms), apart,
                    by_stamps ? "the start of the exposures is (trigger, phase of the cameras)"
                              : "the exposures or the ways of the frames are"));
  }

  void tell_spread_by_clocks(const SpreadBudget& pair) {
    const bool is_cause =
        pair.host_clock.share >= kExplains && pair.host_clock.rms_ms > kLeastMoveMs;
    if (!is_cause) return;
    say("spread_by_clocks", {}, harm_of_ms(pair.host_clock.rms_ms),
        fmt::format("the clocks of hosts {} and {} are {} (RMS) apart by their logs: {} of the "
                    "spread of {} and {}",
                    pair.host, pair.host_against, ms_of(pair.host_clock.rms_ms),
                    percent_of_share(pair.host_clock.share), pair.camera, pair.against));
  }

  const ClockAccount& account_;
  std::vector<ClockFinding> found_;
};

// A kind that a host has often is told a few times and then counted.
std::vector<ClockFinding> without_repeated(std::vector<ClockFinding> all) {
  std::vector<ClockFinding> kept;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto is_like = [&](const ClockFinding& other) {
      return other.kind == all[i].kind && other.host == all[i].host;
    };
    const auto before =
        std::count_if(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(i), is_like);
    const auto later =
        std::count_if(all.begin() + static_cast<std::ptrdiff_t>(i) + 1, all.end(), is_like);
    if (before >= static_cast<std::ptrdiff_t>(kMostOfKind)) continue;
    kept.push_back(all[i]);
    if (before + 1 == static_cast<std::ptrdiff_t>(kMostOfKind) && later > 0) {
      kept.back().text += fmt::format("; and {} more like it", later);
    }
  }
  return kept;
}

}  // namespace

std::vector<ClockFinding> clock_findings(const ClockAccount& account) {
  return without_repeated(ClockTeller(account).tell());
}

}  // namespace simbench::evaluation
