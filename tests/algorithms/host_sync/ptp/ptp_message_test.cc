#include "algorithms/host_sync/ptp/ptp_message.h"

#include <gtest/gtest.h>

#include <boost/random/mersenne_twister.hpp>

namespace simbench {
namespace {

constexpr PtpType kTypes[] = {PtpType::kSync,
                              PtpType::kDelayRequest,
                              PtpType::kPeerDelayRequest,
                              PtpType::kPeerDelayResponse,
                              PtpType::kFollowUp,
                              PtpType::kDelayResponse,
                              PtpType::kPeerDelayFollowUp,
                              PtpType::kAnnounce};

TEST(PtpMessageTest, WhatIsEncodedIsDecoded) {
  for (const PtpType type : kTypes) {
    const bool is_response = type == PtpType::kPeerDelayResponse ||
                             type == PtpType::kDelayResponse || type == PtpType::kPeerDelayFollowUp;
    for (const std::int64_t time_ns : {0L, 1'700'000'000'123'456'789L, -1L, -5'000'000'001L}) {
      const PtpMessage message{.type = type,
                               .sender = 6000,
                               .sequence = 0xfffe,
                               .correction = -77'000,
                               .time_ns = time_ns,
                               .asked_by = is_response ? 17u : 0u,
                               .is_simple = time_ns < 0};
      EXPECT_EQ(decode_ptp_message(encode(message)), message);
    }
  }
}

TEST(PtpMessageTest, TheBytesAreWhereTheStandardPutsThem) {
  const Bytes bytes = encode({.type = PtpType::kDelayResponse,
                              .sender = 0x0102,
                              .sequence = 0x0304,
                              .correction = 0x0506,
                              .time_ns = 2'000'000'007,
                              .asked_by = 9});
  ASSERT_EQ(bytes.size(), 54u);
  const auto at = [&bytes](std::size_t i) { return std::to_integer<int>(bytes[i]); };
  EXPECT_EQ(at(0), 0x09);
  EXPECT_EQ(at(1), 2);
  EXPECT_EQ(at(3), 54);
  EXPECT_EQ(at(14), 0x05);
  EXPECT_EQ(at(15), 0x06);
  EXPECT_EQ(at(26), 0x01);
  EXPECT_EQ(at(27), 0x02);
  EXPECT_EQ(at(29), 1);
  EXPECT_EQ(at(30), 0x03);
  EXPECT_EQ(at(31), 0x04);
  EXPECT_EQ(at(32), 3);
  EXPECT_EQ(at(39), 2);
  EXPECT_EQ(at(43), 7);
  EXPECT_EQ(at(51), 9);
  EXPECT_EQ(encode({.type = PtpType::kSync}).size(), 44u);
  EXPECT_EQ(std::to_integer<int>(encode({.type = PtpType::kSync})[6]), 0x02);
  EXPECT_EQ(encode({.type = PtpType::kPeerDelayRequest}).size(), 54u);
  const Bytes announce = encode({.type = PtpType::kAnnounce, .sender = 7, .is_simple = true});
  ASSERT_EQ(announce.size(), 64u);
  EXPECT_EQ(std::to_integer<int>(announce[60]), 7);
  // Unicast and profile-specific 1; no two-step.
  EXPECT_EQ(std::to_integer<int>(announce[6]), 0x24);
  EXPECT_EQ(std::to_integer<int>(encode({.type = PtpType::kSync, .is_simple = true})[6]), 0x24);
}

TEST(PtpMessageTest, CorrectionsAreIn65536thsOfANanosecond) {
  EXPECT_EQ(correction_of({.correction = 1'000 * 65'536 + 65'535}).count(), 1000);
  EXPECT_EQ(correction_of({.correction = -1}).count(), -1);
}

TEST(PtpMessageTest, ForeignBytesAreRefused) {
  const Bytes good = encode({.type = PtpType::kSync, .sequence = 1});
  ASSERT_TRUE(decode_ptp_message(good));
  EXPECT_FALSE(decode_ptp_message({}));
  Bytes other = good;
  other[1] = std::byte{1};
  EXPECT_FALSE(decode_ptp_message(other)) << "version 1";
  other = good;
  other[0] = std::byte{0xb};
  EXPECT_FALSE(decode_ptp_message(other)) << "an Announce that is too short";
  other[0] = std::byte{0xc};
  EXPECT_FALSE(decode_ptp_message(other)) << "Signaling";
  other = good;
  other[3] = std::byte{43};
  EXPECT_FALSE(decode_ptp_message(other)) << "length";
  other = good;
  other.push_back(std::byte{0});
  EXPECT_FALSE(decode_ptp_message(other)) << "longer than it says";
  other = good;
  other[40] = std::byte{0xff};
  EXPECT_FALSE(decode_ptp_message(other)) << "more than 1e9 ns";
  other = good;
  other[35] = std::byte{0x7f};
  EXPECT_FALSE(decode_ptp_message(other)) << "thousands of years";
}

TEST(PtpMessageTest, RandomBytesDecodeToWhatCanBeSentAgain) {
  boost::random::mt19937_64 engine(21);
  for (int run = 0; run < 20'000; ++run) {
    Bytes bytes = encode({.type = kTypes[engine() % std::size(kTypes)]});
    for (int change = 0; change < 1 + run % 8; ++change) {
      bytes[engine() % bytes.size()] = static_cast<std::byte>(engine());
    }
    const auto message = decode_ptp_message(bytes);
    if (!message) continue;
    EXPECT_EQ(decode_ptp_message(encode(*message)), message) << "seed 21, run " << run;
  }
}

}  // namespace
}  // namespace simbench
