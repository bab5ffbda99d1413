// The reader of MCAP against @mcap/core: what that writes is read here, and what the tests' own
// writer writes is read there, checksums included.
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <sstream>
#include <string>
#include <vector>

#include "bags/bag.h"
#include "tests/bags/bag_writers.h"
#include "tests/bags/rosbag_writer.h"
#include "tests/data/test_data.h"
#include "tests/scratch_folder.h"

namespace simbench::bags {
namespace {

// What a script of npm/ prints; a failure of it is a failure here.
std::string node(const std::string& script, const std::string& arguments) {
  const std::string command = "NODE_NO_WARNINGS=1 node " SIMBENCH_SOURCE_DIR "/tests/bags/npm/" +
                              script + " " SIMBENCH_BAG_PACKAGES " " + arguments + " 2>&1";
  std::string printed;
  std::FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return "no shell";
  std::array<char, 4096> part;
  while (const std::size_t size = std::fread(part.data(), 1, part.size(), pipe)) {
    printed.append(part.data(), size);
  }
  EXPECT_EQ(pclose(pipe), 0) << command << "\n" << printed << "(tools/setup check installs it)";
  return printed;
}

std::string node_mcap(const std::string& arguments) { return node("mcap.mjs", arguments); }

std::string csv_of(const std::string& path) {
  KeptBag bag(0);
  const BagFacts facts = read_bag(path, bag);
  EXPECT_EQ(facts.lost_bytes, 0U);
  EXPECT_THAT(facts.notes, testing::IsEmpty());
  EXPECT_EQ(facts.lost_messages, 0U);
  std::string csv;
  for (const KeptBag::Message& message : bag.messages) {
    csv += bag.topics.at(message.topic).name + "," + std::to_string(message.log_time_ns) + "," +
           std::to_string(message.size) + "\n";
  }
  return csv;
}

TEST(BagReference, ReadsWhatMcapCoreWrites) {
  const ScratchFolder folder;
  std::string expected;
  for (int i = 0; i < 50; ++i) {
    expected += "/camera" + std::to_string(i % 3) + "," + std::to_string(1000 + i) + "," +
                std::to_string(40 + i) + "\n";
  }
  for (const char* compression : {"unchunked", "none", "zstd"}) {
    const std::string path = folder / compression;
    node_mcap("write " + path + " " + compression + " 50");
    EXPECT_EQ(csv_of(path), expected) << compression;
    EXPECT_EQ(node_mcap("read " + path), expected) << compression;
  }
}

TEST(BagReference, McapCoreReadsWhatTheTestsWrite) {
  const ScratchFolder folder;
  for (const char* compression : {"", "lz4", "zstd"}) {
    for (const std::size_t chunk_bytes : {std::size_t{0}, std::size_t{500}}) {
      McapWriter mcap({.compression = compression, .chunk_bytes = chunk_bytes});
      const std::uint16_t left = mcap.channel("/left", "sensor_msgs/msg/Image", "cdr");
      const std::uint16_t right = mcap.channel("/right", "sensor_msgs/msg/Image", "cdr", "/node");
      for (std::uint64_t i = 0; i < 40; ++i) {
        mcap.message(i % 2 == 0 ? left : right, 1'700'000'000'000'000'000 + i,
                     cdr_header(1, 2, "f") + std::string(i * 3, 'x'));
      }
      const std::string path = folder.write("rig.mcap", mcap.close());
      const std::string read = csv_of(path);
      EXPECT_EQ(std::count(read.begin(), read.end(), '\n'), 40);
      EXPECT_EQ(node_mcap("read " + path), read) << compression << " " << chunk_bytes;
    }
  }
}

// "topic,s,ns,size" of each message.
std::string rosbag_csv_of(const std::string& path) {
  KeptBag bag(0);
  read_bag(path, bag);
  std::string csv;
  for (const KeptBag::Message& message : bag.messages) {
    csv += bag.topics.at(message.topic).name + "," +
           std::to_string(message.log_time_ns / 1'000'000'000) + "," +
           std::to_string(message.log_time_ns % 1'000'000'000) + "," +
           std::to_string(message.size) + "\n";
  }
  return csv;
}

// That reader goes by time, ours by the file, so messages are compared in an order of their own.
std::vector<std::string> sorted_lines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  std::ranges::sort(lines);
  return lines;
}

TEST(BagReference, FoxgloveRosbagReadsTheSame) {
  const ScratchFolder folder;
  for (const auto chunks :
       {RosbagWriter::Chunks::kNone, RosbagWriter::Chunks::kLz4, RosbagWriter::Chunks::kBzip2}) {
    RosbagWriter writer(chunks, 500);
    const auto topic = writer.add_topic("/cam/image_raw", "sensor_msgs/Image");
    for (int i = 0; i < 30; ++i) {
      writer.add_message(topic, std::chrono::milliseconds(100 + 33 * i), std::string(20 + i, 'x'));
    }
    const std::string path = folder.write("rig.bag", writer.bag());
    EXPECT_EQ(sorted_lines(node("read_rosbag.mjs", path)), sorted_lines(rosbag_csv_of(path)));
  }
  for (const char* camera : {"camera0", "camera1"}) {
    const std::string path = test_data_path(std::string("realsense_bag/") + camera + ".bag");
    EXPECT_EQ(sorted_lines(node("read_rosbag.mjs", path)), sorted_lines(rosbag_csv_of(path)));
  }
}

}  // namespace
}  // namespace simbench::bags
