#include "scenarios/trigger_code.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/camera_groups.h"
#include "scenarios/camera_profile.h"
#include "scenarios/loader.h"
#include "scenarios/pulse_window.h"

namespace simbench::scenarios {
namespace {

constexpr const char* kShift = "/trigger/code/shift_us";
constexpr const char* kKind = "/trigger/code/kind";
constexpr const char* kPulses = "/trigger/code/pulses_per_symbol";

double in_us(Nanoseconds time) { return to_ns(time) * 1e-3; }

Nanoseconds period_of(const Trigger& trigger) { return from_ns(1e9 / trigger.pulse_rate_hz()); }

// The longest exposure that a camera may make.
Nanoseconds longest_exposure(const Scenario& scenario, const Stream& stream) {
  const Cameras& cameras = scenario.cameras;
  const double periods = cameras.exposure_camera_periods + cameras.exposure_host_periods;
  double exposure_ms = cameras.exposure_ms + periods * scenario.trigger.period_ms();
  if (cameras.auto_exposure.is_on()) {
    exposure_ms = std::max(exposure_ms, cameras.auto_exposure.max_ms);
  }
  return from_ms(exposure_ms + (stream.shutter == ShutterKind::kRolling ? stream.readout_ms : 0));
}

// What a code must be before any camera sees it.
void check_code_members(const Scenario& scenario, const TriggerCodeModel& code) {
  const bool has_shift = code.kind != CodeKind::kMissing;
  if (has_shift != (code.shift_us > 0)) {
    fail_at(scenario, kShift,
            fmt::format("found {}, allowed {} of kind \"{}\"", code.shift_us,
                        has_shift ? "more than 0" : "0", to_text(code.kind)));
  }
  const std::int64_t pulses = code.pulses_per_symbol;
  const auto fail_pulses = [&](const char* allowed) {
    fail_at(
        scenario, kPulses,
        fmt::format("found {}, allowed {} of kind \"{}\"", pulses, allowed, to_text(code.kind)));
  };
  if (code.kind == CodeKind::kPosition && pulses != 1) fail_pulses("1");
  if (code.kind == CodeKind::kMissing && pulses < 2) fail_pulses("at least 2");
  if (code.kind == CodeKind::kFrequency && pulses % 2 != 0) fail_pulses("an even number");
  if (!has_shift) return;
  // Two shifts of position part by twice the shift, the intervals of frequency by it once.
  const double period_us = in_us(period_of(scenario.trigger));
  const double reach = code.kind == CodeKind::kPosition ? 8 : static_cast<double>(4 * pulses);
  if (code.shift_us * reach <= period_us) return;
  fail_at(scenario, kShift,
          fmt::format("found {}, allowed at most {:.4g}: pulses that are {:.6g} us apart must stay "
                      "in their order",
                      code.shift_us, period_us / reach, period_us));
}

// What would make room for pulses that come too near to each other.
std::string slower_trigger(const Scenario& scenario, const CodeLimits& limits,
                           const CodeDistances& found) {
  if (!scenario.cameras.begins_at_pulse()) return "";
  const Nanoseconds even = period_of(scenario.trigger) * limits.pulses_per_frame;
  const double fastest_hz = static_cast<double>(limits.pulses_per_frame) * 1e9 /
                            to_ns(limits.shortest + (even - found.shortest));
  return fmt::format("; a /trigger/rate_hz of at most {:.6g} would leave room for this shift",
                     fastest_hz / (1 + scenario.trigger.rate_error_ppm * 1e-6));
}

std::string allowed_shift(const TriggerCodeModel& code, Nanoseconds even, const CodeLimits& limits,
                          const CodeDistances& found) {
  if (code.kind == CodeKind::kMissing) return "another kind";
  double most_us = code.shift_us * to_ns(even - limits.shortest) / to_ns(even - found.shortest);
  if (limits.longest != Nanoseconds::max()) {
    most_us = std::min(most_us,
                       code.shift_us * to_ns(limits.longest - even) / to_ns(found.longest - even));
  }
  constexpr double kSteps = 100;  // a microsecond, rounded down
  most_us = std::floor(most_us * kSteps) / kSteps;
  return most_us > 0 ? fmt::format("at most {:g}", most_us) : "no shift at all";
}

}  // namespace

std::optional<TriggerCode> trigger_code(const Trigger& trigger) {
  if (!trigger.code) return std::nullopt;
  const TriggerCodeModel& code = *trigger.code;
  const Nanoseconds period = period_of(trigger);
  const auto order = static_cast<int>(code.order);
  const auto pulses = static_cast<std::size_t>(code.pulses_per_symbol);
  switch (code.kind) {
    case CodeKind::kPosition:
      return TriggerCode::position(period, order, from_us(code.shift_us));
    case CodeKind::kMissing:
      return TriggerCode::missing(period, order, pulses);
    case CodeKind::kFrequency:
      break;
  }
  return TriggerCode::frequency(period, order, pulses, from_us(code.shift_us));
}

CodeLimits code_limits(const Scenario& scenario, const Stream& stream,
                       std::int64_t pulses_per_camera) {
  const Cameras& cameras = scenario.cameras;
  const double period_ns = 1e9 / stream.mode_rate_hz * (1 + kClockErrorPpm * 1e-6);
  const double unguarded = 1 - cameras.genlock_guard_fraction;
  const double ignored = cameras.sync_mode == SyncMode::kGenlock ? 2 : 1;
  CodeLimits limits;
  limits.pulses_per_frame = pulses_per_camera * scenario.pulses_per_frame(stream);
  limits.may_leave_out = cameras.begins_at_pulse();
  Nanoseconds busy = longest_exposure(scenario, stream);
  if (cameras.begins_at_pulse()) busy += from_us(cameras.trigger_to_exposure_us);
  limits.shortest = std::max(from_ns_up(ignored * unguarded * period_ns), busy);
  if (cameras.begins_at_pulse()) return limits;
  const PulseWindow window(stream.mode_rate_hz);
  limits.shortest = std::max(limits.shortest, from_ns_up(1e9 / window.fastest_hz));
  limits.longest = from_ns_down(1e9 / window.slowest_hz);
  return limits;
}

CodeDistances code_distances(const TriggerCode& code, std::int64_t pulses) {
  CodeDistances distances{.shortest = Nanoseconds::max(), .longest = {}};
  for (std::int64_t pulse = 0; pulse < code.length(); ++pulse) {
    if (!code.is_sent(pulse)) continue;
    std::int64_t later = pulse + pulses;
    while (!code.is_sent(later)) ++later;
    const Nanoseconds distance =
        (later - pulse) * code.period() + code.shift(later) - code.shift(pulse);
    distances.shortest = std::min(distances.shortest, distance);
    distances.longest = std::max(distances.longest, distance);
  }
  return distances;
}

std::optional<CodeProblem> code_problem(const Scenario& scenario, const Stream& stream,
                                        const TriggerCode& code, std::int64_t pulses_per_camera) {
  const std::string mode(to_text(scenario.cameras.sync_mode));
  const CodeLimits limits = code_limits(scenario, stream, pulses_per_camera);
  if (code.leaves_out() && !limits.may_leave_out) {
    return CodeProblem{
        kKind,
        fmt::format("found \"missing\", allowed \"position\" or \"frequency\" in sync mode \"{}\": "
                    "where no pulse comes such a camera runs free after a while; one in "
                    "\"genlock\" waits",
                    mode)};
  }
  if (code.leaves_out() && limits.pulses_per_frame > 1) {
    return CodeProblem{
        kKind, fmt::format("found \"missing\", allowed \"position\" or \"frequency\" where a "
                           "camera answers one in {} pulses: it would be other ones after each "
                           "that is left out",
                           limits.pulses_per_frame)};
  }
  const CodeDistances found = code_distances(code, limits.pulses_per_frame);
  const Nanoseconds even = code.period() * limits.pulses_per_frame;
  const bool is_early = found.shortest < limits.shortest;
  if (!is_early && found.longest <= limits.longest) return std::nullopt;
  const std::string range =
      limits.longest == Nanoseconds::max()
          ? fmt::format("at least {:.6g} us", in_us(limits.shortest))
          : fmt::format("{:.6g} to {:.6g} us", in_us(limits.shortest), in_us(limits.longest));
  return CodeProblem{
      kShift,
      fmt::format("found {:g}, with which the pulses that a camera answers are {:.6g} to {:.6g} us "
                  "apart, allowed {}: the {} stream takes {} in sync mode \"{}\" with a {} Hz mode "
                  "(docs/coded_trigger.md section 3){}",
                  scenario.trigger.code->shift_us, in_us(found.shortest), in_us(found.longest),
                  allowed_shift(*scenario.trigger.code, even, limits, found), to_text(stream.kind),
                  range, mode, stream.mode_rate_hz,
                  is_early ? slower_trigger(scenario, limits, found) : "")};
}

namespace {

void check_code_is_followed(const Scenario& scenario, const Scenario& alone,
                            const TriggerCode& code, std::int64_t pulses_per_camera) {
  for (const Stream& stream : alone.cameras.streams) {
    if (!alone.cameras.follows_trigger(stream)) continue;
    const auto problem = code_problem(alone, stream, code, pulses_per_camera);
    if (problem) fail_at(scenario, problem->pointer, problem->text);
  }
}

// Modes of the model in which some stream follows the trigger.
std::vector<std::string_view> following_modes(const CameraProfile& camera) {
  std::vector<std::string_view> modes;
  for (const SyncModeProfile& each : camera.sync_modes) {
    if (!each.triggered.empty()) modes.push_back(to_text(each.mode));
  }
  return modes;
}

}  // namespace

void check_trigger_code(const Scenario& scenario) {
  if (!scenario.trigger.code) return;
  const Cameras& cameras = scenario.cameras;
  const bool is_any = std::ranges::any_of(cameras.streams, [&cameras](const Stream& stream) {
    return cameras.follows_trigger(stream);
  });
  if (!is_any) {
    const std::vector<std::string_view> modes =
        following_modes(*find_camera_profile(cameras.model));
    fail_at(
        scenario, "/trigger/code",
        fmt::format(
            "found a code, allowed null in sync mode \"{}\": no stream follows the "
            "pulses{}",
            to_text(cameras.sync_mode),
            modes.empty() ? "" : fmt::format("; in \"{}\" one would", fmt::join(modes, "\", \""))));
  }
  check_code_members(scenario, *scenario.trigger.code);
  const TriggerCode code = *trigger_code(scenario.trigger);
  if (cameras.groups.empty()) return check_code_is_followed(scenario, scenario, code, 1);
  for (std::size_t group = 0; group < cameras.groups.size(); ++group) {
    check_code_is_followed(scenario, group_alone(scenario, group), code,
                           pulses_per_frame(cameras, group));
  }
}

}  // namespace simbench::scenarios
