// Attacks that take their time: they end by a limit of real time, or fill the memory.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <vector>

#include "tests/processes/attack_case.h"

namespace simbench::processes {
namespace {

using namespace std::chrono_literals;
using testing::_;
using testing::AnyOf;

class SlowAttackTest : public testing::TestWithParam<AttackCase> {};

TEST_P(SlowAttackTest, IsRepelled) { expect_repelled(GetParam()); }

std::vector<AttackCase> attacks_on_time() {
  const auto at = [](const char* attempt, std::chrono::milliseconds patience = 1s) {
    return Attack{.program = "process_attacks", .words = {attempt}, .patience = patience};
  };
  return {
      {at("wait_for_ever"), _, ends("computed for 1 s without waiting")},
      {at("ignore_all"), _, ends("computed for 1 s without waiting")},
      {at("compute_in_pieces", 500ms), _,
       ends("computed for 5 s in all, beside 10 ms for each request")},
      {at("use_processor", 20s), _, ends("used the processor for longer than it may")},
      {at("leave_world"), _, AnyOf(ends("was ended"), ends("computed for"))},
      {at("new_session"), _, ends("computed for")},
  };
}

std::vector<AttackCase> attacks_on_memory() {
  const auto at = [](const char* attempt) {
    return Attack{.program = "process_attacks",
                  .words = {attempt},
                  .patience = 20s,
                  .memory = std::uint64_t{200} << 20};
  };
  const auto much = ends("used more than 200 MiB of memory, with the run's other programs");
  return {{at("private_memory"), _, much}, {at("shared_memory"), _, much}};
}

INSTANTIATE_TEST_SUITE_P(Time, SlowAttackTest, testing::ValuesIn(attacks_on_time()), attack_name);
INSTANTIATE_TEST_SUITE_P(Memory, SlowAttackTest, testing::ValuesIn(attacks_on_memory()),
                         attack_name);

}  // namespace
}  // namespace simbench::processes
