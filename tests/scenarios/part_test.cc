#include "scenarios/part.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "scenarios/builtin_files.h"
#include "scenarios/schema.h"
#include "tests/nonempty.h"

namespace simbench::scenarios {
namespace {

using nlohmann::json;
using testing::HasSubstr;

TEST(Parts, AreWhatTheirSchemaAsksFor) {
  const JsonSchema schema(json::parse(part_schema_text()));
  for (const BuiltinFile& file : nonempty(part_files())) {
    const json part = json::parse(file.text);
    const auto problems = schema.problems(part);
    EXPECT_TRUE(problems.empty()) << file.name << ": " << problems.front().text;
    EXPECT_EQ(part["part"], file.name);
    // The checks beyond the schema, as for a user's file.
    EXPECT_EQ(load_part_text(std::string(file.text), "a.json").part, file.name);
  }
}

TEST(Parts, ThereIsEveryKind) {
  for (const auto& word : words_of(PartKind{})) {
    const auto is_it = [&word](const Part& part) { return part.kind == word.value; };
    EXPECT_TRUE(std::ranges::any_of(parts(), is_it)) << word.text;
  }
  EXPECT_EQ(find_part("abacus"), nullptr);
}

// What a part sets must be a place in the world that simbench advise uses.
TEST(Parts, SetWhatAScenarioHas) {
  for (const Part& part : nonempty(parts())) {
    EXPECT_NO_THROW(load_scenario("18cam_6host_45fps_lan", part.sets)) << part.part;
  }
}

TEST(Parts, CostWhatTheirPricesSay) {
  const Part& pps = *find_part("pps_wires");
  const PriceRange price = price_of(pps, {.hosts = 4, .pieces = 4});
  EXPECT_EQ(price.low_eur, 60 + 4 * 10);
  EXPECT_EQ(price.high_eur, 300 + 4 * 40);
  EXPECT_EQ(price_of(*find_part("usb_card_single"), {.hosts = 4, .pieces = 6}).low_eur, 120);
  EXPECT_EQ(price_of(*find_part("software"), {.hosts = 4, .pieces = 4}).high_eur, 0);
}

std::string refusal(const std::string& members) {
  try {
    (void)load_part_text("{" + members + "}", "mine.json");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Parts, OfTheUserAreChecked) {
  const std::string switch_part =
      R"("part": "mine", "kind": "switch", "name": "n", "price_source": "p", "source": "s", )";
  EXPECT_EQ(refusal(switch_part + R"("hosts": 8, "prices": [])"), "accepted");
  EXPECT_THAT(refusal(switch_part + R"("prices": [])"), HasSubstr("found no hosts"));
  EXPECT_THAT(refusal(switch_part +
                      R"("hosts": 8, "prices": [{"per": "rig", "low_eur": 5, "high_eur": 4}])"),
              HasSubstr("mine.json:1: /prices/0/high_eur: found 4, allowed at least low_eur, 5"));
  EXPECT_THAT(refusal(switch_part +
                      R"("hosts": 8, "prices": [{"per": "day", "low_eur": 5, "high_eur": 4}])"),
              HasSubstr("mine.json:1: /prices/0/per: found \"day\""));
  EXPECT_THAT(refusal(R"("part": "mine")"), HasSubstr("mine.json:1"));
  EXPECT_THAT(refusal("\n\n"), HasSubstr("mine.json"));
}

}  // namespace
}  // namespace simbench::scenarios
