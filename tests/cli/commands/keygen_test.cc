// `simbench keygen`: the key of a rig, and that it is not overwritten.
#include <gmock/gmock.h>
#include <sys/stat.h>

#include "tests/cli/program.h"

namespace simbench {
namespace {

using testing::HasSubstr;
using testing::MatchesRegex;

class Keygen : public ProgramTest {};

TEST_F(Keygen, WritesAKeyThatOnlyItsOwnerReads) {
  const ProgramResult result = run({"keygen", "rig.key"});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("rig.key: a new key, readable by you only"));
  EXPECT_THAT(result.out, HasSubstr("--key-file"));
  EXPECT_THAT(content("rig.key"), MatchesRegex("[0-9a-f]{64}\n"));
  struct stat found {};
  ASSERT_EQ(stat((folder() / "rig.key").c_str(), &found), 0);
  EXPECT_EQ(found.st_mode & 07777u, 0600u);
}

TEST_F(Keygen, EveryKeyIsAnother) {
  run({"keygen", "a.key"});
  run({"keygen", "b.key"});
  EXPECT_NE(content("a.key"), content("b.key"));
}

TEST_F(Keygen, DoesNotOverwrite) {
  file("rig.key", "precious\n");
  const ProgramResult result = run({"keygen", "rig.key"});
  EXPECT_EQ(result.status, 2);
  EXPECT_EQ(
      result.err,
      "error: rig.key: found a file there already, and a key is not overwritten; name another, "
      "or remove it first\n");
  EXPECT_EQ(content("rig.key"), "precious\n");
}

TEST_F(Keygen, SaysWhyItCannotWrite) {
  const ProgramResult result = run({"keygen", "nowhere/rig.key"});
  EXPECT_EQ(result.status, 2);
  EXPECT_EQ(result.err, "error: nowhere/rig.key: No such file or directory\n");
}

TEST_F(Keygen, LeavesNoHalfOfAKeyOnAFullDisk) {
  const ProgramResult result = run({"keygen", "rig.key"}, {.largest_file = 10});
  EXPECT_EQ(result.status, 2);
  EXPECT_EQ(result.err, "error: rig") << "what the same limit leaves of the message";
  EXPECT_TRUE(names_in().empty());
}

}  // namespace
}  // namespace simbench
