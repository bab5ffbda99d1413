#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <random>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "bags/bag.h"
#include "bags/bag_scan.h"
#include "recording/temporary_folder.h"
#include "tests/bags/memory_file.h"
#include "tests/bags/rosbag_writer.h"
#include "tests/data/test_data.h"

namespace simbench::bags {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::HasSubstr;
using Chunks = RosbagWriter::Chunks;

// Keeps what it is told.
class KeepingSink final : public BagSink {
 public:
  explicit KeepingSink(std::size_t head = 64) : head_(head) {}
  std::size_t on_topic(std::uint32_t number, const BagTopic& topic) override {
    EXPECT_EQ(number, topics.size());
    topics.push_back(topic);
    return left_out.contains(topic.name) ? kLeaveOut : head_;
  }
  void on_message(const BagMessage& message) override {
    ASSERT_LT(message.topic, topics.size());
    messages.push_back({message.topic, message.log_time, message.size, std::string(message.head)});
  }

  struct Kept {
    std::uint32_t topic;
    Nanoseconds log_time;
    std::uint64_t size;
    std::string head;
    bool operator==(const Kept&) const = default;
  };
  std::vector<BagTopic> topics;
  std::vector<Kept> messages;
  std::set<std::string> left_out;

 private:
  std::size_t head_;
};

// A bag of two topics, `count` messages each, in chunks of about 1 kB.
RosbagWriter small_bag(Chunks chunks, int count = 40) {
  RosbagWriter writer(chunks, 1000);
  const auto left = writer.add_topic("/left/image_raw", "sensor_msgs/Image");
  const auto right = writer.add_topic("/right/image_raw", "sensor_msgs/Image");
  for (int i = 0; i < count; ++i) {
    const Nanoseconds stamp = seconds(100) + milliseconds(20) * i;
    for (const auto topic : {left, right}) {
      const auto sequence = static_cast<std::uint32_t>(i);
      writer.add_message(topic, stamp + milliseconds(3),
                         ros1_header(sequence, stamp, "cam") + std::string(50 + i % 7, 'x'));
    }
  }
  return writer;
}

class RosbagTest : public testing::Test {
 protected:
  static BagFacts read(const std::string& bytes, KeepingSink& sink) {
    return read_bag(MemoryFile(bytes).path(), sink);
  }
};

TEST_F(RosbagTest, EveryCompressionGivesWhatWasWritten) {
  for (const Chunks chunks : {Chunks::kNone, Chunks::kLz4, Chunks::kBzip2}) {
    for (const bool indexed : {true, false}) {
      RosbagWriter writer = small_bag(chunks);
      KeepingSink sink(16);
      const BagFacts facts = read(writer.bag(indexed), sink);
      EXPECT_EQ(facts.indexed, indexed);
      EXPECT_EQ(facts.messages, 80U);
      EXPECT_EQ(facts.lost_bytes, 0U);
      ASSERT_EQ(sink.messages.size(), 80U);
      for (std::size_t i = 0; i < 80; ++i) {
        const auto number = static_cast<int>(i / 2);
        const Nanoseconds stamp = seconds(100) + milliseconds(20) * number;
        const std::string whole = ros1_header(static_cast<std::uint32_t>(number), stamp, "cam");
        EXPECT_EQ(sink.messages[i].topic, i % 2);
        EXPECT_EQ(sink.messages[i].log_time, stamp + milliseconds(3));
        EXPECT_EQ(sink.messages[i].size, whole.size() + 50 + static_cast<std::size_t>(number % 7));
        EXPECT_EQ(sink.messages[i].head, whole.substr(0, 16));
      }
      EXPECT_EQ(sink.topics[0].name, "/left/image_raw");
      EXPECT_EQ(sink.topics[0].type, "sensor_msgs/Image");
      EXPECT_EQ(sink.topics[0].publisher, "/recorder");
    }
  }
}

TEST_F(RosbagTest, ATopicThatIsLeftOutIsCountedAndNotTold) {
  RosbagWriter writer(Chunks::kLz4, 500);
  const auto a = writer.add_topic("/a", "sensor_msgs/Image");
  const auto b = writer.add_topic("/b", "sensor_msgs/Image");
  for (int i = 0; i < 20; ++i) writer.add_message(a, milliseconds(i), std::string(100, 'a'));
  for (int i = 0; i < 20; ++i) writer.add_message(b, milliseconds(i), std::string(100, 'b'));
  KeepingSink sink;
  sink.left_out = {"/a"};
  const BagFacts facts = read(writer.bag(), sink);
  EXPECT_EQ(facts.messages, 40U);
  EXPECT_EQ(facts.lost_messages, 0U);
  EXPECT_EQ(sink.messages.size(), 20U);
}

TEST_F(RosbagTest, WhatIsCutOffAnywhereIsReadUpToThere) {
  for (const Chunks chunks : {Chunks::kNone, Chunks::kLz4}) {
    RosbagWriter writer = small_bag(chunks, 12);
    const std::string whole = writer.bag();
    std::size_t before = 0;
    for (std::size_t size = 13; size < whole.size(); size += 7) {
      KeepingSink sink;
      try {
        const BagFacts facts = read(whole.substr(0, size), sink);
        EXPECT_LE(sink.messages.size(), 24U);
        EXPECT_GE(sink.messages.size(), before) << "cut after " << size;
        EXPECT_FALSE(facts.notes.empty()) << "cut after " << size;
        before = sink.messages.size();
      } catch (const BagError& error) {
        EXPECT_EQ(before, 0U) << error.what();
      }
    }
    EXPECT_EQ(before, 24U);
  }
}

TEST_F(RosbagTest, ADamagedChunkCostsOnlyItself) {
  for (const bool indexed : {true, false}) {
    for (const Chunks chunks : {Chunks::kNone, Chunks::kLz4, Chunks::kBzip2}) {
      RosbagWriter writer = small_bag(chunks);
      std::string bytes = writer.bag(indexed);
      ASSERT_GE(writer.chunk_positions().size(), 4U);
      // The second chunk's own header.
      std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(writer.chunk_positions()[1]), 40,
                  '\xee');
      KeepingSink sink;
      const BagFacts facts = read(bytes, sink);
      const std::size_t per_chunk = 80 / writer.chunk_positions().size();
      EXPECT_LT(sink.messages.size(), 80U);
      EXPECT_GE(sink.messages.size(), 80U - per_chunk - 4);
      EXPECT_GT(facts.lost_bytes, 0U);
      EXPECT_THAT(facts.notes, testing::Contains(HasSubstr("are lost")));
      if (indexed) {
        EXPECT_EQ(*facts.lost_messages, 80 - sink.messages.size());
      }
    }
  }
}

