#include "algorithms/host_sync/messages.h"

#include <gtest/gtest.h>

#include <boost/random/mersenne_twister.hpp>
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

TEST(SessionMessageTest, EveryKindComesBackAsItWas) {
  for (const SessionMessage& message : nonempty(one_of_each_kind())) {
    const Bytes bytes = encode(message);
    ASSERT_EQ(bytes.size(), kSessionMessageBytes);
    const auto decoded = decode_session_message(bytes);
    ASSERT_TRUE(decoded) << "kind " << static_cast<int>(message.kind);
    EXPECT_EQ(*decoded, message) << "kind " << static_cast<int>(message.kind);
  }
}

TEST(SessionMessageTest, TheBytesAreThoseOfTheTable) {
  const Bytes bytes =
      encode({MessageKind::kStamp, 0x01020304, 0x0A0B0C0D, HostTime{Nanoseconds{-2}}});
  const unsigned char expected[] = {0x59, 0x32, 1,    2,    4,    3,    2,    1,    0x0D, 0x0C,
                                    0x0B, 0x0A, 0xFE, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF};
  ASSERT_EQ(bytes.size(), sizeof(expected));
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    EXPECT_EQ(std::to_integer<unsigned char>(bytes[i]), expected[i]) << "byte " << i;
  }
}

TEST(SessionMessageTest, OtherLengthsAreRefused) {
  const Bytes whole = encode({MessageKind::kReady, 1, 0, HostTime{}});
  for (std::size_t size = 0; size <= 64; ++size) {
    Bytes bytes = whole;
    bytes.resize(size);
    EXPECT_EQ(decode_session_message(bytes).has_value(), size == kSessionMessageBytes) << size;
  }
}

TEST(SessionMessageTest, FieldsThatAKindDoesNotHaveMustBeZero) {
  EXPECT_FALSE(decode_session_message(encode({MessageKind::kReady, 1, 1, HostTime{}})));
  EXPECT_FALSE(
      decode_session_message(encode({MessageKind::kSuccess, 1, 0, HostTime{Nanoseconds{1}}})));
  EXPECT_FALSE(
      decode_session_message(encode({MessageKind::kRequest, 1, 1, HostTime{Nanoseconds{1}}})));
}

// Whatever is accepted is exactly what encode() makes of it: one message has one encoding.
TEST(SessionMessageTest, DamagedMessagesAreRefusedOrAreAnotherMessageExactly) {
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

TEST(SessionMessageTest, RandomBytesAreRefused) {
  constexpr std::uint64_t kSeed = 21;
  std::mt19937_64 random(kSeed);
  for (int i = 0; i < 200'000; ++i) {
    Bytes bytes(random() % 2 == 0 ? kSessionMessageBytes : random() % 64);
    for (std::byte& byte : bytes) byte = static_cast<std::byte>(random());
    ASSERT_FALSE(decode_session_message(bytes)) << "seed " << kSeed << ", round " << i;
  }
}

TEST(TwoWayMessageTest, WhatIsEncodedIsDecoded) {
  const TwoWayMessage request{.index = 7};
  EXPECT_EQ(decode_two_way_message(encode(request)), request);
  const TwoWayMessage asking{.index = 7, .replied_index = 6};
  EXPECT_EQ(decode_two_way_message(encode(asking)), asking);
  const TwoWayMessage reply{.kind = TwoWayMessage::Kind::kReply,
                            .index = 0xfffffffe,
                            .arrived = HostTime(Nanoseconds(-5)),
                            .replied_index = 0xfffffffd,
                            .replied = HostTime(Nanoseconds(1'700'000'000'123'456'789))};
  EXPECT_EQ(decode_two_way_message(encode(reply)), reply);
  EXPECT_EQ(encode(reply).size(), kTwoWayMessageBytes);
  EXPECT_EQ(encode(request).size(), kTwoWayMessageBytes);
}

TEST(TwoWayMessageTest, WhatEncodeCannotMakeIsRefused) {
  const Bytes good = encode(TwoWayMessage{.kind = TwoWayMessage::Kind::kReply,
                                          .index = 9,
                                          .arrived = HostTime(Nanoseconds(1)),
                                          .replied_index = 8,
                                          .replied = HostTime(Nanoseconds(2))});
  ASSERT_TRUE(decode_two_way_message(good));
  Bytes shorter = good;
  shorter.pop_back();
  EXPECT_FALSE(decode_two_way_message(shorter));
  for (const std::size_t at : {0u, 1u, 2u}) {
    Bytes other = good;
    other[at] ^= std::byte{0x40};
    EXPECT_FALSE(decode_two_way_message(other)) << "byte " << at;
  }
  for (const int kind : {0, 1, 3}) {
    Bytes other = good;
    other[3] = static_cast<std::byte>(kind);
    EXPECT_FALSE(decode_two_way_message(other)) << "kind " << kind;
  }
  Bytes no_index = good;
  no_index[4] = std::byte{0};
  EXPECT_FALSE(decode_two_way_message(no_index));
  Bytes from_the_future = good;
  from_the_future[16] = std::byte{10};
  EXPECT_FALSE(decode_two_way_message(from_the_future));
  Bytes in_a_far_future = good;
  in_a_far_future[15] = std::byte{0x7f};
  EXPECT_FALSE(decode_two_way_message(in_a_far_future));
  Bytes departure_of_none = good;
  departure_of_none[16] = std::byte{0};
  EXPECT_FALSE(decode_two_way_message(departure_of_none));
}

TEST(TwoWayMessageTest, RandomBytesAreRefusedOrEncodeToThemselves) {
  boost::random::mt19937_64 engine(3);
  for (int run = 0; run < 20'000; ++run) {
    Bytes bytes = encode(TwoWayMessage{.index = 1});
    for (int change = 0; change < 1 + run % 6; ++change) {
      bytes[engine() % bytes.size()] = static_cast<std::byte>(engine());
    }
    const auto message = decode_two_way_message(bytes);
    if (!message) continue;
    EXPECT_EQ(encode(*message), bytes) << "seed 3, run " << run;
  }
}

}  // namespace
}  // namespace simbench
