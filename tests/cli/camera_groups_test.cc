// Several camera models in one rig, by the real command against calculated values.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/cli/program.h"

namespace simbench {
namespace {

using Json = nlohmann::ordered_json;
using testing::HasSubstr;

class CameraGroups : public ProgramTest {
 protected:
  // The rows of a run of two seeds in a world without noise.
  Json rows(const std::string& scenario, const std::string& pipelines,
            const std::vector<std::string>& sets = {}) {
    std::vector<std::string> command = {"run",      "--scenario", scenario,      "--seeds", "2",
                                        "--format", "json",       "--pipelines", pipelines};
    std::vector<std::string> all = sets;
    for (const char* noise :
         {"/trigger/pulse_jitter_sigma_us", "/trigger/branch_delay_max_us",
          "/trigger/cable_delay_max_us", "/usb/kernel_copy_exponential_ms",
          "/usb/delivery_jitter_transfers", "/usb/host_jitter_transfers", "/usb/spike_probability",
          "/cameras/calibration/delay_error_sigma_ms",
          "/cameras/calibration/camera_delay_error_sigma_ms", "/cameras/oscillator/skew_sigma_ppm",
          "/cameras/oscillator/white_frequency_ppb",
          "/cameras/oscillator/random_walk_ppb_per_sqrt_s"}) {
      all.push_back(std::string(noise) + "=0");
    }
    all.emplace_back("/timeline/frames=120");
    for (const std::string& each : all) {
      command.emplace_back("--set");
      command.push_back(each);
    }
    const ProgramResult result = run(command);
    EXPECT_EQ(result.status, 0) << result.err;
    return Json::parse(result.out).at("rows");
  }
  static double median(const Json& row, const char* metric) {
    return row.at(metric).at("median").get<double>();
  }
};

// Start delays of 30 and 19 us; 11 ms and 3.1 MB, 1.3 ms and 2.3 MB at 400 MB/s.
constexpr double kStartsApartMs = 0.011;
constexpr double kFirstDelayMs = 11 + 2048 * 1536 * 1e-3 / 400;
constexpr double kSecondDelayMs = 1.3 + 1920 * 1200 * 1e-3 / 400;

TEST_F(CameraGroups, ExposuresSpreadByTheStartDelaysAndArrivalsByTheTransfersToo) {
  const Json all = rows("6cam_mixed_models_30fps", "oracle,raw_arrival_oracle_hosts");
  EXPECT_NEAR(median(all[0], "amd_ms"), kStartsApartMs, 2e-6);
  EXPECT_NEAR(median(all[0], "exposure_spread_ms"), kStartsApartMs, 2e-6);
  // Arrivals are in steps of 1 us.
  EXPECT_NEAR(median(all[1], "amd_ms"), kFirstDelayMs + kStartsApartMs - kSecondDelayMs, 0.0015);
  const double exposure_ms = 5;
  EXPECT_NEAR(median(all[1], "bias_ms"), exposure_ms / 2 + (kFirstDelayMs + kSecondDelayMs) / 2,
              0.0015);
}

// A longer exposure of one model moves its middle by half of what it is longer.
TEST_F(CameraGroups, UnequalExposuresSpreadByHalfOfTheirDifference) {
  const Json all = rows("6cam_mixed_models_30fps", "oracle", {"/cameras/groups/1/exposure_ms=9"});
  EXPECT_NEAR(median(all[0], "exposure_spread_ms"), 2 - kStartsApartMs, 2e-6);
}

TEST_F(CameraGroups, DelaysAreCalibratedForEachModel) {
  const Json all = rows("6cam_mixed_models_30fps", "raw_arrival_calibrated",
                        {"/hosts/clock/oscillator/skew_sigma_ppm=0"});
  // Delays are rounded to 0.01 ms; the rest is chrony's.
  EXPECT_LT(median(all[0], "amd_ms"), 0.1);
}

// 120 pulses, of which three cameras expose every second.
TEST_F(CameraGroups, UnequalRatesAreGatheredByTheSlowerOne) {
  const Json all = rows("6cam_mixed_rates_60fps", "oracle");
  EXPECT_NEAR(median(all[0], "amd_ms"), kStartsApartMs, 2e-6);
  const Json& sets = all[0].at("gathering_score");
  EXPECT_EQ(sets.at("recall").get<double>(), 1);
  EXPECT_EQ(sets.at("precision").get<double>(), 1);
  EXPECT_EQ(sets.at("due_pulses").get<int>(), 2 * 60);
  EXPECT_EQ(sets.at("complete_pulses").get<int>(), 2 * 60);
  const Json& frames = all[0].at("frames");
  EXPECT_EQ(frames.at("expected").get<int>(), 2 * 3 * (120 + 60));
  EXPECT_EQ(frames.at("dropped").get<int>(), 0);
}

TEST_F(CameraGroups, TheTableNamesTheModels) {
  const ProgramResult result = run({"run", "--scenario", "6cam_mixed_rates_60fps", "--seeds", "1",
                                    "--pipelines", "oracle", "--set", "/timeline/frames=60"});
  EXPECT_THAT(result.out, HasSubstr("of basler_aca1920_155um: colour of 1920 x 1200 at 60 Hz"));
  EXPECT_THAT(result.out, HasSubstr("flir_bfs_u3_31s4: colour of 2048 x 1536 at 30 Hz"));
}

}  // namespace
}  // namespace simbench
