#include "bags/fields.h"

#include <gmock/gmock.h>

#include "tests/bags/bag_writers.h"

namespace simbench::bags {
namespace {

TEST(Fields, ReadsAHeaderOfRos1) {
  const std::string bytes = ros1_header(7, 3'000'000'000U, 500, "left") + bytes_of(9, 4);
  FieldBytes fields(bytes, Encoding::kRos1);
  const MessageHeader header = read_header(fields);
  EXPECT_TRUE(fields.ok());
  EXPECT_EQ(header.sequence, 7U);
  EXPECT_EQ(header.stamp.count(), 3'000'000'000LL * 1'000'000'000 + 500);
  EXPECT_EQ(header.frame, "left");
  EXPECT_EQ(fields.u32(), 9U);
}

TEST(Fields, ReadsAHeaderOfCdrAndAlignsWhatFollows) {
  // The text of "left" and its zero end at byte 4 + 8 + 4 + 5, so the next number is 3 bytes on.
  const std::string bytes = cdr_header(2, 5, "left") + std::string(3, 'x') + bytes_of(9, 4);
  FieldBytes fields(bytes, Encoding::kCdr);
  const MessageHeader header = read_header(fields);
  EXPECT_EQ(header.sequence, std::nullopt);
  EXPECT_EQ(header.stamp.count(), 2'000'000'005);
  EXPECT_EQ(header.frame, "left");
  EXPECT_EQ(fields.u32(), 9U);
  EXPECT_TRUE(fields.ok());
}

TEST(Fields, ReadsBigEndianCdr) {
  const std::string bytes("\0\0\0\0\x01\0\0\0\0\0\0\0\x01\x02\x03\x04\x05\x06\x07\x08", 20);
  FieldBytes fields(bytes, Encoding::kCdr);
  EXPECT_EQ(fields.u8(), 1U);
  EXPECT_EQ(fields.u64(), 0x0102030405060708U);
  EXPECT_TRUE(fields.ok());
}

TEST(Fields, SecondsBeforeTheEpochAreNegativeInRos2) {
  const std::string bytes = cdr_header(0xffffffffU, 0, "");
  FieldBytes fields(bytes, Encoding::kCdr);
  EXPECT_EQ(read_header(fields).stamp.count(), -1'000'000'000);
}

TEST(Fields, EveryCutIsSeen) {
  for (const Encoding encoding : {Encoding::kRos1, Encoding::kCdr}) {
    const std::string bytes =
        encoding == Encoding::kRos1 ? ros1_header(1, 2, 3, "frame") : cdr_header(2, 3, "frame");
    for (std::size_t size = 0; size <= bytes.size(); ++size) {
      FieldBytes fields(std::string_view(bytes).substr(0, size), encoding);
      const MessageHeader header = read_header(fields);
      EXPECT_EQ(fields.ok(), size == bytes.size()) << size;
      EXPECT_TRUE(std::string_view("frame").starts_with(header.frame.substr(0, 5))) << size;
    }
  }
}

}  // namespace
}  // namespace simbench::bags
