// `simbench inspect` and `simbench export` through the real program.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
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

// The proposed command, as a shell takes it.
class NextCommand : public InspectCommand {
 protected:
  ProgramResult proposed(const ProgramResult& inspected) const {
    const std::size_t at = inspected.out.find("Next: simbench ");
    if (at == std::string::npos) return {};
    const std::string line = inspected.out.substr(at + 6, inspected.out.find('\n', at) - at - 6);
    file("next.sh",
         "simbench() { '" SIMBENCH_PROGRAM "' \"$@\"; }\n" + line + " > next.txt 2>&1\n");
    const std::string shell = "cd '" + folder().string() + "' && sh next.sh";
    return {.status = std::system(shell.c_str()), .out = content("next.txt"), .err = line};
  }
};

TEST_F(NextCommand, RepeatsFilesAndOptionsAndWorks) {
  std::string stamps = "#timestamp [ns]\n";
  for (int i = 0; i < 400; ++i)
    stamps += std::to_string(1'403'636'579'763'555'584 + i * 50'000'000L) + "\n";
  std::filesystem::create_directories(folder() / "cam0");
  std::filesystem::create_directories(folder() / "cam 1");
  file("cam0/data.csv", stamps);
  file("cam 1/data.csv", stamps);
  const ProgramResult found = run({"inspect", "cam0/data.csv", "cam 1/data.csv", "--columns",
                                   "sensor=#timestamp [ns]:ns,arrival=#timestamp [ns]:ns"});
  EXPECT_EQ(found.status, 0);
  EXPECT_THAT(found.out, HasSubstr("cam0/data  frame"));
  EXPECT_THAT(found.out, HasSubstr("cam 1/data  frame"));
  EXPECT_THAT(found.out, HasSubstr("there is one clock only"));
  const ProgramResult next = proposed(found);
  EXPECT_EQ(next.status, 0) << next.err;
  EXPECT_THAT(next.err, HasSubstr("cam0/data.csv"));
  EXPECT_THAT(next.out, HasSubstr("cam0/data"));
  EXPECT_THAT(next.out, HasSubstr("cam 1/data"));
  EXPECT_EQ(found.out.find("Next: ", found.out.find("Next: ") + 1), std::string::npos);
}

TEST_F(NextCommand, RepeatsTopicsAndLeavesOutWhatHasNone) {
  for (const char* const name : {"a.bag", "b.bag"}) {
    bags::RosbagWriter writer(bags::RosbagWriter::Chunks::kNone);
    const auto topic = writer.add_topic("/my/stamps", "my_msgs/Stamps");
    for (int i = 0; i < 50; ++i) {
      const auto at = std::chrono::milliseconds(100'000 + 33 * i);
      writer.add_message(topic, at, bags::ros1_header(static_cast<std::uint32_t>(i), at, "x"));
    }
    file(name, writer.bag());
  }
  const ProgramResult found = run({"inspect", "a.bag", "b.bag", "--topics", "/my/stamps"});
  const ProgramResult next = proposed(found);
  EXPECT_EQ(next.err, "simbench diagnose a.bag b.bag --topics /my/stamps");
  EXPECT_EQ(next.status, 0) << next.out;
  EXPECT_EQ(proposed(run({"inspect", bag(0), "a.bag"})).err, "simbench diagnose " + bag(0));
}

TEST_F(InspectCommand, ProgressIsInTheUnitOfTheWhole) {
  std::string text = "Stream Type,Index,F#,HW Timestamp (ms),Host Timestamp(ms)\n";
  for (int i = 0; i < 60'000; ++i) {
    const std::string ms = std::to_string(33 * i);
    text += "Depth,0," + std::to_string(i) + "," + ms + ".000," + ms + ".500\n";
  }
  ASSERT_GT(text.size(), 1'000'000U);
  file("large.csv", text);
  for (const char* const command : {"inspect", "diagnose"}) {
    const ProgramResult found = run({command, "large.csv"});
    EXPECT_THAT(found.err,
                testing::ContainsRegex("^[0-2]\\.[0-9][0-9] of [12]\\.[0-9][0-9] MB \\("));
    EXPECT_THAT(found.err, testing::Not(HasSubstr("megabyte")));
  }
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
