#include "sim/programs/find_program.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "sim/programs/program_file.h"
#include "tests/scratch_folder.h"

namespace simbench::sim {
namespace {

using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;

class FindProgramTest : public testing::Test {
 protected:
  void TearDown() override { unsetenv(kProgramsVariable); }

  std::string copy_of_a_program(const std::string& name) const {
    std::string path = folder_ / name;
    std::filesystem::create_directories(std::filesystem::path(path).parent_path());
    std::filesystem::copy_file(std::string(SIMBENCH_PROGRAMS) + "/simbench_cristian", path);
    return path;
  }
  static std::string refusal(const std::string& word, const std::string& packages = "") {
    try {
      find_program(word, packages);
    } catch (const ProgramError& error) {
      return error.what();
    }
    return "none";
  }

  const ScratchFolder folder_;
};

TEST_F(FindProgramTest, ASlashIsAnAbsolutePath) {
  const std::string path = copy_of_a_program("daemon");
  EXPECT_THAT(find_program(path).words, ElementsAre(path));
  for (const char* word : {"./daemon", "../daemon", "bin/daemon"}) {
    EXPECT_EQ(refusal(word), std::string("found \"") + word +
                                 "\", a relative path; write an absolute one or a bare name");
  }
  EXPECT_EQ(refusal(""), "a command without a program");
}

TEST_F(FindProgramTest, OwnFoldersComeBeforePackagesAndThoseBeforeTheSystem) {
  EXPECT_THAT(find_program("env").words, ElementsAre(EndsWith("/bin/env")));
  const std::string packages = folder_ / "packages";
  const std::string unpacked = copy_of_a_program("packages/usr/sbin/env");
  EXPECT_THAT(find_program("env", packages).words, ElementsAre(unpacked));
  EXPECT_THAT(find_program("env", packages + "/").words, ElementsAre(unpacked));
  const std::string apart = copy_of_a_program("packages/apart/daemon/usr/sbin/daemon");
  EXPECT_THAT(find_program("daemon", packages).words, ElementsAre(apart));
  const std::string own = copy_of_a_program("second/env");
  setenv(kProgramsVariable, ((folder_ / "first") + "::" + (folder_ / "second")).c_str(), 1);
  EXPECT_THAT(find_program("env", packages).words, ElementsAre(own));
  setenv(kProgramsVariable, "second", 1);
  EXPECT_EQ(refusal("env"),
            "SIMBENCH_PROGRAMS has \"second\", a relative path; write an absolute one");
}

TEST_F(FindProgramTest, UnpackedProgramsHaveTheirLibraries) {
  const std::string packages = folder_ / "packages";
  copy_of_a_program("packages/usr/sbin/daemon");
  EXPECT_EQ(find_program("daemon", packages).library_path, "");
#ifdef __x86_64__
  std::filesystem::create_directories(packages + "/usr/lib/x86_64-linux-gnu");
  std::filesystem::create_directories(packages + "/lib/x86_64-linux-gnu");
  EXPECT_EQ(find_program("daemon", packages).library_path,
            packages + "/usr/lib/x86_64-linux-gnu:" + packages + "/lib/x86_64-linux-gnu");
#endif
  EXPECT_EQ(find_program("env", packages).library_path, "") << "the system's own";
}

TEST_F(FindProgramTest, AMissingProgramNamesItsPackage) {
  EXPECT_EQ(refusal("no_such_daemon"),
            "no_such_daemon is not there; write its absolute path, or put its folder into "
            "SIMBENCH_PROGRAMS");
  if (refusal("ptp4l") == "none") GTEST_SKIP() << "ptp4l is installed";
  EXPECT_EQ(refusal("ptp4l"),
            "ptp4l is not there; it is in the Debian package linuxptp (apt install linuxptp; in a "
            "clone of simbench, tools/setup --with-programs unpacks it for simbench alone)");
}

TEST_F(FindProgramTest, WhatIsFoundIsLookedAt) {
  const std::string path = copy_of_a_program("daemon");
  chmod(path.c_str(), 0644);
  EXPECT_EQ(refusal(path), path + ": is not executable");
  folder_.write("script", "#!/usr/bin/env no_such_language\n");
  chmod((folder_ / "script").c_str(), 0755);
  EXPECT_THAT(refusal(folder_ / "script"), HasSubstr("its interpreter: no_such_language is not"));
}

}  // namespace
}  // namespace simbench::sim
