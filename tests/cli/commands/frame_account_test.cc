// One account of a file's frames, as inspect, diagnose, replay and fit of the real program have it.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "tests/cli/commands/rs_csv_files.h"
#include "tests/cli/program.h"

namespace simbench {
namespace {

using Json = nlohmann::ordered_json;
using testing::HasSubstr;

class FrameAccountOfCommands : public ProgramTest {
 protected:
  // Two minutes at 30 Hz on a clock that is 40 ppm slow. Three frames of the first five seconds and
  // four later ones are lost; three pulses are missed.
  static std::string recording() {
    const std::set<int> lost = {30, 31, 100, 900, 1500, 1501, 1502};
    const std::set<int> missed = {2000, 2500, 2501};
    std::string text = kHeader;
    int counter = 0;
    for (int i = 0; i < 3600; ++i) {
      if (missed.contains(i)) continue;
      ++counter;
      if (lost.contains(i)) continue;
      const double ms = i * 1000.0 / 30;
      text += fmt::format("Depth,0,{},{:.3f},{:.3f}\n", counter, 5000 + ms * (1 - 40e-6),
                          20 + ms + i % 5 * 0.1);
    }
    return text;
  }
};

TEST_F(FrameAccountOfCommands, IsTheSameAndRight) {
  const std::string name = file("a.csv", recording());
  const Json inspected = Json::parse(run({"inspect", name, "--format", "json"}).out);
  const Json& stream = inspected["files"][0]["streams"][0];
  EXPECT_EQ(stream["frames"], 3590);
  EXPECT_EQ(stream["lost_frames"], 7);
  EXPECT_EQ(stream["never_exposed_frames"], 3);
  EXPECT_EQ(stream["unknown_frames"], 0);

  const Json diagnosed = Json::parse(run({"diagnose", name, "--format", "json"}).out);
  const Json& camera = diagnosed["cameras"][0];
  EXPECT_EQ(camera["frames"], 3590);
  EXPECT_EQ(camera["lost_frames"], 7);
  EXPECT_EQ(camera["never_exposed_frames"], 3);
  EXPECT_EQ(camera["unknown_frames"], 0);

  const ProgramResult replayed =
      run({"replay", name, "--pipelines", "hull_300", "--format", "json"});
  const Json frames = Json::parse(replayed.out)["rows"][0]["frames"];
  EXPECT_EQ(frames["delivered"], 3590);
  EXPECT_EQ(frames["dropped"], 7);
  EXPECT_THAT(run({"replay", name, "--pipelines", "hull_300"}).out,
              testing::ContainsRegex("a +Depth 0 +3[,' ]?590 +7 +3 +0"));

  const ProgramResult fitted = run({"fit", name, "--output", "model.json"});
  EXPECT_EQ(fitted.status, 0) << fitted.err;
  EXPECT_THAT(fitted.out, HasSubstr("7 of 3597 frames lost"));
}

TEST_F(FrameAccountOfCommands, WithoutACounterNothingIsKnownOfWhatIsMissing) {
  std::string text = "camera stamp,host stamp\n";
  for (int i = 0; i < 900; ++i) {
    if (i == 50 || i == 51 || i == 600) continue;
    text += fmt::format("{:.3f},{:.3f}\n", 5000 + i * 1000.0 / 30, 20 + i * 1000.0 / 30);
  }
  file("b.csv", text);
  const std::string columns = "sensor=camera stamp,arrival=host stamp";
  const Json inspected =
      Json::parse(run({"inspect", "b.csv", "--columns", columns, "--format", "json"}).out);
  EXPECT_EQ(inspected["files"][0]["streams"][0]["lost_frames"], 0);
  EXPECT_EQ(inspected["files"][0]["streams"][0]["unknown_frames"], 3);
  const Json diagnosed =
      Json::parse(run({"diagnose", "b.csv", "--columns", columns, "--format", "json"}).out);
  EXPECT_EQ(diagnosed["cameras"][0]["unknown_frames"], 3);
}

}  // namespace
}  // namespace simbench
