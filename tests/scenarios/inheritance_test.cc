// Files, names and "base".
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tests/scenarios/support.h"
#include "tests/scratch_folder.h"

namespace simbench::scenarios {
namespace {

namespace fs = std::filesystem;

// A folder of files for one test.
class Files : public testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) const {
    return folder_.write(name, text);
  }
  std::string path(const std::string& name) const { return folder_ / name; }

  static std::string error_of_file(const std::string& name_or_path) {
    try {
      load_scenario(name_or_path);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

 private:
  ScratchFolder folder_;
};

std::string over(const std::string& base, const std::string& members = "") {
  return "{\"base\": \"" + base + "\", \"name\": \"my\", \"summary\": \"s\"" + members + "}";
}

TEST(Base, StatesTheDifferencesOnly) {
  const Scenario base = load_scenario("18cam_6host_45fps");
  const Scenario scenario = load_derived(R"("hosts": {"clock": {"tick_ms": 15.6}})");
  EXPECT_EQ(scenario.name, "my");
  EXPECT_EQ(scenario.hosts.clock.tick_ms, 15.6);
  EXPECT_EQ(scenario.hosts.clock.set_cost_ms, base.hosts.clock.set_cost_ms);
  EXPECT_EQ(scenario.origin->describe("/hosts/clock/tick_ms"), "my.json:3: /hosts/clock/tick_ms");
  EXPECT_EQ(scenario.origin->describe("/hosts/clock/set_cost_ms").substr(0, 23),
            "18cam_6host_45fps.json:");
}

TEST(Base, NullForgets) {
  const Scenario scenario = load_derived(
      R"("published": {"ntp_last_set": null}, "algorithms": {"w32time": null,
         "yoon2021": {"stamps": null}})");
  EXPECT_EQ(scenario.published.count("ntp_last_set"), 0U);
  EXPECT_EQ(scenario.algorithms.count("w32time"), 0U);
  EXPECT_EQ(scenario.algorithms.at("yoon2021").count("stamps"), 0U);
  EXPECT_EQ(scenario.algorithms.at("yoon2021").count("clock_calls"), 1U);
}

TEST(Base, NullForgetsTemperatureAndDriftFile) {
  const Scenario day = load_scenario_text(over("6host_lan_day"), "my.json");
  EXPECT_EQ(day.hosts.temperature->day_amplitude_k, 3);
  EXPECT_EQ(day.hosts.drift_file->age_h, 8);
  const Scenario still = load_scenario_text(
      over("6host_lan_day", R"(, "hosts": {"temperature": null, "drift_file": null})"), "my.json");
  EXPECT_FALSE(still.hosts.temperature.has_value());
  EXPECT_FALSE(still.hosts.drift_file.has_value());
}

TEST(Base, PublishedResultsDoNotOutliveItsPipelines) {
  const Scenario scenario = load_derived(
      R"("pipelines": [{"name": "yoon2021_both", "host_sync": "yoon2021_both",
                        "device_time": "regression_30", "gathering": "yoon2021"},
                       {"name": "yoon2021_time", "host_sync": "oracle",
                        "device_time": "regression_30", "gathering": "yoon2021"}])");
  ASSERT_EQ(scenario.published.size(), 1U);
  EXPECT_EQ(scenario.published.begin()->first, "yoon2021_both");
  EXPECT_EQ(scenario.resolved_json().find("ntp_last_set"), std::string::npos);
}

TEST_F(Files, BasesLieRelativeToTheFile) {
  write("a/one.json", over("18cam_6host_45fps", ", \"timeline\": {\"frames\": 7}"));
  write("a/b/two.json", over("../one.json", ", \"timeline\": {\"warm_up_ms\": 8}"));
  const Scenario scenario = load_scenario(write("c.json", over("a/b/two.json")));
  EXPECT_EQ(scenario.timeline.frames, 7);
  EXPECT_EQ(scenario.timeline.warm_up_ms, 8);
}

TEST_F(Files, ErrorsInABaseNameTheBase) {
  const std::string base = write("one.json", over("18cam_6host_45fps", ",\n \"usb\": 1"));
  EXPECT_EQ(error_of_file(write("two.json", over("one.json"))),
            base + ":2: /usb: found 1, allowed an object");
}

TEST_F(Files, CirclesOfBases) {
  const std::string one = write("one.json", over("two.json"));
  const std::string two = write("two.json", over("one.json"));
  EXPECT_EQ(error_of_file(one),
            two + ":1: /base: found a circle of bases: " + one + " -> " + two + " -> " + one);
  const std::string self = write("self.json", over("./self.json"));
  EXPECT_EQ(error_of_file(self),
            self + ":1: /base: found a circle of bases: " + self + " -> " + self);
}

TEST_F(Files, ChainsOfBasesEnd) {
  for (int i = 0; i < 40; ++i) {
    write(fmt::format("s{}.json", i), over(fmt::format("s{}.json", i + 1)));
  }
  EXPECT_EQ(error_of_file(path("s0.json")),
            path("s31.json") + ":1: /base: found more than 32 bases upon each other");
}

TEST_F(Files, UnknownBases) {
  const std::string file = write("one.json", over("18cam_6host_44fps"));
  EXPECT_EQ(error_of_file(file),
            file +
                ":1: /base: found \"18cam_6host_44fps\", did you mean 18cam_6host_45fps or "
                "18cam_6host_15fps (or the path of a .json file)");
  const std::string other = write("two.json", over("three.json"));
  EXPECT_EQ(error_of_file(other),
            other + ":1: /base: found \"three.json\": cannot be read: No such file or directory");
  fs::create_directory(path("folder.json"));
  const std::string third = write("four.json", over("folder.json"));
  EXPECT_EQ(error_of_file(third),
            third + ":1: /base: found \"folder.json\": cannot be read: it is no regular file");
}

TEST_F(Files, Unreadable) {
  EXPECT_EQ(error_of_file("none/my.json"),
            "none/my.json: cannot be read: No such file or directory");
  EXPECT_EQ(error_of_file(path("")), path("") + ": cannot be read: it is a folder");
  const std::string large = write("large.json", std::string(5 << 20, ' '));
  EXPECT_EQ(error_of_file(large),
            large + ": cannot be read: found more than 4194304 bytes, which no scenario needs");
  EXPECT_EQ(error_of_file(write("empty.json", "")),
            path("empty.json") + ":1:1: nothing in it; a JSON object was expected");
}

TEST_F(Files, UnknownNames) {
  EXPECT_EQ(error_of_file("18cam_6host_45fp"),
            "scenario: found \"18cam_6host_45fp\", did you mean 18cam_6host_45fps or "
            "18cam_6host_15fps (or the path of a .json file)");
  EXPECT_EQ(error_of_file("").substr(0, 30), "scenario: found \"\", allowed 18");
}

TEST(Nearest, ByDistanceAndPart) {
  const std::vector<std::string> known = {"count", "clock", "send_cost_ms"};
  EXPECT_EQ(nearest("cuont", known), std::vector<std::string>{"count"});
  EXPECT_EQ(nearest("Count", known), std::vector<std::string>{"count"});
  EXPECT_EQ(nearest("cost", known), std::vector<std::string>{"send_cost_ms"});
  EXPECT_EQ(nearest("xyz", known), std::vector<std::string>());
}

}  // namespace
}  // namespace simbench::scenarios
