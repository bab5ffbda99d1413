#include "hardware/net/secret_key.h"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include <fstream>
#include <iterator>
#include <string>

#include "tests/scratch_folder.h"

namespace simbench::hardware {
namespace {

using testing::HasSubstr;

class SecretKeyFile : public testing::Test {
 protected:
  std::string path(const std::string& name = "rig.key") const { return folder_ / name; }
  void write(const std::string& text, mode_t mode = 0600) const {
    std::ofstream(path()) << text;
    chmod(path().c_str(), mode);
  }
  std::string error() const {
    try {
      SecretKey::from_file(path());
    } catch (const KeyError& error) {
      return error.what();
    }
    return "(none)";
  }

 private:
  const ScratchFolder folder_;
};

TEST_F(SecretKeyFile, IsReadAsItWasWritten) {
  write("00ff10" + std::string(58, 'a') + "\n");
  const SecretKey key = SecretKey::from_file(path());
  EXPECT_TRUE(key.is_secret());
  EXPECT_EQ(key.bytes()[0], 0x00);
  EXPECT_EQ(key.bytes()[1], 0xff);
  EXPECT_EQ(key.bytes()[2], 0x10);
  EXPECT_EQ(key.bytes()[31], 0xaa);
}

TEST_F(SecretKeyFile, IsMadeForItsOwnerAlone) {
  SecretKey::create_file(path());
  struct stat found {};
  ASSERT_EQ(stat(path().c_str(), &found), 0);
  EXPECT_EQ(found.st_mode & 07777u, 0600u);
  SecretKey::create_file(path("other"));
  EXPECT_NE(SecretKey::from_file(path()).bytes(), SecretKey::from_file(path("other")).bytes());
}

TEST_F(SecretKeyFile, IsNotOverwritten) {
  write("precious");
  EXPECT_THROW(SecretKey::create_file(path()), KeyError);
  std::ifstream file(path());
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}), "precious");
}

TEST_F(SecretKeyFile, MayNotBeReadableByOthers) {
  SecretKey::create_file(path());
  for (const mode_t mode : {0640, 0604, 0620, 0602, 0610, 0601}) {
    chmod(path().c_str(), mode);
    EXPECT_THAT(error(), HasSubstr("mend it with: chmod 600 '" + path() + "'")) << mode;
  }
  chmod(path().c_str(), 0400);
  EXPECT_EQ(error(), "(none)");
}

TEST_F(SecretKeyFile, WhatIsNoKeyIsRefused) {
  const std::string digits(64, 'a');
  for (const std::string& text :
       {std::string(), digits.substr(1), digits + "a", digits + "\n\n", digits.substr(1) + "g",
        digits.substr(1) + "\n", " " + digits.substr(1), std::string(100000, 'a')}) {
    write(text);
    EXPECT_THAT(error(), HasSubstr("found something that is no key")) << text.substr(0, 70);
  }
  write(digits);
  EXPECT_EQ(error(), "(none)");
}

TEST_F(SecretKeyFile, WhatIsNoFileIsRefusedAndNotWaitedFor) {
  EXPECT_THAT(error(), HasSubstr("simbench keygen"));
  ASSERT_EQ(mkfifo(path().c_str(), 0600), 0);
  EXPECT_THAT(error(), HasSubstr("no regular file"));
}

TEST(SecretKey, WhoHasNoneHasTheOneThatEverybodyKnows) {
  EXPECT_FALSE(SecretKey().is_secret());
  EXPECT_EQ(SecretKey().bytes(), SecretKey().bytes());
}

}  // namespace
}  // namespace simbench::hardware
