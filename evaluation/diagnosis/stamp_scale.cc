#include "evaluation/diagnosis/stamp_scale.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "recording/counted.h"

namespace simbench::evaluation {
namespace {

constexpr double kEarliestS = -0.05;  // a delay after a shift: clocks are not that exact
constexpr double kShortDelayS = 1;
constexpr double kWholeSecondDelayS = 0.3;
constexpr double kLeastAheadMs = 1;
constexpr double kQuarterHourS = 900;
constexpr double kFarthestZoneS = 14 * 3600.0;
constexpr double kYear2000S = 946'684'800;

struct KnownShift {
  double ahead_s;
  const char* name;
  const char* cause;
};

constexpr const char* kEpochCause = "subtract the distance of the two epochs";
constexpr std::array<KnownShift, 10> kKnownShifts = {{
    {37, "TAI, which is 37 s ahead of UTC",
     "a PTP clock counts TAI: take the UTC offset into account (linuxptp: phc2sys -w, or -O 37)"},
    {-37, "UTC, while the others count TAI (37 s ahead)",
     "a PTP clock counts TAI: give its source the UTC offset (linuxptp: ts2phc or phc2sys -O -37)"},
    {18, "GPS time, which is 18 s ahead of UTC", "subtract the leap seconds since 1980"},
    {-18, "UTC, while the others count GPS time (18 s ahead)", "add the leap seconds since 1980"},
    {19, "TAI, while the others count GPS time (19 s behind it)", "subtract 19 s"},
    {-19, "GPS time, while the others count TAI (19 s ahead)", "add 19 s"},
    {2'082'844'800.0, "seconds from 1904 (QuickTime, MP4, HFS)", kEpochCause},
    {2'208'988'800.0, "seconds from 1900 (NTP)", kEpochCause},
    {-946'684'800.0, "seconds from 2000", kEpochCause},
    {-315'964'782.0, "GPS seconds from 1980", kEpochCause},
}};

bool is_short_delay(double delay_s, double longest_s) {
  return delay_s > kEarliestS && delay_s < longest_s;
}

StampScale shifted(double shift_s, std::string name, std::string cause) {
  return {.kind = ScaleKind::kShifted,
          .shift_s = shift_s,
          .name = std::move(name),
          .cause = std::move(cause)};
}

std::string hours_text(double hours) {
  return fmt::format("{:g} h {}", std::abs(hours), hours > 0 ? "ahead" : "behind");
}

}  // namespace

std::optional<StampScale> named_shift(double ahead_s) {
  for (const KnownShift& known : kKnownShifts) {
    if (is_short_delay(known.ahead_s - ahead_s, kShortDelayS)) {
      return shifted(known.ahead_s, known.name, known.cause);
    }
  }
  const double quarters = std::ceil((ahead_s + kEarliestS) / kQuarterHourS);
  const double zone_s = quarters * kQuarterHourS;
  if (quarters != 0 && std::abs(zone_s) <= kFarthestZoneS &&
      is_short_delay(zone_s - ahead_s, kShortDelayS)) {
    return shifted(zone_s, fmt::format("local time, {} of UTC", hours_text(zone_s / 3600)),
                   "a time zone was taken for UTC, or daylight saving counted twice: stamp in UTC");
  }
  const double whole_s = std::ceil(ahead_s + kEarliestS);
  if ((whole_s >= 1 || whole_s < -kLongestDelayS) &&
      is_short_delay(whole_s - ahead_s, kWholeSecondDelayS)) {
    return shifted(whole_s,
                   fmt::format("a scale that is {} {}",
                               counted(std::llround(std::abs(whole_s)), "whole second"),
                               whole_s > 0 ? "ahead" : "behind"),
                   "its clock was set by something that is right within the second only, or with "
                   "another number of leap seconds");
  }
  return std::nullopt;
}

StampScale stamp_scale(const StreamFacts& facts, std::optional<double> others_ahead_s) {
  StampScale scale;
  if (std::isnan(facts.delay.median_ms)) return scale;
  const double base_s = others_ahead_s.value_or(0);
  const double ahead_s = -facts.delay.median_ms * 1e-3 - base_s;
  const double stamp_s = to_seconds(facts.first_stamp);
  const bool compared = others_ahead_s || facts.first_arrival_s > kYear2000S;
  constexpr double kFarPastS = 20 * 365 * 86400.0;
  if (!compared || facts.one_clock || stamp_s < kFarPastS) return scale;
  if (const auto named = named_shift(ahead_s)) scale = *named;
  scale.delay_ms = facts.delay.median_ms + (base_s + scale.shift_s) * 1e3;
  scale.least_delay_ms = facts.delay.least_ms + (base_s + scale.shift_s) * 1e3;
  if (scale.kind == ScaleKind::kShifted) return scale;
  scale.kind = ScaleKind::kUnixTime;
  if (scale.least_delay_ms < -kLeastAheadMs) scale.kind = ScaleKind::kAhead;
  if (scale.delay_ms > kLongestDelayS * 1e3) scale.kind = ScaleKind::kBehind;
  return scale;
}

}  // namespace simbench::evaluation
