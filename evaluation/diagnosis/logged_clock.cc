#include "evaluation/diagnosis/logged_clock.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

#include "evaluation/stability/log_entry.h"

namespace simbench::evaluation {
namespace {

constexpr double kHourS = 3600;
constexpr double kTwentyYearsS = 20 * 365.25 * 86400;
constexpr double kGapIntervals = 5;
// An hour's jump of the times is known to within so much of an interval, if points are close.
constexpr double kOfInterval = 0.5;
constexpr double kLongestIntervalS = kHourS / 4;
constexpr double kLeastChangeS = 10e-6;
constexpr double kScatters = 10;
constexpr double kCrystalRate = 200e-6;
constexpr std::size_t kFewestOfSlew = 3;  // differences
constexpr std::size_t kBeside = 3;        // points
constexpr double kAlikeShare = 0.2;
constexpr double kNearIntervals = 2;
constexpr double kNearS = 1;
constexpr double kEnoughOverlap = 0.5;  // of the shorter of log and recording
// Zones in use that are no whole hours, in minutes (tz database, 2024).
constexpr std::array<int, 12> kOddZonesMin = {-570, -210, -150, 210, 270, 330,
                                              345,  390,  525,  570, 630, 765};
constexpr std::size_t kMostMatched = 30;  // steps and jumps that place a log
constexpr int kFirstZoneH = -12;
constexpr int kLastZoneH = 14;

// The points in order of the log while it is made.
struct LogPointRow {
  std::vector<double> time_s;
  std::vector<double> error_s;
  double interval_s = kNan;

