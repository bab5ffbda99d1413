#include <gmock/gmock.h>

#include <filesystem>

#include "bags/bag.h"
#include "tests/bags/bag_writers.h"
#include "tests/nonempty.h"
#include "tests/scratch_folder.h"

namespace simbench::bags {
namespace {

using testing::HasSubstr;

std::string small_db(const ScratchFolder& folder, std::size_t messages, bool indexed = true,
                     std::size_t data_bytes = 60, int page_bytes = 512) {
  const std::string path = folder / "rig.db3";
  std::filesystem::remove(path);
  SqliteBagWriter writer(path, indexed, page_bytes);
  const std::int64_t left = writer.topic("/left", "sensor_msgs/msg/Image");
  const std::int64_t right = writer.topic("/right", "sensor_msgs/msg/Image");
  for (std::size_t i = 0; i < messages; ++i) {
    const auto s = static_cast<std::uint32_t>(i);
    writer.message(i % 2 == 0 ? left : right, static_cast<std::int64_t>(1000 + i),
                   cdr_header(s, 0, "f") + std::string(data_bytes + i, 'x'));
  }
  writer.close();
  return path;
}

TEST(SqliteBag, GivesTopicsAndMessages) {
  const ScratchFolder folder;
  for (const bool indexed : {true, false}) {
    for (const std::size_t data : {0U, 60U, 5000U}) {
      KeptBag bag(20);
      const BagFacts facts = read_bag(small_db(folder, 40, indexed, data), bag);
      EXPECT_EQ(facts.format, BagFormat::kSqlite);
      EXPECT_TRUE(facts.indexed);
      EXPECT_EQ(facts.lost_messages, 0U);
      EXPECT_THAT(facts.notes, testing::IsEmpty());
      ASSERT_EQ(bag.topics.size(), 2U);
      EXPECT_EQ(bag.topics[1].name, "/right");
      EXPECT_EQ(bag.topics[1].type, "sensor_msgs/Image");
      EXPECT_EQ(bag.topics[1].encoding, Encoding::kCdr);
      ASSERT_EQ(bag.messages.size(), 40U);
      for (std::size_t i = 0; i < 40; ++i) {
        const auto s = static_cast<std::uint32_t>(i);
        const std::string bytes = cdr_header(s, 0, "f") + std::string(data + i, 'x');
        EXPECT_EQ(bag.messages[i], (KeptBag::Message{s % 2, static_cast<std::int64_t>(1000 + i),
                                                     bytes.size(), bytes.substr(0, 20)}));
      }
    }
  }
}

TEST(SqliteBag, InflatesMessagesThatAreCompressed) {
  const ScratchFolder folder;
  const std::string path = folder / "rig.db3";
  const std::string data = cdr_header(5, 6, "frame") + std::string(400'000, 'p');
  SqliteBagWriter writer(path);
  writer.message(writer.topic("/left", "a/msg/B"), 1, deflated("zstd", data));
  writer.message(1, 2, deflated("zstd", data).substr(0, 12));
  writer.close();
  KeptBag bag(30);
  const BagFacts facts = read_bag(path, bag);
  ASSERT_EQ(bag.messages.size(), 1U);
  EXPECT_EQ(bag.messages[0].size, data.size());
  EXPECT_EQ(bag.messages[0].head, data.substr(0, 30));
  EXPECT_EQ(facts.lost_messages, 1U);
  ASSERT_EQ(facts.notes.size(), 1U);
  EXPECT_THAT(facts.notes[0], HasSubstr("message 2: zstd"));
}

TEST(SqliteBag, AnotherDatabaseIsRefusedWithWhatItHas) {
  const ScratchFolder folder;
  const std::string path = folder / "other.db3";
  SqliteBagWriter writer(path);
  writer.run("DROP TABLE messages; CREATE TABLE songs(name TEXT);");
  writer.close();
  EXPECT_THAT(bag_refusal(path), HasSubstr("found the tables topics, songs, allowed: a bag of"));
}

TEST(SqliteBag, NamesWithLettersThatUrisUse) {
  const ScratchFolder folder;
  const std::string path = folder / "a b?c#d%41.db3";
  std::filesystem::rename(small_db(folder, 3), path);
  KeptBag bag;
  EXPECT_EQ(read_bag(path, bag).messages, 3U);
}

TEST(SqliteBag, WhatARecorderLeftBehindIsStated) {
  const ScratchFolder folder;
  const std::string path = small_db(folder, 3);
  put(path + "-wal", "something");
  KeptBag bag;
  const BagFacts facts = read_bag(path, bag);
  EXPECT_FALSE(facts.indexed);
  ASSERT_EQ(facts.notes.size(), 1U);
  EXPECT_THAT(facts.notes[0], HasSubstr("-wal (9 bytes) was read too"));
  EXPECT_EQ(facts.messages, 3U);
  EXPECT_EQ(content(path + "-wal"), "something");
  std::filesystem::remove(path + "-wal");
  put(path + "-journal", "something");
  KeptBag again;
  EXPECT_THAT(read_bag(path, again).notes, testing::ElementsAre(HasSubstr("was not read")));
}

// The files of a recorder that was killed: 20 messages in the file, 30 in its write-ahead log.
TEST(SqliteBag, WhatIsInTheWriteAheadLogIsRead) {
  const ScratchFolder folder;
  std::filesystem::create_directory(folder / "recorder");
  std::filesystem::create_directory(folder / "killed");
  const std::string written = folder / "recorder/rig.db3";
  SqliteBagWriter writer(written);
  const std::int64_t topic = writer.topic("/left", "sensor_msgs/msg/Image");
  const auto write = [&](std::uint32_t from, std::uint32_t to) {
    for (std::uint32_t i = from; i < to; ++i) writer.message(topic, i, cdr_header(i, 0, "f"));
  };
  write(0, 20);
  writer.run("COMMIT; PRAGMA journal_mode=WAL; PRAGMA wal_autocheckpoint=0; BEGIN;");
  write(20, 50);
  writer.run("COMMIT; BEGIN;");
  const std::string killed = folder / "killed/rig.db3";
  for (const std::string suffix : {"", "-wal"}) {
    std::filesystem::copy(written + suffix, killed + suffix);
  }
  std::filesystem::create_symlink(killed, folder / "link.db3");
  const std::string file = content(killed);
  const std::string log = content(killed + "-wal");
  for (const std::string& path : {killed, std::string(folder / "link.db3")}) {
    KeptBag bag(16);
    const BagFacts facts = read_bag(path, bag);
    EXPECT_EQ(facts.messages, 50U);
    EXPECT_EQ(bag.messages.back().head, cdr_header(49, 0, "f").substr(0, 16));
    EXPECT_FALSE(facts.indexed);
    EXPECT_THAT(facts.notes, testing::ElementsAre(HasSubstr("bytes) was read too")));
  }
  EXPECT_EQ(content(killed), file);
  EXPECT_EQ(content(killed + "-wal"), log);
  EXPECT_FALSE(std::filesystem::exists(killed + "-shm"));
}

TEST(SqliteBag, ADamagedPageCostsItsMessages) {
  const ScratchFolder folder;
  for (const bool indexed : {true, false}) {
    const std::string path = small_db(folder, 200, indexed);
    std::string file = content(path);
    // A leaf in the middle: the page that has message 100's header.
    const std::size_t at = file.find(cdr_header(100, 0, "f")) / 512 * 512;
    file.replace(at, 512, std::string(512, '\xff'));
    put(path, file);
    KeptBag bag;
    const BagFacts facts = read_bag(path, bag);
    EXPECT_GT(facts.messages, 180U);
    EXPECT_LT(facts.messages, 200U);
    EXPECT_EQ(facts.messages + facts.lost_messages.value_or(0), 200U);
    ASSERT_FALSE(facts.notes.empty());
    EXPECT_THAT(facts.notes[0], HasSubstr("malformed"));
    EXPECT_EQ(bag.messages.back().log_time_ns, 1199);
  }
}

TEST(SqliteBag, EveryCutIsSurvived) {
  const ScratchFolder folder;
  for (const bool indexed : {true, false}) {
    const std::string path = small_db(folder, 60, indexed);
    const std::string file = content(path);
    std::size_t most = 0;
    for (std::size_t cut = 16; cut < file.size(); cut += 61) {
      std::filesystem::remove(path);
      put(path, file.substr(0, cut));
      KeptBag bag;
      try {
        const BagFacts facts = read_bag(path, bag);
        EXPECT_FALSE(facts.notes.empty()) << cut;
        EXPECT_FALSE(facts.indexed) << cut;
      } catch (const BagError&) {
      }
      EXPECT_LE(bag.messages.size(), 60U) << cut;
      most = std::max(most, bag.messages.size());
    }
    EXPECT_GT(most, 40U);
  }
}

TEST(SqliteBag, EveryFlippedByteIsSurvived) {
  const ScratchFolder folder;
  const std::string path = small_db(folder, 12);
  const std::string file = content(path);
  std::size_t read = 0;
  std::size_t tries = 0;
  for (std::size_t i = 16; i < file.size(); i += 3) {
    std::string damaged = file;
    damaged[i] = static_cast<char>(damaged[i] ^ (i % 2 == 0 ? 0xff : 0x10));
    std::filesystem::remove(path);
    put(path, damaged);
    KeptBag bag;
    try {
      read_bag(path, bag);
    } catch (const BagError&) {
    }
    EXPECT_LE(bag.messages.size(), 12U) << "byte " << i;
    read += bag.messages.size();
    ++tries;
  }
  EXPECT_GT(read, tries * 8);
}

}  // namespace
}  // namespace simbench::bags
