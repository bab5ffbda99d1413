// What is left of a recording whose writer died, or ran into a full disk.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "recording/event.h"
#include "recording/recording_folder.h"
#include "tests/nonempty.h"
#include "tests/recording/random_events.h"
#include "tests/scratch_folder.h"

namespace simbench {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

RigLayout layout() {
  return {.hosts = 2, .cameras = {{0}, {1}}, .frame_rate_hz = 45, .first_pulse = 0, .pulses = 100};
}

std::size_t lines_in(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

std::vector<KeptEvent> numbered_events(int count) {
  std::vector<KeptEvent> events;
  for (int i = 0; i < count; ++i) {
    if (i % 3 == 0) {
      events.emplace_back(SyncOutcome{1, true, static_cast<std::uint32_t>(i), "a\\b,\n"});
    } else {
      FrameEvent frame;
      frame.record.counter = static_cast<std::uint32_t>(i);
      if (i % 2 == 0) frame.truth = FrameTruth{};
      events.emplace_back(frame);
    }
  }
  return events;
}

class RecordingDeathTest : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return scratch_ / name; }

  // As a writer that died leaves it.
  void write_without_end(const std::string& name, const std::vector<KeptEvent>& events) const {
    RecordingWriter writer(path(name), {.backend = "sim"});
    RecordingSink& sink = writer.begin("p", 1);
    sink.on_start(layout());
    for (const KeptEvent& event : events) notify(event, sink);
  }

  // All that was played is among what was recorded, in its order.
  static void expect_part_of(const std::vector<KeptEvent>& played,
                             const std::vector<KeptEvent>& recorded) {
    std::size_t at = 0;
    for (const KeptEvent& event : played) {
      while (at < recorded.size() && !same(recorded[at], event)) ++at;
      ASSERT_LT(at, recorded.size()) << "an event that was not recorded";
      ++at;
    }
  }

 private:
  ScratchFolder scratch_;
};

TEST_F(RecordingDeathTest, CutAtEveryByteTheWholeLinesBeforeAreThere) {
  const std::vector<KeptEvent> events = numbered_events(12);
  write_without_end("r", events);
  for (const std::string name : {"frames.csv", "events.csv"}) {
    const std::string file = path("r/p/1/" + name);
    const std::string whole = content(file);
    const std::size_t header = name == "frames.csv" ? 1 : 0;
    for (std::size_t size = 0; size <= whole.size(); ++size) {
      SCOPED_TRACE(testing::Message() << name << " cut at byte " << size);
      put(file, whole.substr(0, size));
      KeptRecording kept;
      const RecordingFolder folder(path("r"));
      folder.play(0, kept);
      const std::size_t lost = lines_in(whole) - std::max(lines_in(whole.substr(0, size)), header);
      ASSERT_EQ(kept.events().size(), events.size() - lost);
      expect_part_of(kept.events(), events);
    }
    put(file, whole);
  }
}

TEST_F(RecordingDeathTest, ACompleteCaptureCutAtAnyByteIsDamagedNotCrashed) {
  const std::vector<KeptEvent> events = numbered_events(12);
  {
    RecordingWriter writer(path("r"), {.backend = "sim"});
    RecordingSink& sink = writer.begin("p", 1);
    sink.on_start(layout());
    for (const KeptEvent& event : events) notify(event, sink);
    writer.end({});
  }
  for (const std::string name : {"frames.csv", "events.csv"}) {
    const std::string file = path("r/p/1/" + name);
    const std::string whole = content(file);
    for (std::size_t size = 0; size < whole.size(); ++size) {
      SCOPED_TRACE(testing::Message() << name << " cut at byte " << size);
      put(file, whole.substr(0, size));
      KeptRecording kept;
      const RecordingFolder folder(path("r"));
      const RecordingCost cost =
          make_recorded_source(folder)->record({.seed = 1, .pipeline = "p"}, kept);
      ASSERT_THAT(cost.notes, ElementsAre(HasSubstr("damaged")));
      expect_part_of(kept.events(), events);
    }
    put(file, whole);
  }
}

