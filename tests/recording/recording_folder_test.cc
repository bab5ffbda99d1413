#include "recording/recording_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "recording/event.h"
#include "tests/read_fault.h"
#include "tests/recording/random_events.h"
#include "tests/scratch_folder.h"

namespace simbench {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const RigLayout kLayout = {.hosts = 3,
                           .cameras = {{0}, {2}, {1}, {1}},
                           .frame_rate_hz = 44.977511244377814,
                           .first_pulse = 450,
                           .pulses = 480};

RecordingDescription description() {
  return {.backend = "sim",
          .scenario_json = "{\n  \"name\": \"s\",\n  \"rate_hz\": 45.0\n}\n",
          .hosts = {"left", "right", "top"},
          .cameras = {"0815", "0816", "0817", "ä \"q\""}};
}

std::vector<KeptEvent> some_events(std::mt19937_64& random, int count) {
  std::vector<KeptEvent> events;
  while (count-- > 0) events.push_back(random_event(random, {.hosts = 3, .cameras = 4}));
  return events;
}

void write_events(const std::string& folder, const std::vector<KeptEvent>& events) {
  RecordingWriter writer(folder, description());
  RecordingSink& sink = writer.begin("p", 1);
  sink.on_start(kLayout);
  for (const KeptEvent& event : events) notify(event, sink);
  writer.end({.events = 5, .simulated_seconds = 16.5, .trace_hash = ~std::uint64_t{0}});
}

void expect_same(const std::vector<KeptEvent>& played, const std::vector<KeptEvent>& recorded) {
  ASSERT_EQ(played.size(), recorded.size());
  for (std::size_t i = 0; i < played.size(); ++i) {
    ASSERT_TRUE(same(played[i], recorded[i])) << "event " << i;
  }
}

template <class Work>
std::string error_of(const Work& work) {
  try {
    work();
  } catch (const RecordingFolderError& error) {
    return error.what();
  }
  return "no error";
}

class RecordingFolderTest : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return scratch_ / name; }

  // The error of playing the only capture of a folder.
  static std::string play_error(const std::string& folder) {
    KeptRecording kept;
    return error_of([&] { RecordingFolder(folder).play(0, kept); });
  }

 private:
  ScratchFolder scratch_;
};

TEST_F(RecordingFolderTest, TheFilesAreAsDocumented) {
  FrameEvent bare;
  bare.record.camera = 1;
  FrameEvent with_truth;
  with_truth.record.stream = StreamKind::kColour;
  with_truth.record.arrival = HostTime(Nanoseconds(7));
  with_truth.truth = FrameTruth{};
  write_events(path("r"), {bare, SyncOutcome{2, true, 3, "a, b"}, with_truth});
  EXPECT_EQ(content(path("r/p/1/frames.csv")),
            "order,camera,stream,domain,counter,exposure_us,sensor_us,frame_us,backend_ns,"
            "arrival_ns,arrival_steady_ns,pulse,exposure_start_ns,exposure_end_ns,reference_ns,"
            "own_host_ns,own_steady_ns,delivered_ns\n"
            "0,1,depth,hardware_clock,0,0,0,0,0,0,0,,,,,,,\n"
            "2,0,colour,hardware_clock,0,0,0,0,0,7,0,-1,0,0,0,0,0,0\n");
  EXPECT_EQ(content(path("r/p/1/events.csv")), "1,outcome,2,true,3,a\\, b\n");
}

TEST_F(RecordingFolderTest, PlaysWhatWasRecorded) {
  const auto seed = std::random_device{}();
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  std::mt19937_64 random(seed);
  std::vector<KeptEvent> events = some_events(random, 5000);
  write_events(path("r"), events);

  const RecordingFolder folder(path("r"));
  EXPECT_EQ(folder.description().backend, "sim");
  EXPECT_EQ(folder.description().scenario_json, description().scenario_json);
  EXPECT_EQ(folder.description().hosts, description().hosts);
  EXPECT_EQ(folder.description().cameras, description().cameras);
  ASSERT_EQ(folder.captures().size(), 1U);
  const RecordedCapture& capture = folder.captures()[0];
  EXPECT_EQ(capture.pipeline, "p");
  EXPECT_EQ(capture.seed, 1U);
  EXPECT_TRUE(same(capture.layout, kLayout));
  EXPECT_TRUE(capture.complete);
  EXPECT_EQ(capture.cost.events, 5U);
  EXPECT_EQ(capture.cost.simulated_seconds, 16.5);
  EXPECT_EQ(capture.cost.trace_hash, ~std::uint64_t{0});
  EXPECT_EQ(capture.frames + capture.other_events, events.size());
  EXPECT_THAT(capture.notes, IsEmpty());

  KeptRecording kept;
  folder.play(0, kept);
  EXPECT_TRUE(same(kept.layout(), kLayout));
  expect_same(kept.events(), events);
}

