#include "evaluation/diagnosis/findings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace simbench::evaluation {
namespace {

constexpr double kGapPeriods = 10;
constexpr double kLeastGapS = 0.5;
constexpr double kLateS = 1;  // a later start or earlier end than this is reported

// From the first to the last arrival of a host's cameras, on its clock.
struct Presence {
  double first_s = std::numeric_limits<double>::infinity();
  double last_s = -std::numeric_limits<double>::infinity();
};

// By host, whose clocks may have nothing in common.
std::map<std::string, Presence> presences_of(const Diagnosis& diagnosis) {
  std::map<std::string, Presence> hosts;
  for (const CameraDiagnosis& camera : diagnosis.cameras) {
    if (camera.facts.account.delivered == 0) continue;
    Presence& host = hosts[camera.host];
    host.first_s = std::min(host.first_s, camera.facts.first_arrival_s);
    host.last_s = std::max(host.last_s, camera.facts.last_arrival_s);
  }
  return hosts;
}

bool is_enough(const CameraDiagnosis& camera) {
  return camera.facts.account.delivered >= 2 && camera.facts.period_ms > 0;
}

void add_too_little(CameraFindings& found) {
  const std::int64_t frames = found.camera.facts.account.delivered;
  found.add({.name = "too_few_frames", .harm = Harm::kSerious},
            frames == 1  ? "one frame: too few for a diagnosis"
            : frames > 1 ? fmt::format("{} frames, but their stamps do not advance", frames)
                         : std::string("no frame"));
}

std::string moves_text(const CameraFindings& found) {
  const Standing& standing = found.camera.standing;
  return fmt::format("drifts {:.3g} ms per minute relative to camera {} ({:+.3g} ppm)",
                     standing.moves_ms_per_minute, found.reference(), standing.rate_ppm);
}

// One finding for all cameras of a host that move together.
void add_host(CameraFindings& found) {
  std::string names;
  int count = 0;
  for (const CameraDiagnosis& other : found.diagnosis.cameras) {
    if (other.stream != found.camera.stream || other.host != found.camera.host) continue;
    if (!is_enough(other) || other.standing.follows != Follows::kHostOrOwn) continue;
    if (count++ == 0 && &other != &found.camera) return;  // reported with the first one
    names += (names.empty() ? "" : ", ") + other.camera;
  }
  if (found.is_reference()) return;  // the others are compared with this host
  const bool alone = count == 1;
  found.add({.name = "host_or_free_running",
             .harm = Harm::kFatal,
             .certainty = FindingCertainty::kPossible,
             .in_verdict = true},
            fmt::format("host {} ({} of camera{} {}): phase {}; the cause may be the host's clock "
                        "or {}",
                        found.camera.host, found.camera.stream, alone ? "" : "s", names,
                        moves_text(found), alone ? "the camera's" : "a trigger of their own"),
            "give the hosts' clocks a common source and log them (--clock-log)");
}

void add_unknown(CameraFindings& found) {
  const CameraFindings::Kind kind = {
      .name = "unknown_rate", .harm = Harm::kMinor, .in_verdict = true};
  const auto group =
      std::ranges::count(found.diagnosis.cameras, found.camera.stream, &CameraDiagnosis::stream);
  if (!found.camera.facts.has_grid) {
    found.add({.name = "no_grid", .harm = Harm::kSerious, .in_verdict = group > 1},
              fmt::format("its intervals vary by {:.2f} ms by themselves: no trigger of an even "
                          "period starts its frames",
                          found.camera.facts.interval_jitter_ms),
              "set a fixed rate and exposure, or pair frames by nearest stamp");
  } else if (std::isnan(found.camera.facts.host_period.period_ms)) {
    found.add(kind, "too few frames to determine its rate in host time");
  } else if (found.group().standard && group > 1) {  // else the verdict reports it for all
    found.add(kind, "its rate in host time is too uncertain to compare");
  }
}

void add_multiple(CameraFindings& found) {
  const Standing& standing = found.camera.standing;
  if (standing.period_multiple <= 1 || standing.follows == Follows::kOtherRate) return;
  const std::string part =
      standing.period_multiple == 2 ? "half" : fmt::format("1/{} of", standing.period_multiple);
  const bool counted_more = found.camera.facts.account.lost > 0;
  found.add(
      {.name = "divided_rate", .harm = Harm::kSerious, .certainty = FindingCertainty::kLikely},
      fmt::format(
          "{} the rate ({:.3f} Hz): {}", part, 1000 / found.camera.facts.host_period.period_ms,
          counted_more ? "its counter counts the others, so that a reader drops them"
                       : "it ignores triggers while it is busy, with too long an exposure or "
                         "a trigger faster than half its mode's rate"),
      counted_more ? "" : "shorten the exposure, or take a mode of twice the rate");
}

void add_standing(CameraFindings& found) {
  const StreamFacts& facts = found.camera.facts;
  switch (found.camera.standing.follows) {
    case Follows::kOwnClock:
      found.add({.name = "free_running", .harm = Harm::kFatal, .in_verdict = true},
                found.is_reference() ? std::string("free-running: no other camera has its period")
                                     : "free-running: its phase " + moves_text(found),
                "check the trigger's cable and the camera's sync mode");
      break;
    case Follows::kOtherRate:
      found.add({.name = "other_rate", .harm = Harm::kFatal, .in_verdict = true},
                fmt::format("runs at {:.3f} Hz, no whole fraction of the common rate",
                            1000 / facts.host_period.period_ms),
                "set one rate for all cameras");
      break;
    case Follows::kHostOrOwn:
      add_host(found);
      break;
    case Follows::kUnknown:
      add_unknown(found);
      break;
    case Follows::kTrigger:
      break;
  }
  add_multiple(found);
  if (!found.camera.standing.is_offset) return;
  found.add(
      {.name = "constant_offset", .harm = Harm::kSerious, .in_verdict = true},
      fmt::format("its stamps are a constant {:.3f} ms {} than those of {} (modulo the period "
                  "of {:.3f} ms)",
                  std::abs(found.camera.standing.phase_ms),
                  found.camera.standing.phase_ms > 0 ? "later" : "earlier",
                  called_camera(found.reference()), found.group().period_ms),
      "set equal delays and exposures; pair frames within a window that holds this offset");
}

void add_presence(CameraFindings& found, const std::map<std::string, Presence>& hosts) {
  const StreamFacts& facts = found.camera.facts;
  if (facts.longest_gap_s > kLeastGapS &&
      facts.longest_gap_s > kGapPeriods * facts.period_ms * 1e-3) {
    found.add({.name = "stalled", .harm = Harm::kSerious},
              fmt::format("no frame for {:.2f} s, {:.1f} s after its first", facts.longest_gap_s,
                          facts.gap_at_s));
  }
  const std::string of_host = hosts.size() > 1 ? " of " + found.camera.host : "";
  const Presence& host = hosts.at(found.camera.host);
  if (const double late_s = facts.first_arrival_s - host.first_s; late_s > kLateS) {
    found.add({.name = "late_start"},
              fmt::format("starts {:.1f} s after the first camera{}", late_s, of_host));
  }
  if (const double early_s = host.last_s - facts.last_arrival_s; early_s > kLateS) {
    found.add({.name = "ended_early", .harm = Harm::kSerious},
              fmt::format("ends {:.1f} s before the last camera{}", early_s, of_host));
  }
}

// What a log says of a host.
Finding of_clock(const ClockFinding& clock) {
  constexpr double kFatalHarm = 0.6;
  constexpr double kSeriousHarm = 0.4;
  constexpr double kMinorHarm = 0.2;
  return {.camera = "",
          .stream = "",
          .kind = clock.kind,
          .text = clock.text,
          .harm = clock.harm >= kFatalHarm     ? Harm::kFatal
                  : clock.harm >= kSeriousHarm ? Harm::kSerious
                  : clock.harm >= kMinorHarm   ? Harm::kMinor
                                               : Harm::kNote};
}

Finding free_pair(const PairDiagnosis& pair) {
  constexpr double kMsPerMinutePerPpm = 0.06;
  return {
      .camera = pair.camera,
      .stream = pair.stream,
      .kind = "stream_runs_free",
      .text = fmt::format("{}: {} does not follow {}: it runs free, its offset drifts {:.3g} ms "
                          "per minute ({:+.3g} ppm)",
                          called_camera(pair.camera), pair.stream, pair.against,
                          pair.moves_ms_per_minute, pair.moves_ms_per_minute / kMsPerMinutePerPpm),
      .advice =
          "set one rate for both streams and the camera's option that couples them, or "
          "pair frames by nearest stamp",
      .harm = Harm::kFatal,
      .certainty = FindingCertainty::kCertain};
}

}  // namespace

