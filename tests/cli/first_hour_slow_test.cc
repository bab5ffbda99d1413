// docs/first_hour.md as a reader follows it: every command, in order, in one folder.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "tests/cli/program.h"

namespace simbench {
namespace {

using testing::HasSubstr;

class FirstHour : public ProgramTest {};

// The words of a line, with '...' as one word.
std::vector<std::string> words_of(const std::string& line) {
  std::vector<std::string> words;
  bool is_quoted = false;
  bool is_open = false;
  for (const char c : line) {
    if (c == '\'') {
      is_quoted = !is_quoted;
    } else if (c == ' ' && !is_quoted) {
      is_open = false;
    } else {
      if (!is_open) words.emplace_back();
      is_open = true;
      words.back() += c;
    }
  }
  return words;
}

// The commands below each heading.
std::map<std::string, std::vector<std::string>> commands_of_page() {
  std::map<std::string, std::vector<std::string>> commands;
  std::ifstream page(std::string(SIMBENCH_SOURCE_DIR) + "/docs/first_hour.md");
  std::string heading;
  for (std::string line; std::getline(page, line);) {
    if (line.starts_with("## ")) heading = line.substr(3);
    if (line.starts_with("    simbench ")) commands[heading].push_back(line.substr(13));
  }
  return commands;
}

TEST_F(FirstHour, EachReaderHasTheAnswerAfterThreeCommands) {
  std::filesystem::create_directory_symlink(std::string(SIMBENCH_SOURCE_DIR) + "/reports",
                                            folder() / "reports");
  const auto pages = commands_of_page();
  EXPECT_EQ(pages.size(), 6U);
  for (const auto& [reader, commands] : pages) {
    EXPECT_LE(commands.size(), 3U) << reader;
    for (const std::string& command : commands) {
      const ProgramResult result = run(words_of(command));
      EXPECT_EQ(result.status, 0) << command << "\n" << result.err;
    }
  }
}

}  // namespace
}  // namespace simbench
