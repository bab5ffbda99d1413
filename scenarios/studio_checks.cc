#include "scenarios/studio_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenarios/camera_profile.h"
#include "scenarios/document.h"
#include "scenarios/loader.h"

namespace simbench::scenarios {
namespace {

constexpr double kFullCircleDeg = 360;

// How far the farthest camera is from the point that all look at, and the nearest.
struct Sight {
  double nearest_m = 0;
  double farthest_m = 0;
};

Sight sight_of(const Studio& studio) {
  Sight sight = {.nearest_m = HUGE_VAL, .farthest_m = 0};
  for (const double height_m : studio.heights_m) {
    const double distance_m = std::hypot(studio.radius_m, height_m - studio.look_at_height_m);
    sight.nearest_m = std::min(sight.nearest_m, distance_m);
    sight.farthest_m = std::max(sight.farthest_m, distance_m);
  }
  return sight;
}

// The cameras see with their depth stream, whose profile must say how.
void check_depth_stream(const Scenario& scenario) {
  const std::vector<Stream>& streams = scenario.cameras.streams;
  const auto depth = std::find_if(streams.begin(), streams.end(),
                                  [](const Stream& stream) { return stream.kind == "depth"; });
  if (depth == streams.end()) {
    fail_at(scenario, "/studio",
            "found a studio without a depth stream in /cameras/streams, allowed null");
  }
  const CameraProfile* camera = find_camera_profile(scenario.cameras.model);
  if (camera->stream("depth")->find_size(depth->width, depth->height)->focal_px > 0) return;
  fail_at(scenario, "/studio",
          fmt::format("found a studio with depth images of {}x{}, whose focal length the profile "
                      "of the {} does not state",
                      depth->width, depth->height, camera->name));
}

void check_room(const Scenario& scenario) {
  const Studio& studio = *scenario.studio;
  const auto heights = static_cast<std::int64_t>(studio.heights_m.size());
  const std::int64_t azimuths = (scenario.cameras.count + heights - 1) / heights;
  const double widest_deg = kFullCircleDeg / static_cast<double>(azimuths);
  if (studio.azimuth_step_deg <= widest_deg) return;
  fail_at(
      scenario, "/studio/azimuth_step_deg",
      fmt::format("found {}, allowed at most {:.4g}: {} cameras at {} height(s) need {} angles",
                  studio.azimuth_step_deg, widest_deg, scenario.cameras.count, heights, azimuths));
}

void check_subject(const Scenario& scenario) {
  const StudioSubject& subject = scenario.studio->subject;
  if (subject.kind == "mesh" && subject.mesh_file.empty()) {
    fail_at(scenario, "/studio/subject/mesh_file",
            "found \"\", allowed the path of a PLY, OBJ, OFF or STL file: the subject is a mesh");
  }
  if (subject.kind == "person" && !subject.mesh_file.empty()) {
    fail_at(scenario, "/studio/subject/mesh_file",
            fmt::format("found \"{}\", allowed \"\": the subject is a person",
                        shown_text(subject.mesh_file)));
  }
}

}  // namespace

void check_studio(const Scenario& scenario) {
  if (!scenario.studio) return;
  check_depth_stream(scenario);
  check_room(scenario);
  check_subject(scenario);
  const Studio& studio = *scenario.studio;
  if (studio.min_distance_m < studio.max_distance_m) return;
  fail_at(scenario, "/studio/min_distance_m",
          fmt::format("found {}, allowed less than /studio/max_distance_m, {}",
                      studio.min_distance_m, studio.max_distance_m));
}

std::vector<std::string> studio_warnings(const Scenario& scenario) {
  std::vector<std::string> lines;
  if (!scenario.studio) return lines;
  const Studio& studio = *scenario.studio;
  const auto warn = [&](const std::string& pointer, const std::string& text) {
    lines.push_back(scenario.origin->describe(pointer) + ": " + text);
  };
  const Sight sight = sight_of(studio);
  if (sight.nearest_m < studio.min_distance_m || sight.farthest_m > studio.max_distance_m) {
    warn("/studio/radius_m",
         fmt::format("cameras are {:.3g} to {:.3g} m from the centre they look at and see from "
                     "{:g} to {:g} m",
                     sight.nearest_m, sight.farthest_m, studio.min_distance_m,
                     studio.max_distance_m));
  }
  const StudioSubject& subject = studio.subject;
  if (subject.motion == "walk_and_turn" && subject.turn_rate_rad_per_s > 0) {
    const double circle_m = subject.walk_speed_m_per_s / subject.turn_rate_rad_per_s;
    if (circle_m >= studio.radius_m) {
      warn("/studio/subject/walk_speed_m_per_s",
           fmt::format("the subject walks on a circle of {:.3g} m, the cameras stand on one of "
                       "{:g} m",
                       circle_m, studio.radius_m));
    }
  }
  return lines;
}

}  // namespace simbench::scenarios
