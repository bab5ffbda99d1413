// The replay of a recording folder: the table that the run of it would print.
#ifndef SIMBENCH_CLI_REPLAY_FOLDER_H_
#define SIMBENCH_CLI_REPLAY_FOLDER_H_

#include <string>
#include <vector>

namespace simbench::cli {

struct FolderReplay {
  std::string folder;
  std::vector<std::string> pipelines;  // of those recorded; empty: all
  std::string format;                  // table, markdown, csv or json
  std::string output;                  // folder of a result archive; empty: none
  std::vector<std::string> command;    // as given, for the archive
};

// Returns the exit status. What is missing or damaged is noted, and the rest scored. Throws
// RecordingFolderError or scenarios::InputError where there is nothing to score.
int replay_folder(const FolderReplay& options);

}  // namespace simbench::cli

#endif  // SIMBENCH_CLI_REPLAY_FOLDER_H_