TEST_F(RecordingDeathTest, AManifestCutAtAnyByteIsNamed) {
  write_without_end("r", {});
  const std::string whole = content(path("r/manifest.json"));
  for (std::size_t size = 0; size + 2 < whole.size(); ++size) {
    put(path("r/manifest.json"), whole.substr(0, size));
    try {
      RecordingFolder folder(path("r"));
      FAIL() << "cut at byte " << size;
    } catch (const RecordingFolderError& error) {
      ASSERT_THAT(error.what(), HasSubstr("r/manifest.json: "));
    }
  }
}

TEST_F(RecordingDeathTest, AKilledWriterLosesAtMostItsLastThousand) {
  const std::vector<KeptEvent> events = numbered_events(3456);
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    RecordingWriter writer(path("r"), {.backend = "sim"});
    RecordingSink& sink = writer.begin("p", 1);
    sink.on_start(layout());
    for (const KeptEvent& event : events) notify(event, sink);
    raise(SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status));

  const RecordingFolder folder(path("r"));
  EXPECT_FALSE(folder.captures().at(0).complete);
  EXPECT_THAT(folder.captures()[0].notes, ElementsAre(HasSubstr("has no end")));
  KeptRecording kept;
  folder.play(0, kept);
  EXPECT_GE(kept.events().size(), 3000U);
  EXPECT_EQ(kept.layout().cameras.size(), 2U);
  for (std::size_t i = 0; i < kept.events().size(); ++i) {
    ASSERT_TRUE(same(kept.events()[i], events[i])) << "event " << i;
  }
}

TEST_F(RecordingDeathTest, WhatIsOlderThanTheIntervalIsInTheKernelWithTheNextEvent) {
  RecordingWriter writer(path("r"), {.backend = "sim"});
  RecordingSink& sink = writer.begin("p", 1);
  sink.on_start(layout());
  sink.on_event(SyncOutcome{1, true, 1, ""});
  usleep(110'000);
  sink.on_event(SyncOutcome{1, true, 2, ""});
  KeptRecording kept;
  RecordingFolder(path("r")).play(0, kept);
  EXPECT_EQ(kept.events().size(), 2U);
}

// Files cannot grow beyond a size while it lives, as on a full disk.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) : handler_(signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit = {bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FullDisk() {
    setrlimit(RLIMIT_FSIZE, &before_);
    signal(SIGXFSZ, handler_);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit before_ = {};
  void (*handler_)(int);
};

TEST_F(RecordingDeathTest, AFullDiskIsReportedAndTheRestIsReadable) {
  constexpr std::size_t kRoom = 50'000;
  const std::vector<KeptEvent> events = numbered_events(10'000);
  std::string error = "no error";
  std::string after = "no error";
  {
    const FullDisk full(kRoom);
    RecordingWriter writer(path("r"), {.backend = "sim"});
    RecordingSink& sink = writer.begin("p", 1);
    sink.on_start(layout());
    try {
      for (const KeptEvent& event : events) notify(event, sink);
    } catch (const RecordingFolderError& thrown) {
      error = thrown.what();
    }
    try {
      writer.end({});
    } catch (const RecordingFolderError& thrown) {
      after = thrown.what();
    }
  }
  EXPECT_THAT(error, HasSubstr("r/p/1/frames.csv: cannot be written: File too large"));
  EXPECT_THAT(after, HasSubstr("r/p/1/frames.csv: cannot be written: "));
  const RecordingFolder folder(path("r"));
  EXPECT_FALSE(folder.captures().at(0).complete);
  KeptRecording kept;
  folder.play(0, kept);
  expect_part_of(kept.events(), events);
  const std::string frames = content(path("r/p/1/frames.csv"));
  EXPECT_EQ(frames.size(), kRoom);
  EXPECT_GE(kept.events().size(), lines_in(frames) - 1);
}

TEST_F(RecordingDeathTest, AManifestThatDoesNotFitLeavesTheOneBefore) {
  RecordingWriter writer(path("r"), {.backend = "sim"});
  writer.begin("p", 1).on_start(layout());
  const std::string before = content(path("r/manifest.json"));
  {
    const FullDisk full(before.size() / 2);
    EXPECT_THROW(writer.end({}), RecordingFolderError);
  }
  EXPECT_EQ(content(path("r/manifest.json")), before);
  writer.begin("p", 2).on_start(layout());
  writer.end({});
  EXPECT_EQ(RecordingFolder(path("r")).captures().size(), 2U);
}

}  // namespace
}  // namespace simbench
