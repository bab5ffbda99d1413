// The reader of MCAP against @mcap/core: what that writes is read here, and what the tests' own
// writer writes is read there, checksums included.
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cstdio>

#include "bags/bag.h"
#include "tests/bags/bag_writers.h"
#include "tests/scratch_folder.h"

namespace simbench::bags {
namespace {

// What `node mcap.mjs` prints; a failure of it is a failure here.
std::string node_mcap(const std::string& arguments) {
  const std::string command = "node " SIMBENCH_SOURCE_DIR
                              "/tests/bags/npm/mcap.mjs " SIMBENCH_BAG_PACKAGES " " +
                              arguments + " 2>&1";
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

}  // namespace
}  // namespace simbench::bags
