// A folder of results that appears complete or not at all.
//
// The files are written below a temporary name beside the folder; publish() renames. Nothing is
// left if publish() is not reached, and an earlier result of simbench in that place stays until
// then. Only such an earlier result is replaced: a folder with anything else in it is refused.
//
//   OutputFolder output("results/monday");    // before the work: refuses what cannot be written
//   output.file("table.txt") << text;
//   output.publish();
//
// Errors: OutputError, whose message says what to do.
#ifndef SIMBENCH_REPORTS_TEXT_OUTPUT_FOLDER_H_
#define SIMBENCH_REPORTS_TEXT_OUTPUT_FOLDER_H_

#include <filesystem>
#include <fstream>
#include <optional>
#include <ostream>
#include <stdexcept>
#include <string>
#include <vector>

namespace simbench::reports {

class OutputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class OutputFolder {
 public:
  // Checks that `folder` may be written and makes the temporary one. `more_own_files`: what an
  // earlier result there may hold beside the files of an archive.
  explicit OutputFolder(const std::filesystem::path& folder,
                        const std::vector<std::string>& more_own_files = {});
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  // Starts the next file and finishes the one before: at most one is open.
  std::ostream& file(const std::string& name);
  // Finishes the last file and gives the folder its name.
  void publish();

 private:
  void finish_file();

  std::filesystem::path folder_;
  std::filesystem::path temporary_;
  std::filesystem::path open_name_;
  std::ofstream open_;
};

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_TEXT_OUTPUT_FOLDER_H_
