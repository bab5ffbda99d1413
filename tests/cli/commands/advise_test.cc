// simbench advise through the real program: what it answers, what it refuses.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/cli/program.h"

namespace simbench {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

class AdviseTest : public ProgramTest {
 protected:
  static std::vector<std::string> command(const std::string& requirement,
                                          const std::vector<std::string>& more = {},
                                          const std::string& seeds = "4") {
    std::vector<std::string> arguments = {"advise",
                                          "--require",
                                          requirement,
                                          "--cameras",
                                          "4",
                                          "--rate",
                                          "30",
                                          "--hosts",
                                          "2",
                                          "--seeds",
                                          seeds,
                                          "--set",
                                          "/timeline/frames=60"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }

  std::string refusal(const std::vector<std::string>& arguments) const {
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.status, 2) << result.out;
    EXPECT_EQ(result.out, "");
    return result.err;
  }
};

TEST_F(AdviseTest, AnswersFirst) {
  const ProgramResult result = run(command("amd<0.1ms", {}, "72"));
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out,
              StartsWith("4 cameras at 30 Hz: amd<0.1ms\n2 x office_pc, office_switch"));
  EXPECT_THAT(result.out, AllOf(HasSubstr("in 72 of 72 simulated rigs"), HasSubstr("Margin"),
                                HasSubstr("Fails first: The stage"), HasSubstr("What is assumed")));
}

TEST_F(AdviseTest, IsTheSameAgainWithAnyNumberOfThreads) {
  const ProgramResult one = run(command("amd<0.1ms", {"--format", "json", "--jobs", "1"}));
  const ProgramResult two = run(command("amd<0.1ms", {"--format", "json", "--jobs", "2"}));
  ASSERT_EQ(one.status, 0) << one.err;
  EXPECT_EQ(one.out, two.out);
  const auto root = nlohmann::json::parse(one.out);
  EXPECT_TRUE(root["recommended"].is_null()) << "four seeds show nothing with 95 %";
  EXPECT_THAT(root["answer"]["lead"].get<std::string>(), StartsWith("No rig is shown to meet"));
  EXPECT_EQ(root["options"][0]["pipelines"][0]["met"], 4);
  EXPECT_TRUE(root["rare"].is_null());
}

TEST_F(AdviseTest, SaysWhenNothingMeetsIt) {
  const ProgramResult result = run(command("amd<1ns"));
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("None of 6 rigs meets amd<1ns"));
}

TEST_F(AdviseTest, RefusesBadRequirements) {
  EXPECT_THAT(refusal(command("speed<1ms")),
              HasSubstr("--require: found 'speed', allowed a metric"));
  EXPECT_THAT(refusal(command("amd<1kg")), HasSubstr("the unit s, ms, us or ns"));
  EXPECT_THAT(refusal(command("amd")), HasSubstr("METRIC<VALUE"));
  EXPECT_THAT(refusal(command("amd<0ms")), HasSubstr("nothing is below 0"));
  EXPECT_THAT(refusal(command("recall>100%")), HasSubstr("nothing is above 100 %"));
}

TEST_F(AdviseTest, RefusesBadRigs) {
  const auto rig = [](const std::string& cameras, const std::string& rate,
                      const std::string& hosts) {
    return std::vector<std::string>{"advise", "--require", "amd<1ms", "--cameras", cameras,
                                    "--rate", rate,        "--hosts", hosts};
  };
  EXPECT_THAT(refusal(rig("4", "30", "8..2")), HasSubstr("--hosts: found '8..2', allowed"));
  EXPECT_THAT(refusal(rig("4", "30", "0..2")), HasSubstr("--hosts: found '0..2', allowed"));
  EXPECT_THAT(refusal(rig("4", "30", "two")), HasSubstr("--hosts: found 'two', allowed"));
  EXPECT_THAT(refusal(rig("4", "61", "2")), HasSubstr("--rate: found 61, allowed"));
  EXPECT_THAT(refusal(rig("0", "30", "2")), HasSubstr("--cameras: found '0', allowed"));
  EXPECT_THAT(refusal(rig("400", "30", "2")), HasSubstr("--cameras: found 400"));
  EXPECT_THAT(refusal(rig("1", "30", "1")), HasSubstr("of a single camera"));
  EXPECT_THAT(refusal({"advise", "--cameras", "4"}), HasSubstr("--require"));
}

