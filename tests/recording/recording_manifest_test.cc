#include "recording/recording_manifest.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <random>
#include <string>

#include "recording/version.h"
#include "tests/recording/random_events.h"

namespace simbench {
namespace {

using Json = nlohmann::ordered_json;
using ::testing::HasSubstr;

RecordingManifest manifest() {
  RecordedCapture capture;
  capture.pipeline = "p";
  capture.seed = 7;
  capture.layout = {
      .hosts = 2, .cameras = {{0}, {1}}, .frame_rate_hz = 0.1, .first_pulse = 3, .pulses = 4};
  capture.complete = true;
  capture.cost = {.events = 5, .simulated_seconds = 0.1 + 0.2, .trace_hash = 6};
  capture.notes = {"a \"note\"\n"};
  capture.frames = 8;
  capture.other_events = 9;
  return {{"hardware", "{\n  \"a\": 0.1\n}\n", {"h0", "h1"}, {"c0", "c1"}}, {capture}};
}

std::string manifest_error(const std::string& text) {
  try {
    parse_manifest(text, "m.json");
  } catch (const RecordingFolderError& error) {
    return error.what();
  }
  return "no error";
}

// The manifest with one value replaced (or removed).
std::string changed(const std::string& pointer, const Json& value) {
  Json root = Json::parse(manifest_text(manifest()));
  root[Json::json_pointer(pointer)] = value;
  return root.dump();
}

TEST(RecordingManifestTest, ReadsBackWhatWasWritten) {
  const RecordingManifest written = manifest();
  const RecordingManifest read = parse_manifest(manifest_text(written), "m.json");
  EXPECT_EQ(read.description.backend, "hardware");
  EXPECT_EQ(read.description.scenario_json, written.description.scenario_json);
  EXPECT_EQ(read.description.hosts, written.description.hosts);
  EXPECT_EQ(read.description.cameras, written.description.cameras);
  ASSERT_EQ(read.captures.size(), 1U);
  const RecordedCapture& a = written.captures[0];
  const RecordedCapture& b = read.captures[0];
  EXPECT_TRUE(same(a.layout, b.layout));
  EXPECT_EQ(b.seed, 7U);
  EXPECT_EQ(b.cost.simulated_seconds, a.cost.simulated_seconds);
  EXPECT_EQ(b.cost.trace_hash, 6U);
  EXPECT_EQ(b.notes, a.notes);
  EXPECT_EQ(b.frames, 8U);
  EXPECT_EQ(b.other_events, 9U);
  EXPECT_EQ(manifest_text(read), manifest_text(written));
}

TEST(RecordingManifestTest, AScenarioMayBeAbsent) {
  RecordingManifest none = manifest();
  none.description.scenario_json = "";
  EXPECT_EQ(parse_manifest(manifest_text(none), "m.json").description.scenario_json, "");
}

TEST(RecordingManifestTest, MessagesNamePlaceFoundAndAllowed) {
  EXPECT_EQ(manifest_error(changed("/format", "zip")),
            "m.json: /format: found '\"zip\"', allowed: 'simbench recording'");
  EXPECT_EQ(manifest_error(changed("/format_version", 0)),
            "m.json: /format_version: found '0', allowed: a whole number from 1 to 1");
  EXPECT_EQ(manifest_error(changed("/captures/0/layout/camera_hosts/1", 2)),
            "m.json: /captures/0/layout/camera_hosts/1: found '2', allowed: a whole number from 0 "
            "to 1");
  EXPECT_EQ(manifest_error(changed("/captures/0/cost", Json::object())),
            "m.json: /captures/0/cost/events: missing");
  EXPECT_EQ(manifest_error(changed("/captures", 5)),
            "m.json: /captures: found '5', allowed: an array of at most 1000000");
  EXPECT_THAT(manifest_error("{\"format\": }"),
              HasSubstr("m.json: parse error at line 1, column 12"));
}

TEST(RecordingManifestTest, ANewerFormatNamesItsWriterAndThisProgram) {
  EXPECT_EQ(manifest_error(changed("/format_version", 2)),
            fmt::format("m.json: /format_version: found '2', allowed: at most 1; a newer simbench "
                        "({0}) wrote this and reads it; this is simbench {0}",
                        version()));
}

TEST(RecordingManifestTest, NumbersBeyondWhatARigCanHaveAreRefused) {
  const std::string layout = "/captures/0/layout";
  for (const auto& [pointer, value] : std::initializer_list<std::pair<std::string, Json>>{
           {layout + "/hosts", 0},
           {layout + "/hosts", -1},
           {layout + "/hosts", 1.5},
           {layout + "/hosts", 4294967297},
           {layout + "/hosts", "2"},
           {layout + "/camera_hosts", Json::array()},
           {layout + "/camera_hosts", 0},
           {layout + "/frame_rate_hz", 0},
           {layout + "/frame_rate_hz", -1},
           {layout + "/frame_rate_hz", 1e300},
           {layout + "/frame_rate_hz", nullptr},
           {layout + "/first_pulse", 1e18},
           {layout + "/pulses", -1},
           {layout + "/pulses", ~std::uint64_t{0}},
           {"/captures/0/cost/simulated_seconds", -1},
           {"/captures/0/seed", -1},
           {"/captures/0/complete", 1},
           {"/captures/0/notes", "a"},
           {"/captures/0/notes/0", 1},
           {"/captures/0/pipeline", nullptr},
           {"/scenario", 5},
           {"/hosts", nullptr}}) {
    EXPECT_THAT(manifest_error(changed(pointer, value)), HasSubstr("m.json: /" + pointer.substr(1)))
        << value;
  }
}

TEST(RecordingManifestTest, ANumberThatNoDoubleHoldsIsRefused) {
  EXPECT_EQ(manifest_error("{\"format\": 1e999}"), "m.json: number overflow parsing '1e999'");
}

TEST(RecordingManifestTest, EachCaptureIsThereOnce) {
  RecordingManifest twice = manifest();
  twice.captures.push_back(twice.captures[0]);
  EXPECT_EQ(manifest_error(manifest_text(twice)),
            "m.json: /captures/1/seed: found '7', allowed: each pipeline and seed once");
}

TEST(RecordingManifestTest, ADeepDocumentIsRefused) {
  EXPECT_THAT(manifest_error(std::string(1'000'000, '[')), HasSubstr("nested deeper than"));
}

TEST(RecordingManifestTest, AnyChangedByteIsSafe) {
  const auto seed = std::random_device{}();
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  std::mt19937_64 random(seed);
  const std::string whole = manifest_text(manifest());
  int refused = 0;
  for (int i = 0; i < 3000; ++i) {
    std::string text = whole;
    text[random() % text.size()] = static_cast<char>(random());
    try {
      parse_manifest(text, "m.json");
    } catch (const RecordingFolderError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 1000);
}

}  // namespace
}  // namespace simbench
