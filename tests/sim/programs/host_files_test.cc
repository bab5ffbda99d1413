#include "sim/programs/host_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <utime.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "scenarios/loader.h"
#include "shim/protocol.h"
#include "sim/programs/kernel_clock.h"
#include "tests/scratch_folder.h"
#include "tests/sim/host/service_world.h"

namespace simbench::sim {
namespace {

constexpr std::int64_t kASecond_ns = 1'000'000'000;

std::int64_t modified_ns(const std::string& path) {
  struct stat status {};
  lstat(path.c_str(), &status);
  return status.st_mtim.tv_sec * kASecond_ns + status.st_mtim.tv_nsec;
}

class HostFilesTest : public testing::Test {
 protected:
  std::int64_t host_now() { return epoch_ns(world_.clock(1).read(world_.now())); }

  ServiceWorld world_{scenarios::load_scenario("6host_star")};
  const ScratchFolder folder_;
  HostFiles files_{world_.host(1), folder_.path().string()};
};

TEST(FileTimes, AreTheMachinesBetweenTheFoldersBirthAndTheLastChange) {
  EXPECT_FALSE(shim::is_of_machine(100, 99, 200)) << "a program said so";
  EXPECT_TRUE(shim::is_of_machine(100, 100, 200));
  EXPECT_TRUE(shim::is_of_machine(100, 200, 200));
  EXPECT_FALSE(shim::is_of_machine(100, 201, 200)) << "the world's, which is ahead";
  EXPECT_TRUE(shim::is_of_host(100, 100));
  EXPECT_FALSE(shim::is_of_host(100, 99));
}

TEST_F(HostFilesTest, NumbersComeInTheOrderOfTheFirstLooks) {
  EXPECT_EQ(files_.look({.device = 1, .file = 7}).number, 1);
  EXPECT_EQ(files_.look({.device = 1, .file = 5}).number, 2);
  EXPECT_EQ(files_.look({.device = 2, .file = 7}).number, 3);
  EXPECT_EQ(files_.look({.device = 1, .file = 7}).number, 1);
  EXPECT_EQ(files_.look({.device = 1, .file = 7, .born = 3}).number, 4) << "its number is reused";
}

TEST_F(HostFilesTest, AFileThatWasMadeIsNoneThatWasThere) {
  EXPECT_EQ(files_.look({.file = 7, .born = 3}).number, 1);
  EXPECT_EQ(files_.look({.file = 7, .born = 3, .is_new = 1}).number, 2) << "born in the same tick";
  EXPECT_EQ(files_.look({.file = 7, .born = 3}).number, 2);
  EXPECT_EQ(files_.look({.file = 8, .is_new = 1}).number, 3);
}

TEST_F(HostFilesTest, AFileIsFromTheFirstLookAfterItWasWrittenTo) {
  world_.run_until(10);
  const std::int64_t first = host_now();
  EXPECT_EQ(files_.look({.file = 7, .modified = 100}).modified, first);
  world_.run_until(20);
  EXPECT_EQ(files_.look({.file = 7, .modified = 100}).modified, first);
  EXPECT_EQ(files_.look({.file = 7, .modified = 101}).modified, host_now());
  EXPECT_GT(host_now(), first);
}

TEST_F(HostFilesTest, ThereIsAnEndToWhatIsKept) {
  constexpr auto kMost = static_cast<std::uint64_t>(HostFiles::kMost);
  for (std::uint64_t file = 1; file <= kMost; ++file) files_.look({.file = file});
  EXPECT_EQ(files_.look({.file = kMost + 1}).number, -1);
  EXPECT_EQ(files_.look({.file = 9, .is_new = 1}).number, -1);
  EXPECT_EQ(files_.look({.file = 9}).number, 9);
}

TEST_F(HostFilesTest, AtTheEndAllHaveTheHostsTime) {
  const ScratchFolder other;
  const std::string outside = other.write("outside", "text");
  const std::int64_t before = modified_ns(outside);
  folder_.write("log", "text");
  folder_.write("sub/drift", "text");
  const utimbuf set{.actime = 5, .modtime = 5};
  utime((folder_ / "sub/drift").c_str(), &set);
  std::filesystem::create_symlink(outside, folder_ / "link");
  std::filesystem::create_directory_symlink(other.path(), folder_ / "way");
  world_.run_until(10);
  files_.stamp_all();
  for (const char* each : {"log", "sub", "link", "way", "."}) {
    EXPECT_EQ(modified_ns(folder_ / each), host_now()) << each;
  }
  EXPECT_EQ(modified_ns(folder_ / "sub/drift"), 5 * kASecond_ns) << "as the program said";
  EXPECT_EQ(modified_ns(outside), before);
}

}  // namespace
}  // namespace simbench::sim