TEST_F(RecordingFolderTest, CapturesAreFoundByPipelineAndSeed) {
  RecordingWriter writer(path("r"), description());
  const std::string odd = "../a/b c.d";
  for (const std::string& pipeline : {std::string("p"), odd, std::string("P.1")}) {
    for (const std::uint64_t seed : {std::uint64_t{1}, ~std::uint64_t{0}}) {
      RecordingSink& sink = writer.begin(pipeline, seed);
      sink.on_start(kLayout);
      sink.on_event(SyncOutcome{1, true, 0, pipeline + std::to_string(seed)});
      writer.end({.notes = {"unplugged"}}, {"host 2 was lost"});
    }
  }
  EXPECT_TRUE(fs::exists(path("r/%2E.%2Fa%2Fb%20c.d/1/frames.csv")));
  EXPECT_TRUE(fs::exists(path("r/P.1/18446744073709551615/frames.csv")));
  const RecordingFolder folder(path("r") + "/");
  ASSERT_EQ(folder.captures().size(), 6U);
  EXPECT_FALSE(folder.find("q", 1));
  EXPECT_FALSE(folder.find("p", 2));
  const auto found = folder.find(odd, ~std::uint64_t{0});
  ASSERT_TRUE(found);
  EXPECT_THAT(folder.captures()[*found].notes, ElementsAre("unplugged", "host 2 was lost"));
  KeptRecording kept;
  folder.play(*found, kept);
  EXPECT_EQ(event_as<SyncOutcome>(kept.events().at(0))->message, odd + "18446744073709551615");
}

TEST_F(RecordingFolderTest, TheRecordedSourcePlaysThem) {
  write_events(path("r"), {SyncOutcome{1, true, 2, ""}});
  const RecordingFolder folder(path("r"));
  const auto source = make_recorded_source(folder);
  KeptRecording kept;
  const RecordingCost cost = source->record({.seed = 1, .pipeline = "p"}, kept);
  EXPECT_EQ(cost.events, 5U);
  EXPECT_THAT(cost.notes, IsEmpty());
  EXPECT_EQ(kept.events().size(), 1U);
  EXPECT_THROW(source->record({.seed = 2, .pipeline = "p"}, kept), RecordingFailed);
  EXPECT_THROW(source->record({.seed = 1, .pipeline = "q"}, kept), RecordingFailed);
}

TEST_F(RecordingFolderTest, NothingIsWrittenWithoutAStart) {
  RecordingWriter writer(path("r"), description());
  writer.begin("p", 1).on_event(SyncOutcome{});
  writer.end({});
  writer.begin("q", 1).on_event(SyncOutcome{});
  writer.abandon();
  EXPECT_THAT(RecordingFolder(path("r")).captures(), IsEmpty());
  EXPECT_FALSE(fs::exists(path("r/p")));
}

TEST_F(RecordingFolderTest, AnAbandonedCaptureIsIncomplete) {
  RecordingWriter writer(path("r"), description());
  RecordingSink& sink = writer.begin("p", 1);
  sink.on_start(kLayout);
  sink.on_event(SyncOutcome{1, true, 0, "before"});
  writer.abandon({"host 2 was lost"});
  const RecordingFolder folder(path("r"));
  EXPECT_FALSE(folder.captures().at(0).complete);
  EXPECT_THAT(folder.captures()[0].notes, ElementsAre("host 2 was lost", HasSubstr("has no end")));
  KeptRecording kept;
  const RecordingCost cost =
      make_recorded_source(folder)->record({.seed = 1, .pipeline = "p"}, kept);
  EXPECT_EQ(kept.events().size(), 1U);
  EXPECT_EQ(cost.notes, folder.captures()[0].notes);
}

TEST_F(RecordingFolderTest, NeverOverwrites) {
  write_events(path("r"), {});
  const std::string before = content(path("r/manifest.json"));
  EXPECT_THAT(error_of([&] { RecordingWriter(path("r"), description()); }),
              HasSubstr("r: is not empty; a recording needs a new folder"));
  EXPECT_EQ(content(path("r/manifest.json")), before);
  fs::create_directory(path("empty"));
  write_events(path("empty"), {});
  put(path("file"), "");
  EXPECT_THAT(error_of([&] { RecordingWriter(path("file"), description()); }),
              HasSubstr("file: cannot be written: "));
  EXPECT_THAT(error_of([&] { RecordingWriter(path("no/r"), description()); }),
              HasSubstr("make it first"));
  RecordingWriter twice(path("twice"), description());
  twice.begin("p", 1).on_start(kLayout);
  twice.end({});
  EXPECT_THAT(error_of([&] { twice.begin("p", 1); }),
              HasSubstr("twice: pipeline p, seed 1 is recorded already"));
}

TEST_F(RecordingFolderTest, AFolderThatIsNoRecordingSaysSo) {
  EXPECT_THAT(error_of([&] { RecordingFolder(path("none")); }), HasSubstr("no such folder"));
  fs::create_directory(path("other"));
  EXPECT_THAT(error_of([&] { RecordingFolder(path("other")); }),
              HasSubstr("other: is no recording, it has no manifest.json"));
}

