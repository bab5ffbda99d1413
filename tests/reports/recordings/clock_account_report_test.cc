#include "reports/recordings/clock_account_report.h"

#include <gmock/gmock.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/evaluation/diagnosis/clocked_rig.h"

namespace simbench::reports {
namespace {

using evaluation::ClockAccount;
using evaluation::ClockErrorS;
using evaluation::HostLog;
using evaluation::rig_log;
using evaluation::rig_recording;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

// Host A is set by -250 ms; camera z of host B starts its frames 5.2 ms later.
ClockAccount account_of_rig() {
  const ClockErrorS step = evaluation::step_at(41.2, -0.25);
  const std::vector<RecordedStream> streams = {
      rig_recording({.name = "x", .host = "A", .error_s = step}),
      rig_recording({.name = "y", .host = "A", .error_s = step}),
      rig_recording({.name = "z", .host = "B", .phase_ms = 5.2})};
  const std::vector<HostLog> logs = {{"A", rig_log({.file = "a.log", .error_s = step})},
                                     {"B", rig_log({.file = "b.log"})},
                                     {"C", rig_log({.file = "c.log"})}};
  return evaluation::clock_account(streams, logs);
}

std::string text_of_clock_blocks(const std::vector<Block>& blocks) {
  return plain(Document{.title = "clocks", .blocks = blocks});
}

TEST(ClockAccountReport, BlocksHaveLogsAndParts) {
  const std::vector<Block> blocks = clock_account_blocks(account_of_rig());
  ASSERT_THAT(blocks, SizeIs(4));
  const std::string text = text_of_clock_blocks(blocks);
  EXPECT_THAT(text, HasSubstr("a.log"));
  EXPECT_THAT(text, HasSubstr("clocks of the hosts"));
  EXPECT_THAT(text, HasSubstr("The widest pair: z against x"));
  EXPECT_THAT(text, HasSubstr("unknown"));
}

TEST(ClockAccountReport, WithoutLogsThereIsNone) {
  EXPECT_THAT(clock_account_blocks({}), IsEmpty());
}

TEST(ClockAccountReport, JsonHasWhatTheBlocksHave) {
  const Json root = Json::parse(clock_account_json(account_of_rig()).dump());
  ASSERT_EQ(root["hosts"].size(), 3U);
  EXPECT_EQ(root["hosts"][0]["placed"], "as_is");
  EXPECT_TRUE(root["hosts"][2]["host"].is_null());
  EXPECT_TRUE(root["hosts"][2]["placed"].is_null());
  EXPECT_NEAR(root["hosts"][0]["changes"][0]["by_ms"].get<double>(), -250, 0.1);
  EXPECT_EQ(root["jumps"][0]["file"], "a.log");
  EXPECT_NEAR(root["jumps"][0]["log_step_ms"].get<double>(), -250, 0.1);
  EXPECT_EQ(root["explained"].size(), 3U);
  ASSERT_EQ(root["spread"].size(), 2U);
  EXPECT_TRUE(root["spread"][1]["parts"]["exposure"]["rms_ms"].is_null());
  EXPECT_GT(root["spread"][1]["parts"]["host_clock"]["rms_ms"].get<double>(), 100);
  EXPECT_EQ(root["findings"][0]["kind"], "host_clock_step");
}

}  // namespace
}  // namespace simbench::reports
