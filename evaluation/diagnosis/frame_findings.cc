#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "evaluation/diagnosis/findings.h"
#include "recording/counted.h"

namespace simbench::evaluation {
namespace {

constexpr double kSeriousLoss = 0.01;    // of the periods
constexpr double kUnsteady = 0.02;       // jitter as a share of the period
constexpr double kBatched = 0.1;         // of the frames
constexpr double kExposureMoves = 0.05;  // of a period
constexpr double kLeastExposureMs = 0.5;
constexpr double kGigabitBytesPerS = 117e6;  // of payload, at most, with frames of 1500 bytes
constexpr double kFullLink = 0.85;

std::uint64_t whole(std::int64_t count) { return static_cast<std::uint64_t>(count); }

// " (12.3 % of its periods, every 2.00 s)"
std::string share_and_place(const StreamFacts& facts) {
  std::string text = fmt::format(" ({:.3g} % of its periods", facts.missing_share() * 100);
  switch (facts.losses.pattern) {
    case LossPattern::kAtStart:
      text += ", nearly all in its first 5 s";
      break;
    case LossPattern::kPeriodic:
      text += fmt::format(", every {:.3g} s", facts.losses.every_s);
      break;
    case LossPattern::kRandom:
      if (facts.losses.places > 2) text += ", at no even distance";
      break;
    case LossPattern::kNone:
      break;
  }
  return text + ")";
}

std::string loss_advice(const StreamFacts& facts) {
  switch (facts.losses.pattern) {
    case LossPattern::kAtStart:
      return "leave the first seconds out";
    case LossPattern::kPeriodic:
      return "look for what runs that often on its host";
    case LossPattern::kRandom:
    case LossPattern::kNone:
      break;
  }
  return "look at the load of its bus, its host and the reader's queue";
}

void add_lost(CameraFindings& found) {
  const StreamFacts& facts = found.camera.facts;
  const FrameAccount& account = facts.account;
  const Harm harm = facts.missing_share() >= kSeriousLoss ? Harm::kSerious : Harm::kMinor;
  const std::string where = share_and_place(facts);
  if (!facts.counted) {
    if (account.unknown == 0) return;
    found.add(
        {.name = "missing_frames", .harm = harm},
        fmt::format("{} without a frame{}: lost or never exposed, which nothing tells without "
                    "a frame counter",
                    counted(whole(account.unknown), "period"), where),
        loss_advice(facts));
    return;
  }
  if (account.lost > 0) {
    found.add({.name = "lost_frames", .harm = harm},
              fmt::format("{} lost after the camera had counted them{}: in the camera, on its link "
                          "or in the host",
                          counted(whole(account.lost), "frame"), where),
              loss_advice(facts));
  }
  if (account.never_exposed > 0) {
    found.add({.name = "skipped_pulses", .harm = harm},
              fmt::format("{} never exposed: periods that its counter did not count{}, because the "
                          "camera missed triggers or there were none",
                          counted(whole(account.never_exposed), "frame"), where),
              "shorten the exposure, or look at the trigger's cable and level");
  }
  if (account.counter_restarts > 0) {
    found.add(
        {.name = "counter_restarts"},
        fmt::format("its frame counter stood still or went back {}: the camera was restarted, "
                    "or frames arrived twice",
                    times(whole(account.counter_restarts))));
  }
  if (account.counter_jumps > 0) {
    found.add({.name = "counter_jumps"},
              fmt::format("its frame counter jumps {} by more frames than the time between two "
                          "allows; these are not counted as lost",
                          times(whole(account.counter_jumps))));
  }
}

void add_delivery(CameraFindings& found) {
  const StreamFacts& facts = found.camera.facts;
  for (const DelayBurst& burst : facts.bursts) {
    found.add(
        {.name = "late_burst"},
        fmt::format("from {:.1f} s on, for {:.2f} s, {} came up to {:.1f} ms later than usual: "
                    "the host or its bus was busy",
                    burst.at_s, burst.for_s, counted(whole(burst.late), "frame"), burst.most_ms));
  }
  if (facts.batched_share > kBatched) {
    found.add({.name = "batches", .harm = Harm::kSerious},
              fmt::format("{:.0f} % of its frames arrive together with the frame before: they wait "
                          "somewhere for each other",
                          facts.batched_share * 100),
              "look at the reader's queue, at interrupt moderation and at energy saving");
  }
  if (facts.out_of_order > 0) {
    found.add(
        {.name = "out_of_order"},
        fmt::format("{} arrived after later ones", counted(whole(facts.out_of_order), "frame")),
        "sort by the frame's number or stamp");
  }
  if (facts.interval_jitter_ms > kUnsteady * facts.period_ms && facts.has_grid &&
      !facts.stamped_on_arrival) {
    found.add({.name = "unsteady"},
              fmt::format("unsteady: its intervals differ from whole periods of {1:.3f} ms by "
                          "{0:.3f} ms (standard deviation), {2:.1f} % are within a tenth of a "
                          "period",
                          facts.interval_jitter_ms, facts.period_ms, facts.on_grid_share * 100));
  }
}

// Where the delay comes from, if it has a spread worth a name.
void add_backend(CameraFindings& found) {
  const StreamFacts& facts = found.camera.facts;
  const double link_ms = facts.columns.to_backend_ms.high;
  const double host_ms = facts.columns.from_backend_ms.high;
  const double most_ms = std::max(link_ms, host_ms);
  if (!(most_ms > facts.period_ms / 4)) return;
  const bool host = host_ms > link_ms;
  found.add({.name = host ? "host_delay" : "link_delay", .certainty = FindingCertainty::kLikely},
            fmt::format("its delay varies by {:.1f} ms up to the back end's stamp and by {:.1f} ms "
                        "from there to the arrival (1 to 99 %): the {} holds frames up",
                        link_ms, host_ms, host ? "program" : "camera or its link"),
            host ? "give the reader a thread of its own, or a higher priority"
                 : "lower the load of the bus, or give the camera a port of its own");
}

void add_exposure(CameraFindings& found) {
  const StreamFacts& facts = found.camera.facts;
  const ColumnRange& exposure = facts.columns.exposure_ms;
  const double moves_ms = (exposure.high - exposure.low) / 2;
  if (exposure.high > facts.period_ms) {
    found.add({.name = "exposure_too_long", .harm = Harm::kSerious},
              fmt::format("its exposures of up to {:.2f} ms do not fit into a period of {:.2f} ms",
                          exposure.high, facts.period_ms),
              "shorten the exposure: pulses that come while a camera is busy are ignored");
  }
  if (moves_ms > std::max(kLeastExposureMs, kExposureMoves * facts.period_ms)) {
    found.add({.name = "auto_exposure", .harm = Harm::kSerious},
              fmt::format("its exposures vary from {:.2f} to {:.2f} ms: with a common start their "
                          "middles move by up to {:.2f} ms",
                          exposure.low, exposure.high, moves_ms),
              "set the exposure by hand, the same for all cameras");
  }
  double least_ms = exposure.middle;
  const CameraDiagnosis* shortest = nullptr;
  for (const CameraDiagnosis& other : found.diagnosis.cameras) {
    if (other.stream != found.camera.stream) continue;
    if (!(other.facts.columns.exposure_ms.middle < least_ms)) continue;
    least_ms = other.facts.columns.exposure_ms.middle;
    shortest = &other;
  }
  const double apart_ms = (exposure.middle - least_ms) / 2;
  if (shortest == nullptr ||
      apart_ms <= std::max(kLeastExposureMs, kExposureMoves * facts.period_ms)) {
    return;
  }
  found.add({.name = "exposures_differ", .harm = Harm::kSerious},
            fmt::format("its exposures last {:.2f} ms, those of {} {:.2f} ms: with a common start "
                        "their middles are {:.2f} ms apart",
                        exposure.middle, called_camera(shortest->camera), least_ms, apart_ms),
            "set the exposure by hand, the same for all cameras");
}

void add_load(CameraFindings& found) {
  const StreamFacts& facts = found.camera.facts;
  double all = 0;
  const CameraDiagnosis* first = nullptr;
  for (const CameraDiagnosis& other : found.diagnosis.cameras) {
    if (other.host != found.camera.host || !(other.facts.columns.bytes_per_s > 0)) continue;
    all += other.facts.columns.bytes_per_s;
    if (first == nullptr) first = &other;
  }
  if (first == &found.camera && all > kFullLink * kGigabitBytesPerS && all < kGigabitBytesPerS) {
    found.add(
        {.name = "full_link", .certainty = FindingCertainty::kPossible},
        fmt::format("its host receives {:.0f} MB/s from all cameras; one Gigabit link carries "
                    "{:.0f} at most",
                    all * 1e-6, kGigabitBytesPerS * 1e-6),
        "if they share one link, lower the rate or the size, or add a link");
  }
  if (!std::isnan(facts.columns.ns_per_byte)) {
    found.add({.name = "size_delay", .certainty = FindingCertainty::kLikely},
              fmt::format("larger frames come later, by {:.3g} ns a byte, as on a link of {:.0f} "
                          "MB/s",
                          facts.columns.ns_per_byte, 1e3 / facts.columns.ns_per_byte),
              "stamp before the transfer, or send frames of one size");
  }
}

void add_temperature(CameraFindings& found) {
  constexpr double kLeastSpanC = 3;
  const ColumnRange& temperature = found.camera.facts.columns.temperature_c;
  if (!(temperature.high - temperature.low > kLeastSpanC)) return;
  found.add(
      {.name = "temperature", .harm = Harm::kNote, .certainty = FindingCertainty::kPossible},
      fmt::format("its temperature goes from {:.1f} to {:.1f} degrees Celsius: the rate of its "
                  "clock moves with it",
                  temperature.low, temperature.high),
      "record when it is warm");
}

}  // namespace

void add_frame_findings(CameraFindings& found) {
  add_temperature(found);
  add_lost(found);
  add_delivery(found);
  add_backend(found);
  add_exposure(found);
  add_load(found);
}

}  // namespace simbench::evaluation