// Without the topics' numbers: a damaged index may name one more.
std::vector<std::string> contents(const KeepingSink& sink) {
  std::vector<std::string> heads;
  for (const KeepingSink::Kept& kept : sink.messages) {
    heads.push_back(std::to_string(kept.log_time.count()) + kept.head);
  }
  return heads;
}

// Whatever byte is changed: no crash, and what a checksum covers never changes in silence.
TEST_F(RosbagTest, AnyByteMayBeWrong) {
  for (const Chunks chunks : {Chunks::kNone, Chunks::kLz4}) {
    RosbagWriter writer = small_bag(chunks, 6);
    const std::string whole = writer.bag();
    KeepingSink written;
    read(whole, written);
    std::mt19937 random(7);
    for (std::size_t at = 13; at < whole.size(); ++at) {
      if (at > 200 && at < 4096) continue;  // the bag header's padding
      std::string bytes = whole;
      bytes[at] = static_cast<char>(bytes[at] ^ (1 + random() % 255));
      KeepingSink sink;
      try {
        const BagFacts facts = read(bytes, sink);
        if (chunks == Chunks::kNone) {
          EXPECT_LE(sink.messages.size(), 12U) << "byte " << at;
        } else if (contents(sink) != contents(written)) {
          EXPECT_FALSE(facts.notes.empty()) << "byte " << at;
        }
      } catch (const BagError& error) {
        EXPECT_THAT(error.what(), HasSubstr(": "));
      }
    }
  }
}