TEST_F(RecordingFolderTest, DamagedLinesAreNamed) {
  std::vector<KeptEvent> events;
  for (std::uint32_t i = 0; i < 10; ++i) events.emplace_back(SyncOutcome{1, true, i, ""});
  const auto error_with = [&](const std::string& from, const std::string& to) {
    fs::remove_all(path("r"));
    write_events(path("r"), events);
    std::string text = content(path("r/p/1/events.csv"));
    text.replace(text.find(from), from.size(), to);
    put(path("r/p/1/events.csv"), text);
    return play_error(path("r"));
  };
  EXPECT_THAT(error_with("3,outcome,1", "3,outcome,x"),
              HasSubstr("events.csv:4: column 3 (slave): found 'x', allowed: "));
  EXPECT_THAT(error_with("3,outcome,1", "3,outcome,3"),
              HasSubstr("events.csv:4: slave: found 3, allowed: 0 to 2"));
  EXPECT_THAT(error_with("3,outcome", "2,outcome"),
              HasSubstr("events.csv:4: order: found 2, allowed: above 2"));
  EXPECT_THAT(error_with("3,outcome,1,true,3,\n", ""),
              HasSubstr("events.csv:4: order: found 4, allowed: 3"));
  EXPECT_THAT(error_with("9,outcome,1,true,9,\n", ""), HasSubstr("ends after 9 of 10 lines"));
  EXPECT_THAT(error_with("9,outcome,1,true,9,\n", "9,outcome,1,true,9,"),
              HasSubstr("ends after 9 of 10 lines"));
  EXPECT_THAT(error_with("9,outcome,1,true,9,\n", "9,outcome,1,true,9,\n10,outcome,1,true,9,\n"),
              HasSubstr("events.csv:11: found another line, allowed: 10"));
  EXPECT_THAT(error_with("3,outcome,1,true,3,", "3,frame,0,depth,hardware_clock,1,1,1,1,1,1,1"),
              HasSubstr("events.csv:4: found a frame"));
  EXPECT_THAT(error_with("3,outcome,1,true,3,", "3,alignment,99,true,3,"),
              HasSubstr("events.csv:4: camera: found 99, allowed: 0 to "));
  EXPECT_THAT(error_with("3,outcome,1,true,3,", "3,pulse,1,1,0;0"),
              HasSubstr("events.csv:4: found 2 clock errors, allowed: one for each of 3 hosts"));
}

TEST_F(RecordingFolderTest, WhatComesBeforeTheDamageIsPlayed) {
  std::mt19937_64 random(3);
  std::vector<KeptEvent> events = some_events(random, 200);
  write_events(path("r"), events);
  std::string text = content(path("r/p/1/frames.csv"));
  const std::size_t line = text.find('\n', text.size() / 2) + 1;
  const std::size_t order = std::stoul(text.substr(line));
  text.insert(text.find(',', line), "x");
  put(path("r/p/1/frames.csv"), text);

  KeptRecording kept;
  const RecordingFolder folder(path("r"));
  const RecordingCost cost =
      make_recorded_source(folder)->record({.seed = 1, .pipeline = "p"}, kept);
  EXPECT_THAT(cost.notes, ElementsAre(HasSubstr("damaged, played up to there: ")));
  events.resize(order);
  expect_same(kept.events(), events);
}

TEST_F(RecordingFolderTest, AMissingFileIsDamage) {
  write_events(path("r"), {SyncOutcome{}});
  fs::remove(path("r/p/1/events.csv"));
  EXPECT_THAT(play_error(path("r")), HasSubstr("events.csv: cannot be read: No such file"));
}

TEST_F(RecordingFolderTest, AHeaderOfAnotherFormatIsNamed) {
  write_events(path("r"), {FrameEvent{}});
  put(path("r/p/1/frames.csv"), "camera,frame\n0,1\n");
  EXPECT_THAT(play_error(path("r")), HasSubstr("frames.csv:1: found 'camera,frame', allowed: "));
}

TEST_F(RecordingFolderTest, AnEndlessLineIsRefused) {
  write_events(path("r"), {SyncOutcome{}});
  put(path("r/p/1/events.csv"), std::string(40U << 20U, 'x'));
  EXPECT_THAT(play_error(path("r")), HasSubstr("events.csv:1: longer than "));
}

// What was played before the error is a beginning of the whole.
TEST_F(RecordingFolderTest, AReadErrorAtAnyByteIsAnError) {
  const std::string folder = path("r");
  std::mt19937_64 random(7);
  const std::vector<KeptEvent> events = some_events(random, 40);
  write_events(folder, events);
  std::size_t size = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) size += entry.file_size();
  }
  std::size_t played = 0;
  for (std::size_t byte = 0; byte < size; ++byte) {
    const ReadFault fault(byte);
    KeptRecording kept;
    EXPECT_THROW(RecordingFolder(folder).play(0, kept), RecordingFolderError) << byte;
    ASSERT_LE(kept.events().size(), events.size());
    for (std::size_t i = 0; i < kept.events().size(); ++i) {
      ASSERT_TRUE(same(kept.events()[i], events[i])) << byte;
    }
    played = std::max(played, kept.events().size());
  }
  EXPECT_GT(played, 0U);
}

}  // namespace
}  // namespace simbench
