// The studio of a scenario: optional, inherited, set, checked, described.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "scenarios/camera_profile.h"
#include "tests/scenarios/support.h"

namespace simbench::scenarios {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr const char* kStudio = "18cam_6host_30fps_studio";

// A scenario over the built-in one with a studio; `members` begin on line 2.
std::string over_studio(const std::string& members) {
  return "{\"base\": \"18cam_6host_30fps_studio\", \"name\": \"my\", \"summary\": \"s\",\n" +
         members + "}\n";
}

std::string error_of_studio(const std::string& members) {
  return error_of_text(over_studio(members));
}

Scenario load_over_studio(const std::string& members) {
  return load_scenario_text(over_studio(members), "my.json");
}

std::vector<std::string> warnings_of(const Override& setting) {
  return warnings(load_scenario(kStudio, {setting}));
}

TEST(Studio, AScenarioMayDoWithout) {
  const Scenario scenario = load_scenario("18cam_6host_45fps");
  EXPECT_FALSE(scenario.studio.has_value());
  EXPECT_EQ(scenario.resolved_json().find("studio"), std::string::npos);
}

TEST(Studio, OfThePaper) {
  const Scenario scenario = load_scenario(kStudio);
  ASSERT_TRUE(scenario.studio.has_value());
  const Studio& studio = *scenario.studio;
  EXPECT_EQ(studio.azimuth_step_deg, 60);
  EXPECT_THAT(studio.heights_m, ElementsAre(0.5, 1, 1.5));
  EXPECT_EQ(studio.subject.kind, SubjectKind::kPerson);
  EXPECT_EQ(studio.subject.mesh_file, "");
  EXPECT_EQ(studio.subject.motion, MotionScript::kWalkAndTurn);
  EXPECT_EQ(studio.published.at("ntp_last_set").mean_cm, 9.703);
  EXPECT_EQ(studio.published.at("ntp_last_set").std_cm, 12.1391);
  EXPECT_EQ(studio.published.at("yoon2021_both").mean_cm, 2.3942);
  EXPECT_EQ(studio.published.at("yoon2021_both").std_cm, 1.7967);
  EXPECT_TRUE(scenario.published.empty()) << "Tables 2 and 3 are at 15 and 45 fps";
}

// docs/reference/calibration.md section 6: noise of 0.00196 z^2 m.
TEST(Studio, DepthNoiseOfTheStudy) {
  const Scenario scenario = load_scenario(kStudio);
  const Stream& depth = scenario.cameras.streams.front();
  const double focal_px = find_camera_profile(scenario.cameras.model)
                              ->stream(StreamKind::kDepth)
                              ->find_size(depth.width, depth.height)
                              ->focal_px;
  const Studio& studio = *scenario.studio;
  EXPECT_NEAR(studio.subpixel_error_px / (focal_px * studio.stereo_baseline_mm * 1e-3), 0.00196,
              5e-6);
}

TEST(Studio, IsInherited) {
  const Scenario scenario =
      load_over_studio(R"("studio": {"radius_m": 3, "subject": {"motion": "stand"}})");
  ASSERT_TRUE(scenario.studio.has_value());
  EXPECT_EQ(scenario.studio->radius_m, 3);
  EXPECT_EQ(scenario.studio->azimuth_step_deg, 60);
  EXPECT_EQ(scenario.studio->subject.motion, MotionScript::kStand);
  EXPECT_EQ(scenario.studio->subject.height_m, 1.75);
  EXPECT_TRUE(scenario.studio->published.empty());
}

TEST(Studio, NullForgetsIt) {
  for (const Scenario& scenario :
       {load_over_studio(R"("studio": null)"), load_scenario(kStudio, {{"/studio", "null"}}),
        load_derived(R"("studio": null)")}) {
    EXPECT_FALSE(scenario.studio.has_value());
    EXPECT_EQ(scenario.resolved_json().find("studio\":"), std::string::npos);
  }
}

TEST(Studio, PublishedErrorsDoNotOutliveTheirPipelines) {
  const Scenario scenario = load_over_studio(
      R"("pipelines": [{"name": "yoon2021_both", "host_sync": "yoon2021_both",
                        "device_time": "regression_30", "gathering": "yoon2021"}])");
  ASSERT_EQ(scenario.studio->published.size(), 1U);
  EXPECT_EQ(scenario.studio->published.begin()->first, "yoon2021_both");
  EXPECT_EQ(error_of_studio(R"("studio": {"published": {"ntp": {"mean_cm": 1, "std_cm": 1}}})"),
            "my.json:2: /studio/published/ntp: found no such pipeline, did you mean ntp_last_set?");
}

