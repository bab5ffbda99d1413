#include "recording/distrusted_folder.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <string>

#include "tests/scratch_folder.h"

namespace simbench {
namespace {

TEST(DistrustedFolder, AFileAndAFolderWithItsFilesAreRemoved) {
  const ScratchFolder scratch;
  EXPECT_TRUE(remove_tree(scratch.write("file", "text")));
  scratch.write("folder/sub/file", "text");
  scratch.write("folder/other", "text");
  EXPECT_TRUE(remove_tree(scratch / "folder"));
  EXPECT_THAT(scratch.names(), testing::IsEmpty());
  EXPECT_TRUE(remove_tree(scratch / "folder")) << "nothing is left of what was not there";
}

TEST(DistrustedFolder, LinksAreRemovedAndNotFollowed) {
  const ScratchFolder kept;
  const ScratchFolder scratch;
  kept.write("file", "text");
  scratch.write("folder/file", "text");
  ASSERT_EQ(symlink(kept.path().c_str(), (scratch / "folder/link").c_str()), 0);
  ASSERT_EQ(symlink(kept.path().c_str(), (scratch / "link").c_str()), 0);
  ASSERT_EQ(mkfifo((scratch / "folder/pipe").c_str(), 0600), 0);
  EXPECT_EQ(open_folder_in(AT_FDCWD, (scratch / "link").c_str()), -1);
  EXPECT_EQ(errno, ENOTDIR);
  EXPECT_TRUE(remove_tree(scratch / "folder"));
  EXPECT_TRUE(remove_tree(scratch / "link"));
  EXPECT_EQ(kept.content("file"), "text");
}

// In a child, which has few descriptors: more folders than these, in a path longer than any name.
TEST(DistrustedFolder, DepthIsNoLimit) {
  const ScratchFolder scratch;
  const std::string top = scratch / "folder";
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    if (mkdir(top.c_str(), 0700) != 0 || chdir(top.c_str()) != 0) _exit(2);
    const std::string name(200, 'd');
    for (int i = 0; i < 300; ++i) {
      if (mkdir(name.c_str(), 0700) != 0 || chdir(name.c_str()) != 0) _exit(3);
    }
    const rlimit few{.rlim_cur = 100, .rlim_max = 100};
    setrlimit(RLIMIT_NOFILE, &few);
    _exit(chdir("/") == 0 && remove_tree(top) ? 0 : 1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
  EXPECT_THAT(scratch.names(), testing::IsEmpty());
}

// As another user than root, where there is one to be.
TEST(DistrustedFolder, RightsThatTheOwnerTookAwayComeBack) {
  const ScratchFolder scratch;
  const std::string top = scratch / "folder";
  ASSERT_EQ(chmod(scratch.path().c_str(), 0777), 0);
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    if (geteuid() == 0 && setuid(65534) != 0) _exit(4);
    if (mkdir(top.c_str(), 0700) != 0 || mkdir((top + "/sub").c_str(), 0700) != 0) _exit(2);
    if (close(creat((top + "/sub/file").c_str(), 0)) != 0) _exit(3);
    if (chmod((top + "/sub").c_str(), 0) != 0 || chmod(top.c_str(), 0300) != 0) _exit(3);
    _exit(remove_tree(top) ? 0 : 1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
  EXPECT_THAT(scratch.names(), testing::IsEmpty());
}

}  // namespace
}  // namespace simbench