  std::size_t size() const { return time_s.size(); }
  double distance_s(std::size_t i) const { return time_s[i] - time_s[i - 1]; }
  double change_s(std::size_t i) const { return error_s[i] - error_s[i - 1]; }
  // A clock that is set takes the times of its log along.
  bool is_gap(std::size_t i) const {
    const double more_s = distance_s(i) - interval_s;
    const bool was_set = std::abs(more_s - change_s(i)) <= 2 * interval_s;
    return (distance_s(i) > kGapIntervals * interval_s || distance_s(i) < 0) && !was_set;
  }
};

double median_distance(const std::vector<double>& time_s) {
  std::vector<double> distances;
  for (std::size_t i = 1; i < time_s.size(); ++i) {
    if (time_s[i] > time_s[i - 1]) distances.push_back(time_s[i] - time_s[i - 1]);
  }
  return median(std::move(distances));
}

double common_s(const TimeRange& a, const TimeRange& b) {
  return std::min(a.last_s, b.last_s) - std::max(a.first_s, b.first_s);
}

// The begin and end of the part of a log from a boot that is of the recording's boot.
std::pair<std::size_t, std::size_t> one_boot(const ClockLog& log, const TimeRange& of_arrivals) {
  std::vector<std::size_t> bounds = {0};
  bounds.insert(bounds.end(), log.segments.begin(), log.segments.end());
  bounds.push_back(log.points.size());
  const auto seconds = [&log](std::size_t i) {
    return 1e-6 * static_cast<double>(log.points[i].time.count());
  };
  std::pair best = {bounds[bounds.size() - 2], bounds.back()};
  double most_s = 0;
  for (std::size_t part = 0; part + 1 < bounds.size(); ++part) {
    const double both_s =
        common_s({seconds(bounds[part]), seconds(bounds[part + 1] - 1)}, of_arrivals);
    if (!(both_s > most_s)) continue;
    most_s = both_s;
    best = {bounds[part], bounds[part + 1]};
  }
  return best;
}

// When the boot was that each point counts from, if all have one and arrivals count from 1970.
std::vector<double> boots_of(const ClockLog& log, const TimeRange& of_arrivals) {
  const bool known = !log.boots.empty() && log.boots.front().point == 0 &&
                     log.boots.size() == log.segments.size() + 1;
  if (!known || !is_from_1970(of_arrivals.first_s)) return {};
  const auto arrivals_day = std::chrono::floor<std::chrono::days>(std::chrono::sys_seconds(
      std::chrono::seconds(static_cast<std::int64_t>(of_arrivals.first_s))));
  const auto year = static_cast<int>(std::chrono::year_month_day(arrivals_day).year());
  std::vector<double> boots_s;
  boots_s.reserve(log.points.size());
  std::size_t boot = 0;
  for (std::size_t i = 0; i < log.points.size(); ++i) {
    if (boot + 1 < log.boots.size() && log.boots[boot + 1].point <= i) ++boot;
    const ClockLog::Boot& of = log.boots[boot];
    boots_s.push_back(of.has_year ? of.at_s : in_year(of.at_s, year));
  }
  return boots_s;
}

// Moves what is behind the jump of an hour, of which a year has one in either direction.
std::optional<DaylightSaving> undo_daylight_saving(LogPointRow& row) {
  if (!(row.interval_s <= kLongestIntervalS)) return std::nullopt;
  const double near_s = std::max(kOfInterval * row.interval_s, 0.1);
  for (std::size_t i = 1; i < row.size(); ++i) {
    const double more_s = row.distance_s(i) - row.interval_s;
    const double by_s = std::copysign(kHourS, more_s);
    if (std::abs(more_s - by_s) > near_s) continue;
    // A clock that was set by an hour has that in its error, too.
    if (std::abs(row.change_s(i)) > kHourS / 2) continue;
    const DaylightSaving found{.at_s = row.time_s[i - 1], .by_s = by_s};
    for (std::size_t k = i; k < row.size(); ++k) row.time_s[k] -= by_s;
    return found;
  }
  return std::nullopt;
}

double median_of_points(const std::vector<double>& values, std::size_t begin, std::size_t end) {
  return median(std::vector<double>(values.begin() + static_cast<std::ptrdiff_t>(begin),
                                    values.begin() + static_cast<std::ptrdiff_t>(end)));
}

// The change that the differences [begin, end) make, all large and of one sign.
std::optional<LoggedChange> log_change_of(const LogPointRow& row, std::size_t begin,
                                          std::size_t end) {
  const double before_s = row.error_s[begin - 1];
  const double after_s = row.error_s[end - 1];
  LoggedChange change{.at_s = row.time_s[begin - 1],
                      .until_s = row.time_s[end - 1],
                      .by_s = after_s - before_s,
                      .before_s = before_s,
                      .after_s = after_s,
                      .is_slew = end - begin >= kFewestOfSlew};
  const double lasting_s =
      median_of_points(row.error_s, end - 1, std::min(row.size(), end - 1 + kBeside)) -
      median_of_points(row.error_s, begin - std::min(begin, kBeside), begin);
  change.lasts = lasting_s / change.by_s > 0.5;
  change.away = std::abs(after_s) > std::abs(before_s);
  const double rate = std::abs(change.by_s) / (change.until_s - change.at_s);
  if (change.is_slew && rate < kCrystalRate) return std::nullopt;
  return change;
}

// The differences of neighbours without gaps.
std::vector<double> steady_changes(const LogPointRow& row) {
  std::vector<double> steady;
  for (std::size_t i = 1; i < row.size(); ++i) {
    if (!row.is_gap(i)) steady.push_back(row.change_s(i));
  }
  return steady;
}

std::vector<LoggedChange> log_changes_of(const LogPointRow& row, double middle_s, double limit_s) {
  const auto sign_of_large = [&](std::size_t i) {
    if (row.is_gap(i) || std::abs(row.change_s(i) - middle_s) <= limit_s) return 0;
    return row.change_s(i) > 0 ? 1 : -1;
  };
  std::vector<LoggedChange> found;
  for (std::size_t i = 1; i < row.size();) {
    const int sign = sign_of_large(i);
    std::size_t end = i + 1;
    while (sign != 0 && end < row.size() && sign_of_large(end) == sign) ++end;
    const auto change = sign != 0 ? log_change_of(row, i, end) : std::nullopt;
    if (change) found.push_back(*change);
    i = end;
  }
  return found;
}

template <class T>
std::vector<T> in_order(const std::vector<T>& values, const std::vector<std::size_t>& order) {
  std::vector<T> sorted;
  sorted.reserve(order.size());
  for (const std::size_t i : order) sorted.push_back(values[i]);
  return sorted;
}

void sort_points(LoggedClock& clock) {
  std::vector<std::size_t> order(clock.time_s.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&clock](std::size_t i) { return clock.time_s[i]; });
  clock.error_s = in_order(clock.error_s, order);
  if (clock.are_summaries) clock.largest_s = in_order(clock.largest_s, order);
  clock.time_s = in_order(clock.time_s, order);
}

// A shift of a log's times, and what speaks for it.
struct LogShift {
  double by_s = 0;
  std::size_t matches = 0;
  double share = 0;  // of the shorter of log and recording that overlaps

