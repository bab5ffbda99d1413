#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "evaluation/diagnosis/findings.h"
#include "evaluation/frames/camera_statistics.h"
#include "recording/counted.h"

namespace simbench::evaluation {
namespace {

constexpr std::size_t kMostJumps = 3;
constexpr double kLeastClockApartMs = 50;  // more delay than the quickest camera's
constexpr double kWholeDelayShare = 0.05;  // of a period
constexpr double kSteadyDelayShare = 0.1;
constexpr double kSwapS = 0.5;
constexpr double kSwapShare = 0.5;  // of a period: lateness of the frames around a step
constexpr double kUndisciplinedPpm = 5;

// Two streams of one kind whose stamps step at one time, one as far up as the other down, have
// changed places.
bool are_swapped(const CameraDiagnosis& a, const StampJump& jump_a, const CameraDiagnosis& b,
                 const StampJump& jump_b) {
  const double apart_s =
      a.facts.first_arrival_s + jump_a.at_s - (b.facts.first_arrival_s + jump_b.at_s);
  return &a != &b && a.stream == b.stream && std::abs(apart_s) < kSwapS &&
         std::abs(jump_a.step_ms + jump_b.step_ms) < kSwapShare * a.facts.period_ms;
}

// The camera with which this one changes places at this jump.
const CameraDiagnosis* swapped_with(const CameraFindings& found, const StampJump& jump) {
  for (const CameraDiagnosis& other : found.diagnosis.cameras) {
    for (const StampJump& its : other.facts.jumps) {
      if (are_swapped(found.camera, jump, other, its)) return &other;
    }
  }
  return nullptr;
}

void add_scale(CameraFindings& found) {
  const StampScale& scale = found.camera.scale;
  const StreamFacts& facts = found.camera.facts;
  if (scale.kind == ScaleKind::kShifted) {
    const double ahead_s = -facts.delay.median_ms * 1e-3;
    found.add(
        {.name = "time_scale", .harm = Harm::kStamps},
        fmt::format("its stamps count {}: they lie {:.3f} s {} their arrivals{}; with {:+.0f} "
                    "s taken out, {:.1f} ms before them",
                    scale.name, std::abs(ahead_s), ahead_s > 0 ? "after" : "before",
                    ahead_s > 0 ? ", which no frame can" : "", scale.shift_s, scale.delay_ms),
        scale.cause);
  } else if (scale.kind == ScaleKind::kAhead) {
    found.add({.name = "clock_ahead", .harm = Harm::kStamps},
              fmt::format("its stamps are {:.1f} ms later than its frames arrived: the clock that "
                          "made them is ahead of the one that stamped the arrivals, by at least "
                          "that",
                          -scale.least_delay_ms),
              "synchronise the two clocks, and watch both (simbench stability)");
  } else if (scale.kind == ScaleKind::kBehind) {
    found.add(
        {.name = "clock_behind", .harm = Harm::kStamps},
        fmt::format("its stamps lie {:.3f} s before their arrivals: no delay is that long, the "
                    "clock that made them is behind, or frames were queued",
                    scale.delay_ms * 1e-3),
        "synchronise the two clocks, and watch both (simbench stability)");
  }
}

// The least delay of another camera whose stamps can be compared; nothing if this one has it.
const CameraDiagnosis* quickest_other(const CameraFindings& found) {
  const CameraDiagnosis* quickest = nullptr;
  for (const CameraDiagnosis& other : found.diagnosis.cameras) {
    const bool comparable = other.scale.kind != ScaleKind::kOwnClock &&
                            !other.facts.stamped_on_arrival && other.scale.least_delay_ms >= 0;
    if (!comparable || other.scale.least_delay_ms >= found.camera.scale.least_delay_ms) continue;
    if (quickest == nullptr || other.scale.least_delay_ms < quickest->scale.least_delay_ms) {
      quickest = &other;
    }
  }
  return quickest;
}

void add_delay(CameraFindings& found) {
  const StampScale& scale = found.camera.scale;
  const StreamFacts& facts = found.camera.facts;
  const CameraDiagnosis* other = quickest_other(found);
  if (other == nullptr || facts.stamped_on_arrival) return;
  const double more_ms = scale.least_delay_ms - other->scale.least_delay_ms;
  const double periods = std::round(more_ms / facts.period_ms);
  const bool whole = periods >= 1 && other->stream == found.camera.stream &&
                     std::abs(more_ms / facts.period_ms - periods) < kWholeDelayShare &&
                     facts.delay.scatter_ms < kSteadyDelayShare * facts.period_ms;
  const std::string evidence =
      fmt::format("its frames arrive {:.1f} ms after their stamps, those of {} {:.1f} ms after",
                  scale.least_delay_ms, called_camera(other->camera), other->scale.least_delay_ms);
  if (whole) {
    found.add(
        {.name = "delay_of_periods",
         .harm = Harm::kSerious,
         .certainty = FindingCertainty::kLikely},
        fmt::format("{}: {} more, so that its frames are held back by a buffer, or its stamps "
                    "are those of earlier frames",
                    evidence, counted(static_cast<std::uint64_t>(periods), "whole period")),
        "film one event with both cameras, and compare the frames that show it");
  } else if (more_ms > kLeastClockApartMs) {
    found.add(
        {.name = "clock_apart", .harm = Harm::kSerious, .certainty = FindingCertainty::kLikely},
        fmt::format("{}: the clocks that made the stamps are apart by up to {:.1f} ms, or its "
                    "frames are held up",
                    evidence, more_ms),
        "compare the clocks by their logs (--clock-log), or film one event with both cameras");
  }
}

void add_stamped_on_arrival(CameraFindings& found) {
  const StreamFacts& facts = found.camera.facts;
  if (!facts.stamped_on_arrival) return;
  const bool same_scale = found.camera.scale.kind != ScaleKind::kOwnClock;
  found.add(
      {.name = "stamped_on_arrival", .harm = Harm::kStamps},
      fmt::format("stamped on arrival: its stamps scatter by {:.2f} ms about their grid, and its "
                  "arrivals with them{}, to {:.2f} ms; they say when a program had the frame, not "
                  "when it was exposed",
                  facts.scatter_ms,
                  same_scale ? fmt::format(" ({:.2f} ms later)", found.camera.scale.delay_ms) : "",
                  facts.delay.scatter_ms),
      "use a stamp of the sensor or of the driver; until then its exposures are earlier than its "
      "stamps by a delay that stamps cannot show");
}

void add_clock(CameraFindings& found) {
  const StreamFacts& facts = found.camera.facts;
  const bool epoch = found.camera.scale.kind != ScaleKind::kOwnClock;
  if (facts.one_clock) {
    found.add({.name = "one_clock", .harm = Harm::kNote},
              "its arrivals are its stamps, as from one column of a file: there is one clock only, "
              "so that nothing tells a camera's clock from its host's");
  } else if (facts.global_time && facts.realsense && !facts.stamped_by_host) {
    found.add({.name = "global_time", .harm = Harm::kMinor, .certainty = FindingCertainty::kLikely},
              "its stamps count from 1970: with librealsense's global time they are the host's own "
              "estimate",
              "record with global time off");
  } else if (is_doubtful_drift(facts.drift_ppm)) {
    found.add(
        {.name = "doubtful_rate", .harm = Harm::kStamps},
        fmt::format("its clock and its host's differ by {:.0f} ppm, where some tens are usual: "
                    "are both stamps milliseconds of one camera?",
                    facts.drift_ppm));
  } else if (epoch && std::abs(facts.drift_ppm) > kUndisciplinedPpm && !found.group().by_stamps) {
    found.add({.name = "undisciplined_clock", .harm = Harm::kSerious},
              fmt::format("its stamps count from 1970, but drift against its arrivals by {:+.1f} "
                          "ppm ({:.2f} ms a minute): nothing keeps one of the two clocks",
                          facts.drift_ppm, facts.drift_ppm * 0.06),
              "see whether PTP or NTP runs on both, and reaches its source");
  }
}

void add_stamp_jump(CameraFindings& found, const StampJump& jump) {
  if (jump.periods != 0) {
    found.add(
        {.name = "period_slip", .harm = Harm::kFatal},
        fmt::format("at {:.1f} s its stamps slip permanently by {} period{} relative to their "
                    "arrivals",
                    jump.at_s, -jump.periods, std::abs(jump.periods) > 1 ? "s" : ""),
        "from then on its frames belong to other pulses than their stamps or numbers say");
  } else {
    found.add({.name = "clock_step", .harm = Harm::kFatal},
              fmt::format("at {:.1f} s arrivals and stamps move apart permanently by {:.3f} ms: a "
                          "clock was set",
                          jump.at_s, jump.step_ms),
              "let the daemon slew once it is in sync (chrony: makestep with a limit; phc2sys: no "
              "step_threshold)");
  }
}

void add_jumps(CameraFindings& found) {
  std::size_t shown = 0;
  for (const StampJump& jump : found.camera.facts.jumps) {
    if (const CameraDiagnosis* other = swapped_with(found, jump)) {
      found.add(
          {.name = "swapped", .harm = Harm::kFatal},
          fmt::format("at {:.1f} s it changes places with {}: each goes on with the stamps of "
                      "the other",
                      jump.at_s, called_camera(other->camera)));
      continue;
    }
    if (shown++ == kMostJumps) {
      const std::size_t more = found.camera.facts.jumps.size() - kMostJumps;
      found.add({.name = "jumps", .harm = Harm::kFatal}, counted(more, "more jump"));
      break;
    }
    add_stamp_jump(found, jump);
  }
}

void add_steps(CameraFindings& found) {
  const std::vector<PhaseStep>& steps = found.camera.facts.steps;
  if (steps.empty()) return;
  const double period_ms = found.camera.facts.period_ms;
  const bool half = std::ranges::all_of(steps, [period_ms](const PhaseStep& step) {
    constexpr double kNearHalf = 0.05;
    return std::abs(std::abs(step.step_ms) / period_ms - 0.5) < kNearHalf;
  });
  std::string text = fmt::format(
      "its frames move against their own grid {}: at {:.1f} s by {:.2f} "
      "ms",
      times(steps.size()), steps.front().at_s, steps.front().step_ms);
  if (half) {
    text += fmt::format(
        ", half a period: it lies on a grid of {:.3f} Hz, and a reader takes every "
        "other frame, now the even and now the odd ones",
        2e3 / period_ms);
  }
  found.add({.name = "phase_step",
             .harm = Harm::kFatal,
             .certainty = FindingCertainty::kCertain,
             .in_verdict = found.group().status == SyncStatus::kSlips},
            text,
            half ? "let the readers choose by the frame's number or stamp, not by a timer of their "
                   "own"
                 : "look what happened then: a restart of the stream, another exposure, another "
                   "trigger");
}

bool is_swapped(const CameraFindings& found) {
  return std::ranges::any_of(found.camera.facts.jumps, [&found](const StampJump& jump) {
    return swapped_with(found, jump) != nullptr;
  });
}

}  // namespace

void add_stamp_findings(CameraFindings& found) {
  const StreamFacts& facts = found.camera.facts;
  add_scale(found);
  add_stamped_on_arrival(found);
  add_delay(found);
  add_clock(found);
  add_jumps(found);
  add_steps(found);
  for (const RateChange& change : facts.rate_changes) {
    found.add({.name = "rate_change", .harm = Harm::kFatal},
              fmt::format("at {:.1f} s its rate changes from {:.3f} to {:.3f} Hz", change.at_s,
                          change.from_hz, change.to_hz),
              "automatic exposure may lower the rate in the dark: limit it, or set the rate");
  }
  if (facts.repeated_stamps > 0) {
    found.add({.name = "repeated_stamps"},
              fmt::format("{} with the stamp of the frame before",
                          counted(static_cast<std::uint64_t>(facts.repeated_stamps), "frame")));
  }
  if (facts.future_stamps > 0) {
    found.add({.name = "future_stamps"},
              fmt::format("{} in the future: up to {:.1f} ms later than the delay of all other "
                          "frames allows",
                          counted(static_cast<std::uint64_t>(facts.future_stamps), "stamp"),
                          facts.future_ms));
  }
  // Another camera's clock may well be behind.
  if (facts.backward_stamps > (is_swapped(found) ? 1 : 0)) {
    found.add({.name = "backward_stamps"},
              "its stamps go back " + times(static_cast<std::uint64_t>(facts.backward_stamps)));
  }
  if (facts.backward_arrivals > 0) {
    found.add({.name = "backward_arrivals"},
              fmt::format("arrivals go back {}: its host's clock was set back",
                          times(static_cast<std::uint64_t>(facts.backward_arrivals))));
  }
  if (facts.wraps > 0) {
    found.add(
        {.name = "register_wraps", .harm = Harm::kNote},
        fmt::format("its 32-bit microsecond register wraps {} (every 71.6 min): no fault, but "
                    "programs must expect it",
                    times(static_cast<std::uint64_t>(facts.wraps))));
  }
}

}  // namespace simbench::evaluation
