#include "explore/state.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "app/program_pipelines.h"
#include "recording/collected.h"

namespace simbench::explore {
namespace {

using reports::Json;
using testing::ElementsAre;
using testing::HasSubstr;

const PageSubject kPaper{.name = "18cam_6host_45fps"};

State state(const std::string& text, const PageSubject& subject = kPaper) {
  return state_of(Json::parse(text), subject);
}

// What the page is told of a state that is refused: "pointer|message".
std::string refusal(const std::string& text, const PageSubject& subject = kPaper) {
  try {
    world_of(state(text, subject), subject);
  } catch (const StateRefused& refused) {
    return refused.pointer() + '|' + refused.what();
  }
  return "none";
}

TEST(StateTest, AStateIsAWorldAndWhatDoesTheSame) {
  const State changed = state(
      R"({"scenario": "3cam_1host_30fps", "sets": [{"pointer": "/trigger/rate_hz", "value": 15},
          {"pointer": "/usb/sharing", "value": "fair"}], "pipelines": ["oracle"],
          "first_seed": 5})");
  const scenarios::Scenario world = world_of(changed, kPaper);
  EXPECT_EQ(world.trigger.rate_hz, 15);
  EXPECT_THAT(collected(world.pipelines, &scenarios::Pipeline::name), ElementsAre("oracle"));
  EXPECT_THAT(command_of(changed, kPaper, 8),
              ElementsAre("simbench", "run", "--scenario", "3cam_1host_30fps", "--set",
                          "/trigger/rate_hz=15", "--set", "/usb/sharing=fair", "--pipelines",
                          "oracle", "--seeds", "8", "--first-seed", "5"));
  EXPECT_EQ(python_of(changed, kPaper, 8),
            "import simbench\n\nresult = simbench.run(\n    \"3cam_1host_30fps\",\n"
            "    pipelines=[\"oracle\"],\n    seeds=8,\n    first_seed=5,\n    set={\n"
            "        \"/trigger/rate_hz\": 15,\n        \"/usb/sharing\": \"fair\",\n"
            "    },\n)\nprint(result)\n");
}

TEST(StateTest, TheScenarioFileIsTheSameWorld) {
  for (
      const char* const text :
      {R"({"scenario": "3cam_1host_30fps", "sets": [{"pointer": "/usb/spike_probability", "value": 0.25}]})",
       R"({"scenario": "3cam_1host_30fps", "sets": [{"pointer": "/cameras/streams/0/width", "value": 640}]})",
       R"({"scenario": "3cam_1host_30fps", "pipelines": ["oracle"]})",
       R"({"scenario": "3cam_1host_30fps"})"}) {
    const State changed = state(text);
    const scenarios::Scenario world = world_of(changed, kPaper);
    const scenarios::Scenario again =
        scenarios::load_scenario_text(file_of(changed, kPaper), "explored.json");
    EXPECT_EQ(again.usb.spike_probability, world.usb.spike_probability) << text;
    EXPECT_EQ(again.cameras.streams[0].width, world.cameras.streams[0].width) << text;
    EXPECT_EQ(again.pipelines.size(), world.pipelines.size()) << text;
  }
}

TEST(StateTest, ARefusalStandsBesideItsParameter) {
  EXPECT_EQ(refusal(R"({"scenario": "3cam_1host_30fps", "sets":
                       [{"pointer": "/usb/spike_probability", "value": 2}]})"),
            "/usb/spike_probability|found 2, allowed a number from 0 to 1");
  EXPECT_THAT(refusal(R"({"scenario": "3cam_1host_30fps", "sets":
                          [{"pointer": "/usb/spike", "value": 2}]})"),
              HasSubstr("/usb/spike|"));
  EXPECT_THAT(refusal(R"({"scenario": "3cam_1host_30fps", "pipelines": ["none"]})"),
              HasSubstr("none"));
}

// A page that was told the token is still no way to the user's other files, nor to programs.
TEST(StateTest, OnlyWorldsCanBeSet) {
  EXPECT_THAT(refusal(R"({"scenario": "/etc/passwd"})"), HasSubstr("neither a scenario"));
  EXPECT_THAT(refusal(R"({"scenario": "../other.json"})"), HasSubstr("neither a scenario"));
  for (const char* const pointer : {"/pipelines/0/programs", "/pipelines", "/pipelines/-", "/name",
                                    "/published/oracle/amd_ms"}) {
    EXPECT_THAT(refusal(R"({"scenario": "3cam_1host_30fps", "sets": [{"pointer": ")" +
                        std::string(pointer) + R"(", "value": 1}]})"),
                HasSubstr("is no parameter of a world"))
        << pointer;
  }
  app::use_programs();  // as the command does
  EXPECT_THAT(refusal(R"({"scenario": "leaderboard_programs", "pipelines": ["chronyd"]})"),
              HasSubstr("chronyd is of real programs, which a page does not start"));
}

TEST(StateTest, WorldsThatAreTooLargeAreRefused) {
  EXPECT_THAT(refusal(R"({"scenario": "3cam_1host_30fps", "sets":
                          [{"pointer": "/timeline/frames", "value": 500000}]})"),
              HasSubstr("too much to play with"));
  EXPECT_THAT(refusal(R"({"scenario": "18cam_6host_45fps", "sets":
                          [{"pointer": "/hosts/count", "value": 100000}]})"),
              HasSubstr("too much to play with"));
}

TEST(StateTest, OtherFormsAreRefused) {
  for (const char* const text :
       {"[]", "1", "null", "{}", R"({"scenario": 1})",
        R"({"scenario": "3cam_1host_30fps", "sets": {}})",
        R"({"scenario": "3cam_1host_30fps", "sets": [1]})",
        R"({"scenario": "3cam_1host_30fps", "sets": [{"pointer": "/usb"}]})",
        R"({"scenario": "3cam_1host_30fps", "pipelines": [1]})",
        R"({"scenario": "3cam_1host_30fps", "pipelines": "oracle"})",
        R"({"scenario": "3cam_1host_30fps", "first_seed": -1})",
        R"({"scenario": "3cam_1host_30fps", "first_seed": 18446744073709551615})"}) {
    EXPECT_THROW(state(text), StateRefused) << text;
  }
}

TEST(StateTest, AFileIsWhatItWasAndKeepsTheChangesOfTheCommandLine) {
  const PageSubject rig{.name = "rig.json",
                        .text = R"({"name": "rig", "summary": "mine", "base": "3cam_1host_30fps",
                  "trigger": {"rate_hz": 20}})",
                        .sets = {{"/timeline/frames", "60"}}};
  const State begin = state(R"({"scenario": "rig.json"})", rig);
  const scenarios::Scenario world = world_of(begin, rig);
  EXPECT_EQ(world.trigger.rate_hz, 20);
  EXPECT_EQ(world.timeline.frames, 60);
  EXPECT_THAT(command_of(begin, rig, 8), testing::Contains("/timeline/frames=60"));
  const scenarios::Scenario again =
      scenarios::load_scenario_text(file_of(begin, rig), "explored.json");
  EXPECT_EQ(again.trigger.rate_hz, 20);
}

}  // namespace
}  // namespace simbench::explore
