// What a node answers to the requests of programs around its clock, and what they read.
#include "hardware/node/program_clock.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/timex.h>
#include <time.h>

#include <cerrno>
#include <cstdint>
#include <cstdlib>

#include "processes/requests.h"
#include "tests/hardware/node/host_pair.h"

namespace simbench::hardware {
namespace {

using shim::Call;

class ProgramClockTest : public testing::Test {
 protected:
  ProgramClockTest()
      : page_(mmap(nullptr, sizeof(shim::ClockPage), PROT_READ, MAP_SHARED, served_.page(), 0)) {}
  ~ProgramClockTest() override { munmap(page_, sizeof(shim::ClockPage)); }

  ProgramClock::Answer ask(shim::Request head, Bytes data = {}) {
    return served_.answer({.head = head, .data = std::move(data), .is_whole = true});
  }
  ProgramClock::Answer adjust(const timex& request) {
    return ask({.call = Call::kAdjustClock, .a = CLOCK_REALTIME}, processes::bytes_of(request));
  }
  // What a program reads beside what the clock says, in ns.
  std::int64_t difference_ns(MonotonicTime at) const {
    const auto& page = *static_cast<const shim::ClockPage*>(page_);
    return shim::reading_at(page, nanoseconds_of(at)) - nanoseconds_of(clock_.system_at(at));
  }

  HostPair pair_{from_ms(300), 0, 25};
  SoftwareClock& clock_ = pair_.clock(1);
  ProgramClock served_{pair_.context().get_executor(), clock_};
  void* page_;
};

TEST_F(ProgramClockTest, AProgramReadsTheClockToTheNanosecond) {
  const MonotonicTime now = monotonic_now();
  EXPECT_LE(std::abs(difference_ns(now)), 1);
  EXPECT_LE(std::abs(difference_ns(now + std::chrono::hours(1))), 1);
  timex rate{};
  rate.modes = ADJ_FREQUENCY;
  rate.freq = 65'536 * 123;
  EXPECT_EQ(adjust(rate).error, 0);
  EXPECT_LE(std::abs(difference_ns(monotonic_now() + std::chrono::hours(1))), 1);
}

TEST_F(ProgramClockTest, AStampFromBeforeASettingReadsWhatTheClockReadThen) {
  const MonotonicTime before = monotonic_now();
  const std::int64_t reading = nanoseconds_of(clock_.system_at(before));
  EXPECT_EQ(
      ask({.call = Call::kSetClock, .a = CLOCK_REALTIME, .b = 1'900'000'000 * kSecondNs}).error, 0);
  const auto& page = *static_cast<const shim::ClockPage*>(page_);
  EXPECT_LE(std::abs(shim::reading_at(page, nanoseconds_of(before)) - reading), 1);
  EXPECT_LE(std::abs(difference_ns(monotonic_now())), 1);
  EXPECT_GE(clock_.system_at(monotonic_now()).time_since_epoch(),
            std::chrono::seconds(1'900'000'000));
}

TEST_F(ProgramClockTest, SaysThatOnlyTheClockIsServed) {
  const ProgramClock::Answer hello = ask({.call = Call::kHello});
  EXPECT_EQ(processes::read_head<shim::Identity>(hello.data).only_clock, 1U);
}

TEST_F(ProgramClockTest, RefusesWhatTheKernelRefuses) {
  EXPECT_EQ(ask({.call = Call::kSetClock, .a = CLOCK_MONOTONIC, .b = 1}).error, EINVAL);
  EXPECT_EQ(ask({.call = Call::kSetClock, .a = CLOCK_REALTIME, .b = -1}).error, EINVAL);
  EXPECT_EQ(ask({.call = Call::kSetClock, .a = CLOCK_REALTIME, .b = INT64_MAX}).error, EINVAL);
  timex tick{};
  tick.modes = ADJ_TICK;
  tick.tick = 1;
  EXPECT_EQ(adjust(tick).error, EINVAL);
}

TEST_F(ProgramClockTest, WhatIsNoRequestEndsTheProgram) {
  using processes::BadRequest;
  EXPECT_THROW(ask({.call = Call::kWait}), BadRequest);
  EXPECT_THROW(ask({.call = static_cast<Call>(999)}), BadRequest);
  EXPECT_THROW(ask({.call = Call::kAdjustClock, .a = CLOCK_REALTIME}), BadRequest);
  EXPECT_THROW(ask({.call = Call::kNote}), BadRequest);
  EXPECT_THROW(served_.answer({}), BadRequest) << "a part of one";
}

}  // namespace
}  // namespace simbench::hardware
