#include "scenarios/study.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "scenarios/builtin_files.h"
#include "scenarios/schema.h"
#include "tests/nonempty.h"

namespace simbench::scenarios {
namespace {

TEST(Study, EveryFileIsWhatTheSchemaSays) {
  const JsonSchema schema(nlohmann::json::parse(study_schema_text()));
  for (const BuiltinFile& file : nonempty(study_files())) {
    EXPECT_TRUE(schema.problems(nlohmann::json::parse(file.text)).empty()) << file.name;
  }
  auto wrong = nlohmann::json::parse(study_files().front().text);
  wrong["tables"] = {"respons"};
  EXPECT_FALSE(schema.problems(wrong).empty());
}

TEST(Study, IsFoundByName) {
  const Study* study = find_study("scalability");
  ASSERT_NE(study, nullptr);
  EXPECT_EQ(study->scenario, "18cam_6host_45fps");
  EXPECT_THAT(study->sweep, testing::ElementsAre(testing::HasSubstr("/hosts/count=")));
  EXPECT_EQ(find_study("scalable"), nullptr);
}

}  // namespace
}  // namespace simbench::scenarios
