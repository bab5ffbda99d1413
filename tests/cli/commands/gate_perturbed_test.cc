// `simbench gate` on an algorithm that was made worse: a regression over 5 frames in place of 30.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "algorithms/device_time/yoon2021.h"
#include "algorithms/registry.h"
#include "evaluation/run/evaluate.h"
#include "reports/archive/archive.h"
#include "scenarios/loader.h"
#include "sim/rig/simulation.h"
#include "tests/cli/program.h"

namespace simbench {
namespace {

using testing::HasSubstr;

class PerturbedGate : public ProgramTest {
 protected:
  static void SetUpTestSuite() {
    static bool is_done = false;  // a name may be registered once, also where tests are repeated
    if (std::exchange(is_done, true)) return;
    for (const auto& [name, frames] : {std::pair("regression_5", 5), {"regression_20", 20}}) {
      register_algorithm<DeviceTimeEntry>({.info = {.name = name,
                                                    .family = name,
                                                    .summary = "a perturbed regression_30",
                                                    .source = "",
                                                    .parameters = {}},
                                           .make = [frames = frames](const Parameters&) {
                                             return make_regression(
                                                 {static_cast<std::size_t>(frames)});
                                           }});
    }
  }

  // In this process, which knows the perturbed algorithm.
  void run_to(const std::string& output, const std::string& scenario_name,
              const std::string& pipeline, const std::string& device_time) const {
    const std::string pointer = device_time_of(scenario_name, pipeline);
    // Jitter that is independent from frame to frame: then a window's length is worth its root.
    const scenarios::Scenario scenario = scenarios::load_scenario(
        scenario_name, {{pointer, device_time}, {"/usb/host_jitter_transfers", "0"}});
    const evaluation::Results results = evaluation::evaluate(
        scenario, [&] { return sim::make_simulation(scenario); }, {.pipelines = {pipeline}},
        nullptr);
    reports::OutputFolder folder_of_run(folder() / output);
    reports::write_archive(folder_of_run, results, scenario,
                           {.command = {"simbench", "run"}, .started = {}, .finished = {}});
  }

  // Saves the unperturbed result and gates both.
  void expect_failure_in_both_modes(const std::string& scenario, const std::string& pipeline,
                                    const std::string& device_time) const {
    run_to("before", scenario, pipeline, "regression_30");
    const ProgramResult saved = run({"gate", "before", "--save-baseline", "b.json"});
    ASSERT_EQ(saved.status, 0) << saved.err;
    run_to("now", scenario, pipeline, device_time);
    for (const char* mode : {"exact", "statistical"}) {
      const auto gate = [&](const char* archive) {
        return run({"gate", archive, "--baseline", "b.json", "--mode", mode, "--junit", "j.xml"});
      };
      const ProgramResult same = gate("before");
      EXPECT_EQ(same.status, 0) << same.out << same.err;
      const ProgramResult result = gate("now");
      EXPECT_EQ(result.status, 3) << result.out << result.err;
      EXPECT_THAT(result.out, HasSubstr(fmt::format("FAILED: AMD of {} in {}, seeds 1-32", pipeline,
                                                    scenario)));
      EXPECT_THAT(result.out, HasSubstr("simbench gate now --baseline b.json"));
      EXPECT_THAT(content("j.xml"), HasSubstr("<failure message=\"AMD of " + pipeline));
    }
  }

 private:
  static std::string device_time_of(const std::string& scenario, const std::string& pipeline) {
    const auto resolved =
        nlohmann::json::parse(scenarios::load_scenario(scenario).resolved_json())["pipelines"];
    std::size_t index = 0;
    while (resolved.at(index)["name"] != pipeline) ++index;
    return "/pipelines/" + std::to_string(index) + "/device_time";
  }
};

TEST_F(PerturbedGate, FailsAt45Fps) {
  expect_failure_in_both_modes("18cam_6host_45fps", "yoon2021_both", "regression_5");
}

TEST_F(PerturbedGate, FailsAt15Fps) {
  expect_failure_in_both_modes("18cam_6host_15fps", "yoon2021_both", "regression_5");
}

TEST_F(PerturbedGate, FailsAt45FpsInANominalWorld) {
  expect_failure_in_both_modes("18cam_6host_45fps_lan", "yoon2021_both", "regression_5");
}

TEST_F(PerturbedGate, FailsAt15FpsInANominalWorld) {
  expect_failure_in_both_modes("18cam_6host_15fps_lan", "yoon2021_both", "regression_5");
}

// The scatter of a fit over n frames goes with 1 / sqrt(n), and with clocks that agree it is all
// there is: 20 frames in place of 30 are worth a fifth of AMD.
TEST_F(PerturbedGate, AFifthIsSeenByCompareAndByTheGate) {
  expect_failure_in_both_modes("18cam_6host_45fps_lan", "oracle", "regression_20");
  const ProgramResult result = run({"compare", "before", "now", "--format", "json"});
  const auto amd = nlohmann::json::parse(result.out)["pipelines"][0]["amd_ms"];
  EXPECT_EQ(amd["verdict"], "worse");
  EXPECT_EQ(amd["pairs"], 32);
  EXPECT_NEAR(amd["ratio"]["value"].get<double>(), 1.2, 0.05);
  EXPECT_GT(amd["ratio"]["low"], 1.1);
}

}  // namespace
}  // namespace simbench
