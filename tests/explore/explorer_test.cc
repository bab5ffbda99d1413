#include "explore/explorer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "explore/parameters.h"

namespace simbench::explore {
namespace {

using nlohmann::json;
using server::PageRequest;
using server::PageResponse;
using testing::HasSubstr;

class ExplorerTest : public testing::Test {
 protected:
  PageResponse post(const std::string& path, const std::string& body) {
    return explorer_.answer({.method = "POST", .path = path, .body = body});
  }
  PageResponse get(const std::string& path) {
    return explorer_.answer({.method = "GET", .path = path});
  }

  Explorer explorer_{PageSubject{.name = "3cam_1host_30fps"}};
};

TEST_F(ExplorerTest, ThePageIsWholeAndSmall) {
  const PageResponse page = get("");
  EXPECT_EQ(page.status, 200u);
  EXPECT_LT(page.body.size(), 400'000u);
  EXPECT_THAT(page.body, testing::StartsWith("<!doctype html>"));
  EXPECT_THAT(page.body, testing::Not(HasSubstr("{{")));
}

TEST_F(ExplorerTest, TheSubjectNamesScenariosAndFigures) {
  const json subject = json::parse(get("subject").body);
  EXPECT_EQ(subject["subject"], "3cam_1host_30fps");
  EXPECT_GT(subject["scenarios"].size(), 40u);
  EXPECT_GT(subject["figures"].size(), 5u);
}

TEST_F(ExplorerTest, EveryParameterHasAValueAMeaningAndAType) {
  const json parameters =
      json::parse(post("parameters", R"({"state": {"scenario": "18cam_6host_45fps"}})").body);
  ASSERT_GT(parameters["parameters"].size(), 100u);
  for (const json& parameter : parameters["parameters"]) {
    EXPECT_FALSE(parameter["type"].get<std::string>().empty()) << parameter;
    if (!parameter["pointer"].get<std::string>().starts_with("/algorithms/")) {
      EXPECT_FALSE(parameter["meaning"].get<std::string>().empty()) << parameter;
    }
    EXPECT_TRUE(parameter.contains("value")) << parameter;
  }
  EXPECT_GT(parameters["choices"]["pipelines"].size(), 5u);
  EXPECT_GT(parameters["choices"]["stages"].size(), 2u);
}

// Each parameter's own value is one that the page may send back.
TEST_F(ExplorerTest, WhatIsShownCanBeSet) {
  const PageSubject subject{.name = "18cam_6host_45fps_lan"};
  const json parameters = parameters_json(scenarios::load_scenario("18cam_6host_45fps_lan"));
  for (const json& parameter : parameters) {
    const reports::Json state = {
        {"scenario", "18cam_6host_45fps_lan"},
        {"sets", {{{"pointer", parameter["pointer"]}, {"value", parameter["value"]}}}}};
    EXPECT_NO_THROW(world_of(state_of(state, subject), subject)) << parameter["pointer"];
  }
}

TEST_F(ExplorerTest, WhatDoesTheSameIsGiven) {
  const std::string body = R"({"state": {"scenario": "3cam_1host_30fps", "sets":
      [{"pointer": "/trigger/rate_hz", "value": 15}]}, "seeds": 16})";
  EXPECT_EQ(post("command.txt", body).body,
            "simbench run --scenario 3cam_1host_30fps --set /trigger/rate_hz=15 --seeds 16\n");
  EXPECT_THAT(post("script.py", body).body, HasSubstr("\"/trigger/rate_hz\": 15"));
  const PageResponse file = post("scenario.json", body);
  EXPECT_THAT(file.body, HasSubstr("\"base\": \"3cam_1host_30fps\""));
  EXPECT_EQ(file.file_name, "explored.json");
}

TEST_F(ExplorerTest, NonsenseIsRefused) {
  for (const char* const body : {"", "{", "[]", "1", R"({"state": 1})", R"({"state": {}})",
                                 R"({"states": [{"scenario": "/etc/passwd"}]})"}) {
    for (const char* const path : {"look", "parameters", "command.txt", "scenario.json"}) {
      EXPECT_EQ(post(path, body).status, 422u) << path << ' ' << body;
    }
  }
  for (const char* const path : {"../../etc/passwd", "/etc/passwd", "look", "nothing", "%2e%2e/"}) {
    EXPECT_EQ(get(path).status, 404u) << path;
  }
  EXPECT_EQ(post("nothing", R"({"state": {"scenario": "3cam_1host_30fps"}})").status, 404u);
}

}  // namespace
}  // namespace simbench::explore
