#include "algorithms/host_sync/yoon2021/wire.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <vector>

#include "tests/nonempty.h"

namespace simbench {
namespace {

std::vector<SessionMessage> one_of_each_kind() {
  const HostTime time{Nanoseconds{1'637'449'200'123'456'789}};
  return {{MessageKind::kReady, 1, 0, HostTime{}},
          {MessageKind::kStamp, 2, 99, time},
          {MessageKind::kRequest, 3, 7, HostTime{}},
          {MessageKind::kMeasured, 4, 0, HostTime{}},
          {MessageKind::kSetTime, 5, 0, HostTime{Nanoseconds{-1}}},
          {MessageKind::kSlaveTime, std::numeric_limits<std::uint32_t>::max(), 0, time},
          {MessageKind::kSuccess, 200, 0, HostTime{}},
          {MessageKind::kGiveUp, 200, 0, HostTime{}}};
}

TEST(Wire, EveryKindComesBackAsItWas) {
  for (const SessionMessage& message : nonempty(one_of_each_kind())) {
    const Bytes bytes = encode(message);
    ASSERT_EQ(bytes.size(), kSessionMessageBytes);
    const auto decoded = decode_session_message(bytes);
    ASSERT_TRUE(decoded) << "kind " << static_cast<int>(message.kind);
    EXPECT_EQ(*decoded, message) << "kind " << static_cast<int>(message.kind);
  }
}

TEST(Wire, TheBytesAreThoseOfTheTable) {
  const Bytes bytes =
      encode({MessageKind::kStamp, 0x01020304, 0x0A0B0C0D, HostTime{Nanoseconds{-2}}});
  const unsigned char expected[] = {0x59, 0x32, 1,    2,    4,    3,    2,    1,    0x0D, 0x0C,
                                    0x0B, 0x0A, 0xFE, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF};
  ASSERT_EQ(bytes.size(), sizeof(expected));
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    EXPECT_EQ(std::to_integer<unsigned char>(bytes[i]), expected[i]) << "byte " << i;
  }
}

TEST(Wire, OtherLengthsAreRefused) {
  const Bytes whole = encode({MessageKind::kReady, 1, 0, HostTime{}});
  for (std::size_t size = 0; size <= 64; ++size) {
    Bytes bytes = whole;
    bytes.resize(size);
    EXPECT_EQ(decode_session_message(bytes).has_value(), size == kSessionMessageBytes) << size;
  }
}

TEST(Wire, FieldsThatAKindDoesNotHaveMustBeZero) {
  EXPECT_FALSE(decode_session_message(encode({MessageKind::kReady, 1, 1, HostTime{}})));
  EXPECT_FALSE(
      decode_session_message(encode({MessageKind::kSuccess, 1, 0, HostTime{Nanoseconds{1}}})));
  EXPECT_FALSE(
      decode_session_message(encode({MessageKind::kRequest, 1, 1, HostTime{Nanoseconds{1}}})));
}

// Whatever is accepted is exactly what encode() makes of it: one message has one encoding.
TEST(Wire, DamagedMessagesAreRefusedOrAreAnotherMessageExactly) {
  constexpr std::uint64_t kSeed = 6276;
  std::mt19937_64 random(kSeed);
  const std::vector<SessionMessage> messages = one_of_each_kind();
  for (int i = 0; i < 200'000; ++i) {
    const Bytes original = encode(messages[random() % messages.size()]);
    Bytes bytes = original;
    const std::size_t position = random() % bytes.size();
    bytes[position] = static_cast<std::byte>(random());
    const auto decoded = decode_session_message(bytes);
    if (decoded) {
      ASSERT_EQ(encode(*decoded), bytes) << "seed " << kSeed << ", round " << i;
    } else {
      ASSERT_NE(bytes, original) << "seed " << kSeed << ", round " << i;
    }
  }
}

TEST(Wire, RandomBytesAreRefused) {
  constexpr std::uint64_t kSeed = 21;
  std::mt19937_64 random(kSeed);
  for (int i = 0; i < 200'000; ++i) {
    Bytes bytes(random() % 2 == 0 ? kSessionMessageBytes : random() % 64);
    for (std::byte& byte : bytes) byte = static_cast<std::byte>(random());
    ASSERT_FALSE(decode_session_message(bytes)) << "seed " << kSeed << ", round " << i;
  }
}

}  // namespace
}  // namespace simbench
