#include "watch/tail.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <string>

#include "tests/scratch_folder.h"
#include "watch/folder_text.h"
#include "watch/grown_stamps.h"

namespace simbench::watch {
namespace {

namespace fs = std::filesystem;

class TailTest : public testing::Test {
 protected:
  void append(const std::string& text) { std::ofstream(path_, std::ios::app) << text; }
  void replace(const std::string& text) { std::ofstream(path_, std::ios::trunc) << text; }

  ScratchFolder folder_;
  std::string path_ = folder_ / "log";
};

TEST_F(TailTest, WholeLinesAreHandedOutOnce) {
  append("one\ntw");
  Tail tail(path_);
  EXPECT_EQ(tail.poll().text, "one\n");
  EXPECT_EQ(tail.poll().text, "");
  append("o\nthree\n");
  EXPECT_EQ(tail.poll().text, "two\nthree\n");
  EXPECT_EQ(tail.head(4), "one\n");
}

TEST_F(TailTest, ATruncatedFileIsReadFromItsBeginning) {
  append("one\ntwo\nthr");
  Tail tail(path_);
  tail.poll();
  replace("new\n");
  const GrownText grown = tail.poll();
  EXPECT_TRUE(grown.begins_anew);
  EXPECT_EQ(grown.text, "new\n");
}

TEST_F(TailTest, ARotatedFileIsReadToItsEndThenTheNewOne) {
  append("one\n");
  Tail tail(path_);
  tail.poll();
  append("last\n");
  fs::rename(path_, path_ + ".1");
  append("new\n");
  std::string text;
  bool anew = false;
  for (int i = 0; i < 4; ++i) {
    const GrownText grown = tail.poll();
    anew = anew || grown.begins_anew;
    text += grown.text;
    EXPECT_TRUE(grown.is_there);
  }
  EXPECT_EQ(text, "last\nnew\n");
  EXPECT_TRUE(anew);
}

TEST_F(TailTest, AFileThatVanishesComesBack) {
  Tail tail(path_);
  EXPECT_FALSE(tail.poll().is_there);
  append("one\n");
  EXPECT_EQ(tail.poll().text, "one\n");
  fs::remove(path_);
  EXPECT_FALSE(tail.poll().is_there);
  EXPECT_FALSE(tail.poll().is_there);
  append("again\n");
  const GrownText grown = tail.poll();
  EXPECT_TRUE(grown.is_there);
  EXPECT_EQ(grown.text, "again\n");
}

TEST_F(TailTest, ALongFileIsReadFromNearItsEnd) {
  for (int i = 0; i < 1000; ++i) append("line " + std::to_string(i) + "\n");
  Tail tail(path_, 100);
  const GrownText grown = tail.poll();
  EXPECT_TRUE(grown.is_cut);
  EXPECT_LE(grown.text.size(), 100u);
  EXPECT_TRUE(grown.text.starts_with("line 9")) << grown.text;
  EXPECT_TRUE(grown.text.ends_with("line 999\n"));
}

TEST_F(TailTest, AFolderIsNoFile) {
  fs::create_directory(path_);
  Tail tail(path_);
  EXPECT_FALSE(tail.poll().is_there);
}

// Whatever a writer does, no line is handed out twice, and none that stays is lost.
TEST_F(TailTest, LinesSurviveAnyOrderOfWritingAndRotating) {
  std::minstd_rand chance(11);
  Tail tail(path_);
  std::string written;
  std::string read;
  for (int i = 0; i < 2000; ++i) {
    const std::string line = std::to_string(i) + "\n";
    const std::size_t cut = chance() % (line.size() + 1);
    append(line.substr(0, cut));
    if (chance() % 3 == 0) read += tail.poll().text;
    append(line.substr(cut));
    written += line;
    if (chance() % 50 == 0) {
      read += tail.poll().text;  // a file that comes and goes between two polls is never seen
      fs::rename(path_, path_ + "." + std::to_string(i));
      for (int k = 0; k < 3; ++k) read += tail.poll().text;
    }
  }
  for (int k = 0; k < 3; ++k) read += tail.poll().text;
  EXPECT_TRUE(read == written) << read.size() << " bytes of " << written.size();
}

std::string csv_row(int pulse) {
  const double ms = 1000 + pulse * 1000 / 30.0;
  return "Depth,0," + std::to_string(pulse) + "," + std::to_string(ms) + "," +
         std::to_string(ms + 5) + "\n";
}

TEST_F(TailTest, FramesOfACsvAreReadOnceInWhateverPieces) {
  std::minstd_rand chance(3);
  GrownFrames frames(std::make_unique<Tail>(path_), {});
  std::vector<std::uint64_t> counters;
  const auto poll = [&] {
    for (const RecordedStream& stream : frames.poll().streams) {
      for (const StampedFrame& frame : stream.frames) counters.push_back(frame.counter);
    }
  };
  poll();
  append("Stream Type,Index,F#,HW Timestamp (ms),Host Timestamp(ms)\n");
  poll();
  for (int pulse = 0; pulse < 500; ++pulse) {
    append(csv_row(pulse));
    if (chance() % 7 == 0) poll();
  }
  poll();
  ASSERT_EQ(counters.size(), 500u);
  for (std::size_t i = 0; i < counters.size(); ++i) EXPECT_EQ(counters[i], i);
}

TEST_F(TailTest, ALogOfChronyIsReadOnce) {
  GrownClock clock(std::make_unique<Tail>(path_), {});
  std::size_t points = 0;
  for (int i = 0; i < 40; ++i) {
    char line[200];
    std::snprintf(line, sizeof line,
                  "2024-03-05 12:%02d:%02d 10.0.0.1        2      1.000      0.100  %.3e N  1 "
                  "1.000e-05 0.000e+00 1.0e-05 1.0e-03 2.0e-03\n",
                  i / 4, (i % 4) * 15, (i % 2 ? 1 : -1) * 1e-6 * i);
    append(line);
    const GrownClock::Found found = clock.poll();
    points += found.points.size();
    EXPECT_EQ(found.problem, "");
  }
  EXPECT_EQ(points, 40u);
}

// Captures of a recording folder follow one another, each with its heading.
TEST_F(TailTest, ARecordingFolderIsReadCaptureByCapture) {
  const std::string heading =
      "order,camera,stream,domain,counter,exposure_us,sensor_us,frame_us,backend_ns,arrival_ns,"
      "arrival_steady_ns\n";
  GrownFrames frames(std::make_unique<FolderText>(folder_.path().string()), FolderText::columns());
  EXPECT_TRUE(frames.poll().streams.empty());
  for (const char* const seed : {"1", "2"}) {
    const fs::path capture = folder_.path() / "pipeline" / seed;
    fs::create_directories(capture);
    std::ofstream file(capture / "frames.csv");
    file << heading;
    std::size_t read = 0;
    for (int pulse = 0; pulse < 200; ++pulse) {
      for (int camera = 0; camera < 2; ++camera) {
        file << 2 * pulse + camera << "," << camera << ",depth,hardware_clock," << pulse << ",8000,"
             << 1000 + pulse * 33333 << "," << 1010 + pulse * 33333 << ",,"
             << 1'000'000'000LL + pulse * 33'333'333LL << ",5\n";
      }
      file.flush();
      if (pulse % 10 != 9) continue;
      for (const RecordedStream& stream : frames.poll().streams) read += stream.frames.size();
    }
    for (const RecordedStream& stream : frames.poll().streams) read += stream.frames.size();
    EXPECT_EQ(read, 400u) << seed;
  }
}

TEST_F(TailTest, RowsThatCannotBeReadAreAProblemAndNoEnd) {
  GrownFrames frames(std::make_unique<Tail>(path_), {});
  append("Stream Type,Index,F#,HW Timestamp (ms),Host Timestamp(ms)\n");
  for (int pulse = 0; pulse < 100; ++pulse) append(csv_row(pulse));
  EXPECT_EQ(frames.poll().problem, "");
  append("Depth,0,nonsense,x,y\n");
  EXPECT_NE(frames.poll().problem, "");
  append(csv_row(101));
  const GrownFrames::Found found = frames.poll();
  EXPECT_EQ(found.problem, "");
  ASSERT_EQ(found.streams.size(), 1u);
  EXPECT_EQ(found.streams[0].frames.size(), 1u);
}

}  // namespace
}  // namespace simbench::watch
