#include "reports/reconstruction/reconstruction_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "evaluation/statistics/statistics.h"

namespace simbench::reports {
namespace {

using reconstruction::ReconstructionResults;
using reconstruction::ReprojectionRow;
using scenarios::PublishedReprojection;
using scenarios::Studio;
using scenarios::StudioSubject;

bool walks(const StudioSubject& subject) {
  return subject.motion == "walk" || subject.motion == "walk_and_turn";
}

std::string motion_text(const StudioSubject& subject) {
  std::string text = fmt::format("motion \"{}\"", subject.motion);
  if (walks(subject)) text += fmt::format(" at {:g} m/s", subject.walk_speed_m_per_s);
  if (subject.motion == "turn" || subject.motion == "walk_and_turn") {
    text +=
        fmt::format("{} {:g} rad/s", walks(subject) ? " and" : " at", subject.turn_rate_rad_per_s);
  }
  if (subject.motion == "raise_arms") {
    text += fmt::format(" at {:g} rad/s", subject.arm_rate_rad_per_s);
  }
  return text;
}

std::string subject_note(const StudioSubject& subject) {
  const std::string who =
      subject.kind == "mesh"
          ? fmt::format("The subject is the mesh {}", subject.mesh_file)
          : fmt::format("The subject is a simulated person of {:g} m", subject.height_m);
  return fmt::format("{}, {}; the paper says \"moving person\" and no more.", who,
                     motion_text(subject));
}

std::string assumptions_note(const Studio& studio) {
  return fmt::format(
      "Assumptions: calibration errors of {:g} mm and {:g} degrees per axis, depth noise of {:g} "
      "px "
      "of disparity; a vertex counts as seen up to {:g} mm behind the mesh's own z-buffer, spread "
      "by {} pixels.",
      studio.calibration_translation_sigma_mm, studio.calibration_rotation_sigma_deg,
      studio.subpixel_error_px, studio.visibility_tolerance_mm, studio.visibility_spread_px);
}

// The row with the smallest published mean hardly sees time at all.
std::string floor_note(const std::vector<ReprojectionRow>& rows, const StudioSubject& subject) {
  const ReprojectionRow* best = nullptr;
  for (const ReprojectionRow& row : rows) {
    if (!row.published) continue;
    if (best == nullptr || row.published->mean_cm < best->published->mean_cm) best = &row;
  }
  if (best == nullptr || !walks(subject)) return "";
  const double ms = best->desync_ms().median;
  const double moved_cm = ms * subject.walk_speed_m_per_s / 10;
  if (!(moved_cm < best->mean_cm().median)) return "";
  return fmt::format(
      "In the {} ms of {} the subject moves {} cm: that row measures calibration and depth noise, "
      "and cannot be told from a perfect synchronisation.",
      ms_text(ms), best->pipeline, cm_text(moved_cm));
}

std::string speed_phrase(const reconstruction::CurvePoint& point) {
  if (point.speed_m_per_s > 0) return speed_text(point.speed_m_per_s, point.speed_factor);
  return fmt::format("{:g} times the stated one", point.speed_factor);
}

// Medians and bands: what the speed that is found between two of them is worth.
std::string points_text(const std::vector<reconstruction::CurvePoint>& points) {
  std::string text;
  for (const reconstruction::CurvePoint& point : points) {
    text += fmt::format("{}{}: {} cm", text.empty() ? "" : ", ", speed_phrase(point),
                        cm_text(evaluation::make_series(point.mean_cm)));
  }
  return text;
}

}  // namespace

std::string cm_text(double cm) { return std::isnan(cm) ? "-" : fmt::format("{:.2f}", cm); }

std::string cm_text(const evaluation::Series& series) {
  if (std::isnan(series.median)) return "-";
  return fmt::format("{:.2f} [{:.2f}, {:.2f}]", series.median, series.p05, series.p95);
}

std::string ms_text(double ms) {
  if (std::isnan(ms)) return "-";
  return fmt::format("{:.{}f}", ms, std::abs(ms) < 1 ? 3 : 1);
}

std::string ms_text(const evaluation::Series& series) {
  if (std::isnan(series.median)) return "-";
  return fmt::format("{} [{}, {}]", ms_text(series.median), ms_text(series.p05),
                     ms_text(series.p95));
}

std::string speed_text(double speed_m_per_s, double speed_factor) {
  if (speed_m_per_s > 0) return fmt::format("{:.2f} m/s", speed_m_per_s);
  return fmt::format("x {:g}", speed_factor);
}

std::string published_text(const std::optional<PublishedReprojection>& published,
                           double PublishedReprojection::*member,
                           const evaluation::Series& simulated) {
  if (!published) return "-";
  const double value = (*published).*member;
  if (std::isnan(simulated.median)) return cm_text(value);
  return fmt::format("{}, {}", cm_text(value),
                     evaluation::inside(value, simulated) ? "inside" : "outside");
}

double no_gathered_set_share(const ReprojectionRow& row) {
  const auto without = std::count_if(row.seeds.begin(), row.seeds.end(),
                                     [](const auto& seed) { return !seed.gathered; });
  return row.seeds.empty() ? reconstruction::kNoError
                           : static_cast<double>(without) / static_cast<double>(row.seeds.size());
}

std::string limit_text(const SyncLimit& limit) {
  if (std::isnan(limit.floor_cm)) return "-";
  return limit.limit_ms ? ms_text(*limit.limit_ms) : fmt::format("> {:g}", limit.last_ms);
}

std::string cost_text(const SyncLimit& limit) {
  return std::isnan(limit.cost_cm_per_ms) ? "-" : fmt::format("{:.4f}", limit.cost_cm_per_ms);
}

std::string ratio_sentence(const PublishedRatio& ratio) {
  return fmt::format("{} : {} = {} in the mean error, seed by seed; published: {:.2f}.",
                     ratio.worst, ratio.best, cm_text(ratio.ratio), ratio.published);
}

std::string speed_sentence(const reconstruction::SpeedNeeded& needed) {
  const std::string what =
      fmt::format("the published {} cm of {}, at its {} ms", cm_text(needed.published_mean_cm),
                  needed.pipeline, ms_text(needed.desync_ms));
  if (needed.points.empty()) return "";
  const reconstruction::CurvePoint& first = needed.points.front();
  const reconstruction::CurvePoint& last = needed.points.back();
  const double at_first = evaluation::median(first.mean_cm);
  if (at_first >= needed.published_mean_cm) {
    return fmt::format("At {} the error is {} cm already, which is more than {}.",
                       speed_phrase(first), cm_text(at_first), what);
  }
  if (needed.speed_m_per_s && *needed.speed_m_per_s > 0) {
    return fmt::format("For {}, the subject would have to move at {:.2f} m/s ({}).", what,
                       *needed.speed_m_per_s, points_text(needed.points));
  }
  if (const auto factor = speed_factor_for(needed.points, needed.published_mean_cm)) {
    return fmt::format("For {}, the subject would have to be {:.2f} times as fast as stated ({}).",
                       what, *factor, points_text(needed.points));
  }
  return fmt::format("No speed of the subject up to {} gives {}: it is {} cm there.",
                     speed_phrase(last), what, cm_text(evaluation::median(last.mean_cm)));
}

std::vector<std::string> honest_notes(const ReconstructionResults& results) {
  std::vector<std::string> notes;
  if (results.scenario.studio) {
    const Studio& studio = *results.scenario.studio;
    notes = {subject_note(studio.subject), assumptions_note(studio)};
    const std::string floor = floor_note(results.rows, studio.subject);
    if (!floor.empty()) notes.push_back(floor);
  }
  notes.insert(notes.end(), results.notes.begin(), results.notes.end());
  return notes;
}

}  // namespace simbench::reports
