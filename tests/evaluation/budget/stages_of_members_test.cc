// Every member of a scenario is in a stage of the budgets, and says what it is where that is ideal.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "evaluation/budget/budget.h"
#include "evaluation/budget/host_clock_budget.h"
#include "scenarios/ideal.h"
#include "scenarios/loader.h"
#include "scenarios/scenario_json.h"
#include "scenarios/schema.h"
#include "tests/nonempty.h"

namespace simbench::evaluation {
namespace {

using nlohmann::ordered_json;

std::set<std::string> known_stages() {
  std::set<std::string> stages = {"none"};
  for (const std::string_view stage : kStageNames) stages.emplace(stage);
  for (const HostClockPart& part : kHostClockParts) stages.emplace(part.cause);
  return stages;
}

// What a part of the schema says, or what it is in.
struct Said {
  bool is_world = true;
  std::string stage{};
  bool is_ideal = false;
  bool stays = false;
};

Said said_by(const ordered_json& node, Said outer) {
  outer.is_world = node.value("x-world", outer.is_world);
  outer.stage = node.value("x-stage", outer.stage);
  outer.is_ideal |= node.contains("x-ideal");
  outer.stays |= node.contains("x-stays");
  return outer;
}

void expect_said(const std::string& pointer, const Said& said) {
  EXPECT_TRUE(known_stages().contains(said.stage)) << pointer << ": x-stage: " << said.stage;
  EXPECT_TRUE(said.is_ideal || said.stays) << pointer << " needs x-ideal or x-stays (why)";
  EXPECT_FALSE(said.stage == "none" && said.is_ideal) << pointer;
}

std::size_t expect_all_said(const std::string& pointer, const ordered_json& node,
                            const Said& outer) {
  const Said said = said_by(node, outer);
  if (!said.is_world) return 0;
  if (node.contains("x-kinds")) {
    for (const auto& [kind, of_kind] : node["x-kinds"].items()) {
      expect_said(pointer + '/' + kind, said_by(of_kind, said));
    }
    return node["x-kinds"].size();
  }
  std::size_t leaves = 0;
  for (const char* const container : {"properties", "items", "additionalProperties"}) {
    if (!node.contains(container) || !node[container].is_object()) continue;
    if (container != std::string("properties")) {
      return expect_all_said(pointer + "/*", node[container], said);
    }
    for (const auto& [key, child] : node[container].items()) {
      leaves += expect_all_said(pointer + '/' + key, child, said);
    }
    return leaves;
  }
  expect_said(pointer, said);
  return 1;
}

TEST(StagesOfMembers, EveryMemberSaysItsStage) {
  EXPECT_GT(expect_all_said("", scenarios::ordered_schema(), {}), 200U);
}

// A world in which nothing is ideal.
scenarios::Scenario real_world() {
  return scenarios::load_scenario("18cam_6host_45fps_lan",
                                  {{"/trigger/pulse_jitter_sigma_us", "1"},
                                   {"/cameras/exposure_camera_periods", "0.1"},
                                   {"/cameras/frame_control",
                                    R"({"adjust_frame": true, "insert_frame": true,
                                        "frame_length": true, "start_at": true,
                                        "granularity_us": 10, "shortest_ms": 5, "longest_ms": 50,
                                        "latency_frames": 2, "delay_ms": 1,
                                        "delay_exponential_ms": 1, "loss_probability": 0,
                                        "insert_stretches": 1, "insert_noise_sigma_us": 1,
                                        "start_jitter_sigma_us": 1, "frame_jitter_sigma_us": 1,
                                        "sensor_clock": "camera"})"}});
}

TEST(StagesOfMembers, AnIdealStageChangesItsMembersAlone) {
  const nlohmann::json before = real_world();
  std::set<std::string> changed;
  for (const std::string& stage : nonempty(known_stages())) {
    if (stage == "none" || stage == "host clock" || stage == "gathering") continue;
    const nlohmann::json after = scenarios::with_ideal_stages(real_world(), {stage});
    const nlohmann::json changes = nlohmann::json::diff(before, after);
    EXPECT_FALSE(changes.empty()) << stage;
    for (const nlohmann::json& change : changes) {
      EXPECT_TRUE(changed.insert(change["path"].get<std::string>()).second) << change;
    }
  }
}

TEST(StagesOfMembers, WithoutAnIdealStageNothingChanges) {
  EXPECT_EQ(nlohmann::json(scenarios::with_ideal_stages(real_world(), {})),
            nlohmann::json(real_world()));
}

}  // namespace
}  // namespace simbench::evaluation
