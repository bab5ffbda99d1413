#include "app/host_logs.h"

#include <gmock/gmock.h>

#include <string>

#include "recording/temporary_folder.h"
#include "reports/text/output_file.h"
#include "scenarios/loader.h"

namespace simbench::app {
namespace {

using testing::HasSubstr;
using testing::SizeIs;

class HostLogFiles : public testing::Test {
 protected:
  std::string file(const std::string& name, const std::string& text) const {
    const std::string path = folder_.file(name);
    reports::write_file(path, text);
    return path;
  }

  TemporaryFolder folder_;
};

TEST_F(HostLogFiles, EachSeriesIsALog) {
  std::string text;
  for (int i = 0; i < 20; ++i) {
    const std::string at = std::to_string(100 + i);
    text += "ptp4l[" + at + ".0]: [eth0] master offset 10 s2 freq +1 path delay 100\n";
    text += "ptp4l[" + at + ".1]: [eth1] master offset 20 s2 freq +1 path delay 100\n";
  }
  const HostLogs found = host_logs({"left=" + file("two.log", text)});
  ASSERT_THAT(found.logs, SizeIs(2));
  EXPECT_EQ(found.logs[0].host, "left");
  EXPECT_NEAR(found.logs[0].log.points.front().error_s, 10e-9, 1e-15);
  EXPECT_NEAR(found.logs[1].log.points.front().error_s, 20e-9, 1e-15);
}

TEST_F(HostLogFiles, ATableIsOneLog) {
  std::string text = "time_s,offset_ns\n";
  for (int i = 0; i < 20; ++i) text += std::to_string(i) + ",12\n";
  const HostLogs found = host_logs({file("a=b.csv", text)});
  ASSERT_THAT(found.logs, SizeIs(1)) << "a file's name may have an equals sign";
  EXPECT_EQ(found.logs[0].host, "");
}

TEST_F(HostLogFiles, AnAbsentFileIsNamed) {
  try {
    host_logs({"left=absent.log"});
    ADD_FAILURE() << "no such file";
  } catch (const scenarios::InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("absent.log"));
  }
}

}  // namespace
}  // namespace simbench::app
