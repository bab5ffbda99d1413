// Every command line of the README and the docs is one that simbench takes. The option at the end
// is none: it is the one thing that a good line is refused for, before any work.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <sstream>
#include <string>
#include <vector>

#include "tests/cli/program.h"

namespace simbench {
namespace {

using testing::StartsWith;

namespace fs = std::filesystem;

constexpr const char* kNoOption = "--end-of-the-line";

struct DocumentedCommand {
  std::string place;
  std::vector<std::string> words;  // without "simbench"
};

// Words that a shell, or a reader, has to fill in.
bool is_for_a_shell(const std::string& line) {
  for (const char* part : {"$(", "<(", "|", "...", "[", "&&", " > ", "COMMAND"}) {
    if (line.find(part) != std::string::npos) return true;
  }
  return false;
}

// A line without its comment; quotes hold a word together.
std::vector<std::string> words_of_line(std::string line) {
  line.resize(std::min(line.size(), line.find(" #")));
  std::vector<std::string> words;
  std::istringstream text(line);
  std::string word;
  while (text >> std::ws && !text.eof()) {
    const char first = static_cast<char>(text.peek());
    if (first == '"' || first == '\'') {
      text >> std::quoted(word, first);
    } else {
      text >> word;
    }
    words.push_back(word);
  }
  return words;
}

void add_commands_of(const fs::path& page, std::vector<DocumentedCommand>& commands) {
  std::ifstream text(page);
  std::string line;
  for (int number = 1; std::getline(text, line); ++number) {
    if (!line.starts_with("    simbench ") || is_for_a_shell(line)) continue;
    for (std::string more; line.ends_with('\\') && std::getline(text, more);) {
      line.back() = ' ';
      line += more;
    }
    std::vector<std::string> words = words_of_line(line);
    words.erase(words.begin());
    if (words.empty()) continue;  // `simbench` alone
    commands.push_back({fmt::format("{}:{}", page.filename().string(), number), words});
  }
}

class DocumentedCommands : public ProgramTest {};

TEST_F(DocumentedCommands, AreWhatTheProgramTakes) {
  const fs::path project(SIMBENCH_SOURCE_DIR);
  std::vector<DocumentedCommand> commands;
  add_commands_of(project / "README.md", commands);
  for (const auto& entry : fs::recursive_directory_iterator(project / "docs")) {
    if (entry.path().extension() == ".md") add_commands_of(entry.path(), commands);
  }
  EXPECT_GT(commands.size(), 100U);
  for (const DocumentedCommand& command : commands) {
    std::vector<std::string> arguments = command.words;
    arguments.emplace_back(kNoOption);
    EXPECT_THAT(run(arguments).err, StartsWith(fmt::format("error: found '{}'", kNoOption)))
        << fmt::format("{}: simbench {}", command.place, fmt::join(command.words, " "));
  }
}

}  // namespace
}  // namespace simbench
