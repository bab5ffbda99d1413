#include "processes/program_use.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdint>
#include <cstring>
#include <memory>
#include <string>

#include "processes/process_tree.h"
#include "processes/warden.h"
#include "recording/distrusted_folder.h"
#include "tests/scratch_folder.h"

namespace simbench::processes {
namespace {

using testing::Ge;
using testing::Le;

constexpr std::uint64_t kMebibyte = std::uint64_t{1} << 20;

class FolderUseTest : public testing::Test {
 protected:
  FolderUseTest() : folder_(open_folder_in(AT_FDCWD, scratch_.path().c_str())) {}
  void TearDown() override { close(folder_); }
  FolderUse use(const FolderLimits& limits = {}) const { return folder_use(folder_, limits); }

  const ScratchFolder scratch_;
  const int folder_;
};

TEST_F(FolderUseTest, CountsFilesFoldersAndBytes) {
  EXPECT_EQ(use().files, 0U);
  EXPECT_EQ(use().bytes, 0U);
  scratch_.write("file", std::string(100'000, 'x'));
  scratch_.write("a/b/file", std::string(50'000, 'x'));
  const FolderUse all = use();
  EXPECT_EQ(all.files, 4U) << "two files, two folders";
  EXPECT_EQ(all.depth, 3U);
  EXPECT_THAT(all.bytes, testing::AllOf(Ge(150'000U), Le(150'000U + 3 * 4096U)));
  EXPECT_EQ(use().bytes, all.bytes) << "counted again, it is the same";
}

TEST_F(FolderUseTest, LinksAreNotFollowedAndNamesOfOneFileCountItOnce) {
  const ScratchFolder other;
  other.write("large", std::string(kMebibyte, 'x'));
  ASSERT_EQ(symlink(other.path().c_str(), (scratch_ / "folder").c_str()), 0);
  ASSERT_EQ(symlink((other / "large").c_str(), (scratch_ / "file").c_str()), 0);
  ASSERT_EQ(mkfifo((scratch_ / "pipe").c_str(), 0600), 0);
  EXPECT_EQ(use().files, 3U);
  EXPECT_LT(use().bytes, 4096U);
  scratch_.write("one", std::string(kMebibyte, 'x'));
  ASSERT_EQ(link((scratch_ / "one").c_str(), (scratch_ / "two").c_str()), 0);
  EXPECT_EQ(use().files, 5U);
  EXPECT_LT(use().bytes, 2 * kMebibyte);
}

TEST_F(FolderUseTest, HolesCountWithTheFilesLength) {
  const std::string name = scratch_.write("file", "");
  ASSERT_EQ(truncate(name.c_str(), 10 * kMebibyte), 0);
  EXPECT_EQ(use().bytes, 10 * kMebibyte);
}

TEST_F(FolderUseTest, LimitsAreNamed) {
  scratch_.write("a/file", std::string(3 * kMebibyte, 'x'));
  scratch_.write("b", "");
  EXPECT_EQ(excess_of(use(), {}), "");
  EXPECT_EQ(excess_of(use({.files = 2}), {.files = 2}), "made more than 2 files");
  EXPECT_EQ(excess_of(use({.files = 3}), {.files = 3}), "");
  EXPECT_EQ(excess_of(use({.depth = 1}), {.depth = 1}), "made folders more than 1 deep");
  EXPECT_EQ(excess_of(use({.bytes = 2 * kMebibyte}), {.bytes = 2 * kMebibyte}),
            "wrote more than 2 MiB into its folder");
}

TEST_F(FolderUseTest, FilesWithoutANameCountForWhoHoldsThem) {
  const std::string name = scratch_.write("file", std::string(kMebibyte, 'x'));
  const int file = open(name.c_str(), O_RDONLY);
  FolderUse before;
  add_unlinked_files(getpid(), before);
  unlink(name.c_str());
  FolderUse after;
  add_unlinked_files(getpid(), after);
  close(file);
  EXPECT_EQ(after.files, before.files + 1);
  EXPECT_EQ(after.bytes, before.bytes + kMebibyte);
  EXPECT_EQ(use().bytes, 0U);
}

// A process with so much memory, and its parent.
class LargeProcess {
 public:
  explicit LargeProcess(std::size_t bytes)
      : warden_([bytes](pid_t) {
          void* room = mmap(nullptr, bytes, PROT_READ | PROT_WRITE,
                            MAP_PRIVATE | MAP_ANONYMOUS | MAP_POPULATE, -1, 0);
          std::memset(room, 1, bytes);
          for (;;) pause();
        }) {
    while (resident_bytes(warden_.program()) < bytes) usleep(1000);
  }
  pid_t parent() const { return warden_.process(); }

 private:
  Warden warden_;
};

TEST_F(FolderUseTest, MemoryIsThatOfTheRunsProgramsTogether) {
  // What a copy of this process has beside is no more than this.
  const std::uint64_t own = resident_bytes(getpid());
  const std::uint64_t each = 60 * kMebibyte + own;
  const LargeProcess one(each);
  const LargeProcess two(each);
  auto run = std::make_shared<RunUse>(each + own + 30 * kMebibyte);
  ProgramUse first(dup(folder_), one.parent(), {}, run);
  EXPECT_EQ(first.excess(), "");
  EXPECT_EQ(first.excess(), "") << "it is not counted twice";
  EXPECT_THAT(run->memory(), testing::AllOf(Ge(each), Le(each + own)));
  {
    ProgramUse second(dup(folder_), two.parent(), {}, run);
    EXPECT_EQ(second.excess(), run->memory_excess());
  }
  EXPECT_EQ(first.excess(), "") << "the other has ended";
}

}  // namespace
}  // namespace simbench::processes
