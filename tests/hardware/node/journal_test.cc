#include "hardware/node/journal.h"

#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>

#include "hardware/node/protocol.h"
#include "recording/event_text.h"
#include "tests/scratch_folder.h"

namespace simbench::hardware {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

constexpr const char* kSession = "0123456789abcdef";

FrameEvent written_frame(std::uint32_t counter) {
  FrameRecord record;
  record.camera = 4;
  record.counter = counter;
  record.arrival = HostTime(Nanoseconds(1'700'000'000'000'000'000 + counter));
  return {record, std::nullopt};
}

std::string line(std::uint32_t counter) { return to_line(written_frame(counter)) + "\n"; }

class JournalTest : public testing::Test {
 protected:
  std::string folder() const { return root_ / "journals"; }
  std::string path(const std::string& session = kSession) const {
    return folder() + "/" + session + ".csv";
  }
  std::string content() const {
    std::ifstream in(path(), std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  void make_file(const std::string& name, const std::string& text) const {
    fs::create_directories(folder());
    std::ofstream(folder() + "/" + name, std::ios::binary) << text;
  }

  boost::asio::io_context context_;
  const ScratchFolder root_;
};

TEST_F(JournalTest, HasTheLinesOfEventsAndNotesInOrder) {
  Journal journal(context_, folder(), kSession, {});
  journal.write(written_frame(1));
  journal.note("camera 1, front: unplugged\nand back");
  journal.write(SyncOutcome{.slave = 2, .synchronised = true, .passes = 3, .message = ""});
  journal.close();
  EXPECT_EQ(content(),
            line(1) + "note,camera 1\\, front: unplugged\\nand back\n" + "outcome,2,true,3,\n");
  EXPECT_EQ(journal.frames(), 1U);
}

TEST_F(JournalTest, ABatchIsOnDiskAfterItsTime) {
  Journal journal(context_, folder(), kSession, {});
  journal.write(written_frame(1));
  journal.write(written_frame(2));
  EXPECT_THAT(content(), IsEmpty());
  context_.run();  // ends when the batch is written: nothing else waits
  EXPECT_EQ(content(), line(1) + line(2));
}

TEST_F(JournalTest, ALongBatchDoesNotWait) {
  Journal journal(context_, folder(), kSession, {});
  for (std::uint32_t i = 0; i < 2000; ++i) journal.write(written_frame(i));
  EXPECT_GT(content().size(), 32u << 10);
}

TEST_F(JournalTest, AnEarlyEndLeavesNothingThatTouchesIt) {
  {
    Journal journal(context_, folder(), kSession, {});
    journal.write(written_frame(1));
    std::this_thread::sleep_for(kJournalBatch * 2);  // its timer is due
  }
  context_.run();
  EXPECT_EQ(content(), line(1));
}

TEST_F(JournalTest, FolderAndFileAreTheirOwnersAlone) {
  const Journal journal(context_, folder(), kSession, {});
  EXPECT_EQ(fs::status(folder()).permissions(), fs::perms::owner_all);
  EXPECT_EQ(fs::status(path()).permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST_F(JournalTest, IsNeverWrittenOver) {
  make_file(std::string(kSession) + ".csv", "old");
  EXPECT_THROW(Journal(context_, folder(), kSession, {}), JournalError);
  EXPECT_EQ(content(), "old");
}

TEST_F(JournalTest, AFolderThatCannotBeIsOneLine) {
  make_file("file", "");
  try {
    make_journal_folder(folder() + "/file/journals");
    FAIL() << "nothing thrown";
  } catch (const JournalError& error) {
    EXPECT_THAT(error.what(), HasSubstr("file/journals: cannot be made"));
  }
}

TEST_F(JournalTest, TheNewestAreKept) {
  for (int i = 0; i < 130; ++i) {
    char name[32];
    std::snprintf(name, sizeof name, "%016x.csv", i);
    make_file(name, "x\n");
    // The lowest numbers are the newest.
    fs::last_write_time(folder() + "/" + name, fs::file_time_type::clock::now() -
                                                   std::chrono::hours(1) - std::chrono::seconds(i));
  }
  make_file("mine.csv", "not a journal");
  make_file("0000000000000000.txt", "not a journal");
  const Journal journal(context_, folder(), kSession, {});
  std::size_t count = 0;
  for (const auto& entry : fs::directory_iterator(folder())) {
    if (entry.path().extension() == ".csv" && entry.path().stem() != "mine") ++count;
  }
  EXPECT_EQ(count, kKeptJournals);
  EXPECT_TRUE(fs::exists(path()));
  EXPECT_TRUE(fs::exists(folder() + "/mine.csv"));
  EXPECT_TRUE(fs::exists(folder() + "/0000000000000000.txt"));
  EXPECT_TRUE(fs::exists(folder() + "/0000000000000062.csv"));   // the 99th newest
  EXPECT_FALSE(fs::exists(folder() + "/0000000000000063.csv"));  // the 100th
}

TEST_F(JournalTest, IsReadFromAnyLineOn) {
  Journal journal(context_, folder(), kSession, {});
  journal.write(written_frame(1));
  journal.write(written_frame(2));
  journal.flush();
  const auto all = read_journal(folder(), kSession, 0);
  ASSERT_TRUE(all);
  EXPECT_EQ(all->text, line(1) + line(2));
  EXPECT_EQ(all->size, all->text.size());
  const auto second = read_journal(folder(), kSession, line(1).size());
  EXPECT_EQ(second->text, line(2));
  EXPECT_THAT(read_journal(folder(), kSession, all->size)->text, IsEmpty());
  EXPECT_THROW(read_journal(folder(), kSession, all->size + 1), JournalError);
  EXPECT_FALSE(read_journal(folder(), "fedcba9876543210", 0));
  EXPECT_FALSE(read_journal(folder(), "../journals/0123456789abcdef", 0));
}

TEST_F(JournalTest, ChunksJoinToTheWhole) {
  Journal journal(context_, folder(), kSession, {});
  for (std::uint32_t i = 0; i < 20'000; ++i) journal.write(written_frame(i));
  journal.close();
  std::string text;
  std::size_t chunks = 0;
  for (;; ++chunks) {
    const auto chunk = read_journal(folder(), kSession, text.size());
    EXPECT_LE(chunk->text.size(), kJournalChunkBytes);
    if (chunk->text.empty()) break;
    EXPECT_EQ(chunk->text.back(), '\n');
    text += chunk->text;
  }
  EXPECT_GT(chunks, 2U);
  EXPECT_EQ(text, content());
}

// What a kill in the middle of a write() leaves behind.
TEST_F(JournalTest, CutAtAnyByteItEndsWithItsLastWholeLine) {
  const std::string whole = line(1) + "note,\n" + line(2);
  for (std::size_t size = 0; size <= whole.size(); ++size) {
    make_file(std::string(kSession) + ".csv", whole.substr(0, size));
    const auto chunk = read_journal(folder(), kSession, 0);
    const std::size_t expected = whole.substr(0, size).rfind('\n') + 1;
    ASSERT_EQ(chunk->size, expected) << size;
    ASSERT_EQ(chunk->text, whole.substr(0, expected)) << size;
  }
}

TEST_F(JournalTest, AHalfLineLongerThanALookIsLeftOut) {
  make_file(std::string(kSession) + ".csv", line(1) + std::string(10'000, 'x'));
  EXPECT_EQ(read_journal(folder(), kSession, 0)->text, line(1));
}

TEST_F(JournalTest, AFullDiskEndsItAtAWholeLineAndIsToldOnce) {
  // In a process of its own: a limit of file size can be set but not taken back.
  const pid_t process = fork();
  if (process == 0) {
    std::signal(SIGXFSZ, SIG_IGN);
    const std::size_t room = line(1).size() * 10 + 7;
    const rlimit limit = {room, room};
    setrlimit(RLIMIT_FSIZE, &limit);
    std::vector<std::string> messages;
    Journal journal(context_, folder(), kSession,
                    [&](const std::string& text) { messages.push_back(text); });
    for (std::uint32_t i = 1; i <= 8; ++i) journal.write(written_frame(i));
    journal.flush();
    for (std::uint32_t i = 9; i <= 9 + 4; ++i) journal.write(written_frame(1));
    journal.flush();
    for (std::uint32_t i = 0; i < 100; ++i) journal.write(written_frame(1));
    journal.flush();
    const bool good = messages.size() == 1 &&
                      messages[0].find("File too large") != std::string::npos &&
                      journal.frames() == 113 && journal.frames_not_kept() == 103;
    _exit(good ? 0 : 1);
  }
  int status = 0;
  waitpid(process, &status, 0);
  EXPECT_EQ(status, 0);
  std::string expected;
  for (std::uint32_t i = 1; i <= 8; ++i) expected += line(i);
  EXPECT_EQ(content(), expected + line(1) + line(1));
}

TEST(NoteLine, IsReadBack) {
  for (const std::string text : {"", "a,b\\c\nd\re", "\\n", ",", "Kamera 3: gelöst"}) {
    EXPECT_EQ(note_of_line(note_line(text)), text);
    EXPECT_THAT(note_line(text), StartsWith("note,"));
    EXPECT_EQ(note_line(text).find('\n'), std::string::npos);
  }
  EXPECT_FALSE(note_of_line("frame,1"));
  EXPECT_FALSE(note_of_line("note"));
  EXPECT_FALSE(note_of_line(""));
}

TEST_F(JournalTest, BytesThatAreNoTextAreReplaced) {
  Journal journal(context_, folder(), kSession, {});
  journal.note("serial \xff\xfe");
  journal.close();
  EXPECT_EQ(content(), "note,serial \xef\xbf\xbd\xef\xbf\xbd\n");
}

}  // namespace
}  // namespace simbench::hardware
