// `simbench code` through the real program.
#include <gmock/gmock.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <numeric>
#include <regex>
#include <string>
#include <vector>

#include "tests/cli/program.h"

namespace simbench {
namespace {

using Json = nlohmann::ordered_json;
using testing::AllOf;
using testing::HasSubstr;

constexpr const char* kCodedScenario = "18cam_6host_90fps_coded";

class CodeCommand : public ProgramTest {
 protected:
  // The table of a header.
  static std::vector<std::int64_t> ticks_of(const std::string& header) {
    const std::size_t begin = header.find("= {");
    const std::string table = header.substr(begin, header.find("};") - begin);
    std::vector<std::int64_t> ticks;
    const std::regex number("[0-9]+");
    for (std::sregex_iterator each(table.begin(), table.end(), number), end; each != end; ++each) {
      ticks.push_back(std::stoll(each->str()));
    }
    return ticks;
  }
};

TEST_F(CodeCommand, SaysWhatTheCodeIsAndWhatCamerasMakeOfIt) {
  const ProgramResult result = run({"code", kCodedScenario});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out,
              AllOf(HasSubstr("each pulse 50 us early or late"), HasSubstr("4 096 pulses, 45.5 s"),
                    HasSubstr("90.045 Hz"), HasSubstr("How soon a camera finds its place")));
  EXPECT_THAT(result.out, AllOf(HasSubstr("slave (own)"), HasSubstr("follows every pulse"),
                                HasSubstr("answers one in 2 pulses")));
}

TEST_F(CodeCommand, JsonHasTheSame) {
  const ProgramResult result = run({"code", kCodedScenario, "--format", "json"});
  ASSERT_EQ(result.status, 0) << result.err;
  const Json json = Json::parse(result.out);
  EXPECT_EQ(json["kind"], "trigger_code");
  EXPECT_EQ(json["code"]["length_pulses"], 4096);
  EXPECT_EQ(json["search"]["found"], json["search"]["places"]);
  EXPECT_EQ(json["search"]["wrong"], 0);
  EXPECT_LT(json["search"]["seconds_worst"], 0.4);
  ASSERT_EQ(json["modes"].size(), 3U);
  EXPECT_EQ(json["modes"][0]["mode"], "slave");
  EXPECT_EQ(json["modes"][0]["follows"], true);
  EXPECT_TRUE(json["modes"][2]["takes_to_us"].is_null()) << "genlock waits";
}

TEST_F(CodeCommand, ExportsTheIntervalsForATimer) {
  const ProgramResult result =
      run({"code", kCodedScenario, "--export", "intervals.h", "--timer-hz", "1000000"});
  ASSERT_EQ(result.status, 0) << result.err;
  const std::string header = content("intervals.h");
  EXPECT_THAT(header, AllOf(HasSubstr("#define CODE_TIMER_HZ 1000000UL"),
                            HasSubstr("#define CODE_INTERVALS 4096UL"),
                            HasSubstr("static const uint16_t code_interval_ticks")));
  const std::vector<std::int64_t> ticks = ticks_of(header);
  ASSERT_EQ(ticks.size(), 4096U);
  // 4096 pulses at 90.045 Hz: rounding does not add up.
  const std::int64_t sum = std::accumulate(ticks.begin(), ticks.end(), std::int64_t{0});
  EXPECT_NEAR(static_cast<double>(sum), 4096e6 / 90.045, 2);
}

TEST_F(CodeCommand, LeftOutPulsesAreLongerIntervals) {
  const ProgramResult result =
      run({"code", "18cam_6host_45fps_lan", "--set",
           R"(/trigger/code={"kind": "missing", "order": 6, "pulses_per_symbol": 4})", "--export",
           "intervals.h"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, AllOf(HasSubstr("the last of 4 pulses left out or not"),
                                HasSubstr("allowed \"position\" or \"frequency\"")));
  EXPECT_EQ(ticks_of(content("intervals.h")).size(), 256U - 32);
}

TEST_F(CodeCommand, RefusesWhatHasNoCodeAndWhatCamerasCannotFollow) {
  const ProgramResult without = run({"code", "18cam_6host_45fps"});
  EXPECT_EQ(without.status, 2);
  EXPECT_THAT(without.err, HasSubstr("found no /trigger/code"));
  const ProgramResult wide = run({"code", kCodedScenario, "--set", "/trigger/code/shift_us=80"});
  EXPECT_EQ(wide.status, 2);
  EXPECT_THAT(wide.err, AllOf(HasSubstr("/trigger/code/shift_us"), HasSubstr("allowed at most")));
  const ProgramResult slow = run({"code", kCodedScenario, "--export", "x.h", "--timer-hz", "50"});
  EXPECT_EQ(slow.status, 2);
  EXPECT_THAT(slow.err, HasSubstr("--timer-hz: found 50"));
}

TEST_F(CodeCommand, AShiftWithinTheNoiseIsSaidToBeHidden) {
  const ProgramResult result = run({"code", kCodedScenario, "--set", "/trigger/code/shift_us=2"});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("does NOT find its place"));
}

TEST_F(CodeCommand, TheFigureShowsTheCodeInTheStamps) {
  const ProgramResult drawn = run({"figure", "coded_trigger", "--scenario", kCodedScenario, "--set",
                                   "/timeline/frames=80", "--output", "code.csv"});
  EXPECT_EQ(drawn.status, 0) << drawn.err;
  EXPECT_THAT(content("code.csv"),
              AllOf(HasSubstr("Pulses as the cameras' own clocks show them"),
                    HasSubstr("the code,"), HasSubstr("The search for the place in the code")));
  const ProgramResult without =
      run({"figure", "coded_trigger", "--scenario", "3cam_1host_30fps", "--output", "none.csv"});
  EXPECT_EQ(without.status, 2);
  EXPECT_THAT(without.err, HasSubstr("the scenario's trigger has no code (/trigger/code)"));
}

TEST_F(CodeCommand, ARunSaysHowThePlacesWereFound) {
  const ProgramResult result =
      run({"run", "--scenario", kCodedScenario, "--pipelines", "coded", "--seeds", "1", "--set",
           "/timeline/frames=60", "--no-levers", "--verbose"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, AllOf(HasSubstr("Places in the trigger's code"), HasSubstr("18 of 18")));
}

}  // namespace
}  // namespace simbench
