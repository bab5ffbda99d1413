#include "bags/bag_scan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
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
  EXPECT_FALSE(left.counted);
  EXPECT_EQ(left.origin.topic, "/left/image_raw");
  EXPECT_EQ(left.host, "rig");
  ASSERT_EQ(left.frames.size(), 10U);
  EXPECT_EQ(left.frames[3].counter, 3U);
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

TEST(BagScanTest, FrameIdsThatCountAreNoCameras) {
  RosbagWriter writer(Chunks::kLz4);
  const auto topic = writer.add_topic("/cam/image_raw", "sensor_msgs/Image");
  for (int i = 0; i < 300; ++i) {
    writer.add_message(topic, stamp_of(i), image(i, "frame" + std::to_string(i), 0));
  }
  const BagScan scan = scanned(writer);
  ASSERT_EQ(scan.streams.size(), 1U);
  ASSERT_EQ(scan.streams[0].frames.size(), 300U);
  for (std::size_t i = 0; i < 300; ++i) EXPECT_EQ(scan.streams[0].origin.messages[i], i);
  ASSERT_EQ(scan.notes.size(), 1U);
  EXPECT_THAT(scan.notes[0], HasSubstr("/cam/image_raw: found more than 64 frame ids"));
}

TEST(BagScanTest, TopicsOfCamerasHaveALimit) {
  McapWriter mcap({});
  for (int i = 0; i < 5000; ++i) {
    const std::string name = "/cam" + std::to_string(i) + "/image_raw";
    const std::uint16_t id = mcap.channel(name, "sensor_msgs/msg/Image", "cdr");
    mcap.message(id, static_cast<std::uint64_t>(i), cdr_header(1, 2, "cam"));
  }
  const BagScan scan = scan_bag(MemoryFile(mcap.close()).path(), "rig", {});
  EXPECT_EQ(scan.streams.size(), kMostTracks);
  EXPECT_THAT(scan.notes,
              Contains(HasSubstr("904 messages left out: found more than 4096 topics")));
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

TEST(BagScanTest, MessagesOfTwoPublishersAreNumberedAsTheTopics) {
  RosbagWriter writer(Chunks::kNone);
  const auto first = writer.add_topic("/cam/image_raw", "sensor_msgs/Image", "/a");
  const auto second = writer.add_topic("/cam/image_raw", "sensor_msgs/Image", "/b");
  for (int i = 0; i < 12; ++i) {
    writer.add_message(i < 4 || i % 2 == 0 ? first : second, stamp_of(i),
                       image(i, i < 4 || i % 2 == 0 ? "left" : "right", 0));
  }
  const BagScan scan = scanned(writer);
  ASSERT_EQ(scan.streams.size(), 2U);
  EXPECT_THAT(scan.streams[0].origin.messages, testing::ElementsAre(0, 1, 2, 3, 4, 6, 8, 10));
  EXPECT_THAT(scan.streams[1].origin.messages, testing::ElementsAre(5, 7, 9, 11));
}

// Chunks in the order 2, 0, 1: a file's order is not the order of arrival.
TEST(BagScanTest, SwappedChunksAreReadByTimeOfArrival) {
  for (const Chunks chunks : {Chunks::kNone, Chunks::kLz4, Chunks::kBzip2}) {
    RosbagWriter writer(chunks, 2000);
    const auto left = writer.add_topic("/left/image_raw", "sensor_msgs/Image");
    const auto imu = writer.add_topic("/imu", "sensor_msgs/Imu");
    for (const int begin : {60, 0, 30}) {
      for (int i = begin; i < begin + 30; ++i) {
        writer.add_message(left, stamp_of(i) + milliseconds(5), image(i, "cam", 7));
        writer.add_message(imu, stamp_of(i) + milliseconds(6), "imu" + std::to_string(i));
      }
    }
    const BagScan scan = scanned(writer, {.all_topics = true});
    ASSERT_EQ(scan.streams.size(), 1U);
    const RecordedStream& stream = scan.streams[0];
    ASSERT_EQ(stream.frames.size(), 90U);
    for (std::size_t i = 0; i < 90; ++i) {
      EXPECT_EQ(stream.frames[i].counter, i);
      EXPECT_EQ(stream.frames[i].sensor, stamp_of(static_cast<int>(i)));
      EXPECT_EQ(stream.frames[i].arrival, stamp_of(static_cast<int>(i)) + milliseconds(5));
      EXPECT_EQ(stream.origin.messages[i], (i + 30) % 90);
    }
    ASSERT_EQ(scan.topics.size(), 2U);
    for (const TopicScan& topic : scan.topics) {
      EXPECT_EQ(topic.out_of_order, 60U) << topic.topic.name;
      EXPECT_EQ(topic.longest_gap, milliseconds(33)) << topic.topic.name;
      EXPECT_EQ(topic.last - topic.first, milliseconds(33) * 89) << topic.topic.name;
      EXPECT_NEAR(topic.rate_hz(), 1 / 0.033, 1e-9) << topic.topic.name;
    }
    EXPECT_THAT(scan.notes, Contains(HasSubstr("120 messages stand out of order of their log "
                                               "times; they were sorted")));
  }
}

// An image, and metadata of the SDK that was written before it, away from it, or twice.
TEST(BagScanTest, MetadataOfTheSdkFindsItsImageWhereverItStands) {
  RosbagWriter writer(Chunks::kNone);
  const std::string base = "/device_0/sensor_0/Depth_0/image/";
  const auto data = writer.add_topic(base + "data", "sensor_msgs/Image");
  const auto metadata = writer.add_topic(base + "metadata", "diagnostic_msgs/KeyValue");
  const auto tell = [&](int i) {
    writer.add_message(metadata, stamp_of(i),
                       ros1_key_value("Sensor Timestamp", std::to_string(5'000 + 33'000 * i)));
    writer.add_message(metadata, stamp_of(i),
                       ros1_key_value("Frame Counter", std::to_string(70 + 2 * i)));
  };
  for (int i = 10; i < 20; ++i) writer.add_message(data, stamp_of(i), image(i, "1", 0));
  for (int i = 0; i < 10; ++i) {
    tell(i);
    writer.add_message(data, stamp_of(i), image(i, "1", 0));
  }
  for (int i = 10; i < 20; ++i) tell(i);
  for (int i = 3; i < 8; ++i) tell(i);
  const BagScan scan = scanned(writer);
  ASSERT_EQ(scan.streams.size(), 1U);
  EXPECT_TRUE(scan.streams[0].counted);
  ASSERT_EQ(scan.streams[0].frames.size(), 20U);
  for (int i = 0; i < 20; ++i) {
    const auto at = static_cast<std::size_t>(i);
    EXPECT_EQ(scan.streams[0].frames[at].sensor, Microseconds(5'000 + 33'000 * i));
    EXPECT_EQ(scan.streams[0].frames[at].counter, 70U + 2 * at);
    EXPECT_EQ(scan.streams[0].origin.messages[at], (at + 10) % 20);
  }
}

TEST(BagScanTest, AMessageThatStandsTwiceCountsOnce) {
  RosbagWriter writer(Chunks::kLz4, 1000);
  const auto left = writer.add_topic("/left/image_raw", "sensor_msgs/Image");
  for (const int begin : {0, 5, 5}) {
    for (int i = begin; i < begin + 5; ++i) {
      writer.add_message(left, stamp_of(i), image(i, "cam", static_cast<std::uint32_t>(i)));
    }
  }
  // Messages of one time that are no copies: another number, another size, another content.
  writer.add_message(left, stamp_of(9), image(9, "cam", 10));
  writer.add_message(left, stamp_of(9), image(9, "cam", 10) + "x");
  writer.add_message(left, stamp_of(9),
                     ros1_header(10, stamp_of(10), "cam") + std::string(64, 'x'));
  const BagScan scan = scanned(writer);
  ASSERT_EQ(scan.streams.size(), 1U);
  EXPECT_EQ(scan.streams[0].frames.size(), 13U);
  EXPECT_EQ(scan.topics[0].messages, 13U);
  EXPECT_EQ(scan.topics[0].copies, 5U);
  EXPECT_EQ(scan.facts.messages, 13U);
  EXPECT_EQ(scan.streams[0].origin.messages[9], 9U);
  EXPECT_EQ(scan.streams[0].origin.messages[10], 15U);
  EXPECT_THAT(scan.notes, Contains(HasSubstr("5 messages stand twice")));
}

// What publishes counts its messages, so no frame of the camera is known to be lost.
TEST(BagScanTest, MissingNumbersOfAPublisherAreSaidAndCountNoFrames) {
  RosbagWriter writer(Chunks::kNone);
  const auto left = writer.add_topic("/left/image_raw", "sensor_msgs/Image");
  const auto right = writer.add_topic("/right/image_raw", "sensor_msgs/Image");
  std::uint32_t number = 40;
  for (int i = 0; i < 20; ++i) {
    if (i == 7 || i == 12) number += 3;
    if (i == 15) number = 0;  // restarted
    writer.add_message(left, stamp_of(i), image(i, "cam", number++));
    writer.add_message(right, stamp_of(i), image(i, "cam", static_cast<std::uint32_t>(i)));
  }
  const BagScan scan = scanned(writer);
  ASSERT_EQ(scan.streams.size(), 2U);
  EXPECT_FALSE(scan.streams[0].counted);
  EXPECT_EQ(scan.streams[0].frames[19].counter, 19U);
  ASSERT_EQ(scan.notes.size(), 1U);
  EXPECT_THAT(scan.notes[0],
              HasSubstr("/left/image_raw: 6 numbers of header.seq are missing: messages that were "
                        "published and not recorded"));
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

std::string refused_topics(RosbagWriter& writer, const std::string& topic) {
  try {
    scanned(writer, {.topics = {topic}});
  } catch (const BagError& error) {
    return error.what();
  }
  return "accepted";
}

// Floats would make a stamp and a frame id of a kind.
TEST(BagScanTest, ATopicWithoutAHeaderIsRefused) {
  RosbagWriter writer(Chunks::kNone);
  const auto pose = writer.add_topic("/turtle1/pose", "turtlesim/Pose", "/sim",
                                     "float32 x\nfloat32 y\nfloat32 theta\n");
  writer.add_topic("/old", "old_msgs/Thing", "/sim", "");
  for (int i = 0; i < 5; ++i) writer.add_message(pose, stamp_of(i), std::string(20, '\x3f'));
  EXPECT_THAT(refused_topics(writer, "/turtle1/pose"),
              HasSubstr("/turtle1/pose: found turtlesim/Pose, which has no header; allowed:"));
  EXPECT_THAT(refused_topics(writer, "/old"), HasSubstr("whose definition is not in the bag"));
  EXPECT_THAT(headed_topics(scanned(writer)), IsEmpty());
}

TEST(BagScanTest, FoxglovesImagesHaveAStampInProtobufAndJson) {
  TemporaryFolder folder;
  McapWriter mcap({.compression = "lz4", .chunk_bytes = 500});
  const auto left = mcap.channel("/left/image", "foxglove.CompressedImage", "protobuf", {}, "");
  const auto right = mcap.channel("/right/video", "foxglove.CompressedVideo", "json", {}, "");
  const auto log = mcap.channel("/log", "my.Log", "protobuf", {}, "");
  for (int i = 0; i < 10; ++i) {
    const auto log_ns = static_cast<std::uint64_t>((stamp_of(i) + milliseconds(9)).count());
    // Field 1: a message of 1: 100 + i, 2: 5; field 2: bytes beyond what is read.
    const std::string stamp = std::string("\x08") + static_cast<char>(100 + i) + "\x10\x05";
    mcap.message(left, log_ns, "\x0a\x04" + stamp + "\x12\x88\x08" + std::string(1032, 'j'));
    mcap.message(right, log_ns,
                 R"({"timestamp":{"sec":)" + std::to_string(100 + i) +
                     R"(,"nsec":7},"frame_id":"r","data":")" + std::string(20'000, 'A') + R"("})");
    mcap.message(log, log_ns, stamp);
  }
  write_bytes(folder.file("rig.mcap"), mcap.close());
  const BagScan scan = scan_bag(folder.file("rig.mcap"), "rig", {});
  ASSERT_THAT(names(scan), testing::ElementsAre("left:image", "right:image"));
  EXPECT_THAT(scan.notes, IsEmpty());
  for (const std::size_t stream : {0U, 1U}) {
    ASSERT_EQ(scan.streams[stream].frames.size(), 10U);
    EXPECT_EQ(scan.streams[stream].frames[3].sensor,
              seconds(103) + Nanoseconds(stream == 0 ? 5 : 7));
    EXPECT_EQ(scan.streams[stream].frames[3].arrival, stamp_of(3) + milliseconds(9));
  }
  EXPECT_THROW(scan_bag(folder.file("rig.mcap"), "rig", {.topics = {"/log"}}), BagError);
}

// rosbag2 since Iron writes definitions, older ones none: known names are believed.
TEST(BagScanTest, DefinitionsOfRosTwoDecide) {
  TemporaryFolder folder;
  SqliteBagWriter sqlite(folder.file("rig.db3"));
  sqlite.run(
      "CREATE TABLE message_definitions(id INTEGER PRIMARY KEY, topic_type TEXT, encoding TEXT,"
      " encoded_message_definition TEXT, type_description_hash TEXT);"
      "INSERT INTO message_definitions VALUES(1,'my/msg/Good','ros2msg',"
      " '# first' || char(10) || 'int32 K=3' || char(10) || 'std_msgs/Header header','');"
      "INSERT INTO message_definitions VALUES(2,'my/msg/Bad','ros2msg','float64 x','');");
  for (const std::string type :
       {"my/msg/Good", "my/msg/Bad", "my/msg/Other", "sensor_msgs/msg/Imu"}) {
    const std::int64_t topic = sqlite.topic("/" + type, type);
    for (std::uint32_t i = 0; i < 3; ++i) sqlite.message(topic, 1 + i, cdr_header(i, 0, "x"));
  }
  sqlite.close();
  EXPECT_THAT(headed_topics(scan_bag(folder.file("rig.db3"), "rig", {})),
              testing::ElementsAre("/my/msg/Good", "/sensor_msgs/msg/Imu"));
  for (const std::string topic : {"/my/msg/Bad", "/my/msg/Other"}) {
    EXPECT_THROW(scan_bag(folder.file("rig.db3"), "rig", {.topics = {topic}}), BagError) << topic;
  }
  const BagScan scan = scan_bag(folder.file("rig.db3"), "rig", {.topics = {"/my/msg/Good"}});
  EXPECT_EQ(scan.streams.size(), 1U);
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

// The files of a folder in another order than they were recorded.
TEST(RecordedFilesTest, AFolderIsReadByTimeOfArrival) {
  TemporaryFolder folder;
  const std::string bag = folder.file("rig");
  std::filesystem::create_directory(bag);
  int file = 0;
  for (const int begin : {10, 0, 20}) {
    McapWriter mcap({});
    const std::uint16_t channel = mcap.channel("/left/image_raw", "sensor_msgs/msg/Image", "cdr");
    for (int i = begin; i < begin + 10; ++i) {
      mcap.message(channel, static_cast<std::uint64_t>(stamp_of(i).count()),
                   cdr_header(static_cast<std::uint32_t>(i), 0, "cam"));
    }
    write_bytes(bag + "/rig_" + std::to_string(file++) + ".mcap", mcap.close());
  }
  const BagScan scan = scan_recording(bag, "rig", {});
  ASSERT_EQ(scan.streams.size(), 1U);
  const RecordedStream& stream = scan.streams[0];
  EXPECT_EQ(stream.origin.file, bag);
  ASSERT_EQ(stream.frames.size(), 30U);
  for (std::size_t i = 0; i < 30; ++i) {
    EXPECT_EQ(stream.frames[i].sensor, seconds(i));
    EXPECT_EQ(stream.frames[i].counter, i);
    EXPECT_EQ(stream.origin.messages[i], i < 10 ? i + 10 : i < 20 ? i - 10 : i);
  }
  ASSERT_EQ(scan.topics.size(), 1U);
  EXPECT_EQ(scan.topics[0].first, stamp_of(0));
  EXPECT_EQ(scan.topics[0].last, stamp_of(29));
  EXPECT_EQ(scan.topics[0].longest_gap, milliseconds(33));
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
    EXPECT_THAT(error.what(), HasSubstr("--topics /odom"));
  }
}

}  // namespace
}  // namespace simbench::bags
