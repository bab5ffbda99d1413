#include "bags/video_times.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>

#include "bags/bag.h"
#include "bags/recorded_files.h"
#include "tests/scratch_folder.h"

namespace simbench::bags {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

const std::string kMatroska("\x1a\x45\xdf\xa3 rest");

// A program of a test's own in the place of ffprobe.
class VideoTimesTest : public testing::Test {
 protected:
  VideoTimesTest() : path_(std::getenv("PATH")) {}
  ~VideoTimesTest() override { setenv("PATH", path_.c_str(), 1); }

  void ffprobe(const std::string& script) {
    const std::string file = folder_.write("bin/ffprobe", "#!/bin/sh\n" + script);
    std::filesystem::permissions(file, std::filesystem::perms::owner_all);
    setenv("PATH", fmt::format("{}:{}", folder_ / "bin", path_).c_str(), 1);
  }
  std::string refusal() {
    try {
      read_recorded_files({video_}, {});
    } catch (const BagError& error) {
      return error.what();
    }
    return "accepted";
  }

  const ScratchFolder folder_;
  const std::string path_;
  const std::string video_ = folder_.write("it's a rig.mkv", kMatroska);
};

// A codec stores frames in another order than they are shown in; what has no stamp is counted.
TEST_F(VideoTimesTest, FramesAreInOrderOfTheirStampsAndExactToTheNanosecond) {
  ffprobe(
      "echo packet,0,0,48; echo packet,0,1024,100; echo packet,0,512,200\n"
      "echo packet,1,0,300; echo packet,1,N/A,350; echo packet,1,66,400\n"
      "echo stream,0,1/15360,COLOR; echo stream,1,1/1000\n");
  const RecordedStreams read = read_recorded_files({video_}, {});
  ASSERT_EQ(read.streams.size(), 2U);
  const RecordedStream& colour = read.streams[0];
  EXPECT_EQ(colour.camera, "it's a rig");
  EXPECT_EQ(colour.stream, "COLOR");
  EXPECT_FALSE(colour.counted);
  ASSERT_EQ(colour.frames.size(), 3U);
  EXPECT_EQ(colour.frames[1].sensor.count(), 33'333'333);
  EXPECT_EQ(colour.frames[2].sensor.count(), 66'666'667);
  EXPECT_EQ(colour.frames[2].arrival, colour.frames[2].sensor);
  EXPECT_THAT(colour.origin.stamps, HasSubstr("in steps of 1/15360 s"));
  EXPECT_EQ(read.streams[1].stream, "video 1");
  EXPECT_THAT(read.streams[1].origin.stamps, HasSubstr("in steps of 1 ms"));
  EXPECT_THAT(read.notes, ElementsAre(HasSubstr("video 1: 1 frame without a time stamp left out")));
}

TEST_F(VideoTimesTest, TracksOfOneTitleAreToldApart) {
  ffprobe(
      "echo packet,0,0,1; echo packet,1,0,2; echo packet,3,0,3\n"
      "echo stream,0,1/30,Main; echo stream,1,1/30,Main; echo stream,3,1/30,IR\n");
  std::vector<std::string> names;
  for (const RecordedStream& stream : read_video(video_, "rig").streams) {
    names.push_back(stream.stream);
  }
  EXPECT_THAT(names, ElementsAre("Main 0", "Main 1", "IR"));
}

TEST_F(VideoTimesTest, TheFileIsOneWordWhateverItsName) {
  ffprobe("for word; do :; done; test \"$word\" = \"file:" + video_ +
          "\" && echo packet,0,1,2; echo stream,0,1/30\n");
  EXPECT_EQ(read_video(video_, "rig").streams[0].frames.size(), 1U);
}

TEST_F(VideoTimesTest, WhatFfprobeSaysIsPassedOn) {
  ffprobe("echo 'moov atom not found' >&2; exit 1\n");
  EXPECT_EQ(refusal(), video_ + ": ffprobe: moov atom not found");
  ffprobe("echo stream,0,1/1000\n");
  EXPECT_THAT(refusal(), HasSubstr("found no video track with time stamps"));
  ffprobe("echo packet,0,1,2; echo stream,0,0/0\n");
  EXPECT_THAT(refusal(), HasSubstr("found no video track with time stamps"));
}

TEST_F(VideoTimesTest, WithoutFfprobeItSaysWhatWouldReadIt) {
  setenv("PATH", (folder_ / "nothing").c_str(), 1);
  EXPECT_THAT(refusal(), StartsWith(video_ + ": it is a video, whose frame times ffprobe reads"));
}

TEST_F(VideoTimesTest, ProgressMayEndTheReading) {
  ffprobe("while :; do echo packet,0,1,2; done\n");
  struct Enough {};
  EXPECT_THROW(read_video(video_, "rig", [](std::uint64_t, std::uint64_t) { throw Enough(); }),
               Enough);
}

TEST_F(VideoTimesTest, ItsFirstBytesTell) {
  EXPECT_TRUE(is_video(video_));
  EXPECT_TRUE(is_video(folder_.write("a.mp4", std::string("\0\0\0 ftypisom", 12))));
  EXPECT_TRUE(is_video(folder_.write("a.mov", std::string("\0\0\0\x08wide\0\0", 10))));
  EXPECT_FALSE(is_video(folder_.write("a.csv", "time,offset\n")));
  EXPECT_FALSE(is_video(folder_.write("cameras.csv", "cam_wide,cam_tele\n1,2\n")));
  EXPECT_FALSE(is_video(folder_.write("empty.mkv", "")));
}

}  // namespace
}  // namespace simbench::bags
