#include "recording/disposable.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <stdexcept>
#include <string>
#include <thread>

#include "recording/temporary_folder.h"
#include "tests/scratch_folder.h"

namespace simbench {
namespace {

namespace fs = std::filesystem;

// Makes a folder with a file in it.
fs::path make_in(const ScratchFolder& scratch, const std::string& name) {
  scratch.write(name + "/file", "text");
  return scratch / name;
}

TEST(Disposable, IsRemovedWithAllThatIsInIt) {
  const ScratchFolder scratch;
  {
    const Disposable folder([&] { return make_in(scratch, "folder"); });
    folder.change([&] { put(folder.path() / "second", ""); });
    EXPECT_TRUE(fs::exists(scratch / "folder/second"));
  }
  EXPECT_FALSE(fs::exists(scratch / "folder"));
}

TEST(Disposable, WhatIsKeptStays) {
  const ScratchFolder scratch;
  {
    Disposable folder([&] { return make_in(scratch, "folder"); });
    EXPECT_THROW(folder.keep([] { throw std::runtime_error("no"); }), std::runtime_error);
    folder.keep([&] { fs::rename(folder.path(), scratch / "kept"); });
    make_in(scratch, "folder");  // somebody else's, by then
  }
  EXPECT_TRUE(fs::exists(scratch / "kept/file"));
  EXPECT_TRUE(fs::exists(scratch / "folder"));
}

TEST(DisposableDeathTest, AProgramThatEndsInHasteLeavesNothing) {
  const ScratchFolder scratch;
  const auto end_in_haste = [&] {
    const Disposable folder([&] { return make_in(scratch, "folder"); });
    const TemporaryFolder temporary;
    put(scratch / "name", temporary.path());
    dispose_of_all();
    // From now on nothing is made.
    std::thread([&] { Disposable([&] { return make_in(scratch, "late"); }); }).detach();
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    _exit(7);
  };
  EXPECT_EXIT(end_in_haste(), testing::ExitedWithCode(7), "");
  EXPECT_FALSE(fs::exists(scratch / "folder"));
  EXPECT_FALSE(fs::exists(scratch / "late"));
  EXPECT_FALSE(fs::exists(scratch.content("name")));
}

}  // namespace
}  // namespace simbench