  auto rank() const { return std::tuple(matches, share, -std::abs(by_s)); }
};

class LogPlacer {
 public:
  LogPlacer(const LoggedClock& clock, const TimeRange& of_arrivals,
            std::span<const DelayJump> jumps)
      : clock_(clock), of_arrivals_(of_arrivals), jumps_(jumps.begin(), jumps.end()) {
    for (const LoggedChange& change : clock.changes) {
      if (!change.is_slew && change.lasts) steps_.push_back(change);
    }
    keep_largest(steps_, [](const LoggedChange& step) { return -std::abs(step.by_s); });
    keep_largest(jumps_, [](const DelayJump& jump) { return -std::abs(jump.step_ms); });
  }

  LogShift shift(double by_s) const {
    const TimeRange log = {clock_.first_s() + by_s - clock_.interval_s,
                           clock_.last_s() + by_s + clock_.interval_s};
    const double shorter_s =
        std::min(log.last_s - log.first_s, of_arrivals_.last_s - of_arrivals_.first_s);
    return {by_s, matches(by_s), std::min(1.0, common_s(log, of_arrivals_) / shorter_s)};
  }

  // By zones: whole hours, and where none overlaps, the others.
  std::vector<LogShift> zones() const {
    std::vector<LogShift> found;
    const auto take = [&](double zone_s) {
      const LogShift moved = shift(-zone_s);
      if (moved.share >= kEnoughOverlap) found.push_back(moved);
    };
    for (int hour = kFirstZoneH; hour <= kLastZoneH; ++hour) take(hour * kHourS);
    if (!found.empty()) return found;
    for (const int minutes : kOddZonesMin) take(minutes * 60.0);
    return found;
  }

  // The only shift that most steps match; nothing if there is none.
  std::optional<LogShift> by_steps() const {
    std::vector<LogShift> found;
    for (const LoggedChange& change : steps_) {
      for (const DelayJump& jump : jumps_) {
        const LogShift moved = shift(jump.at_s - (change.at_s + change.until_s) / 2);
        if (moved.matches > 0 && moved.share > 0) found.push_back(moved);
      }
    }
    if (found.empty()) return std::nullopt;
    const LogShift best = *std::ranges::max_element(found, {}, &LogShift::matches);
    const double near_s = kNearIntervals * clock_.interval_s + kNearS;
    const bool is_only = std::ranges::none_of(found, [&](const LogShift& other) {
      return other.matches == best.matches && std::abs(other.by_s - best.by_s) > near_s;
    });
    return is_only ? std::optional(best) : std::nullopt;
  }

 private:
  std::size_t matches(double by_s) const {
    return static_cast<std::size_t>(std::ranges::count_if(steps_, [&](const LoggedChange& change) {
      return std::ranges::any_of(
          jumps_, [&](const DelayJump& jump) { return may_be_one(clock_, change, jump, by_s); });
    }));
  }

  template <class T, class Rank>
  static void keep_largest(std::vector<T>& all, Rank rank) {
    std::ranges::stable_sort(all, {}, rank);
    all.resize(std::min(all.size(), kMostMatched));
  }

  const LoggedClock& clock_;
  const TimeRange& of_arrivals_;
  std::vector<LoggedChange> steps_;
  std::vector<DelayJump> jumps_;
};

void move_log(LoggedClock& clock, LogPlacing placing, double by_s) {
  clock.placing = placing;
  clock.shift_s = by_s;
  for (double& time_s : clock.time_s) time_s += by_s;
  for (LoggedChange& change : clock.changes) {
    change.at_s += by_s;
    change.until_s += by_s;
  }
}

// Both count from 1970.
void place_by_zone(LoggedClock& clock, const LogPlacer& placer) {
  const std::vector<LogShift> zones = placer.zones();
  const LogShift as_is = placer.shift(0);
  if (zones.empty()) {
    if (as_is.share > 0) move_log(clock, LogPlacing::kAsIs, 0);
    return;
  }
  const LogShift best = *std::ranges::max_element(zones, {}, &LogShift::rank);
  const bool is_utc = !clock.daylight_saving && as_is.share > 0 && as_is.matches >= best.matches;
  const double by_s = is_utc ? 0 : best.by_s;
  clock.other_zones_fit =
      !is_utc && std::ranges::count_if(zones, [&best](const LogShift& other) {
                   return other.matches == best.matches && other.share >= best.share;
                 }) > 1;
  move_log(clock, by_s == 0 ? LogPlacing::kAsIs : LogPlacing::kByZone, by_s);
}

}  // namespace

bool is_from_1970(double time_s) { return time_s > kTwentyYearsS; }

