#include "bags/bag_scan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "bags/camera_topics.h"
#include "bags/frame_track.h"
#include "bags/recorded_files.h"
#include "recording/temporary_folder.h"
#include "tests/bags/bag_writers.h"
#include "tests/bags/memory_file.h"
#include "tests/bags/rosbag_writer.h"

namespace simbench::bags {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using Chunks = RosbagWriter::Chunks;

constexpr Nanoseconds kEpoch = seconds(1'790'000'000);

Nanoseconds stamp_of(int i) { return kEpoch + milliseconds(33) * i; }

BagScan scanned(RosbagWriter& writer, const ScanOptions& options = {}) {
  return scan_bag(MemoryFile(writer.bag()).path(), "rig", options);
}

std::string image(int i, const std::string& frame, std::uint32_t sequence) {
  return ros1_header(sequence, stamp_of(i), frame) + std::string(64, 'x');
}

std::vector<std::string> names(const BagScan& scan) {
  std::vector<std::string> all;
  for (const RecordedStream& stream : scan.streams) {
    all.push_back(stream.camera + ":" + stream.stream);
  }
  return all;
}

TEST(CameraTopicsTest, CamerasAndStreamsComeFromTheNames) {
  const auto named = [](const char* topic, const char* type) {
    const NamedStream found = camera_of(camera_topic({.name = topic, .type = type}));
    return found.camera + ":" + found.stream;
  };
  EXPECT_EQ(named("/camera/color/image_raw", "sensor_msgs/Image"), "camera:color");
  EXPECT_EQ(named("/camera/camera/depth/metadata", "realsense2_camera_msgs/Metadata"),
            "camera:depth");
  EXPECT_EQ(named("/left/image_raw/compressed", "sensor_msgs/CompressedImage"), "left:image");
  EXPECT_EQ(named("/robot/front/infra1/image_rect_raw", "sensor_msgs/Image"), "robot/front:infra1");
  EXPECT_EQ(named("/image_raw", "sensor_msgs/Image"), ":image");
  EXPECT_EQ(named("/lidar/points", "sensor_msgs/PointCloud2"), "lidar:points");
  EXPECT_EQ(camera_topic({.name = "/imu", .type = "sensor_msgs/Imu"}).kind, TopicKind::kOther);
  EXPECT_EQ(camera_topic({.name = "/device_0/sensor_0/Depth_0/info/camera_info",
                          .type = "sensor_msgs/CameraInfo"})
                .kind,
            TopicKind::kOther);
}

TEST(BagScanTest, HeaderStampsAreAComputersAndTheRawImageSpeaks) {
  RosbagWriter writer(Chunks::kLz4);
  const auto info = writer.add_topic("/left/camera_info", "sensor_msgs/CameraInfo");
  const auto raw = writer.add_topic("/left/image_raw", "sensor_msgs/Image");
  const auto packed = writer.add_topic("/left/image_raw/compressed", "sensor_msgs/CompressedImage");
  const auto right = writer.add_topic("/right/image_raw", "sensor_msgs/Image");
  writer.add_topic("/imu", "sensor_msgs/Imu");
  for (int i = 0; i < 10; ++i) {
    const auto sequence = static_cast<std::uint32_t>(100 + i);
    for (const auto topic : {info, raw, packed, right}) {
      writer.add_message(topic, stamp_of(i) + milliseconds(5), image(i, "cam", sequence));
    }
  }
  const BagScan scan = scanned(writer);
  EXPECT_THAT(names(scan), testing::ElementsAre("left:image", "right:image"));
  const RecordedStream& left = scan.streams[0];
  EXPECT_TRUE(left.stamped_by_host);
  EXPECT_TRUE(left.counted);
  EXPECT_EQ(left.origin.topic, "/left/image_raw");
  EXPECT_EQ(left.host, "rig");
  ASSERT_EQ(left.frames.size(), 10U);
  EXPECT_EQ(left.frames[3].counter, 103U);
  EXPECT_EQ(left.frames[3].sensor, stamp_of(3));
  EXPECT_EQ(left.frames[3].arrival, stamp_of(3) + milliseconds(5));
  EXPECT_THAT(scan.notes, Contains(HasSubstr("/left/image_raw/compressed")));
  EXPECT_EQ(scan.topics.size(), 5U);
}

TEST(BagScanTest, MetadataHasTheCamerasStampsAndNamesTheImages) {
  RosbagWriter writer(Chunks::kNone);
  const auto images = writer.add_topic("/camera/depth/image_rect_raw", "sensor_msgs/Image");
  const auto metadata = writer.add_topic("/camera/depth/metadata", "realsense2_camera/Metadata");
  for (int i = 0; i < 10; ++i) {
    const auto number = static_cast<std::uint32_t>(i);
    // The third image was lost; its metadata was not.
    if (i != 2) writer.add_message(images, stamp_of(i), image(i, "cam", number));
    const std::string json = R"({"frame_number":)" + std::to_string(50 + i) +
                             R"(,"clock_domain":"global_time","frame_timestamp":1.5,)" +
                             R"("sensor_timestamp":)" + std::to_string(1'000'000 + 33'000 * i) +
                             "}";
    writer.add_message(metadata, stamp_of(i) + milliseconds(1),
                       ros1_header(number, stamp_of(i), "cam") + ros1_text(json));
  }
  const BagScan scan = scanned(writer);
  ASSERT_THAT(names(scan), testing::ElementsAre("rig:depth"));
  const RecordedStream& depth = scan.streams[0];
  EXPECT_FALSE(depth.stamped_by_host);
  EXPECT_EQ(depth.origin.topic, "/camera/depth/image_rect_raw");
  ASSERT_EQ(depth.frames.size(), 10U);
  EXPECT_EQ(depth.frames[4].counter, 54U);
  EXPECT_EQ(depth.frames[4].sensor, milliseconds(1132));
  EXPECT_EQ(depth.frames[4].arrival, stamp_of(4) + milliseconds(1));
  EXPECT_EQ(depth.origin.messages[1], 1U);
  EXPECT_EQ(depth.origin.messages[2], kNoMessage);
  EXPECT_EQ(depth.origin.messages[4], 3U);
}

TEST(BagScanTest, TwoCamerasOnATopicAreTwo) {
  RosbagWriter writer(Chunks::kNone);
  const auto topic = writer.add_topic("/image_raw", "sensor_msgs/Image");
  for (int i = 0; i < 20; ++i) {
    writer.add_message(topic, stamp_of(i), image(i, i % 2 == 0 ? "left" : "right", 0));
  }
  const BagScan scan = scanned(writer);
  EXPECT_THAT(names(scan), testing::ElementsAre("left:image", "right:image"));
  EXPECT_EQ(scan.streams[0].frames.size(), 10U);
  EXPECT_FALSE(scan.streams[0].counted);
  EXPECT_THAT(scan.notes, Contains(HasSubstr("several cameras write this topic")));
}

TEST(BagScanTest, APublisherThatWasRestartedIsOne) {
  RosbagWriter writer(Chunks::kNone);
  const auto first = writer.add_topic("/cam/image_raw", "sensor_msgs/Image", "/a");
  const auto second = writer.add_topic("/cam/image_raw", "sensor_msgs/Image", "/b");
  for (int i = 0; i < 20; ++i) {
    writer.add_message(i < 10 ? first : second, stamp_of(i), image(i, "cam", 0));
  }
  const BagScan scan = scanned(writer);
  ASSERT_EQ(scan.streams.size(), 1U);
  EXPECT_EQ(scan.streams[0].frames.size(), 20U);
}

// The same frames in both formats of ROS 2.
TEST(BagScanTest, RosTwoHasNoCounterAndTheSameStamps) {
  TemporaryFolder folder;
  McapWriter mcap({.compression = "zstd", .chunk_bytes = 500});
  const std::uint16_t channel = mcap.channel("/left/image_raw", "sensor_msgs/msg/Image", "cdr");
  SqliteBagWriter sqlite(folder.file("rig_0.db3"));
  const std::int64_t topic = sqlite.topic("/left/image_raw", "sensor_msgs/msg/Image", "cdr");
  for (int i = 0; i < 10; ++i) {
    const auto stamp_ns = static_cast<std::uint64_t>(stamp_of(i).count());
    const std::string bytes =
        cdr_header(static_cast<std::uint32_t>(stamp_ns / 1'000'000'000),
                   static_cast<std::uint32_t>(stamp_ns % 1'000'000'000), "cam") +
        std::string(64, 'x');
    mcap.message(channel, stamp_ns + 5'000'000, bytes);
    sqlite.message(topic, static_cast<std::int64_t>(stamp_ns + 5'000'000), bytes);
  }
  sqlite.close();
  write_bytes(folder.file("rig.mcap"), mcap.close());
  for (const std::string name : {"rig.mcap", "rig_0.db3"}) {
    const BagScan scan = scan_bag(folder.file(name), "rig", {});
    ASSERT_EQ(scan.streams.size(), 1U) << name;
    const RecordedStream& left = scan.streams[0];
    EXPECT_FALSE(left.counted);
    EXPECT_TRUE(left.stamped_by_host);
    ASSERT_EQ(left.frames.size(), 10U);
    EXPECT_EQ(left.frames[7].counter, 7U);
    EXPECT_EQ(left.frames[7].sensor, stamp_of(7));
    EXPECT_EQ(left.frames[7].arrival, stamp_of(7) + milliseconds(5));
  }
}

TEST(BagScanTest, StampsThatAreAllZeroAreNone) {
  RosbagWriter writer(Chunks::kNone);
  const auto topic = writer.add_topic("/cam/image_raw", "sensor_msgs/Image");
  for (int i = 0; i < 5; ++i) writer.add_message(topic, stamp_of(i), ros1_header(0, {}, "cam"));
  const BagScan scan = scanned(writer);
  EXPECT_THAT(scan.streams, IsEmpty());
  EXPECT_THAT(scan.notes, Contains(HasSubstr("have no stamps, or all the same")));
}

TEST(BagScanTest, ATopicOfAnyTypeIsReadIfItIsNamed) {
  RosbagWriter writer(Chunks::kNone);
  const auto topic = writer.add_topic("/my/events", "my_msgs/Events");
  for (int i = 0; i < 5; ++i) writer.add_message(topic, stamp_of(i), image(i, "cam", 7));
  EXPECT_THAT(scanned(writer).streams, IsEmpty());
  const BagScan scan = scanned(writer, {.topics = {"/my/events"}});
  ASSERT_EQ(scan.streams.size(), 1U);
  EXPECT_EQ(scan.streams[0].frames[2].sensor, stamp_of(2));
  EXPECT_THROW(scanned(writer, {.topics = {"/none"}}), BagError);
}

TEST(RecordedFilesTest, FilesOfOneNameAreToldApartAndBagsAndCsvMix) {
  TemporaryFolder folder;
  std::vector<std::string> files;
  for (const std::string name : {"a", "b"}) {
    RosbagWriter writer(Chunks::kNone);
    for (const std::string camera : {"left", "right"}) {
      const auto topic = writer.add_topic("/" + camera + "/image_raw", "sensor_msgs/Image");
      for (int i = 0; i < 3; ++i) writer.add_message(topic, stamp_of(i), image(i, "cam", 0));
    }
    files.push_back(folder.file(name + ".dat"));
    write_bytes(files.back(), writer.bag());
  }
  files.push_back(folder.file("c.csv"));
  write_bytes(files.back(),
              "Stream Type,Index,F#,HW Timestamp (ms),Host Timestamp(ms)\nDepth,0,1,10,11\n");
  const RecordedStreams read = read_recorded_files(files, {});
  std::vector<std::string> cameras;
  for (const RecordedStream& stream : read.streams) cameras.push_back(stream.camera);
  EXPECT_THAT(cameras,
              testing::UnorderedElementsAre("a/left", "a/right", "b/left", "b/right", "c"));
}

TEST(RecordedFilesTest, ABagWithoutCamerasListsItsTopics) {
  TemporaryFolder folder;
  RosbagWriter writer(Chunks::kNone);
  const auto topic = writer.add_topic("/odom", "nav_msgs/Odometry");
  writer.add_message(topic, stamp_of(0), image(0, "odom", 0));
  write_bytes(folder.file("x.bag"), writer.bag());
  try {
    read_recorded_files({folder.file("x.bag")}, {});
    FAIL();
  } catch (const BagError& error) {
    EXPECT_THAT(error.what(), HasSubstr("/odom (nav_msgs/Odometry)"));
    EXPECT_THAT(error.what(), HasSubstr("--topics"));
  }
}

}  // namespace
}  // namespace simbench::bags
