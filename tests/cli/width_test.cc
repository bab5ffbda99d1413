// Output fits the page: COLUMNS, as a terminal of that width would have it.
#include <gmock/gmock.h>

#include <sstream>

#include "tests/cli/program.h"

namespace simbench {
namespace {

class Width : public ProgramTest {
 protected:
  // Lines wider than `columns`, unless it is one word (in the last column of a table) that is.
  static std::vector<std::string> too_wide(const std::string& text, std::size_t columns) {
    std::istringstream in(text);
    std::vector<std::string> found;
    for (std::string line; std::getline(in, line);) {
      if (line.size() <= columns) continue;
      const std::size_t gap = line.rfind("  ");
      const std::string last = gap == std::string::npos ? line : line.substr(gap + 2);
      if (last.find(' ') != std::string::npos) found.push_back(line);
    }
    return found;
  }
};

const std::vector<std::vector<std::string>>& commands() {
  static const std::vector<std::vector<std::string>> all_commands = {
      {"run", "--scenario", "18cam_6host_45fps", "--seeds", "1", "--set", "/timeline/frames=20"},
      {"run", "--scenario", "3cam_1host_30fps", "--seeds", "1", "--set", "/timeline/frames=8",
       "--pipelines", "free_running", "--budget"},
      {"describe", "18cam_6host_45fps"},
      {"list"},
      {"list", "pipelines"},
      {"list", "cameras"},
      {"list", "oscillators"},
      {"list", "algorithms"}};
  return all_commands;
}

TEST_F(Width, TablesAndProseFit) {
  for (const std::vector<std::string>& command : commands()) {
    for (const std::size_t columns : {80, 100, 160}) {
      SCOPED_TRACE(testing::PrintToString(command) + " at " + std::to_string(columns));
      const ProgramResult result =
          run(command, {.environment = {"COLUMNS=" + std::to_string(columns)}});
      EXPECT_EQ(result.status, 0) << result.err;
      EXPECT_THAT(too_wide(result.out, columns), testing::IsEmpty());
    }
  }
}

// The headers of a table's parts, the last line of each: what stands above the rule.
std::vector<std::string> headers_of(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> found;
  std::string above;
  for (std::string line; std::getline(in, line); above = line) {
    if (line.starts_with("--")) found.push_back(above);
  }
  return found;
}

TEST_F(Width, EveryPartOfATableSaysWhatItsRowsAreOf) {
  const ProgramOptions narrow = {.environment = {"COLUMNS=80"}};
  const ProgramResult swept =
      run({"sweep", "--scenario", "3cam_1host_30fps", "--pipelines", "raw_arrival,genlock",
           "--seeds", "2", "--set", "/timeline/frames=8", "--sweep",
           "/usb/delivery_jitter_transfers=0,0.2", "--output", "swept"},
          narrow);
  ASSERT_EQ(swept.status, 0) << swept.err;
  ASSERT_GT(headers_of(swept.out).size(), 1U) << swept.out;
  for (const std::string& header : headers_of(swept.out)) {
    EXPECT_THAT(header, testing::MatchesRegex("/delivery_jitter_transfers +pipeline .*"));
  }

  ASSERT_EQ(run({"run", "--scenario", "3cam_1host_30fps", "--pipelines", "raw_arrival,genlock",
                 "--seeds", "8", "--set", "/timeline/frames=8", "--output", "a"})
                .status,
            0);
  const ProgramResult compared = run({"compare", "a", "--with-baseline", "raw_arrival"}, narrow);
  ASSERT_EQ(compared.status, 0) << compared.err;
  ASSERT_GT(headers_of(compared.out).size(), 1U) << compared.out;
  for (const std::string& header : headers_of(compared.out)) {
    EXPECT_THAT(header, testing::MatchesRegex("pipeline +metric .*"));
  }
}

TEST_F(Width, AFileOrAPipeIsAsWideAsNeedBe) {
  for (const std::vector<std::string>& command : commands()) {
    if (command.front() == "run") continue;  // says how long it took
    SCOPED_TRACE(testing::PrintToString(command));
    const std::string piped = run(command).out;
    EXPECT_EQ(run(command, {.environment = {"COLUMNS=100000"}}).out, piped);
    EXPECT_EQ(run(command, {.environment = {"COLUMNS=wide"}}).out, piped);
  }
}

TEST_F(Width, DataKnowsNoWidth) {
  const std::vector<std::string> command = {"describe", "18cam_6host_45fps", "--format", "json"};
  EXPECT_EQ(run(command, {.environment = {"COLUMNS=40"}}).out, run(command).out);
}

TEST_F(Width, HelpIsNeverWiderThanAHundredColumns) {
  std::istringstream names(run({"manual", "--names"}).out);
  std::vector<std::string> all = {""};
  for (std::string name; std::getline(names, name);) all.push_back(name);
  ASSERT_GT(all.size(), 5);
  for (const std::string& name : all) {
    SCOPED_TRACE(name);
    const std::vector<std::string> command = name.empty()
                                                 ? std::vector<std::string>{"--help"}
                                                 : std::vector{name, std::string("--help")};
    const ProgramResult result = run(command);
    EXPECT_EQ(result.status, 0);
    EXPECT_THAT(too_wide(result.out, 100), testing::IsEmpty());
    EXPECT_THAT(too_wide(run(command, {.environment = {"COLUMNS=72"}}).out, 72),
                testing::IsEmpty());
  }
}

}  // namespace
}  // namespace simbench
