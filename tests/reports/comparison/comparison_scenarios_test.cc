#include "reports/comparison/comparison_scenarios.h"

#include <gmock/gmock.h>

#include "scenarios/loader.h"

namespace simbench::reports {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::ThrowsMessage;

TEST(CompareScenarios, TheWordsOfAScenarioAreNoDifference) {
  const ScenarioDifferences d = compare_scenarios(
      R"({"name": "a", "summary": "x", "published": {}, "evaluation": {"table": "p", "stream": "d"}})",
      R"({"name": "b", "evaluation": {"stream": "d", "table": "leaderboard"}, "published": {"q": 1}})");
  EXPECT_THAT(d.world, IsEmpty());
  EXPECT_THAT(d.algorithms, IsEmpty());
}

TEST(CompareScenarios, TheWorldIsToldByPointers) {
  const ScenarioDifferences d =
      compare_scenarios(R"({"a": {"x": 1, "list": [1, 2], "same": 0}, "only": {"here": true}})",
                        R"({"a": {"x": 2, "list": [1, 3, 4], "same": 0}})");
  EXPECT_THAT(d.world, ElementsAre("/a/list/1: 2 against 3", "/a/list/2: nothing against 4",
                                   "/a/x: 1 against 2", "/only/here: true against nothing"));
  EXPECT_THAT(d.algorithms, IsEmpty());
}

TEST(CompareScenarios, AlgorithmsAreUnderTestAndToldByName) {
  const ScenarioDifferences d = compare_scenarios(
      R"({"algorithms": {"y": {"n": 30}}, "pipelines": [{"name": "p", "gathering": "g"}]})",
      R"({"algorithms": {"y": {"n": 5}},
          "pipelines": [{"name": "new"}, {"name": "p", "gathering": "h"}]})");
  EXPECT_THAT(d.world, IsEmpty());
  EXPECT_THAT(d.algorithms, ElementsAre("/algorithms/y/n: 30 against 5",
                                        "/pipelines/p/gathering: \"g\" against \"h\""));
}

TEST(CompareScenarios, RefusesWhatIsNoScenario) {
  EXPECT_THAT([] { compare_scenarios("{", "{}"); },
              ThrowsMessage<scenarios::InputError>(HasSubstr("not a JSON object")));
}

TEST(DigestOfJson, DependsOnContentOnly) {
  EXPECT_EQ(digest_of_json(R"({"a": 1, "b": [2]})"), digest_of_json("{\"b\":[2],\n\"a\":1}"));
  EXPECT_NE(digest_of_json(R"({"a": 1})"), digest_of_json(R"({"a": 2})"));
  // Version 5 of RFC 4122: UUIDv5(namespace OID, "{}"), by Python's uuid.uuid5.
  EXPECT_EQ(digest_of_json("{}"), "56bd00e8-9408-567f-b0cc-aab82ef285b4");
}

TEST(FirstFew, SaysHowManyMoreThereAre) {
  EXPECT_EQ(first_few({"a", "b"}), "a; b");
  EXPECT_EQ(first_few(std::vector<std::string>(10, "x")), "x; x; x; x; x; x; x; x; and 2 more");
}

}  // namespace
}  // namespace simbench::reports
