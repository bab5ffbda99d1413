// Depth against colour through the real program: the paper's three ways to trigger a rig of both.
#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/cli/program.h"

namespace simbench {
namespace {

using Json = nlohmann::ordered_json;
using testing::HasSubstr;
using testing::Not;

constexpr int kSeedsOfColour = 40;
constexpr double kColourPeriodMs = 1000.0 / 90;
constexpr double kCameras = 18;

class DepthAgainstColour : public ProgramTest {
 protected:
  ProgramResult run_with(const std::string& mode, const std::vector<std::string>& more) const {
    std::vector<std::string> arguments = {"run",
                                          "--scenario",
                                          "18cam_6host_90fps_full_slave",
                                          "--set",
                                          "/cameras/sync_mode=" + mode,
                                          "--set",
                                          "/timeline/frames=90",
                                          "--seeds",
                                          std::to_string(kSeedsOfColour),
                                          "--pipelines",
                                          "oracle"};
    if (mode == "genlock") arguments.insert(arguments.end(), {"--set", "/trigger/rate_hz=45"});
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
  // Means over the seeds.
  struct Offset {
    double mean_ms = 0;
    double spread_ms = 0;
  };
  Offset offset_in(const std::string& mode) const {
    const ProgramResult result = run_with(mode, {"--format", "json"});
    EXPECT_EQ(result.status, 0) << result.err;
    const Json row = Json::parse(result.out)["rows"][0];
    const auto mean = [&row](const char* metric) {
      double sum = 0;
      for (const Json& value : row[metric]["values"]) sum += value.get<double>();
      return sum / kSeedsOfColour;
    };
    return {.mean_ms = mean("colour_offset_ms"), .spread_ms = mean("colour_offset_spread_ms")};
  }
};

// Four standard errors: |offset| of a camera deviates by T/sqrt(48), the range of n phases by
// T sqrt(2 (n - 1) / ((n + 1)^2 (n + 2))).
TEST_F(DepthAgainstColour, WhereColourRunsFreeItIsAQuarterOfItsPeriodAway) {
  for (const char* mode : {"genlock", "slave"}) {
    const Offset offset = offset_in(mode);
    EXPECT_NEAR(offset.mean_ms, kColourPeriodMs / 4,
                4 * kColourPeriodMs / std::sqrt(48 * kCameras * kSeedsOfColour))
        << mode;
    EXPECT_NEAR(offset.spread_ms, kColourPeriodMs * (kCameras - 1) / (kCameras + 1),
                4 * kColourPeriodMs / (kCameras + 1) *
                    std::sqrt(2 * (kCameras - 1) / (kCameras + 2) / kSeedsOfColour))
        << mode;
  }
}

// One pulse, one exposure time, global shutters.
TEST_F(DepthAgainstColour, InFullSlaveBothFollowThePulse) {
  const Offset offset = offset_in("full_slave");
  EXPECT_EQ(offset.mean_ms, 0);
  EXPECT_EQ(offset.spread_ms, 0);
}

TEST_F(DepthAgainstColour, HasATableWhereTheRigHasBoth) {
  EXPECT_THAT(run_with("full_slave", {"--verbose"}).out, HasSubstr("Colour against depth"));
  const ProgramResult depth_alone =
      run({"run", "--scenario", "3cam_1host_30fps", "--seeds", "2", "--verbose"});
  EXPECT_THAT(depth_alone.out, Not(HasSubstr("Colour against depth")));
}

}  // namespace
}  // namespace simbench
