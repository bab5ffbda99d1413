// An attack by name, and what becomes of it. Whatever that is: the machine is as it was, nothing is
// left running, simbench has not waited for longer than its patience, and the folder can be
// removed.
//
//   expect_repelled({{.program = "file_attacks", .words = {"up"}}, lines({"above: EACCES"})});
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <ostream>
#include <string>
#include <vector>

#include "tests/processes/attacked_machine.h"

namespace simbench::processes {

struct AttackCase {
  Attack attack;
  testing::Matcher<std::string> output = testing::_;
  testing::Matcher<std::string> ending = testing::_;
};

std::ostream& operator<<(std::ostream& out, const AttackCase& each);
std::string attack_name(const testing::TestParamInfo<AttackCase>& info);

// What it printed, and that it came to its end.
testing::Matcher<std::string> lines(const std::vector<std::string>& expected);
// What its ending says, in part, after the program's name.
testing::Matcher<std::string> ends(const std::string& how);

// That it made this call, which no program may.
testing::Matcher<std::string> ends_by_call(const std::string& call);

void expect_repelled(const AttackCase& each);

}  // namespace simbench::processes
