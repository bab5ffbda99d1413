// `simbench fit` through the real program.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "tests/cli/commands/rs_csv_files.h"
#include "tests/cli/program.h"
#include "tests/data/ibl_recordings.h"

namespace simbench {
namespace {

using Json = nlohmann::ordered_json;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

class FitCommand : public ProgramTest {
 protected:
  // At 30 FPS; the camera's clock is 100 ppm fast, every third frame 0.3 ms late.
  static std::string recording(int frames, double first_stamp_ms = 700, double rate = 1.0001) {
    std::string text = kHeader;
    for (int i = 0; i < frames; ++i) {
      const double ms = i * 1000.0 / 30;
      text += fmt::format("Depth,0,{},{:.3f},{:.6f}\n", i + 1, first_stamp_ms + ms * rate,
                          ms + (i % 3 == 0 ? 0.3 : 0));
    }
    return text;
  }
  // The recording's delays have the distribution of those of the model that is fitted to it, and
  // the camera's clock is this much fast.
  void expect_agreement(const std::string& ibl_recording, double skew_ppm) const {
    file("body.csv", run({"convert-ibl", ibl_recording}).out);
    const ProgramResult fitted = run({"fit", "body.csv", "-o", "body.json", "--format", "json"});
    ASSERT_EQ(fitted.status, 0) << fitted.err;
    const Json whole = Json::parse(fitted.out)["checks"][0];
    EXPECT_LT(whole["ks"].get<double>(), whole["ks_limit"].get<double>());
    EXPECT_NEAR(whole["skew_ppm"][0]["recorded"]["value"].get<double>(), skew_ppm, 0.2);
  }
};

TEST_F(FitCommand, MakesAScenarioThatIsValidAndRuns) {
  const ProgramResult fitted = run({"fit", file("a.csv", recording(600)), "-o", "model.json"});
  ASSERT_EQ(fitted.status, 0) << fitted.err;
  EXPECT_THAT(fitted.out, AllOf(HasSubstr("drift of a, ppm"), HasSubstr("Hold-out"),
                                HasSubstr("the constant part of the delivery delay")));
  EXPECT_EQ(run({"validate", "model.json"}).status, 0);
  const ProgramResult described = run({"describe", "model.json"});
  EXPECT_THAT(described.out, HasSubstr("/usb/delivery_quantiles_ms"));
  const ProgramResult ran = run({"--scenario", "model.json", "--seeds", "2", "--set",
                                 "/timeline/frames=20", "--format", "json"});
  ASSERT_EQ(ran.status, 0) << ran.err;
  EXPECT_FALSE(Json::parse(ran.out)["rows"].empty());
}

TEST_F(FitCommand, JsonHasBothChecks) {
  const ProgramResult fitted =
      run({"fit", file("a.csv", recording(600)), file("b.csv", recording(300)), "--one-host", "-o",
           "model.json", "--format", "json"});
  ASSERT_EQ(fitted.status, 0) << fitted.err;
  const Json root = Json::parse(fitted.out);
  EXPECT_EQ(root["schema_version"], 1);
  EXPECT_EQ(root["base"], "3cam_1host_30fps");
  ASSERT_EQ(root["checks"].size(), 2U);
  EXPECT_EQ(root["checks"][1]["check"], "hold_out");
  EXPECT_EQ(root["checks"][0]["excess_ms"].size(), 8U);
  EXPECT_TRUE(root["trust"]["held_out"].get<bool>());
  EXPECT_FALSE(root["trust"]["text"].get<std::string>().empty());
  EXPECT_EQ(root["checks"][1]["verdicts"][0]["what"], "delays");
  EXPECT_LT(root["checks"][0]["skew_ppm"][0]["recorded"]["low"].get<double>(), 100.5);
  EXPECT_NEAR(root["checks"][0]["skew_ppm"][0]["recorded"]["value"].get<double>(), 100, 0.5);
  EXPECT_NEAR(root["checks"][0]["skew_ppm"][0]["simulated"]["value"].get<double>(), 100, 0.5);
}

// A camera under PTP has them, and a ROS header: the fit has the rate of that clock, whichever.
TEST_F(FitCommand, StampsThatCountFrom1970AreFittedAndNamed) {
  const ProgramResult fitted =
      run({"fit", file("ptp.csv", recording(600, 1.7e12)), "-o", "model.json", "--format", "json"});
  ASSERT_EQ(fitted.status, 0) << fitted.err;
  const Json root = Json::parse(fitted.out);
  EXPECT_NEAR(root["checks"][0]["skew_ppm"][0]["recorded"]["value"].get<double>(), 100, 0.5);
  EXPECT_THAT(root["not_identified"].dump(), HasSubstr("the oscillator of ptp: stamps that count"));
}

// Whether frames were lost is unknown then, and the model keeps what the base has.
TEST_F(FitCommand, WithoutCountersNoFrameIsCalledLostOrKept) {
  std::string text = "sensor_ms,arrival_ms\n";
  std::istringstream lines(recording(600));
  std::string line;
  std::getline(lines, line);
  for (int i = 0; std::getline(lines, line); ++i) {
    if (i % 10 != 7) text += line.substr(line.find(',', line.find(',', 6) + 1) + 1) + "\n";
  }
  const ProgramResult fitted =
      run({"fit", file("a.csv", text), "--columns", "sensor=sensor_ms,arrival=arrival_ms", "-o",
           "model.json", "--format", "json"});
  ASSERT_EQ(fitted.status, 0) << fitted.err;
  const Json root = Json::parse(fitted.out);
  EXPECT_TRUE(root["checks"][0]["drop_share"]["recorded"].is_null());
  EXPECT_THAT(root["not_identified"].dump(), HasSubstr("lost frames: these cameras do not count"));
  EXPECT_FALSE(Json::parse(content("model.json"))["cameras"].contains("drop_probability"));
}

TEST_F(FitCommand, AnIblRecordingAgreesWithItsSimulatedModel) {
  // -215 ppm of the host's clock against the camera's.
  expect_agreement(file("a.timestamps.ssv", ibl_timestamps()), 215.05);
}

TEST_F(FitCommand, ARealRecordingAgreesWithItsSimulatedModel) {
  SIMBENCH_SKIP_WITHOUT(kRealBody);
  // -214.932 ppm by the lower envelope.
  expect_agreement(kRealBody, 214.98);
}

TEST_F(FitCommand, ARecordingFolderIsFittedOverItsOwnScenario) {
  const ProgramResult recorded =
      run({"record", "--scenario", "3cam_1host_30fps", "--seed", "3", "-o", "monday"});
  ASSERT_EQ(recorded.status, 0) << recorded.err;
  const ProgramResult fitted = run({"fit", "monday", "-o", "model.json", "--format", "json"});
  ASSERT_EQ(fitted.status, 0) << fitted.err;
  EXPECT_EQ(Json::parse(fitted.out)["base"], "3cam_1host_30fps");
  EXPECT_EQ(Json::parse(content("model.json"))["base"], "3cam_1host_30fps");
  const ProgramResult other = run({"fit", "monday", "--seed", "9", "-o", "model.json"});
  EXPECT_EQ(other.status, 2);
  EXPECT_THAT(other.err, HasSubstr("monday: found no such capture, allowed "));
}

TEST_F(FitCommand, BadInputIsOneLineAndLeavesTheEarlierFile) {
  file("model.json", "earlier");
  const auto refused = [this](std::vector<std::string> inputs, const std::string& text) {
    inputs.insert(inputs.begin(), "fit");
    inputs.insert(inputs.end(), {"-o", "model.json"});
    const ProgramResult result = run(inputs);
    EXPECT_EQ(result.status, 2) << text;
    EXPECT_THAT(result.err, HasSubstr(text));
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(content("model.json"), "earlier");
  };
  refused({file("few.csv", recording(50))},
          "camera few, Depth 0: found 50 frames, a fit needs 100");
  // Stamps in microseconds, where milliseconds are meant, drift by nearly 10^6 ppm.
  refused({file("thousand.csv", recording(150, 700, 1000))},
          "camera thousand, Depth 0: found a drift of ");
  refused({file("percent.csv", recording(150, 700, 1.02))},
          "camera percent, Depth 0: found a drift of ");
  refused({file("fast.csv", recording(150)), "--base", "no_such"}, "no_such");
  refused({file("x.csv", recording(150)), "--seed", "1"}, "--pipeline and --seed choose");
  std::filesystem::create_directory(folder() / "empty");
  refused({"empty"}, "empty");
  refused({"empty", "x.csv"}, "allowed one recording folder, or files");
  EXPECT_THAT(names_in("empty"), ElementsAre());
}

}  // namespace
}  // namespace simbench
