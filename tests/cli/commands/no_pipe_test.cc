// Where a recording is meant, what is no file is refused, and not waited for.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "tests/cli/program.h"

namespace simbench {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using Words = std::vector<std::string>;

class NoPipe : public ProgramTest {
 protected:
  void SetUp() override {
    for (const char* const name : {"pipe", "x.timestamps.ssv", "x.frameData.bin"}) {
      ASSERT_EQ(mkfifo((folder() / name).c_str(), 0600), 0);
    }
  }
};

TEST_F(NoPipe, IsTakenWhereARecordingIsMeant) {
  const std::vector<Words> lines = {{"inspect", "pipe"},
                                    {"inspect", "pipe", "--columns", "sensor=a,arrival=b"},
                                    {"diagnose", "pipe"},
                                    {"replay", "pipe"},
                                    {"export", "pipe"},
                                    {"fit", "pipe", "-o", "m.json"},
                                    {"figure", "phases", "pipe", "-o", "p.csv"},
                                    {"inspect", "x.timestamps.ssv"},
                                    {"convert-ibl", "x.frameData.bin"}};
  for (const Words& words : lines) {
    SCOPED_TRACE(testing::PrintToString(words));
    const ProgramResult result = run(words);
    EXPECT_EQ(result.status, 2);
    EXPECT_THAT(result.err, HasSubstr("it is a pipe; allowed: a file"));
  }
}

TEST_F(NoPipe, NorInAFolderOfARecording) {
  fs::create_directory(folder() / "rosbag2");
  fs::create_directory(folder() / "monday");
  ASSERT_EQ(mkfifo((folder() / "rosbag2/rig_0.mcap").c_str(), 0600), 0);
  ASSERT_EQ(mkfifo((folder() / "monday/manifest.json").c_str(), 0600), 0);
  for (const char* const name : {"rosbag2", "monday"}) {
    const ProgramResult result = run({"diagnose", name});
    EXPECT_EQ(result.status, 2);
    EXPECT_THAT(result.err, HasSubstr("it is a pipe; allowed: a file"));
  }
}

TEST_F(NoPipe, NorASocketOrADevice) {
  const int made = socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un address{.sun_family = AF_UNIX, .sun_path = {}};
  const std::string path = folder() / "s";
  ASSERT_LT(path.size(), sizeof address.sun_path);
  path.copy(address.sun_path, path.size());
  ASSERT_EQ(bind(made, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  EXPECT_THAT(run({"inspect", "s"}).err, HasSubstr("it is a socket; allowed: a file"));
  EXPECT_THAT(run({"inspect", "/dev/zero"}).err, HasSubstr("it is a device"));
  close(made);
}

TEST_F(NoPipe, ButLogsAndScenariosMayComeThroughOne) {
  const auto through_pipe = [&](const Words& words, const std::string& text) {
    const std::jthread writer([&] { put(folder() / "pipe", text); });
    return run(words).status;
  };
  std::string log = "seconds,error_ns\n";
  for (int i = 0; i < 100; ++i) {
    log += std::to_string(i) + "," + std::to_string(i % 7) + "\n";
  }
  EXPECT_EQ(through_pipe({"stability", "pipe"}, log), 0);
  EXPECT_EQ(through_pipe({"validate", "pipe"},
                         R"({"name": "a", "summary": "a", "base": "6cam_2host_30fps"})"),
            0);
}

}  // namespace
}  // namespace simbench
