// The same scenario and seed give the same bytes: on one thread or several, and - through the
// digest below, which every build of the project must reproduce - with every compiler, build type
// and sanitizer. A change that is meant changes the digest; say why in its commit.
#include <gtest/gtest.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "evaluation/run/evaluate.h"
#include "reports/results/json.h"
#include "scenarios/loader.h"
#include "sim/rig/simulation.h"

namespace simbench {
namespace {

std::string results_without_performance(const scenarios::Scenario& scenario,
                                        const evaluation::EvaluationOptions& options) {
  const evaluation::Results results =
      evaluation::evaluate(scenario, [&] { return sim::make_simulation(scenario); }, options, {});
  nlohmann::ordered_json json = nlohmann::ordered_json::parse(reports::json(results));
  for (const char* varies : {"performance", "version", "commit"}) json.erase(varies);
  for (const char* m : {"levers", "levers_seeds"}) json["answer"].erase(m);
  return json.dump();
}

std::uint64_t digest(const std::string& text) {
  std::uint64_t hash = 0xCBF29CE484222325;  // FNV-1a
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001B3;
  return hash;
}

TEST(Determinism, ResultsDependOnNeitherThreadsNorCompilerNorFlags) {
  for (const auto& [name, expected] : {std::pair{"18cam_6host_45fps", 0x43fae0fe066c2fc7ULL},
                                       std::pair{"18cam_6host_15fps_lan", 0xd6502defcf3cd211ULL}}) {
    const scenarios::Scenario scenario =
        scenarios::load_scenario(name, {{"/timeline/frames", "60"}});
    const std::string one_thread = results_without_performance(scenario, {.seeds = 3, .jobs = 1});
    EXPECT_EQ(one_thread, results_without_performance(scenario, {.seeds = 3, .jobs = 4}))
        << name << ", seeds 1 to 3";
    EXPECT_EQ(digest(one_thread), expected)
        << name << ", seeds 1 to 3: the digest is now 0x" << std::hex << digest(one_thread);
  }
}

// Pipelines of one host_sync share a capture, with messages and with clocks left alone, and in both
// worlds: with a load for each pipeline, and without.
TEST(Determinism, SharedCapturesGiveTheSameBytes) {
  for (const char* name : {"18cam_6host_45fps", "leaderboard_lan"}) {
    scenarios::Scenario scenario = scenarios::load_scenario(name, {{"/timeline/frames", "60"}});
    scenario.pipelines = {{"a", "yoon2021_both", "regression_30", "yoon2021"},
                          {"b", "free_running", "sensor_normalised", "genlock"},
                          {"c", "yoon2021_both", "regression_offline", "oracle"},
                          {"d", "free_running", "regression_30", "yoon2021"},
                          {"e", "yoon2021_both", "oracle", "yoon2021"}};
    scenario.published.clear();
    for (const unsigned jobs : {1U, 2U}) {
      EXPECT_EQ(
          results_without_performance(scenario, {.seeds = 2, .jobs = jobs, .share_captures = true}),
          results_without_performance(scenario, {.seeds = 2, .jobs = jobs}))
          << name << ", seeds 1 to 2, " << jobs << " threads";
    }
  }
}

}  // namespace
}  // namespace simbench