TEST(Studio, Set) {
  const Scenario scenario = load_scenario(kStudio, {{"/studio/subject/walk_speed_m_per_s", "0.5"},
                                                    {"/studio/heights_m", "[1.2]"},
                                                    {"/studio/azimuth_step_deg", "20"}});
  EXPECT_EQ(scenario.studio->subject.walk_speed_m_per_s, 0.5);
  EXPECT_THAT(scenario.studio->heights_m, ElementsAre(1.2));
}

TEST(Studio, ASetOfAScenarioWithoutOne) {
  EXPECT_THAT(error_of_set("/studio/radius_m", "3"),
              HasSubstr("--set /studio/radius_m=3: found no \"studio\" in the scenario"));
}

TEST(Studio, SchemaErrors) {
  EXPECT_EQ(error_of_studio(R"("studio": 1)"),
            "my.json:2: /studio: found 1, allowed an object or null");
  EXPECT_EQ(error_of_studio(R"("studio": {"heights_m": []})"),
            "my.json:2: /studio/heights_m: found an array of 0, allowed an array of 1 to 100");
  EXPECT_EQ(error_of_studio(R"("studio": {"radius_m": 0})"),
            "my.json:2: /studio/radius_m: found 0, allowed a number above 0 and at most 1000");
  EXPECT_EQ(error_of_studio(R"("studio": {"missing_share": 1})"),
            "my.json:2: /studio/missing_share: found 1, allowed a number from 0 to 0.99");
  EXPECT_EQ(error_of_studio(R"("studio": {"radius": 2})"),
            "my.json:2: /studio/radius: found an unknown key, did you mean radius_m?");
  EXPECT_EQ(error_of_studio(R"("studio": {"subject": {"motion": "run"}})"),
            "my.json:2: /studio/subject/motion: found \"run\", allowed \"stand\", \"turn\", "
            "\"walk\", \"walk_and_turn\", \"raise_arms\"");
  // A scenario that has no base with a studio must state all of it.
  EXPECT_EQ(error_of(R"("studio": {})"),
            "my.json:3: /studio/azimuth_step_deg: found nothing, allowed a number above 0 and at "
            "most 360");
}

TEST(Studio, TheSubjectAndItsMesh) {
  EXPECT_EQ(error_of_studio(R"("studio": {"subject": {"kind": "mesh"}})"),
            load_scenario(kStudio).origin->describe("/studio/subject/mesh_file") +
                ": found \"\", allowed the path of a PLY, OBJ, OFF or STL file: the subject is a "
                "mesh");
  EXPECT_EQ(
      error_of_studio(R"("studio": {"subject": {"mesh_file": "a\n.ply"}})"),
      "my.json:2: /studio/subject/mesh_file: found \"a\\n.ply\", allowed \"\": the subject is "
      "a person");
  EXPECT_EQ(error_of_studio(R"("studio": {"subject": {"kind": "mesh", "mesh_file": "scan.ply"}})"),
            "");
}

TEST(Studio, Distances) {
  EXPECT_EQ(error_of_studio(R"("studio": {"min_distance_m": 6})"),
            "my.json:2: /studio/min_distance_m: found 6, allowed less than "
            "/studio/max_distance_m, 6");
}