void CameraFindings::add(const Kind& kind, std::string_view text, std::string advice) {
  // With its stream where the camera has several.
  const auto streams =
      std::ranges::count(diagnosis.cameras, camera.camera, &CameraDiagnosis::camera);
  const std::string name = streams > 1 ? camera.camera + " " + camera.stream : camera.camera;
  const bool of_host = kind.name == std::string_view("host_or_free_running");
  list_.push_back(
      {.camera = camera.camera,
       .stream = camera.stream,
       .kind = kind.name,
       .text = of_host ? std::string(text) : fmt::format("{}: {}", called_camera(name), text),
       .advice = std::move(advice),
       .harm = kind.harm,
       .certainty = kind.certainty,
       .in_verdict = kind.in_verdict});
}

const GroupVerdict& CameraFindings::group() const {
  return *std::ranges::find(diagnosis.groups, camera.stream, &GroupVerdict::stream);
}

std::string CameraFindings::reference() const {
  const std::size_t index = group().standard.value_or(0);
  std::size_t place = 0;
  for (const CameraDiagnosis& other : diagnosis.cameras) {
    if (other.stream == camera.stream && place++ == index) return other.camera;
  }
  return "";
}

std::vector<Finding> findings_of(const Diagnosis& diagnosis) {
  const std::map<std::string, Presence> hosts = presences_of(diagnosis);
  std::vector<Finding> list;
  for (const ClockFinding& clock : diagnosis.clocks.findings) list.push_back(of_clock(clock));
  for (const CameraDiagnosis& camera : diagnosis.cameras) {
    CameraFindings found(diagnosis, camera, list);
    if (!is_enough(camera)) {
      add_too_little(found);
      continue;
    }
    add_standing(found);
    add_frame_findings(found);
    add_stamp_findings(found);
    add_presence(found, hosts);
  }
  for (const PairDiagnosis& pair : diagnosis.pairs) {
    if (pair.runs_free) list.push_back(free_pair(pair));
  }
  std::ranges::stable_sort(list, std::ranges::greater{}, &Finding::harm);
  return list;
}

}  // namespace simbench::evaluation
