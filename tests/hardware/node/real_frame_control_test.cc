#include "hardware/node/real_frame_control.h"

#include <gmock/gmock.h>

#include <variant>

#include "tests/hardware/await.h"
#include "tests/hardware/node/host_pair.h"
#include "tests/hardware/node/made_up_steering.h"

namespace simbench::hardware {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;
using testing::SizeIs;

class RealFrameControlTest : public testing::Test {
 protected:
  RealFrameControlTest() { host().steer({{3, third}, {5, fifth}}); }

  boost::asio::io_context& context() { return pair.context(); }
  RealHost& host() { return pair.host(1); }
  FrameControl& control(std::size_t which) { return *host().frame_controls()[which]; }
  HostTime now() { return pair.clock(1).system_at(monotonic_now()); }

  HostPair pair{from_ms(300), 0, 30};
  std::shared_ptr<MadeUpSteering> third = std::make_shared<MadeUpSteering>();
  std::shared_ptr<MadeUpSteering> fifth = std::make_shared<MadeUpSteering>();
};

TEST_F(RealFrameControlTest, ThereIsOneForEachCameraThatCanBeSteered) {
  ASSERT_THAT(host().frame_controls(), SizeIs(2));
  EXPECT_EQ(control(0).camera(), 3U);
  EXPECT_EQ(control(1).camera(), 5U);
  EXPECT_EQ(control(1).limits().latency_frames, 2U);
  EXPECT_THAT(pair.host(0).frame_controls(), IsEmpty());
}

TEST_F(RealFrameControlTest, ControlsReachTheirCamera) {
  EXPECT_EQ(await(context(), control(1).adjust_frame(from_ms(-1))).length, from_ms(3));
  EXPECT_EQ(await(context(), control(1).insert_frame(from_ms(6))).length, from_ms(6));
  EXPECT_THAT(await(context(), control(1).set_frame_length(from_ms(30))).refused,
              HasSubstr("found a frame of 30"));
  EXPECT_THAT(fifth->controls, ElementsAre(Pair(FrameControlKind::kAdjustFrame, from_ms(-1)),
                                           Pair(FrameControlKind::kInsertFrame, from_ms(6)),
                                           Pair(FrameControlKind::kFrameLength, from_ms(30))));
  EXPECT_THAT(third->controls, IsEmpty());
}

TEST_F(RealFrameControlTest, EachGetsTheFramesOfItsCamera) {
  for (const std::uint32_t camera : {3U, 4U, 5U}) {
    FrameArrival frame;
    frame.camera = camera;
    frame.counter = 10 * camera;
    host().deliver(frame);
  }
  const SteadyTime soon = host().steady_clock().now() + from_ms(5);
  for (const std::size_t which : {0U, 1U}) {
    const auto frame = await(context(), control(which).next_frame(soon));
    ASSERT_TRUE(frame.has_value());
    EXPECT_EQ(frame->counter, 10 * control(which).camera());
    EXPECT_EQ(await(context(), control(which).next_frame(soon)), std::nullopt);
  }
}

// A thread that is woken too late asks for a start at once.
TEST_F(RealFrameControlTest, AStartIsWhenTheSystemClockShowsIt) {
  const HostTime at = now() + from_ms(30);
  EXPECT_TRUE(await(context(), control(0).start_at(at)).is_accepted());
  EXPECT_GE(now(), at);
  ASSERT_THAT(third->starts, SizeIs(1));
  const double late_ns = to_ns(pair.clock(1).system_at(third->starts[0]) - at);
  EXPECT_GE(late_ns, -2);
  if (pair.clock(1).system_at(third->asked[0]) < at) {
    EXPECT_LE(late_ns, 2);
  } else {
    EXPECT_LE(third->starts[0], third->asked[0]);
  }
}

TEST_F(RealFrameControlTest, AStartThatIsPastIsRefused) {
  EXPECT_THAT(await(context(), control(0).start_at(now() - from_ms(5))).refused,
              HasSubstr("ms ago, allowed: one to come"));
  EXPECT_THAT(third->starts, IsEmpty());
}

TEST_F(RealFrameControlTest, ReportsGoOnRecord) {
  const std::size_t before = pair.events(1).size();
  host().report_alignment({.camera = 5, .aligned = true, .controls = 7});
  ASSERT_THAT(pair.events(1), SizeIs(before + 1));
  const auto* report = std::get_if<AlignmentReport>(&pair.events(1).back());
  ASSERT_NE(report, nullptr);
  EXPECT_EQ(report->camera, 5U);
  EXPECT_EQ(report->controls, 7U);
}

}  // namespace
}  // namespace simbench::hardware
