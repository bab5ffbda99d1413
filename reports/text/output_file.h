// A file that appears whole or not at all.
//
// It is written under a temporary name beside its own; publish() renames. Nothing is left if that
// is not reached, and an earlier file of the name stays until then. A link stays one: what it leads
// to is replaced.
//
//   OutputFile file("fig8.csv");     // before the work: refuses what cannot be written
//   file.write(text);
//   file.publish();
//
// Errors: OutputError, whose message says what to do.
#ifndef SIMBENCH_REPORTS_TEXT_OUTPUT_FILE_H_
#define SIMBENCH_REPORTS_TEXT_OUTPUT_FILE_H_

#include <filesystem>
#include <string>
#include <string_view>

namespace simbench::reports {

class OutputFile {
 public:
  // Checks that `path` may be written and makes the temporary file.
  explicit OutputFile(const std::string& path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  // The temporary name, for those who write by other means.
  const std::filesystem::path& path() const { return temporary_; }
  void write(std::string_view content) const;
  void publish() const;

 private:
  std::string named_;  // as the user did
  std::filesystem::path path_;
  std::filesystem::path temporary_;
};

// All of it at once.
void write_file(const std::string& path, std::string_view content);

// Why the last call of the system failed, in the system's words.
std::string system_reason();

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_TEXT_OUTPUT_FILE_H_
