// Schema, structs and the list of fields between them say the same.
#include "scenarios/schema.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "scenarios/builtin_files.h"
#include "scenarios/document.h"
#include "scenarios/fields.h"
#include "scenarios/loader.h"
#include "scenarios/study.h"
#include "tests/scenarios/support.h"

namespace simbench::scenarios {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

// A scenario that uses everything that may be left empty.
json full_document() {
  const std::string law =
      R"({"fixed_us": 1, "exponential_us": 1, "quantiles_us": [1, 2], "spike_probability": 0,
          "spike_max_us": 1, "common_share": 0, "common_time_ms": 1})";
  const std::string text = derived(R"("faults": [
      {"kind": "camera_vanishes", "camera": 1, "at_ms": 1, "duration_ms": 2},
      {"kind": "clock_step", "host": 1, "at_ms": 3, "step_ms": 4},
      {"kind": "leap_second", "at_ms": 5, "smear_ms": 20000, "inserted": true}],
    "trigger": {"pauses": [{"at_ms": 5, "duration_ms": 6}]},
    "hosts": {"master_is_exact": true,
              "temperature": {"day_amplitude_k": 1, "day_period_h": 24, "load_amplitude_k": 1,
                              "load_period_s": 100, "load_time_constant_s": 10,
                              "fan_amplitude_k": 1, "fan_period_s": 10},
              "drift_file": {"age_h": 1, "error_ppb": 2},
              "stack": {"transmit": )" +
                                   law + R"(, "transmit_to_card": )" + law + R"(,
                        "receive": )" +
                                   law + R"(, "wake_up": )" + law + R"(,
                        "interrupt_moderation_us": 1, "interrupts_per_s": 1, "sleep_share": 0,
                        "sleep_exit_us": 1, "awake_us": 1, "sleep_time_ms": 1,
                        "speed_log_sigma": 1},
              "clock": {"oscillator": {"class": "tcxo"},
                        "skew_of_host_ppm": [0,1,2,3,4,5],
                        "initial_offset_of_host_ms": [0,1,2,3,4,5]}},
    "network": {"port_asymmetry_sigma_ms": 0.01, "switch_of_host": [0,0,0,1,1,1],
                "bandwidth_mbit_per_s": 1000, "switch_residence_ms": 0.001,
                "cross_traffic_share": 0, "switch_clock_wander_ppb_per_sqrt_s": 1,
                "links": [{"host": 1, "latency_fixed_ms": 1, "latency_exponential_ms": 2,
                           "asymmetry_ms": 0.5}]},
    "usb": {"delivery_quantiles_ms": [0, 0.3], "delivery_correlation": 0.1},
    "cameras": {"oscillator": {"class": "ocxo"}, "host_of_camera": [0,0,0, 1,1,1, 2,2,2, 3,3,3, 4,4,4, 5,5,5],
                "skew_of_camera_ppm": [1,2,3, 1,2,3, 1,2,3, 1,2,3, 1,2,3, 1,2,3],
                "stamp_clock": "host",
                "frame_control": {
                  "adjust_frame": true, "insert_frame": true, "frame_length": true,
                  "start_at": true, "granularity_us": 10, "shortest_ms": 5, "longest_ms": 50,
                  "latency_frames": 2, "delay_ms": 1, "delay_exponential_ms": 1,
                  "loss_probability": 0, "insert_stretches": 1, "insert_noise_sigma_us": 1,
                  "start_jitter_sigma_us": 1, "frame_jitter_sigma_us": 1,
                  "sensor_clock": "camera"}},
    "studio": )" + studio_of("18cam_6host_30fps_studio"));
  json document = json::parse(load_scenario_text(text, "my.json").resolved_json());
  // Beside which there is no wireless cell, and no link has a latency of its own, which only the
  // checks say.
  document["network"]["wifi"] = {
      {"access_point_host", 0},
      {"wired_hosts", {5}},
      {"rate_mbit_per_s", 54},
      {"basic_rate_mbit_per_s", 6},
      {"preamble_us", 20},
      {"sifs_us", 16},
      {"slot_us", 9},
      {"contention_window_min", 15},
      {"contention_window_max", 1023},
      {"retry_limit", 7},
      {"collision_probability", 0},
      {"busy", {{"rate_hz", 0.1}, {"duration_exponential_ms", 100}, {"latency_ms", 20}}},
      {"power_save",
       {{"idle_ms", 100}, {"beacon_interval_ms", 102.4}, {"dtim_period", 1}, {"wake_up_ms", 2}}}};
  document["network"]["latency_quantiles_ms"] = {0.1, 0.2};
  // A figure has one of the three numbers, which only the checks say.
  const json figure = {{"pipeline", "yoon2021_both"},
                       {"metric", "amd_ms"},
                       {"at_most", 2},
                       {"value", 1},
                       {"at_least", 0},
                       {"conditions", "a rig"},
                       {"source", "a paper"}};
  document["published_figures"] = json::array({figure});
  json& stream = document["cameras"]["streams"][0];
  stream["calibrated_delay_ms"] = 10.5;
  stream["calibrated_at"] = {{"width", 848}, {"height", 480}, {"mode_rate_hz", 30}};
  json& polls = document["cameras"]["clock_poll"];
  polls["calibrated_asymmetry_ms"] = 0.25;
  polls["calibrated_at"] = {{"request_ms", 0.4}, {"reply_ms", 0.2}};
  document["cameras"]["led_clock"] = {{"interval_ms", 200},      {"first_ms", 1000},
                                      {"last_ms", 1000},         {"step_ms", 1},
                                      {"missed_probability", 0}, {"wrong_probability", 0},
                                      {"skew_sigma_ppm", 20},    {"row_spread_share", 0}};
  document["pipelines"][0]["capture_alignment"] = "free_run";
  document["pipelines"][0]["host_sync"] = {
      {"program",
       {{"master", json::array({json::array({"chronyd", "-d"})})},
        {"slave", json::array({json::array({"chronyd", "-d"})})},
        {"files", {{"a.conf", "local"}}},
        {"environment", {{"A", "b"}}},
        {"run_before_capture_s", 60},
        {"run_during_capture", false},
        {"model", "chrony"}}}};
  return document;
}

