#include <gtest/gtest.h>

#include <boost/random/mersenne_twister.hpp>

#include "algorithms/host_sync/two_way/two_way_probe.h"

namespace simbench {
namespace {

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
