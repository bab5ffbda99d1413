// The camera profiles of the distribution.
#include "scenarios/camera_profile.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>

#include "scenarios/builtin_files.h"
#include "scenarios/schema.h"
#include "tests/nonempty.h"

namespace simbench::scenarios {
namespace {

using nlohmann::json;
using testing::ElementsAre;

// Every object is closed and says what it requires, and everything has a description.
void expect_well_stated(const json& node) {
  EXPECT_TRUE(node.contains("description")) << node.dump();
  if (node.contains("properties")) {
    EXPECT_EQ(node["additionalProperties"], false) << node.dump();
    EXPECT_FALSE(node["required"].empty()) << node.dump();
    for (const json& child : node["properties"]) expect_well_stated(child);
  }
  if (node.contains("items")) expect_well_stated(node["items"]);
}

TEST(CameraProfiles, AllAreThereInOrder) {
  std::vector<std::string> models;
  for (const CameraProfile& camera : camera_profiles()) models.push_back(camera.model);
  EXPECT_THAT(models,
              ElementsAre("astra_plus", "astra_s", "azure_kinect", "basler_aca1440_220uc",
                          "basler_aca1440_73gm", "basler_aca1920_155um", "basler_aca2040_55uc",
                          "d435", "d455", "esp32_camera", "flir_bfs_pge_31s4", "flir_bfs_u3_16s2",
                          "flir_bfs_u3_31s4", "gige_ace", "l515", "oak_4", "pixel_phone",
                          "raspberry_camera_v3", "raspberry_hq"));
}

TEST(CameraProfiles, AreWhatTheirSchemaAsksFor) {
  expect_well_stated(json::parse(camera_schema_text()));
  const JsonSchema schema(json::parse(camera_schema_text()));
  for (const BuiltinFile& file : nonempty(camera_files())) {
    const json profile = json::parse(file.text);
    const auto problems = schema.problems(profile);
    EXPECT_TRUE(problems.empty()) << file.name << ": " << problems.front().text;
    EXPECT_EQ(profile["model"], file.name);
  }
  json broken = json::parse(camera_files().front().text);
  broken["sync"].erase("wiring");
  EXPECT_FALSE(schema.problems(broken).empty());
}

TEST(CameraProfiles, AreConsistent) {
  for (const CameraProfile& camera : nonempty(camera_profiles())) {
    SCOPED_TRACE(camera.model);
    ASSERT_NE(camera.sync_mode(SyncMode::kDefault), nullptr);
    EXPECT_TRUE(camera.sync_mode(SyncMode::kDefault)->triggered.empty());
    std::set<SyncMode> modes;
    for (const SyncModeProfile& mode : nonempty(camera.sync_modes)) {
      EXPECT_TRUE(modes.insert(mode.mode).second);
      for (const StreamKind kind : mode.triggered) EXPECT_NE(camera.stream(kind), nullptr);
    }
    EXPECT_TRUE(std::is_sorted(camera.sync_rates_hz.begin(), camera.sync_rates_hz.end()));
    for (const StreamProfile& stream : nonempty(camera.streams)) {
      EXPECT_EQ(camera.stream(stream.kind), &stream) << "one stream of a kind";
      EXPECT_EQ(stream.shutter == ShutterKind::kRolling, stream.readout_periods > 0);
      for (const ImageSize& size : nonempty(stream.sizes)) {
        EXPECT_EQ(stream.find_size(size.width, size.height), &size) << "a size once only";
        EXPECT_TRUE(std::is_sorted(size.rates_hz.begin(), size.rates_hz.end()));
      }
    }
    std::set<std::string> stamps;
    for (const StampProfile& stamp : nonempty(camera.stamps)) {
      EXPECT_TRUE(stamps.insert(stamp.stamp).second) << stamp.stamp;
      if (stamp.clock == "host") continue;  // all, of a camera that is a computer itself
      EXPECT_EQ(stamp.clock, "camera");
      EXPECT_TRUE(stamp.stamp == "sensor" || stamp.stamp == "frame") << stamp.stamp;
    }
  }
}

TEST(CameraProfiles, WhatTheTriggerLeads) {
  const CameraProfile& d455 = *find_camera_profile("d455");
  EXPECT_FALSE(d455.triggers(SyncMode::kDefault, StreamKind::kDepth));
  EXPECT_FALSE(d455.triggers(SyncMode::kMaster, StreamKind::kDepth));
  EXPECT_TRUE(d455.triggers(SyncMode::kSlave, StreamKind::kDepth));
  EXPECT_FALSE(d455.triggers(SyncMode::kSlave, StreamKind::kColour));
  EXPECT_TRUE(d455.triggers(SyncMode::kFullSlave, StreamKind::kColour));
  EXPECT_TRUE(d455.triggers(SyncMode::kGenlock, StreamKind::kDepth));
  EXPECT_FALSE(d455.triggers(SyncMode::kGenlock, StreamKind::kColour));
  EXPECT_FALSE(find_camera_profile("d435")->triggers(SyncMode::kSlave, StreamKind::kColour));
  EXPECT_EQ(find_camera_profile("d435")->sync_mode(SyncMode::kFullSlave), nullptr);
  EXPECT_TRUE(find_camera_profile("azure_kinect")->triggers(SyncMode::kSlave, StreamKind::kColour));
  EXPECT_FALSE(find_camera_profile("l515")->triggers(SyncMode::kSlave, StreamKind::kDepth));
  EXPECT_EQ(find_camera_profile("D455"), nullptr);
}

// The specifications of Table 1 of Yoon et al. 2021.
TEST(CameraProfiles, SizesOfThePapersTable) {
  const auto rates = [](const char* model, StreamKind kind, int width, int height) {
    const ImageSize* size = find_camera_profile(model)->stream(kind)->find_size(width, height);
    return size == nullptr ? std::vector<double>{} : size->rates_hz;
  };
  using testing::Contains;
  EXPECT_THAT(rates("azure_kinect", StreamKind::kColour, 3840, 2160), Contains(30));
  EXPECT_THAT(rates("azure_kinect", StreamKind::kDepth, 640, 576), Contains(30));
  EXPECT_THAT(rates("astra_plus", StreamKind::kColour, 1920, 1080), Contains(30));
  EXPECT_THAT(rates("astra_plus", StreamKind::kDepth, 640, 480), Contains(30));
  EXPECT_THAT(rates("astra_s", StreamKind::kColour, 1280, 720), Contains(30));
  EXPECT_THAT(rates("astra_s", StreamKind::kDepth, 640, 480), Contains(30));
  EXPECT_THAT(rates("d455", StreamKind::kColour, 1280, 800), Contains(30));
  EXPECT_THAT(rates("d455", StreamKind::kDepth, 1280, 720), Contains(30));
  EXPECT_THAT(rates("d455", StreamKind::kDepth, 848, 480), Contains(90));
  EXPECT_THAT(rates("d435", StreamKind::kColour, 1920, 1080), Contains(30));
  EXPECT_THAT(rates("d435", StreamKind::kDepth, 1280, 720), Contains(30));
  EXPECT_THAT(rates("d435", StreamKind::kDepth, 848, 480), Contains(90));
  EXPECT_THAT(rates("l515", StreamKind::kColour, 1920, 1080), Contains(30));
  EXPECT_THAT(rates("l515", StreamKind::kDepth, 1024, 768), Contains(30));
  for (const char* model : {"azure_kinect", "astra_plus", "astra_s", "l515"}) {
    for (const ImageSize& size :
         nonempty(find_camera_profile(model)->stream(StreamKind::kDepth)->sizes)) {
      EXPECT_LE(size.rates_hz.back(), 30) << model << " has no 90 Hz";
    }
  }
}

// docs/reference/calibration.md section 6: 107.5 px at a quarter of 848x480.
TEST(CameraProfiles, FocalLengthOfDepth) {
  const StreamProfile& depth = *find_camera_profile("d455")->stream(StreamKind::kDepth);
  EXPECT_EQ(depth.find_size(848, 480)->focal_px, 4 * 107.5);
  EXPECT_EQ(depth.find_size(848, 100)->focal_px, 430) << "a crop";
  EXPECT_NEAR(depth.find_size(640, 480)->focal_px, 0.6 * depth.find_size(1280, 720)->focal_px, 0.01)
      << "a crop of 768x480";
  EXPECT_EQ(depth.find_size(256, 144)->focal_px, depth.find_size(1280, 720)->focal_px) << "a crop";
  int nominal = 0;
  for (const ImageSize& size : depth.sizes) {
    if (size.width == 256 || size.height == 100 || size.height * 4 == size.width * 3) continue;
    ++nominal;
    EXPECT_NEAR(size.focal_px, 430 * static_cast<double>(size.width) / 848, 0.01)
        << size.width << 'x' << size.height;
  }
  EXPECT_GT(nominal, 0);
  for (const ImageSize& size :
       nonempty(find_camera_profile("d435")->stream(StreamKind::kDepth)->sizes)) {
    EXPECT_NEAR(size.focal_px, depth.find_size(size.width, size.height)->focal_px, 10);
  }
  int colour_streams = 0;
  for (const CameraProfile& camera : camera_profiles()) {
    const StreamProfile* colour = camera.stream(StreamKind::kColour);
    if (colour == nullptr) continue;
    ++colour_streams;
    for (const ImageSize& size : nonempty(colour->sizes))
      EXPECT_EQ(size.focal_px, 0) << camera.model;
  }
  EXPECT_GT(colour_streams, 0);
}

// docs/reference/capture_alignment.md, sections 1 to 4 and 9.
TEST(CameraProfiles, ControlsOfFramesThatTheMakersOffer) {
  const auto offered = [](const char* model) {
    const std::optional<FrameControlProfile>& control = find_camera_profile(model)->frame_control;
    std::string text;
    if (!control) return std::string("not known");
    EXPECT_FALSE(control->source.empty()) << model;
    if (control->adjust_frame) text += "adjust ";
    if (control->insert_frame) text += "insert ";
    if (control->frame_length) text += "length ";
    if (control->start_at) text += "start ";
    return text;
  };
  EXPECT_EQ(offered("d455"), "");
  EXPECT_EQ(offered("d435"), "");
  EXPECT_EQ(offered("pixel_phone"), "insert length ");
  EXPECT_EQ(offered("raspberry_camera_v3"), "adjust length ");
  EXPECT_EQ(offered("gige_ace"), "adjust length start ");
  EXPECT_EQ(offered("oak_4"), "length ");
  EXPECT_EQ(offered("esp32_camera"), "start ");
  EXPECT_EQ(offered("azure_kinect"), "not known");
}

TEST(CameraProfiles, JsonHasThemAll) {
  const json all = json::parse(camera_profiles_json());
  ASSERT_EQ(all.size(), camera_profiles().size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(all[i]["model"], camera_profiles()[i].model);
    EXPECT_FALSE(all[i].contains("$schema"));
  }
}

}  // namespace
}  // namespace simbench::scenarios
