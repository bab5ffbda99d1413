#include "bags/foxglove.h"

#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "bags/message_types.h"

namespace simbench::bags {
namespace {

std::optional<Nanoseconds> protobuf(const std::string& bytes) {
  return foxglove_stamp(bytes, Encoding::kProtobuf);
}
std::optional<Nanoseconds> json(const std::string& text) {
  return foxglove_stamp(text, Encoding::kJson);
}

TEST(FoxgloveStampTest, ProtobufInAnyOrderOfItsFields) {
  using std::string_literals::operator""s;
  EXPECT_EQ(protobuf("\x0a\x04\x08\x03\x10\x07"s), std::chrono::seconds(3) + Nanoseconds(7));
  EXPECT_EQ(protobuf("\x0a\x02\x10\x07"s), Nanoseconds(7));
  // Behind a number, eight bytes, four bytes and a text.
  EXPECT_EQ(protobuf("\x10\x96\x01\x19"s + std::string(8, 'x') + "\x25" + "abcd" + "\x2a\x02hi" +
                     "\x0a\x02\x08\x05"),
            std::chrono::seconds(5));
  EXPECT_EQ(protobuf(""), std::nullopt);
  EXPECT_EQ(protobuf("\x0a\x50\x08"s), std::nullopt);                      // cut off
  EXPECT_EQ(protobuf("\x0a\x06\x10\xff\xff\xff\xff\x7f"s), std::nullopt);  // no nanoseconds
  EXPECT_EQ(protobuf(std::string(20, '\xff')), std::nullopt);
}

TEST(FoxgloveStampTest, JsonThatIsCutBehindTheStamp) {
  EXPECT_EQ(json(R"({"frame_id":"a","timestamp":{"nsec":7,"sec":3},"data":"abc)"),
            std::chrono::seconds(3) + Nanoseconds(7));
  EXPECT_EQ(json(R"({"other":{"sec":1,"nsec":2},"timestamp":{"sec":5,"nsec":6}})"),
            std::chrono::seconds(5) + Nanoseconds(6));
  EXPECT_EQ(json(R"({"a":{"timestamp":{"sec":5,"nsec":6}}})"), std::nullopt);
  EXPECT_EQ(json(R"({"timestamp":{"sec":5)"), std::nullopt);
  EXPECT_EQ(json(R"({"timestamp":"2026-01-01T00:00:00Z"})"), std::nullopt);
  EXPECT_EQ(json("nonsense"), std::nullopt);
}

Headed headed(const std::string& type, const std::string& definition,
              Encoding encoding = Encoding::kCdr) {
  BagTopic topic{.type = type, .encoding = encoding};
  return headed_by(topic, definition);
}

TEST(MessageTypesTest, TheFirstFieldDecides) {
  EXPECT_EQ(headed("a/B", "# comment\n\nint32 K=1 # one\n  std_msgs/Header  header\nint8 x"),
            Headed::kYes);
  EXPECT_EQ(headed("a/B", "Header header"), Headed::kYes);
  EXPECT_EQ(headed("a/B", "float32 x\nHeader header"), Headed::kNo);
  EXPECT_EQ(headed("a/B", "#only\n====\nMSG: std_msgs/Header\nHeader header"), Headed::kNo);
  EXPECT_EQ(headed("a/B", ""), Headed::kUnknown);
  EXPECT_EQ(headed("sensor_msgs/Imu", ""), Headed::kYes);
  EXPECT_EQ(headed("geometry_msgs/PoseStamped", ""), Headed::kYes);
  EXPECT_EQ(headed("geometry_msgs/Pose", ""), Headed::kUnknown);
  EXPECT_EQ(headed("depthai_ros_msgs/TrackedFeatures", ""), Headed::kYes);
  EXPECT_EQ(headed("sensor_msgs/Image", "", Encoding::kJson), Headed::kNo);
  EXPECT_EQ(headed("foxglove.RawImage", "", Encoding::kProtobuf), Headed::kYes);
  EXPECT_EQ(headed("foxglove_msgs/RawImage", "", Encoding::kRos1), Headed::kUnknown);
}

}  // namespace
}  // namespace simbench::bags
