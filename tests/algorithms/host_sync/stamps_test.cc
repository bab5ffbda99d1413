#include "algorithms/host_sync/stamps.h"

#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "tests/algorithms/host_sync/script_host.h"

namespace simbench {
namespace {

Task<void> send_one(Host& host, MessageStamps& stamps, std::optional<std::int64_t>& departure) {
  MessageChannel& channel = host.open_channel(1, Transport::kDatagram);
  const MessageId id = co_await channel.send(Bytes(4));
  departure = co_await stamps.departure(channel, id);
}

class MessageStampsTest : public testing::Test {
 protected:
  MessageStampsTest() {
    world_.connect(from_ms(1));
    world_.host(0).offset = from_ms(7);
    world_.host(0).costs.send = from_ms(2);
  }
  std::optional<std::int64_t> send(MessageStamps& stamps) {
    std::optional<std::int64_t> departure;
    world_.start(send_one(world_.host(0), stamps, departure));
    world_.run();
    return departure;
  }
  std::int64_t reading_ns() { return nanoseconds_of(world_.host(0).reading()); }

  ScriptWorld world_{2};
};

TEST_F(MessageStampsTest, TheKernelStampsTheDepartureTheProgramReadsAfterTheCall) {
  world_.host(0).stamps_departures = true;
  MessageStamps kernel(world_.host(0), StampSource::kKernel);
  EXPECT_EQ(send(kernel), nanoseconds_of(HostTime(from_ms(2 + 7))));
  MessageStamps program(world_.host(0), StampSource::kProgram);
  const std::int64_t before = reading_ns();
  EXPECT_EQ(send(program), before + from_ms(2).count());
  EXPECT_EQ(kernel.lacking(), "");
  EXPECT_EQ(program.lacking(), "");
}

TEST_F(MessageStampsTest, WithoutStampsNoneIsMadeUpAndTheLackIsNamed) {
  MessageStamps kernel(world_.host(0), StampSource::kKernel);
  for (int i = 0; i < MessageStamps::kPatience; ++i) {
    EXPECT_EQ(kernel.lacking(), "");
    EXPECT_FALSE(send(kernel));
  }
  EXPECT_NE(kernel.lacking().find("/network/stamp_point"), std::string::npos);
  const MessageStamps card(world_.host(0), StampSource::kCard);
  EXPECT_NE(card.lacking().find("Host::hardware_clock"), std::string::npos);
  EXPECT_FALSE(card.arrival({}));
}

TEST_F(MessageStampsTest, AStampThatIsLostAfterOthersCameIsNoLack) {
  world_.host(0).stamps_departures = true;
  MessageStamps kernel(world_.host(0), StampSource::kKernel);
  EXPECT_TRUE(send(kernel));
  world_.host(0).stamps_departures = false;
  for (int i = 0; i < 2 * MessageStamps::kPatience; ++i) EXPECT_FALSE(send(kernel));
  EXPECT_EQ(kernel.lacking(), "");
}

}  // namespace
}  // namespace simbench
