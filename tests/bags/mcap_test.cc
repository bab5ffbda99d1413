#include <gmock/gmock.h>

#include <filesystem>
#include <random>

#include "bags/bag.h"
#include "tests/bags/bag_writers.h"
#include "tests/nonempty.h"
#include "tests/scratch_folder.h"

namespace simbench::bags {
namespace {

using testing::AnyOf;
using testing::HasSubstr;

constexpr std::size_t kMessages = 12;

// Three cameras, one of them with a second publisher; sizes and times differ.
std::string small_mcap(const McapOptions& options, std::size_t messages = kMessages) {
  McapWriter mcap(options);
  const std::uint16_t channels[] = {mcap.channel("/left", "sensor_msgs/msg/Image", "cdr", "/one"),
                                    mcap.channel("/left", "sensor_msgs/msg/Image", "cdr", "/two"),
                                    mcap.channel("/imu", "sensor_msgs/Imu", "ros1")};
  for (std::size_t i = 0; i < messages; ++i) {
    const auto s = static_cast<std::uint32_t>(i);
    mcap.message(channels[i % 3], 1000 + i, cdr_header(s, 0, "f") + std::string(50 + i, 'x'));
  }
  return mcap.close();
}

const std::vector<McapOptions>& every_kind() {
  static const std::vector<McapOptions> kKinds = {
      {.compression = "", .chunk_bytes = 0},
      {.compression = "", .chunk_bytes = 0, .summary = false},
      {.compression = "", .chunk_bytes = 300},
      {.compression = "lz4", .chunk_bytes = 300},
      {.compression = "zstd", .chunk_bytes = 300},
      {.compression = "zstd", .chunk_bytes = 300, .summary = false}};
  return kKinds;
}

BagFacts read_text(const ScratchFolder& folder, const std::string& bytes, KeptBag& bag) {
  // Some file systems flush what replaces a file, which makes thousands of them slow.
  const std::string path = folder / "rig.mcap";
  std::filesystem::remove(path);
  put(path, bytes);
  return read_bag(path, bag);
}

TEST(Mcap, EveryKindOfFileGivesTheSameMessages) {
  const ScratchFolder folder;
  for (const McapOptions& options : nonempty(every_kind())) {
    KeptBag bag(20);
    const BagFacts facts = read_text(folder, small_mcap(options), bag);
    EXPECT_EQ(facts.format, BagFormat::kMcap);
    EXPECT_TRUE(facts.indexed);
    EXPECT_EQ(facts.messages, kMessages);
    EXPECT_EQ(facts.lost_bytes, 0U);
    EXPECT_EQ(facts.lost_messages,
              options.summary ? std::optional<std::uint64_t>(0) : std::nullopt);
    EXPECT_THAT(facts.notes, testing::IsEmpty());
    ASSERT_EQ(bag.topics.size(), 3U);
    EXPECT_EQ(bag.topics[0].name, "/left");
    EXPECT_EQ(bag.topics[0].type, "sensor_msgs/Image");
    EXPECT_EQ(bag.topics[1].publisher, "/two");
    EXPECT_EQ(bag.topics[2].encoding, Encoding::kRos1);
    ASSERT_EQ(bag.messages.size(), kMessages);
    for (std::size_t i = 0; i < kMessages; ++i) {
      const auto s = static_cast<std::uint32_t>(i);
      const std::string data = cdr_header(s, 0, "f") + std::string(50 + i, 'x');
      EXPECT_EQ(bag.messages[i], (KeptBag::Message{s % 3, static_cast<std::int64_t>(1000 + i),
                                                   data.size(), data.substr(0, 20)}));
    }
  }
}

// rosbag2's compression_mode FILE.
TEST(Mcap, AFileThatIsCompressedAsAWholeGivesTheSameMessages) {
  const ScratchFolder folder;
  const std::string plain = small_mcap({.compression = "", .chunk_bytes = 300});
  const std::string packed = deflated("zstd", plain);
  KeptBag expected(20);
  read_text(folder, plain, expected);
  KeptBag whole(20);
  std::uint64_t last = 0;
  const std::string path = folder.write("rig.mcap.zstd", packed);
  const BagFacts facts = read_bag(path, whole, [&](std::uint64_t done, std::uint64_t total) {
    EXPECT_EQ(total, packed.size());
    EXPECT_LE(last, done);
    last = done;
  });
  EXPECT_LE(last, packed.size());
  EXPECT_EQ(whole.messages, expected.messages);
  EXPECT_TRUE(facts.indexed);
  EXPECT_THAT(facts.description, HasSubstr("compressed as a whole (zstd)"));
  EXPECT_THAT(facts.notes, testing::IsEmpty());
}

TEST(Mcap, AFileThatIsCompressedAsAWholeAndCutIsReadUpToThere) {
  const ScratchFolder folder;
  // Numbers that look random, so that half of the packed bytes is about half of the messages.
  McapWriter mcap({});
  const std::uint16_t id = mcap.channel("/left", "sensor_msgs/msg/Image", "cdr");
  std::mt19937 random(1);
  for (std::uint32_t i = 0; i < 20'000; ++i) {
    mcap.message(id, i, cdr_header(i, 0, "f") + bytes_of(random(), 4) + bytes_of(random(), 4));
  }
  const std::string packed = deflated("zstd", mcap.close());
  const std::string path = folder.write("rig.mcap.zstd", packed.substr(0, packed.size() / 2));
  KeptBag bag;
  const BagFacts facts = read_bag(path, bag);
  EXPECT_GT(bag.messages.size(), 1'000U);
  EXPECT_LT(bag.messages.size(), 20'000U);
  EXPECT_FALSE(facts.indexed);
  EXPECT_THAT(facts.notes, testing::Contains(testing::StartsWith(path + ": ")));
  EXPECT_THAT(facts.notes, testing::Contains(HasSubstr("the rest is lost")));
}

TEST(Mcap, ProgressMayEndTheUnpacking) {
  const ScratchFolder folder;
  const std::string path = folder.write("rig.mcap.zstd", deflated("zstd", small_mcap({})));
  struct Enough {};
  KeptBag bag;
  EXPECT_THROW(read_bag(path, bag, [](std::uint64_t, std::uint64_t) { throw Enough(); }), Enough);
  EXPECT_EQ(bag.messages.size(), 0U);
}

// The file unpacked may have more messages than the one that the user has.
TEST(Mcap, AFileThatIsCompressedAsAWholeMayNotBecomeAnything) {
  const ScratchFolder folder;
  McapWriter mcap({});
  const std::uint16_t id = mcap.channel("/a", "t", "cdr");
  std::string plain;
  for (int i = 0; i < 1'100'000; ++i) {
    mcap.message(id, 1, "x");
    if (i % 100'000 == 0) plain += mcap.take_finished();
  }
  plain += mcap.close();
  KeptBag bag;
  const std::string path = folder.write("rig.mcap.zstd", deflated("zstd", plain));
  EXPECT_THAT(read_bag(path, bag).notes,
              testing::Contains(testing::StartsWith(path + ": found more than 10")));
  EXPECT_LT(bag.messages.size(), 1'100'000U);
  EXPECT_GE(bag.messages.size(), 1'000'000U);
  plain += std::string(100'000'000, '\0');
  put(path, deflated("zstd", plain));
  KeptBag cut;
  EXPECT_THAT(read_bag(path, cut).notes, testing::Contains(HasSubstr("128 times its bytes")));
}

TEST(Mcap, LargeMessagesAndLargeHeads) {
  const ScratchFolder folder;
  for (const char* compression : {"", "lz4", "zstd"}) {
    McapWriter mcap({.compression = compression, .chunk_bytes = 1 << 20});
    const std::uint16_t id = mcap.channel("/a", "t", "cdr");
    std::string data(3'000'000, 'q');
    data.back() = 'z';
    for (int i = 0; i < 3; ++i) mcap.message(id, 1, data);
    KeptBag bag(kMostHead * 2);
    EXPECT_EQ(read_text(folder, mcap.close(), bag).messages, 3U);
    ASSERT_EQ(bag.messages.size(), 3U);
    EXPECT_EQ(bag.messages[2].size, data.size());
    EXPECT_EQ(bag.messages[2].head, data.substr(0, kMostHead)) << compression;
  }
}

TEST(Mcap, TopicsThatAreLeftOutAreCountedAndNotTold) {
  const ScratchFolder folder;
  KeptBag bag(kLeaveOut);
  EXPECT_EQ(read_text(folder, small_mcap({.compression = "lz4", .chunk_bytes = 300}), bag).messages,
            kMessages);
  EXPECT_THAT(bag.messages, testing::IsEmpty());
}

TEST(Mcap, OddButAllowedRecordsAreTaken) {
  const ScratchFolder folder;
  McapWriter mcap({.chunk_bytes = 0});
  // A channel before its schema, unknown records, an empty message, and both repeated.
  const std::string channel =
      bytes_of(9, 2) + bytes_of(9, 2) + length_and("/late") + length_and("cdr") + length_and("");
  const std::string schema =
      bytes_of(9, 2) + length_and("a/msg/B") + length_and("ros2msg") + length_and("");
  mcap.record(4, channel);
  mcap.record(0x80, "private");
  mcap.record(0x70, "");
  mcap.record(3, schema);
  mcap.message(9, 5, "");
  mcap.record(3, schema);
  mcap.record(4, channel);
  mcap.message(9, 6, "x");
  KeptBag bag;
  const BagFacts facts = read_text(folder, mcap.close(), bag);
  EXPECT_EQ(facts.messages, 2U);
  ASSERT_EQ(bag.topics.size(), 1U);
  EXPECT_EQ(bag.topics[0].type, "a/B");
  EXPECT_THAT(facts.notes, testing::IsEmpty());
}

TEST(Mcap, MessagesOfUnknownChannelsAreLost) {
  const ScratchFolder folder;
  McapWriter mcap({.chunk_bytes = 0});
  mcap.message(mcap.channel("/a", "t", "cdr"), 1, "x");
  mcap.message(77, 2, "x");
  KeptBag bag;
  const BagFacts facts = read_text(folder, mcap.close(), bag);
  EXPECT_EQ(facts.messages, 1U);
  EXPECT_EQ(facts.lost_messages, 1U);
  ASSERT_EQ(facts.notes.size(), 1U);
  EXPECT_THAT(facts.notes[0], HasSubstr("1 messages are of channels that are nowhere described"));
}

TEST(Mcap, AnEncryptedFileIsRefusedWithWhatIsAllowed) {
  const ScratchFolder folder;
  McapWriter mcap({.compression = "aes", .chunk_bytes = 100});
  mcap.message(mcap.channel("/a", "t", "cdr"), 1, std::string(200, 'x'));
  KeptBag bag;
  try {
    read_text(folder, mcap.close(), bag);
    ADD_FAILURE() << "accepted";
  } catch (const BagError& error) {
    EXPECT_THAT(error.what(), HasSubstr("'aes', allowed: none, lz4, zstd"));
    EXPECT_THAT(error.what(), HasSubstr("at byte"));
  }
}

TEST(Mcap, ADamagedChunkCostsItselfAlone) {
  const ScratchFolder folder;
  for (const char* compression : {"lz4", "zstd"}) {
    McapWriter mcap({.compression = compression, .chunk_bytes = 1 << 20});
    const std::uint16_t id = mcap.channel("/a", "t", "cdr");
    std::mt19937 random(5);
    std::vector<std::size_t> ends;
    std::string file;
    for (std::uint64_t chunk = 0; chunk < 3; ++chunk) {
      for (std::uint64_t i = 0; i < 4; ++i) {
        std::string data(300, '\0');
        for (char& byte : data) byte = static_cast<char>(random());
        mcap.message(id, chunk * 10 + i, data);
      }
      mcap.end_chunk();
      file += mcap.take_finished();
      ends.push_back(file.size());
    }
    file += mcap.close();
    // The frame's own magic number, behind the chunk's head.
    file[ends[0] + 9 + 40 + std::string(compression).size()] ^= 0x7f;
    KeptBag bag;
    const BagFacts facts = read_text(folder, file, bag);
    EXPECT_EQ(facts.messages, 8U) << compression;
    EXPECT_EQ(facts.lost_messages, 4U) << compression;
    EXPECT_GT(facts.lost_bytes, 1000U) << compression;
    EXPECT_LE(facts.lost_bytes, ends[1] - ends[0]) << compression;
    ASSERT_FALSE(facts.notes.empty());
    EXPECT_THAT(facts.notes[0], HasSubstr("at byte " + std::to_string(ends[0])));
  }
}

TEST(Mcap, AWrongLengthIsPassedByTheNextRecord) {
  const ScratchFolder folder;
  for (const std::size_t chunk : {0U, 100'000U}) {
    McapWriter mcap({.chunk_bytes = chunk, .checksums = false});
    const std::uint16_t id = mcap.channel("/a", "t", "cdr");
    for (std::uint64_t i = 0; i < 10; ++i) mcap.message(id, i, std::string(40, 'x'));
    std::string file = mcap.close();
    // The third message's length: found by its log time, which is stated twice.
    const std::size_t at = file.find(bytes_of(2, 8) + bytes_of(2, 8)) - 6 - 8;
    file[at + 5] = 1;
    KeptBag bag;
    const BagFacts facts = read_text(folder, file, bag);
    EXPECT_EQ(facts.messages, 9U) << chunk;
    EXPECT_EQ(facts.lost_messages, 1U) << chunk;
    EXPECT_EQ(facts.lost_bytes, 9U + 22U + 40U) << chunk;
  }
}

// A changed stamp cannot be told from a right one, so the chunk is not believed.
TEST(Mcap, AChunkWithAnotherChecksumIsLeftOut) {
  const ScratchFolder folder;
  for (const char* compression : {"", "lz4", "zstd"}) {
    McapWriter mcap({.compression = compression, .chunk_bytes = 1 << 20});
    const std::uint16_t left = mcap.channel("/left", "t", "cdr");
    const std::uint16_t right = mcap.channel("/right", "t", "cdr");
    std::string file;
    std::size_t second = 0;
    std::mt19937 random(2);
    for (std::uint64_t chunk = 0; chunk < 3; ++chunk) {
      for (std::uint64_t i = 0; i < 4; ++i) {
        std::string noise(50, '\0');
        for (char& byte : noise) byte = static_cast<char>(random());
        mcap.message(i % 2 == 0 ? left : right, chunk * 10 + i, noise);
      }
      mcap.end_chunk();
      if (chunk == 1) second = file.size();
      file += mcap.take_finished();
    }
    file += mcap.close();
    // The checksum itself, behind two times and the plain size.
    file[second + 9 + 24] ^= 1;
    KeptBag bag;
    const BagFacts facts = read_text(folder, file, bag);
    EXPECT_EQ(facts.messages, 8U) << compression;
    EXPECT_EQ(facts.lost_messages, 4U) << compression;
    ASSERT_EQ(facts.notes.size(), 1U) << compression;
    EXPECT_THAT(facts.notes[0], HasSubstr("at byte " + std::to_string(second) +
                                          ": a chunk's checksum differs; its 4 messages of /left, "
                                          "/right were left out"));
  }
}

TEST(Mcap, TheChecksumOfTheDataSectionIsCompared) {
  const ScratchFolder folder;
  McapWriter mcap({.data_checksum = true});
  const std::uint16_t id = mcap.channel("/a", "t", "cdr");
  for (std::uint64_t i = 0; i < 100; ++i) mcap.message(id, i, std::string(3000, 'x'));
  std::string file = mcap.close();
  KeptBag whole;
  EXPECT_THAT(read_text(folder, file, whole).notes, testing::IsEmpty());
  file[file.size() / 2] ^= 4;
  KeptBag bag;
  const BagFacts facts = read_text(folder, file, bag);
  EXPECT_EQ(facts.messages, 100U);
  ASSERT_EQ(facts.notes.size(), 1U);
  EXPECT_THAT(facts.notes[0], HasSubstr("the checksum of its data section differs"));
}

TEST(Mcap, AChannelThatStandsForTwoTopicsIsNeverMixed) {
  const ScratchFolder folder;
  for (const std::size_t chunk : {0U, 100'000U}) {
    McapWriter mcap({.compression = chunk > 0 ? "lz4" : "", .chunk_bytes = chunk});
    const std::uint16_t id = mcap.channel("/a", "t", "cdr");
    for (std::uint64_t i = 0; i < 5; ++i) mcap.message(id, i, "x");
    mcap.record(4, bytes_of(id, 2) + bytes_of(id, 2) + length_and("/b") + length_and("cdr") +
                       length_and(""));
    for (std::uint64_t i = 5; i < 12; ++i) mcap.message(id, i, "y");
    KeptBag bag;
    const BagFacts facts = read_text(folder, mcap.close(), bag);
    EXPECT_EQ(bag.messages.size(), 5U);
    ASSERT_EQ(facts.notes.size(), 2U);
    EXPECT_THAT(facts.notes[0], HasSubstr("channel 1 stands for /a and for /b"));
    EXPECT_THAT(facts.notes[1], HasSubstr("7 messages of channels that stand for two topics"));
  }
}

TEST(Mcap, AChunkMayNotBecomeMoreThanItDeclares) {
  const ScratchFolder folder;
  for (const char* compression : {"lz4", "zstd"}) {
    McapWriter mcap({.compression = compression, .chunk_bytes = 1 << 20, .checksums = false});
    const std::uint16_t id = mcap.channel("/a", "t", "cdr");
    for (std::uint64_t i = 0; i < 1000; ++i) mcap.message(id, i, std::string(69, 'x'));
    std::string file = mcap.close();
    const std::size_t declared = file.find(compression) - 4 - 4 - 8;
    file.replace(declared, 8, bytes_of(20'000, 8));
    KeptBag bag;
    const BagFacts facts = read_text(folder, file, bag);
    EXPECT_GT(facts.messages, 190U) << compression;
    EXPECT_LE(facts.messages, 200U) << compression;
    EXPECT_THAT(
        facts.notes,
        testing::Contains(HasSubstr("it becomes more than the 20000 bytes that it declares")));
  }
}

TEST(Mcap, ASmallFileMayNotBecomeAnyNumberOfMessages) {
  const ScratchFolder folder;
  McapWriter mcap({.compression = "zstd", .chunk_bytes = 10 << 20, .checksums = false});
  const std::uint16_t id = mcap.channel("/a", "t", "cdr");
  for (int i = 0; i < 1'300'000; ++i) mcap.message(id, 1, "");
  KeptBag bag(kLeaveOut);
  const std::string file = mcap.close();
  const BagFacts facts = read_text(folder, file, bag);
  EXPECT_LT(file.size(), 100'000U);
  EXPECT_EQ(facts.messages, 1'000'000 + file.size() / 16);
  EXPECT_THAT(facts.notes, testing::Contains(HasSubstr("which is the limit for a file of this "
                                                       "size; the rest was left out")));
}

// Read and lost are what was written, wherever the file ends.
TEST(Mcap, EveryCutGivesTheMessagesBeforeIt) {
  const ScratchFolder folder;
  for (const McapOptions& options : nonempty(every_kind())) {
    const std::string file = small_mcap(options);
    KeptBag whole;
    read_text(folder, file, whole);
    std::size_t before = 0;
    for (std::size_t cut = 8; cut < file.size(); ++cut) {
      KeptBag bag;
      try {
        const BagFacts facts = read_text(folder, file.substr(0, cut), bag);
        EXPECT_FALSE(facts.indexed);
        EXPECT_FALSE(facts.notes.empty());
        EXPECT_EQ(facts.messages, bag.messages.size());
      } catch (const BagError&) {
        EXPECT_EQ(before, 0U) << "cut at " << cut;
      }
      ASSERT_LE(bag.messages.size(), whole.messages.size());
      EXPECT_GE(bag.messages.size(), before) << "cut at " << cut;
      EXPECT_TRUE(std::equal(bag.messages.begin(), bag.messages.end(), whole.messages.begin()))
          << "cut at " << cut;
      before = bag.messages.size();
    }
    EXPECT_EQ(before, kMessages);
  }
}

// A flip can make a message of another record, or of an LZ4 block two: that is not to be told apart
// without checksums, but with statistics it is never silent.
TEST(Mcap, EveryFlippedByteIsSurvived) {
  const ScratchFolder folder;
  for (const McapOptions& options : nonempty(every_kind())) {
    const std::string file = small_mcap(options, 6);
    std::size_t read = 0;
    for (std::size_t i = 8; i < file.size(); ++i) {
      const int mask = i % 3 == 0 ? 0x01 : i % 3 == 1 ? 0x80 : 0xff;
      std::string damaged = file;
      damaged[i] = static_cast<char>(damaged[i] ^ mask);
      KeptBag bag;
      try {
        const BagFacts facts = read_text(folder, damaged, bag);
        if (facts.lost_messages && facts.messages <= 6) {
          EXPECT_EQ(facts.messages + *facts.lost_messages, 6U) << "byte " << i << " ^ " << mask;
        }
        if (facts.lost_messages && facts.messages > 6) {
          EXPECT_FALSE(facts.notes.empty()) << "byte " << i << " ^ " << mask;
        }
      } catch (const BagError&) {
      }
      EXPECT_LE(bag.messages.size(), 12U) << "byte " << i << " ^ " << mask;
      EXPECT_LE(bag.topics.size(), 6U) << "byte " << i << " ^ " << mask;
      read += bag.messages.size();
    }
    // Damage of one byte costs half of the messages at the most, on average.
    EXPECT_GT(read, (file.size() - 8) * 3) << options.compression;
  }
}

TEST(Mcap, RandomBytesAreNotBelieved) {
  const ScratchFolder folder;
  for (unsigned seed = 1; seed <= 200; ++seed) {
    std::mt19937 random(seed);
    std::string file = "\x89MCAP0\r\n";
    for (int i = 0; i < 2000; ++i) file += static_cast<char>(random() % (seed % 16 + 1));
    KeptBag bag;
    try {
      read_text(folder, file, bag);
    } catch (const BagError& error) {
      EXPECT_THAT(error.what(), HasSubstr("rig.mcap")) << "seed " << seed;
    }
    EXPECT_LE(bag.messages.size(), 100U) << "seed " << seed;
  }
}

TEST(Mcap, ProgressMayEndTheReading) {
  const ScratchFolder folder;
  McapWriter mcap({.chunk_bytes = 0});
  const std::uint16_t id = mcap.channel("/a", "t", "cdr");
  for (std::uint64_t i = 0; i < 20; ++i) mcap.message(id, i, std::string(1'000'000, 'x'));
  const std::string path = folder.write("rig.mcap", mcap.close());
  KeptBag bag;
  const auto stop = [](std::uint64_t, std::uint64_t) { throw std::runtime_error("stopped"); };
  EXPECT_THROW(read_bag(path, bag, stop), std::runtime_error);
  EXPECT_THAT(bag.messages.size(), AnyOf(8U, 9U));
}

}  // namespace
}  // namespace simbench::bags
