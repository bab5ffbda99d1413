// Schema, structs and the list of fields between them say the same.
#include "scenarios/schema.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>

#include "scenarios/document.h"
#include "scenarios/fields.h"
#include "scenarios/loader.h"
#include "scenarios/resolve.h"
#include "scenarios/source.h"
#include "tests/scenarios/support.h"

namespace simbench::scenarios {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

// A scenario that uses everything that may be left empty.
json full_document() {
  const std::string text = derived(R"("faults": [
      {"kind": "camera_vanishes", "camera": 1, "at_ms": 1, "duration_ms": 2},
      {"kind": "clock_step", "host": 1, "at_ms": 3, "step_ms": 4}],
    "trigger": {"pauses": [{"at_ms": 5, "duration_ms": 6}]},
    "network": {"latency_quantiles_ms": [0.1, 0.2]},
    "usb": {"delivery_quantiles_ms": [0, 0.3], "delivery_correlation": 0.1},
    "cameras": {"host_of_camera": [0,0,0, 1,1,1, 2,2,2, 3,3,3, 4,4,4, 5,5,5],
                "skew_of_camera_ppm": [1,2,3, 1,2,3, 1,2,3, 1,2,3, 1,2,3, 1,2,3]},
    "studio": )" + studio_of("18cam_6host_30fps_studio"));
  return resolve({"my.json", text, false}, {}).document;
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

// Another value of the same type.
json changed(const json& value) {
  if (value.is_boolean()) return !value.get<bool>();
  if (value.is_number()) return value.get<double>() + 1;
  return value.get<std::string>() + "x";
}

TEST(SchemaDrift, EveryLeafOfTheSchemaReachesTheStruct) {
  std::set<std::string> leaves;
  collect_leaves("", ordered_schema(), leaves);
  leaves.erase("/$schema");
  leaves.erase("/base");
  leaves.erase("/schema_version");
  ASSERT_GT(leaves.size(), 100U);

  const json original = full_document();
  const json before = original.get<Scenario>();
  for (const std::string& leaf : leaves) {
    // The step of a clock and the camera of a fault are stated by different faults.
    const std::string pointer = leaf == "/faults/0/host" || leaf == "/faults/0/step_ms"
                                    ? "/faults/1" + leaf.substr(9)
                                    : leaf;
    json document = original;
    json& value = document.at(json::json_pointer(pointer));
    value = changed(value);
    const json after = document.get<Scenario>();
    EXPECT_EQ(json::diff(before, after).size(), 1U) << pointer;
    EXPECT_EQ(after.at(json::json_pointer(pointer)), value) << pointer;
  }
}

TEST(SchemaDrift, EveryMemberOfTheStructIsInTheSchema) {
  json written = full_document().get<Scenario>();
  written["schema_version"] = 1;
  // A loaded fault has all members, a stated one those that its kind needs.
  written["faults"] = json::array();
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

TEST(SchemaDrift, EveryMemberOfTheStructsIsWritten) {
  expect_all_members_written<Timeline>();
  expect_all_members_written<Oscillator>();
  expect_all_members_written<LastSet>();
  expect_all_members_written<HostClock>();
  expect_all_members_written<Hosts>();
  expect_all_members_written<Burst>();
  expect_all_members_written<Network>();
  expect_all_members_written<TriggerPause>();
  expect_all_members_written<Trigger>();
  expect_all_members_written<Stream>();
  expect_all_members_written<Cameras>();
  expect_all_members_written<Usb>();
  expect_all_members_written<Fault>();
  expect_all_members_written<Pipeline>();
  expect_all_members_written<Evaluation>();
  expect_all_members_written<Published>();
  expect_all_members_written<StudioSubject>();
  expect_all_members_written<PublishedReprojection>();
  expect_all_members_written<Studio>();
  constexpr std::size_t kNotInTheFile = 2;  // resolved_json, origin
  EXPECT_EQ(json(Scenario{}).size(), member_count<Scenario>() - kNotInTheFile);
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
  for (const std::string& leaf : leaves) {
    if (leaf == "/$schema" || leaf == "/base" || leaf.starts_with("/faults/0/")) continue;
    json document = original;
    const json::json_pointer pointer(leaf);
    if (pointer.back() == "0") continue;  // an element of an array
    document.at(pointer.parent_pointer()).erase(pointer.back());
    try {
      validate(document, Completeness::kResolved, Places());
      ADD_FAILURE() << leaf << " was not missed";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(leaf + ": found nothing, allowed "),
                std::string::npos)
          << error.what();
    }
  }
}

TEST(Schema, KeepsItsOrder) {
  const std::string text = load_scenario("18cam_6host_45fps").resolved_json;
  EXPECT_LT(text.find("\"schema_version\""), text.find("\"name\""));
  EXPECT_LT(text.find("\"timeline\""), text.find("\"hosts\""));
  EXPECT_LT(text.find("\"warm_up_ms\""), text.find("\"frames\""));
}

}  // namespace
}  // namespace simbench::scenarios