TEST_F(AdviseTest, RefusesOptionsThatMeanNothing) {
  EXPECT_THAT(refusal(command("amd<1ms", {"--bound-ms", "1"})), HasSubstr("without --per-day"));
  EXPECT_THAT(refusal(command("amd<1ms", {"--per-day", "--pipeline", "magic"})),
              HasSubstr("--pipeline: found 'magic'"));
  EXPECT_THAT(refusal(command("amd<1ms", {"--set", "/hosts/nothing=1"})),
              HasSubstr("/hosts/nothing"));
}

TEST_F(AdviseTest, ATaskMayStateWhatItTolerates) {
  const ProgramResult result = run(command("5mm at 2m/s exposed 1ms"));
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out,
              HasSubstr("5mm at 2m/s exposed 1ms is taken as exposure_spread<=1.5ms and "
                        "precision>=99%."));
  EXPECT_THAT(refusal(command("5mm at 2")),
              HasSubstr("--require: found '5mm at 2', allowed LENGTH"));
}

// Each Raspberry Pi is a host of its own; so is a camera of the user that says so.
TEST_F(AdviseTest, CamerasMayBeSteered) {
  const std::string mine = file("mine.json", R"({"part": "mine", "kind": "camera", "name": "Mine",
    "prices": [], "price_source": "none", "source": "none", "world": "8cam_raspberry_30fps",
    "is_host": true, "host_sync": ["chrony_lan"], "capture_alignment": ["rpi_sync"],
    "device_time": ["host_stamps"]})");
  const ProgramResult result =
      run({"advise", "--require", "exposure_spread<100ms", "--camera", "mine", "--parts", mine,
           "--cameras", "3", "--rate", "30", "--seeds", "2", "--set", "/timeline/frames=60",
           "--set", "/timeline/warm_up_ms=1000"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("3 x mine, office_switch"));
  EXPECT_THAT(result.out, HasSubstr("chrony_lan + rpi_sync + host_stamps + yoon2021"));
  for (const std::string& camera : {std::string("raspberry_camera_v3"), std::string("mine")}) {
    EXPECT_THAT(refusal(command("amd<1ms", {"--camera", camera, "--parts", mine})),
                HasSubstr("--hosts: found '2', but each " + camera + " is a host of its own"));
  }
  EXPECT_THAT(refusal(command("amd<1ms", {"--camera", "webcam"})),
              HasSubstr("--camera: found 'webcam', allowed: d455, gige_ace, oak_4, "));
}

TEST_F(AdviseTest, TakesPartsOfTheUser) {
  const std::string part =
      R"({"part": "cheap_pc", "kind": "host", "name": "n", "price_source": "p", "source": "s",
          "cameras": 3, "slots": 0, "prices": [{"per": "host", "low_eur": 1, "high_eur": 2}]})";
  const std::string name = file("mine.json", part);
  const ProgramResult result = run(command("amd<0.1ms", {"--parts", name}));
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("2 x cheap_pc, office_switch"));
  EXPECT_THAT(refusal(command("amd<1ms", {"--parts", name, "--parts", name})),
              HasSubstr("a name that no other part has"));
  EXPECT_THAT(refusal(command("amd<1ms", {"--parts", "nowhere.json"})),
              HasSubstr("cannot be read"));
  EXPECT_THAT(refusal(command("amd<1ms", {"--parts", file("bad.json", "{\"part\": 1}")})),
              HasSubstr("bad.json:1"));
}

}  // namespace
}  // namespace simbench
