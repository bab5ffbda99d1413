// A scenario with a studio, for the tests of reconstruction/.
#ifndef SIMBENCH_TESTS_RECONSTRUCTION_STUDIO_SCENARIO_H_
#define SIMBENCH_TESTS_RECONSTRUCTION_STUDIO_SCENARIO_H_

#include "scenarios/loader.h"
#include "scenarios/scenario.h"

namespace simbench::reconstruction {

// 18 cameras at 6 angles and 3 heights, 3 on a host, 2 m around a standing person.
inline scenarios::Scenario studio_scenario() {
  scenarios::Scenario scenario = scenarios::load_scenario("18cam_6host_45fps");
  scenario.cameras.streams.resize(1);
  scenario.cameras.streams[0].kind = "depth";
  scenario.cameras.streams[0].width = 848;
  scenario.cameras.streams[0].height = 480;
  scenarios::Studio& studio = scenario.studio.emplace();
  studio.radius_m = 2;
  studio.azimuth_step_deg = 60;
  studio.heights_m = {0.5, 1.0, 1.5};
  studio.look_at_height_m = 0.9;
  studio.portrait = true;
  studio.calibration_translation_sigma_mm = 10;
  studio.calibration_rotation_sigma_deg = 0.29;
  studio.stereo_baseline_mm = 95;
  studio.subpixel_error_px = 0.08;
  studio.missing_share = 0.02;
  studio.max_incidence_deg = 80;
  studio.min_distance_m = 0.4;
  studio.max_distance_m = 6;
  studio.point_spacing_mm = 5;
  studio.visibility_tolerance_mm = 50;
  studio.visibility_spread_px = 4;
  studio.subject.kind = "person";
  studio.subject.height_m = 1.75;
  studio.subject.motion = "stand";
  return scenario;
}

}  // namespace simbench::reconstruction

#endif  // SIMBENCH_TESTS_RECONSTRUCTION_STUDIO_SCENARIO_H_
