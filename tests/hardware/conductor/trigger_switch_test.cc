#include "hardware/conductor/trigger_switch.h"

#include <gmock/gmock.h>

#include <boost/asio/co_spawn.hpp>
#include <exception>
#include <filesystem>
#include <fstream>
#include <string>

namespace simbench::hardware {
namespace {

using testing::HasSubstr;

// What switching says if it fails, else nothing.
std::string turned(const std::optional<RigTrigger>& trigger, bool on,
                   const TriggerSwitch::Prompt& prompt = {}) {
  boost::asio::io_context context;
  TriggerSwitch button(context, trigger, prompt);
  std::string problem;
  boost::asio::co_spawn(context, button.turn(on), [&](const std::exception_ptr& failure) {
    if (!failure) return;
    try {
      std::rethrow_exception(failure);
    } catch (const TriggerError& error) {
      problem = error.what();
    }
  });
  context.run();
  return problem;
}

RigTrigger commands(const std::string& on, const std::string& off) {
  return {.manual = false, .on_command = on, .off_command = off};
}

TEST(TriggerSwitch, WithoutATriggerThereIsNothingToDo) {
  EXPECT_EQ(turned(std::nullopt, true), "");
}

TEST(TriggerSwitch, RunsTheCommandInTheShell) {
  const auto file = std::filesystem::temp_directory_path() / "simbench_trigger_test";
  std::filesystem::remove(file);
  const RigTrigger trigger =
      commands("echo 'it'\"'\"'s on' > " + file.string(), "rm " + file.string());
  EXPECT_EQ(turned(trigger, true), "");
  std::string line;
  std::getline(std::ifstream(file), line);
  EXPECT_EQ(line, "it's on");
  EXPECT_EQ(turned(trigger, false), "");
  EXPECT_FALSE(std::filesystem::exists(file));
}

TEST(TriggerSwitch, TellsHowTheCommandFailed) {
  const RigTrigger trigger = commands("exit 3", "exit 0");
  EXPECT_EQ(turned(trigger, true), "trigger on: 'exit 3' ended with exit status 3");
  EXPECT_EQ(turned(trigger, false), "");
}

TEST(TriggerSwitch, AsksWhereItIsSwitchedByHand) {
  const RigTrigger manual = {.manual = true, .on_command = "", .off_command = ""};
  std::string asked;
  EXPECT_EQ(turned(manual, true,
                   [&](const std::string& text) {
                     asked = text;
                     return true;
                   }),
            "");
  EXPECT_THAT(asked, HasSubstr("trigger on"));
  EXPECT_THAT(turned(manual, false, [](const std::string&) { return false; }),
              HasSubstr("given up"));
  EXPECT_THAT(turned(manual, true), HasSubstr("there is no prompt"));
}

}  // namespace
}  // namespace simbench::hardware
