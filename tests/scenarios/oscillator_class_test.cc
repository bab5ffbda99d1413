// Classes of oscillators, and how a scenario takes their values over.
#include "scenarios/oscillator_class.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "scenarios/builtin_files.h"
#include "scenarios/scenario_json.h"
#include "scenarios/schema.h"
#include "tests/nonempty.h"
#include "tests/scenarios/support.h"

namespace simbench::scenarios {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

TEST(OscillatorClasses, AreThere) {
  std::vector<std::string> names;
  for (const OscillatorClass& each : oscillator_classes()) names.push_back(each.class_name);
  EXPECT_THAT(names, ElementsAre("ocxo", "pc_crystal", "tcxo"));
  EXPECT_EQ(find_oscillator_class("rubidium"), nullptr);
}

TEST(OscillatorClasses, AreWhatTheirSchemaAsksFor) {
  const JsonSchema schema(json::parse(oscillator_schema_text()));
  for (const BuiltinFile& file : nonempty(oscillator_files())) {
    const json profile = json::parse(file.text);
    const auto problems = schema.problems(profile);
    EXPECT_TRUE(problems.empty()) << file.name << ": " << problems.front().text;
    EXPECT_EQ(profile["class"], file.name);
  }
  json broken = json::parse(oscillator_files().front().text);
  broken["values"]["skew_sigma_ppm"].erase("source");
  EXPECT_FALSE(schema.problems(broken).empty());
}

TEST(OscillatorClasses, ValuesAreMembersOfAnOscillator) {
  const json members = Oscillator{};
  for (const OscillatorClass& each : nonempty(oscillator_classes())) {
    for (const OscillatorValue& value : nonempty(each.values)) {
      EXPECT_TRUE(members.contains(value.member)) << value.member;
    }
  }
}

// The better an oscillator, the smaller each of its values.
TEST(OscillatorClasses, AreInTheOrderOfTheirPrice) {
  const OscillatorClass& crystal = *find_oscillator_class("pc_crystal");
  const OscillatorClass& tcxo = *find_oscillator_class("tcxo");
  const OscillatorClass& ocxo = *find_oscillator_class("ocxo");
  for (const OscillatorValue& value : nonempty(tcxo.values)) {
    EXPECT_LE(value.value, crystal.find(value.member)->value) << value.member;
    EXPECT_LE(ocxo.find(value.member)->value, value.value) << value.member;
  }
}

Oscillator hosts_of(const std::string& oscillator, const std::vector<Override>& overrides = {}) {
  return load_derived(R"("hosts": {"clock": {"oscillator": )" + oscillator + "}}", overrides)
      .hosts.clock.oscillator;
}

TEST(OscillatorClasses, ReplaceWhatTheBaseStates) {
  const Oscillator tcxo = hosts_of(R"({"class": "tcxo"})");
  EXPECT_EQ(tcxo.class_name, "tcxo");
  EXPECT_EQ(tcxo.skew_sigma_ppm, 1);
  EXPECT_EQ(tcxo.flicker_floor_ppb, 1);
  EXPECT_EQ(tcxo.temperature_coefficient_ppb_per_k, 3.6);
  EXPECT_EQ(tcxo.wander_step_ms, 1000) << "of which the class says nothing";
  const Scenario scenario = load_derived(R"("cameras": {"oscillator": {"class": "ocxo"}})");
  EXPECT_EQ(scenario.cameras.oscillator.skew_sigma_ppm, 0.01);
  EXPECT_EQ(scenario.hosts.clock.oscillator.skew_sigma_ppm, 10);
}

TEST(OscillatorClasses, DoNotReplaceWhatTheFileOrASetStates) {
  EXPECT_EQ(hosts_of(R"({"class": "tcxo", "skew_sigma_ppm": 7})").skew_sigma_ppm, 7);
  const Override skew = {"/hosts/clock/oscillator/skew_sigma_ppm", "3"};
  const Override ocxo = {"/hosts/clock/oscillator/class", "ocxo"};
  EXPECT_EQ(hosts_of(R"({"class": "tcxo"})", {skew}).skew_sigma_ppm, 3);
  for (const auto& order : {std::vector{skew, ocxo}, std::vector{ocxo, skew}}) {
    const Oscillator set = hosts_of(R"({"class": "tcxo"})", order);
    EXPECT_EQ(set.skew_sigma_ppm, 3);
    EXPECT_EQ(set.flicker_floor_ppb, 0.001);
  }
  EXPECT_EQ(hosts_of(R"({"class": "tcxo", "skew_sigma_ppm": 7})", {ocxo}).skew_sigma_ppm, 0.01)
      << "a later class replaces what the file states";
}

TEST(OscillatorClasses, AreInheritedAndTakenBack) {
  const std::string members = R"("base": "6host_lan_day", "name": "my", "summary": "nominal")";
  const auto oscillator = [&members](const std::string& more) {
    return load_scenario_text("{" + members + more + "}", "my.json").hosts.clock.oscillator;
  };
  EXPECT_EQ(oscillator("").skew_sigma_ppm, 15);
  const std::string open = R"(, "hosts": {"clock": {"oscillator": {)";
  EXPECT_EQ(oscillator(open + R"("skew_sigma_ppm": 2}}})").skew_sigma_ppm, 2);
  EXPECT_EQ(oscillator(open + R"("class": "ocxo"}}})").skew_sigma_ppm, 0.01);
  const Oscillator without = oscillator(open + R"("ramp_ppm_per_hour": 1}}})");
  EXPECT_EQ(without.temperature_coefficient_ppb_per_k, 480);
}

TEST(OscillatorClasses, ThatDoNotExistAreNamed) {
  EXPECT_EQ(error_of("\"hosts\": {\"clock\": {\"oscillator\": {\n\"class\": \"txco\"}}}"),
            "my.json:4: /hosts/clock/oscillator/class: found \"txco\", allowed ocxo, pc_crystal, "
            "tcxo (simbench list oscillators)");
  EXPECT_EQ(error_of_set("/cameras/oscillator/class", "7"),
            "--set /cameras/oscillator/class=7: found 7, allowed text of 1 to 100 characters");
}

TEST(OscillatorClasses, AreDescribedWithTheirSources) {
  const Scenario scenario =
      load_derived(R"("hosts": {"clock": {"oscillator": {"class": "tcxo", "skew_sigma_ppm": 7}}})");
  int seen = 0;
  for (const ParameterLine& line : describe(scenario)) {
    if (line.pointer == "/hosts/clock/oscillator/flicker_floor_ppb") {
      EXPECT_EQ(line.value, "1");
      EXPECT_THAT(line.source, StartsWith("class tcxo: Vig, Introduction"));
      ++seen;
    } else if (line.pointer == "/hosts/clock/oscillator/temperature_coefficient_ppb_per_k") {
      EXPECT_EQ(line.unit, "ppb/K");
      EXPECT_THAT(line.meaning, HasSubstr("temperature"));
      ++seen;
    } else if (line.pointer == "/hosts/clock/oscillator/skew_sigma_ppm") {
      EXPECT_EQ(line.source, "my.json:3");
      ++seen;
    }
  }
  EXPECT_EQ(seen, 3);
}

// A class is a change of the world like any other, and no other change makes it one again.
TEST(OscillatorClasses, AreChangesOfTheWorld) {
  EXPECT_TRUE(load_scenario("6host_lan_day").derivation.changes.empty());
  const Scenario changed = load_scenario("6host_lan_day", {{"/timeline/frames", "20"}});
  ASSERT_EQ(changed.derivation.changes.size(), 1U);
  EXPECT_EQ(changed.derivation.changes[0].pointer, "/timeline/frames");
  const Scenario other =
      load_scenario("6host_star", {{"/hosts/clock/oscillator/class", "\"ocxo\""}});
  EXPECT_EQ(other.derivation.changes.front().pointer, "/hosts/clock/oscillator/class");
  EXPECT_GT(other.derivation.changes.size(), 2U);
}

}  // namespace
}  // namespace simbench::scenarios