// The pointers of the leaves that the schema knows, elements written as "0".
void collect_leaves(const std::string& pointer, const ordered_json& node,
                    std::set<std::string>& leaves) {
  if (node.contains("properties")) {
    for (const auto& [key, child] : node["properties"].items()) {
      collect_leaves(child_pointer(pointer, key), child, leaves);
    }
  } else if (node.contains("items")) {
    collect_leaves(pointer + "/0", node["items"], leaves);
  } else if (!node.contains("additionalProperties")) {
    leaves.insert(pointer);
  }
}

template <class Visit>
void for_each_leaf_schema(const std::string& pointer, const ordered_json& node, Visit visit) {
  for (const char* const container : {"properties", "items", "additionalProperties"}) {
    if (!node.contains(container) || !node[container].is_object()) continue;
    if (container == std::string("properties")) {
      for (const auto& [key, child] : node[container].items()) {
        for_each_leaf_schema(child_pointer(pointer, key), child, visit);
      }
    } else {
      for_each_leaf_schema(pointer + "/*", node[container], visit);
    }
    return;
  }
  visit(pointer, node);
}

// Another value of the same type; for a choice, another of its words.
json changed(const json& value, const ordered_json& node) {
  if (value.is_boolean()) return !value.get<bool>();
  if (value.is_number()) return value.get<double>() + 1;
  if (!node.contains("enum")) return value.get<std::string>() + "x";
  const std::string word = value.get<std::string>();
  return node["enum"][0].get<std::string>() == word ? node["enum"][1] : node["enum"][0];
}

// What the schema says of a leaf.
const ordered_json& schema_at(const std::string& leaf) {
  std::vector<std::string> keys;
  for (json::json_pointer rest(leaf); !rest.empty(); rest.pop_back()) keys.push_back(rest.back());
  const ordered_json* node = &ordered_schema();
  for (; !keys.empty(); keys.pop_back()) node = schema_of_child(*node, keys.back());
  return *node;
}

// The members of a fault are stated by faults of different kinds.
std::string stated_place(const std::string& leaf) {
  const std::map<std::string, std::string> others = {{"/faults/0/host", "/faults/1/host"},
                                                     {"/faults/0/step_ms", "/faults/1/step_ms"},
                                                     {"/faults/0/smear_ms", "/faults/2/smear_ms"},
                                                     {"/faults/0/inserted", "/faults/2/inserted"}};
  const auto found = others.find(leaf);
  return found == others.end() ? leaf : found->second;
}

