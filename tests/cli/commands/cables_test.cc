// `simbench run` of rigs without a trigger cable: the answer first, and what cameras cannot do is
// said.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/cli/program.h"

namespace simbench {
namespace {

using testing::HasSubstr;
using testing::Not;

class Cables : public ProgramTest {
 protected:
  ProgramResult raspberry(std::vector<std::string> more) const {
    std::vector<std::string> command = {"run",
                                        "--scenario",
                                        "8cam_raspberry_30fps",
                                        "--seeds",
                                        "1",
                                        "--set",
                                        "/timeline/frames=150",
                                        "--pipelines",
                                        "phase_rate,rpi_sync"};
    command.insert(command.end(), more.begin(), more.end());
    return run(command);
  }
};

TEST_F(Cables, TheQuestionIsAnsweredFirst) {
  const ProgramResult result =
      run({"run", "--scenario", "leaderboard_without_cables", "--seeds", "1", "--set",
           "/timeline/frames=90", "--pipelines", "trigger_tree,align.phase_rate,free_run,oracle"});
  EXPECT_EQ(result.status, 0) << result.err;
  const std::string second_line = result.out.substr(result.out.find('\n') + 1);
  EXPECT_TRUE(second_line.starts_with("No trigger cable is needed for 1 ms")) << result.out;
  EXPECT_THAT(second_line, HasSubstr("With the cable, trigger_tree has"));
}

TEST_F(Cables, AControlThatCamerasLackIsANoteOfTheRow) {
  EXPECT_THAT(raspberry({}).out, Not(HasSubstr("unaligned")));
  const ProgramResult result = raspberry({"--set", "/cameras/frame_control/adjust_frame=false",
                                          "--set", "/cameras/frame_control/frame_length=false"});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("rpi_sync, repetition 1: capture_alignment left a camera "
                                    "unaligned: the camera has no control adjust_frame"));
}

TEST_F(Cables, ControlsThatAreLostOrLateAreRepeated) {
  const ProgramResult result =
      raspberry({"--set", "/cameras/frame_control/loss_probability=0.5", "--set",
                 "/cameras/frame_control/delay_exponential_ms=100", "--format", "json"});
  EXPECT_EQ(result.status, 0) << result.err;
  const nlohmann::json row = nlohmann::json::parse(result.out)["rows"][0];
  EXPECT_LT(row["exposure_spread_median_ms"]["median"], 1);
  EXPECT_EQ(row["wrong_locks"]["median"], 0);
}

TEST_F(Cables, WhatNoSensorCouldMakeIsRefused) {
  const auto refusal = [&](const std::string& change) {
    const ProgramResult result = raspberry({"--set", change});
    EXPECT_EQ(result.status, 2) << change;
    return result.err;
  };
  EXPECT_THAT(refusal("/cameras/exposure_ms=34"), HasSubstr("found exposures of up to 34 ms"));
  EXPECT_THAT(refusal("/cameras/frame_control/longest_ms=33"),
              HasSubstr("a grid that the cameras' rate cannot reach"));
  EXPECT_THAT(refusal("/cameras/frame_control/granularity_us=-1"), HasSubstr("granularity_us"));
}

}  // namespace
}  // namespace simbench
