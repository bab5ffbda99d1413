#include <gmock/gmock.h>

#include "algorithms/capture_alignment/steered_camera.h"
#include "tests/algorithms/capture_alignment/fake_camera.h"
#include "tests/nonempty.h"

namespace simbench {
namespace {

using ::testing::HasSubstr;

constexpr Nanoseconds kPiPeriod = from_ms(30);

Nanoseconds last_difference(const FakeCamera& client, const FakeCamera& server) {
  return phase_error(client.middles().back() - server.middles().back(), kPiPeriod);
}

// The controls of a client whose frames are this much later than the server's, after the whole run.
std::vector<FakeControl> controls_of_client(Nanoseconds later, Nanoseconds delay = from_ms(8)) {
  FakeRig rig(2);
  const FakeCamera& server = rig.add(0, {.phase = from_ms(0)});
  const FakeCamera& client = rig.add(1, {.phase = later, .delay = delay});
  rig.run(*make_alignment("rpi_sync"), from_ms(4000));
  EXPECT_TRUE(server.controls().empty());
  EXPECT_LT(std::chrono::abs(last_difference(client, server)), from_us(50));
  EXPECT_TRUE(rig.host(1).last_report(1).aligned);
  return client.controls();
}

TEST(RpiSyncTest, TheWholeErrorIsTakenOffOneFrameAtThe30th) {
  const std::vector<FakeControl> late = controls_of_client(from_ms(7));
  ASSERT_EQ(late.size(), 1u);
  EXPECT_EQ(late[0].kind, FrameControlKind::kAdjustFrame);
  EXPECT_EQ(late[0].value, from_ms(-7));
  // Frame 29 from 0 is delivered 13 ms after its middle; the client's next one is used.
  EXPECT_GE(late[0].at, 29 * kPiPeriod + from_ms(13));
  EXPECT_LE(late[0].at, 30 * kPiPeriod + from_ms(14));
  const std::vector<FakeControl> early = controls_of_client(from_ms(20));
  ASSERT_EQ(early.size(), 1u);
  EXPECT_EQ(early[0].value, from_ms(10));
}

// A client whose newest frame is 22 ms older than the packet's: the code's integer is 0, not -1,
// and so the frame is 22 ms longer instead of 8 ms shorter. Then it is a period older, at each
// packet.
TEST(RpiSyncTest, TheQuotientIsCutTowardsZero) {
  const std::vector<FakeControl> controls = controls_of_client(from_ms(8), from_ms(40));
  ASSERT_EQ(controls.size(), 4u);
  EXPECT_EQ(controls[0].value, from_ms(22));
  for (std::size_t i = 1; i < 4; ++i) EXPECT_EQ(controls[i].value, kPiPeriod);
}

TEST(RpiSyncTest, BelowTheDeadBandNothingIsSent) {
  EXPECT_EQ(controls_of_client(from_us(49)).size(), 0u);
  EXPECT_EQ(controls_of_client(from_us(50)).size(), 1u);
}

TEST(RpiSyncTest, BothReportReadyAtTheServers100thFrameAndNotBefore) {
  for (const double end_ms : {2900.0, 3100.0}) {
    FakeRig rig(2);
    rig.add(0, {.phase = from_ms(0)});
    rig.add(1, {.phase = from_ms(7)});
    rig.run(*make_alignment("rpi_sync"), from_ms(end_ms));
    for (const PeerId id : {0u, 1u}) {
      ASSERT_EQ(rig.host(id).reports().size(), end_ms < 3000 ? 0u : 1u) << id;
      if (end_ms < 3000) continue;
      EXPECT_TRUE(rig.host(id).reports()[0].aligned);
      EXPECT_EQ(rig.host(id).reports()[0].camera, id);
      EXPECT_EQ(rig.host(id).reports()[0].controls, id);
    }
  }
}

TEST(RpiSyncTest, ALostPacketAndALostControlCostAPeriodEach) {
  FakeRig rig(2);
  const FakeCamera& server = rig.add(0, {.phase = from_ms(0)});
  const FakeCamera& client =
      rig.add(1, {.phase = from_ms(7), .is_lost = [](std::size_t number) { return number == 0; }});
  rig.world().script_link(0, 1, [](std::size_t index, const Bytes&) {
    return index == 0 ? std::vector<Nanoseconds>{} : std::vector{from_ms(1)};
  });
  rig.run(*make_alignment("rpi_sync"), from_ms(4000));
  ASSERT_EQ(client.controls().size(), 2u);
  EXPECT_NEAR(to_ms(client.controls()[0].at), 60 * 30, 30);
  EXPECT_NEAR(to_ms(client.controls()[1].at), 90 * 30, 30);
  EXPECT_EQ(last_difference(client, server), Nanoseconds(0));
}

// 20 ppm are 18 us from one packet to the next: a correction at 54, 72, 90 us at the latest.
TEST(RpiSyncTest, ADriftingClientStaysWithinTheDeadBandAndAPeriodsDrift) {
  FakeRig rig(2);
  const FakeCamera& server = rig.add(0, {.phase = from_ms(0)});
  const FakeCamera& client = rig.add(1, {.phase = from_ms(7), .rate_ppm = 20});
  rig.run(*make_alignment("rpi_sync"), from_ms(30'000));
  for (const Nanoseconds middle : nonempty(client.middles())) {
    if (middle < from_ms(2000)) continue;
    ASSERT_LE(std::chrono::abs(phase_error(middle - server.middles().front(), kPiPeriod)),
              from_us(50 + 18 + 4));
  }
  EXPECT_GE(client.controls().size(), 7u);
  EXPECT_LE(client.controls().size(), 12u);
}

TEST(RpiSyncTest, TheServersMeanFrameLengthIsTold) {
  FakeRig rig(2);
  const FakeCamera& server = rig.add(0, {.phase = from_ms(0), .rate_ppm = 1000});
  Bytes told;
  rig.world().script_link(0, 1, [&told](std::size_t, const Bytes& bytes) {
    told = bytes;
    return std::vector{from_ms(1)};
  });
  rig.add(1, {.phase = from_ms(7)});
  rig.run(*make_alignment("rpi_sync"), from_ms(1000));
  ASSERT_EQ(told.size(), 36u);
  const auto byte = [&told](std::size_t i) { return std::to_integer<std::int64_t>(told[i]); };
  EXPECT_EQ(byte(0) + 256 * byte(1), 30'030);
  const std::int64_t frame_us = byte(12) + 256 * byte(13) + 65536 * byte(14);
  EXPECT_EQ(frame_us, (server.middles().at(29).count() + 500) / 1000);
  const std::int64_t ready_us = byte(28) + 256 * byte(29) + 65536 * byte(30);
  EXPECT_EQ(ready_us, frame_us + 70 * 30'030);
}

TEST(RpiSyncTest, EveryOtherCameraFollowsTheMastersFirst) {
  FakeRig rig(3);
  rig.world().host(0).offset = from_ms(11);  // all system clocks agree
  rig.world().host(1).offset = from_ms(11);
  rig.world().host(2).offset = from_ms(11);
  const FakeCamera& server = rig.add(0, {.phase = from_ms(2)});
  std::vector<const FakeCamera*> clients;
  for (const PeerId host : {0u, 1u, 1u, 2u}) {
    clients.push_back(
        &rig.add(host, {.phase = from_ms(5 + 6.0 * static_cast<double>(clients.size()))}));
  }
  rig.run(*make_alignment("rpi_sync"), from_ms(4000));
  for (const FakeCamera* client : clients) {
    EXPECT_EQ(last_difference(*client, server), Nanoseconds(0)) << client->camera();
  }
}

TEST(RpiSyncTest, WhatAClientCannotDoIsReported) {
  FakeRig rig(2);
  rig.add(0, {.phase = from_ms(0)});
  FakeCameraScript unable{.phase = from_ms(7)};
  unable.limits.allowed = {false, true, true, true};
  rig.add(1, unable);
  FakeCameraScript full_rate{.phase = from_ms(7)};
  full_rate.limits.shortest = kPiPeriod;
  rig.add(1, full_rate);
  rig.add(1, {.phase = from_ms(7)});
  rig.run(*make_alignment("rpi_sync"), from_ms(4000));
  EXPECT_FALSE(rig.host(1).last_report(1).aligned);
  EXPECT_THAT(rig.host(1).last_report(1).message, HasSubstr("adjust_frame"));
  EXPECT_FALSE(rig.host(1).last_report(2).aligned);
  EXPECT_THAT(rig.host(1).last_report(2).message, HasSubstr("lower rate"));
  EXPECT_TRUE(rig.host(1).last_report(3).aligned);
}

TEST(RpiSyncTest, WithoutPacketsClientsSaySoAndForeignBytesAreNone) {
  FakeRig rig(2);
  const FakeCamera& client = rig.add(1, {.phase = from_ms(7)});  // the master has no camera
  rig.world().call_at(from_ms(1000), [&rig] { rig.world().transmit(0, 1, Bytes(3)); });
  rig.world().call_at(from_ms(1100), [&rig] { rig.world().transmit(0, 1, Bytes(36)); });
  rig.run(*make_alignment("rpi_sync"), from_ms(8000));
  EXPECT_TRUE(client.controls().empty());
  ASSERT_EQ(rig.host(1).reports().size(), 1u);
  EXPECT_THAT(rig.host(1).reports()[0].message, HasSubstr("no packet"));
}

}  // namespace
}  // namespace simbench