std::optional<double> LoggedClock::error_beside_step(double at_s) const {
  for (const SeenStep& step : seen) {
    const LoggedChange& change = changes[step.change];
    const double again_s = step.at_s + std::min(0.0, change.by_s);
    const bool is_beside =
        at_s > std::min(change.at_s, again_s) && at_s < std::max(change.until_s, step.at_s);
    if (!is_beside) continue;
    if (at_s > step.at_s) return change.after_s;
    return at_s > again_s && again_s < step.at_s ? kNan : change.before_s;
  }
  return std::nullopt;
}

double LoggedClock::error_at(double at_s) const {
  if (const std::optional<double> beside = error_beside_step(at_s)) return *beside;
  const auto next = std::ranges::lower_bound(time_s, at_s);
  if (are_summaries || next == time_s.end()) return kNan;
  const auto i = static_cast<std::size_t>(next - time_s.begin());
  if (time_s[i] == at_s) return error_s[i];
  if (i == 0 || time_s[i] - time_s[i - 1] > kGapIntervals * interval_s) return kNan;
  const double share = (at_s - time_s[i - 1]) / (time_s[i] - time_s[i - 1]);
  return error_s[i - 1] + share * (error_s[i] - error_s[i - 1]);
}

double LoggedClock::within_s(double begin_s, double end_s) const {
  double largest = kNan;
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    if (is_placed() && (time_s[i] < begin_s || time_s[i] > end_s)) continue;
    const double size_s = are_summaries ? largest_s[i] : std::abs(error_s[i]);
    if (!(largest >= size_s)) largest = size_s;
  }
  return largest;
}

LoggedClock logged_clock(const HostLog& log, const TimeRange& of_arrivals) {
  const ClockLog& read = log.log;
  LoggedClock clock{.said_host = log.host,
                    .file = read.path,
                    .series = read.series,
                    .format = read.format,
                    .are_summaries = read.are_summaries()};
  const std::vector<double> boots_s = boots_of(read, of_arrivals);
  clock.from_1970 = !boots_s.empty() ||
                    is_from_1970(1e-6 * static_cast<double>(read.points.front().time.count()));
  const auto [begin, end] =
      clock.from_1970 ? std::pair(std::size_t{0}, read.points.size()) : one_boot(read, of_arrivals);
  LogPointRow row;
  for (std::size_t i = begin; i < end; ++i) {
    const double boot_s = boots_s.empty() ? 0 : boots_s[i];
    row.time_s.push_back(boot_s + 1e-6 * static_cast<double>(read.points[i].time.count()));
    row.error_s.push_back(read.points[i].error_s);
    if (clock.are_summaries) clock.largest_s.push_back(read.largest_s[i]);
  }
  row.interval_s = median_distance(row.time_s);
  if (clock.from_1970) clock.daylight_saving = undo_daylight_saving(row);
  if (!clock.are_summaries) {
    const std::vector<double> steady = steady_changes(row);
    clock.large_s = std::max(kLeastChangeS, kScatters * robust_deviation(steady));
    clock.changes = log_changes_of(row, median(steady), clock.large_s);
  }
  clock.interval_s = std::isnan(row.interval_s) ? 0 : row.interval_s;
  clock.time_s = std::move(row.time_s);
  clock.error_s = std::move(row.error_s);
  sort_points(clock);
  return clock;
}

bool may_be_one(const LoggedClock& clock, const LoggedChange& change, const DelayJump& jump,
                double shift_s) {
  const double near_s = kNearIntervals * clock.interval_s + kNearS;
  const double step_s = 1e-3 * jump.step_ms;
  const bool is_alike = std::abs(step_s - change.by_s) <= kAlikeShare * std::abs(change.by_s);
  return !change.is_slew && is_alike && jump.at_s >= change.at_s + shift_s - near_s &&
         jump.at_s <= change.until_s + shift_s + near_s;
}

void place(LoggedClock& clock, const TimeRange& of_arrivals, std::span<const DelayJump> jumps) {
  const LogPlacer placer(clock, of_arrivals, jumps);
  const bool same_base = clock.from_1970 == is_from_1970(of_arrivals.first_s);
  if (same_base && clock.from_1970) {
    place_by_zone(clock, placer);
  } else if (same_base && placer.shift(0).share > 0) {
    move_log(clock, LogPlacing::kAsIs, 0);
  }
  // A log of another day stays one, even if a step of it is like one of the recording.
  if (clock.is_placed() || (same_base && clock.from_1970)) return;
  if (const std::optional<LogShift> shift = placer.by_steps()) {
    move_log(clock, LogPlacing::kBySteps, shift->by_s);
  }
}

}  // namespace simbench::evaluation