TEST(SchemaDrift, EveryLeafOfTheSchemaReachesTheStruct) {
  std::set<std::string> leaves;
  collect_leaves("", ordered_schema(), leaves);
  leaves.erase("/$schema");
  leaves.erase("/base");
  leaves.erase("/schema_version");
  leaves.erase("/faults/0/kind");  // which decides what the other members are
  ASSERT_GT(leaves.size(), 100U);

  const json original = full_document();
  const json before = original.get<Scenario>();
  for (const std::string& leaf : leaves) {
    const std::string pointer = stated_place(leaf);
    json document = original;
    json& value = document.at(json::json_pointer(pointer));
    value = changed(value, schema_at(leaf));
    const json after = document.get<Scenario>();
    EXPECT_EQ(json::diff(before, after).size(), 1U) << pointer;
    EXPECT_EQ(after.at(json::json_pointer(pointer)), value) << pointer;
  }
}

TEST(SchemaDrift, EveryMemberOfTheStructIsInTheSchema) {
  json written = full_document().get<Scenario>();
  written["schema_version"] = 1;
  EXPECT_NO_THROW(validate(written, Completeness::kResolved, Places()));
}

// Converts to anything: how many of it an aggregate takes is the number of its members.
struct Anything {
  template <class T>
  operator T() const {  // NOLINT(google-explicit-constructor): implicit is what it is for
    std::abort();       // only its type is ever asked for
  }
};

template <class T, class... Members>
constexpr std::size_t member_count() {
  if constexpr (requires { T{std::declval<Members>()..., std::declval<Anything>()}; }) {
    return member_count<T, Members..., Anything>();
  } else {
    return sizeof...(Members);
  }
}

template <class T>
void expect_all_members_written() {
  EXPECT_EQ(json(T{}).size(), member_count<T>()) << typeid(T).name();
}

// Beside its kind.
template <class Kind>
void expect_all_members_of_fault_written() {
  EXPECT_EQ(json(Fault(Kind{})).size(), 1 + member_count<Kind>()) << Kind::kKind;
}

TEST(SchemaDrift, EveryMemberOfTheStructsIsWritten) {
  expect_all_members_written<Timeline>();
  expect_all_members_written<Oscillator>();
  expect_all_members_written<LastSet>();
  expect_all_members_written<Temperature>();
  expect_all_members_written<DriftFile>();
  expect_all_members_written<HostClock>();
  expect_all_members_written<DelayLaw>();
  expect_all_members_written<Stack>();
  expect_all_members_written<Hosts>();
  expect_all_members_written<Burst>();
  expect_all_members_written<Link>();
  expect_all_members_written<WifiPowerSave>();
  expect_all_members_written<Wifi>();
  expect_all_members_written<Network>();
  expect_all_members_written<TriggerPause>();
  expect_all_members_written<Trigger>();
  expect_all_members_written<StreamMode>();
  expect_all_members_written<Stream>();
  expect_all_members_written<PollDelays>();
  expect_all_members_written<ClockPoll>();
  expect_all_members_written<CalibrationError>();
  expect_all_members_written<LedClockModel>();
  expect_all_members_written<FrameControlModel>();
  expect_all_members_written<BackendStamp>();
  expect_all_members_written<Cameras>();
  expect_all_members_written<Usb>();
  expect_all_members_written<HostPrograms>();
  expect_all_members_written<Evaluation>();
  expect_all_members_written<Published>();
  expect_all_members_written<PublishedFigure>();
  expect_all_members_written<StudioSubject>();
  expect_all_members_written<PublishedReprojection>();
  expect_all_members_written<Studio>();
  const auto expect_all = []<class... Kinds>(const std::variant<Kinds...>&) {
    (expect_all_members_of_fault_written<Kinds>(), ...);
  };
  expect_all(Fault{});
  constexpr std::size_t kNotInTheFile = 3;  // derivation, resolved_json, origin
  EXPECT_EQ(json(Scenario{}).size(), member_count<Scenario>() - kNotInTheFile);
}

TEST(SchemaDrift, ChoicesHaveTheWordsOfTheSchema) {
  std::map<std::string, std::vector<std::string>> words = {
      {"/network/stamp_point", all_texts<StampPoint>()},
      {"/network/switch_clock", all_texts<SwitchClockKind>()},
      {"/cameras/sync_mode", all_texts<SyncMode>()},
      {"/cameras/streams/*/kind", all_texts<StreamKind>()},
      {"/cameras/streams/*/shutter", all_texts<ShutterKind>()},
      {"/cameras/stamp_clock", all_texts<ClockOwner>()},
      {"/cameras/frame_control/sensor_clock", all_texts<ClockOwner>()},
      {"/usb/sharing", all_texts<UsbSharing>()},
      {"/evaluation/stream", all_texts<StreamKind>()},
      {"/evaluation/table", all_texts<TableKind>()},
      {"/evaluation/rmdv_median", all_texts<MedianKind>()},
      {"/studio/subject/kind", all_texts<SubjectKind>()},
      {"/studio/subject/motion", all_texts<MotionScript>()}};
  const auto add_kinds = [&words]<class... Kinds>(const std::variant<Kinds...>&) {
    words["/faults/*/kind"] = {std::string(Kinds::kKind)...};
  };
  add_kinds(Fault{});
  std::map<std::string, std::vector<std::string>> in_schema;
  for_each_leaf_schema("", ordered_schema(),
                       [&](const std::string& pointer, const ordered_json& node) {
                         if (node.contains("enum")) node["enum"].get_to(in_schema[pointer]);
                       });
  EXPECT_EQ(words, in_schema);
}

