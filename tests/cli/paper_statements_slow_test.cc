// Every command that docs/reference/paper_statements.md names, run with one seed.
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/cli/paper_statements.h"
#include "tests/cli/program.h"
#include "tests/nonempty.h"

namespace simbench {
namespace {

class PaperStatementsSlow : public ProgramTest {};

std::set<std::string> commands_of_list() {
  std::set<std::string> commands;
  for (const StatementRow& row : nonempty(read_statements(statements_text()).rows)) {
    for (const std::string& name : quoted_names(row.where)) {
      if (name.starts_with("simbench ")) commands.insert(name);
    }
  }
  return commands;
}

TEST_F(PaperStatementsSlow, EveryCommandRuns) {
  for (const std::string& command : nonempty(commands_of_list())) {
    std::istringstream text(command);
    std::vector<std::string> words;
    for (std::string word; text >> word;) words.push_back(word);
    words.erase(words.begin());
    // reconstruct, and Table 4 of paper, have libraries and slow tests of their own.
    if (words.front() == "reconstruct") continue;
    if (words.front() == "paper") words.emplace_back("--no-table-4");
    if (words.front() == "run" || words.front() == "sweep" || words.front() == "paper") {
      words.insert(words.end(), {"--seeds", "1"});
    }
    const ProgramResult result = run(words);
    EXPECT_EQ(result.status, 0) << command << "\n" << result.err;
  }
}

}  // namespace
}  // namespace simbench