TEST(Studio, RoomForTheCameras) {
  EXPECT_EQ(error_of_studio(R"("studio": {"azimuth_step_deg": 60.5})"),
            "my.json:2: /studio/azimuth_step_deg: found 60.5, allowed at most 60: 18 cameras at 3 "
            "height(s) need 6 angles");
  EXPECT_EQ(error_of_studio(R"("studio": {"azimuth_step_deg": 20})"), "");
  // 19 cameras do not fit at 60 degrees, whoever stated those.
  EXPECT_THAT(error_of_studio(R"("cameras": {"count": 19}, "hosts": {"count": 7})"),
              HasSubstr("/studio/azimuth_step_deg: found 60, allowed at most 51.43: 19 cameras"));
}

TEST(Studio, NeedsDepthImagesOfAKnownFocalLength) {
  const std::string stream = R"({"width": 848, "height": 480, "bytes_per_pixel": 2,
    "mode_rate_hz": 30, "pipeline_latency_ms": 8, "latency_mode_periods": 0, "shutter": "global",
    "readout_ms": 0, "kind": )";
  EXPECT_THAT(error_of_studio(R"("evaluation": {"stream": "colour"}, "cameras": {"streams": [)" +
                              stream + R"("colour"}], "sync_mode": "full_slave"})"),
              HasSubstr("/studio: found a studio without a depth stream in /cameras/streams, "
                        "allowed null"));
  EXPECT_THAT(error_of_text(R"({"base": "9cam_3host_30fps_azure_kinect", "name": "my",
                                "summary": "s", "studio": )" +
                            [] {
                              auto studio = nlohmann::json::parse(studio_of(kStudio));
                              studio["published"] = nlohmann::json::object();
                              return studio.dump();
                            }() +
                            "}"),
              HasSubstr("my.json:2: /studio: found a studio with depth images of 640x576, whose "
                        "focal length the profile of the Azure Kinect DK does not state"));
}

TEST(Studio, Warnings) {
  EXPECT_THAT(warnings(load_scenario(kStudio)), IsEmpty());
  EXPECT_THAT(warnings_of({"/studio/radius_m", "7"}),
              ElementsAre("--set /studio/radius_m=7: cameras are 7 to 7.03 m from the centre they "
                          "look at and see from 0.4 to 6 m"));
  EXPECT_THAT(warnings_of({"/studio/subject/turn_rate_rad_per_s", "0.5"}),
              ElementsAre(HasSubstr("/studio/subject/walk_speed_m_per_s: the subject walks on a "
                                    "circle of 2.4 m, the cameras stand on one of 2 m")));
  EXPECT_THAT(warnings_of({"/studio/subject/turn_rate_rad_per_s", "0"}), IsEmpty())
      << "it walks to and fro then";
}

TEST(Studio, Described) {
  const std::vector<ParameterLine> lines = describe(load_scenario(kStudio));
  const auto unit = [&lines](const std::string& pointer) {
    const auto found =
        std::find_if(lines.begin(), lines.end(),
                     [&pointer](const ParameterLine& each) { return each.pointer == pointer; });
    return found == lines.end() ? "no such line" : found->unit;
  };
  EXPECT_EQ(unit("/studio/radius_m"), "m");
  EXPECT_EQ(unit("/studio/heights_m/2"), "m");
  EXPECT_EQ(unit("/studio/azimuth_step_deg"), "degrees");
  EXPECT_EQ(unit("/studio/calibration_translation_sigma_mm"), "mm");
  EXPECT_EQ(unit("/studio/subpixel_error_px"), "pixels");
  EXPECT_EQ(unit("/studio/subject/walk_speed_m_per_s"), "m/s");
  EXPECT_EQ(unit("/studio/subject/turn_rate_rad_per_s"), "rad/s");
  EXPECT_EQ(unit("/studio/published/ntp_last_set/mean_cm"), "cm");
  EXPECT_EQ(unit("/studio/portrait"), "");
  for (const ParameterLine& line : lines) {
    if (!line.pointer.starts_with("/studio")) continue;
    EXPECT_FALSE(line.meaning.empty()) << line.pointer;
    EXPECT_FALSE(line.source.empty()) << line.pointer;
  }
}

}  // namespace
}  // namespace simbench::scenarios