TEST(SchemaDrift, TablesOfStudiesHaveTheWordsOfTheirSchema) {
  const auto schema = ordered_json::parse(study_schema_text());
  EXPECT_EQ(schema.at("/properties/tables/items/enum"_json_pointer),
            ordered_json(all_texts<StudyTable>()));
}

TEST(SchemaDrift, CameraProfilesHaveTheWordsOfTheirSchema) {
  const auto schema = ordered_json::parse(camera_schema_text());
  const auto words = [&schema](const char* pointer) {
    return schema.at(ordered_json::json_pointer(pointer)).get<std::vector<std::string>>();
  };
  EXPECT_EQ(words("/properties/streams/items/properties/kind/enum"), all_texts<StreamKind>());
  EXPECT_EQ(words("/properties/streams/items/properties/shutter/enum"), all_texts<ShutterKind>());
  const std::string mode = "/properties/sync/properties/modes/items/properties/";
  EXPECT_EQ(words((mode + "mode/enum").c_str()), all_texts<SyncMode>());
  EXPECT_EQ(words((mode + "triggered/items/enum").c_str()), all_texts<StreamKind>());
}

TEST(Schema, EveryPropertyHasDescriptionSourceAndRange) {
  for_each_leaf_schema(
      "", ordered_schema(), [](const std::string& pointer, const ordered_json& node) {
        EXPECT_FALSE(node.value("description", "").empty()) << pointer;
        EXPECT_FALSE(node.value("x-source", "").empty()) << pointer;
        const ordered_json& type = node.at("type");
        if (type == "integer" || type == "number") {
          EXPECT_TRUE(node.contains("minimum") || node.contains("exclusiveMinimum")) << pointer;
          EXPECT_TRUE(node.contains("maximum")) << pointer;
        }
        if (type == "string") {
          EXPECT_TRUE(node.contains("enum") || node.contains("maxLength")) << pointer;
        }
      });
}

TEST(Schema, ObjectsAreClosed) {
  std::string text = ordered_schema().dump();
  std::size_t objects = 0;
  for (std::size_t at = 0; (at = text.find("\"properties\":", at)) != std::string::npos; ++at) {
    ++objects;
  }
  std::size_t closed = 0;
  for (std::size_t at = 0;
       (at = text.find("\"additionalProperties\":false", at)) != std::string::npos; ++at) {
    ++closed;
  }
  EXPECT_EQ(closed, objects);
}

TEST(Schema, EveryPropertyIsRequiredOfAResolvedScenario) {
  const json original = full_document();
  std::set<std::string> leaves;
  collect_leaves("", ordered_schema(), leaves);
  std::size_t required = 0;
  for (const std::string& leaf : leaves) {
    if (leaf == "/$schema" || leaf == "/base" || leaf.starts_with("/faults/0/")) continue;
    json document = original;
    const json::json_pointer pointer(leaf);
    if (pointer.back() == "0") continue;  // an element of an array
    const auto optional = schema_at(pointer.parent_pointer().to_string())
                              .value("x-optional", std::vector<std::string>());
    if (std::ranges::find(optional, pointer.back()) != optional.end()) continue;
    document.at(pointer.parent_pointer()).erase(pointer.back());
    ++required;
    try {
      validate(document, Completeness::kResolved, Places());
      ADD_FAILURE() << leaf << " was not missed";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(leaf + ": found nothing, allowed "),
                std::string::npos)
          << error.what();
    }
  }
  EXPECT_GT(required, 100u);
}

TEST(Schema, KeepsItsOrder) {
  const std::string text = load_scenario("18cam_6host_45fps").resolved_json();
  EXPECT_LT(text.find("\"schema_version\""), text.find("\"name\""));
  EXPECT_LT(text.find("\"timeline\""), text.find("\"hosts\""));
  EXPECT_LT(text.find("\"warm_up_ms\""), text.find("\"frames\""));
}

}  // namespace
}  // namespace simbench::scenarios
