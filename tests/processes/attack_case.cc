#include "tests/processes/attack_case.h"

#include <linux/landlock.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <chrono>

#include "recording/distrusted_folder.h"

namespace simbench::processes {
namespace {

std::string name_of(const Attack& attack) {
  std::string name = attack.program;
  for (const std::string& word : attack.words) name += "_" + word;
  return name;
}

}  // namespace

std::ostream& operator<<(std::ostream& out, const AttackCase& each) {
  return out << name_of(each.attack);
}

std::string attack_name(const testing::TestParamInfo<AttackCase>& info) {
  return name_of(info.param.attack);
}

testing::Matcher<std::string> lines(const std::vector<std::string>& expected) {
  std::string text;
  for (const std::string& line : expected) text += line + "\n";
  return testing::Eq(text + "still there\n");
}

testing::Matcher<std::string> ends(const std::string& how) {
  return testing::HasSubstr(": " + how);
}

testing::Matcher<std::string> ends_by_call(const std::string& call) {
  return testing::ContainsRegex(": " + call + "\\(.*\\) is not for programs");
}

void expect_repelled(const AttackCase& each) {
  if (syscall(SYS_landlock_create_ruleset, nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION) < 6) {
    GTEST_SKIP() << "this kernel's Landlock does not know signals and abstract sockets";
  }
  const AttackedMachine machine;
  const Attacked result = machine.run(each.attack);
  EXPECT_THAT(result.output, each.output) << result.ending;
  EXPECT_THAT(result.ending, each.ending);
  EXPECT_EQ(machine.change(), "");
  constexpr double kMoment_s = 5;  // of a busy machine
  const double patience_s = std::chrono::duration<double>(each.attack.patience).count();
  EXPECT_LT(result.took_s, Child::kPatiencesInAll * patience_s + kMoment_s);
  EXPECT_TRUE(remove_tree(machine.folder().path()));
}

}  // namespace simbench::processes
