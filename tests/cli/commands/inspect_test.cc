// `simbench inspect` and `simbench export` through the real program.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/bags/rosbag_writer.h"
#include "tests/cli/program.h"
#include "tests/data/test_data.h"

namespace simbench {
namespace {

using testing::HasSubstr;

class InspectCommand : public ProgramTest {};
class ExportCommand : public ProgramTest {};

std::string bag(int camera) {
  return test_data_path("realsense_bag/camera" + std::to_string(camera) + ".bag");
}

TEST_F(InspectCommand, SaysWhatABagHas) {
  const ProgramResult found = run({"inspect", bag(0)});
  EXPECT_EQ(found.status, 0);
  EXPECT_THAT(found.out, HasSubstr("serial number 018322070001"));
  EXPECT_THAT(found.out, HasSubstr("SENSOR_TIMESTAMP"));
  EXPECT_THAT(found.out, HasSubstr("and 16 topics with one or two messages"));
  const auto json = nlohmann::json::parse(run({"inspect", bag(1), "--format", "json"}).out);
  const auto& file = json["files"][0];
  EXPECT_EQ(file["closed"], true);
  EXPECT_EQ(file["lost_messages"], 0);
  EXPECT_EQ(file["streams"].size(), 2U);
  EXPECT_EQ(file["streams"][0]["lost_frames"], 6);
  EXPECT_EQ(file["topics"].size(), 20U);
}

TEST_F(InspectCommand, ABagIsKnownByItsContent) {
  std::filesystem::copy(bag(0), folder() / "camera.csv");
  EXPECT_THAT(run({"inspect", "camera.csv"}).out, HasSubstr("rosbag 2.0"));
  const ProgramResult diagnosis = run({"diagnose", "camera.csv"});
  EXPECT_EQ(diagnosis.status, 0);
  EXPECT_THAT(diagnosis.out, HasSubstr("one camera alone"));
}

TEST_F(InspectCommand, UnknownTopicsAreProposed) {
  bags::RosbagWriter writer(bags::RosbagWriter::Chunks::kLz4);
  const auto topic = writer.add_topic("/my/stamps", "my_msgs/Stamps");
  for (int i = 0; i < 5; ++i) {
    writer.add_message(topic, std::chrono::seconds(i),
                       bags::ros1_header(1, std::chrono::seconds(100 + i), "x"));
  }
  file("x.bag", writer.bag());
  EXPECT_THAT(run({"inspect", "x.bag"}).out,
              HasSubstr("simbench diagnose x.bag --topics\n/my/stamps"));
  const ProgramResult refused = run({"diagnose", "x.bag"});
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.err, HasSubstr("/my/stamps (my_msgs/Stamps)"));
}

TEST_F(ExportCommand, SetsNameFileTopicAndMessage) {
  const ProgramResult sets = run({"export", bag(0), bag(1), "--complete"});
  EXPECT_EQ(sets.status, 0);
  EXPECT_THAT(sets.out, HasSubstr("set,complete,camera,stream,file,topic,message,"));
  EXPECT_THAT(sets.out, HasSubstr("camera1.bag,/device_0/sensor_0/Depth_0/image/data,0,1,"));
  EXPECT_THAT(sets.err, HasSubstr("of Depth 0 by regression_30 and yoon2021"));
  // camera1 lacks six depth frames; no set can have more than it has.
  const auto lines = std::count(sets.out.begin(), sets.out.end(), '\n');
  EXPECT_GT(lines, 2 * 500);
  EXPECT_LE(lines, 2 * 594 + 1);
  const ProgramResult refused = run({"export", bag(0), "--gathering", "none"});
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.err, HasSubstr("--gathering: found 'none', allowed"));
}

}  // namespace
}  // namespace simbench