TEST_F(RosbagTest, WrongSizesDoNotMatter) {
  for (const bool indexed : {true, false}) {
    RosbagWriter writer = small_bag(Chunks::kLz4);
    const std::string whole = writer.bag(indexed);
    const std::uint64_t chunk = writer.chunk_positions()[1];
    const std::uint32_t header =
        static_cast<std::uint8_t>(whole[chunk]) |
        static_cast<std::uint32_t>(static_cast<std::uint8_t>(whole[chunk + 1])) << 8;
    for (const std::uint32_t size : {0U, 10U, 100'000U, 0xffffffffU}) {
      std::string bytes = whole;
      bytes.replace(chunk + 4 + header, 4, little_endian(size));
      KeepingSink sink;
      const BagFacts facts = read(bytes, sink);
      EXPECT_GE(sink.messages.size(), 80 - 80 / writer.chunk_positions().size() - 4) << size;
      EXPECT_FALSE(facts.notes.empty());
    }
  }
}

TEST_F(RosbagTest, AChunkMayNotBecomeMoreThanItDeclares) {
  for (const Chunks chunks : {Chunks::kLz4, Chunks::kBzip2}) {
    RosbagWriter writer(chunks, 100'000);
    const auto topic = writer.add_topic("/a", "sensor_msgs/Image");
    for (int i = 0; i < 200; ++i) writer.add_message(topic, milliseconds(i), std::string(60, 'x'));
    std::string bytes = writer.bag();
    const std::size_t size = bytes.find("size=", writer.chunk_positions()[0]) + 5;
    bytes.replace(size, 4, little_endian(std::uint32_t{5000}));
    KeepingSink sink;
    const BagFacts facts = read(bytes, sink);
    EXPECT_GT(sink.messages.size(), 20U);
    EXPECT_LT(sink.messages.size(), 80U);
    EXPECT_FALSE(facts.notes.empty());
  }
}

TEST_F(RosbagTest, WhatCannotBeReadIsRefusedInOneLine) {
  const auto message_of = [](const std::string& bytes) -> std::string {
    KeepingSink sink;
    try {
      read(bytes, sink);
    } catch (const BagError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(message_of(""), HasSubstr("found no bag"));
  EXPECT_THAT(message_of("#ROSBAG V2.0\n"), HasSubstr("empty"));
  EXPECT_THAT(message_of("#ROSBAG V1.2\nabc"), HasSubstr("found no bag"));
  RosbagWriter writer = small_bag(Chunks::kNone, 2);
  EXPECT_THAT(message_of(writer.bag(true, "rosbag/AesCbcEncryptor")), HasSubstr("encrypted"));
}

// ---- The SDK's own bags -------------------------------------------------------------------------

struct Injected {
  std::vector<StampedFrame> depth;
  std::vector<StampedFrame> colour;
};

Injected injected(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  Injected found;
  while (std::getline(file, line)) {
    std::stringstream cells(line);
    std::string stream;
    std::string cell;
    std::getline(cells, stream, ',');
    std::vector<std::string> values;
    while (std::getline(cells, cell, ',')) values.push_back(cell);
    StampedFrame frame;
    frame.counter = std::stoull(values[0]);
    frame.sensor = Microseconds(std::stoll(values[3]));
    frame.arrival = milliseconds(std::stoll(values[6]));
    (stream == "depth" ? found.depth : found.colour).push_back(frame);
  }
  return found;
}

void expect_frames(const std::vector<StampedFrame>& expected, const RecordedStream& stream) {
  ASSERT_EQ(stream.frames.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(stream.frames[i].counter, expected[i].counter) << i;
    EXPECT_EQ(stream.frames[i].sensor, expected[i].sensor) << i;
    EXPECT_EQ(stream.frames[i].arrival, expected[i].arrival) << i;
    EXPECT_EQ(stream.origin.messages[i], i);
  }
}

TEST(RealsenseBagTest, EveryStampIsTheOneThatWasInjected) {
  for (const std::string name : {"camera0", "camera1"}) {
    const std::string path = test_data_path("realsense_bag/" + name);
    const Injected expected = injected(path + ".csv");
    const BagScan scan = scan_bag(path + ".bag", name, {});
    ASSERT_EQ(scan.streams.size(), 2U);
    EXPECT_EQ(scan.streams[0].stream, "Depth 0");
    EXPECT_EQ(scan.streams[1].stream, "Color 0");
    EXPECT_EQ(scan.streams[0].camera, name);
    EXPECT_FALSE(scan.streams[0].stamped_by_host);
    EXPECT_TRUE(scan.streams[0].counted);
    EXPECT_THAT(scan.streams[0].origin.stamps, HasSubstr("SENSOR_TIMESTAMP"));
    expect_frames(expected.depth, scan.streams[0]);
    expect_frames(expected.colour, scan.streams[1]);
    EXPECT_THAT(scan.devices, testing::ElementsAre(HasSubstr("D455")));
    EXPECT_THAT(scan.notes, testing::IsEmpty());
    EXPECT_EQ(*scan.facts.lost_messages, 0U);
  }
}

TEST(RealsenseBagTest, CutInTheMiddleItGivesTheFirstChunk) {
  std::ifstream file(test_data_path("realsense_bag/camera0.bag"), std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(file)), {});
  TemporaryFolder folder;
  const std::string path = folder.path() + "/cut.bag";
  write_bytes(path, bytes.substr(0, 100'000));
  const BagScan scan = scan_bag(path, "cut", {});
  ASSERT_EQ(scan.streams.size(), 2U);
  const Injected expected = injected(test_data_path("realsense_bag/camera0.csv"));
  const std::vector<StampedFrame>& frames = scan.streams[0].frames;
  ASSERT_GT(frames.size(), 250U);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(frames[i].sensor, expected.depth[i].sensor);
  }
  EXPECT_THAT(scan.notes, testing::Contains(HasSubstr("index")));
}

}  // namespace
}  // namespace simbench::bags
