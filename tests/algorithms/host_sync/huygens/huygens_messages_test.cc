#include "algorithms/host_sync/huygens/huygens_messages.h"

#include <gtest/gtest.h>

#include <boost/random/mersenne_twister.hpp>
#include <vector>

#include "tests/nonempty.h"

namespace simbench {
namespace {

std::vector<HuygensMessage> samples() {
  return {RosterMessage{},
          RosterMessage{{0, 3, 4'000'000}},
          ProbeMessage{.pair = 1, .member = 1},
          ProbeMessage{.pair = 9, .member = 0, .left_pair = 8, .left_ns = {-5, 1'000'000'000'000}},
          BoundsMessage{.begin_ns = -7, .end_ns = 9, .vertices = {{-7, 1}, {2, -3}, {9, 1}}},
          BoundsMessage{},
          LineMessage{.b = 5, .line = {.x_ns = 1, .lead_ns = -2, .rate = 0x1p-20}},
          SteerMessage{.raw_ns = -1, .master = HostTime(from_ms(1e12))}};
}

TEST(HuygensMessageTest, WhatIsEncodedIsDecoded) {
  for (const HuygensMessage& message : nonempty(samples())) {
    EXPECT_EQ(decode_huygens_message(encode(message)), message) << message.index();
  }
}

TEST(HuygensMessageTest, WhatCannotBeIsRefused) {
  const auto is_refused = [](const HuygensMessage& message) {
    return !decode_huygens_message(encode(message));
  };
  constexpr std::int64_t kTooMuch = (std::int64_t{1} << 61) + 1;
  EXPECT_TRUE(is_refused(ProbeMessage{.pair = 0}));
  EXPECT_TRUE(is_refused(ProbeMessage{.pair = 1, .member = 2}));
  EXPECT_TRUE(is_refused(ProbeMessage{.pair = 3, .left_pair = 3}));
  EXPECT_TRUE(is_refused(ProbeMessage{.pair = 3, .left_ns = {1, 2}}));
  EXPECT_TRUE(is_refused(ProbeMessage{.pair = 3, .left_pair = 2, .left_ns = {0, kTooMuch}}));
  EXPECT_TRUE(is_refused(BoundsMessage{.vertices = {{3, 0}, {3, 0}}}));
  EXPECT_TRUE(is_refused(BoundsMessage{.end_ns = kTooMuch, .vertices = {}}));
  EXPECT_TRUE(is_refused(LineMessage{.line = {.rate = 0.01}}));
  EXPECT_TRUE(is_refused(LineMessage{.line = {.lead_ns = -kTooMuch}}));
  EXPECT_TRUE(is_refused(SteerMessage{.raw_ns = kTooMuch}));
  EXPECT_FALSE(decode_huygens_message({}));
}

TEST(HuygensMessageTest, RandomBytesDecodeToWhatEncodesToThem) {
  boost::random::mt19937_64 engine(31);
  const std::vector<HuygensMessage> messages = samples();
  for (int run = 0; run < 40'000; ++run) {
    Bytes bytes = encode(messages[engine() % messages.size()]);
    for (int change = 0; change < 1 + run % 6; ++change) {
      bytes[engine() % bytes.size()] = static_cast<std::byte>(engine());
    }
    if (run % 9 == 0) bytes.resize(engine() % 80);
    const auto message = decode_huygens_message(bytes);
    if (!message) continue;
    EXPECT_EQ(encode(*message), bytes) << "seed 31, run " << run;
  }
}

}  // namespace
}  // namespace simbench
