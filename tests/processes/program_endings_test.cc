#include "processes/program_endings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace simbench::processes {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

// A host that keeps what is reported, and does nothing else.
class KeepingHost final : public Host {
 public:
  explicit KeepingHost(PeerId id) : id_(id) {}

  PeerId id() const override { return id_; }
  HostClock& clock() override { throw std::logic_error("no clock"); }
  const SteadyClock& steady_clock() const override { throw std::logic_error("no clock"); }
  MessageChannel& open_channel(PeerId, Transport) override { throw std::logic_error("no network"); }
  Task<void> sleep_for(Nanoseconds) override { throw std::logic_error("no time"); }
  Task<void> sleep_until(HostTime) override { throw std::logic_error("no time"); }
  double random_uniform() override { return 0; }
  void report_exchange(const Exchange&) override {}
  void report_outcome(const SyncOutcome& outcome) override { outcomes.push_back(outcome); }
  void report_program_failure(const ProgramFailure& failure) override {
    failures.push_back(failure);
  }

  std::vector<SyncOutcome> outcomes;
  std::vector<ProgramFailure> failures;

 private:
  PeerId id_;
};

constexpr bool kSet = true;
constexpr bool kNotSet = false;
const EndPlace kPlace{.at = Nanoseconds(10'000'213'000), .log = "logs/0_client.log"};

ProgramEnd end_with(int status) {
  return {.program = "client",
          .how = "exited with status " + std::to_string(status),
          .last_words = "bye",
          .status = status};
}

TEST(ProgramEndings, AStatusIsAFailureWithAllThatIsKnown) {
  KeepingHost host(3);
  ProgramEndings endings(host, 2);
  endings.add(end_with(4), kPlace, kSet);
  EXPECT_TRUE(endings.failure()) << "though another program runs";
  ASSERT_THAT(host.failures, SizeIs(1));
  const ProgramFailure& failure = host.failures.front();
  EXPECT_EQ(failure.host, 3U);
  EXPECT_EQ(failure.program, "client");
  EXPECT_EQ(failure.at, kPlace.at);
  EXPECT_EQ(failure.how, "exited with status 4");
  EXPECT_EQ(failure.last_words, "bye");
  EXPECT_EQ(failure.log, "logs/0_client.log");
  ASSERT_THAT(host.outcomes, SizeIs(1));
  EXPECT_EQ(host.outcomes.front().slave, 3U);
  EXPECT_FALSE(host.outcomes.front().synchronised);
  EXPECT_EQ(host.outcomes.front().message,
            "host 3, at 10.000213 s: client: exited with status 4: bye");
}

TEST(ProgramEndings, AHostFailsOnce) {
  KeepingHost host(3);
  ProgramEndings endings(host, 2);
  endings.add(end_with(4), kPlace, kNotSet);
  endings.add(end_with(5), kPlace, kNotSet);
  EXPECT_THAT(host.failures, SizeIs(1));
  EXPECT_EQ(host.failures.front().how, "exited with status 4");
}

TEST(ProgramEndings, WhatDidNotExitByItselfHasFailed) {
  KeepingHost host(3);
  ProgramEndings endings(host, 1);
  endings.add({.program = "client", .how = "was ended by signal SEGV"}, kPlace, kSet);
  ASSERT_THAT(host.failures, SizeIs(1));
  EXPECT_EQ(host.failures.front().how, "was ended by signal SEGV");
}

TEST(ProgramEndings, AOneShotClientThatHasSetTheClockIsDone) {
  KeepingHost host(3);
  ProgramEndings endings(host, 1);
  endings.add(end_with(0), kPlace, kSet);
  EXPECT_FALSE(endings.failure());
  EXPECT_THAT(host.failures, IsEmpty());
  ASSERT_THAT(host.outcomes, SizeIs(1));
  EXPECT_TRUE(host.outcomes.front().synchronised);
  EXPECT_EQ(host.outcomes.front().message,
            "host 3: client: exited with status 0 at 10.000213 s, the clock is set");
  EXPECT_THAT(endings.notes(), IsEmpty());
}

TEST(ProgramEndings, OneThatHasNotIsAFailureThatSaysSo) {
  KeepingHost host(3);
  ProgramEndings endings(host, 1);
  endings.add(end_with(0), kPlace, kNotSet);
  ASSERT_THAT(host.failures, SizeIs(1));
  EXPECT_EQ(host.failures.front().how, "ended with status 0 without setting the clock");
}

TEST(ProgramEndings, WhatElseIsKnownOfItStays) {
  KeepingHost host(3);
  ProgramEndings endings(host, 1);
  ProgramEnd end = end_with(0);
  end.how += ", and the preloaded library was never loaded";
  endings.add(end, kPlace, kNotSet);
  ASSERT_THAT(host.failures, SizeIs(1));
  EXPECT_EQ(host.failures.front().how,
            "ended with status 0 without setting the clock, and the preloaded library was never "
            "loaded");
}

TEST(ProgramEndings, AHelperMayEndWhileOthersRun) {
  KeepingHost host(3);
  ProgramEndings endings(host, 2);
  endings.add(end_with(0), kPlace, kNotSet);
  EXPECT_THAT(host.outcomes, IsEmpty());
  endings.add(end_with(0), kPlace, kSet);
  ASSERT_THAT(host.outcomes, SizeIs(1)) << "by the last of them";
  EXPECT_TRUE(host.outcomes.front().synchronised);
}

TEST(ProgramEndings, AMasterNeedNotSetItsClock) {
  KeepingHost host(0);
  ProgramEndings endings(host, 1);
  endings.add(end_with(0), kPlace, kNotSet);
  EXPECT_THAT(host.failures, IsEmpty());
  EXPECT_THAT(host.outcomes, IsEmpty());
  EXPECT_THAT(endings.notes(),
              ElementsAre("host 0, at 10.000213 s: client: ended with status 0; nobody serves the "
                          "hosts from then on"));
  KeepingHost other(0);
  ProgramEndings failed(other, 1);
  failed.add(end_with(1), kPlace, kNotSet);
  EXPECT_THAT(other.failures, SizeIs(1)) << "it is to go on all the same";
}

}  // namespace
}  // namespace simbench::processes
