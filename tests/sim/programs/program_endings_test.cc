// What the world makes of programs that end (processes/program_endings.h), and of clocks that
// nobody sets.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "scenarios/loader.h"
#include "sim/programs/program_sync.h"
#include "tests/scratch_folder.h"
#include "tests/sim/host/service_world.h"

namespace simbench::sim {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::Field;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using Command = scenarios::HostPrograms::Command;

constexpr std::size_t kEndingHosts = 3;

Command ending(const std::string& what) {
  return {std::string(SIMBENCH_PROGRAMS) + "/simbench_endings", what};
}

class ProgramEndingsWorld : public testing::Test {
 protected:
  void run(std::vector<Command> master, std::vector<Command> slave, double seconds) {
    programs_.master = std::move(master);
    programs_.slave = std::move(slave);
    ProgramSync sync({.pipeline = "test",
                      .programs = programs_,
                      .shim = SIMBENCH_SHIM,
                      .log_folder = log_folder_,
                      .hosts = kEndingHosts});
    {
      ServiceWorld world(
          scenarios::load_scenario("6host_star", {{"/hosts/count", "3"}, {"/cameras/count", "3"}}),
          1);
      world.start(sync);
      world.run_until(seconds);
      outcomes_ = world.record.outcomes;
      failures_ = world.record.program_failures;
    }
    notes_ = sync.notes();
  }

  scenarios::HostPrograms programs_;
  std::string log_folder_;
  std::vector<SyncOutcome> outcomes_;
  std::vector<ProgramFailure> failures_;
  std::vector<std::string> notes_;
};

TEST_F(ProgramEndingsWorld, OneShotClientsHaveDoneTheirWork) {
  for (const char* const what : {"set", "adjust"}) {
    run({ending("wait")}, {ending(what)}, 100);
    EXPECT_THAT(failures_, IsEmpty()) << what;
    EXPECT_THAT(outcomes_, ElementsAre(Field(&SyncOutcome::synchronised, true),
                                       Field(&SyncOutcome::synchronised, true)))
        << what;
    EXPECT_THAT(notes_, IsEmpty()) << what;
  }
}

TEST_F(ProgramEndingsWorld, AnEndWithoutSettingTheClockIsAFailure) {
  run({ending("wait")}, {ending("nothing")}, 100);
  ASSERT_THAT(failures_, SizeIs(kEndingHosts - 1));
  EXPECT_EQ(failures_.front().how, "ended with status 0 without setting the clock");
  EXPECT_NEAR(to_seconds(failures_.front().at), 1.5, 1e-3) << "the skew of a quartz, wake-ups";
}

TEST_F(ProgramEndingsWorld, ButNotOfAHelper) {
  run({ending("wait")}, {ending("nothing"), ending("wait")}, 50);
  EXPECT_THAT(failures_, IsEmpty());
  run({ending("wait")}, {ending("nothing"), ending("set")}, 50);
  EXPECT_THAT(failures_, IsEmpty()) << "whoever set it";
  run({ending("wait")}, {ending("set"), ending("late")}, 50);
  EXPECT_THAT(failures_, SizeIs(kEndingHosts - 1)) << "another one failed";
}

TEST_F(ProgramEndingsWorld, AFailureTellsWhereAndWhen) {
  const ScratchFolder logs;
  log_folder_ = logs.path().string();
  run({ending("wait")}, {ending("late")}, 10);
  ASSERT_THAT(failures_, SizeIs(kEndingHosts - 1));
  const ProgramFailure& failure = failures_.front();
  EXPECT_EQ(failure.program, "simbench_endings");
  EXPECT_EQ(failure.how, "exited with status 4");
  EXPECT_EQ(failure.last_words, "lost patience");
  EXPECT_EQ(failure.log,
            fmt::format("{}/test/seed1/host{}/0_simbench_endings.log", log_folder_, failure.host));
  EXPECT_EQ(content(failure.log), "lost patience\n");
  EXPECT_NEAR(to_seconds(failure.at), 2.5, 1e-3);
}

TEST_F(ProgramEndingsWorld, AMasterThatEndsIsANote) {
  run({ending("nothing")}, {ending("wait")}, 10);
  EXPECT_THAT(failures_, IsEmpty());
  EXPECT_THAT(notes_, ElementsAre(AllOf(HasSubstr("host 0, at 1.5"),
                                        HasSubstr("nobody serves the hosts from then on")),
                                  "hosts 1, 2: no program has set the clock, which ran free"));
}

// After a minute, or what the programs are said to need.
TEST_F(ProgramEndingsWorld, AHostWhoseClockNobodySetsIsNotSynchronised) {
  run({ending("wait")}, {ending("wait")}, 100);
  ASSERT_THAT(outcomes_, SizeIs(kEndingHosts - 1));
  EXPECT_FALSE(outcomes_.front().synchronised);
  EXPECT_EQ(outcomes_.front().message, "host 1: no program has set its clock in 60 s");
  EXPECT_THAT(notes_, IsEmpty()) << "it is said";
  programs_.run_before_capture_s = 120;
  run({ending("wait")}, {ending("wait")}, 100);
  EXPECT_THAT(outcomes_, IsEmpty());
  EXPECT_THAT(notes_, ElementsAre("hosts 1, 2: no program has set the clock, which ran free"));
}

}  // namespace
}  // namespace simbench::sim
