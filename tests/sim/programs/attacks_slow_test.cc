// Programs that attack the world by their link to it: it ends them, or answers, and goes on.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cmath>
#include <string>
#include <vector>

#include "scenarios/loader.h"
#include "shim/protocol.h"
#include "sim/programs/program_sync.h"
#include "tests/sim/host/service_world.h"

namespace simbench::sim {
namespace {

using testing::AllOf;
using testing::HasSubstr;

struct Attacked {
  std::string ending{};               // of the attacking host
  std::vector<std::string> others{};  // what ended elsewhere
  double error_s = 0;                 // of the host that does not attack
  double took_s = 0;                  // in real time
};

// Host 1 attacks, host 2 follows the master by Cristian's algorithm.
Attacked attack(const std::vector<std::string>& words) {
  const auto program = [](const std::string& name) {
    return std::string(SIMBENCH_PROGRAMS) + "/simbench_" + name;
  };
  scenarios::HostPrograms programs;
  programs.master = {{program("cristian"), "serve"}};
  programs.slave = {{program("link_attacks")}};
  programs.slave[0].insert(programs.slave[0].end(), words.begin(), words.end());
  scenarios::HostPrograms honest = programs;
  honest.slave = {{program("cristian"), "follow", "{master}"}};
  const auto sync_of = [](const scenarios::HostPrograms& each, std::chrono::milliseconds patience) {
    return ProgramSettings{.pipeline = "test",
                           .programs = each,
                           .shim = SIMBENCH_SHIM,
                           .patience = patience,
                           .hosts = 3};
  };
  ProgramSync attacking(sync_of(programs, std::chrono::milliseconds(300)));
  ProgramSync following(sync_of(honest, std::chrono::seconds(10)));
  ServiceWorld world(
      scenarios::load_scenario("6host_star", {{"/hosts/count", "3"}, {"/cameras/count", "3"}}));
  const auto begin = std::chrono::steady_clock::now();
  world.spawn(attacking.run_slave(world.host(1), 0));
  world.spawn(following.run_slave(world.host(2), 0));
  world.spawn(following.run_master(world.host(0), {1, 2}));
  world.run_until(20);
  Attacked result{.error_s = world.error_s(2)};
  result.took_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  for (const SyncOutcome& outcome : world.record.outcomes) {
    if (outcome.slave == 1) {
      result.ending = outcome.message;
    } else {
      result.others.push_back(outcome.message);
    }
  }
  return result;
}

void expect_that_others_go_on(const Attacked& result) {
  EXPECT_THAT(result.others, testing::IsEmpty());
  EXPECT_LT(std::abs(result.error_s), 300e-6) << "it was set by its program";
  EXPECT_LT(result.took_s, 30);
  EXPECT_TRUE(std::ranges::none_of(result.ending, [](char letter) {
    return std::iscntrl(static_cast<unsigned char>(letter));
  })) << "what is shown is one line";
}

TEST(LinkAttacks, WhatIsNoRequestEndsTheProgram) {
  for (const char* attempt : {"garbage", "short", "wrong_size"}) {
    const Attacked result = attack({attempt});
    EXPECT_THAT(result.ending, HasSubstr("sent a request of a wrong size")) << attempt;
    expect_that_others_go_on(result);
  }
  const Attacked unknown = attack({"unknown_call"});
  EXPECT_THAT(unknown.ending, HasSubstr("asked what the world does not know"));
  expect_that_others_go_on(unknown);
}

TEST(LinkAttacks, NumbersOutOfRangeEndTheProgramOrAreAnswered) {
  constexpr int kEnd = static_cast<int>(shim::Call::kLookAtFile) + 3;  // two that there are none of
  for (int call = 0; call < kEnd; ++call) {
    const Attacked result = attack({"extremes", std::to_string(call)});
    SCOPED_TRACE(call);
    expect_that_others_go_on(result);
  }
}

TEST(LinkAttacks, FloodsEndTheProgram) {
  for (const char* attempt : {"flood", "open_many", "many_waits", "with_descriptors"}) {
    const Attacked result = attack({attempt});
    EXPECT_NE(result.ending, "") << attempt;
    expect_that_others_go_on(result);
  }
}

TEST(LinkAttacks, ALinkThatIsEndedEndsTheProgram) {
  for (const char* attempt : {"empty", "end_one_way", "map_it"}) {
    const Attacked result = attack({attempt});
    EXPECT_THAT(result.ending, HasSubstr("simbench_link_attacks: ")) << attempt;
    expect_that_others_go_on(result);
  }
}

TEST(LinkAttacks, WhatATerminalWouldObeyIsSpelt) {
  const Attacked result = attack({"colours"});
  EXPECT_THAT(result.ending, AllOf(HasSubstr("exited with status 3"), HasSubstr("red")));
  expect_that_others_go_on(result);
}

}  // namespace
}  // namespace simbench::sim
