// A small hand-made reconstruction experiment: three pipelines over three seeds, a curve of two
// speeds whose errors are straight lines.
#pragma once

#include <string>
#include <vector>

#include "reconstruction/results.h"

namespace simbench::reports {

inline reconstruction::ReprojectionRow sample_row(const std::string& pipeline,
                                                  const std::vector<double>& means,
                                                  double desync_ms, bool gathered) {
  reconstruction::ReprojectionRow row;
  row.pipeline = row.host_sync = pipeline;
  row.device_time = "regression_30";
  row.gathering = "yoon2021";
  for (std::size_t i = 0; i < means.size(); ++i) {
    reconstruction::SeedReprojection seed;
    seed.seed = i + 1;
    seed.errors = {.mean_cm = means[i],
                   .std_cm = means[i] / 2,
                   .median_cm = means[i] / 4,
                   .p95_cm = means[i] * 3,
                   .count = 1000};
    seed.desync_ms = desync_ms;
    seed.sets = 10;
    seed.gathered = gathered;
    row.seeds.push_back(seed);
  }
  return row;
}

inline reconstruction::CurvePoint sample_point(double factor, double desync_ms, double mean_cm) {
  return {.speed_m_per_s = factor * 1.2,
          .speed_factor = factor,
          .desync_ms = desync_ms,
          .mean_cm = {mean_cm - 0.5, mean_cm, mean_cm + 1},
          .std_cm = {1, 2, 3}};
}

// At factor 1 the error is 2 cm up to 10 ms and grows by 0.01 cm/ms from there; at factor 0.5 by
// 0.0002 cm/ms, which 100 ms do not show.
inline std::vector<reconstruction::CurvePoint> sample_curve() {
  return {sample_point(0.5, 0, 2), sample_point(0.5, 10, 2.002), sample_point(0.5, 100, 2.02),
          sample_point(1, 0, 2),   sample_point(1, 10, 2),       sample_point(1, 100, 2.9)};
}

inline scenarios::Studio sample_studio() {
  scenarios::Studio studio;
  studio.calibration_translation_sigma_mm = 10;
  studio.calibration_rotation_sigma_deg = 0.29;
  studio.subpixel_error_px = 0.08;
  studio.subject = {.kind = scenarios::SubjectKind::kPerson,
                    .mesh_file = "",
                    .height_m = 1.75,
                    .motion = scenarios::MotionScript::kWalkAndTurn,
                    .walk_speed_m_per_s = 1.2,
                    .turn_rate_rad_per_s = 1,
                    .arm_rate_rad_per_s = 0};
  studio.published = {{"ntp_last_set", {.mean_cm = 9.703, .std_cm = 12.1391}},
                      {"yoon2021_both", {.mean_cm = 2.3942, .std_cm = 1.7967}}};
  return studio;
}

inline reconstruction::ReconstructionResults sample_reconstruction() {
  reconstruction::ReconstructionResults results;
  results.scenario.name = "a_studio";
  results.scenario.studio = sample_studio();
  results.seeds = 3;
  results.frames = 10;
  results.rows = {sample_row("ntp_last_set", {6, 8, 13}, 547, false),
                  sample_row("yoon2021_both", {2, 2.4, 2.6}, 5, true),
                  sample_row("oracle", {2, reconstruction::kNoError, 2.2}, 0.25, true)};
  results.rows[0].published = sample_studio().published.at("ntp_last_set");
  results.rows[1].published = sample_studio().published.at("yoon2021_both");
  results.rows[0].seeds[1].gathered = true;
  results.rows[0].seeds[2].missing_frames = 7;
  results.rows[2].seeds[1].sets = 0;
  results.rows[2].seeds[1].failed_sets = 10;
  results.rows[2].notes = {"seed 2: too little of the subject was seen"};
  results.curve = sample_curve();
  results.speed_needed = {.pipeline = "ntp_last_set",
                          .desync_ms = 547,
                          .published_mean_cm = 9.703,
                          .points = {sample_point(1, 547, 7), sample_point(2, 547, 9.5)},
                          .speed_m_per_s = std::nullopt};
  results.notes = {"the mesh has 3 holes"};
  results.wall_s = 61.25;
  results.seconds_per_set = 4.5;
  return results;
}

}  // namespace simbench::reports
